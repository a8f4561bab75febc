// What all blocks of a process share, read-only once it is set up: the scene, its particles'
// source, the fields. It is handed from PE to PE within a process as a pointer; on its way to
// another process it becomes the scene, and the fields are built there again.
#pragma once

#include "apps/particles/scene/scene.hpp"
#include "apps/particles/simulation/emit.hpp"
#include "apps/particles/simulation/field_making.hpp"
#include "collide/dn_field/bvh.hpp"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace particles {

struct Stage {
  explicit Stage(Scene of)
      : scene(std::move(of)),
        source(scene),
        masses(species_of(scene)),
        fields(builds_fields(scene) ? scene.objects.size() : 0),
        triangles(scene.objects.size()) {}
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  const Scene scene;
  const Source source;
  const std::vector<double> masses;  ///< a species is an index into this
  std::vector<FieldInTheMaking>
      fields;  ///< of the objects; empty where nobody asks, see builds_fields()
  std::vector<std::optional<tess::dn::Bvh>>
      triangles;  ///< of objects whose impacts or audit ask them

  [[nodiscard]] bool collides() const { return needs_field(scene.rules); }
  /// As they stand at the start, once their fields are built.
  [[nodiscard]] std::vector<tess::dn::Object> objects() const {
    std::vector<tess::dn::Object> objects;
    for (std::size_t i = 0; i < fields.size(); ++i)
      objects.push_back(
          fields[i].object(scene.objects[i].frame, triangles[i] ? &*triangles[i] : nullptr));
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
