#include "collide/dn_field/surface.hpp"

#include "runtime/base/open_file.hpp"
#include "runtime/base/words.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/core/number.hpp"

#include <algorithm>
#include <ranges>
#include <string_view>
#include <tuple>

namespace tess::dn {
namespace {

using tess::detail::take_word;
using tess::detail::to_number;

/// Reads a line that ends with \n, \r\n or \r. False at the end of the file.
bool read_line(std::istream& file, std::string& line) {
  line.clear();
  std::streambuf& bytes = *file.rdbuf();
  constexpr auto end = std::char_traits<char>::eof();
  for (auto c = bytes.sbumpc(); c != end; c = bytes.sbumpc()) {
    if (c == '\r' && bytes.sgetc() == '\n') bytes.sbumpc();
    if (c == '\n' || c == '\r') return true;
    line += static_cast<char>(c);
  }
  return !line.empty();
}

// The keywords of OBJ beside v and f: elements, and what describes them.
constexpr std::array<std::string_view, 10> elements{"p",   "l",   "curv", "curv2", "surf",
                                                    "bzp", "bsp", "cdc",  "cdp",   "call"};
constexpr std::array<std::string_view, 32> attributes{
    "vt",     "vn",         "vp",        "g",      "s",        "o",        "mg",   "usemtl",
    "mtllib", "usemap",     "maplib",    "bevel",  "c_interp", "d_interp", "lod",  "ctech",
    "stech",  "shadow_obj", "trace_obj", "cstype", "deg",      "bmat",     "step", "parm",
    "trim",   "hole",       "scrv",      "sp",     "end",      "con",      "res",  "csh"};

/// Whether a file begins with bytes that no text has.
bool is_binary(std::istream& file) {
  std::array<char, 1024> bytes{};
  file.seekg(0);
  file.read(bytes.data(), bytes.size());
  return std::ranges::count(bytes.begin(), bytes.begin() + file.gcount(), '\0') > 0;
}

/// Reads a line with those that continue it after a backslash, and without its comment. Counts the
/// lines. False at the end of the file.
bool next_line(std::istream& file, std::string& line, std::size_t& number) {
  line.clear();
  std::string part;
  for (bool more = true; more;) {
    if (!read_line(file, part)) return !line.empty();
    if (++number == 1) part = tess::detail::without_byte_order_mark(part);
    part.resize(std::min(part.find('#'), part.size()));
    while (!part.empty() && tess::detail::is_blank(part.back())) part.pop_back();
    more = part.ends_with('\\');
    if (more) part.back() = ' ';
    line += part;
  }
  return true;
}

/// Reads "17", "17/3", "17//4" or "-1/…"; negative counts from the last vertex.
std::uint32_t face_vertex(std::string_view word, std::size_t n_vertices, const auto& place) {
  std::string_view rest = word;
  const auto written = take_number<long long>(rest);
  if (!written || !(rest.empty() || rest.starts_with('/')) ||
      rest.find_first_not_of("/-0123456789") != std::string::npos)
    fail(ErrorCode::bad_file, place(), ": expected a vertex number in a face, found '", word, "'");
  const auto count = static_cast<long long>(n_vertices);
  const long long index = *written < 0 ? count + *written : *written - 1;
  if (index < 0 || index >= count)
    fail(ErrorCode::bad_file, place(), ": face names vertex ", *written, ", but ", n_vertices,
         " stand before it");
  return static_cast<std::uint32_t>(index);
}

Vec3 vertex(std::string_view line, const auto& place) {
  std::array<double, 3> value{};
  for (double& v : value) {
    const std::string_view word = take_word(line);
    if (!to_number(word, v))
      fail(ErrorCode::bad_file, place(), ": a vertex needs three numbers, found '", word, "'");
  }
  return {value[0], value[1], value[2]};
}

/// Calls visit(from, to) with the vertices of each triangle's sides, as one number each way.
void each_side(const Surface& surface, const auto& visit) {
  const auto number = [](std::uint64_t a, std::uint64_t b) { return tess::mix(a << 32U | b); };
  for (const auto& t : surface.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      if (a != b) visit(number(a, b), number(b, a));
    }
}

/// Whether an odd number of triangles meets at some edge.
bool has_rim(const Surface& surface) {
  std::uint64_t odd = 0;
  each_side(surface, [&](std::uint64_t there, std::uint64_t back) { odd ^= there ^ back; });
  return odd != 0;
}

/// The volume that a closed surface encloses; negative if its triangles face inwards.
double volume_of(const Surface& surface) {
  const Vec3 middle = bounds(surface).centre();
  double volume = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    volume += dot(a - middle, cross(b - middle, c - middle)) / 6;
  }
  return volume;
}

}  // namespace

Bounds bounds(const Surface& surface) {
  Bounds box;
  each_corner(surface, [&](Vec3 p) { box.extend(p); });
  return box;
}

std::uint64_t fingerprint(const Surface& surface) {
  const auto hash = [](const auto& values) {
    return tess::hash_bytes(values.data(), values.size() * sizeof(values[0]));
  };
  return tess::mix(hash(surface.vertices) ^ tess::mix(hash(surface.triangles))) | 1U;
}

