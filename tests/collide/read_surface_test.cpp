// Files of triangles: nothing is lost, merged or moved, and what is damaged is refused by name.
#include "collide/read_surface.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <cmath>
#include <cstring>
#include <fmt/format.h>

using tess::dn::read_surface, tess::dn::Surface, tess::test::message_of;

namespace {

using Corners = std::array<std::array<double, 3>, 3>;

/// All triangles by their corners, in order.
std::vector<Corners> soup(const Surface& surface) {
  std::vector<Corners> out;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    Corners& corners = out.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const auto p = surface.corners(t)[i];
      corners[i] = {p.x, p.y, p.z};
    }
  }
  return out;
}

template <class T>
std::string bytes_of(T value, bool reversed) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (reversed) std::ranges::reverse(bytes);
  return bytes;
}

// A triangle, the same again, one with an edge of no length, a point, and a fan of two.
const std::string obj =
    "v 0 0 0\nv 1 0 0\nv 0 .5 0\nv 3 0 0.25\n"
    "f 1 2 3\nf 1/1/1 2//2 3/7\nf 1 1 2\nf 4 4 4\nf -4 -3 -1 -2\n";
const std::vector<Corners> triangles{
    {{{0, 0, 0}, {1, 0, 0}, {0, 0.5, 0}}},  {{{0, 0, 0}, {1, 0, 0}, {0, 0.5, 0}}},
    {{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}}},    {{{3, 0, 0.25}, {3, 0, 0.25}, {3, 0, 0.25}}},
    {{{0, 0, 0}, {1, 0, 0}, {3, 0, 0.25}}}, {{{0, 0, 0}, {3, 0, 0.25}, {0, 0.5, 0}}},
};

/// The same as PLY: with a property and an element that are passed over.
std::string ply(const std::string& format, const std::string& real) {
  const bool text = format == "ascii", reversed = format == "binary_big_endian";
  std::string out = "ply\nformat " + format + " 1.0\ncomment made by a test\nelement vertex 4\n";
  for (const char* name : {"x", "y", "z"}) out += "property " + real + " " + name + "\n";
  out += "property uchar red\nelement material 2\nproperty list uchar short ids\n";
  out += "element face 5\nproperty list uchar int vertex_indices\nend_header\n";
  const auto put = [&](auto value) {
    out += text ? std::to_string(value) + " " : bytes_of(value, reversed);
  };
  const double places[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 0.5, 0}, {3, 0, 0.25}};
  for (const auto& place : places) {
    for (const double at : place) real == "double" ? put(at) : put(static_cast<float>(at));
    put(std::uint8_t{200});
    if (text) out += "\n";
  }
  put(std::uint8_t{2}), put(std::int16_t{-5}), put(std::int16_t{7});
  put(std::uint8_t{0});
  const std::vector<std::vector<int>> faces{
      {0, 1, 2}, {0, 1, 2}, {0, 0, 1}, {3, 3, 3}, {0, 1, 3, 2}};
  for (const auto& face : faces) {
    put(static_cast<std::uint8_t>(face.size()));
    for (const int v : face) put(v);
    if (text) out += "\n";
  }
  return out;
}

std::string binary_stl(const std::vector<Corners>& of) {
  std::string out(80, '\0');
  out += bytes_of(static_cast<std::uint32_t>(of.size()), false);
  for (const Corners& corners : of) {
    for (const float normal : {0.F, 0.F, 1.F}) out += bytes_of(normal, false);
    for (const auto& corner : corners)
      for (const double at : corner) out += bytes_of(static_cast<float>(at), false);
    out += bytes_of(std::uint16_t{0}, false);
  }
  return out;
}

std::string text_stl(const std::vector<Corners>& of) {
  std::string out = "solid part\n";
  for (const Corners& corners : of) {
    out += "facet normal 0 0 1\nouter loop\n";
    for (const auto& [x, y, z] : corners)
      out +=
          "vertex " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
    out += "endloop\nendfacet\n";
  }
  return out + "endsolid part\n";
}

}  // namespace

