// The box that the step loop is measured on, and particles about it.
#pragma once

#include "collide/dn_field/field.hpp"
#include "collide/dn_field/particles.hpp"
#include "collide/dn_field/surface.hpp"

namespace bench {

inline constexpr int resolution = 60;
inline constexpr double step = 1e-3;
inline constexpr int n_steps = 32;
inline constexpr double half = 0.5;  // of the box

/// The box, each triangle cut into n².
[[nodiscard]] tess::dn::Surface cut_box(int n);

/// To the box, negative inside.
[[nodiscard]] double box_distance(tess::dn::Vec3 p);

/// Outside of the box, up to `furthest` from it, with velocities of all directions.
[[nodiscard]] tess::dn::Particles placed(std::size_t count, double furthest);

/// How far the worst particle is inside.
[[nodiscard]] double deepest(const tess::dn::Particles& particles);

}  // namespace bench
