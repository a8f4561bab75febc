// The data that all blocks of a process share, read-only once it is set up: the scene, the source
// of its particles, the fields. PEs of a process share it by a pointer; a message to another
// process holds the scene, and the fields are built there again.
#pragma once

#include "apps/particles/scene/scene.hpp"
#include "apps/particles/simulation/emit.hpp"
#include "apps/particles/simulation/field_making.hpp"
#include "collide/dn_field/bvh.hpp"
#include "collide/dn_field/stepper.hpp"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace particles {

/// Whether the `wanted` of ids 0 … n − 1 that are spread evenly over them include `id`.
[[nodiscard]] inline bool is_sampled(std::uint64_t id, std::uint64_t n, std::uint64_t wanted) {
  return wanted >= n || id * wanted % n < wanted;  // below 1e18: there are at most 1e9 particles
}

/// Particles that one step loop moves together: they have one mass, and either all or none of them
/// are audited in each step.
struct Species {
  double mass = 1;
  bool audited = false;
};

struct Stage {
  explicit Stage(Scene of)
      : scene(std::move(of)),
        source(scene),
        n_audited(particles::n_audited(scene)),
        fields(builds_fields(scene) ? scene.objects.size() : 0),
        triangles(scene.objects.size()) {
    for (const double mass : masses_of(scene))
      species.insert(species.end(), {{mass, false}, {mass, true}});
  }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  const Scene scene;
  const Source source;
  const std::uint64_t n_audited;  ///< particles that are audited in each step
  std::vector<Species> species;
  std::vector<FieldInTheMaking> fields;  ///< of the objects; empty unless builds_fields()
  std::vector<std::optional<tess::dn::Bvh>> triangles;  ///< of open surfaces, for the audit

  /// The position in `species` of particle `id`.
  [[nodiscard]] std::size_t species_of(std::uint64_t id, double mass) const {
    std::size_t s = is_sampled(id, source.size(), n_audited) ? 1 : 0;
    while (species[s].mass != mass) s += 2;
    return s;
  }
  /// The objects as they stand at the start; after their fields are built.
  [[nodiscard]] std::vector<tess::dn::Object> objects() const {
    std::vector<tess::dn::Object> objects;
    for (std::size_t i = 0; i < fields.size(); ++i)
      objects.push_back({&fields[i].field(), scene.objects[i].frame});
    return objects;
  }
};

struct StageHandle {
  std::shared_ptr<Stage> stage;

  template <class Ar>
  void serialize(Ar& ar) {
    if constexpr (Ar::is_reading) {
      stage = std::make_shared<Stage>(ar.template take<Scene>());
    } else {
      ar(stage->scene);
    }
  }
};

}  // namespace particles
