#include "apps/lb_lab/run/kind.hpp"

#include <algorithm>

namespace lb_lab {
namespace {

constexpr double fewest_items = 256, most_items = 1 << 18;

double iteration_seconds(const Problem& p) {
  return p.cell_seconds * static_cast<double>(p.domain.n_cells());
}

}  // namespace

std::uint64_t n_items(const Problem& p, double nominal_seconds) {
  return static_cast<std::uint64_t>(
      std::clamp(iteration_seconds(p) / nominal_seconds, fewest_items, most_items));
}

double item_seconds(const Problem& p, std::uint64_t n_items) {
  return iteration_seconds(p) / static_cast<double>(n_items);
}

double nominal_seconds(const Problem& p) {
  return iteration_seconds(p) * p.n_iterations;
}

std::uint64_t serial_answer(const Problem& p) {
  return workload_of(p).kind->serial_answer(p);
}

double total_seconds(const Problem& p) {
  return workload_of(p).kind->total_seconds(p);
}

}  // namespace lb_lab
