#include "m2m/io/exodus_reader.hpp"

#include "m2m/io/netcdf_header.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <exodusII.h>
#include <fcntl.h>
#include <limits>
#include <optional>
#include <unistd.h>
#include <utility>
#include <vector>

namespace tess::m2m {
namespace {

/// Sends standard error nowhere while it lives. The whole process is affected, so it lives for one
/// call only: libexodusII prints with no way to turn it off where a NetCDF-4 file cannot be opened.
class Silence {
 public:
  Silence() : kept_(::dup(STDERR_FILENO)) {
    std::fflush(stderr);
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) return;
    ::dup2(nowhere, STDERR_FILENO);
    ::close(nowhere);
  }
  ~Silence() {
    std::fflush(stderr);
    if (kept_ < 0) return;
    ::dup2(kept_, STDERR_FILENO);
    ::close(kept_);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  int kept_;
};

class ExodusReader {
 public:
  ExodusReader(const std::string& path, bool classic) : path_(path) {
    std::optional<Silence> silence;
    if (!classic) silence.emplace();
    ex_opts(0);  // the library keeps its messages to itself: ours say more
    int compute_bytes = sizeof(double);
    int stored_bytes = 0;
    float version = 0;
    id_ = ex_open(path.c_str(), EX_READ, &compute_bytes, &stored_bytes, &version);
    if (id_ < 0) damaged("ex_open", id_);
    ex_set_int64_status(id_, EX_ALL_INT64_API);
  }
  ~ExodusReader() {
    if (id_ >= 0) ex_close(id_);
  }
  ExodusReader(const ExodusReader&) = delete;
  ExodusReader& operator=(const ExodusReader&) = delete;

  TetMesh read(std::size_t file_bytes) {
    TetMesh mesh;
    mesh.name = path_;
    const std::int64_t n_axes = inquire(EX_INQ_DIM);
    if (n_axes != 3) {
      fail(ErrorCode::bad_mesh,
           path_,
           ": has ",
           n_axes,
           " dimensions; only meshes in 3 are transferred");
    }
    // Compressed NetCDF-4 may hold more than its size shows; 1 000 times more it does not.
    const auto most =
        static_cast<std::int64_t>(std::min<std::size_t>(file_bytes, SIZE_MAX / 2000) * 1000);
    const std::int64_t n = inquire(EX_INQ_NODES);
    const std::int64_t n_blocks = inquire(EX_INQ_ELEM_BLK);
    if (n < 0 || n > most || n_blocks < 0 || n_blocks > most) {
      damaged("number of nodes or blocks", -1);
    }
    if (n > std::numeric_limits<VertexId>::max()) {
      fail(ErrorCode::bad_mesh,
           path_,
           ": has ",
           n,
           " vertices; at most 2147483647 fit in one mesh, split it");
    }
    if (n > 0) read_points(mesh, n);
    std::vector<std::int64_t> ids(static_cast<std::size_t>(n_blocks));
    if (n_blocks > 0) check(ex_get_ids(id_, EX_ELEM_BLOCK, ids.data()), "ex_get_ids");
    for (const std::int64_t block : ids) read_block(mesh, block, most);
    return mesh;
  }

 private:
  [[noreturn]] void damaged(const char* call, int code) const {
    fail(ErrorCode::bad_file,
         path_,
         ": is truncated or damaged (",
         call,
         " gives ",
         code,
         "); write the mesh again");
  }
  void check(int code, const char* call) const {
    if (code < 0) damaged(call, code);
  }
  std::int64_t inquire(int what) const {
    const std::int64_t answer = ex_inquire_int(id_, what);
    if (answer < 0) damaged("ex_inquire", static_cast<int>(answer));
    return answer;
  }

  void read_points(TetMesh& mesh, std::int64_t n) const {
    std::array<std::vector<double>, 3> axes;
    for (auto& axis : axes) axis.resize(static_cast<std::size_t>(n));
    check(ex_get_n_coord(id_, 1, n, axes[0].data(), axes[1].data(), axes[2].data()),
          "ex_get_coord");
    mesh.points.resize(static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
      mesh.points[i] = {axes[0][i], axes[1][i], axes[2][i]};
  }

  void read_block(TetMesh& mesh, std::int64_t id, std::int64_t most) const {
    ex_block block{};
    block.id = id;
    block.type = EX_ELEM_BLOCK;
    check(ex_get_block_param(id_, &block), "ex_get_block_param");
    block.topology[MAX_STR_LENGTH] = '\0';
    if (block.num_entry == 0) return;
    std::string type = block.topology;
    for (char& c : type) {
      c = std::isprint(static_cast<unsigned char>(c)) != 0
              ? static_cast<char>(std::toupper(static_cast<unsigned char>(c)))
              : '?';
    }
    const bool tet = type == "TET4" || type == "TET" || type == "TETRA" || type == "TETRA4";
    if (!tet || block.num_nodes_per_entry != 4) {
      fail(ErrorCode::bad_mesh,
           path_,
           ": block ",
           id,
           " has elements of type ",
           type,
           " with ",
           block.num_nodes_per_entry,
           " vertices; only TET4 is read: mesh it with linear tetrahedra");
    }
    if (block.num_entry < 0 || block.num_entry > most) damaged("number of elements", -1);
    const auto n = static_cast<std::size_t>(block.num_entry);
    std::vector<std::int64_t> vertices(4 * n);
    check(ex_get_n_conn(
              id_, EX_ELEM_BLOCK, id, 1, block.num_entry, vertices.data(), nullptr, nullptr),
          "ex_get_conn");
    const auto n_points = static_cast<std::int64_t>(mesh.n_points());
    mesh.tets.reserve(mesh.n_tets() + n);
    for (std::size_t t = 0; t < n; ++t) {
      Tet tetrahedron;
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const std::int64_t vertex = vertices[4 * t + corner];
        if (vertex < 1 || vertex > n_points) {
          fail(ErrorCode::bad_mesh,
               path_,
               ": element ",
               t + 1,
               " of block ",
               id,
               " names vertex ",
               vertex,
               " of ",
               n_points,
               "; write the mesh again");
        }
        tetrahedron[corner] = static_cast<VertexId>(vertex - 1);
      }
      mesh.tets.push_back(tetrahedron);
    }
  }

  const std::string& path_;
  int id_ = -1;
};

}  // namespace

TetMesh read_exodus(const std::string& path, std::string_view bytes) {
  const bool classic = bytes.starts_with("CDF");
  if (classic) check_netcdf_header(path, bytes);
  return ExodusReader(path, classic).read(bytes.size());
}

}  // namespace tess::m2m
