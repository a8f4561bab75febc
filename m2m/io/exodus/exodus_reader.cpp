// Reads the cells of an ExodusII file (NetCDF-3 or NetCDF-4) through libexodusII. The library
// trusts the lengths that a file declares, so netcdf_header.hpp refuses a damaged NetCDF-3 header
// first. HDF5 guards the metadata of NetCDF-4 by checksums. The library is not reentrant: one
// thread at a time.
#include "m2m/io/exodus/exodus_elements.hpp"
#include "m2m/io/exodus/exodus_file.hpp"
#include "m2m/io/exodus/exodus_turn.hpp"
#include "m2m/io/file_format.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <exodusII.h>
#include <fmt/core.h>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace tess::m2m {
namespace {

constexpr const char* supported(std::int32_t dimension) {
  return dimension == 3   ? "TET4, TET10, HEX8, HEX27, WEDGE6 and PYRAMID5"
         : dimension == 2 ? "TRI3, TRI6, QUAD4, SHELL3 and SHELL4"
                          : "BAR2 and other lines of two vertices";
}

class ExodusReader : private ExodusFile {
 public:
  using ExodusFile::ExodusFile;

  TetMesh read(std::int32_t dimension) {
    TetMesh mesh;
    mesh.name = path_;
    mesh.dimension = dimension;
    n_axes_ = inquire(EX_INQ_DIM);
    if (n_axes_ < 1 || n_axes_ > 3) {
      fail(ErrorCode::bad_mesh, path_, ": has ", n_axes_,
           " dimensions; give a mesh in 1 to 3 dimensions");
    }
    const std::int64_t n = count(EX_INQ_NODES, "number of nodes");
    const std::int64_t n_blocks = count(EX_INQ_ELEM_BLK, "number of blocks");
    if (n > std::numeric_limits<VertexId>::max()) {
      fail(ErrorCode::bad_mesh, path_, ": has ", n,
           " vertices; at most 2147483647 fit in one mesh, split it");
    }
    if (n > 0) read_points(mesh, n);
    set_name_length();
    ElementSplitter elements(mesh);
    std::size_t k = 0;
    for (const std::int64_t block : ids_of(EX_ELEM_BLOCK, n_blocks))
      read_block(mesh, elements, block, ++k);
    elements.finish();
    for (const auto& [what, name] : exodus_extras)
      if (const std::int64_t n_extra = inquire(what); n_extra > 0)
        mesh.skipped.push_back({name, static_cast<std::uint64_t>(n_extra)});
    read_sets(mesh, elements);
    return mesh;
  }

 private:
  void read_points(TetMesh& mesh, std::int64_t n) const {
    mesh.points.resize(static_cast<std::size_t>(n));
    std::vector<double> values(mesh.n_points());
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(n_axes_); ++axis) {
      check(read_exodus_axis(id_, axis, 0, values), "nc_get_vara of the coordinates");
      for (std::size_t i = 0; i < values.size(); ++i) mesh.points[i][axis] = values[i];
    }
  }

