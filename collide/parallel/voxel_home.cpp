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
  std::uint32_t maker = 0;
  std::uint64_t rank = 0;  // of the maker

  /// A PE makes the voxel only if few objects have to be sent to it. Of such PEs each gets its share
  /// of the voxels: the hash ranks them, differently for each voxel.
  void offer(const VoxelRecord& record, std::uint32_t pe) {
    if (2 * std::uint64_t{record.n_natives + record.n_visitors} < most) return;
    const std::uint64_t own_rank = mix(IndexHash<Index4>{}(record.voxel) ^ mix(pe + 1));
    if (own_rank < rank) return;
    rank = own_rank;
    maker = pe;
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

std::vector<std::vector<VoxelAnswer>> answers_to(
    std::span<const std::span<const VoxelRecord>> records, WithinModel within_model) {
  std::vector<std::vector<VoxelAnswer>> answers(records.size());
  if (records.size() == 1) {
    for (const VoxelRecord& record : records[0])
      answers[0].push_back({can_have_pairs(record, within_model) ? 1U : 0U, 1});
    return answers;
  }
  boost::unordered_flat_map<Index4, Totals, IndexHash<Index4>> voxels;
  for (std::uint32_t pe = 0; pe < records.size(); ++pe)
    for (const VoxelRecord& record : records[pe]) {
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
  for (std::uint32_t pe = 0; pe < records.size(); ++pe)
    for (const VoxelRecord& record : records[pe])
      voxels.find(record.voxel)->second.offer(record, pe);
  for (std::uint32_t pe = 0; pe < records.size(); ++pe)
    for (const VoxelRecord& record : records[pe]) {
      const Totals& voxel = voxels.find(record.voxel)->second;
      answers[pe].push_back({can_have_pairs(voxel.all, within_model) ? voxel.n_senders : 0,
                             voxel.maker == pe ? 1U : 0U});
    }
  return answers;
}

}  // namespace tess::collide