void validate(const Surface& surface) {
  if (surface.triangles.empty())
    fail(ErrorCode::bad_mesh, "surface has no triangles; a field needs at least one");
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (const auto v : surface.triangles[t]) {
      if (v >= surface.vertices.size())
        fail(ErrorCode::bad_mesh, "triangle ", t, " names vertex ", v, " of ",
             surface.vertices.size());
      const Vec3 p = surface.vertices[v];
      if (!is_finite(p))
        fail(ErrorCode::bad_mesh, "vertex ", v, " of triangle ", t, " is (", p.x, ", ", p.y, ", ",
             p.z, "); remove it or give it a finite position");
    }
  const Vec3 size = bounds(surface).size();
  if (!(norm(size) > 0) || !is_finite(size))
    fail(ErrorCode::bad_mesh, "surface has extent ", norm(size),
         "; it must be positive and finite");
  const auto has_area = [&](std::size_t t) {
    const auto [a, b, c] = surface.corners(t);
    return norm(cross(b - a, c - a)) > 0;
  };
  const auto numbers = std::views::iota(std::size_t{0}, surface.triangles.size());
  if (std::ranges::none_of(numbers, has_area))
    fail(ErrorCode::bad_mesh, "all ", surface.triangles.size(),
         " triangles are without area; a field needs a surface");
}

bool is_closed(const Surface& surface) {
  std::uint64_t surplus = 0;
  each_side(surface, [&](std::uint64_t there, std::uint64_t back) { surplus += there - back; });
  return surplus == 0;
}

Surface welded(const Surface& surface) {
  // Of the vertices that triangles use: others may be NaN.
  std::vector<std::uint32_t> order, merged(surface.vertices.size());
  for (const auto& t : surface.triangles) order.insert(order.end(), t.begin(), t.end());
  const auto key = [&](std::uint32_t v) {
    const Vec3 p = surface.vertices[v];
    return std::tuple(p.x, p.y, p.z, v);
  };
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return key(a) < key(b); });
  Surface result;
  result.remarks = surface.remarks;
  for (const std::uint32_t v : order) {
    const Vec3 p = surface.vertices[v];
    if (result.vertices.empty() || !(result.vertices.back() == p)) result.vertices.push_back(p);
    merged[v] = static_cast<std::uint32_t>(result.vertices.size() - 1);
  }
  result.triangles.reserve(surface.triangles.size());
  for (const auto& t : surface.triangles)
    result.triangles.push_back({merged[t[0]], merged[t[1]], merged[t[2]]});
  return result;
}

Surface outward(const Surface& surface) {
  constexpr double no_volume = 1e-12;  // of the cube of the diagonal: rounding
  Surface result = is_closed(surface) ? surface : welded(surface);
  const double diagonal = norm(bounds(result).size());
  if (!has_rim(result) && volume_of(result) < -no_volume * diagonal * diagonal * diagonal)
    for (auto& t : result.triangles) std::swap(t[0], t[1]);
  return result;
}

Surface read_obj(const std::string& path) {
  std::ifstream file = tess::detail::open_file(path, "an OBJ file");
  Surface surface;
  std::string line;
  for (std::size_t number = 0; next_line(file, line, number);) {
    const auto place = [&] { return text(path, ":", number); };
    std::string_view rest = line;
    const std::string_view keyword = take_word(rest);
    if (keyword == "v") {
      surface.vertices.push_back(vertex(rest, place));
    } else if (keyword == "f" || keyword == "fo") {  // fo: of version 2
      std::vector<std::uint32_t> polygon;
      for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest))
        polygon.push_back(face_vertex(word, surface.vertices.size(), place));
      if (polygon.size() < 3) fail(ErrorCode::bad_file, place(), ": a face needs three vertices");
      add_polygon(surface, polygon);
    } else if (std::ranges::find(elements, keyword) != elements.end()) {
      ++surface.remarks[text("skipped ", keyword)];
    } else if (!keyword.empty() && std::ranges::find(attributes, keyword) == attributes.end()) {
      ++surface.remarks["skipped lines of no known keyword"];
    }
  }
  if (surface.triangles.empty())
    fail(ErrorCode::bad_file, path, ": holds no faces: ",
         is_binary(file) ? "it is not text, as an OBJ file is; name it by its format"
                         : "an OBJ file has lines f 1 2 3");
  return surface;
}

std::vector<double> area_sums(const Surface& surface) {
  std::vector<double> sums;
  sums.reserve(surface.triangles.size());
  double sum = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    sums.push_back(sum += 0.5 * norm(cross(b - a, c - a)));
  }
  return sums;
}

SurfacePoint point_on(const Surface& surface, const std::vector<double>& sums, double first,
                      double second, double third) {
  const auto found = std::upper_bound(sums.begin(), sums.end() - 1, first * sums.back());
  const auto triangle = static_cast<std::uint32_t>(found - sums.begin());
  const auto [a, b, c] = surface.corners(triangle);
  const double root = std::sqrt(second);
  return {(1 - root) * a + (root * (1 - third)) * b + (root * third) * c,
          direction(cross(b - a, c - a)), triangle};
}

}  // namespace tess::dn
