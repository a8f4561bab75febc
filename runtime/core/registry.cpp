#include "runtime/core/registry.hpp"

#include "runtime/core/check.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>

namespace tess::detail {

Registered::Registered(std::string_view text, const std::type_info* tag) : name_{text, tag} {
  Registry::all().push_back(this);
}

std::vector<Registered*>& Registry::all() {
  static std::vector<Registered*> things;
  return things;
}

void Registry::seal() {
  auto& things = all();
  std::sort(things.begin(), things.end(), [](const Registered* a, const Registered* b) {
    return a->name_.key() < b->name_.key();
  });
  for (std::size_t i = 0; i < things.size(); ++i) {
    TESS_CHECK(i == 0 || things[i - 1]->name_.key() != things[i]->name_.key(),
               "two classes or functions that messages name are both called ", things[i]->name(),
               ": rename one, or put it into a named namespace of its own");
    things[i]->id_ = static_cast<std::uint32_t>(i);
  }
}

std::uint64_t Registry::fingerprint() {
  std::uint64_t hash = all().size();
  for (const Registered* thing : all()) {
    const std::string_view key = thing->name_.key();
    hash = mix(hash ^ hash_bytes(key.data(), key.size()));
  }
  return hash;
}

const Registered& Registry::at(std::uint32_t id) {
  if (id >= all().size())
    fail(ErrorCode::bad_value, "a message names action ", id, ", but this program has ",
         all().size(), ": start the same build everywhere");
  return *all()[id];
}

}  // namespace tess::detail
