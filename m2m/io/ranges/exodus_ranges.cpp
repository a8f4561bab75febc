#include "m2m/io/ranges/exodus_ranges.hpp"

#include "m2m/io/exodus/exodus_elements.hpp"
#include "m2m/io/exodus/exodus_file.hpp"
#include "m2m/io/exodus/exodus_turn.hpp"
#include "m2m/io/exodus/netcdf_header.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <exodusII.h>
#include <set>
#include <vector>

namespace tess::m2m {
namespace {

class ExodusRanges final : public MeshRanges {
 public:
  explicit ExodusRanges(const std::string& path) : path_(path) {
    ex_opts(0);  // the library prints no messages of its own
    int compute_bytes = sizeof(double);
    int stored_bytes = 0;
    float version = 0;
    id_ = ex_open(path.c_str(), EX_READ, &compute_bytes, &stored_bytes, &version);
    check(id_, "ex_open");
    ex_set_int64_status(id_, EX_ALL_INT64_API);
  }
  ~ExodusRanges() override {
    const ExodusTurn turn;
    if (id_ >= 0) ex_close(id_);
  }
  ExodusRanges(const ExodusRanges&) = delete;
  ExodusRanges& operator=(const ExodusRanges&) = delete;

  /// False if the file cannot be read in ranges.
  bool open(std::int64_t most) {
    if (inquire(EX_INQ_DIM) != 3) return false;
    for (const ExodusExtra& extra : exodus_extras)
      if (inquire(extra.what) > 0) return false;
    n_points = inquire(EX_INQ_NODES);
    const std::int64_t n_blocks = inquire(EX_INQ_ELEM_BLK);
    if (n_points > most || n_blocks > most) return false;
    std::vector<std::int64_t> ids(static_cast<std::size_t>(n_blocks));
    if (n_blocks > 0) check(ex_get_ids(id_, EX_ELEM_BLOCK, ids.data()), "ex_get_ids");
    if (std::set(ids.begin(), ids.end()).size() != ids.size()) return false;
    for (const std::int64_t id : ids) {
      ex_block block{};
      block.id = id;
      block.type = EX_ELEM_BLOCK;
      check(ex_get_block_param(id_, &block), "ex_get_block_param");
      block.topology[MAX_STR_LENGTH] = '\0';
      std::string type = block.topology;
      for (char& c : type) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
      if (block.num_entry == 0) continue;
      if (block.num_entry < 0 || block.num_entry > most - n_tets ||
          exodus_supported(type, block.num_nodes_per_entry) != ElementType::tet4)
        return false;
      blocks_.push_back({id, n_tets, block.num_entry});
      n_tets += block.num_entry;
    }
    return n_tets > 0;
  }

  void points(GlobalId first, std::span<Point> out) override {
    std::array<std::vector<double>, 3> axes;
    const auto n = static_cast<std::int64_t>(out.size());
    for (std::int64_t at = 0; at < n; at += portion) {
      const std::int64_t many = std::min(portion, n - at);
      for (auto& axis : axes) axis.resize(static_cast<std::size_t>(many));
      {
        const ExodusTurn turn;
        for (std::size_t axis = 0; axis < 3; ++axis)
          check(read_exodus_axis(id_, axis, first + at, axes[axis]),
                "nc_get_vara of the coordinates");
      }
      for (std::size_t i = 0; i < static_cast<std::size_t>(many); ++i)
        out[static_cast<std::size_t>(at) + i] = {axes[0][i], axes[1][i], axes[2][i]};
    }
  }

  void tets(GlobalId first, std::span<Tet> out) override {
    std::vector<std::int64_t> vertices;
    const GlobalId end = first + static_cast<GlobalId>(out.size());
    for (const Block& block : blocks_) {
      const GlobalId last = std::min(end, block.first + block.n);
      for (GlobalId at = std::max(first, block.first); at < last; at += portion) {
        const std::int64_t many = std::min(portion, last - at);
        vertices.resize(4 * static_cast<std::size_t>(many));
        {
          const ExodusTurn turn;
          check(ex_get_partial_conn(id_, EX_ELEM_BLOCK, block.id, at - block.first + 1, many,
                                    vertices.data(), nullptr, nullptr),
                "ex_get_partial_conn");
        }
        for (std::size_t i = 0; i < vertices.size(); ++i) {
          if (vertices[i] < 1 || vertices[i] > n_points)
            fail(ErrorCode::bad_mesh, path_, ": element ",
                 at - block.first + 1 + static_cast<GlobalId>(i / 4), " of block ", block.id,
                 " names vertex ", vertices[i], " of ", n_points, "; write the mesh again");
          out[static_cast<std::size_t>(at - first) + i / 4][i % 4] =
              static_cast<VertexId>(vertices[i] - 1);
        }
      }
    }
  }

 private:
  static constexpr std::int64_t portion = 1 << 16;  // so that the copies are small

  struct Block {
    std::int64_t id;
    GlobalId first;  // tetrahedron
    std::int64_t n;
  };

  void check(std::int64_t code, const char* call) const {
    if (code < 0)
      fail(ErrorCode::bad_file, path_, ": is truncated or damaged (", call, " failed with code ",
           code, "); write the mesh again");
  }
  [[nodiscard]] std::int64_t inquire(int what) const {
    const std::int64_t answer = ex_inquire_int(id_, what);
    check(answer, "ex_inquire");
    return answer;
  }

  std::string path_;
  int id_ = -1;
  std::vector<Block> blocks_;
};

}  // namespace

std::unique_ptr<MeshRanges> open_exodus_ranges(const std::string& path, std::string_view bytes) {
  check_netcdf_header(path, bytes);
  std::unique_ptr<ExodusRanges> ranges;
  bool fits = false;
  {
    const ExodusTurn turn;
    ranges = std::make_unique<ExodusRanges>(path);
    fits = ranges->open(static_cast<std::int64_t>(bytes.size()));
  }
  if (!fits) ranges.reset();
  return ranges;
}

}  // namespace tess::m2m
