// Which PE makes a voxel: the decision of its home, without a run.
#include "collide/parallel/voxel_home.hpp"

#include "tests/support/catch.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tess::collide {
namespace {

constexpr std::uint32_t n_voxels = 4000;

/// The records of a PE that has `n` objects of a model in each voxel.
std::vector<VoxelRecord> records_of(std::uint32_t model, std::uint32_t n) {
  std::vector<VoxelRecord> records;
  for (std::uint32_t v = 0; v < n_voxels; ++v)
    records.push_back({Index4{static_cast<std::int32_t>(v), 0, 0, 0}, n, 0, ModelId{model}});
  return records;
}

/// How many voxels each PE makes. Each voxel has one maker, and all PEs send to it.
template <std::size_t N>
std::array<std::uint32_t, N> made(const std::array<std::uint32_t, N>& n_objects) {
  std::vector<std::vector<VoxelRecord>> lists;
  for (std::uint32_t pe = 0; pe < N; ++pe) lists.push_back(records_of(pe, n_objects[pe]));
  std::vector<RecordsOf> all;
  for (std::int32_t pe = 0; const std::vector<VoxelRecord>& list : lists)
    all.push_back({PeId{pe++}, list});
  const auto answers = answers_to(all, WithinModel::skip);
  std::array<std::uint32_t, N> result{};
  for (std::uint32_t v = 0; v < n_voxels; ++v) {
    for (std::size_t pe = 0; pe < N; ++pe) {
      REQUIRE(answers[pe][v].n_senders == N);
      REQUIRE(answers[pe][v].maker == answers[0][v].maker);
    }
    ++result.at(static_cast<std::size_t>(answers[0][v].maker.value));
  }
  return result;
}

}  // namespace

TEST_CASE("PEs with nearly as many objects share the voxels", "[collide][parallel][voxel_home]") {
  // 0.5 ± 0.05 of 4 000 is six standard deviations of a fair draw.
  for (const auto& n_objects :
       {std::array{64U, 64U}, std::array{65U, 64U}, std::array{64U, 65U}, std::array{100U, 50U}}) {
    CAPTURE(n_objects);
    for (const std::uint32_t n : made(n_objects))
      CHECK(std::abs(n / double{n_voxels} - 0.5) < 0.05);
  }
  for (const std::uint32_t n : made(std::array{7U, 8U, 9U, 10U}))
    CHECK(std::abs(n / double{n_voxels} - 0.25) < 0.05);
}

TEST_CASE("two PEs with as many objects each make half of the voxels of a row",
          "[collide][parallel][voxel_home]") {
  CHECK(made(std::array{64U, 64U}) == std::array{n_voxels / 2, n_voxels / 2});
}

TEST_CASE("a PE with less than half of the objects of another one makes no voxel",
          "[collide][parallel][voxel_home]") {
  CHECK(made(std::array{100U, 49U}) == std::array{n_voxels, 0U});
  CHECK(made(std::array{1U, 3U}) == std::array{0U, n_voxels});
  const auto three = made(std::array{10U, 100U, 60U});
  CHECK(three[0] == 0);
  CHECK(three[1] + three[2] == n_voxels);
}

TEST_CASE("the PE where a voxel is remains its maker, whatever it has",
          "[collide][parallel][voxel_home]") {
  std::vector<VoxelRecord> many = records_of(0, 100), few = records_of(1, 1);
  for (std::size_t v = 0; v < n_voxels; v += 3) few[v].is_here = 1;
  const std::array all{RecordsOf{PeId{4}, many}, RecordsOf{PeId{7}, few}};
  const auto answers = answers_to(all, WithinModel::skip);
  for (std::size_t v = 0; v < n_voxels; ++v) {
    REQUIRE(answers[0][v].maker == PeId{v % 3 == 0 ? 7 : 4});
    REQUIRE(answers[1][v].maker == PeId{v % 3 == 0 ? 7 : 4});
  }
}

}  // namespace tess::collide
