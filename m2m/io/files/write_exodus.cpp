#include "m2m/write_exodus.hpp"

#include "m2m/io/exodus/exodus_turn.hpp"
#include "runtime/core/check.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <exodusII.h>
#include <fmt/core.h>
#include <limits>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>

namespace tess::m2m {
namespace {

constexpr std::size_t longest_name = 255;  // the limit of ParaView and of the library

/// A variable of ExodusII: one component of a field.
struct Variable {
  std::string name;
  std::size_t field;  ///< its position in the list
  std::size_t component;
  friend bool operator==(const Variable&, const Variable&) = default;
};

std::vector<Variable> variables(std::span<const Field> fields, std::size_t n_rows,
                                const std::string& path) {
  std::vector<Variable> result;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const Field& field = fields[f];
    TESS_CHECK(field.values.size() == n_rows * field.n_components, "field ", field.name,
               ": expected ", n_rows, " × ", field.n_components, " values, got ",
               field.values.size());
    for (std::size_t c = 0; c < field.n_components; ++c) {
      std::string name = field.name;
      if (field.n_components == 3) {
        name = fmt::format("{}_{}", field.name, "xyz"[c]);
      } else if (field.n_components > 1) {
        name = fmt::format("{}_{}", field.name, c + 1);
      }
      if (name.empty() || name.size() > longest_name) {
        fail(ErrorCode::bad_value, path, ": field name '", name, "' has ", name.size(),
             " characters; choose a name of 1 to ", longest_name);
      }
      for (const Variable& other : result)
        if (other.name == name)
          fail(ErrorCode::bad_value, path, ": two fields have the variable '", name,
               "'; give each field a name of its own");
      result.push_back({std::move(name), f, c});
    }
  }
  return result;
}

/// The file under its temporary name. The destructor removes it unless finish() has renamed it.
class PartFile {
 public:
  explicit PartFile(const std::string& path)
      : path_(path), part_(path + ".part" + std::to_string(::getpid())) {
    const ExodusTurn turn;
    ex_opts(0);
    int compute_bytes = sizeof(double);
    int stored_bytes = sizeof(double);
    errno = 0;
    id_ = ex_create(part_.c_str(), EX_CLOBBER | EX_LARGE_MODEL, &compute_bytes, &stored_bytes);
    if (id_ < 0) {
      fail(ErrorCode::bad_file, path_, ": cannot be written (",
           std::generic_category().message(errno),
           "); check that its folder exists and is writable");
    }
  }
  ~PartFile() {
    const ExodusTurn turn;
    if (id_ >= 0) ex_close(id_);
    if (!part_.empty()) ::unlink(part_.c_str());
  }
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  [[nodiscard]] int id() const { return id_; }
  [[nodiscard]] bool is_open() const { return id_ >= 0; }
  void check(int code, const char* call) const {
    if (code >= 0) return;
    fail(ErrorCode::environment, path_, ": ", call, " failed with code ", code,
         "; check that the disk has space");
  }
  void finish() {
    const int code = ex_close(id_);
    id_ = -1;
    check(code, "ex_close");
    if (std::rename(part_.c_str(), path_.c_str()) != 0) {
      fail(ErrorCode::bad_file, path_, ": cannot be replaced (",
           std::generic_category().message(errno), ")");
    }
    part_.clear();
  }

