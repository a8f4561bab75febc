#include "apps/particles/simulation/memory.hpp"

#include "apps/particles/audit/measured.hpp"
#include "apps/particles/audit/passage.hpp"
#include "collide/dn_field/build_blurred.hpp"
#include "runtime/base/usable_memory.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>

namespace particles {
namespace {

/// Counts what is needed, and throws at the first that is too much.
class Needs {
 public:
  explicit Needs(const Scene& scene) : scene_(scene), there_(tess::usable_memory()) {}

  /// `place` and `value`: of the key that asks for it. what: "makes the fields".
  template <class Value>
  void add(double bytes, const std::string& place, const Value& value, const char* what) {
    wanted_ += bytes;
    if (wanted_ <= there_) return;
    tess::fail(tess::ErrorCode::environment, scene_.name, ": ", place, ": ", value, " ", what, " ",
               wanted_ / 1e9, " GB large, and this process may have ", there_ / 1e9,
               " GB; ask for less");
  }

  void add_fields() {
    if (!builds_fields(scene_)) return;
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) {
      const SceneObject& object = scene_.objects[i];
      const bool blurs = object.field.empty() && object.method != tess::dn::Method::exact;
      const double bytes_per_voxel = blurs ? tess::dn::bytes_per_voxel_blurring : 8;
      add(bytes_per_voxel * static_cast<double>(object.grid.size()),
          tess::text("objects[", i, "].", object.field.empty() ? "resolution" : "field"),
          object.grid.n[0], "voxels along an axis make the fields");
    }
  }

 private:
  const Scene& scene_;
  double there_, wanted_ = 0;
};

/// How many times something is done that is done every so many steps, and at both ends.
double n_times(const Scene& scene, int every) {
  return every > 0 ? 2.0 + scene.steps / every : 2.0;
}

}  // namespace

void check_field_memory(const Scene& scene) {
  Needs(scene).add_fields();
}

void check_memory(const Scene& scene, int n_processes) {
  constexpr double bytes_per_particle =
                       6 * sizeof(double) + sizeof(std::uint64_t) + sizeof(Mark),  // a Flock
      bytes_per_sample = 6 * sizeof(double) + sizeof(std::uint64_t);
  const auto n = static_cast<double>(scene.n_particles());
  const Outputs& outputs = scene.outputs;
  Needs needs(scene);
  needs.add_fields();
  needs.add(bytes_per_particle * n / n_processes, "emitters", scene.n_particles(),
            n_processes == 1 ? "particles make the run"
                             : "particles, shared by the processes, make the run");
  needs.add(n_times(scene, outputs.statistics) * sizeof(Measured), "outputs.statistics",
            outputs.statistics, "(a row every so many steps) makes the run");
  if (outputs.trajectories > 0)
    needs.add(n_times(scene, outputs.trajectories) * bytes_per_sample *
                  std::min(n, static_cast<double>(outputs.traced)),
              "outputs.trajectories", outputs.trajectories,
              "(positions every so many steps) makes the run");
}

}  // namespace particles