TEST_CASE("every format keeps all triangles, also degenerate and duplicate ones, in order",
          "[collide][surface]") {
  const tess::test::Scratch scratch;
  CHECK(soup(read_surface(scratch.write("a.obj", obj))) == triangles);
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"})
    for (const char* real : {"float", "double"}) {
      INFO(format << " " << real);
      CHECK(soup(read_surface(scratch.write("a.ply", ply(format, real)))) == triangles);
    }
  CHECK(soup(read_surface(scratch.write("a.stl", binary_stl(triangles)))) == triangles);
  CHECK(soup(read_surface(scratch.write("A.STL", text_stl(triangles)))) == triangles);
}

TEST_CASE(
    "an OBJ file may have tabs, indents, comments, continued lines, line ends of any kind and "
    "a byte order mark",
    "[collide][surface]") {
  const tess::test::Scratch scratch;
  const std::string plain = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n";
  const auto expected = soup(read_surface(scratch.write("plain.obj", plain)));
  REQUIRE(expected.size() == 2);
  for (const char* text :
       {"v\t0\t0\t0\nv\t1 0 0\nv 0 1 0\nv 0 0 1\nf\t1\t2\t3\nf 1 2 4\n",
        "  v 0 0 0\n\tv 1 0 0\n v 0 1 0\nv 0 0 1 \n  f 1 2 3\n\tf 1 2 4\t\n",
        "\xEF\xBB\xBFv 0 0 0\nv 1 0 0 # right\nv 0 1 0\nv 0 0 1\nf 1 2 3 # front\n#f 1 2 3\nf 1 2 "
        "4",
        "v 0 0 \\\n0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 \\\r\n 2 \\\n 3\nf 1 2 4\\",
        "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nv 0 0 1\r\nf 1/2 2/3/4 3//5\r\nf -4 -3 -1\r\n",
        "# old\rv 0 0 0\rv 1 0 0\rv 0 1 0\r\rv 0 0 1\rf 1 \\\r 2 3\rf 1 2 4"}) {
    INFO(text);
    CHECK(soup(read_surface(scratch.write("a.obj", text))) == expected);
  }
}

