#include "apps/particles/simulation/field_making.hpp"

#include "collide/dn_field/field_file.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <numbers>

namespace particles {
using namespace tess::dn;

namespace {

FieldOptions options_of(const SceneObject& object, Content content) {
  return {object.sides, content, object.thickness, object.method, object.blur};
}

/// The field from the object's file, with normals only where they are asked for.
Field loaded(const SceneObject& object, Content content) {
  Field field = load_field(object.field);
  if (content == Content::distance) field.normal = {};
  return field;
}

}  // namespace

Content content_of(const Scene& scene) {
  return scene.compression || scene.outputs.slice || scene.outputs.fields
             ? Content::distance_and_normal
             : needed_content(scene.rules);
}

void FieldInTheMaking::begin(const SceneObject& object, Content content, int n_parts) {
  start_ = std::chrono::steady_clock::now();
  n_parts_ = n_parts;
  if (!object.field.empty()) {
    field_ = loaded(object, content);
    return;
  }
  grid_ = object.grid;
  builder_.emplace(object.surface, object.grid, options_of(object, content));
}

int FieldInTheMaking::n_stages() const {
  return builder_ ? builder_->n_rounds() : 0;
}

void FieldInTheMaking::fill(int stage, int part) {
  if (stage >= n_stages()) return;
  // Parts are cut between blocks of layers.
  const int n_blocks = (grid_.n[2] + block_layers - 1) / block_layers;
  const auto edge = [&](int at) {
    return std::min(grid_.n[2],
                    block_layers * static_cast<int>(std::int64_t{n_blocks} * at / n_parts_));
  };
  if (edge(part) < edge(part + 1)) builder_->build(stage, edge(part), edge(part + 1));
}

void FieldInTheMaking::finish(const std::optional<Compression>& compression) {
  if (builder_) field_ = builder_->finish();
  builder_.reset();
  flat_bytes_ = field_.bytes();
  if (compression) field_ = compress(field_, bound_of(*compression, field_));
  seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

Field build_alone(const SceneObject& object, Content content) {
  if (object.field.empty())
    return build_field(object.surface, object.grid, options_of(object, content));
  if (content == Content::distance_and_normal) require_normals(object);
  return loaded(object, content);
}

ErrorBound bound_of(const Compression& compression, const Field& field) {
  return {compression.cells * field.grid.cell, compression.degrees * std::numbers::pi / 180};
}

}  // namespace particles
