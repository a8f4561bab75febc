// The files that a run writes: pictures and snapshots.
#include "apps/kit/output/contour.hpp"
#include "apps/particles/output/files.hpp"
#include "tests/apps/particles/run_scene.hpp"
#include "tests/support/scratch.hpp"

#include <algorithm>
#include <sstream>

using namespace particles;

namespace {

double area_of(const std::vector<kit::Point>& line) {  // negative: clockwise
  double twice = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const kit::Point &a = line[i], &b = line[(i + 1) % line.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return twice / 2;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; ++at) ++n;
  return n;
}

/// The commands of the one path with this attribute, without letters.
std::string path_with(const std::string& svg, const std::string& attribute) {
  REQUIRE(count(svg, attribute) == 1);
  const std::size_t at = svg.find(" d=\"", svg.find(attribute)) + 4;
  std::string path = svg.substr(at, svg.find('"', at) - at);
  for (char& c : path)
    if (c == 'M' || c == 'L') c = ' ';
  return path;
}

Scene with_object(const std::string& object, const std::string& outputs = "{}") {
  return scene_of(R"({"dt": 0.01, "steps": 100, "objects": [)" + object +
                  R"(], "emitters": [{"count": 1, "sphere": {"radius": 1}}], "outputs": )" +
                  outputs + "}");
}

/// Why the files of a run or study are refused beside others that are written; empty if they are
/// not.
std::string message(const Scene& scene, const Options& options,
                    const std::vector<std::pair<std::string, std::string>>& written = {}) {
  return tess::test::message_of([&] {
    kit::FileNames names;
    for (const auto& [option, file] : written) names.writes(option, file);
    prepare_files(scene, options, names);
  });
}

}  // namespace

TEST_CASE("a snapshot's file holds each particle once, in the order of ids", "[particles]") {
  const Snapshot snapshot{7, {{3, {1, 2, 3}, {4, 5, 6}}, {9, {0.5, 0, -1}, {}}}};
  const std::string file = vtp(snapshot);
  CHECK_THAT(file, Contains("NumberOfPoints=\"2\""));
  CHECK_THAT(file, Contains("format=\"ascii\">\n3\n9\n<"));
  CHECK_THAT(file, Contains("format=\"ascii\">\n1 2 3\n0.5 0 -1\n<"));
}

TEST_CASE("contours lie where the values say, closed, and around holes the other way",
          "[particles]") {
  // A ring around (10, 10), between the radii 3 and 6.
  const auto ring = [](int i, int j) { return std::abs(std::hypot(i - 10, j - 10) - 4.5) - 1.5; };
  const auto lines = kit::contours(21, 21, ring, 0);
  REQUIRE(lines.size() == 2);
  double sum = 0;
  for (const auto& line : lines) {
    const double radius = area_of(line) > 0 ? 6 : 3;
    for (const kit::Point& p : line)
      CHECK(std::hypot(p.x - 10, p.y - 10) == Approx(radius).margin(0.05));
    sum += area_of(line);
  }
  CHECK(sum == Approx(27 * std::acos(-1.0)).epsilon(0.02));
  // A region that reaches the border follows it.
  const auto half = kit::contours(
      5, 4, [](int i, int) { return i - 2.25; }, 0);
  REQUIRE(half.size() == 1);
  CHECK(area_of(half[0]) == Approx(2.25 * 3));
  CHECK(kit::contours(
            5, 4, [](int, int) { return NAN; }, 0)
            .empty());
  // Two corners of one square touch by neither rule twice: each is a line of its own.
  const auto corners = [](int i, int j) { return (i + j) % 2 == 0 ? -1.0 : 1.0; };
  CHECK(kit::contours(2, 2, corners, 0).size() == 2);
}

TEST_CASE("a cut through a field draws the surface where it is", "[particles]") {
  const Scene scene =
      with_object(R"({"shape": {"sphere": {"radius": 1}}, "resolution": 24, "thickness": 1})");
  const auto field = build_alone(scene.objects[0], tess::dn::Content::distance_and_normal);
  const std::string path = path_with(slice_svg(field, 2, 0), "stroke-width=\"1.5\"");
  // 140 pixels per unit; the layer lies half a cell off the middle.
  std::istringstream numbers(path);
  const double cell = 4.0 / 23, radius = 140 * std::sqrt(1 - cell * cell / 4);
  std::size_t n = 0;
  for (double x = 0, y = 0; numbers >> x >> y; ++n)
    CHECK(std::hypot(x - 64 - 280, y - 34 - 280) == Approx(radius).margin(1.5));
  CHECK(n > 40);
}

