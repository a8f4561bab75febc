#include "m2m/io/ranges/gmsh_ranges.hpp"

#include "m2m/io/file_bytes.hpp"
#include "m2m/io/gmsh/gmsh_elements.hpp"
#include "m2m/io/gmsh/gmsh_format.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

namespace tess::m2m {
namespace {

class GmshRanges final : public MeshRanges {
 public:
  explicit GmshRanges(const std::string& path)
      : path_(path), file_(path), at_(path_, file_.view()) {}

  /// False if the file cannot be read in ranges.
  bool open(RangeCheck check) {
    if (!format()) return false;
    bool have_nodes = false, have_elements = false;
    for (at_.skip_blanks(); !at_.at_end(); at_.skip_blanks()) {
      const std::string section(at_.word());
      if (section == "$Nodes" && !have_nodes) {
        if (!binary_section([this] { return nodes(); }, "$EndNodes")) return false;
        have_nodes = true;
      } else if (section == "$Elements" && !have_elements && have_nodes) {
        if (!binary_section([this] { return elements(); }, "$EndElements")) return false;
        have_elements = true;
      } else if (gmsh_section_beside_mesh(section)) {
        at_.skip_to("$End" + section.substr(1));
      } else {
        return false;  // such as a second $Nodes
      }
    }
    for (const GmshElement& type : gmsh_elements) {
      const std::uint64_t n = n_skipped_[static_cast<std::size_t>(type.number)];
      if (n == 0) continue;
      if (!skipped.empty()) skipped += ", ";
      skipped += std::to_string(n) + " " + std::string(type.name);
    }
    return have_nodes && n_tets > 0 && (check == RangeCheck::header || tags_follow(0, n_points));
  }

  void points(GlobalId first, std::span<Point> out) override {
    if (!tags_follow(first, static_cast<GlobalId>(out.size())))
      at_.refuse("its node tags are not consecutive; save it again with gmsh");
    visit(node_blocks_, first, out.size(),
          [&](const Block& block, std::size_t from, std::size_t at, std::size_t n) {
            const std::size_t begin = block.begin + block.n * 8 + from * sizeof(Point);
            std::memcpy(out.data() + at, file_.view().data() + begin, n * sizeof(Point));
            file_.release(begin, n * sizeof(Point));
          });
  }

  void tets(GlobalId first, std::span<Tet> out) override {
    visit(tet_blocks_, first, out.size(),
          [&](const Block& block, std::size_t from, std::size_t at, std::size_t n) {
            const std::size_t begin = block.begin + from * sizeof(Element);
            for (std::size_t i = 0; i < n; ++i) {
              Element element;
              std::memcpy(&element, file_.view().data() + begin + i * sizeof element,
                          sizeof element);
              for (std::size_t k = 0; k < 4; ++k) {
                const std::uint64_t vertex = element[k + 1] - first_tag_;
                if (vertex >= static_cast<std::uint64_t>(n_points))
                  at_.refuse("tet4 ", first + static_cast<GlobalId>(at + i), " names node ",
                             element[k + 1], ", which does not exist; write the mesh again");
                out[at + i][k] = static_cast<VertexId>(vertex);
              }
            }
            file_.release(begin, n * sizeof(Element));
          });
  }

 private:
  using Element = std::array<std::uint64_t, 5>;  // tag and corners
  /// Nodes (all tags, then all coordinates) or tetrahedra.
  struct Block {
    GlobalId first;  // id of the first of them
    std::size_t n;
    std::size_t begin;  // byte
  };

  bool format() {
    if (at_.word() != "$MeshFormat" || at_.number_as_text<double>() != 4.1 ||
        at_.number_as_text<int>() != 1 || at_.number_as_text<int>() != 8)
      return false;
    at_.end_of_line();
    at_.set_binary(true);
    const bool native = at_.number<int>() == 1;
    at_.set_binary(false);
    at_.close("$EndMeshFormat");
    return native;
  }

