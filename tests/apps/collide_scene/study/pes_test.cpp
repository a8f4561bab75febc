// The study of PEs: its predictions repeat, more PEs are faster, and balance rounds help where the
// work is uneven.
#include "apps/collide_scene/study/pes.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <algorithm>

using namespace collide_scene;

namespace {

std::vector<PesRow> study(const char* scene, const Ladder& ladder, std::int32_t n_steps) {
  kit::Progress progress(nullptr);
  Options options{.inputs = {scene}, .steps = n_steps, .ladder = ladder};
  check_ladder(options);
  return study_pes(options, progress, [](const PesRow&) {});
}

}  // namespace

TEST_CASE("a crowd has its pairs on all machines, whose predictions repeat",
          "[apps][collide_scene]") {
  const Ladder ladder{.pes = {1, 20}, .balance = {"none", "greedy_refine"}};
  const std::vector<PesRow> rows = study("crowd:8192", ladder, 11);
  const std::vector<PesRow> again = study("crowd:8192", ladder, 11);
  REQUIRE(rows.size() == 4);
  CHECK(std::ranges::all_of(rows, &PesRow::agrees));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    CHECK(rows[i].answer == again[i].answer);
    CHECK(rows[i].predicted == again[i].predicted);
  }
  CHECK(rows[0].measured.has_value());
  CHECK(rows[2].speed_up > 1.5);
  CHECK(rows[2].n_moved == 0);
  CHECK(rows[3].n_moved > 0);
}

TEST_CASE("balance rounds help a crowd whose clusters are uneven", "[apps][collide_scene]") {
  const std::vector<PesRow> rows =
      study("crowd:65536", {.pes = {16}, .balance = {"none", "greedy_refine"}}, 16);
  REQUIRE(rows.size() == 2);
  CHECK(rows[1].predicted < 0.97 * rows[0].predicted);
}

TEST_CASE("weak scaling gives each PE as many objects, which are near each other",
          "[apps][collide_scene]") {
  const std::vector<PesRow> rows = study("planes:4096", {.pes = {1, 4, 16}, .is_weak = true}, 2);
  REQUIRE(rows.size() == 3);
  CHECK(rows[2].n_objects == 16 * rows[0].n_objects);
  CHECK(rows[0].efficiency == 1);
  CHECK(rows[2].efficiency > 0.4);
  CHECK(rows[2].efficiency < rows[1].efficiency);
  CHECK(rows[2].speed_up == Approx(16 * rows[2].efficiency));
}

TEST_CASE("ladders that cannot be climbed are refused", "[apps][collide_scene]") {
  const auto refusal = [](const Options& options) {
    return tess::test::message_of([&] { check_ladder(options); });
  };
  CHECK(refusal({.inputs = {"a.obj"}, .ladder = {.is_weak = true}}).starts_with("--weak: a.obj"));
  CHECK(refusal({.steps = 5, .ladder = {.balance = {"greedy"}}}).starts_with("--steps 5: greedy"));
  CHECK(refusal({.ladder = {.network = "cost=1us,pes=3"}}).starts_with("--network cost=1us,pes=3"));
}