TEST_CASE("what is no triangle of a surface is named, and strips of PLY are read",
          "[collide][surface]") {
  const tess::test::Scratch scratch;
  const Surface lines = read_surface(scratch.write(
      "a.obj",
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\ns off\nl 1 2\nl 2 3\np 1\nF 1 2 3\nfo 1 2 3\n"));
  CHECK(lines.triangles.size() == 1);
  CHECK(remarks_text(lines) == "skipped l: 2, skipped lines of no known keyword: 1, skipped p: 1");
  CHECK(remarks_text(read_surface(scratch.write("a.obj", obj))) == "polygons that are not flat: 1");
  CHECK(remarks_text(read_surface(scratch.write("a.ply", ply("ascii", "float")))) ==
        "polygons that are not flat: 1, skipped material: 2");
  // The faces of a cube: one as a face, the others as strips, of which -1 begins the next.
  const std::vector<std::vector<int>> strips{
      {4, 5, 6, 7}, {0, 1, 4, 5}, {2, 6, 3, 7}, {0, 4, 2, 6}, {1, 3, 5, 7}};
  for (const bool text : {true, false}) {
    std::string bytes = std::string("ply\nformat ") + (text ? "ascii" : "binary_little_endian") +
                        " 1.0\nelement tristrips 1\nproperty list int int vertex_indices\n"
                        "element vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
                        "element face 1\nproperty list int int vertex_indices\nend_header\n";
    const auto put = [&](auto value) {
      bytes += text ? std::to_string(value) + " " : bytes_of(value, false);
    };
    put(25);
    for (const auto& strip : strips) {
      for (const int v : strip) put(v);
      put(-1);
    }
    for (int v = 0; v < 8; ++v)
      for (const int bit : {1, 2, 4}) put((v & bit) != 0 ? 1.F : 0.F);
    for (const int v : {4, 0, 2, 3, 1}) put(v);
    const Surface cube = read_surface(scratch.write("strips.ply", bytes));
    CHECK(cube.triangles.size() == 12);
    CHECK(is_closed(cube));  // each strip turns every other triangle round
    CHECK(remarks_text(cube).empty());
  }
  // Repeated vertices join two strips, with no surface between them.
  const Surface joined = read_surface(scratch.write(
      "joined.ply",
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty "
      "float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n9 0 0\n8 0 0\n9 1 0\n8 1 0\n"
      "10 0 1 2 3 3 4 4 5 6 7\n3 0 1 2\n"));
  CHECK(joined.triangles.size() == 4);
  CHECK(remarks_text(joined) == "skipped text behind the last element: 1");
}

TEST_CASE("a polygon that is not convex is cut inside itself, from whichever corner it begins",
          "[collide][surface]") {
  const tess::test::Scratch scratch;
  using Outline = std::vector<std::array<double, 2>>;
  const auto area_of = [](const Outline& outline) {
    double area = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const auto &a = outline[i], &b = outline[(i + 1) % outline.size()];
      area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    }
    return area;
  };
  // The planes along the axes, and one across them. Coordinates stay exact.
  const auto placed = [](const std::array<double, 2>& p, int plane) {
    const auto [x, y] = p;
    return plane == 0   ? tess::dn::Vec3{x, y, 0}
           : plane == 1 ? tess::dn::Vec3{0, x, y}
           : plane == 2 ? tess::dn::Vec3{y, 0, x}
                        : tess::dn::Vec3{x, y, x + y};
  };
  const auto read = [&](const Outline& outline, std::size_t first, bool turned, int plane) {
    std::string corners, face = "f", list;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const std::size_t at = turned ? outline.size() - 1 - i : i;
      const auto p = placed(outline[(first + at) % outline.size()], plane);
      corners += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
      face += fmt::format(" {}", i + 1);
      list += fmt::format(" {}", i);
    }
    const Surface of_obj = read_surface(scratch.write("a.obj", corners + face + "\n"));
    // PLY may have the face before its corners.
    std::string rows = corners;
    std::erase(rows, 'v');
    const Surface of_ply = read_surface(scratch.write(
        "a.ply", fmt::format("ply\nformat ascii 1.0\nelement face 1\nproperty list int int "
                             "vertex_indices\nelement vertex {0}\nproperty double x\nproperty "
                             "double y\nproperty double z\nend_header\n{0}{1}\n{2}",
                             outline.size(), list, rows)));
    CHECK(of_ply.triangles == of_obj.triangles);
    CHECK(of_ply.remarks == of_obj.remarks);
    return of_obj;
  };
  Outline spiral{{0, 0}, {5, 0}, {5, 5}, {1, 5}, {1, 2}, {3, 2}, {3, 3}};
  spiral.insert(spiral.end(), {{2, 3}, {2, 4}, {4, 4}, {4, 1}, {0, 1}});
  // An L, a comb, a square with corners on its sides, a spiral, and a square with a square hole that
  // a side joins to the outline there and back.
  const std::vector<Outline> outlines{
      {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
      {{0, 0}, {7, 0}, {7, 3}, {6, 1}, {5, 3}, {4, 1}, {3, 3}, {2, 1}, {1, 3}},
      {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {1, 3}, {0, 3}, {0, 2}, {0, 1}},
      spiral,
      {{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}, {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}},
      {{0, 0}, {4, 1}, {8, 0}, {4, 6}}};
  for (std::size_t k = 0; k < outlines.size(); ++k)
    for (std::size_t first = 0; first < outlines[k].size(); ++first)
      for (const bool turned : {false, true})
        for (int plane = 0; plane < 4; ++plane) {
          const Outline& outline = outlines[k];
          CAPTURE(k, first, turned, plane);
          const Surface surface = read(outline, first, turned, plane);
          CHECK(remarks_text(surface).empty());
          REQUIRE(surface.triangles.size() == outline.size() - 2);
          // The triangles have the outline's area, and none is turned the other way.
          const double stretch = plane == 3 ? std::sqrt(3.0) : 1;
          tess::dn::Vec3 sum{};
          double absolute = 0;
          for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
            const auto [a, b, c] = surface.corners(t);
            const auto twice = cross(b - a, c - a);
            sum = sum + 0.5 * twice;
            absolute += 0.5 * norm(twice);
          }
          CHECK(absolute == Approx(area_of(outline) * stretch).epsilon(1e-12));
          CHECK(norm(sum) == Approx(absolute).epsilon(1e-12));
        }
  // A convex polygon stays a fan, also one with corners on its sides.
  const Outline square{{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 2}, {0, 2}};
  for (std::size_t first = 0; first < square.size(); ++first)
    CHECK(read(square, first, false, 0).triangles ==
          std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}});
}

