// The STL format (3D Systems, "Stereolithography Interface Specification", 1988). Binary: a header of
// 80 bytes, the number of facets, and of each facet its normal, three vertices and two more bytes. As
// text: a line per word, such as "vertex X Y Z"; files of capital letters, of several solids, and with
// "end loop" in two words exist.
#include "collide/io/formats.hpp"
#include "runtime/base/open_file.hpp"
#include "runtime/base/words.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string_view>

namespace tess::dn {
namespace {
using detail::take_line;
using detail::take_word;
using detail::to_number;

constexpr std::size_t head = 84, per_facet = 50;

/// Of the last three vertices.
void add_triangle(Surface& surface) {
  const auto end = static_cast<std::uint32_t>(surface.vertices.size());
  surface.triangles.push_back({end - 3, end - 2, end - 1});
}

Surface read_binary(const std::string& path, const std::string& bytes, std::uint32_t announced) {
  static_assert(std::endian::native == std::endian::little, "as the numbers of the file");
  const std::size_t n_whole = (bytes.size() - head) / per_facet;
  if (announced > n_whole)
    fail(ErrorCode::bad_file, path, ": announces ", announced, " facets, but has bytes for ",
         n_whole, "; it is truncated");
  const std::size_t n_facets = announced == 0 ? n_whole : announced;  // some writers leave it 0
  Surface surface;
  for (std::size_t t = 0; t < n_facets; ++t) {
    std::array<std::array<float, 3>, 4> facet{};  // its normal first
    std::memcpy(&facet, bytes.data() + head + t * per_facet, sizeof(facet));
    for (std::size_t i = 1; i < 4; ++i)
      surface.vertices.push_back({facet[i][0], facet[i][1], facet[i][2]});
    add_triangle(surface);
  }
  if (n_facets != announced) surface.remarks["facets that the header does not announce"] = n_facets;
  if (const std::size_t left = bytes.size() - head - n_facets * per_facet; left > 0)
    surface.remarks["bytes behind the last facet"] = left;
  return surface;
}

/// The first characters of a word, so that an error has one line.
std::string shown(std::string word) {
  word.resize(std::min<std::size_t>(word.size(), 20));
  for (char& c : word) c = c < ' ' || c > '~' ? '?' : c;
  return word;
}

Surface read_text(const std::string& path, std::string_view text) {
  constexpr std::array<std::string_view, 5> passed_over{"solid", "facet", "outer", "endfacet",
                                                        "endsolid"};
  Surface surface;
  std::string last;
  for (std::size_t number = 1; !text.empty(); ++number) {
    std::string_view words = take_line(text);
    std::string word(take_word(words));
    if (word.empty()) continue;
    if (word == "end") word += take_word(words);  // "end loop"
    if (word == "vertex") {
      Vec3 at{};
      if (!to_number(take_word(words), at.x) || !to_number(take_word(words), at.y) ||
          !to_number(take_word(words), at.z) || !take_word(words).empty())
        fail(ErrorCode::bad_file, path, ":", number, ": a vertex needs three numbers");
      surface.vertices.push_back(at);
    } else if (word == "endloop") {
      const std::size_t n = surface.vertices.size() - 3 * surface.triangles.size();
      if (n != 3)
        fail(ErrorCode::bad_file, path, ":", number, ": a facet of ", n,
             " vertices; STL holds triangles only: divide it, or write OBJ or PLY");
      add_triangle(surface);
    } else if (std::ranges::find(passed_over, word) == passed_over.end()) {
      fail(ErrorCode::bad_file, path, ":", number, ": no line of an STL file begins with '",
           shown(word), "'; is it binary and truncated?");
    }
    last = word;
  }
  if (last != "endsolid" || surface.vertices.size() != 3 * surface.triangles.size())
    fail(ErrorCode::bad_file, path,
         ": ends without endsolid, or a facet without endloop; is it truncated?");
  return surface;
}

}  // namespace

Surface read_stl(const std::string& path) {
  std::string bytes = detail::read_file(path, "an STL file");
  if (bytes.size() >= head) {
    std::uint32_t n_facets = 0;
    std::memcpy(&n_facets, bytes.data() + head - sizeof(n_facets), sizeof(n_facets));
    // What follows the facets is less than one more, so `n_facets` is their number. Some binary
    // files begin with "solid" as well; their zeros show that they are no text.
    const std::size_t end = head + n_facets * per_facet;
    const bool fits = bytes.size() >= end && bytes.size() - end < per_facet;
    if (fits || (bytes.starts_with("solid") && bytes.find('\0') != std::string::npos))
      return read_binary(path, bytes, n_facets);
  }
  bytes = detail::without_byte_order_mark(bytes);
  for (char& c : bytes)
    if (c >= 'A' && c <= 'Z') c += 'a' - 'A';
  const std::size_t begin = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
  if (bytes.compare(begin, 5, "solid") != 0)
    fail(ErrorCode::bad_file, path,
         ": is not an STL file, or is truncated: it neither begins with 'solid' nor has as "
         "many bytes as its facets need");
  return read_text(path, bytes);
}

}  // namespace tess::dn
