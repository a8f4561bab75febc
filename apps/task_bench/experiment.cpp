#include "apps/task_bench/experiment.hpp"

#include "apps/kit/median.hpp"
#include "apps/kit/wrong_answer.hpp"
#include "runtime/more/load_measurement.hpp"

#include <algorithm>
#include <deque>
#include <fmt/format.h>

namespace task_bench {
namespace {

/// The arrays of one case.
class Bench {
 public:
  Bench(const Settings& settings, std::vector<Graph> graphs)
      : settings_(settings), graphs_(std::move(graphs)) {
    for (const Graph& graph : graphs_) {
      columns_.push_back(tess::create<Column>(tess::range(graph.width), graph));
      totals_.push_back(totals(graph));
      if (settings_.balance)
        balancers_.push_back(tess::start_balancing(columns_.back(), *settings_.balance));
    }
  }

  /// One run of all graphs; `seconds` is what it took. `iterations`: of every kernel, or as each
  /// graph has them.
  tess::Task run(std::optional<std::int64_t> iterations, double* seconds);
  /// The median (or the fastest) of a few runs, after one that is not counted where there are
  /// several.
  tess::Task measure(std::optional<std::int64_t> iterations, Row* row);
  /// Runs, or the search.
  tess::Task measure_all(Result* result);

 private:
  [[nodiscard]] double kernel_seconds(const Graph& graph, std::int64_t iterations) const {
    if (is_virtual())
      return 1e-9 * static_cast<double>(virtual_nanoseconds(graph.kernel, iterations));
    return calibrate(graph.kernel, iterations);
  }
  [[nodiscard]] bool is_virtual() const { return tess::machine().virtual_time(); }
  void check(std::size_t graph, const Count& count) const;
  [[nodiscard]] Row row_of(std::optional<std::int64_t> iterations, double seconds) const;

  const Settings& settings_;
  const std::vector<Graph> graphs_;
  std::vector<tess::ArrayProxy<Column>> columns_;
  std::vector<tess::BalancerProxy> balancers_;
  std::vector<Totals> totals_;
};

tess::Task Bench::run(std::optional<std::int64_t> iterations, double* seconds) {
  std::deque<tess::Future<Count>> done;
  const tess::Time began = tess::now();
  for (std::size_t k = 0; k < graphs_.size(); ++k) {
    Run run;
    run.iterations = iterations.value_or(graphs_[k].kernel.iterations);
    run.sync_every = settings_.sync_every;
    if (!settings_.spoiled.empty()) run.spoiled = {settings_.spoiled[0], settings_.spoiled[1]};
    run.virtual_time = is_virtual() ? 1 : 0;
    run.done = done.emplace_back().callback();
    columns_[k].broadcast<&Column::begin>(run);
  }
  for (std::size_t k = 0; k < graphs_.size(); ++k) {
    tess::Future<Count>& future = done[k];
    const Count count = co_await future;
    check(k, count);
  }
  *seconds = tess::seconds(tess::now() - began);
}

void Bench::check(std::size_t graph, const Count& count) const {
  const Totals& expected = totals_[graph];
  if (count.n_tasks == expected.n_tasks && count.n_inputs == expected.n_dependences) return;
  kit::end_with(fmt::format(
      "task_bench: wrong answer: {} ran {} tasks with {} inputs, the graph has {} and {}",
      name_of(graphs_[graph].type), count.n_tasks, count.n_inputs, expected.n_tasks,
      expected.n_dependences));
}

Row Bench::row_of(std::optional<std::int64_t> iterations, double seconds) const {
  Row row;
  double kernels = 0;
  for (std::size_t k = 0; k < graphs_.size(); ++k) {
    const Graph& graph = graphs_[k];
    row.type += (k > 0 ? "+" : "") + name_of(graph.type);
    row.kernel += (k > 0 ? "+" : "") + name_of(graph.kernel.type);
    row.n_tasks += totals_[k].n_tasks;
    row.n_dependences += totals_[k].n_dependences;
    Graph tried = graph;
    tried.kernel.iterations = iterations.value_or(graph.kernel.iterations);
    const auto n_tasks = static_cast<double>(totals_[k].n_tasks);
    // A kernel's time is linear in its iterations; where they are random, the drawn ones count.
    const double asked = n_tasks * static_cast<double>(tried.kernel.iterations);
    const double drawn = asked > 0 ? static_cast<double>(totals(tried).n_iterations) / asked : 1;
    kernels += drawn * n_tasks * kernel_seconds(graph, tried.kernel.iterations);
  }
  row.width = graphs_.front().width;
  row.steps = graphs_.front().steps;
  row.pes = tess::n_pes();
  row.ranks = tess::machine().n_processes();
  row.iterations = iterations.value_or(graphs_.front().kernel.iterations);
  row.grain_seconds = kernels / static_cast<double>(row.n_tasks);
  row.seconds = seconds;
  row.efficiency = kernels / (seconds * row.pes);
  return row;
}

tess::Task Bench::measure(std::optional<std::int64_t> iterations, Row* row) {
  double seconds = 0;
  if (settings_.repeat > 1) co_await run(iterations, &seconds);
  std::vector<double> all;
  for (std::int32_t k = 0; k < settings_.repeat; ++k) {
    co_await run(iterations, &seconds);
    all.push_back(seconds);
  }
  *row = row_of(iterations, settings_.fastest ? std::ranges::min(all) : kit::median(all));
}

tess::Task Bench::measure_all(Result* result) {
  result->graphs = graphs_;
  std::optional<std::int64_t> last;  // of METG's search: close to what it found
  if (settings_.metg) {
    MetgSearch search;
    while (const auto iterations = search.next()) {
      Row row;
      co_await measure(*iterations, &row);
      search.tell(row);
      last = iterations;
    }
    result->metg = search.found();
    result->rows = search.rows();
  } else {
    Row row;
    co_await measure(std::nullopt, &row);
    result->rows.push_back(row);
  }
  for (const tess::BalancerProxy& balancer : balancers_)
    result->rounds.push_back(balancer.history());
  // A run of its own: the measurement costs as much as a message.
  tess::LoadMeasurement measurement;
  std::vector<tess::PeLoad> loads;
  double seconds = 0;
  co_await measurement.begin();
  co_await run(last, &seconds);
  co_await measurement.end(&loads);
  result->limits = tess::summarise(loads);
}

}  // namespace

tess::Task run_all(const Settings& settings, const std::function<void(const Result&)>& tell,
                   std::vector<Result>& results) {
  for (const std::vector<Graph>& graphs : cases(settings)) {
    Bench bench(settings, graphs);
    Result result;
    co_await bench.measure_all(&result);
    tell(result);
    results.push_back(std::move(result));
  }
}

}  // namespace task_bench
