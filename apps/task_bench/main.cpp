// task_bench: the task graphs of Task Bench (Slaughter et al., SC20) on chare arrays. It measures
// how small tasks may be before the runtime costs as much as they do.
#include "apps/kit/output/write_file.hpp"
#include "apps/task_bench/report.hpp"

namespace task_bench {
namespace {

tess::Task measure(const Settings& settings, kit::Driver& driver) {
  driver.progress().phase("measuring");
  const std::size_t n_cases = cases(settings).size();
  driver.progress().part(1, n_cases);
  tess::print_text(tess::machine().describe() + "\n" +
                   (settings.metg ? report().head() : std::string()));
  std::vector<Result> results;
  const auto tell = [&](const Result& result) {
    driver.progress().clear();
    tess::print_text(settings.metg ? report().line(result) : run_text(result));
    driver.progress().part(std::min(results.size() + 2, n_cases), n_cases);
  };
  co_await run_all(settings, tell, results);
  if (settings.metg)
    for (const Result& result : results) tess::print_text(limits_text(result));
  kit::Json options = driver.document({}).at("options");
  options["graphs"] = settings.words;
  driver.write(report().json(results), {{"options", options}});
  if (!settings.csv.empty()) kit::write_file(settings.csv, csv_of(results));
  driver.draw(chart_of(results));
}

int start(tess::Setup& setup, int argc, char** argv) {
  Settings settings;
  kit::Driver driver(setup,
                     "Task Bench (Slaughter et al., SC20): grids of tasks, one chare per column, "
                     "inputs checked.");
  if (!parse(argc, argv, setup.machine->n_pes(), driver, settings)) return 0;
  kit::require_writable("--csv", settings.csv);
  driver.files().writes("--csv", settings.csv);
  if (driver.explains() && driver.speaks()) tess::print_text(explain(settings));
  return tess::run(setup, [&] { return measure(settings, driver); });
}

}  // namespace
}  // namespace task_bench

int main(int argc, char** argv) {
  return tess::guarded(argc, argv,
                       [&](tess::Setup& setup) { return task_bench::start(setup, argc, argv); });
}