  template <class Read>
  bool binary_section(const Read& read, std::string_view end) {
    at_.end_of_line();
    at_.set_binary(true);
    const bool fits = read();
    at_.set_binary(false);
    if (fits) at_.close(end);
    return fits;
  }

  bool nodes() {
    const auto n_blocks = at_.count<std::uint64_t>("blocks of nodes", 20);
    const auto n = at_.count<std::uint64_t>("nodes", 32);
    first_tag_ = at_.number<std::uint64_t>();
    at_.skip<std::uint64_t>(1);
    for (std::size_t block = 0; block < n_blocks; ++block) {
      at_.skip<int>(2);  // dimension and entity
      if (at_.number<int>() != 0) return false;
      const auto m = at_.count<std::uint64_t>("nodes in a block", 32);
      if (m > 0) node_blocks_.push_back({n_points, m, at_.at()});
      at_.skip<double>(4 * m);
      n_points += static_cast<GlobalId>(m);
    }
    return static_cast<std::uint64_t>(n_points) == n;
  }

  bool elements() {
    const auto n_blocks = at_.count<std::uint64_t>("blocks of elements", 20);
    const auto n = at_.number<std::uint64_t>();
    at_.skip<std::uint64_t>(2);  // least and greatest tag
    std::uint64_t n_found = 0;
    for (std::size_t block = 0; block < n_blocks; ++block) {
      at_.skip<int>(2);  // dimension and entity
      const int number = at_.number<int>();
      const GmshElement* const type = gmsh_element(number);
      if (type == nullptr || (type->dimension == 3 && number != 4)) return false;
      const auto m = at_.count<std::uint64_t>("elements in a block", 16);
      n_found += m;
      if (number != 4) {
        n_skipped_[static_cast<std::size_t>(number)] += m;
      } else if (m > 0) {
        tet_blocks_.push_back({n_tets, m, at_.at()});
        n_tets += static_cast<GlobalId>(m);
      }
      at_.skip<std::uint64_t>((static_cast<std::size_t>(type->n_vertices) + 1) * m);
    }
    return n_found == n;
  }

  [[nodiscard]] bool tags_follow(GlobalId first, GlobalId n) const {
    bool follow = true;
    visit(node_blocks_, first, static_cast<std::size_t>(n),
          [&](const Block& block, std::size_t from, std::size_t at, std::size_t many) {
            for (std::size_t i = 0; i < many; ++i) {
              std::uint64_t tag = 0;
              std::memcpy(&tag, file_.view().data() + block.begin + (from + i) * 8, 8);
              follow = follow && tag == first_tag_ + static_cast<std::uint64_t>(first) + at + i;
            }
          });
    return follow;
  }

  /// Calls f(block, position in the block, position in the range, number) for portions of a range.
  template <class F>
  static void visit(const std::vector<Block>& blocks, GlobalId first, std::size_t n, const F& f) {
    constexpr std::size_t portion = 1 << 16;
    const auto begin = static_cast<std::size_t>(first);
    for (const Block& block : blocks) {
      const auto block_first = static_cast<std::size_t>(block.first);
      const std::size_t low = std::max(begin, block_first);
      const std::size_t high = std::min(begin + n, block_first + block.n);
      for (std::size_t at = low; at < high; at += portion)
        f(block, at - block_first, at - begin, std::min(portion, high - at));
    }
  }

  std::string path_;
  FileBytes file_;
  GmshScanner at_;
  std::uint64_t first_tag_ = 0;
  std::vector<Block> node_blocks_, tet_blocks_;
  std::array<std::uint64_t, 128> n_skipped_{};  // per type number
};

}  // namespace

std::unique_ptr<MeshRanges> open_gmsh_ranges(const std::string& path, RangeCheck check) {
  auto ranges = std::make_unique<GmshRanges>(path);
  if (!ranges->open(check)) return nullptr;
  return ranges;
}

}  // namespace tess::m2m
