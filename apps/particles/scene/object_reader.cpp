#include "apps/particles/scene/object_reader.hpp"

#include "apps/particles/scene/shape_reader.hpp"
#include "collide/dn_field/field_file.hpp"
#include "collide/dn_field/orientation.hpp"
#include "collide/dn_field/walls.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <numbers>

namespace particles {
namespace {
using namespace tess::dn;

Frame read_transform(const Node& node) {
  const Keys keys = node.keys({"position", "rotation", "scale", "matrix"});
  Frame frame;
  Vec3 position;
  keys.read("position", position);
  if (keys.has("matrix")) {
    if (keys.has("rotation") || keys.has("scale"))
      node.refuse("has a matrix beside rotation or scale; give either");
    const std::vector<Node> rows = keys["matrix"].items();
    if (rows.size() != 3) keys["matrix"].refuse("is not a list of three rows");
    const Vec3 x = rows[0].vector(), y = rows[1].vector(), z = rows[2].vector();
    try {
      return frame_from({{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}}, position);
    } catch (const tess::Error& error) {
      keys["matrix"].refuse(std::string("cannot be used: ") + error.what());
    }
  }
  Vec3 degrees;
  keys.read("rotation", degrees);
  keys.read("scale", frame.scale, positive);
  frame.axes = rotation((std::numbers::pi / 180) * degrees);
  frame.position = position;
  return frame;
}

/// Grid, thickness and blur from how fast the particles are and how fine the object is. Where
/// impacts are swept, two cells do if a whole step is too much for a field.
void choose(const Node& node, const Bounds& box, double dt, const Rules& rules,
            SceneObject& object) {
  constexpr std::size_t most_voxels = std::size_t{512} * 512 * 512;
  const Keys keys = node.keys({"max_speed", "detail"});
  const Demand demand{
      keys.need("max_speed", "the largest speed relative to the surface").number(positive) /
          object.frame.scale,
      dt, keys.need("detail", "the size of the smallest feature").number(positive)};
  const auto plan = [&](Coverage coverage) {
    const FieldPlan chosen = choose_plan(box, demand, coverage, most_voxels);
    object.grid = chosen.grid, object.thickness = chosen.thickness, object.blur = chosen.blur;
  };
  try {
    try {
      plan(Coverage::step);
    } catch (const tess::Error&) {
      if (!rules.impact || rules.impact->sweep == Sweep::off) throw;
      plan(Coverage::swept);
    }
  } catch (const tess::Error& error) {
    node.refuse(std::string("cannot be met: ") + error.what());
  }
}

Blur read_blur(const Node& node, Method method) {
  if (method == Method::exact)
    node.refuse("stands beside the exact method, which blurs nothing; leave it out");
  const Keys keys = node.keys({"radius", "rounds"});
  constexpr std::int64_t most_rounds = 1000;
  return {static_cast<int>(keys.need("radius", "its radius in voxels, 2 to 4").whole(2, 4)),
          static_cast<int>(keys.need("rounds", "how often").whole(1, most_rounds))};
}

void give_field(const Keys& keys, const Node& node, const Bounds& box, SceneObject& object) {
  constexpr int usual_resolution = 60, least = 4, most = 1024;
  int resolution = usual_resolution;
  keys.read("thickness", object.thickness, positive);
  keys.read("resolution", resolution, least, most);
  try {
    object.grid = grid_around(box, resolution, object.thickness);
  } catch (const tess::Error& error) {
    node.refuse(std::string("cannot have a field: ") + error.what());
  }
  if (object.thickness < 2 * object.grid.cell)
    (keys.has("thickness") ? keys["thickness"] : node)
        .refuse(tess::text("is thinner than two cells of ", object.grid.cell,
                           "; raise the thickness or the resolution"));
  if (keys.has("blur")) object.blur = read_blur(keys["blur"], object.method);
}

/// What a field from a file says of itself. It is read again where it is used: a scene stays small.
/// Returns the fingerprint of the surface it was built from.
std::uint64_t read_field(const Keys& keys, const std::string& folder, SceneObject& object) {
  for (const char* key : {"resolution", "thickness", "method", "sides", "blur", "choose"})
    if (keys.has(key))
      keys[key].refuse("stands beside a field from a file, which has its own; leave it out");
  const Node node = keys["field"];
  object.field = path_beside(folder, node.text());
  try {
    const Field field = load_field(object.field);
    object.grid = field.grid, object.thickness = field.thickness;
    object.method = field.method, object.sides = field.sides;
    return field.surface;
  } catch (const tess::Error& error) {
    node.blame(error.what());
  }
}

}  // namespace

SceneObject read_object(const Node& node, const std::string& folder, double dt,
                        const Rules& rules) {
  const Keys keys = node.keys({"shape", "field", "resolution", "thickness", "method", "sides",
                               "blur", "transform", "motion", "choose"});
  SceneObject object;
  const Node shape = keys.need("shape", "one of sphere, box, boxes, torus, cylinder, plate, file");
  object.surface = read_shape(shape, folder, object.name);
  if (keys.has("transform")) object.frame = read_transform(keys["transform"]);
  if (keys.has("motion")) {
    const Keys motion = keys["motion"].keys({"velocity", "spin", "scale"});
    motion.read("velocity", object.frame.velocity);
    motion.read("spin", object.frame.angular_velocity);
    motion.read("scale", object.frame.scale_rate);
  }
  if (keys.has("method"))
    object.method = static_cast<Method>(keys["method"].word({"exact", "normals", "potential"}));
  if (keys.has("sides")) object.sides = static_cast<Sides>(keys["sides"].word({"one", "two"}));
  const std::uint64_t of_field = keys.has("field") ? read_field(keys, folder, object) : 0;
  // Emitters, audits and the study see the triangles as the field does.
  if (object.sides == Sides::one) {
    object.surface = Surface(OutwardSurface(object.surface).surface());
    if (rules.impact || rules.spring) object.walls = walls_of(object.surface, Bvh(object.surface));
  }
  if (keys.has("field")) {
    if (of_field != fingerprint(object.surface))
      keys["field"].blame(
          object.field + ": is the field of another shape; give that of this one, or leave it out");
    return object;
  }
  const Bounds box = bounds(object.surface);
  const Vec3 size = box.size();
  object.thickness = 0.25 * std::max({size.x, size.y, size.z});
  if (keys.has("choose")) {
    for (const char* key : {"resolution", "thickness", "blur"})
      if (keys.has(key))
        keys["choose"].refuse(std::string("stands beside ") + key + "; give either");
    choose(keys["choose"], box, dt, rules, object);
    return object;
  }
  give_field(keys, node, box, object);
  return object;
}

}  // namespace particles
