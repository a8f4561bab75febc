#include "m2m/io/gmsh/gmsh_reader.hpp"

#include "m2m/io/file_format.hpp"
#include "m2m/io/gmsh/gmsh_elements.hpp"
#include "m2m/io/gmsh/gmsh_format.hpp"
#include "m2m/io/gmsh/gmsh_groups.hpp"
#include "m2m/io/gmsh/gmsh_scanner.hpp"
#include "m2m/surface/sides.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace tess::m2m {
namespace {

class GmshReader {
 public:
  GmshReader(const std::string& path, std::string_view bytes, std::int32_t dimension,
             GmshTags* tags)
      : file_(path, bytes), tags_out_(tags) {
    mesh_.name = path;
    mesh_.dimension = dimension;
  }

  TetMesh read() {
    bool have_nodes = false, have_elements = false;
    bool tags_known = false;  // sections may be repeated
    for (file_.skip_blanks(); !file_.at_end(); file_.skip_blanks()) {
      const std::string section(file_.word());
      if (section == "$MeshFormat") {
        format_ = read_gmsh_format(file_);
        have_format_ = true;
      } else if (section == "$PhysicalNames") {
        groups_.read_names(file_);
      } else if (section == "$Entities" || section == "$PartitionedEntities") {
        need_format();
        groups_.read_entities(file_, format_, section == "$PartitionedEntities");
      } else if (section == "$Nodes") {
        need_format();
        file_.set_binary(format_.binary);
        format_.legacy ? nodes_22() : nodes_4();
        file_.set_binary(false);
        file_.close("$EndNodes");
        have_nodes = true;
        tags_known = false;
      } else if (section == "$Elements") {
        need_format();
        if (!have_nodes) file_.damaged("$Elements before $Nodes");
        if (!std::exchange(tags_known, true)) tags_.build(node_tags_, file_, "node");
        file_.set_binary(format_.binary);
        format_.legacy ? elements_22() : elements_4();
        file_.set_binary(false);
        file_.close("$EndElements");
        have_elements = true;
      } else if (section == "$ParametricNodes") {
        file_.refuse(
            "has $ParametricNodes; only $Nodes are supported: save it with "
            "-setnumber Mesh.SaveParametric 0");
      } else if (section == "$NOD" || section == "$ELM") {
        file_.refuse(
            "is MSH 1; only 2.0 to 2.2, 4.0 and 4.1 are supported: convert it with gmsh -save "
            "-format msh41");
      } else if (section.size() > 1 && section[0] == '$' && section.size() < 64) {
        if (!gmsh_section_beside_mesh(section)) ++n_sections_[section];
        file_.skip_to("$End" + section.substr(1));
      } else {
        file_.damaged("expected a section such as $Nodes");
      }
    }
    if (!have_nodes) file_.damaged("$Nodes is missing");
    if (!have_elements) file_.damaged("$Elements is missing");
    if (!tags_known) tags_.build(node_tags_, file_, "node");  // finds tags that occur twice
    elements_.finish();
    find_sides();
    for (const GmshElement& type : gmsh_elements) {
      const std::uint64_t n = n_skipped_[static_cast<std::size_t>(type.number)];
      if (n > 0) mesh_.skipped.push_back({std::string(type.name), n});
    }
    for (const auto& [section, n] : n_sections_)
      mesh_.skipped.push_back({"section " + clean_name(section), n});
    blocks_.finish(groups_, mesh_);
    if (tags_out_ != nullptr) {
      tags_out_->nodes = std::move(node_tags_);
      tags_out_->cells = std::move(cell_tags_);
    }
    return std::move(mesh_);
  }

 private:
  void need_format() const {
    if (!have_format_) file_.damaged("$MeshFormat is missing");
  }

