#include "apps/task_bench/metg.hpp"

#include <algorithm>
#include <cmath>

namespace task_bench {
namespace {

constexpr double half = 0.5;
constexpr double narrow = 1.05;                       // ratio of a bracket's ends
constexpr std::int64_t most = std::int64_t{1} << 26;  // iterations: 0.3 s per task
constexpr std::int64_t stride = 4;                    // of the search for a bracket
constexpr double most_seconds = 5;                    // of a run: no grain is worth longer ones

double between(double a, double b, double share) {
  return a + share * (b - a);
}

}  // namespace

const Row* MetgSearch::less() const {
  // Measured efficiencies may not be monotonic: what is below the first good grain counts.
  const Row* const good = more();
  const Row* best = nullptr;
  for (const Row& row : rows_)
    if (row.efficiency < half && (good == nullptr || row.iterations < good->iterations) &&
        (best == nullptr || row.iterations > best->iterations))
      best = &row;
  return best;
}

const Row* MetgSearch::more() const {
  const Row* best = nullptr;
  for (const Row& row : rows_)
    if (row.efficiency >= half && (best == nullptr || row.iterations < best->iterations))
      best = &row;
  return best;
}

void MetgSearch::tell(Row row) {
  rows_.push_back(std::move(row));
  const Row* const low = less();
  const Row* const high = more();
  next_.reset();
  if (high == nullptr) {
    if (low->iterations < most && low->seconds * stride < most_seconds)
      next_ = low->iterations * stride;
  } else if (low == nullptr) {
    if (high->iterations > 1) next_ = std::max<std::int64_t>(1, high->iterations / stride);
  } else if (high->iterations - low->iterations > 1 &&
             static_cast<double>(high->iterations) >
                 narrow * static_cast<double>(low->iterations)) {
    const double middle =
        std::sqrt(static_cast<double>(low->iterations) * static_cast<double>(high->iterations));
    next_ =
        std::clamp<std::int64_t>(std::llround(middle), low->iterations + 1, high->iterations - 1);
  }
}

std::optional<Metg> MetgSearch::found() const {
  const Row* const low = less();
  const Row* const high = more();
  if (high == nullptr) return std::nullopt;
  const auto wall = [](const Row& row) {
    return row.seconds * row.pes / static_cast<double>(row.n_tasks);
  };
  if (low == nullptr) return Metg{high->grain_seconds, wall(*high), true};
  const double share = (half - low->efficiency) / (high->efficiency - low->efficiency);
  return Metg{between(low->grain_seconds, high->grain_seconds, share),
              between(wall(*low), wall(*high), share), false};
}

std::vector<Row> MetgSearch::rows() const {
  std::vector<Row> rows = rows_;
  std::ranges::sort(rows, {}, &Row::iterations);
  return rows;
}

}  // namespace task_bench