TEST_CASE("the arrows of a cut stand in the middle of their voxels, also far from the origin",
          "[particles]") {
  const auto arrows = [](const std::string& low, const std::string& high) {
    const Scene scene =
        with_object(R"({"shape": {"boxes": [{"low": [)" + low + R"(, 0, 0], "high": [)" + high +
                    R"(, 0.6, 0.6]}]}, "resolution": 40, "thickness": 0.2})");
    const auto field = build_alone(scene.objects[0], tess::dn::Content::distance_and_normal);
    std::istringstream numbers(path_with(slice_svg(field, 2, 0.3), "stroke-width=\"0.8\""));
    std::vector<double> all;
    for (double x = 0; numbers >> x;) all.push_back(x);
    return all;
  };
  const std::vector<double> near = arrows("0", "0.6"), far = arrows("1000000", "1000000.6");
  CHECK(near.size() > 1000);
  REQUIRE(far.size() == near.size());
  // An arrow is five points, of which the first is its foot. Its direction may differ: halfway
  // between two faces rounding decides which one is nearer.
  double off = 0;  // pixels
  for (std::size_t i = 0; i + 1 < near.size(); i += 10)
    off = std::max({off, std::abs(far[i] - near[i]), std::abs(far[i + 1] - near[i + 1])});
  CHECK(off < 0.15);
}

TEST_CASE("vertices that no triangle uses are neither in the arena nor in the picture",
          "[particles]") {
  const tess::test::Scratch scratch;
  const std::string mesh =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const auto with_more = [&](const char* name, const std::string& more) {
    const std::string file = scratch.write(name, mesh + more);
    return scene_of(R"({"dt": 0.01, "steps": 1, "objects": [{"shape": {"file": ")" + file +
                    R"("}}], "emitters": [{"count": 1,
                           "surface": {"object": 0, "low": 0.1, "high": 0.3}}]})");
  };
  const Scene kept = with_more("kept.obj", ""),
              stray = with_more("stray.obj", "v 1000 1000 1000\n");
  const tess::dn::Bounds box = Source(kept).bounds(), same = Source(stray).bounds();
  CHECK((same.low == box.low && same.high == box.high));
  const std::vector<Snapshot> snapshots{{0, {{0, {}, {}}}}, {1, {{0, {1, 1, 0}, {}}}}};
  CHECK(paths_svg(stray, snapshots) == paths_svg(kept, snapshots));
}

TEST_CASE("a picture of paths has axes, times, and the outline of what moves", "[particles]") {
  const auto picture = [](const std::string& motion, const std::string& outputs = "{}") {
    const Scene scene = with_object(
        R"({"shape": {"box": {"half": [1, 1, 1]}}, "motion": {"velocity": )" + motion + "}}",
        outputs);
    return paths_svg(
        scene, {{0, {{0, {}, {}}}}, {50, {{0, {0, 0.5, 0}, {}}}}, {100, {{0, {0, 1, 0}, {}}}}});
  };
  // 175 pixels per unit: the left side goes from 169 to 239.0.
  const std::string moved = picture("[0.4, 0, 0]"), still = picture("[0, 0, 0]");
  CHECK_THAT(moved, Contains("239.0 "));
  CHECK_THAT(moved, Contains("outline: t = 1<"));
  CHECK_THAT(still, !Contains("239.0 "));
  CHECK_THAT(still, Contains("169.0 "));
  CHECK_THAT(still, !Contains("outline"));
  for (const char* label : {">t = 0<", ">t = 0.5<", ">t = 1<", ">x<", ">y<", ">-1<", ">0.5<"})
    CHECK_THAT(still, Contains(label));
  CHECK_THAT(still, !Contains(">z<"));
  // Two pieces of the path in two colours, and a dot for each of three times.
  CHECK(count(still, " opacity=\"0.7\"") == 2);
  CHECK(count(still, "h0\"") == 3);
  const std::string twice = picture("[0, 0, 0]", R"({"axis": ["z", "x"]})");
  CHECK(count(twice, "<clipPath") == 2);
  CHECK_THAT(twice, Contains(">z<"));
}

TEST_CASE("particles that start at one point have a picture with distinct labels", "[particles]") {
  const Scene scene =
      scene_of(R"({"dt": 1, "steps": 2, "emitters": [{"count": 1, "sphere": {"radius": 0}}]})");
  const auto labels = [&](double start, double second, double step) {
    std::vector<Snapshot> snapshots;
    for (int i = 0; i < 3; ++i) {
      const double x = start + (i == 0 ? 0 : i * step);
      snapshots.push_back({i, {{0, {x, 0, 0}, {}}, {1, {x + second, 0, 0}, {}}}});
    }
    const std::string svg = paths_svg(scene, snapshots);
    CHECK_THAT(svg, !Contains("inf"));
    CHECK_THAT(svg, !Contains("nan"));
    const std::string begin = "text-anchor=\"middle\"";
    std::vector<std::string> found;  // along x, and the axis's name
    for (std::size_t at = 0; (at = svg.find(begin, at)) != std::string::npos;) {
      at = svg.find('>', at) + 1;
      found.push_back(svg.substr(at, svg.find('<', at) - at));
    }
    return found;
  };
  for (const double start : {0.0, 5.0, 2e6, 1e7, -1e15, 1e150})
    for (const double second : {0.0, 1.0})
      for (const double step : {0.0, 0.5}) {
        CAPTURE(start, second, step);
        std::vector<std::string> found = labels(start, second, step);
        CHECK(found.size() >= 4);
        CHECK(found.size() <= 14);
        std::ranges::sort(found);
        CHECK(std::ranges::adjacent_find(found) == found.end());
      }
  // The paths, where they begin at one point.
  const std::vector<std::string> moved = labels(5, 0, 0.5);
  CHECK(std::ranges::count(moved, "6") == 1);
  (void)labels(0, 0, HUGE_VAL);  // a place that is not finite is left out
}

