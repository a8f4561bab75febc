#include "collide/parallel/voxel_home.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

namespace tess::collide {
namespace {

/// What all PEs have for a voxel.
struct Totals {
  VoxelRecord all;
  std::uint32_t n_senders = 0;
  std::uint32_t most = 0;  // objects of the PE that makes it
  std::uint32_t maker = 0;
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
      const std::uint32_t n = record.n_natives + record.n_visitors;
      // Of equal PEs the one that the hash says, so that they share the voxels.
      const bool prefers_later = (IndexHash<Index4>{}(record.voxel) >> 20 & 1U) != 0;
      if (n > voxel.most || (n == voxel.most && prefers_later)) {
        voxel.most = n;
        voxel.maker = pe;
      }
      if (is_new) continue;
      voxel.all.n_natives += record.n_natives;
      voxel.all.n_visitors += record.n_visitors;
      if (record.several_models != 0 || record.model != voxel.all.model)
        voxel.all.several_models = 1;
    }
  for (std::uint32_t pe = 0; pe < records.size(); ++pe)
    for (const VoxelRecord& record : records[pe]) {
      const Totals& voxel = voxels.find(record.voxel)->second;
      answers[pe].push_back({can_have_pairs(voxel.all, within_model) ? voxel.n_senders : 0,
                             voxel.maker == pe ? 1U : 0U});
    }
  return answers;
}

}  // namespace tess::collide