  /// The library numbers the variables of blocks, and of sets, by their place `k`, from 1 on.
  void read_block(TetMesh& mesh, ElementSplitter& elements, std::int64_t id, std::size_t k) {
    const ElementBlock block = block_of(id, k);
    if (block.n_elements == 0) return;
    if (block.n_elements < 0 || block.n_elements > most() - n_elements_)
      damaged("number of elements", -1);
    n_elements_ += block.n_elements;
    if (exodus_dimension(block.type) < mesh.dimension)
      return skip(mesh, block.type, block.n_elements);
    const auto element = exodus_supported(block.type, block.n_vertices_each);
    if (!element || dimension_of(*element) != mesh.dimension) {
      fail(ErrorCode::bad_mesh, path_, ": block ", id, " has elements of type ", block.type,
           " with ", block.n_vertices_each, " vertices; ", supported(mesh.dimension),
           " are supported: mesh it with one of these");
    }
    element_runs_.push_back({n_elements_, elements.n_elements() - (n_elements_ - block.n_elements),
                             exodus_faces_before_edges(block.type, n_axes_)});
    const std::size_t n_tets_before = mesh.n_tets();
    const auto n = static_cast<std::size_t>(block.n_elements);
    const std::size_t n_each = n_vertices(*element);
    check_lengths(fmt::format("connect{}", k), {block.n_elements, block.n_vertices_each});
    std::vector<std::int64_t> vertices(n_each * n);
    check(ex_get_n_conn(id_, EX_ELEM_BLOCK, id, 1, block.n_elements, vertices.data(), nullptr,
                        nullptr),
          "ex_get_conn");
    const auto n_points = static_cast<std::int64_t>(mesh.n_points());
    mesh.tets.reserve(mesh.n_tets() + n);
    std::vector<VertexId> corners(n_each);
    for (std::size_t t = 0; t < n; ++t) {
      for (std::size_t corner = 0; corner < n_each; ++corner) {
        const std::int64_t vertex = vertices[n_each * t + corner];
        if (vertex < 1 || vertex > n_points) {
          fail(ErrorCode::bad_mesh, path_, ": element ", t + 1, " of block ", id, " names vertex ",
               vertex, " of ", n_points, "; write the mesh again");
        }
        corners[corner] = static_cast<VertexId>(vertex - 1);
      }
      elements.add(*element, corners);
    }
    mesh.blocks.push_back({id, name_of(EX_ELEM_BLOCK, id), mesh.n_tets() - n_tets_before});
  }

  static void count_skipped(TetMesh& mesh, const std::string& type, std::int64_t n) {
    const auto known = std::ranges::find(mesh.skipped, type, &Skipped::type);
    if (known == mesh.skipped.end())
      mesh.skipped.push_back({type, static_cast<std::uint64_t>(n)});
    else
      known->n_elements += static_cast<std::uint64_t>(n);
  }
  void skip(TetMesh& mesh, const std::string& type, std::int64_t n) {
    count_skipped(mesh, type, n);
    element_runs_.push_back({n_elements_, std::nullopt, 0});
  }

  /// The block of an element of the file (counted from 1 over all blocks); null if there is none.
  struct Run;
  [[nodiscard]] const Run* run_of(std::int64_t element) const {
    const auto run = std::partition_point(element_runs_.begin(), element_runs_.end(),
                                          [&](const Run& r) { return r.last < element; });
    return element < 1 || run == element_runs_.end() ? nullptr : &*run;
  }

  void read_sets(TetMesh& mesh, const ElementSplitter& elements) {
    const std::int64_t n_side_sets = count(EX_INQ_SIDE_SETS, "number of side sets");
    const std::int64_t n_node_sets = count(EX_INQ_NODE_SETS, "number of node sets");
    std::size_t k = 0;
    for (const std::int64_t id : ids_of(EX_SIDE_SET, n_side_sets))
      read_side_set(mesh, elements, id, ++k);
    k = 0;
    for (const std::int64_t id : ids_of(EX_NODE_SET, n_node_sets)) read_node_set(mesh, id, ++k);
  }

  /// Checks the length of a list of the k-th set.
  void check_list(const char* stem, std::size_t k, std::size_t n) const {
    if (n > 0) check_lengths(fmt::format("{}{}", stem, k), {static_cast<std::int64_t>(n)});
  }

  /// The number of entries and of distribution factors of a set.
  [[nodiscard]] std::pair<std::size_t, std::size_t> size_of(ex_entity_type type,
                                                            std::int64_t id) const {
    std::int64_t n = 0, n_factors = 0;
    check(ex_get_set_param(id_, type, id, &n, &n_factors), "ex_get_set_param");
    if (n < 0 || n > most() || n_factors < 0 || n_factors > most()) damaged("size of a set", -1);
    return {static_cast<std::size_t>(n), static_cast<std::size_t>(n_factors)};
  }

  [[nodiscard]] std::vector<double> factors_of(ex_entity_type type, std::int64_t id, std::size_t k,
                                               std::size_t n) const {
    check_list(type == EX_SIDE_SET ? "dist_fact_ss" : "dist_fact_ns", k, n);
    std::vector<double> factors(n);
    if (n > 0) check(ex_get_set_dist_fact(id_, type, id, factors.data()), "ex_get_set_dist_fact");
    return factors;
  }

