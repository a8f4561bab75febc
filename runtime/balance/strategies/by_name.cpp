#include "runtime/balance/honour.hpp"
#include "runtime/balance/strategies/diffusion.hpp"
#include "runtime/balance/strategies/gossip.hpp"
#include "runtime/balance/strategies/graph.hpp"
#include "runtime/balance/strategies/greedy.hpp"
#include "runtime/balance/strategies/greedy_refine.hpp"
#include "runtime/balance/strategies/refine.hpp"
#include "runtime/balance/strategy.hpp"
#include "runtime/balance/unknown_loads.hpp"
#include "runtime/core/did_you_mean.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tess::balance {

// Strategies that only this table calls. Each is in the source of its name, or in simple.cpp, and
// described there.
Assignment none(const Snapshot& s);
Assignment rotate(const Snapshot& s);
Assignment random(const Snapshot& s, std::uint64_t seed);
Assignment hierarchical(const Snapshot& s);
Assignment rcb(const Snapshot& s);
Assignment hilbert(const Snapshot& s);

namespace {

enum class Needs : std::uint8_t { nothing, positions, scotch };

struct Entry {
  std::string name;
  Assignment (*run)(const Snapshot&, std::uint64_t seed);
  Needs needs = Needs::nothing;
  Strategy users{};  ///< of register_strategy(), in place of `run`
};

/// The table of strategies; an entry without a seed ignores it.
std::vector<Entry>& entries() {
  static std::vector<Entry> all = {
      {"none", [](const Snapshot& s, std::uint64_t) { return none(s); }},
      {"rotate", [](const Snapshot& s, std::uint64_t) { return rotate(s); }},
      {"random", [](const Snapshot& s, std::uint64_t seed) { return random(s, seed); }},
      {"greedy", [](const Snapshot& s, std::uint64_t) { return greedy(s); }},
      {"greedy_refine", [](const Snapshot& s, std::uint64_t) { return greedy_refine(s); }},
      {"refine", [](const Snapshot& s, std::uint64_t) { return refine(s); }},
      {"diffusion", [](const Snapshot& s, std::uint64_t) { return diffusion(s); }},
      {"gossip", [](const Snapshot& s, std::uint64_t seed) { return gossip(s, seed); }},
      {"hierarchical", [](const Snapshot& s, std::uint64_t) { return hierarchical(s); }},
      {"rcb", [](const Snapshot& s, std::uint64_t) { return rcb(s); }, Needs::positions},
      {"hilbert", [](const Snapshot& s, std::uint64_t) { return hilbert(s); }, Needs::positions},
      {"graph", [](const Snapshot& s, std::uint64_t seed) { return graph(s, seed); },
       Needs::scotch},
  };
  return all;
}

std::vector<std::string>& names() {
  static std::vector<std::string> all = [] {
    std::vector<std::string> result;
    for (const Entry& entry : entries()) result.push_back(entry.name);
    return result;
  }();
  return all;
}

Needs needs_of(std::string_view name) {
  const auto entry = std::ranges::find(entries(), name, &Entry::name);
  return entry == entries().end() ? Needs::nothing : entry->needs;
}

}  // namespace

void register_strategy(const std::string& name, Strategy strategy, std::uint64_t version) {
  const auto refuse = [&name](const auto&... why) {
    fail(ErrorCode::bad_argument, "register_strategy: ", name, ": ", why...);
  };
  if (version != snapshot_version)
    refuse("it was compiled against another version of Tessera, whose snapshots differ (",
           fmt::format("{:x}, here {:x}", version, snapshot_version),
           "); compile it with the headers of this one");
  constexpr std::string_view fitting =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  if (name.empty() || name.find_first_not_of(fitting) != std::string::npos || name == "all")
    refuse("is no name of a strategy; use letters, digits, '_' and '-'");
  if (std::ranges::count(strategy_names(), name) > 0)
    refuse("there is a strategy of this name; choose another name");
  if (!strategy) refuse("its function is empty");
  entries().push_back({name, nullptr, Needs::nothing, std::move(strategy)});
  names().push_back(name);
}

const std::vector<std::string>& strategy_names() {
  return names();
}

namespace {

/// The user's strategy of an entry, whose exceptions name it.
Strategy named_when_it_throws(const Entry& entry) {
  return [users = entry.users, name = entry.name](const Snapshot& s) {
    try {
      return users(s);
    } catch (const std::exception& error) {
      fail(ErrorCode::bad_argument, "balance strategy ", name,
           ": ends with an exception: ", error.what());
    }
  };
}

}  // namespace

Strategy make_strategy(std::string_view name, std::uint64_t seed) {
  for (const Entry& entry : entries()) {
    if (entry.name != name) continue;
    if (entry.users) return make_strategy(named_when_it_throws(entry), entry.name);
    return [run = entry.run, seed](const Snapshot& s) {
      if (n_known_loads(s) == s.elements.size()) return run(s, seed);
      return run(with_unknown_pinned(s), seed);
    };
  }
  const std::string names = fmt::format("{}", fmt::join(strategy_names(), ", "));
  fail(ErrorCode::bad_argument,
       fmt::format("no balance strategy '{}'; choose one of {}", name, names),
       did_you_mean(name, names));
}

bool needs_positions(std::string_view name) {
  return needs_of(name) == Needs::positions;
}

bool is_distributed(std::string_view name) {
  return name == "diffusion" || name == "gossip";
}

std::string obstacle(std::string_view name, const Snapshot& s) {
  if (needs_positions(name) && s.elements.position.empty() && s.elements.size() > 0)
    return "the snapshot does not have the positions of all elements";
  if (needs_of(name) == Needs::scotch && !graph_is_built())
    return "Tessera is built without Scotch";
  return {};
}

Strategy make_strategy(Strategy users, std::string name) {
  return [users = std::move(users), name = std::move(name)](const Snapshot& s) {
    return honour(with_unknown_pinned(s), users(s), name);
  };
}

}  // namespace tess::balance
