// Reads the cells of a VTU file (VTK XML UnstructuredGrid, vtu_file.hpp), or of the files that a .pvtu
// names. Hexahedra, voxels, wedges, pyramids, quadrilaterals and quadratic tetrahedra and triangles
// are split, also if they are written as Lagrange cells; cells of lower dimension than the mesh are
// skipped and counted. Pieces are joined in the order of the file; their points are not merged.
#include "m2m/io/file_format.hpp"
#include "m2m/io/vtu/vtu_cells.hpp"
#include "m2m/io/vtu/vtu_file.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace tess::m2m {
namespace {

constexpr std::size_t most_points = std::numeric_limits<VertexId>::max();

/// Stands for the type of a cell that another piece has, too, or that is hidden.
constexpr std::int64_t ghost = -1;

/// The types of the cells of a piece. Ghost cells (vtkDataSetAttributes: DUPLICATECELL,
/// REFINEDCELL, HIDDENCELL; in older files a level above 0) are no part of the mesh; they would
/// count twice.
std::vector<std::int64_t> types_of(const VtuFile& file, const VtuPiece& piece) {
  std::vector<std::int64_t> types = file.integers(file.array(piece.cells, "types"), piece.n_cells);
  auto marks = std::ranges::find(piece.cell_data, "vtkGhostType", &VtuArray::name);
  const bool has_levels = marks == piece.cell_data.end();
  if (has_levels) marks = std::ranges::find(piece.cell_data, "vtkGhostLevels", &VtuArray::name);
  if (marks == piece.cell_data.end() || piece.n_cells == 0) return types;
  const std::vector<std::int64_t> bits = file.integers(*marks, piece.n_cells);
  for (std::size_t c = 0; c < types.size(); ++c)
    if (has_levels ? bits[c] > 0 : (bits[c] & (1 | 8 | 32)) != 0) types[c] = ghost;
  return types;
}

class VtuMeshReader {
 public:
  VtuMeshReader(const std::string& path, std::int32_t dimension) {
    mesh_.name = path;
    mesh_.dimension = dimension;
  }

  TetMesh read(const std::vector<OpenVtuFile>& files) {
    for (const OpenVtuFile& open : files)
      for (const VtuPiece& piece : open.file->pieces()) read(*open.file, piece);
    for (const VtuCell& cell : vtu_cells) {
      const std::uint64_t n = n_skipped_[static_cast<std::size_t>(cell.number)];
      if (n > 0) mesh_.skipped.push_back({std::string(cell.name), n});
    }
    if (n_ghosts_ > 0) mesh_.skipped.push_back({"ghost", n_ghosts_});
    elements_.finish();
    return std::move(mesh_);
  }

 private:
  void read(const VtuFile& file, const VtuPiece& piece) {
    const std::size_t first = mesh_.n_points();
    if (piece.n_points > most_points - first)
      fail(ErrorCode::bad_mesh, mesh_.name, ": has more than ", most_points,
           " points; split the mesh");
    if (piece.n_cells > 0 || piece.n_points > 0) read_points(file, piece);
    if (piece.n_cells == 0) return;
    const std::vector<std::int64_t> types = types_of(file, piece);
    const std::vector<std::int64_t> ends =
        file.integers(file.array(piece.cells, "offsets"), piece.n_cells);
    const std::vector<std::int64_t> vertices =
        file.integers(file.array(piece.cells, "connectivity"), VtuFile::any);
    std::int64_t begin = 0;
    for (std::size_t c = 0; c < piece.n_cells; ++c) {
      if (ends[c] < begin || ends[c] > static_cast<std::int64_t>(vertices.size()))
        file.damaged("cell ", c, " ends at ", ends[c], " of ", vertices.size());
      add(file, types[c], c,
          std::span(vertices).subspan(static_cast<std::size_t>(begin),
                                      static_cast<std::size_t>(ends[c] - begin)),
          first);
      begin = ends[c];
    }
  }