  /// Leaves out the sides of skipped elements and the faces of shells, which are counted, and
  /// replaces those of split elements by sides of their cells. The factors of such a set are left out
  /// too, because the file does not say which factor belongs to which side.
  void read_side_set(TetMesh& mesh, const ElementSplitter& cells, std::int64_t id, std::size_t k) {
    const auto [n, n_factors] = size_of(EX_SIDE_SET, id);
    check_list("elem_ss", k, n);
    check_list("side_ss", k, n);
    std::vector<std::int64_t> elements(n), sides(n);
    if (n > 0) check(ex_get_set(id_, EX_SIDE_SET, id, elements.data(), sides.data()), "ex_get_set");
    SideSet set{id, name_of(EX_SIDE_SET, id)};
    for (std::size_t i = 0; i < n; ++i) {
      const Run* const run = run_of(elements[i]);
      if (run != nullptr && !run->shift) continue;
      const GlobalId element = run == nullptr ? -1 : elements[i] - 1 + *run->shift;
      if (run == nullptr || sides[i] < 1 ||
          sides[i] > run->n_faces + static_cast<std::int64_t>(cells.n_sides_of(element))) {
        fail(ErrorCode::bad_mesh, path_, ": side set ", id, " names side ", sides[i],
             " of element ", elements[i], " of ", n_elements_, "; write the mesh again");
      }
      if (sides[i] > run->n_faces)
        cells.append_side(element, sides[i] - run->n_faces, set.entries);
      else
        count_skipped(mesh, "face in a side set", 1);
    }
    if (set.entries.size() == n && mesh.split.empty())
      set.factors = factors_of(EX_SIDE_SET, id, k, n_factors);
    mesh.side_sets.push_back(std::move(set));
  }

  void read_node_set(TetMesh& mesh, std::int64_t id, std::size_t k) const {
    const auto [n, n_factors] = size_of(EX_NODE_SET, id);
    check_list("node_ns", k, n);
    std::vector<std::int64_t> vertices(n);
    if (n > 0) check(ex_get_set(id_, EX_NODE_SET, id, vertices.data(), nullptr), "ex_get_set");
    NodeSet set{id, name_of(EX_NODE_SET, id), {}, factors_of(EX_NODE_SET, id, k, n_factors)};
    for (const std::int64_t vertex : vertices) {
      if (vertex < 1 || vertex > static_cast<std::int64_t>(mesh.n_points())) {
        fail(ErrorCode::bad_mesh, path_, ": node set ", id, " names vertex ", vertex, " of ",
             mesh.n_points(), "; write the mesh again");
      }
      set.entries.push_back(static_cast<VertexId>(vertex - 1));
    }
    mesh.node_sets.push_back(std::move(set));
  }

  /// The elements of a block of the file.
  struct Run {
    std::int64_t last;              // of the file's elements, counted from 1
    std::optional<GlobalId> shift;  // from element - 1 to its place among the cells' elements
    std::int64_t n_faces;           // sides before its edges
  };

  std::int64_t n_axes_ = 3;
  std::int64_t n_elements_ = 0;    // read so far, including skipped ones
  std::vector<Run> element_runs_;  // in file order
};

bool is_netcdf(std::string_view bytes) {
  return bytes.starts_with("CDF") || bytes.starts_with("\x89HDF");
}

/// Returns all blocks of elements of this dimension in file order as one mesh, with the side and node
/// sets. Those of lower dimension are skipped and counted. Missing coordinates are 0.
TetMesh read_exodus(const std::string& path, std::string_view bytes, std::int32_t dimension) {
  const ExodusTurn turn;
  return ExodusReader(path, bytes).read(dimension);
}

}  // namespace

extern const FileFormat exodus_format{"an ExodusII file (NetCDF)", is_netcdf, read_exodus,
                                      exodus_fields};

}  // namespace tess::m2m
