#include "apps/fsi/problem.hpp"

#include "runtime/core/error.hpp"

namespace fsi {

double Problem::added_mass() const {
  const double k = std::numbers::pi * std::numbers::sqrt2;
  return density / (k * std::tanh(k * height));
}

double Problem::frequency() const {
  return std::numbers::pi * std::sqrt(2 * tension / (mass + added_mass()));
}

void Problem::complete(std::int32_t n_pes) {
  constexpr double most_substeps = 1e6;
  if (n_flow == 0) n_flow = n_panel + n_panel / 2 + 1;
  if (n_pieces == 0) n_pieces = std::min(2 * n_pes, std::min(n_panel, n_flow) + 1);
  if (n_pieces > std::min(n_panel, n_flow) + 1)
    tess::fail(tess::ErrorCode::bad_argument, "--pieces ", n_pieces, ": the meshes have ",
               n_panel + 1, " and ", n_flow + 1, " rows of points; give at most one piece per row");
  // Springs between the points are stable up to h √(m / 2 T).
  const double longest = std::sqrt(mass / (2 * tension)) / n_panel;
  const double least = std::ceil(dt() / longest);
  if (!(least <= most_substeps))
    tess::fail(tess::ErrorCode::bad_argument, "a step of ", dt(), " takes ", least,
               " steps of the panel, and at most ", most_substeps,
               " are taken; give more --per-period, more --mass or a coarser --panel");
  if (n_substeps == 0) n_substeps = static_cast<std::int32_t>(1.25 * least) + 1;
  if (n_substeps < least)
    tess::fail(tess::ErrorCode::bad_argument, "--substeps ", n_substeps,
               ": the panel is not stable above a step of ", longest, "; give at least ", least);
}

}  // namespace fsi