  void read_points(const VtuFile& file, const VtuPiece& piece) {
    if (piece.points.size() != 1)
      file.damaged("a Piece has ", piece.points.size(), " arrays of Points instead of one");
    const std::vector<double> x = file.reals(piece.points[0], 3 * piece.n_points);
    for (std::size_t v = 0; v < piece.n_points; ++v)
      mesh_.points.push_back({x[3 * v], x[3 * v + 1], x[3 * v + 2]});
  }

  void add(const VtuFile& file, std::int64_t type, std::size_t cell,
           std::span<const std::int64_t> vertices, std::size_t first) {
    if (type == ghost) {
      ++n_ghosts_;
      return;
    }
    const VtuCell* const known = vtu_cell(type);
    if (known != nullptr && known->dimension < mesh_.dimension) {
      ++n_skipped_[static_cast<std::size_t>(type)];
      return;
    }
    const auto element = vtu_supported(type, vertices.size());
    if (!element || dimension_of(*element) != mesh_.dimension)
      fail(ErrorCode::bad_mesh, file.path(), ": cell ", cell, " is a ",
           known == nullptr ? "cell" : known->name, " (VTK type ", type, ") of ", vertices.size(),
           " points; ", supported(),
           " are supported, also as Lagrange cells: mesh it with one of "
           "these");
    if (vertices.size() != n_vertices(*element))
      file.damaged("cell ", cell, " of type ", known->name, " has ", vertices.size(), " vertices");
    ElementVertices ids{};
    const auto n_points = static_cast<std::int64_t>(mesh_.n_points() - first);
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      if (vertices[k] < 0 || vertices[k] >= n_points)
        fail(ErrorCode::bad_mesh, file.path(), ": cell ", cell, " names point ", vertices[k],
             " of ", n_points, "; write the mesh again");
      ids[k] = static_cast<VertexId>(vertices[k] + static_cast<std::int64_t>(first));
    }
    if (type == 8 || type == 11) std::swap(ids[2], ids[3]);
    if (type == 11) std::swap(ids[6], ids[7]);
    if (type == 29) reorder(ids, vtu_hex27);
    if (*element == ElementType::wedge6 && is_inverted(ids)) {
      std::swap(ids[1], ids[2]);
      std::swap(ids[4], ids[5]);
    }
    elements_.add(*element, std::span(ids).first(vertices.size()));
  }

  [[nodiscard]] const char* supported() const {
    return mesh_.dimension == 3 ? "of volumes, tetra, hexahedron, voxel, wedge, pyramid, quadratic "
                                  "tetra and triquadratic hexahedron"
           : mesh_.dimension == 2
               ? "of surfaces, triangle, quad, pixel, polygon of 3 or 4 and quadratic triangle"
               : "of lines, line and poly line of 2";
  }

  /// VTK's wedges have the opposite orientation of ExodusII's; many programs write the latter.
  [[nodiscard]] bool is_inverted(const ElementVertices& wedge) const {
    const auto edge = [&](std::size_t to) {
      return difference(mesh_.points[static_cast<std::size_t>(wedge[to])],
                        mesh_.points[static_cast<std::size_t>(wedge[0])]);
    };
    return dot(edge(1), cross(edge(2), edge(3))) < 0;
  }

  TetMesh mesh_;
  ElementSplitter elements_{mesh_};
  std::array<std::uint64_t, 128> n_skipped_{};  // per type number
  std::uint64_t n_ghosts_ = 0;
};

/// PointData and CellData of all pieces, at one time.
class VtuFields : public FieldReader {
 public:
  VtuFields(const std::string& path, std::string_view bytes)
      : path_(path), files_(open_vtu_files(path, bytes)) {
    times_ = {files_[0].file->time()};
    // Empty pieces need not have the arrays.
    const VtuPiece* full = nullptr;
    for (const OpenVtuFile& open : files_)
      for (const VtuPiece& piece : open.file->pieces())
        if (full == nullptr && piece.n_points != 0 && piece.n_cells != 0) full = &piece;
    const VtuPiece& first = full != nullptr ? *full : files_[0].file->pieces()[0];
    for (const VtuArray& array : first.point_data) list(array, FieldPlace::vertices);
    for (const VtuArray& array : first.cell_data) list(array, FieldPlace::tets);
  }