TEST_CASE("a run replaces none of the files that it reads or writes", "[particles]") {
  const tess::test::Scratch scratch;
  Scene scene = with_object(R"({"shape": {"box": {"half": [1, 1, 1]}}})",
                            R"({"slice": {}, "trajectories": 20})");
  scene.outputs.fields = true;
  const std::string out = scratch.path("out");
  Options options;
  options.out = out;
  std::filesystem::create_directory(out);
  std::string json;
  const auto refusal = [&](const std::string& trace = {}) {
    return message(scene, options, {{"--json", json}, {"--trace", trace}});
  };
  for (const char* file :
       {"field_0.dnf", "field.svg", "paths.svg", "trajectories.pvd",
        "trajectories/step_000000020.vtp", "study_distance.svg", "study_step.csv"}) {
    CAPTURE(file);
    options.study = std::string_view(file).starts_with("study");
    scene.objects[0].field = out + "/./" + file;
    CHECK_THAT(refusal(), Contains("would overwrite objects[0].field"));
    scene.objects[0].field.clear();
    scene.objects[0].file = out + "/" + file;
    CHECK_THAT(refusal(), Contains("would overwrite objects[0].shape.file"));
    scene.objects[0].file.clear();
    json = out + "/" + file;
    CHECK_THAT(refusal(), Contains("would overwrite --json"));
    json.clear();
    CHECK_THAT(refusal(out + "/" + file), Contains("would overwrite --trace"));
  }
  scene.objects[0].field = json = scratch.path("field.dnf");
  CHECK_THAT(refusal(), Contains("would overwrite objects[0].field"));
  json.clear();
  CHECK(refusal(scratch.path("trace.json")).empty());
}

TEST_CASE("the mesh that a scene reads is not overwritten", "[particles]") {
  const tess::test::Scratch scratch;
  const std::string mesh = scratch.write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Scene scene =
      with_object(R"({"sides": "two", "shape": {"file": ")" + mesh + R"("}})", R"({"slice": {}})");
  CHECK(scene.objects[0].file == mesh);
  const auto refusal = [&](const std::string& json, const std::string& trace) {
    return message(scene, {}, {{"--json", json}, {"--trace", trace}});
  };
  CHECK_THAT(refusal(mesh, ""), Contains("would overwrite objects[0].shape.file"));
  CHECK_THAT(refusal("", mesh), Contains("would overwrite objects[0].shape.file"));
  CHECK(refusal(scratch.path("other.obj"), "").empty());
}

TEST_CASE("a file that cannot be written is refused before the run", "[particles]") {
  const tess::test::Scratch scratch;
  Scene scene = with_object(R"({"shape": {"box": {"half": [1, 1, 1]}}})",
                            R"({"slice": {}, "trajectories": 20})");
  scene.outputs.fields = true;
  Options options;
  options.out = scratch.path("out");
  for (const char* file :
       {"field_0.dnf", "field.svg", "paths.svg", "trajectories.pvd",
        "trajectories/step_000000000.vtp", "trajectories/step_000000020.vtp",
        "trajectories/step_000000100.vtp", "study_distance.svg", "study_step.csv"}) {
    CAPTURE(file);
    options.study = std::string_view(file).starts_with("study");
    const std::string taken = options.out + "/" + file;
    std::filesystem::create_directories(taken);
    CHECK_THAT(message(scene, options), Contains(taken + ": cannot be written: is a directory"));
    std::filesystem::remove(taken);
  }
  // Names that this run does not write.
  for (const char* file : {"step_000000030.vtp", "step_000000120.vtp", "step_20.vtp", "step_.vtp"})
    std::filesystem::create_directories(options.out + "/trajectories/" + file);
  for (const bool study : {false, true}) {
    options.study = study;
    CHECK(message(scene, options).empty());
  }
}

TEST_CASE("the shadow of a torus has its hole", "[particles]") {
  const Scene scene = with_object(R"({"shape": {"torus": {"major": 1, "minor": 0.4}}})");
  const std::string svg = paths_svg(scene, {{0, {{0, {}, {}}}}, {1, {{0, {}, {}}}}});
  const std::size_t begin = svg.find("fill=\"#bbb\"");
  REQUIRE(begin != std::string::npos);
  const std::string path = svg.substr(begin, svg.find("/>", begin) - begin);
  CHECK(count(path, "Z") >= 2);
  // Edges inside of the shadow cancel: two circles of 64 corners, each for the front and the back.
  CHECK(count(path, "L") < 4 * 64);
}
