// The runtime's cost, row by row, each beside the limit that the machine sets where one is known:
// CSV on standard output. The shapes are those in which other runtimes were timed; their figures
// stand in apps/bench/results/.
//
//     bench --pes 1;  bench --pes 2;  mpirun -n 2 bench --pes 1;  bench message one_way --pes 2
#include "apps/bench/calibrate/calibrate.hpp"
#include "apps/bench/shapes/shapes.hpp"
#include "apps/kit/driver.hpp"
#include "apps/kit/output/write_file.hpp"
#include "runtime/command_line.hpp"

#include <algorithm>
#include <fmt/core.h>

namespace bench {
namespace {

const std::vector<Shape>& all_shapes() {
  static const std::vector<Shape> all{
      message_shape(), creation_shape(), collectives_shape(),   migration_shape(), one_way_shape(),
      work_shape(),    balance_shape(),  balance_round_shape(), measuring_shape(), timers_shape()};
  return all;
}

std::string needed(Needs needs) {
  switch (needs) {
    case Needs::two_pes:
      return "two PEs: give --pes 2";
    case Needs::two_cores:
      return "two PEs in one process: give --pes 2, without mpirun";
    case Needs::two_processes:
      return "two processes: start it by mpirun -n 2";
    default:
      return "nothing";
  }
}

/// Throws Error for a name that is neither a shape's nor a row's, or that this machine cannot show.
void require_known(const Bench& bench, const std::string& name) {
  for (const Shape& shape : all_shapes()) {
    const bool whole = shape.name == name;
    for (const RowText& row : shape.rows) {
      if (!whole && row.name != name) continue;
      if (bench.has(row.needs)) return;
      if (!whole || &row == &shape.rows.back())
        tess::fail(tess::ErrorCode::bad_argument, name, " needs ", needed(row.needs));
    }
  }
  tess::fail(tess::ErrorCode::bad_argument, "no shape and no row is named ", name, " (see --list)");
}

/// The rows that are asked for and can be measured here.
std::vector<std::string> chosen(const Bench& bench, const std::vector<std::string>& names) {
  for (const std::string& name : names) require_known(bench, name);
  const auto named = [&names](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  std::vector<std::string> rows;
  for (const Shape& shape : all_shapes())
    for (const RowText& row : shape.rows)
      if (bench.has(row.needs) && (names.empty() || named(shape.name) || named(row.name)))
        rows.push_back(row.name);
  return rows;
}

[[nodiscard]] bool any_wanted(const Bench& bench, const Shape& shape) {
  return std::any_of(shape.rows.begin(), shape.rows.end(),
                     [&bench](const RowText& row) { return bench.wants(row.name); });
}

void list(const Bench& bench) {
  for (const Shape& shape : all_shapes()) {
    if (!any_wanted(bench, shape)) continue;
    tess::print(fmt::format("{}: {}\n", shape.name, shape.meaning));
    for (const RowText& row : shape.rows)
      if (bench.wants(row.name)) tess::print(fmt::format("  {:<26} {}\n", row.name, row.meaning));
  }
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  const std::vector<char*> command_line(argv, argv + argc);
  return tess::guarded(argc, argv, [&](tess::Setup& setup) {
    bench::Options options;
    bool lists = false;
    std::string calibrated;
    tess::CommandLine line("What the runtime costs, beside what the machine allows.");
    line.option("NAME", options.names, "shapes or rows (all by default)");
    const tess::Option repeat =
        line.option("--repeat", options.repeat, "samples of each figure, after one that warms up")
            .between(1, 1000);
    line.flag("--list", lists, "names and meanings of what can be measured on this machine");
    line.flag("--quick", options.quick, "small sizes: to try out, not to measure");
    line.option("--json FILE", options.json, "a file for the rows as JSON");
    line.option("--calibrate FILE", calibrated,
                "measure what a simulated machine needs, and write it to a file for --sim");
    if (!line.parse(argc, argv)) return 0;
    if (options.quick && !repeat.is_given()) options.repeat = 1;
    if (!calibrated.empty())
      line.refuse_beside("--calibrate " + calibrated, {"NAME", "--repeat", "--list", "--json"});
    kit::require_writable("--json", options.json);
    kit::FileNames names;
    names.writes("--trace", setup.options.trace);
    names.writes("--json", options.json);
    names.writes("--calibrate", calibrated);

    bench::Bench bench(options, command_line, *setup.machine);
    if (!calibrated.empty()) {
      bench::require_calibration(calibrated, *setup.machine);
      kit::require_writable("--calibrate", calibrated);
      return bench::calibrate(bench, calibrated);
    }
    bench.choose(bench::chosen(bench, options.names));
    const bool speaks = setup.machine->process().value == 0;
    if (lists) {
      if (speaks) bench::list(bench);
      return 0;
    }
    if (speaks) bench.report().header();
    for (const bench::Shape& shape : bench::all_shapes()) {
      if (!bench::any_wanted(bench, shape)) continue;
      if (const int code = bench::run(shape, bench); code != 0) return code;
    }
    if (speaks && !options.json.empty())
      kit::write_file(
          options.json,
          kit::json_text(kit::document(
              "bench", setup.machine->describe(),
              {{"names", options.names}, {"repeat", options.repeat}, {"quick", options.quick}},
              bench.report().json())));
    return 0;
  });
}
