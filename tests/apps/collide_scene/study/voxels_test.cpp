// The study of voxels: the same pairs for every voxel size, and the error of boxes against exact triangles.
#include "apps/collide_scene/study/voxels.hpp"

#include "tests/support/catch.hpp"

using namespace collide_scene;

TEST_CASE("every voxel size of the study gives the same pairs", "[apps][collide_scene]") {
  kit::Progress progress(nullptr);
  const Scene scene = make_scene("planes:4096");
  const std::vector<VoxelRow> rows = study_voxels(scene, {}, progress);
  REQUIRE(rows.size() == 16);
  CHECK(agrees(rows));
  const VoxelRow &boxes = rows.front(), &triangles = rows.back();
  CHECK(boxes.objects == "boxes");
  CHECK(triangles.objects == "triangles");
  CHECK(boxes.answer.n_pairs == boxes.answer.n_candidates);
  CHECK(triangles.answer.n_candidates == boxes.answer.n_pairs);
  CHECK(triangles.answer.n_pairs > 0);
  CHECK(triangles.false_positive_rate == 0);
  CHECK(boxes.false_positive_rate == Approx(1 - static_cast<double>(triangles.answer.n_pairs) /
                                                    static_cast<double>(boxes.answer.n_pairs)));
  for (const VoxelRow& row : rows) CHECK((row.note.empty() && row.cpu_seconds > 0));
  CHECK(rows[0].voxel_size < rows[7].voxel_size);
}

TEST_CASE("the study compares with the voxel size of the library, whatever the options give",
          "[apps][collide_scene]") {
  kit::Progress progress(nullptr);
  const Scene scene = make_scene("planes:4096");
  const std::vector<VoxelRow> expected = study_voxels(scene, {}, progress);
  Options options;
  for (const double voxel_size : {1e-9, 3.0}) {  // the first is refused
    options.rules.voxel_size = voxel_size;
    const std::vector<VoxelRow> rows = study_voxels(scene, options, progress);
    CHECK(agrees(rows));
    REQUIRE(rows.size() == expected.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      CHECK(rows[i].voxel_size == expected[i].voxel_size);
      CHECK(rows[i].false_positive_rate == expected[i].false_positive_rate);
    }
  }
}

TEST_CASE("a study in which one voxel size loses a pair does not agree", "[apps][collide_scene]") {
  kit::Progress progress(nullptr);
  std::vector<VoxelRow> rows = study_voxels(make_scene("boxes:500"), {}, progress);
  REQUIRE(rows.size() == 8);
  CHECK(agrees(rows));
  rows[3].agrees = false;
  CHECK_FALSE(agrees(rows));
  CHECK_THAT(voxel_report().table(rows), Contains("OTHER PAIRS"));
  rows[3].note = "too small";  // a refusal is no wrong answer
  CHECK(agrees(rows));
  CHECK_THAT(voxel_report().csv(rows), Contains("too small"));
}
