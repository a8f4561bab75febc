// The whole domain at once. It shares the next state of a cell with the chares, but no code of
// blocks, halos, messages or migrations.
#include "apps/lb_lab/workload/serial.hpp"

#include "runtime/core/hash.hpp"

#include <algorithm>

namespace lb_lab {

std::uint64_t serial_answer_of_cells(const Problem& p) {
  const Workload& workload = workload_of(p);
  const std::int32_t width = p.domain.width, height = p.domain.height;
  const bool looks = workload.traffic == Traffic::neighbours;
  std::vector<std::uint64_t> now(static_cast<std::size_t>(p.domain.n_cells())), next(now.size());
  const auto state = [&](std::int32_t x, std::int32_t y) -> std::uint64_t {
    if (!looks || x < 0 || y < 0 || x >= width || y >= height) return 0;
    return now[p.domain.number({x, y})];
  };
  const auto each = [&](const auto& what) {
    for (std::int32_t y = 0; y < height; ++y)
      for (std::int32_t x = 0; x < width; ++x) what(Cell{x, y}, p.domain.number({x, y}));
  };
  each([&](Cell cell, std::uint64_t i) { now[i] = workload.first(p, cell); });
  for (std::int32_t t = 0; t < p.n_iterations; ++t) {
    each([&](Cell c, std::uint64_t i) {
      next[i] = workload.next(p, c, t,
                              {now[i], state(c.x - 1, c.y), state(c.x + 1, c.y),
                               state(c.x, c.y - 1), state(c.x, c.y + 1)});
    });
    std::swap(now, next);
  }
  std::uint64_t answer = 0;
  each([&](Cell cell, std::uint64_t i) {
    const std::vector<std::uint64_t> cargo = cargo_of(p, cell);
    answer += answer_of(p, cell, now[i], tess::hash_bytes(cargo.data(), 8 * cargo.size()));
  });
  return answer;
}

double total_seconds_of_cells(const Problem& p) {
  const Block whole{{0, 0}, p.domain.width, p.domain.height};
  double sum = 0;
  for (std::int32_t t = 0; t < p.n_iterations; ++t) sum += block_seconds(p, whole, t);
  return sum;
}

}  // namespace lb_lab