  void start_nodes(std::size_t n) {
    const std::size_t all = mesh_.n_points() + n;
    if (all > static_cast<std::size_t>(std::numeric_limits<VertexId>::max())) {
      file_.refuse("has ", all, " vertices; at most 2147483647 fit in one mesh, split it");
    }
    mesh_.points.reserve(all);
    node_tags_.reserve(all);
  }

  Point point() {
    const auto x = file_.number<double>();
    const auto y = file_.number<double>();
    const auto z = file_.number<double>();
    return {x, y, z};
  }

  /// The tag of a node before version 4.1.
  std::uint64_t positive_tag() {
    const int tag = file_.number<int>();
    if (tag < 0) file_.damaged("node tag ", tag);
    return static_cast<std::uint64_t>(tag);
  }

  /// Version 2.2 writes counts as text, also in binary files.
  std::size_t count_22(std::string_view what, std::size_t bytes_each) {
    const auto n = file_.number_as_text<std::uint64_t>();
    if (format_.binary) file_.end_of_line();
    return file_.checked_count(n, what, bytes_each);
  }

  void nodes_22() {
    const std::size_t n = count_22("nodes", 28);
    start_nodes(n);
    for (std::size_t i = 0; i < n; ++i) {
      node_tags_.push_back(positive_tag());
      mesh_.points.push_back(point());
    }
  }

  /// The dimension and the tag of the entity of a block.
  std::pair<int, int> entity_of_block() {
    const int first = file_.number<int>();
    const int second = file_.number<int>();
    return format_.is_40 ? std::pair(second, first) : std::pair(first, second);
  }

  void nodes_4() {
    if (format_.binary) file_.end_of_line();
    const std::size_t bytes_each = format_.is_40 ? 28 : 32;
    const auto n_blocks = file_.count<std::uint64_t>("blocks of nodes", 20);
    const auto n = file_.count<std::uint64_t>("nodes", bytes_each);
    if (!format_.is_40) file_.skip<std::uint64_t>(2);  // least and greatest tag
    start_nodes(n);
    const std::size_t end = mesh_.n_points() + n;
    for (std::size_t block = 0; block < n_blocks; ++block) {
      const int dimension = entity_of_block().first;
      const int parametric = file_.number<int>();
      const auto m = file_.count<std::uint64_t>("nodes in a block", bytes_each);
      if (dimension < 0 || dimension > 3 || (parametric != 0 && parametric != 1)) {
        file_.damaged("a block of nodes of dimension ", dimension, ", parametric ", parametric);
      }
      if (m > end - mesh_.n_points()) file_.damaged("more nodes than the ", n, " announced");
      for (std::size_t i = 0; i < m && !format_.is_40; ++i)
        node_tags_.push_back(file_.number<std::uint64_t>());
      for (std::size_t i = 0; i < m; ++i) {
        if (format_.is_40) node_tags_.push_back(positive_tag());
        mesh_.points.push_back(point());
        if (parametric == 1) file_.skip<double>(static_cast<std::size_t>(dimension));
      }
    }
    if (mesh_.n_points() != end)
      file_.damaged(n, " nodes announced, ", n - (end - mesh_.n_points()), " found");
  }

  /// The type with this number. Refuses unknown types, and those of the dimension of the mesh that
  /// are not supported.
  const GmshElement& element_type(int number) const {
    const GmshElement* const type = gmsh_element(number);
    if (type == nullptr)
      file_.refuse("has elements of unknown gmsh type ", number, "; ", supported());
    if (type->dimension == mesh_.dimension && !gmsh_supported(number)) {
      file_.refuse("has elements of type ", type->name, "; ", supported(),
                   ": mesh it with one of these");
    }
    return *type;
  }

