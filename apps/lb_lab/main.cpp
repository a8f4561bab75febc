// lb_lab: the effect of the number of chares per PE, of the strategy and its period on run time,
// and their cost. Runs workloads with a known answer under every given strategy and cut, or
// strategies on saved snapshots.
#include "apps/kit/driver.hpp"
#include "apps/kit/output/write_file.hpp"
#include "apps/kit/wrong_answer.hpp"
#include "apps/lb_lab/output/replay.hpp"
#include "apps/lb_lab/output/report.hpp"
#include "apps/lb_lab/sweep.hpp"
#include "apps/lb_lab/workload/kernel.hpp"
#include "runtime/more/balance_offline.hpp"
#include "runtime/runtime.hpp"

namespace lb_lab {
namespace {

constexpr kit::Modes replaying = kit::Mode::own(0);

tess::Task measure(Settings settings, double steps_a_second, kit::Driver& driver) {
  Sweep sweep;
  sweep.settings = std::move(settings);
  kit::Progress& progress = driver.progress();
  const Settings& s = sweep.settings;
  const std::size_t n_rows = s.workloads.size() * s.per_pe.size() * s.strategies.size();
  progress.phase("measuring");
  progress.part(1, n_rows);
  sweep.on_row = [&](const Row& row) {
    progress.clear();
    tess::print_text(report().line(row));
    progress.part(std::min(sweep.rows.size() + 1, n_rows), n_rows);
  };
  for (const std::string& one : sweep.settings.left_out)
    tess::print_text("left out: " + one + '\n');
  tess::print_text(report().head());
  co_await run_all(sweep, steps_a_second);
  progress.clear();
  tess::print_text(best_text(sweep));
  driver.write(report().json(sweep.rows), {{"best", best_json(sweep)}});
  if (!sweep.wrong.empty()) kit::end_with("lb_lab: wrong answer: " + sweep.wrong);
}

void add_options(kit::Driver& driver, Settings& s) {
  driver
      .option("--strategy NAMES", s.strategies,
              "names, or all (--list); the strategy none is always run")
      .separated_by(',');
  driver.option("--strategy-library FILE", s.library,
                "a shared library with strategies of your own, which --strategy names");
  driver.option("--speed X,X,…", s.speeds, "speed of each PE, as 1,1,0.5").separated_by(',');
  driver
      .option("--memory-limit BYTES", s.memory_limits,
              "bytes that a PE's chares may need: one number, or one per PE; 0: any")
      .separated_by(',');
  driver.option("--seed", s.seed, "of random workloads and strategies");
  driver.json();
  driver.in(kit::Mode::run);  // a replay reads snapshots and runs nothing
  driver.option("--workload NAMES", s.workloads, "names, or all (--list)").separated_by(',');
  driver.option("--per-pe", s.per_pe, "chares per PE: cuts of the same work").separated_by(',');
  driver.option("--period", s.period, "iterations between rounds");
  driver.option("--iterations", s.n_iterations, "iterations of a run").between(1, 100'000'000);
  driver.option("--grain TIME", s.grain,
                "mean work of a chare per iteration at the finest cut, as 250us");
  driver.option("--when NAME", s.when, "at_sync, periodic (no barrier), automatic");
  driver.option("--prediction NAME", s.prediction, "last, moving_average, linear_trend");
  driver
      .option("--cell-bytes", s.cell_bytes,
              "bytes that migrate with a chare at the finest cut; a cell has whole words of 8")
      .between(0, 1 << 30);
  driver.option("--message-bytes", s.message_bytes, "bytes to each neighbour per iteration")
      .between(0, 1 << 30);
  driver.repeat(s.repeat, "runs of each; the fastest counts");
  driver.option("--plot DIR", s.plot, "write SVG plots into a directory");
  driver.option("--save-snapshot DIR", s.snapshots,
                "write the snapshots given to strategies into a directory");
  driver
      .option("--snapshot-format", s.snapshot_format,
              "json.br: compressed with brotli, as vt does by default; or json")
      .one_of({"json.br", "json"});
  driver.explain();
  driver.in(replaying);
  driver
      .option("--replay PATH", s.replay,
              "run the strategies on saved snapshots instead: vt's LBDatafile, .json or .json.br, "
              "its files or their folder")
      .takes(1, 1 << 20);
  driver.enters("--replay", replaying);
  driver.option("--pes-of-replay", s.replay_pes, "PEs to replay on (default: those of the files)")
      .between(1, 1 << 20);
  driver.option("--fold NAME", s.fold,
                "how elements are placed on another number of PEs: block, modulo");
}

int start(tess::Setup& setup, int argc, char** argv) {
  Settings settings;
  bool list = false;
  kit::Driver driver(setup, "Experiments with overdecomposition and load balancing.");
  driver.flag("--list", list, "list workloads and strategies");
  add_options(driver, settings);
  driver.examples(
      {"--list", "--workload linear --per-pe 4 --strategy none,greedy --iterations 20 --pes 2",
       "--workload moving_hot_spot --strategy all --sim pes=8,latency=2us --iterations 20"});
  if (!driver.parse(argc, argv)) return 0;
  if (!settings.library.empty()) tess::balance::load_strategy_library(settings.library);
  if (list) {
    if (driver.speaks()) tess::print_text(list_text());
    return 0;
  }
  if (driver.is_given("--snapshot-format") && !driver.is_given("--save-snapshot"))
    tess::fail(
        tess::ErrorCode::bad_argument,
        "--snapshot-format: is an option of --save-snapshot; give a folder, or leave it out");
  for (const std::string& file : replay_files(settings.replay))
    driver.files().reads("--replay", file);
  if (driver.mode() == replaying) {
    const Replayed replayed = replay(settings, &driver.progress());
    if (!driver.speaks()) return 0;
    driver.progress().clear();
    tess::print_text(replayed.table + replayed.summary);
    driver.write(replayed.rows, {{"left_out", replayed.left_out},
                                 {"strategies", replayed.strategies},
                                 {"last_phase", replayed.last_phase},
                                 {"communications_left_out", replayed.n_communications}});
    return 0;
  }
  const std::int32_t n_pes = setup.machine->n_pes();
  complete(settings, n_pes);
  // On all processes: all of them have to end where one cannot write.
  kit::make_folder("--plot", settings.plot);
  kit::make_folder("--save-snapshot", settings.snapshots);
  double steps_a_second = 0;
  if (driver.speaks()) {
    if (driver.explains()) tess::print_text(explain_text(settings, n_pes));
    if (!setup.machine->virtual_time()) steps_a_second = calibrate();
  }
  return tess::run(setup, [&] { return measure(settings, steps_a_second, driver); });
}

}  // namespace

int program(int argc, char** argv) {
  return tess::guarded(argc, argv, [&](tess::Setup& setup) { return start(setup, argc, argv); });
}

}  // namespace lb_lab

int main(int argc, char** argv) {
  return lb_lab::program(argc, argv);
}
