// Sections over restarts: reductions over them, started by elements and several at once, while
// members end, their indices are used again, and everything migrates.
#include "runtime/checkpoint.hpp"
#include "runtime/more/section.hpp"
#include "runtime/more/when.hpp"
#include "runtime/runtime.hpp"
#include "tests/runtime/checkpoint/runs.hpp"
#include "tests/support/scratch.hpp"

#include <utility>
#include <vector>

namespace choir {
namespace {

using tess::PeId;
using Voices = std::vector<int>;  // the indices of those that sing

class Singer : public tess::Chare<Singer> {
 public:
  void sing(tess::SectionProxy<Singer> choir, tess::Callback<Voices> target) {
    ++n_sung_;
    contribute(choir, tess::in_order(tess::concatenate), Voices{index().x}, std::move(target));
    migrate_to(PeId{(tess::my_pe().value + index().x) % tess::n_pes()});
  }
  /// Two rounds at once.
  tess::TaskOf<Voices> conduct(tess::SectionProxy<Singer> choir) {
    auto first = choir.reduce<&Singer::sing>(choir);
    auto second = choir.reduce<&Singer::sing>(choir);
    const auto [voices, again] = co_await tess::when_all(first, second);
    REQUIRE(voices == again);
    co_return voices;
  }
  [[nodiscard]] int n_sung() const { return n_sung_; }

  void serialize(auto& ar) { ar(n_sung_); }

 private:
  int n_sung_ = 0;
};

struct State {
  tess::ArrayProxy<Singer> singers;
  tess::SectionProxy<Singer> choir;
  Voices members;
  int n_rounds = 0;
};

/// Two elements conduct at the same time; one of them is no member.
tess::Task sing(State& state) {
  auto one = state.singers[{0}].ask<&Singer::conduct>(state.choir);
  auto other = state.singers[{3}].ask<&Singer::conduct>(state.choir);
  const Voices of_other = co_await other;
  const Voices of_one = co_await one;
  REQUIRE(of_one == state.members);
  REQUIRE(of_other == state.members);
  state.n_rounds += 4;
  const int n_sung = co_await state.singers[{5}].ask<&Singer::n_sung>();
  REQUIRE(n_sung == state.n_rounds);
}
tess::Task end(State& state, int member) {
  std::erase(state.members, member);
  co_await tess::epoch([&] { state.singers[{member}].destroy(); });
}

tess::Task begin(std::string folder) {
  State state{tess::create<Singer>(tess::range(7)), {}, {0, 1, 2, 4, 5}, 0};
  co_await tess::epoch([&] {
    state.choir = tess::create_section(state.singers, {{0}, {1}, {2}, {4}, {5}});
  });
  co_await sing(state);
  co_await end(state, 1);
  co_await tess::checkpoint(folder, state);
  co_await end(state, 2);  // the restart does not know of it
}
/// A member that has ended stays away, also if there is a new element of its index.
tess::Task go_on(std::string folder, int ends) {
  State state = co_await tess::restart<State>(folder);
  co_await sing(state);
  co_await tess::epoch([&] { state.singers[{1}].insert_on(PeId{tess::n_pes() - 1}); });
  co_await sing(state);
  co_await end(state, ends);
  co_await sing(state);
  tess::SectionProxy<Singer> duet;
  co_await tess::epoch([&] { duet = tess::create_section(state.singers, {{1}, {0}}); });
  const Voices two = co_await state.singers[{1}].ask<&Singer::conduct>(duet);
  REQUIRE(two == Voices{0, 1});
  co_await end(state, 1);
  co_await tess::epoch([&] { duet.destroy(); });
  co_await tess::checkpoint(folder, state);
}

}  // namespace

TEST_CASE("a section has the same members over restarts, whatever ends and begins between",
          "[runtime][checkpoint][section]") {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const tess::test::Scratch scratch;
    const std::string folder = scratch.path("saved");
    tess::test::completes(4, seed, [&] { return begin(folder); });
    tess::test::completes(1 + static_cast<int>(seed % 3), seed, [&] { return go_on(folder, 4); });
    tess::test::completes(5, seed, [&] { return go_on(folder, 2); });
  }
}

}  // namespace choir
