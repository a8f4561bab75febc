// Which PE makes a voxel: the decision of its home, without a run.
#include "collide/parallel/voxel_home.hpp"

#include "tests/support/catch.hpp"

#include <array>
#include <cstdint>
#include <span>
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
  const std::vector<std::span<const VoxelRecord>> spans(lists.begin(), lists.end());
  const auto answers = answers_to(spans, WithinModel::skip);
  std::array<std::uint32_t, N> result{};
  for (std::uint32_t v = 0; v < n_voxels; ++v) {
    std::uint32_t n_makers = 0;
    for (std::size_t pe = 0; pe < N; ++pe) {
      REQUIRE(answers[pe][v].n_senders == N);
      n_makers += answers[pe][v].makes_it;
      result[pe] += answers[pe][v].makes_it;
    }
    REQUIRE(n_makers == 1);
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

TEST_CASE("a PE with less than half of the objects of another one makes no voxel",
          "[collide][parallel][voxel_home]") {
  CHECK(made(std::array{100U, 49U}) == std::array{n_voxels, 0U});
  CHECK(made(std::array{1U, 3U}) == std::array{0U, n_voxels});
  const auto three = made(std::array{10U, 100U, 60U});
  CHECK(three[0] == 0);
  CHECK(three[1] + three[2] == n_voxels);
}

}  // namespace tess::collide
