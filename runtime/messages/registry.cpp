#include "runtime/messages/registry.hpp"

#include "runtime/core/check.hpp"
#include "runtime/core/hash.hpp"

#include <algorithm>

namespace tess {

Registered::Registered(std::string_view name) : name_(name) {
  Registry::all().push_back(this);
}

std::vector<Registered*>& Registry::all() {
  static std::vector<Registered*> things;
  return things;
}

void Registry::seal() {
  auto& things = all();
  std::sort(things.begin(), things.end(),
            [](const Registered* a, const Registered* b) { return a->name_ < b->name_; });
  for (std::size_t i = 0; i < things.size(); ++i) {
    TESS_CHECK(i == 0 || things[i - 1]->name_ != things[i]->name_,
               "two registered things share the name ", things[i]->name_);
    things[i]->id_ = static_cast<std::uint32_t>(i);
  }
}

std::uint64_t Registry::fingerprint() {
  std::uint64_t hash = all().size();
  for (const Registered* thing : all())
    hash = mix(hash ^ hash_bytes(thing->name_.data(), thing->name_.size()));
  return hash;
}

const Registered& Registry::at(std::uint32_t id) {
  if (id >= all().size())
    fail(ErrorCode::bad_value, "a message names action ", id, ", but only ", all().size(),
         " are known");
  return *all()[id];
}

std::string plain_name(std::string_view compiler_name) {
  // "tess::Call<Block, &Block::step>" is Block::step to a reader.
  if (const auto function = compiler_name.rfind('&'); function != std::string_view::npos) {
    compiler_name.remove_prefix(function + 1);
    // To the bracket that closes what is before the name: "&Block<A<int> >::step>".
    int depth = 0;
    std::size_t end = 0;
    for (; end < compiler_name.size(); ++end) {
      const char c = compiler_name[end];
      depth += c == '<' || c == '(' ? 1 : c == '>' || c == ')' ? -1 : 0;
      if (depth < 0) break;
    }
    compiler_name = compiler_name.substr(0, end);
  }
  std::string name(compiler_name);
  for (const std::string_view noise : {"{anonymous}::", "(anonymous namespace)::", "tess::"}) {
    for (auto at = name.find(noise); at != std::string::npos; at = name.find(noise))
      name.erase(at, noise.size());
  }
  return name;
}

}  // namespace tess