  /// Reads the vertices of an element with the tag `label`, in these physical groups. `entity`: that
  /// of the model that it meshes (version 2.2, otherwise 0).
  template <class Tag>
  void element(const GmshElement& type, Tag label, std::span<const int> groups, int entity = 0) {
    const auto known = gmsh_supported(type.number);
    const bool is_cell = known && type.dimension == mesh_.dimension;
    const bool is_side = known && type.dimension + 1 == mesh_.dimension && !groups.empty();
    if (!is_cell && !is_side) {
      ++n_skipped_[static_cast<std::size_t>(type.number)];
      return file_.skip<Tag>(static_cast<std::size_t>(type.n_vertices));
    }
    ElementVertices ids{};
    const auto corners = std::span(ids).first(static_cast<std::size_t>(type.n_vertices));
    for (VertexId& vertex : corners) {
      const Tag tag = file_.number<Tag>();
      vertex = tag < Tag{0} ? -1 : tags_.find(static_cast<std::uint64_t>(tag));
      if (vertex < 0) {
        file_.refuse(type.name, " ", elements_.n_elements(), " names node ", tag,
                     ", which does not exist; write the mesh again");
      }
    }
    if (is_side) {
      for (const int group : groups) sides_[group].push_back({*known, ids, type.number});
      return;
    }
    if (*known == ElementType::tet10) std::swap(ids[8], ids[9]);
    if (*known == ElementType::hex27) reorder(ids, gmsh_hex27);
    const int group = groups.empty() ? 0 : groups.front();
    if (format_.legacy && is_repeated(type, ids, entity, group)) {
      // gmsh writes values for the last tag
      if (tags_out_ != nullptr) cell_tags_.back() = static_cast<std::uint64_t>(label);
      return blocks_.add_to_last(group);
    }
    if (tags_out_ != nullptr) cell_tags_.push_back(static_cast<std::uint64_t>(label));
    const std::size_t n_before = mesh_.n_tets();
    elements_.add(*known, corners);
    blocks_.add(groups, mesh_.n_tets() - n_before);
  }

  /// Version 2.2 has one physical group per element. Of an entity in several groups gmsh writes
  /// each element once for each group, in a row, every time with another tag.
  bool is_repeated(const GmshElement& type, const ElementVertices& ids, int entity, int group) {
    const Cell last = std::exchange(last_cell_, {&type, ids, entity, group});
    return last.type == &type && last.entity == entity && last.group != group &&
           std::equal(ids.begin(), ids.begin() + type.n_vertices, last.ids.begin());
  }

  void elements_22() {
    const std::size_t n = count_22("elements", 8);
    for (std::size_t i = 0; i < n;) {
      std::size_t group = 1;
      int tag = 0;
      int number = 0;
      int n_labels = 0;
      if (format_.binary) {
        number = file_.number<int>();
        group = file_.count<int>("elements in a block", 8);
        n_labels = file_.number<int>();
        if (group == 0 || group > n - i) file_.damaged("a block of ", group, " elements");
      } else {
        tag = file_.number<int>();
        number = file_.number<int>();
        n_labels = file_.number<int>();
      }
      const GmshElement& type = element_type(number);
      if (n_labels < 0) file_.damaged(n_labels, " labels");
      for (std::size_t k = 0; k < group; ++k) {
        if (format_.binary) tag = file_.number<int>();
        std::array<int, 2> labels{};  // the physical group, the entity
        for (std::size_t l = 0; l < static_cast<std::size_t>(n_labels); ++l) {
          const int label = file_.number<int>();
          if (l < labels.size()) labels[l] = label;
        }
        labels[0] = static_cast<int>(std::abs(std::int64_t{labels[0]}));
        element<int>(type, tag, std::span(labels).first(labels[0] == 0 ? 0 : 1), labels[1]);
      }
      i += group;
    }
  }

