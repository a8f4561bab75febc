// What the readers of meshes and of fields in MSH files share: the format of a file, and the tags
// by which it names nodes and elements.
#pragma once

#include "m2m/io/gmsh/gmsh_scanner.hpp"
#include "m2m/mesh.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace tess::m2m {

struct GmshFormat {
  bool legacy = false;  ///< 2.0 to 2.2, otherwise 4.0 or 4.1
  bool is_40 = false;
  bool binary = false;
};

/// True for a section without nodes or elements of its own, other than the values that gmsh_fields()
/// reads. Any other one that the reader of meshes does not know is reported as skipped.
inline bool gmsh_section_beside_mesh(std::string_view section) {
  constexpr std::array<std::string_view, 11> beside{
      "$Comments",      "$ElementData",         "$Entities", "$GhostElements",
      "$MeshVersion",   "$InterpolationScheme", "$NodeData", "$Parametrizations",
      "$PhysicalNames", "$PartitionedEntities", "$Periodic"};
  return std::ranges::find(beside, section) != beside.end();
}

/// Reads $MeshFormat up to its end; the scanner stands behind the name of the section.
inline GmshFormat read_gmsh_format(GmshScanner& file) {
  const auto version = file.number_as_text<double>();
  const int kind = file.number_as_text<int>();
  const int word_bytes = file.number_as_text<int>();
  // 2.0 and 2.1 are laid out as 2.2; their third label of an element is not used.
  const bool legacy = version == 2 || version == 2.1 || version == 2.2;
  if (!legacy && version != 4 && version != 4.1)
    file.refuse(
        "is MSH ", version,
        "; only 2.0 to 2.2, 4.0 and 4.1 are supported: convert it with gmsh -save -format msh41");
  if (kind != 0 && kind != 1) file.damaged("file type ", kind);
  if (word_bytes != 8)
    file.refuse("has numbers of ", word_bytes,
                " bytes; only 8 are supported: save it again with gmsh");
  if (kind == 1) {
    file.end_of_line();
    file.set_binary(true);
    const int one = file.number<int>();
    file.set_binary(false);
    if (one == 0x01000000)
      file.refuse("has another byte order than this machine; save it as ASCII");
    if (one != 1) file.damaged("the byte-order mark is ", one);
  }
  file.close("$EndMeshFormat");
  return {legacy, version == 4, kind == 1};
}

/// The tags of vertices and of the elements that are cells, in the order of the file.
struct GmshTags {
  std::vector<std::uint64_t> nodes{};
  std::vector<std::uint64_t> cells{};
};

/// Maps tags, which may have gaps of any size, to positions.
class GmshTagMap {
 public:
  void build(const std::vector<std::uint64_t>& tags, const GmshScanner& file, const char* what) {
    const std::uint64_t last = tags.empty() ? 0 : *std::max_element(tags.begin(), tags.end());
    sorted_.clear();
    dense_ = last / 4 <= tags.size() + 1024;
    if (dense_) {
      place_.assign(static_cast<std::size_t>(last) + 1, -1);
      for (std::size_t i = 0; i < tags.size(); ++i) {
        VertexId& place = place_[tags[i]];
        if (place >= 0) twice(tags[i], file, what);
        place = static_cast<VertexId>(i);
      }
      return;
    }
    sorted_.reserve(tags.size());
    for (std::size_t i = 0; i < tags.size(); ++i)
      sorted_.emplace_back(tags[i], static_cast<VertexId>(i));
    std::sort(sorted_.begin(), sorted_.end());
    for (std::size_t i = 1; i < sorted_.size(); ++i) {
      if (sorted_[i].first == sorted_[i - 1].first) twice(sorted_[i].first, file, what);
    }
  }

  /// The position, or -1 if nothing has the tag.
  [[nodiscard]] VertexId find(std::uint64_t tag) const {
    if (dense_) return tag < place_.size() ? place_[tag] : -1;
    const auto found = std::lower_bound(sorted_.begin(), sorted_.end(),
                                        std::pair<std::uint64_t, VertexId>(tag, -1));
    return found != sorted_.end() && found->first == tag ? found->second : -1;
  }

 private:
  static void twice(std::uint64_t tag, const GmshScanner& file, const char* what) {
    file.refuse(what, " tag ", tag, " occurs twice; write the mesh again");
  }
  bool dense_ = true;
  std::vector<VertexId> place_;
  std::vector<std::pair<std::uint64_t, VertexId>> sorted_;
};

}  // namespace tess::m2m