TEST_CASE("a polygon that crosses itself stays a fan, and is counted as one that is not flat is",
          "[collide][surface]") {
  const tess::test::Scratch scratch;
  const auto remarks_of = [&](const std::string& corners, const std::string& face) {
    const Surface surface = read_surface(scratch.write("a.obj", corners + "f " + face + "\n"));
    CHECK(surface.triangles[0] == std::array<std::uint32_t, 3>{0, 1, 2});
    return remarks_text(surface);
  };
  const std::string square = "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\n";
  CHECK(remarks_of(square, "1 2 3 4") == "polygons that cross themselves: 1");
  CHECK(remarks_of("v 0 5 0\nv 3 -4 0\nv -5 1 0\nv 5 1 0\nv -3 -4 0\n", "1 2 3 4 5") ==
        "polygons that cross themselves: 1");
  CHECK(remarks_of("v 0 0 0\nv 1 0 0\nv 1 1 .1\nv 0 1 0\n", "1 2 3 4") ==
        "polygons that are not flat: 1");
  CHECK(remarks_of("v 0 0 0\nv 1 0 0\nv 1 1 1e-7\nv 0 1 0\n", "1 2 3 4").empty());
  CHECK(remarks_of("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\n", "1 2 3 4").empty());
}

TEST_CASE("a surface without area, or a very small one, is a surface for a collision",
          "[collide][surface]") {
  const tess::test::Scratch scratch;
  for (const char* last : {"v 2 0 0\n", "v 0 1e-170 0\n"})
    CHECK(soup(read_surface(
                   scratch.write("a.obj", std::string("v 0 0 0\nv 1 0 0\n") + last + "f 1 2 3\n")))
              .size() == 1);
}

TEST_CASE(
    "STL is read in capital letters, of several solids, and with some bytes behind its facets",
    "[collide][surface]") {
  const tess::test::Scratch scratch;
  std::string text = text_stl(triangles);
  text.replace(text.find("0.5"), 3, ".5");
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::toupper(c); });
  auto twice = triangles;
  twice.insert(twice.end(), triangles.begin(), triangles.end());
  CHECK(soup(read_surface(scratch.write("a.stl", text + text_stl(triangles) + "\r\n"))) == twice);
  std::string binary = binary_stl(triangles) + "more";
  binary.replace(0, 6, "solid ");
  CHECK(soup(read_surface(scratch.write("a.stl", binary))) == triangles);
}

TEST_CASE("STL of other writers is read: words apart, binary that begins with solid, a count of 0",
          "[collide][surface]") {
  const tess::test::Scratch scratch;
  std::string apart = text_stl(triangles);
  for (const std::string word : {"loop", "facet", "solid"})
    for (std::size_t at = apart.find("end" + word); at != std::string::npos;
         at = apart.find("end" + word))
      apart.insert(at + 3, " ");
  CHECK(soup(read_surface(scratch.write("a.stl", apart))) == triangles);
  CHECK_THROWS_WITH(read_surface(scratch.write("a.stl", "solid\nfacette 0 0 1\nendsolid\n")),
                    Contains("a.stl:2: no line of an STL file begins with 'facette'"));
  std::string solid = binary_stl(triangles);
  solid.replace(0, 6, "solid ");
  const Surface more = read_surface(scratch.write("a.stl", solid + std::string(120, 'x')));
  CHECK(soup(more) == triangles);
  CHECK(remarks_text(more) == "bytes behind the last facet: 120");
  std::string uncounted = solid;
  uncounted.replace(80, 4, 4, '\0');
  const Surface all = read_surface(scratch.write("a.stl", uncounted));
  CHECK(soup(all) == triangles);
  CHECK(remarks_text(all) == "facets that the header does not announce: 6");
  CHECK_THROWS_WITH(read_surface(scratch.write("a.stl", solid.substr(0, solid.size() - 9))),
                    Contains("announces 6 facets, but has bytes for 5; it is truncated"));
}

