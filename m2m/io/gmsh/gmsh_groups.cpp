#include "m2m/io/gmsh/gmsh_groups.hpp"

#include "m2m/io/field_reader.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <set>

namespace tess::m2m {

void GmshGroups::read_names(GmshScanner& file) {
  const std::size_t n = file.checked_count(file.number_as_text<std::uint32_t>(), "names", 6);
  for (std::size_t i = 0; i < n; ++i) {
    const int dimension = file.number_as_text<int>();
    const int group = file.number_as_text<int>();
    names_[{dimension, group}] = clean_name(file.quoted());
  }
  file.close("$EndPhysicalNames");
}

void GmshGroups::read_entities(GmshScanner& file, const GmshFormat& format, bool partitioned) {
  if (format.binary) file.end_of_line();
  file.set_binary(format.binary);
  if (partitioned) {
    file.skip<std::uint64_t>(1);  // the number of partitions
    const auto n_ghosts = file.count<std::uint64_t>("ghost entities", 8);
    file.skip<int>(2 * n_ghosts);
  }
  std::array<std::size_t, 4> n{};  // per dimension
  for (std::size_t& each : n) each = file.count<std::uint64_t>("entities", 20);
  for (int dimension = 0; dimension < 4; ++dimension)
    for (std::size_t i = 0; i < n[static_cast<std::size_t>(dimension)]; ++i) {
      const int tag = file.number<int>();
      if (partitioned) {
        file.skip<int>(2);  // the parent
        file.skip<int>(file.count<std::uint64_t>("partitions", 4));
      }
      // A place or a box; points have boxes in version 4.0.
      file.skip<double>(dimension == 0 && !format.is_40 ? 3 : 6);
      std::vector<int>& groups = of_entity_[{dimension, tag}];
      groups.resize(file.count<std::uint64_t>("physical groups", 4));
      // The sign is that of the orientation.
      for (int& group : groups)
        group = static_cast<int>(std::abs(std::int64_t{file.number<int>()}));
      if (dimension > 0) file.skip<int>(file.count<std::uint64_t>("boundaries", 4));
    }
  file.set_binary(false);
  file.close(partitioned ? "$EndPartitionedEntities" : "$EndEntities");
}

std::span<const int> GmshGroups::of_entity(int dimension, int tag) const {
  const auto found = of_entity_.find({dimension, tag});
  if (found == of_entity_.end()) return {};
  return found->second;
}

std::string GmshGroups::name_of(int dimension, int group) const {
  const auto found = names_.find({dimension, group});
  return found == names_.end() ? std::string() : found->second;
}

void GmshBlocks::add(std::span<const int> groups, std::size_t n) {
  const int group = groups.empty() ? 0 : groups.front();
  if (runs_.empty() || runs_.back().first != group) runs_.emplace_back(group, 0);
  runs_.back().second += n;
  for (std::size_t g = 1; g < groups.size(); ++g) add_to_last(groups[g]);
}

void GmshBlocks::finish(const GmshGroups& groups, TetMesh& mesh) const {
  const auto name_of = [&](int group) { return groups.name_of(mesh.dimension, group); };
  std::set<int> used;
  std::int64_t next = 1;
  for (const auto& [group, n] : runs_) next = std::max<std::int64_t>(next, std::int64_t{group} + 1);
  if (next == 1) return;
  for (const auto& [group, n] : runs_)
    mesh.blocks.push_back(
        {group != 0 && used.insert(group).second ? group : next++, name_of(group), n});
  for (const auto& [group, n] : n_as_well_) {
    const std::string name = name_of(group);
    mesh.skipped.push_back(
        {"also of group " + (name.empty() ? std::to_string(group) : "'" + name + "'"), n});
  }
}

}  // namespace tess::m2m