  void elements_4() {
    if (format_.binary) file_.end_of_line();
    const std::size_t bytes_each = format_.is_40 ? 8 : 16;
    const auto n_blocks = file_.count<std::uint64_t>("blocks of elements", 20);
    const auto n = file_.count<std::uint64_t>("elements", bytes_each);
    if (!format_.is_40) file_.skip<std::uint64_t>(2);  // least and greatest tag
    std::size_t found = 0;
    for (std::size_t block = 0; block < n_blocks; ++block) {
      const auto [dimension, entity] = entity_of_block();
      const GmshElement& type = element_type(file_.number<int>());
      const auto m = file_.count<std::uint64_t>("elements in a block", bytes_each);
      const std::span<const int> groups = groups_.of_entity(dimension, entity);
      if (type.dimension == mesh_.dimension) mesh_.tets.reserve(mesh_.n_tets() + m);
      for (std::size_t i = 0; i < m; ++i)
        if (format_.is_40)
          element<int>(type, file_.number<int>(), groups);
        else
          element<std::uint64_t>(type, file_.number<std::uint64_t>(), groups);
      found += m;
    }
    if (found != n) file_.damaged(n, " elements announced, ", found, " found");
  }

  /// Makes side sets of the elements of one dimension less, by their corners. An element that is no
  /// side of a cell is skipped.
  void find_sides() {
    if (sides_.empty()) return;
    std::vector<bool> marks(mesh_.n_points());
    for (const auto& [group, elements] : sides_)
      for (const GroupedSide& side : elements)
        for (std::size_t k = 0; k < n_vertices(side.type); ++k)
          marks[static_cast<std::size_t>(side.ids[k])] = true;
    const SideFinder finder(mesh_, marks);
    std::vector<Tet> parts;
    for (const auto& [group, elements] : sides_) {
      SideSet set{group, groups_.name_of(mesh_.dimension - 1, group), {}, {}};
      for (const GroupedSide& side : elements) {
        parts.clear();
        split_element(side.type, std::span(side.ids).first(n_vertices(side.type)), parts);
        const std::size_t n_before = set.entries.size();
        for (const Tet& part : parts)
          if (const Side found = finder.find(part); found.tet >= 0) set.entries.push_back(found);
        if (set.entries.size() == n_before) ++n_skipped_[static_cast<std::size_t>(side.number)];
      }
      if (!set.entries.empty()) mesh_.side_sets.push_back(std::move(set));
    }
  }

  [[nodiscard]] const char* supported() const {
    return mesh_.dimension == 3
               ? "of volumes, tet4, tet10, hex8, hex27, prism6 and pyramid5 are supported"
           : mesh_.dimension == 2 ? "of surfaces, triangle3, triangle6 and quad4 are supported"
                                  : "of lines, line2 is supported";
  }

  struct Cell {
    const GmshElement* type = nullptr;
    ElementVertices ids{};
    int entity = 0, group = 0;
  };
  struct GroupedSide {
    ElementType type;
    ElementVertices ids;
    int number;  // of its type
  };

  GmshScanner file_;
  TetMesh mesh_;
  ElementSplitter elements_{mesh_};
  std::vector<std::uint64_t> node_tags_;
  GmshTagMap tags_;
  GmshTags* tags_out_;
  Cell last_cell_;                        // of version 2.2
  std::vector<std::uint64_t> cell_tags_;  // if they are asked for
  GmshGroups groups_;
  GmshBlocks blocks_;
  std::map<int, std::vector<GroupedSide>> sides_;    // per group
  std::array<std::uint64_t, 128> n_skipped_{};       // per type number
  std::map<std::string, std::uint64_t> n_sections_;  // that are skipped
  bool have_format_ = false;
  GmshFormat format_;
};

}  // namespace

TetMesh read_gmsh(const std::string& path, std::string_view bytes, std::int32_t dimension,
                  GmshTags* tags) {
  return GmshReader(path, bytes, dimension, tags).read();
}

extern const FileFormat gmsh_format{
    "a gmsh file (starts with $MeshFormat)",
    [](std::string_view bytes) { return bytes.starts_with("$"); },
    [](const std::string& path, std::string_view bytes, std::int32_t dimension) {
      return read_gmsh(path, bytes, dimension);
    },
    gmsh_fields};

}  // namespace tess::m2m
