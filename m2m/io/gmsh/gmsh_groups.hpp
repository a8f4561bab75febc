// The physical groups of an MSH file: their names, and the groups of each entity of the model. Version
// 2 writes the group beside each element instead.
#pragma once

#include "m2m/io/gmsh/gmsh_format.hpp"

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tess::m2m {

class GmshGroups {
 public:
  /// Reads $PhysicalNames, or $Entities and $PartitionedEntities of version 4, up to the end.
  void read_names(GmshScanner& file);
  void read_entities(GmshScanner& file, const GmshFormat& format, bool partitioned);

  /// The groups of an entity, in the order of the file.
  [[nodiscard]] std::span<const int> of_entity(int dimension, int tag) const;
  /// Empty if the group has none.
  [[nodiscard]] std::string name_of(int dimension, int group) const;

 private:
  using Key = std::pair<int, int>;  // dimension, tag
  std::map<Key, std::string> names_;
  std::map<Key, std::vector<int>> of_entity_;
};

/// Collects the cells of a mesh by group as they are read, and makes its blocks of them.
class GmshBlocks {
 public:
  /// The next `n` cells, all of an element of these groups.
  void add(std::span<const int> groups, std::size_t n);
  /// The last element is one of this group as well.
  void add_to_last(int group) { ++n_as_well_[group]; }
  /// Fills mesh.blocks: one per run of cells of a group, which is named after it. The first run has
  /// the number of the group; others, and cells of no group, have free numbers. No block if there
  /// are no groups. An element of several groups is in the first one's block; the others are
  /// reported in mesh.skipped.
  void finish(const GmshGroups& groups, TetMesh& mesh) const;

 private:
  std::vector<std::pair<int, std::size_t>> runs_;  // group (0: none), cells
  std::map<int, std::uint64_t> n_as_well_;         // elements, per group
};

}  // namespace tess::m2m
