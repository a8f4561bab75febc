#include "apps/collide_scene/stability/cases.hpp"

#include "apps/collide_scene/options.hpp"
#include "apps/collide_scene/run/serial.hpp"
#include "apps/collide_scene/stability/made.hpp"
#include "apps/kit/driver.hpp"
#include "collide/triangle.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <ctime>
#include <iterator>

namespace collide_scene {
namespace {

using namespace tess::collide;
using namespace stability;

/// All pairs one by one, in order. Shares only the tests of two objects with the library.
std::vector<ScenePair> brute_force(const Scene& scene, const Rules& rules) {
  const Touching touching = rules.open ? Touching::does_not_count : Touching::counts;
  const std::vector<Aabb> boxes = boxes_of(scene);
  std::vector<ScenePair> pairs;
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    for (std::uint32_t j = i + 1; j < boxes.size(); ++j) {
      if (!scene.models.empty() && scene.models[i] == scene.models[j]) continue;
      if (rules.triangles ? intersect(scene.triangles[i], scene.triangles[j], touching)
                          : overlap(boxes[i], boxes[j], touching))
        pairs.push_back({i, j});
    }
  return pairs;
}

class Reporter {
 public:
  explicit Reporter(kit::Progress* progress) : progress_(progress) {}

  /// A row for each: touching counts or not; boxes, and triangles if there are some.
  void add(const std::string& name, const std::string& parameter, double value, const Scene& scene,
           double voxel_size = 0) {
    for (const bool exact : {false, true}) {
      if (exact && scene.triangles.empty()) continue;
      for (const bool open : {false, true})
        add_row(name + (exact ? ", exact" : "") + (open ? ", open" : ""), parameter, value, scene,
                {.triangles = exact, .open = open, .voxel_size = voxel_size});
    }
  }

  std::vector<StabilityCase> rows;

 private:
  void add_row(const std::string& name, const std::string& parameter, double value,
               const Scene& scene, const Rules& rules) {
    if (progress_ != nullptr) progress_->phase("stability");
    StabilityCase row;
    row.name = name, row.parameter = parameter, row.value = value;
    row.n_objects = scene.n_objects();
    const std::clock_t begin = std::clock();
    const std::vector<ScenePair> expected = brute_force(scene, rules);
    row.brute_seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    row.n_pairs = expected.size();
    std::vector<ScenePair> found;
    try {
      row.seconds = collide_once(scene, rules, 0, &found).cpu_seconds;
      const Difference wrong = difference(expected, std::move(found));
      row.lost = wrong.lost, row.doubled = wrong.doubled, row.added = wrong.added;
      // A scene that all but stops the library is a failure, too.
      row.met = row.seconds / (row.brute_seconds + 1e-3);
      row.tolerance = 20;
      row.ok = wrong == Difference{} && *row.met <= *row.tolerance;
    } catch (const tess::Error& error) {
      row.note = error.what();
    }
    rows.push_back(std::move(row));
  }

  kit::Progress* progress_;
};

void places_and_scales(Reporter& report, const Scene& base, const std::string& objects) {
  for (const double offset : {0.0, 1.0, -1e3, 1e6, -1e9, 1e12})
    report.add(objects + ", far away", "offset", offset, changed(base, 1, offset));
  for (const double scale : {1e-30, 1e-9, 1e-3, 1e3, 1e9, 1e30})
    report.add(objects + ", scaled", "scale", scale, changed(base, scale, 0));
  report.add(objects + " of two models", "", 0, in_models(base, 2));
  report.add(objects + ", each twice", "", 0, each_twice(base));
  for (const double times : {1e1, 1e3, 1e6})
    report.add(objects + ", one over all", "size", times, with_one_over_all(base, times));
}

using kit::of;
constexpr kit::Column<StabilityCase> columns[] = {
    {"objects", "objects", "8", of<&StabilityCase::n_objects>},
    {"pairs", "pairs", "8", of<&StabilityCase::n_pairs>},
    {"lost", "lost", "6", of<&StabilityCase::lost>},
    {"doubled", "doubled", "7", of<&StabilityCase::doubled>},
    {"added", "added", "6", of<&StabilityCase::added>},
    {"cpu_seconds", "CPU s", "8.6f", of<&StabilityCase::seconds>},
    {"brute_cpu_seconds", "brute", "8.6f", of<&StabilityCase::brute_seconds>}};

}  // namespace

Difference difference(const std::vector<ScenePair>& expected, std::vector<ScenePair> found) {
  std::ranges::sort(found);
  Difference out;
  const auto rest = std::ranges::unique(found);
  out.doubled = rest.size();
  found.erase(rest.begin(), rest.end());
  std::vector<ScenePair> apart;
  std::ranges::set_difference(expected, found, std::back_inserter(apart));
  out.lost = apart.size();
  apart.clear();
  std::ranges::set_difference(found, expected, std::back_inserter(apart));
  out.added = apart.size();
  return out;
}

std::vector<StabilityCase> stability_cases(kit::Progress* progress) {
  constexpr std::size_t n = 600;
  Reporter report(progress);
  places_and_scales(report, random_boxes_around_zero(n), "boxes");
  places_and_scales(report, random_triangles(n), "triangles");
  for (const double voxel : {0.0, 0.05, 0.1, 0.25, 0.3, 4.0})
    report.add("boxes 0.1 i … 0.1 i + 0.15", "voxel", voxel, lattice(10), voxel);
  for (const double voxel : {0.0, 0.5, 1.0, 1.5})
    report.add("cubes face to face", "voxel", voxel, face_to_face(8), voxel);
  report.add("identical boxes", "", 0, identical_boxes(1000));
  report.add("identical triangles", "", 0, identical_triangles(300));
  for (const int n_flat : {1, 2, 3})
    report.add("boxes without extent", "axes", n_flat, flat_boxes(n, n_flat));
  for (const double decades : {2.0, 4.0, 6.0, 9.0})
    report.add("boxes of mixed sizes", "decades", decades, mixed_boxes(n, decades));
  for (const double decades : {2.0, 6.0})
    report.add("triangles of mixed sizes", "decades", decades, mixed_triangles(n, decades));
  for (const double aspect : {1e2, 1e4, 1e6, 1e9}) {
    report.add("needle boxes", "aspect", aspect, needle_boxes(n, aspect));
    report.add("needle triangles", "aspect", aspect, needle_triangles(n, aspect));
  }
  report.add("triangles in the plane z = 0", "", 0, in_one_plane(n, 0));
  report.add("triangles in a tilted plane", "", 0, in_one_plane(n, 0.3));
  report.add("segments and points", "", 0, degenerate_triangles(n));
  report.add("a mesh: neighbours touch", "", 0, without_models(make_scene("wave:1024")));
  report.add("nested L shapes", "", 0, make_scene("lshapes:150"));
  report.add("crossing segments", "", 0, make_scene("segments:400"));
  return std::move(report.rows);
}

int report_stability(kit::Driver& driver) {
  const std::vector<StabilityCase> found = stability_cases(&driver.progress());
  driver.progress().clear();
  kit::Cases<StabilityCase> cases(columns);
  for (const StabilityCase& one : found) cases.add(one);
  return cases.finish(driver, "met: CPU time by that of brute force\n");
}

}  // namespace collide_scene
