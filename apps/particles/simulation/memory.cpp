#include "apps/particles/simulation/memory.hpp"

#include "apps/particles/audit/measured.hpp"
#include "apps/particles/audit/passage.hpp"
#include "collide/dn_field/build_field.hpp"
#include "runtime/base/usable_memory.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>

namespace particles {

void check_memory(const Scene& scene, int n_processes) {
  constexpr double bytes_per_sample = 6 * sizeof(double) + sizeof(std::uint64_t),
                   bytes_per_particle = bytes_per_sample + sizeof(Mark);
  const double usable = tess::detail::usable_memory();
  double needed = 0;
  /// `place` and `value`: the key that asks for the memory.
  const auto add = [&](double bytes, const std::string& place, std::uint64_t value,
                       const char* what) {
    needed += bytes;
    if (needed <= usable) return;
    tess::fail(tess::ErrorCode::environment, scene.name, ": ", place, ": ", value, " ", what, " ",
               needed / 1e9, " GB large, and this process may have ", usable / 1e9,
               " GB; ask for less");
  };
  for (std::size_t i = 0; builds_fields(scene) && i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    const tess::dn::FieldOptions options{.method = object.field.empty() ? object.method
                                                                        : tess::dn::Method::exact};
    add(building_bytes_per_voxel(options) * static_cast<double>(object.grid.size()),
        tess::text("objects[", i, "].", object.field.empty() ? "resolution" : "field"),
        static_cast<std::uint64_t>(object.grid.n[0]), "voxels along an axis make the fields");
  }
  const auto n = static_cast<double>(scene.n_particles());
  add(bytes_per_particle * n / n_processes, "emitters", scene.n_particles(),
      n_processes == 1 ? "particles make the run"
                       : "particles, shared by the processes, make the run");
  const auto add_rows = [&](const char* key, int every, double bytes_per_row, const char* what) {
    const double n_rows = 2.0 + (every > 0 ? scene.steps / every : 0);
    add(n_rows * bytes_per_row, key, static_cast<std::uint64_t>(every), what);
  };
  const Outputs& outputs = scene.outputs;
  add_rows("outputs.statistics", outputs.statistics, sizeof(Measured),
           "(a row every so many steps) makes the run");
  if (outputs.trajectories > 0)
    add_rows("outputs.trajectories", outputs.trajectories,
             bytes_per_sample * std::min(n, static_cast<double>(outputs.traced)),
             "(positions every so many steps) makes the run");
}

}  // namespace particles
