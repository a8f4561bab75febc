// task_bench: the task graphs of Task Bench (Slaughter et al., SC20) on chare arrays. It measures
// how small tasks may be before the runtime costs as much as they do.
#include "apps/kit/file_names.hpp"
#include "apps/kit/write_file.hpp"
#include "apps/task_bench/report.hpp"

namespace task_bench {
namespace {

tess::Task measure(Settings settings) {
  const tess::Machine& machine = tess::machine();
  print_head(settings, machine);
  std::vector<Result> results;
  co_await run_all(settings, &print_result, results);
  if (!settings.json.empty()) write_json(settings.json, results, machine.describe());
  if (!settings.csv.empty()) write_csv(settings.csv, results);
  if (!settings.plot.empty()) draw(settings.plot, results);
}

int start(tess::Setup& setup, int argc, char** argv) {
  const auto settings = parse(argc, argv, *setup.machine);
  if (!settings) return 0;
  // On all processes, so that all of them detect an error.
  kit::require_writable("--json", settings->json);
  kit::require_writable("--csv", settings->csv);
  kit::require_picture("--plot", settings->plot);
  kit::FileNames names;
  names.writes("--trace", setup.options.trace);
  names.writes("--json", settings->json);
  names.writes("--csv", settings->csv);
  names.writes_picture("--plot", settings->plot);
  if (settings->explain && setup.machine->process() == tess::ProcessId{0})
    tess::print_text(explain(*settings));
  return tess::run(setup, [&] { return measure(*settings); });
}

}  // namespace
}  // namespace task_bench

int main(int argc, char** argv) {
  return tess::guarded(argc, argv, [&](tess::Setup& setup) {
    // They are written as Task Bench does.
    return task_bench::start(setup, std::exchange(argc, 1), argv);
  });
}
