#include "apps/lb_lab/workload/patch.hpp"

#include "runtime/core/check.hpp"
#include "runtime/core/hash.hpp"

#include <utility>

namespace lb_lab {

Patch::Patch(const Problem& problem, const Block& block) : block_(block) {
  now_.resize(at(block.width, block.height) + 1);
  const Workload& workload = workload_of(problem);
  for (std::int32_t y = 0; y < block.height; ++y) {
    for (std::int32_t x = 0; x < block.width; ++x) {
      const Cell cell{block.first.x + x, block.first.y + y};
      now_[at(x, y)] = workload.first(problem, cell);
      const std::vector<std::uint64_t> words = cargo_of(problem, cell);
      cargo_.insert(cargo_.end(), words.begin(), words.end());
    }
  }
}

Patch::Line Patch::line(Side side, std::int32_t out) const {
  const auto stride = static_cast<std::size_t>(block_.width + 2);
  const auto width = static_cast<std::size_t>(block_.width);
  const auto height = static_cast<std::size_t>(block_.height);
  switch (side) {
    case Side::west:
      return {at(-out, 0), stride, height};
    case Side::east:
      return {at(block_.width - 1 + out, 0), stride, height};
    case Side::south:
      return {at(0, -out), 1, width};
    case Side::north:
      break;
  }
  return {at(0, block_.height - 1 + out), 1, width};
}

std::vector<std::uint64_t> Patch::edge(Side side) const {
  const Line along = line(side, 0);
  std::vector<std::uint64_t> states(along.n);
  for (std::size_t i = 0; i < along.n; ++i) states[i] = now_[along.first + i * along.stride];
  return states;
}

void Patch::set_halo(Side side, const std::vector<std::uint64_t>& states) {
  const Line along = line(side, 1);
  TESS_CHECK(states.size() == along.n, "a halo of ", along.n, " cells gets ", states.size());
  for (std::size_t i = 0; i < along.n; ++i) now_[along.first + i * along.stride] = states[i];
}

void Patch::advance(const Problem& problem, std::int32_t iteration) {
  const Workload& workload = workload_of(problem);
  const bool looks = workload.traffic == Traffic::neighbours;
  next_.assign(now_.size(), 0);
  for (std::int32_t y = 0; y < block_.height; ++y) {
    for (std::int32_t x = 0; x < block_.width; ++x) {
      Stencil around{.self = now_[at(x, y)]};
      if (looks) {
        around.west = now_[at(x - 1, y)];
        around.east = now_[at(x + 1, y)];
        around.south = now_[at(x, y - 1)];
        around.north = now_[at(x, y + 1)];
      }
      next_[at(x, y)] =
          workload.next(problem, {block_.first.x + x, block_.first.y + y}, iteration, around);
    }
  }
  std::swap(now_, next_);
}

std::uint64_t Patch::answer(const Problem& problem) const {
  const std::size_t n_words = problem.cell_bytes / 8;
  std::uint64_t sum = 0;
  std::size_t cell = 0;
  for (std::int32_t y = 0; y < block_.height; ++y)
    for (std::int32_t x = 0; x < block_.width; ++x, ++cell)
      sum += answer_of(problem, {block_.first.x + x, block_.first.y + y}, now_[at(x, y)],
                       tess::hash_bytes(cargo_.data() + cell * n_words, 8 * n_words));
  return sum;
}

}  // namespace lb_lab
