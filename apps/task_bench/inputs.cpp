#include "apps/task_bench/inputs.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace task_bench {

Inputs::Inputs(const Graph& graph, std::int32_t point)
    : graph_(graph),
      point_(point),
      n_steps_(graph.steps),
      n_sets_(n_sets(graph)),
      varies_(graph.type == Type::dom || graph.type == Type::tree) {
  for (std::int32_t s = 0; s < n_sets_; ++s) {
    Set set{dependences(graph, s, point), dependents(graph, s, point)};
    set.in_a_row = !set.from.empty() && set.from.back() - set.from.front() + 1 ==
                                            static_cast<std::int32_t>(set.from.size());
    set.itself = std::ranges::find(set.from, point) != set.from.end();
    n_places_ = std::max(n_places_, set.from.size());
    sets_.push_back(std::move(set));
  }
  counts_.assign(2, 0);
  slots_.assign(2 * n_places_, Output{0, -1});
  rewind();
}

void Inputs::grow(std::int64_t step) {
  std::size_t n = counts_.size();
  while (step - first_ >= static_cast<std::int64_t>(n)) n *= 2;
  std::vector<std::int32_t> counts(n, 0);
  std::vector<Output> slots(n * n_places_, Output{0, -1});
  for (std::size_t k = 0; k < counts_.size(); ++k) {
    const std::int64_t old = first_ + static_cast<std::int64_t>(k);
    const std::size_t to = static_cast<std::size_t>(old) & (n - 1);
    counts[to] = counts_[index_of(old)];
    std::copy_n(slot_of(old), n_places_, slots.data() + to * n_places_);
  }
  counts_ = std::move(counts);
  slots_ = std::move(slots);
}

void Inputs::count_active() {
  const Points before = points_at(graph_, first_ - 1);
  n_needed_ = 0;
  needs_itself_ = false;
  if (!points_at(graph_, first_).contains(point_)) return;
  for (const std::int32_t from : sets_[set_of(first_)].from) {
    if (!before.contains(from)) continue;
    ++n_needed_;
    needs_itself_ = needs_itself_ || from == point_;
  }
}

void Inputs::rewind() {
  first_ = 0;
  set_ = set_at(graph_, 0);
  count_needed();
}

std::string Inputs::complaint(const Output& output) const {
  return fmt::format(
      "point {} got an output of (step {}, point {}) when its next step was {}: it "
      "does not depend on it, or has it already",
      point_, output.step, output.point, first_);
}

}  // namespace task_bench
