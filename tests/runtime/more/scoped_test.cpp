// Scoped handles: what the end of their scope destroys, and what it leaves alone.
#include "runtime/more/scoped.hpp"

#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

#include <type_traits>

namespace {

int n_alive = 0;  // elements; one thread runs all simulated PEs

class Cog : public tess::Chare<Cog> {
 public:
  Cog() { ++n_alive; }
  Cog(const Cog&) = delete;
  Cog& operator=(const Cog&) = delete;
  ~Cog() override { --n_alive; }
  void go(tess::Callback<void> done) { contribute(done); }
};
using Cogs = tess::Scoped<tess::ArrayProxy<Cog>>;

class Crew : public tess::Group<Crew> {
 public:
  Crew() { ++n_alive; }
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;
  ~Crew() override { --n_alive; }
  void take(tess::ArrayProxy<Cog> parts, tess::Callback<void> done) {
    parts.broadcast<&Cog::go>(done);
  }
};

Cogs make(int n) {
  return Cogs(tess::create<Cog>(tess::range(n)));
}

/// Owns an array as long as it lives.
class CogOwner : public tess::Chare<CogOwner> {
 public:
  CogOwner() : parts_(make(index().x + 1)) {}

 private:
  Cogs parts_;
};

template <class Main>
tests::Ending run(const std::string& machine, Main main) {
  n_alive = 0;
  const tests::Ending ending = tests::run(machine, main);
  CHECK(n_alive == 0);  // at the end of the run the rest is freed
  return ending;
}

tess::Task one_of_each() {
  const Cogs parts = make(7);
  const tess::Scoped members(tess::create<Crew>(tess::each_pe));
  tess::Future<void> done;
  // A message takes the handle.
  members[tess::PeId{2}].send<&Crew::take>(parts, done.callback());
  co_await done;
  CHECK(n_alive >= 7 + 1);  // the other members may be on their way
}

tess::Task end_of_scope() {
  co_await tess::epoch([] { const tess::Task work = one_of_each(); });
  CHECK(n_alive == 0);
  CHECK(tess::n_collections() == 0);
}

TEST_CASE("the end of a scope destroys its array and its group on all PEs", "[runtime][destroy]") {
  for (int seed = 1; seed <= 20; ++seed) {
    const tests::Ending ending = run(tess::text("pes=3,per-process=1,seed=", seed),
                                     []() -> tess::Task { return end_of_scope(); });
    INFO("seed " << seed);
    CHECK(ending.exit_code == 0);
    CHECK(ending.report == "");
  }
}

tess::Task move_about() {
  Cogs one;
  CHECK(!one.owns());
  Cogs two = make(2), three = make(3);
  // Moving does not destroy anything; an assignment destroys what was owned before.
  co_await tess::epoch([&] { one = std::move(two); });
  CHECK(one.owns());
  CHECK(!two.owns());
  CHECK(one.id() == two.id());
  CHECK(n_alive == 2 + 3);
  co_await tess::epoch([&] { three = std::move(one); });
  CHECK(n_alive == 2);
  co_await tess::epoch([&] { Cogs same = std::move(three), again = std::move(same); });
  CHECK(n_alive == 0);

  Cogs ended = make(4);
  co_await tess::epoch([&] { ended.destroy(); });
  CHECK(n_alive == 0);
  CHECK(ended.ended());

  tess::ArrayProxy<Cog> kept;
  co_await tess::epoch([&] {
    Cogs scope = make(5);
    kept = scope.release();
  });
  CHECK(n_alive == 5);
  CHECK(!kept.ended());
  co_await tess::epoch([&] { kept.destroy(); });
}

TEST_CASE("a scoped array is destroyed once, by its last owner", "[runtime][destroy]") {
  const tests::Ending ending = run("pes=2,cost=100ns", []() -> tess::Task { return move_about(); });
  CHECK(ending.exit_code == 0);
  CHECK(ending.report == "");
}

tess::Task own_by_elements() {
  tess::ArrayProxy<CogOwner> owners;
  co_await tess::epoch([&] { owners = tess::create<CogOwner>(tess::range(3)); });
  CHECK(n_alive == 1 + 2 + 3);
  co_await tess::epoch([&] { owners[{1}].destroy(); });
  CHECK(n_alive == 1 + 3);
  co_await tess::epoch([&] { owners.destroy(); });
  CHECK(n_alive == 0);
  CHECK(tess::n_collections() == 0);
}

TEST_CASE("an array that a chare owns is destroyed with the chare", "[runtime][destroy]") {
  const tests::Ending ending =
      run("pes=2,cost=100ns", []() -> tess::Task { return own_by_elements(); });
  CHECK(ending.exit_code == 0);
  CHECK(ending.report == "");
}

tess::Task own_to_the_end(bool exits) {
  const Cogs parts = make(3);
  (void)tess::create<CogOwner>(tess::range(2));
  tess::Future<int> never;
  if (exits) tess::exit(3);
  (void)co_await never;
}

TEST_CASE("a scoped array at the end of the run is freed with the run", "[runtime][destroy]") {
  for (const bool exits : {true, false}) {
    const tests::Ending ending =
        run("pes=2,cost=100ns", [exits]() -> tess::Task { return own_to_the_end(exits); });
    CHECK(ending.exit_code == (exits ? 3 : 1));  // 1: a coroutine waits
  }
}

static_assert(!std::is_copy_constructible_v<Cogs> && !std::is_copy_assignable_v<Cogs>);
static_assert(std::is_nothrow_move_constructible_v<Cogs>);

}  // namespace