TEST_CASE("PLY of other writers is read: blanks in the header, longer rows, what is no number",
          "[collide][surface]") {
  const tess::test::Scratch scratch;
  const std::string head =
      "ply \nformat ascii 1.0\t\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty float quality\nelement face 1\n"
      "property list uchar int vertex_indices\nproperty list uchar float weights\nend_header \n";
  const auto read = [&](const std::string& rows) {
    return read_surface(scratch.write("a.ply", head + rows));
  };
  const std::vector<Corners> one{{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}};
  const Surface plain = read("0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2 1 -1.#IND\n");
  CHECK(soup(plain) == one);
  CHECK(plain.remarks.empty());
  const Surface longer = read("0 0 0 -1.#IND 8\n1 0 0 1.#QNAN\n\n0 1 0 red 255 0\n3 0 1 2 0 7 7 7");
  CHECK(soup(longer) == one);
  CHECK(remarks_text(longer) == "rows with more numbers than the header announces: 3");
  CHECK(soup(read("0 0 0 1 1 0 0\n1 0 1 0 1 3 0 1 2 0\n")) == one);  // rows broken elsewhere
  CHECK_THROWS_WITH(read("0 0 0 1\n1 0 0\n0 1 0 1\n3 0 1 2 0\n"),
                    Contains("vertex 1 of 3: its line ends before all that the header announces"));
  CHECK_THROWS_WITH(read("0 0 0 1\n1 -1.#IND 0 1\n0 1 0 1\n3 0 1 2 0\n"),
                    Contains("vertex 1 of 3: '-1.#IND' is not a number"));
}

TEST_CASE("a byte order mark stands before any text", "[collide][surface]") {
  const tess::test::Scratch scratch;
  const std::string mark = "\xEF\xBB\xBF";
  CHECK(soup(read_surface(scratch.write("a.obj", mark + obj))) == triangles);
  CHECK(soup(read_surface(scratch.write("a.ply", mark + ply("ascii", "double")))) == triangles);
  CHECK(soup(read_surface(scratch.write("a.stl", mark + text_stl(triangles)))) == triangles);
}

