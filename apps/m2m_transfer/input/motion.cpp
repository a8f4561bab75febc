#include "apps/m2m_transfer/input/motion.hpp"

#include "apps/m2m_transfer/input/graph.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/number.hpp"

#include <cmath>
#include <numbers>

namespace m2m_transfer {
namespace {

[[noreturn]] void refuse(const std::string& text) {
  fail(ErrorCode::bad_argument, "--move: '", text,
       "' is no motion; give MESH:rotate(AXIS_X,AXIS_Y,AXIS_Z,ANGLEdeg[,X,Y,Z]) or "
       "MESH:translate(X,Y,Z)");
}

}  // namespace

StepMotion parse_motion(const std::string& text, const std::vector<std::string>& meshes,
                        std::size_t default_mesh) {
  const std::size_t open = text.rfind('(');
  if (open == std::string::npos || !text.ends_with(')')) refuse(text);
  const std::string head = text.substr(0, open);
  const std::size_t colon = head.rfind(':');
  const std::string verb = colon == std::string::npos ? head : head.substr(colon + 1);
  StepMotion out;
  out.mesh = colon == std::string::npos ? default_mesh
                                        : find_mesh(head.substr(0, colon), meshes, "--move");
  std::vector<double> numbers;
  const auto words = split_at_commas(text.substr(open + 1, text.size() - open - 2));
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool is_angle = verb == "rotate" && i == 3;
    if (is_angle && !words[i].ends_with("deg")) refuse(text);
    const std::size_t unit = is_angle ? 3 : 0;
    const auto number = parse_number<double>(words[i].substr(0, words[i].size() - unit));
    if (!number || !(std::abs(*number) <= 1e100)) refuse(text);
    numbers.push_back(is_angle ? *number * std::numbers::pi / 180 : *number);
  }
  RigidMotion& motion = out.motion;
  if (verb == "translate" && numbers.size() == 3) {
    motion.translation = {numbers[0], numbers[1], numbers[2]};
  } else if (verb == "rotate" && (numbers.size() == 4 || numbers.size() == 7)) {
    motion.axis = {numbers[0], numbers[1], numbers[2]};
    if (numbers[0] == 0 && numbers[1] == 0 && numbers[2] == 0)
      fail(ErrorCode::bad_argument, "--move: '", text,
           "' has the axis (0, 0, 0); give a direction");
    motion.angle = numbers[3];
    out.about_middle = numbers.size() == 4;
    if (!out.about_middle) motion.centre = {numbers[4], numbers[5], numbers[6]};
  } else {
    refuse(text);
  }
  return out;
}

void set_centre(StepMotion& motion, const Aabb& bounds) {
  if (!motion.about_middle) return;
  for (std::size_t axis = 0; axis < 3; ++axis)
    motion.motion.centre[axis] = bounds.lo[axis] + 0.5 * (bounds.hi[axis] - bounds.lo[axis]);
}

void move_centres(std::vector<StepMotion>& motions, const RigidMotion& made) {
  for (StepMotion& motion : motions)
    if (motion.about_middle) move_points({&motion.motion.centre, 1}, made);
}

std::vector<RigidMotion> opposite(const std::vector<RigidMotion>& motions) {
  std::vector<RigidMotion> back;
  for (auto motion = motions.rbegin(); motion != motions.rend(); ++motion) {
    const auto& [x, y, z] = motion->translation;
    back.push_back({.translation = {-x, -y, -z}});
    back.push_back({.axis = motion->axis, .angle = -motion->angle, .centre = motion->centre});
  }
  return back;
}

}  // namespace m2m_transfer
