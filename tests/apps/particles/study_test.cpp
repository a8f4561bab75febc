// The study against what must come out: the exact reference by itself, and the orders and bounds
// that theory gives for the rows.
#include "apps/particles/study/study.hpp"

#include "apps/particles/study/measure.hpp"
#include "collide/dn_field/field_file.hpp"
#include "collide/dn_field/shapes.hpp"
#include "tests/apps/particles/run_scene.hpp"
#include "tests/support/scratch.hpp"

#include <chrono>
#include <thread>

using namespace particles;
using tess::dn::Vec3;

TEST_CASE("exact bounces lie on the surface and mirror the velocity", "[particles][study]") {
  const tess::dn::Surface box = tess::dn::make_box({1, 2, 3});
  const auto bounces = exact_bounces(box, tess::dn::Bvh(box), 100, 0.5, 1);
  CHECK(bounces.size() == 100);  // a box hides none of its faces
  for (const Bounce& b : bounces) {
    const Vec3 part{std::abs(b.hit.x), std::abs(b.hit.y) / 2, std::abs(b.hit.z) / 3};
    CHECK(std::max({part.x, part.y, part.z}) == Approx(1).epsilon(1e-12));
    CHECK(norm(b.velocity) == Approx(1).epsilon(1e-12));
    CHECK(norm(b.outgoing) == Approx(1).epsilon(1e-12));
    const Vec3 change = b.outgoing - b.velocity;  // along one axis
    CHECK(norm(change) ==
          Approx(std::abs(change.x) + std::abs(change.y) + std::abs(change.z)).epsilon(1e-12));
    const Vec3 place = b.hit + 0.7 * b.outgoing;
    CHECK(bounce_time(b, place, b.outgoing, b.time + 0.7) == Approx(b.time).epsilon(1e-9));
  }
}

TEST_CASE("the study of a mesh far from the origin has the errors of the mesh at the origin",
          "[particles][study]") {
  Scene scene = scene_of(R"({"dt": 1, "steps": 0,
    "objects": [{"shape": {"sphere": {"radius": 1, "rings": 30}}, "resolution": 24, "thickness": 1}],
    "emitters": [{"count": 1, "sphere": {"radius": 1}}]})");
  StudyOptions options;
  options.resolutions = {12};
  options.n_samples = 300;
  options.n_bounces = 10;
  options.n_timed = 10;
  const std::vector<StudyRow> near = study(scene, options);
  const Vec3 away{500000, 4000000, 0};
  for (Vec3& v : scene.objects[0].surface.vertices) v = v + away;
  scene.objects[0].grid.origin = scene.objects[0].grid.origin + away;
  const std::vector<StudyRow> far = study(scene, options);
  int n_compared = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    CHECK(far[i].lost == near[i].lost);
    if (near[i].place_error > 1e-9)
      CHECK(*far[i].place_error == Approx(*near[i].place_error).epsilon(0.01));
    if (near[i].part != "field" || near[i].stored != "flat") continue;
    ++n_compared;
    CHECK(near[i].distance_error > 0);
    CHECK(*far[i].distance_error == Approx(*near[i].distance_error).epsilon(0.01));
    CHECK(*far[i].normal_error == Approx(*near[i].normal_error).epsilon(0.01).margin(0.01));
  }
  CHECK(n_compared == 9);
}

TEST_CASE("a field from a file without normals is not studied", "[particles][study]") {
  using namespace tess::dn;
  const tess::test::Scratch scratch;
  const std::string path = scratch.path("field.dnf");
  const Surface ball = outward(make_sphere(1, 24));
  save_field(build_field(ball, grid_around(bounds(ball), 24, 0.5),
                         {.content = Content::distance, .thickness = 0.5}),
             path);
  const Scene scene = scene_of(R"({"dt": 1, "steps": 0,
    "objects": [{"shape": {"sphere": {"radius": 1, "rings": 24}}, "field": ")" +
                               path + R"("}],
    "emitters": [{"count": 1, "sphere": {"radius": 2}}]})");
  StudyOptions options;
  options.resolutions = {12};
  options.n_samples = options.n_bounces = options.n_timed = 10;
  CHECK(tess::test::message_of([&] { (void)study(scene, options); }) ==
        path + ": stores no normals, which are needed here; build it with distance and normal");
}

