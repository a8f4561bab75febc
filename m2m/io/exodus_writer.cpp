#include "m2m/io/exodus_writer.hpp"

#include "runtime/check.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <exodusII.h>
#include <fmt/core.h>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace tess::m2m {
namespace {

constexpr std::size_t longest_name = 255;  // what ParaView and the library agree on

/// One component of a field, as Exodus sees it.
struct Variable {
  std::string name;
  const Field* field;
  std::size_t component;
};

std::vector<Variable> variables(std::span<const Field> fields,
                                std::size_t n_rows,
                                const std::string& path) {
  std::vector<Variable> result;
  for (const Field& field : fields) {
    TESS_CHECK(field.values.size() == n_rows * field.n_components,
               "field ",
               field.name,
               ": expected ",
               n_rows,
               " × ",
               field.n_components,
               " values, got ",
               field.values.size());
    for (std::size_t c = 0; c < field.n_components; ++c) {
      std::string name = field.name;
      if (field.n_components == 3) {
        name = fmt::format("{}_{}", field.name, "xyz"[c]);
      } else if (field.n_components > 1) {
        name = fmt::format("{}_{}", field.name, c + 1);
      }
      if (name.empty() || name.size() > longest_name) {
        fail(ErrorCode::bad_value,
             path,
             ": field name '",
             name,
             "' has ",
             name.size(),
             " characters; 1 to ",
             longest_name,
             " can be written");
      }
      result.push_back({std::move(name), &field, c});
    }
  }
  return result;
}

/// The file under its other name; gone with this object unless finish() has renamed it.
class PartFile {
 public:
  explicit PartFile(const std::string& path)
      : path_(path), part_(path + ".part" + std::to_string(::getpid())) {
    ex_opts(0);
    int compute_bytes = sizeof(double);
    int stored_bytes = sizeof(double);
    errno = 0;
    id_ = ex_create(part_.c_str(), EX_CLOBBER | EX_LARGE_MODEL, &compute_bytes, &stored_bytes);
    if (id_ < 0) {
      fail(ErrorCode::bad_file,
           path_,
           ": cannot be written (",
           std::generic_category().message(errno),
           "); check that its folder is there and may be written");
    }
  }
  ~PartFile() {
    if (id_ >= 0) ex_close(id_);
    if (!part_.empty()) ::unlink(part_.c_str());
  }
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  [[nodiscard]] int id() const { return id_; }
  void check(int code, const char* call) const {
    if (code >= 0) return;
    fail(ErrorCode::environment, path_, ": ", call, " gives ", code, "; is the disk full?");
  }
  void finish() {
    const int code = ex_close(id_);
    id_ = -1;
    check(code, "ex_close");
    if (std::rename(part_.c_str(), path_.c_str()) != 0) {
      fail(ErrorCode::bad_file,
           path_,
           ": cannot be replaced (",
           std::generic_category().message(errno),
           ")");
    }
    part_.clear();
  }

 private:
  const std::string& path_;
  std::string part_;
  int id_ = -1;
};

void put_mesh(const PartFile& file, const TetMesh& mesh) {
  const auto n_points = static_cast<std::int64_t>(mesh.n_points());
  const auto n_tets = static_cast<std::int64_t>(mesh.n_tets());
  file.check(ex_put_init(file.id(), "Tessera mesh transfer", 3, n_points, n_tets, 1, 0, 0),
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
  file.check(ex_put_block(file.id(), EX_ELEM_BLOCK, 1, "TET4", n_tets, 4, 0, 0, 0), "ex_put_block");
  std::vector<int> vertices;
  vertices.reserve(4 * mesh.n_tets());
  for (const Tet& tet : mesh.tets) {
    for (const VertexId v : tet) vertices.push_back(v + 1);
  }
  file.check(ex_put_conn(file.id(), EX_ELEM_BLOCK, 1, vertices.data(), nullptr, nullptr),
             "ex_put_conn");
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

void put_variables(const PartFile& file,
                   ex_entity_type type,
                   const std::vector<Variable>& all,
                   std::size_t n_rows) {
  std::vector<double> column(n_rows);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Field& field = *all[i].field;
    for (std::size_t row = 0; row < n_rows; ++row) {
      column[row] = field.values[row * field.n_components + all[i].component];
    }
    file.check(ex_put_var(file.id(),
                          1,
                          type,
                          static_cast<int>(i + 1),
                          1,
                          static_cast<std::int64_t>(n_rows),
                          column.data()),
               "ex_put_var");
  }
}

}  // namespace

void write_exodus(const std::string& path,
                  const TetMesh& mesh,
                  std::span<const Field> vertex_fields,
                  std::span<const Field> tet_fields) {
  const std::vector<Variable> nodal = variables(vertex_fields, mesh.n_points(), path);
  const std::vector<Variable> element = variables(tet_fields, mesh.n_tets(), path);
  std::size_t longest = 32;
  for (const auto* list : {&nodal, &element}) {
    for (const Variable& variable : *list) longest = std::max(longest, variable.name.size());
  }
  PartFile file(path);
  ex_set_max_name_length(file.id(), static_cast<int>(longest));
  put_mesh(file, mesh);
  name_variables(file, EX_NODAL, nodal);
  name_variables(file, EX_ELEM_BLOCK, element);
  const double time = 0;
  file.check(ex_put_time(file.id(), 1, &time), "ex_put_time");
  put_variables(file, EX_NODAL, nodal, mesh.n_points());
  put_variables(file, EX_ELEM_BLOCK, element, mesh.n_tets());
  file.finish();
}

}  // namespace tess::m2m
