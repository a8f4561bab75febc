// collide_scaling: steps of a collision on simulated machines of 1 to 1 500 PEs.
//
//     collide_scaling --out PREFIX         weak: two wavy planes, 65 536 triangles per PE
//     collide_scaling --study strong       a crowd of moving bodies, with the balancer on and off
//     collide_scaling --check              predicted and measured steps of 1 and 2 PEs only
#include "apps/collide_scaling/calibrate.hpp"
#include "apps/collide_scaling/report.hpp"
#include "apps/kit/write_file.hpp"
#include "runtime/balance.hpp"
#include "runtime/command_line.hpp"
#include "runtime/core/error.hpp"
#include "runtime/machine/mpi.hpp"

#include <cstdio>
#include <fmt/core.h>
#include <optional>

namespace collide_scaling {
namespace {

int study(int argc, char** argv) {
  std::string kind = "weak", work = "model", out;
  std::vector<std::int32_t> pes;
  std::vector<std::string> balances, costs;
  bool check = false;
  Case given;
  std::uint64_t n_triangles = 0;
  std::int32_t thinned = 0, steps = 0;
  tess::CommandLine line("Steps of a collision on simulated machines of many PEs");
  line.option("--study", kind,
              "weak: as many triangles on each PE; strong: one crowd on more and more PEs")
      .one_of({"weak", "strong"});
  line.option("--pes", pes, "PEs of the machines (1,4,16,64,256,1500; strong 1,4,16,64,256)")
      .separated_by(',')
      .between(1, 1 << 20);
  line.option("--triangles", n_triangles, "per PE (65536), or of the crowd (262144)")
      .between(2048, std::int64_t{1} << 32);
  line.option("--steps", steps,
              "steps, of which the first does not count (2; measured 4; strong 60)")
      .between(2, 100000);
  line.option("--thinned", thinned,
              "weak: one of so many triangles is there, at so many times the cost "
              "(default: 4 for more than 128 million triangles)")
      .one_of({"1", "4", "16"});
  line.option("--balance STRATEGY", balances, "strategies, or none (strong: none,greedy_refine)")
      .separated_by(',');
  line.option("--work", work,
              "model: fixed times of a message and of each part; measured: processor time of all")
      .one_of({"measured", "model"});
  line.option("--message-ns", given.message_ns, "of a PE per message, in the model")
      .between(0, 1'000'000'000);
  line.option("--costs", costs,
              "of a PE per item of each part, in the model: gridding=9ns,search=20ns,pair=5ns,"
              "reply=2ns,copy=8ns,record=60ns (default: fitted now, on one PE, and checked)")
      .separated_by(',');
  line.flag("--check", check,
            "predict and measure 1 and 2 PEs, nothing else; two processes with mpirun -n 2");
  line.option("--latency-ns", given.latency_ns, "of a message").between(0, 1'000'000'000);
  line.option("--bandwidth", given.bandwidth, "bytes per second").positive();
  line.option("--per-process", given.per_process, "PEs per process; the machine of one PE has one")
      .between(1, 4096);
  line.option("--out PREFIX", out, "write PREFIX.svg and PREFIX.csv");
  if (!line.parse(argc, argv, "")) return 0;
  given.is_strong = kind == "strong";
  given.work = work == "model" ? Work::model : Work::measured;
  // In the model all steps of the planes but the first are the same.
  given.steps = steps != 0 ? steps : given.is_strong ? 60 : given.work == Work::model ? 2 : 4;
  given.n_triangles = n_triangles != 0 ? n_triangles : given.is_strong ? 262144 : 65536;
  if (pes.empty() && given.is_strong) pes = {1, 4, 16, 64, 256};
  if (pes.empty()) pes = {1, 4, 16, 64, 256, 1500};
  if (balances.empty() && given.is_strong) balances = {"none", "greedy_refine"};
  if (balances.empty()) balances = {"none"};
  for (const std::string& balance : balances) {
    if (balance == "none") continue;
    static_cast<void>(tess::balance::make_strategy(balance, 0));  // throws
    if (given.steps <= given.period)
      tess::fail(tess::ErrorCode::bad_value, "--steps ", given.steps, ": ", balance,
                 " balances after every ", given.period,
                 " steps, so none of these is balanced; give ", given.period + 1, " or more");
  }
  for (const std::int32_t n : pes)
    if (n > 1 && n % given.per_process != 0)
      tess::fail(tess::ErrorCode::bad_value, "--per-process ", given.per_process, ": the ", n,
                 " PEs of --pes do not divide into processes of so many; give --pes as 1 or "
                 "multiples of ",
                 given.per_process, ", or another --per-process");
  given.costs = parse_costs(costs);
  if (given.work == Work::measured) line.refuse_beside("--work measured", {"--costs", "--check"});
  if (check) line.refuse_beside("--check", {"--costs"});
  if (tess::under_mpirun() && (!check || tess::processes_of_job() != 2))
    tess::fail(tess::ErrorCode::bad_argument,
               "with mpirun only --check runs, on two processes: mpirun -n 2 ... --check");
  if (!out.empty())
    for (const char* end : {".svg", ".csv"}) kit::require_writable("--out", out + end);
  bool are_close = true;
  if (given.work == Work::model) {
    if (!given.is_strong) given.voxel_size = chosen_voxel_size(given);
    if (costs.empty()) {
      const std::optional<bool> found = calibrate(given, argc, argv);
      if (!found) return 0;
      are_close = *found;
    }
    fmt::print("{} ns per message, latency {} ns, {:.1f} GB/s, --costs {}\n\n", given.message_ns,
               given.latency_ns, given.bandwidth / 1e9, text_of(given.costs));
    if (check) return 0;
  }
  fmt::print("{}", head(given.is_strong));
  std::vector<Row> rows;
  for (const std::int32_t n : pes)
    for (const std::string& balance : balances) {
      given.n_pes = n;
      given.balance = balance;
      const std::uint64_t n_all = given.n_triangles * static_cast<std::uint64_t>(n);
      given.thinned = thinned != 0 ? thinned : !given.is_strong && n_all > 128'000'000 ? 4 : 1;
      rows.push_back(run_case(given));
      fmt::print("{}", collide_scaling::line(rows.back(), rows.front()));
      std::fflush(stdout);
      fmt::print(stderr, "collide_scaling: {} PEs are done after {:.0f} s\n", n,
                 rows.back().wall_seconds);
    }
  fmt::print("\n{}\n", conclusion(rows, are_close));
  if (!out.empty()) draw(out, rows);
  // A crowd has the same pairs on every machine.
  for (const Row& row : rows)
    if (given.is_strong && row.step.n_pairs != rows.front().step.n_pairs) {
      std::fprintf(stderr, "collide_scaling: %d PEs find other pairs\n", row.given.n_pes);
      return 1;
    }
  return 0;
}

}  // namespace
}  // namespace collide_scaling

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] { return collide_scaling::study(argc, argv); });
}
