#include "apps/particles/scene/readers.hpp"
#include "collide/dn_field/field_file.hpp"
#include "collide/dn_field/walls.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <numbers>

namespace particles {
namespace {
using namespace tess::dn;

Frame read_transform(const Node& node) {
  Frame frame;
  Vec3 position, degrees;
  std::array<Vec3, 3> rows;
  const auto matrix = [&](const Node& of) {
    if (node.has("rotation") || node.has("scale"))
      node.refuse("has a matrix beside rotation or scale; give either");
    const std::vector<Node> items = of.items();
    if (items.size() != 3) of.refuse("is not a list of three rows");
    for (std::size_t i = 0; i < 3; ++i) rows[i] = items[i].vector();
  };
  node.read({{"position", position},
             {"rotation", degrees},
             {"scale", frame.scale, positive},
             {"matrix", matrix}});
  if (node.has("matrix")) {
    const auto [x, y, z] = rows;
    try {
      return frame_from({{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}}, position);
    } catch (const tess::Error& error) {
      node["matrix"].refuse(std::string("cannot be used: ") + error.what());
    }
  }
  frame.axes = rotation((std::numbers::pi / 180) * degrees);
  frame.position = position;
  return frame;
}

/// Copies what a field's file says of itself. The field is read again where it is used: a scene
/// stays small. Returns the fingerprint of the surface that it was built from.
std::uint64_t read_field(const Node& node, const std::string& folder, SceneObject& object) {
  object.field = path_beside(folder, node.text());
  try {
    const Field field = load_field(object.field);
    object.grid = field.grid, object.thickness = field.thickness;
    object.method = field.method, object.sides = field.sides;
    object.field_has_normals = field.content() == Content::distance_and_normal;
    return field.surface;
  } catch (const tess::Error& error) {
    node.blame(error.what());
  }
}

/// The grid and the thickness of a field that is built: by resolution and thickness, or so that the
/// field covers a step of the fastest particle, with two voxels across the smallest feature.
void set_grid(const Node& node, double dt, SceneObject& object) {
  const Bounds box = bounds(object.surface);
  const Vec3 size = box.size();
  const double extent = std::max({size.x, size.y, size.z});
  double resolution = object.grid.n[0] > 0 ? object.grid.n[0] : 60;
  if (node.has("choose")) {
    double max_speed = 0, detail = 0;
    node["choose"].read(
        {{"max_speed", max_speed, positive, "the largest speed relative to the surface"},
         {"detail", detail, positive, "the size of the smallest feature"}});
    object.thickness = max_speed / object.frame.scale * dt + detail;
    resolution = std::max(4.0, std::ceil(2 * (extent + 2 * object.thickness) / detail) + 1);
    if (!(resolution <= 1024))
      node["choose"].refuse(fmt::format(
          "takes a resolution of {:g}, above 1024; shorten the step, or coarsen the detail",
          resolution));
  } else if (!node.has("thickness")) {
    object.thickness = 0.25 * extent;
  }
  try {
    object.grid = grid_around(box, static_cast<int>(resolution), object.thickness);
  } catch (const tess::Error& error) {
    node.refuse(std::string("cannot have a field: ") + error.what());
  }
  if (object.thickness < 2 * object.grid.cell)
    (node.has("thickness") ? node["thickness"] : node)
        .refuse(
            fmt::format("is thinner than two cells of {:g}; raise the thickness or the resolution",
                        object.grid.cell));
}

}  // namespace

SceneObject read_object(const Node& node, const std::string& folder, double dt,
                        const Rules& rules) {
  SceneObject object;
  std::uint64_t fingerprint_of_field = 0;
  const auto motion = [&](const Node& of) {
    Frame& frame = object.frame;
    of.read({{"velocity", frame.velocity},
             {"spin", frame.angular_velocity},
             {"scale", frame.scale_rate}});
  };
  const auto blur = [&](const Node& of) {
    if (object.method == Method::exact)
      of.refuse("stands beside the exact method, which blurs nothing; leave it out");
    of.read({{"radius", object.blur.radius, 2, 4, "its radius in voxels, 2 to 4"},
             {"rounds", object.blur.rounds, 1, 1000, "how often"}});
  };
  const auto field = [&](const Node& of) {
    for (const char* key : {"resolution", "thickness", "method", "sides", "blur", "choose"})
      if (node.has(key))
        node[key].refuse("stands beside a field from a file, which has its own; leave it out");
    fingerprint_of_field = read_field(of, folder, object);
  };
  const auto shape = [&](const Node& of) {
    object.surface = read_shape(of, folder);
    if (of.has("file")) object.file = path_beside(folder, of["file"].text());
  };
  node.read({{"shape", shape, "one of sphere, box, boxes, torus, cylinder, plate, file"},
             {"field", field},
             {"resolution", object.grid.n[0], 4, 1024},
             {"thickness", object.thickness, positive},
             {"method", object.method, words_of(method_names)},
             {"sides", object.sides, {"one", "two"}},
             {"blur", blur},
             {"transform", [&](const Node& of) { object.frame = read_transform(of); }},
             {"motion", motion},
             {"choose", [&](const Node& of) {
                for (const char* key : {"resolution", "thickness"})
                  if (node.has(key))
                    of.refuse(std::string("stands beside ") + key + "; give either");
              }}});
  // Emitters, the audit and the study use the triangles that the field is built from.
  if (object.sides == Sides::one) object.surface = outward(object.surface);
  if (!node.has("field"))
    set_grid(node, dt, object);
  else if (fingerprint_of_field != fingerprint(object.surface))
    node["field"].blame(object.field +
                        ": is the field of another shape; give that of this one, or leave it out");
  if (object.sides == Sides::one && (rules.impact || rules.spring))
    object.thin_share = thin_share(object.surface, Bvh(object.surface), least_wall(rules, object));
  return object;
}

}  // namespace particles
