// The rules that act on the particles of a scene; the step loop of make_stepper() holds only those
// that are set. All are per mass: a stiffness is k/m in 1/s², a rate c/m in 1/s, a strength F/m. N
// is the surface's normal, V the velocity relative to the moving surface, d the distance to it in
// world units. Only the nearest surface acts. (Paper, sections 3.3 to 3.6. The integrators are
// ours: exact where the motion has a closed form.)
#pragma once

#include "collide/dn_field/look_up.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tess::dn {

/// off: one sample at the start of a step serves the whole step; speed × step must stay below the
/// field's thickness. on: particles that move further than is known to be free are traced.
enum class Sweep : std::uint32_t { off, on };

/// Drag at velocity u: linear -rate × u, quadratic -rate × |u| u.
enum class DragLaw : std::uint32_t { linear, quadratic };

/// A force (stiffness × depth) along N in d < reach, with -damping × N·V. Must be less than
/// critically damped: damping < 2 √stiffness. Not by nearest look-up: its depth is constant over a
/// voxel, so that a spring would push a particle more than once.
struct Spring {
  double stiffness = 1;
  double damping = 0;
  double reach = 0;  ///< distance at which contact begins
};

/// V − (1 + restitution)(N·V)N for a particle that would come closer than `threshold` in this step.
struct Impact {
  double restitution = 1;  ///< 0: slides; 1: keeps the energy
  double threshold = 0;    ///< the distance at which particles bounce: their radius
  Sweep sweep = Sweep::on;
};

/// Linear drag toward the surface's own velocity, in d < threshold.
struct SurfaceDrag {
  double rate = 0;
  double threshold = 0;
};

/// Turns V toward the surface's tangent with an acceleration perpendicular to V, in d < distance.
/// alpha_in for N·V < 0, alpha_out for N·V > 0; a negative one turns away from the tangent.
/// |V| is kept.
struct SurfaceFlow {
  double alpha_in = 0;
  double alpha_out = 0;
  double distance = 0;
};

struct Gravity {
  Vec3 acceleration;
};

/// Air that moves: linear drag toward `velocity`.
struct Wind {
  Vec3 velocity;
  double rate = 0;
};

/// Air at rest.
struct AirDrag {
  double rate = 0;
  DragLaw law = DragLaw::linear;
};

/// Pushes away from `centre`: strength × (1 − r/radius) within `radius`, from `start` for
/// `duration`.
struct Explosion {
  Vec3 centre;
  double strength = 0;  ///< an acceleration; negative pulls
  double radius = 1;
  double start = 0;
  double duration = 0;
};

struct Rules {
  LookUp look_up = LookUp::tangent;
  std::optional<Spring> spring;
  std::optional<Impact> impact;
  std::optional<SurfaceDrag> surface_drag;
  std::optional<SurfaceFlow> surface_flow;
  std::optional<Gravity> gravity;
  std::optional<Wind> wind;
  std::optional<AirDrag> air_drag;
  std::vector<Explosion> explosions;
};

/// Throws Error(bad_value) for the first value that is not finite or out of range. The message
/// names it as a scene file does ("spring.damping"), with the remedy.
void validate(const Rules& rules);

/// Whether some rule needs the surface.
[[nodiscard]] bool needs_field(const Rules& rules);

/// What the fields of this scene must store: normals only if a rule or the look-up needs them.
[[nodiscard]] Content needed_content(const Rules& rules);

/// The distance from the surface at which the first rule acts.
[[nodiscard]] double reach(const Rules& rules);

/// One line per rule, "used" or "left out", for --explain.
[[nodiscard]] std::vector<std::string> explain(const Rules& rules);

}  // namespace tess::dn