  [[nodiscard]] std::vector<double> read(const TetMesh& mesh, std::size_t field,
                                         std::size_t) const override {
    const FileField& wanted = fields_[field];
    const bool nodal = wanted.place == FieldPlace::vertices;
    const std::size_t n_components = wanted.n_components;
    if (n_components < 1 || n_components > 1000)
      files_[0].file->damaged("'", wanted.name, "' has ", n_components, " components");
    std::vector<double> values;
    std::size_t n_points = 0;
    for (const OpenVtuFile& open : files_)
      for (const VtuPiece& piece : open.file->pieces()) {
        n_points += piece.n_points;
        append(*open.file, piece, mesh.dimension, wanted, values);
      }
    if (!nodal) return values_of_tets(mesh, std::move(values), n_components, path_);
    check_n_points(mesh, static_cast<std::int64_t>(n_points), path_);
    return values;
  }

 private:
  static void append(const VtuFile& file, const VtuPiece& piece, std::int32_t dimension,
                     const FileField& wanted, std::vector<double>& values) {
    const bool nodal = wanted.place == FieldPlace::vertices;
    const std::size_t n_components = wanted.n_components;
    const std::size_t n = nodal ? piece.n_points : piece.n_cells;
    if (n == 0) return;
    const VtuArray& array = file.array(nodal ? piece.point_data : piece.cell_data, wanted.name);
    if (array.n_components != n_components)
      file.damaged("'", wanted.name, "' has ", n_components, " components and ",
                   array.n_components);
    const std::vector<double> all = file.reals(array, n * n_components);
    if (nodal) {
      values.insert(values.end(), all.begin(), all.end());
      return;
    }
    const std::vector<std::int64_t> types = types_of(file, piece);
    for (std::size_t c = 0; c < n; ++c)
      if (vtu_dimension(types[c]) == dimension)
        values.insert(values.end(), all.begin() + static_cast<std::ptrdiff_t>(c * n_components),
                      all.begin() + static_cast<std::ptrdiff_t>((c + 1) * n_components));
  }

  void list(const VtuArray& array, FieldPlace place) {
    if (array.name.empty() || array.type == "String") return;
    fields_.push_back({array.name, place, array.n_components});
  }

  const std::string& path_;
  std::vector<OpenVtuFile> files_;
};

/// True for a legacy file, and if the first tag of an XML text, behind declarations and comments, is
/// that of VTK.
bool is_vtk(std::string_view text) {
  if (is_legacy_vtk(text)) return true;
  std::size_t at = text.find_first_not_of(" \t\r\n");
  if (at == std::string_view::npos || text[at] != '<') return false;
  while (at != std::string_view::npos) {
    text.remove_prefix(at);
    const bool is_comment = text.starts_with("<!--");
    if (!is_comment && !text.starts_with("<?") && !text.starts_with("<!")) break;
    at = text.find('<', text.find(is_comment ? "-->" : ">"));
  }
  return text.starts_with("<VTKFile");
}

TetMesh read_vtu(const std::string& path, std::string_view bytes, std::int32_t dimension) {
  return VtuMeshReader(path, dimension).read(open_vtu_files(path, bytes));
}

std::unique_ptr<FieldReader> vtu_fields(const std::string& path, std::string_view bytes) {
  return std::make_unique<VtuFields>(path, bytes);
}

}  // namespace

extern const FileFormat vtu_format{"a VTK file (starts with <VTKFile or # vtk DataFile)", is_vtk,
                                   read_vtu, vtu_fields};

}  // namespace tess::m2m