 private:
  std::string path_;
  std::string part_;
  int id_ = -1;
};

/// The blocks of the mesh, or one block of all tetrahedra.
std::vector<Block> blocks_of(const TetMesh& mesh) {
  return mesh.blocks.empty() ? std::vector{Block{1, {}, mesh.n_tets()}} : mesh.blocks;
}

void put_name(const PartFile& file, ex_entity_type type, std::int64_t id, const std::string& name) {
  if (!name.empty()) file.check(ex_put_name(file.id(), type, id, name.c_str()), "ex_put_name");
}

void put_blocks(const PartFile& file, const TetMesh& mesh, const std::vector<Block>& blocks) {
  std::size_t first = 0;
  std::vector<int> vertices;
  for (const Block& block : blocks) {
    const auto n = static_cast<std::int64_t>(block.n_tets);
    constexpr std::array types{"", "BAR2", "TRI3", "TET4"};  // per dimension
    const auto n_corners = mesh.dimension + 1;
    file.check(
        ex_put_block(file.id(), EX_ELEM_BLOCK, block.id,
                     types.at(static_cast<std::size_t>(mesh.dimension)), n, n_corners, 0, 0, 0),
        "ex_put_block");
    put_name(file, EX_ELEM_BLOCK, block.id, block.name);
    vertices.clear();
    for (std::size_t t = first; t < first + block.n_tets; ++t)
      for (const VertexId v : std::span(mesh.tets[t]).first(static_cast<std::size_t>(n_corners)))
        vertices.push_back(v + 1);
    if (n > 0)
      file.check(ex_put_conn(file.id(), EX_ELEM_BLOCK, block.id, vertices.data(), nullptr, nullptr),
                 "ex_put_conn");
    first += block.n_tets;
  }
}

template <class Entry>
void put_set(const PartFile& file, ex_entity_type type, const EntrySet<Entry>& set,
             const std::vector<int>& entries, const int* extra) {
  file.check(ex_put_set_param(file.id(), type, set.id, static_cast<std::int64_t>(entries.size()),
                              static_cast<std::int64_t>(set.factors.size())),
             "ex_put_set_param");
  put_name(file, type, set.id, set.name);
  if (!entries.empty())
    file.check(ex_put_set(file.id(), type, set.id, entries.data(), extra), "ex_put_set");
  if (!set.factors.empty())
    file.check(ex_put_set_dist_fact(file.id(), type, set.id, set.factors.data()),
               "ex_put_set_dist_fact");
}

void put_sets(const PartFile& file, const TetMesh& mesh) {
  for (const SideSet& set : mesh.side_sets) {
    std::vector<int> elements, sides;
    for (const Side& side : set.entries) {
      elements.push_back(static_cast<int>(side.tet + 1));
      // The first sides of a triangle in space are its two faces.
      sides.push_back(side.side + (mesh.dimension == 2 ? 2 : 0));
    }
    put_set(file, EX_SIDE_SET, set, elements, sides.data());
  }
  for (const NodeSet& set : mesh.node_sets) {
    std::vector<int> vertices;
    for (const VertexId v : set.entries) vertices.push_back(v + 1);
    put_set(file, EX_NODE_SET, set, vertices, nullptr);
  }
}

void put_mesh(const PartFile& file, const TetMesh& mesh, const std::vector<Block>& blocks) {
  file.check(ex_put_init(
                 file.id(), "Tessera mesh transfer", 3, static_cast<std::int64_t>(mesh.n_points()),
                 static_cast<std::int64_t>(mesh.n_tets()), static_cast<std::int64_t>(blocks.size()),
                 static_cast<std::int64_t>(mesh.node_sets.size()),
                 static_cast<std::int64_t>(mesh.side_sets.size())),
             "ex_put_init");
  std::array<std::vector<double>, 3> axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const Point& p : mesh.points) axes[axis].push_back(p[axis]);
  }
  file.check(ex_put_coord(file.id(), axes[0].data(), axes[1].data(), axes[2].data()),
             "ex_put_coord");
  std::array<char, 2> x{"x"}, y{"y"}, z{"z"};
  std::array<char*, 3> names{x.data(), y.data(), z.data()};
  file.check(ex_put_coord_names(file.id(), names.data()), "ex_put_coord_names");
  put_blocks(file, mesh, blocks);
  put_sets(file, mesh);
}

void name_variables(const PartFile& file, ex_entity_type type, const std::vector<Variable>& all) {
  if (all.empty()) return;
  file.check(ex_put_variable_param(file.id(), type, static_cast<int>(all.size())),
             "ex_put_variable_param");
  for (std::size_t i = 0; i < all.size(); ++i) {
    file.check(ex_put_variable_name(file.id(), type, static_cast<int>(i + 1), all[i].name.c_str()),
               "ex_put_variable_name");
  }
}

/// A range of rows of the fields: all vertices, or the tetrahedra of one block.
struct Slab {
  ex_entity_type type;
  std::int64_t id;
  std::size_t first, n;
};

void put_variables(const PartFile& file, const std::vector<Variable>& all,
                   std::span<const Field> fields, int step, const Slab& rows) {
  if (rows.n == 0) return;
  std::vector<double> column(rows.n);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Field& field = fields[all[i].field];
    for (std::size_t row = 0; row < rows.n; ++row)
      column[row] = field.values[(rows.first + row) * field.n_components + all[i].component];
    file.check(ex_put_var(file.id(), step, rows.type, static_cast<int>(i + 1), rows.id,
                          static_cast<std::int64_t>(rows.n), column.data()),
               "ex_put_var");
  }
}

