#include "apps/amr/problem.hpp"

#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace amr {

void Problem::complete() {
  using tess::ErrorCode;
  if (n_cells < 4 || n_cells % 2 != 0)
    tess::fail(ErrorCode::bad_argument, "--cells: ", n_cells, " is not an even number from 4 on");
  if (least_level > most_level)
    tess::fail(ErrorCode::bad_argument, "--least-level: ", least_level, " is above --max-level ",
               most_level);
  if (!(cfl > 0 && cfl <= 1))
    tess::fail(ErrorCode::bad_argument, "--cfl: ", cfl,
               " is not within 0 … 1: the scheme is unstable above 1");
  const auto require_finite = [](const char* option, const std::array<double, 3>& vector) {
    for (const double x : vector)
      if (!std::isfinite(x)) tess::fail(ErrorCode::bad_argument, option, ": ", x, " is not finite");
  };
  require_finite("--velocity", velocity);
  require_finite("--centre", centre);
  double fastest = 0;
  for (const double v : velocity) fastest = std::max(fastest, std::abs(v));
  if (fastest == 0)
    tess::fail(ErrorCode::bad_argument, "--velocity: one component must differ from 0");
  // Rounding must not add a step to a number of steps that is exact.
  if (n_steps == 0) {
    const double n = std::ceil(end * fastest / (cfl * spacing(most_level)) * (1 - 1e-12));
    if (!(n <= most_steps))
      tess::fail(ErrorCode::bad_argument, "--time: ", end, " takes ", n, " steps, and at most ",
                 most_steps, " are run: give at most ",
                 most_steps * cfl * spacing(most_level) / fastest);
    n_steps = std::max(1, static_cast<std::int32_t>(n));
    dt = end / n_steps;
  } else {
    // The number of steps does not change a bit of it: a restart may go on for more of them.
    dt = cfl * spacing(most_level) / fastest;
    end = n_steps * dt;
  }
  if (!std::isfinite(end))
    tess::fail(ErrorCode::bad_argument, "--velocity: ", fastest,
               " takes endless time through a cell: give a larger one, or --time");
  double mass = 1;
  for (std::int32_t axis = 0; axis < 3; ++axis) mass *= mean(axis, 0, 1, 0);
  if (!(mass < 7.9))  // 64 bits of quanta
    tess::fail(ErrorCode::bad_argument, "--width: ", width, " gives u a mean of ", mass,
               ", and it must be below 8: give a smaller one");
}

double Problem::mean(std::int32_t axis, double low, double h, double time) const {
  const auto a = static_cast<std::size_t>(axis);
  const double scale = 1 / (width * std::numbers::sqrt2);
  double from = low - centre[a] - velocity[a] * time;
  from -= std::floor(from);
  double sum = 0;
  // The widest field that complete() takes is below 1e-12 of its height six edges away.
  for (std::int32_t image = -6; image < 6; ++image)
    sum += std::erf((from + image + h) * scale) - std::erf((from + image) * scale);
  return sum * width * std::sqrt(std::numbers::pi / 2) / h;
}

}  // namespace amr