TEST_CASE("text is read in double precision", "[collide][surface]") {
  const tess::test::Scratch scratch;
  const std::string x = "500000.123456789";
  const Surface of_obj =
      read_surface(scratch.write("a.obj", "v " + x + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  CHECK(of_obj.vertices[0].x == 500000.123456789);
  const Surface of_ply = read_surface(scratch.write(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
      "property double z\nelement face 1\nproperty list uchar int vertex_index\n"
      "end_header\n" +
          x + " 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
  CHECK(of_ply.vertices[0].x == 500000.123456789);
  const Surface of_stl = read_surface(scratch.write(
      "a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex " + x +
                   " 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n"));
  CHECK(of_stl.vertices[0].x == 500000.123456789);
}

TEST_CASE("a file that is cut anywhere is refused by its name", "[collide][surface]") {
  const tess::test::Scratch scratch;
  for (const char* format : {"ascii", "binary_little_endian"}) {
    const std::string whole = ply(format, "float");
    // The last character of the text is a blank.
    for (std::size_t n = 0; n + 2 < whole.size(); ++n) {
      const std::string path = scratch.write("cut.ply", whole.substr(0, n));
      const std::string message = message_of([&] { (void)read_surface(path); });
      if (!message.starts_with(path + ": ")) FAIL(format << ", " << n << " bytes: " << message);
    }
  }
  // The last word of the text is endsolid, whatever follows.
  for (const std::string& stl : {binary_stl(triangles), text_stl(triangles)})
    for (std::size_t n = 0; n + 7 < stl.size(); n += 7) {
      const std::string path = scratch.write("cut.stl", stl.substr(0, n));
      CHECK(message_of([&] { (void)read_surface(path); }).starts_with(path + ":"));
    }
}

TEST_CASE("what is no surface is refused with its name and the reason", "[collide][surface]") {
  const tess::test::Scratch scratch;
  const auto refused = [&](const std::string& name, const std::string& bytes) {
    const std::string path = scratch.write(name, bytes);
    const std::string message = message_of([&] { (void)read_surface(path); });
    CHECK(message.starts_with(path));
    return message;
  };
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  CHECK_THAT(refused("a.obj", ""), Contains("holds no faces"));
  CHECK_THAT(refused("a.obj", "not a mesh\n"), Contains("holds no faces: an OBJ file has lines f"));
  CHECK_THAT(refused("a.obj", binary_stl(triangles)), Contains("no faces: it is not text"));
  CHECK_THAT(refused("a.obj", "v 0 0 0\rv 1 0 0\r\nf 1 2 9\r"),
             Contains(":3: face names vertex 9"));
  CHECK_THAT(refused("a.obj", "v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n"), Contains("vertex 2"));
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const char* face : {"1.5 2 3", "1 2 3/a", "1x 2 3", "1 2 three", "1 \v 3"})
    CHECK_THAT(refused("a.obj", corners + "f " + face + "\n"),
               Contains(":4: expected a vertex number in a face"));
  CHECK_THAT(refused("a.obj", "v 0 0\nf 1 1 1\n"), Contains(":1: a vertex needs three numbers"));
  CHECK_THAT(refused("a.obj", "v 0 0,5 0\nf 1 1 1\n"), Contains("found '0,5'"));
  CHECK_THAT(refused("a.ply", "solid\n"), Contains("not a PLY file"));
  CHECK_THAT(refused("a.ply", head + faces + "0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n"),
             Contains("vertex 2 of triangle 0") && Contains("not finite"));
  CHECK_THAT(refused("a.ply", head + faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
             Contains("has vertex 3, but there are 3"));
  CHECK_THAT(refused("a.ply", head + faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"),
             Contains("vertex -1 does not exist"));
  CHECK_THAT(refused("a.ply", head + faces + "0 0 0\n1 0 0\n0 1 0\n2 0 1\n"),
             Contains("a face needs three"));
  CHECK_THAT(refused("a.ply", head + faces + "0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n"),
             Contains("vertex 1 of 3: 'zero' is not a number"));
  CHECK_THAT(refused("a.ply", head + "end_header\n0 0 0\n1 0 0\n0 1 0\n"),
             Contains("holds no triangles"));
  CHECK_THAT(
      refused("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n" + faces),
      Contains("no property y"));
  CHECK_THAT(refused("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty real x\n" + faces),
             Contains("unknown type 'real'"));
  CHECK_THAT(refused("a.ply", "ply\nformat ascii 1.0\nelement dust 99999999999\nend_header\n"),
             Contains("elements without properties"));
  CHECK_THAT(refused("a.stl", binary_stl({})), Contains("holds no triangles"));
  CHECK_THAT(refused("a.stl", binary_stl({}) + std::string(50, 'x')), Contains("not an STL file"));
  const std::string vertex = "solid\nvertex 0 0 0\n";
  CHECK_THAT(refused("a.stl", vertex + "endloop\n"), Contains("a.stl:3: a facet of 1 vertices"));
  CHECK_THAT(refused("a.stl", vertex + "endsolid\n"), Contains("without endloop"));
  CHECK_THAT(refused("a.stl", vertex + "vertex 0 zero 0\n"), Contains("a.stl:3: a vertex needs"));
  CHECK_THAT(refused("a.stl", vertex + "\1\n"), Contains("a.stl:3: no line of an STL file"));
  CHECK_THAT(refused("a.stl", vertex + vertex + vertex + vertex + "endloop\nendsolid"),
             Contains("a.stl:9: a facet of 4 vertices") && Contains("divide it"));
  CHECK_THAT(refused("a.stl", "hello"), Contains("not an STL file"));
  CHECK_THAT(refused("a.stl", binary_stl({{{{0, 0, 0}, {1, 0, 0}, {0, NAN, 0}}}})),
             Contains("not finite"));
  CHECK_THAT(refused("a.txt", obj), Contains("give a file .obj, .ply or .stl"));
  CHECK(message_of([&] {
          (void)read_surface(scratch.path("none.ply"));
        }).starts_with(scratch.path("none.ply")));
}
