// The files of --out.
#include "apps/collide_scene/output/files.hpp"

#include "apps/collide_scene/output/view.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <cstring>
#include <set>

using namespace collide_scene;

namespace {

/// The numbers of an appended array, by its name.
template <class T>
std::vector<T> array_of(const std::string& vtp, const std::string& name) {
  const std::size_t at = vtp.find("Name=\"" + name + "\"");
  REQUIRE(at != std::string::npos);
  const std::size_t offset = std::stoul(vtp.substr(vtp.find("offset=\"", at) + 8));
  const std::size_t begin = vtp.find("encoding=\"raw\">\n_") + 17 + offset;
  std::uint64_t n_bytes = 0;
  std::memcpy(&n_bytes, vtp.data() + begin, sizeof n_bytes);
  std::vector<T> values(n_bytes / sizeof(T));
  std::memcpy(values.data(), vtp.data() + begin + sizeof n_bytes, n_bytes);
  return values;
}

Scene two_triangles() {
  Scene scene;
  scene.triangles = {{{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}}, {{{{1, 1, -1}, {1, 1, 1}, {2, 2, 0}}}}};
  scene.models = {0, 1};
  return scene;
}

}  // namespace

TEST_CASE("the file of hits has each triangle with its hits and its model",
          "[apps][collide_scene]") {
  const std::vector<std::uint32_t> n_hits{5, 7};
  const std::string vtp = hits_vtp(two_triangles(), n_hits);
  CHECK_THAT(vtp, Contains("NumberOfPoints=\"6\" NumberOfPolys=\"2\""));
  CHECK(array_of<std::uint32_t>(vtp, "hits") == n_hits);
  CHECK(array_of<std::uint32_t>(vtp, "model") == std::vector<std::uint32_t>{0, 1});
  CHECK(array_of<std::int64_t>(vtp, "offsets") == std::vector<std::int64_t>{3, 6});
  const auto points = array_of<double>(vtp, "Points");
  REQUIRE(points.size() == 18);
  CHECK(points[3] == 4);
  CHECK(points[11] == -1);
}

TEST_CASE("boxes are six faces in the file of hits", "[apps][collide_scene]") {
  Scene scene;
  scene.boxes = {{{0, 0, 0}, {1, 2, 3}}};
  const std::string vtp = hits_vtp(scene, std::vector<std::uint32_t>{1});
  CHECK(array_of<std::uint32_t>(vtp, "object") == std::vector<std::uint32_t>(6, 0));
  CHECK(array_of<double>(vtp, "Points").size() == 6 * 4 * 3);
}

TEST_CASE("the file of pairs has a segment between the centres of each", "[apps][collide_scene]") {
  const std::string vtp = pairs_vtp(two_triangles(), std::vector<ScenePair>{{0, 1}});
  CHECK_THAT(vtp, Contains("NumberOfLines=\"1\""));
  CHECK(array_of<double>(vtp, "Points") == std::vector<double>{2, 2, 0, 1.5, 1.5, 0});
  CHECK(array_of<std::uint32_t>(vtp, "second") == std::vector<std::uint32_t>{1});
}

TEST_CASE("a pixel shows the triangle that is nearest to the viewer", "[apps][collide_scene]") {
  Scene scene;
  for (const double z : {0.0, 2.0, 1.0})
    scene.triangles.push_back({{{{-9, -9, z}, {9, -9, z}, {0, 9, z}}}});
  const View view(scene, 200);
  const std::uint32_t middle = view.at(view.width() / 2, view.height() / 2);
  REQUIRE(middle != View::nothing);
  CHECK(view.triangles()[middle].object == 1);
  CHECK(view.at(0, 0) == View::nothing);
  // From the farthest to the nearest.
  const std::vector<std::uint32_t> visible = view.visible();
  REQUIRE(visible.size() == 3);
  CHECK(view.triangles()[visible.back()].object == 1);
}

TEST_CASE("the picture shows scenes of points, far away and of one place",
          "[apps][collide_scene]") {
  Scene points;
  points.boxes = {{{1e12, 1, 1}, {1e12, 1, 1}}, {{1e12, 1, 1}, {1e12, 1, 1}}};
  points.description = "<&>";
  const std::string svg = picture(points, std::vector<std::uint32_t>{1, 1});
  CHECK_THAT(svg, Contains("2 of 2 objects collide"));
  CHECK_THAT(svg, Contains("&lt;&amp;&gt;"));
  CHECK_THAT(svg, !Contains("nan"));
  // Many triangles become rows of pixels.
  const Scene wave = make_scene("wave:131072");
  CHECK_THAT(picture(wave, std::vector<std::uint32_t>(wave.n_objects(), 0)), !Contains("M0 "));
  CHECK_THAT(picture(wave, std::vector<std::uint32_t>(wave.n_objects(), 0)), Contains("h"));
}

TEST_CASE("a scene in which nearly all collide has many colours", "[apps][collide_scene]") {
  const Scene planes = make_scene("planes:512");
  std::vector<std::uint32_t> n_hits(planes.n_objects(), 8);
  for (std::uint32_t i = 0; i < n_hits.size(); i += 2) n_hits[i] = 5 + i % 3;
  const std::string svg = picture(planes, n_hits);
  CHECK_THAT(svg, Contains("hits per object: 5"));
  // Half of the objects have the most hits: they are in the middle of the upper half of the ramp.
  std::set<std::string> of_ramp;
  for (std::size_t at = svg.find("objects collide"); (at = svg.find("fill=\"#", at)) != svg.npos;
       ++at)
    of_ramp.insert(svg.substr(at + 6, 7));
  CHECK(of_ramp.size() >= 4);
  CHECK(!of_ramp.contains("#54148c"));
}

TEST_CASE("owners have a colour each, and stand on their voxels", "[apps][collide_scene]") {
  Scene scene;
  for (int i = 0; i < 4; ++i) scene.boxes.push_back({{2.0 * i, 0, 0}, {2.0 * i + 1, 4, 1}});
  const std::string two = picture_of_owners(scene, 2, 2);
  CHECK_THAT(two, Contains("voxels of 2: squares; owners, PEs 0 to 1"));
  CHECK_THAT(two, Contains("#0072b2") && Contains("#d55e00"));
  const std::size_t lines = two.find("#777");
  // x from 0 to 7 in steps of 2, y from 0 to 4.
  CHECK(std::ranges::count(two.substr(lines, two.find("/>", lines) - lines), 'M') == 5 + 3);
  CHECK_THAT(picture_of_owners(scene, 1, 2), !Contains("#d55e00"));
  CHECK_THAT(picture_of_owners(scene, 1, 1e-3), !Contains("#777"));
}

TEST_CASE("files that cannot be written are refused before the run", "[apps][collide_scene]") {
  const tess::test::Scratch scratch;
  kit::FileNames files;
  const std::string prefix = scratch.path("here/scene");
  prepare_files(prefix, endings(), files);
  CHECK(tess::test::message_of([&] {
          files.writes("--json", prefix + ".svg");
        }).starts_with("--json "));
  std::filesystem::create_directories(prefix + "_hits.vtp");
  kit::FileNames again;
  CHECK(tess::test::message_of([&] {
          prepare_files(prefix, endings(), again);
        }).starts_with("--out "));
}
