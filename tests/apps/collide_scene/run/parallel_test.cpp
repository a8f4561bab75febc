// Both faces give the same answer as each other, and as brute force.
#include "apps/collide_scene/run/parallel.hpp"

#include "apps/collide_scene/run/serial.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

using namespace collide_scene;
using tess::collide::WithinModel;

namespace {

struct OnChares {
  StepResult step;
  std::vector<ScenePair> pairs;
  RunResult run;
};

tess::Task collide(const Scene& scene, const Rules& rules, OnChares& out) {
  ParallelCollisions collisions(scene, rules);
  co_await collisions.begin();
  co_await collisions.step(2, 2, out.step, &out.pairs);
  co_await collisions.end(out.run);
}

OnChares collide_on_chares(const Scene& scene, const Rules& rules, const char* machine) {
  OnChares out;
  REQUIRE(tests::run(machine, [&] { return collide(scene, rules, out); }).exit_code == 0);
  std::ranges::sort(out.pairs);
  return out;
}

}  // namespace

TEST_CASE("chares find the pairs of the serial face, on any number of PEs and any schedule",
          "[apps][collide_scene]") {
  for (const char* name : {"planes:1024", "boxes:500", "crowd:1024", "lshapes:20"})
    for (const bool exact : {false, true})
      for (const WithinModel within : {WithinModel::skip, WithinModel::test}) {
        const Scene scene = make_scene(name);
        if (exact && scene.triangles.empty()) continue;
        const Rules rules{.triangles = exact, .within_model = within};
        std::vector<ScenePair> pairs;
        const Answer want = collide_once(scene, rules, 2, &pairs).answer;
        std::ranges::sort(pairs);
        for (const char* machine : {"pes=1", "pes=3", "pes=4,seed=1", "pes=5,seed=2,migrate=0.1"}) {
          INFO(name << " " << exact << (within == WithinModel::test) << " " << machine);
          const OnChares got = collide_on_chares(scene, rules, machine);
          CHECK(got.step.answer == want);
          CHECK(got.pairs == pairs);
          CHECK(got.run.peak_memory_bytes > 0);
        }
      }
}

TEST_CASE("the hash depends on the pairs and the step, and not on their order",
          "[apps][collide_scene]") {
  Answer a, b, other_step, other_pair;
  a.add({1, 2}, 0), a.add({3, 4}, 0);
  b.add({3, 4}, 0), b.add({1, 2}, 0);
  other_step.add({1, 2}, 0), other_step.add({3, 4}, 1);
  other_pair.add({1, 2}, 0), other_pair.add({3, 5}, 0);
  CHECK(a == b);
  CHECK(a.hash != other_step.hash);
  CHECK(a.hash != other_pair.hash);
}