/// The file format has 32-bit numbers of blocks and sets, and a maximum length of names.
void check_groups(const TetMesh& mesh, const std::vector<Block>& blocks, const std::string& path) {
  const auto check = [&](const char* kind, std::int64_t id, const std::string& name) {
    if (id < 0 || id > std::numeric_limits<std::int32_t>::max() || name.size() > longest_name)
      fail(ErrorCode::bad_value, path, ": ", kind, " ", id, " '", name,
           "' cannot be written; choose a number from 0 to 2147483647 and a name of at most ",
           longest_name, " characters");
  };
  for (const Block& block : blocks) check("block", block.id, block.name);
  for (const SideSet& set : mesh.side_sets) check("side set", set.id, set.name);
  for (const NodeSet& set : mesh.node_sets) check("node set", set.id, set.name);
}

std::size_t longest_name_of(const TetMesh& mesh, const std::vector<Block>& blocks,
                            const std::vector<Variable>& nodal,
                            const std::vector<Variable>& element) {
  std::size_t longest = 32;
  for (const Block& block : blocks) longest = std::max(longest, block.name.size());
  for (const SideSet& set : mesh.side_sets) longest = std::max(longest, set.name.size());
  for (const NodeSet& set : mesh.node_sets) longest = std::max(longest, set.name.size());
  for (const auto* list : {&nodal, &element})
    for (const Variable& variable : *list) longest = std::max(longest, variable.name.size());
  return longest;
}

std::string names_of(const std::vector<Variable>& variables) {
  std::string out;
  for (const Variable& variable : variables) {
    if (!out.empty()) out += ", ";
    out += variable.name;
  }
  return out.empty() ? "none" : out;
}

}  // namespace

struct ExodusSteps::Writing {
  std::string path;
  const TetMesh& mesh;
  std::vector<Block> blocks;
  PartFile file;
  int n_steps = 0;
  double last_time = -std::numeric_limits<double>::infinity();
  std::vector<Variable> nodal{}, element{};
};

ExodusSteps::ExodusSteps(const std::string& path, const TetMesh& mesh) {
  std::vector<Block> blocks = blocks_of(mesh);
  check_groups(mesh, blocks, path);
  writing_.reset(new Writing{path, mesh, std::move(blocks), PartFile(path)});
}
ExodusSteps::~ExodusSteps() = default;

void ExodusSteps::add(double time, std::span<const Field> vertex_fields,
                      std::span<const Field> tet_fields) {
  const ExodusTurn turn;
  Writing& to = *writing_;
  TESS_CHECK(to.file.is_open(), to.path, ": a step is added to a file that finish() has closed");
  std::vector<Variable> nodal = variables(vertex_fields, to.mesh.n_points(), to.path);
  std::vector<Variable> element = variables(tet_fields, to.mesh.n_tets(), to.path);
  if (!(time > to.last_time))
    fail(ErrorCode::bad_value, to.path, ": step ", to.n_steps, " has time ", time,
         ", which is not after ", to.last_time, "; add steps in the order of time");
  if (to.n_steps == 0) {
    ex_set_max_name_length(to.file.id(),
                           static_cast<int>(longest_name_of(to.mesh, to.blocks, nodal, element)));
    put_mesh(to.file, to.mesh, to.blocks);
    name_variables(to.file, EX_NODAL, nodal);
    name_variables(to.file, EX_ELEM_BLOCK, element);
    to.nodal = std::move(nodal);
    to.element = std::move(element);
  } else if (nodal != to.nodal || element != to.element) {
    fail(ErrorCode::bad_value, to.path, ": step ", to.n_steps, " has the variables ",
         names_of(nodal), " and ", names_of(element), ", but step 0 had ", names_of(to.nodal),
         " and ", names_of(to.element), "; give all steps the same fields in the same order");
  }
  const int step = ++to.n_steps;  // counted from 1 in the file
  to.last_time = time;
  to.file.check(ex_put_time(to.file.id(), step, &time), "ex_put_time");
  put_variables(to.file, to.nodal, vertex_fields, step, {EX_NODAL, 1, 0, to.mesh.n_points()});
  std::size_t first = 0;
  for (const Block& block : to.blocks) {
    put_variables(to.file, to.element, tet_fields, step,
                  {EX_ELEM_BLOCK, block.id, first, block.n_tets});
    first += block.n_tets;
  }
}

void ExodusSteps::finish() {
  const ExodusTurn turn;
  Writing& to = *writing_;
  TESS_CHECK(to.file.is_open(), to.path, ": finish() is called twice");
  if (to.n_steps == 0) put_mesh(to.file, to.mesh, to.blocks);
  to.file.finish();
}

void write_exodus(const std::string& path, const TetMesh& mesh,
                  std::span<const Field> vertex_fields, std::span<const Field> tet_fields) {
  ExodusSteps out(path, mesh);
  out.add(0, vertex_fields, tet_fields);
  out.finish();
}

}  // namespace tess::m2m