TEST_CASE("the study finds the orders of the look-ups, and no particle lost where none may be",
          "[particles][study]") {
  const Scene scene = scene_of(R"({"dt": 1, "steps": 0,
    "objects": [{"shape": {"sphere": {"radius": 1, "rings": 30}}, "resolution": 24, "thickness": 1}],
    "emitters": [{"count": 1, "sphere": {"radius": 1}}]})");
  StudyOptions options;
  options.resolutions = {12, 23};
  options.n_samples = 1000;
  options.n_bounces = 30;
  options.n_timed = 100;
  const std::vector<StudyRow> rows = study(scene, options);
  const auto row_of = [&](int resolution, const char* look_up) {
    for (const StudyRow& row : rows)
      if (row.part == "field" && row.method == "exact" && row.resolution == resolution &&
          row.look_up == look_up && row.stored == "flat")
        return row;
    FAIL("no row for " << look_up);
    return rows.front();
  };
  // 23 - 1 cells are half as large as 12 - 1.
  const auto order = [&](const char* look_up) {
    return std::log2(*row_of(12, look_up).distance_error / *row_of(23, look_up).distance_error);
  };
  CHECK(order("nearest") == Approx(1).margin(0.25));
  CHECK(order("tangent") == Approx(2).margin(0.5));
  CHECK(order("trilinear") == Approx(2).margin(0.5));
  const double cell = 4.0 / 22;
  CHECK(row_of(23, "nearest").distance_error_max <= 0.5 * std::sqrt(3.0) * cell + 1e-6);
  int n_swept = 0;
  for (const StudyRow& row : rows) {
    if (!row.note.empty()) continue;
    INFO(row.part << " " << row.resolution << " " << row.method << " " << row.look_up << " "
                  << row.rule);
    const bool fine = row.look_up != "nearest" && row.resolution >= 23 && row.method == "exact";
    if (row.rule == "impact, swept" && fine && row.lost >= 0) {
      ++n_swept;
      CHECK(row.lost == 0);
    }
    if (row.rule == "impact, swept" && row.look_up == "tangent" && row.lost >= 0)
      CHECK(row.penetration < cell);
    // A step of twice the thickness without a sweep: some go through.
    if (row.rule == "impact" && row.step == 2) CHECK(row.lost > 0);
    // Compressed fields lose nothing either, and take less.
    if (row.stored == "compressed" && row.part == "field") {
      const StudyRow flat = row_of(row.resolution, row.look_up.c_str());
      CHECK(row.bytes < flat.bytes);
      CHECK(row.lost <= flat.lost);
      CHECK(*row.angle_error < *flat.angle_error + 1);
    }
  }
  CHECK(n_swept > 0);
  // Drag and flow act by the surface at the start of a step: of first order.
  const auto place_error = [&](const char* rule, double step) {
    for (const StudyRow& row : rows)
      if (row.part == "rule" && row.rule == rule && row.step == step) {
        CHECK(row.cpu_ns > 0);
        CHECK(row.ns > 0);
        return *row.place_error;
      }
    FAIL("no row for " << rule);
    return 0.0;
  };
  CHECK(place_error("drag", 0.02) < 0.03);
  CHECK(place_error("drag", 0.1) > 2 * place_error("drag", 0.02));
  CHECK(place_error("drag", 2.0) > 4 * place_error("drag", 0.1));
  CHECK(place_error("surface flow", 0.02) < 0.05);
  CHECK(place_error("surface flow", 2.0) > 3 * place_error("surface flow", 0.02));
  for (const StudyRow& row : rows)
    if (row.part == "field" && row.note.empty()) {
      CHECK(row.build_cpu_seconds > 0);
      CHECK((row.order > 0) == (row.resolution == 23));
    }
  const std::string table = study_table(rows);
  CHECK(static_cast<std::size_t>(std::count(table.begin(), table.end(), '\n')) == rows.size() + 3);
}

TEST_CASE("the study shows an order that is negative, and a dash for none", "[particles][study]") {
  std::vector<StudyRow> rows(2);
  for (StudyRow& row : rows) row.part = "field";
  rows[1].order = -0.25;
  rows[1].relative = -0.0125;
  const std::string table = study_table(rows);
  CHECK_THAT(table, Contains(" -0.25 "));
  CHECK_THAT(table, Contains(" -0.0125\n"));
  CHECK_THAT(table, Contains(" -\n"));
}

TEST_CASE("costs are the least of five runs, and CPU time does not count waiting",
          "[particles][study]") {
  int n_runs = 0, n_prepared = 0;
  const Cost waiting = least_cost(
      [&] {
        CHECK(n_prepared == ++n_runs);
        std::this_thread::sleep_for(std::chrono::milliseconds(n_runs == 3 ? 20 : 60));
      },
      [&] { ++n_prepared; });
  CHECK(n_runs == 5);
  CHECK(waiting.wall >= 0.02);
  CHECK(waiting.wall < 0.06);
  CHECK(waiting.cpu < 0.01);
}
