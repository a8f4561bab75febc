// The minimum effective task granularity, METG(50 %): the smallest grain at which half of the
// machine's time is spent in kernels (Slaughter et al., SC20). It is found by a search over the
// kernel's iterations, which brackets the point, halves the bracket on a logarithmic scale, and
// interpolates. No messages here: the caller measures.
//
//     MetgSearch search;
//     while (const auto iterations = search.next()) search.tell(measure(*iterations));
//     search.found()
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace task_bench {

/// One measured grain: the median of a few runs.
struct Row {
  std::string type;  ///< of graphs at once: joined by +
  std::string kernel;
  std::int64_t width = 0, steps = 0;  ///< of the first graph
  std::int32_t pes = 0, ranks = 0;
  std::int64_t iterations = 0;
  std::uint64_t n_tasks = 0, n_dependences = 0;
  double grain_seconds = 0;  ///< the kernel of one task, measured alone
  double seconds = 0;        ///< elapsed
  double efficiency = 0;     ///< kernels of all tasks / (elapsed × PEs)
};

struct Metg {
  double grain_seconds = 0;  ///< the kernel at an efficiency of one half
  double wall_seconds = 0;   ///< elapsed × PEs / tasks there: SC20's task granularity
  bool below = false;        ///< it is half efficient with the least kernel already: an upper bound
};

class MetgSearch {
 public:
  /// The iterations to measure next; none once the bracket is narrow.
  [[nodiscard]] std::optional<std::int64_t> next() const { return next_; }
  void tell(Row row);

  /// None where no grain was half efficient.
  [[nodiscard]] std::optional<Metg> found() const;
  /// All that were measured, by their iterations.
  [[nodiscard]] std::vector<Row> rows() const;

 private:
  [[nodiscard]] const Row* less() const;  ///< the largest grain below one half
  [[nodiscard]] const Row* more() const;  ///< the smallest grain above it

  std::optional<std::int64_t> next_ = 64;
  std::vector<Row> rows_;
};

}  // namespace task_bench
