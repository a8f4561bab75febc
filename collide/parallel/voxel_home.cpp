#include "collide/parallel/voxel_home.hpp"

#include "runtime/core/hash.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

#include <algorithm>

namespace tess::collide {
namespace {

/// What all PEs have for a voxel.
struct Totals {
  VoxelRecord all;
  std::uint32_t n_senders = 0;
  std::uint32_t most = 0;  // objects of one PE
  PeId maker{};
  bool is_settled = false;
  std::uint64_t rank = 0;  // of the maker

  /// A PE makes the voxel only if few objects have to be sent to it, or if the voxel is there
  /// already.
  void offer(const VoxelRecord& record, PeId pe) {
    if (record.is_here != 0) {
      maker = pe;
      is_settled = true;
    }
    if (is_settled || 2 * std::uint64_t{record.n_natives + record.n_visitors} < most) return;
    const std::uint64_t own_rank = rank_of(record.voxel, pe);
    if (own_rank < rank) return;
    rank = own_rank;
    maker = pe;
  }

 private:
  /// Of such PEs each gets its share of the voxels: a hash ranks them, differently for each block of
  /// 2 × 2 × 2 voxels, and in reverse for every other voxel of the block. So two PEs have half of
  /// each block, where a hash per voxel leaves the shares to chance.
  static std::uint64_t rank_of(const Index4& voxel, PeId pe) {
    const Index4 block{voxel.x >> 1, voxel.y >> 1, voxel.z >> 1, voxel.w};
    const std::uint64_t rank =
        mix(IndexHash<Index4>{}(block) ^ mix(static_cast<std::uint64_t>(pe.value) + 1));
    return ((voxel.x ^ voxel.y ^ voxel.z) & 1) == 0 ? rank : ~rank;
  }
};

bool can_have_pairs(const VoxelRecord& all, WithinModel within_model) {
  return all.n_natives > 0 && all.n_natives + all.n_visitors > 1 &&
         (within_model == WithinModel::test || all.several_models != 0);
}

}  // namespace

std::size_t home_of(const Index4& voxel, std::size_t n_pes) {
  return n_pes == 1 ? 0 : (IndexHash<Index4>{}(voxel) >> 32) % n_pes;
}

std::vector<std::vector<VoxelAnswer>> answers_to(std::span<const RecordsOf> all,
                                                 WithinModel within_model) {
  std::vector<std::vector<VoxelAnswer>> answers(all.size());
  if (all.size() == 1) {
    for (const VoxelRecord& record : all[0].records)
      answers[0].push_back({can_have_pairs(record, within_model) ? 1U : 0U, all[0].pe});
    return answers;
  }
  boost::unordered_flat_map<Index4, Totals, IndexHash<Index4>> voxels;
  for (const auto& [pe, records] : all)
    for (const VoxelRecord& record : records) {
      const auto [at, is_new] = voxels.try_emplace(record.voxel, Totals{record});
      Totals& voxel = at->second;
      ++voxel.n_senders;
      voxel.most = std::max(voxel.most, record.n_natives + record.n_visitors);
      if (is_new) continue;
      voxel.all.n_natives += record.n_natives;
      voxel.all.n_visitors += record.n_visitors;
      if (record.several_models != 0 || record.model != voxel.all.model)
        voxel.all.several_models = 1;
    }
  for (const auto& [pe, records] : all)
    for (const VoxelRecord& record : records) voxels.find(record.voxel)->second.offer(record, pe);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const VoxelRecord& record : all[i].records) {
      const Totals& voxel = voxels.find(record.voxel)->second;
      answers[i].push_back(
          {can_have_pairs(voxel.all, within_model) ? voxel.n_senders : 0, voxel.maker});
    }
  return answers;
}

}  // namespace tess::collide
