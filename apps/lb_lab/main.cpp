// lb_lab: the effect of the number of chares per PE, of the strategy and its period on run time,
// and their cost. Runs workloads with a known answer under every given strategy and cut, or
// strategies on saved snapshots.
#include "apps/kit/file_names.hpp"
#include "apps/kit/write_file.hpp"
#include "apps/kit/wrong_answer.hpp"
#include "apps/lb_lab/output/replay.hpp"
#include "apps/lb_lab/output/report.hpp"
#include "apps/lb_lab/sweep.hpp"
#include "apps/lb_lab/workload/kernel.hpp"
#include "runtime/command_line.hpp"
#include "runtime/runtime.hpp"

namespace lb_lab {
namespace {

tess::Task measure(Settings settings, double steps_a_second) {
  Sweep sweep;
  sweep.settings = std::move(settings);
  sweep.on_row = print_row;
  sweep.machine = tess::machine().describe();
  for (const std::string& one : sweep.settings.left_out)
    tess::print_text("left out: " + one + '\n');
  print_head();
  co_await run_all(sweep, steps_a_second);
  print_best(sweep);
  if (!sweep.settings.json.empty()) write_json(sweep.settings.json, sweep);
  if (!sweep.wrong.empty()) kit::end_with("lb_lab: wrong answer: " + sweep.wrong);
}

void add_options(tess::CommandLine& line, Settings& s) {
  line.option("--workload NAMES", s.workloads, "names, or all (--list)").separated_by(',');
  line.option("--per-pe", s.per_pe, "chares per PE: cuts of the same work").separated_by(',');
  line.option("--strategy NAMES", s.strategies,
              "names, or all (--list); the strategy none is always run")
      .separated_by(',');
  line.option("--period", s.period, "iterations between rounds");
  line.option("--iterations", s.n_iterations, "iterations of a run").between(1, 100'000'000);
  line.option("--grain TIME", s.grain,
              "mean work of a chare per iteration at the finest cut, as 250us");
  line.option("--when NAME", s.when, "at_sync, periodic (no barrier), automatic");
  line.option("--prediction NAME", s.prediction, "last, moving_average, linear_trend");
  line.option("--speed X,X,…", s.speeds, "speed of each PE, as 1,1,0.5").separated_by(',');
  line.option("--memory-limit BYTES", s.memory_limits,
              "bytes that a PE's chares may need: one number, or one per PE; 0: any")
      .separated_by(',');
  line.option("--seed", s.seed, "of random workloads and strategies");
  line.option("--cell-bytes", s.cell_bytes,
              "bytes that migrate with a chare at the finest cut; a cell has whole words of 8")
      .between(0, 1 << 30);
  line.option("--message-bytes", s.message_bytes, "bytes to each neighbour per iteration")
      .between(0, 1 << 30);
  line.option("--repeat", s.repeat, "runs of each; the fastest counts").between(1, 1000);
  line.option("--json FILE", s.json, "write the rows as JSON");
  line.option("--plot DIR", s.plot, "write SVG plots into a directory");
  line.option("--save-snapshot DIR", s.snapshots,
              "write the snapshots given to strategies into a directory");
  line.option("--snapshot-format", s.snapshot_format,
              "json.br: compressed with brotli, as vt does by default; or json")
      .one_of({"json.br", "json"});
  line.option("--replay PATH", s.replay,
              "run the strategies on saved snapshots instead: vt's LBDatafile, .json or .json.br, "
              "its files or their folder")
      .takes(1, 1 << 20);
  line.option("--pes-of-replay", s.replay_pes, "PEs to replay on (default: those of the files)")
      .between(1, 1 << 20);
  line.option("--fold NAME", s.fold,
              "how elements are placed on another number of PEs: block, modulo");
  line.flag("--explain", s.explain, "print what this run uses and what it leaves out");
}

/// A replay reads snapshots and runs nothing, so it has no use for the options of runs, nor a run
/// for those of replays.
void require_one_purpose(const tess::CommandLine& line, bool replays) {
  if (!replays) {
    for (const char* const name : {"--pes-of-replay", "--fold"})
      if (line.is_given(name))
        tess::fail(tess::ErrorCode::bad_argument, name,
                   ": is an option of --replay; give the snapshots to replay, or leave it out");
    if (line.is_given("--snapshot-format") && !line.is_given("--save-snapshot"))
      tess::fail(
          tess::ErrorCode::bad_argument,
          "--snapshot-format: is an option of --save-snapshot; give a folder, or leave it out");
    return;
  }
  for (const char* const name :
       {"--workload", "--per-pe", "--period", "--iterations", "--grain", "--when", "--prediction",
        "--cell-bytes", "--message-bytes", "--repeat", "--plot", "--save-snapshot",
        "--snapshot-format", "--explain"})
    if (line.is_given(name))
      tess::fail(tess::ErrorCode::bad_argument, name,
                 ": is an option of runs, and --replay runs nothing; leave one of them out");
}

int start(tess::Setup& setup, int argc, char** argv) {
  Settings settings;
  bool list = false;
  tess::CommandLine line("Experiments with overdecomposition and load balancing.");
  add_options(line, settings);
  line.flag("--list", list, "list workloads and strategies");
  if (!line.parse(argc, argv)) return 0;
  const bool prints = setup.machine->process() == tess::ProcessId{0};
  if (list) {
    if (prints) tess::print_text(list_text());
    return 0;
  }
  require_one_purpose(line, !settings.replay.empty());
  kit::FileNames names;
  for (const std::string& file : replay_files(settings.replay)) names.reads("--replay", file);
  names.writes("--trace", setup.options.trace);
  names.writes("--json", settings.json);
  if (!settings.replay.empty()) {
    kit::require_writable("--json", settings.json);
    const Replayed replayed = replay(settings);
    if (!prints) return 0;
    tess::print_text(replayed.table);
    if (!settings.json.empty()) kit::write_file(settings.json, replayed.json);
    return 0;
  }
  const std::int32_t n_pes = setup.machine->n_pes();
  complete(settings, n_pes);
  // On all processes: all of them have to end where one cannot write.
  kit::make_folder("--plot", settings.plot);
  kit::make_folder("--save-snapshot", settings.snapshots);
  kit::require_writable("--json", settings.json);
  double steps_a_second = 0;
  if (prints) {
    if (settings.explain) tess::print_text(explain_text(settings, n_pes));
    if (!setup.machine->virtual_time()) steps_a_second = calibrate();
  }
  return tess::run(setup, [&] { return measure(settings, steps_a_second); });
}

}  // namespace

int program(int argc, char** argv) {
  return tess::guarded(argc, argv, [&](tess::Setup& setup) { return start(setup, argc, argv); });
}

}  // namespace lb_lab

int main(int argc, char** argv) {
  return lb_lab::program(argc, argv);
}
