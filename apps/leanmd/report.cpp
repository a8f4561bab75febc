#include "apps/leanmd/report.hpp"

#include "apps/kit/rows.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace leanmd {
namespace {

std::string cells(const Options& options) {
  return fmt::format("{}", fmt::join(options.problem.box.n_cells, " x "));
}

std::size_t n_computes(const Problem& problem) {
  // The neighbourhoods of all cells are alike; a pair of two cells is in two of them.
  const auto& n = problem.box.n_cells;
  const auto n_cells = static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) *
                       static_cast<std::size_t>(n[2]);
  const auto n_partners = problem.box.cells_within(problem.cutoff + problem.skin, {}).size();
  return n_cells * (n_partners + 1) / 2;
}

std::string balancing(const tess::BalanceOptions& balance, std::int32_t every) {
  const std::string by = "computes are measured, and balanced by " + balance.strategy;
  switch (balance.when) {
    case tess::BalanceWhen::at_sync:
      return fmt::format("{} every {} steps\n", by, every);
    case tess::BalanceWhen::automatic:
      return fmt::format("{}; every {} steps a barrier, and a round if it pays off\n", by, every);
    case tess::BalanceWhen::periodic:
      return fmt::format("{} every {} ms, beside the steps\n", by,
                         std::chrono::duration<double, std::milli>(balance.period).count());
  }
  return "";
}

}  // namespace

std::string explain(const Options& options, std::int64_t n_atoms) {
  const Problem& p = options.problem;
  return fmt::format(
      "{} atoms in a periodic cube of edge {:.4g}, {} cells, {} computes; a cell is in {} of them\n"
      "{} steps of {}; all pairs closer than {}; atoms change cells every {} steps\n{}",
      n_atoms, p.box.edge, cells(options), n_computes(p),
      p.box.cells_within(p.cutoff + p.skin, {}).size(), options.n_steps, p.dt, p.cutoff,
      p.exchange_every,
      options.balance ? balancing(*options.balance, p.every)
                      : std::string("no balancer: nothing is measured, no barrier\n"));
}

std::string table(const Options& options, const Outcome& outcome) {
  const auto per_atom = [&](const Vector& energies, std::size_t k) {
    return static_cast<double>(energies[k]) * energy_quantum / static_cast<double>(outcome.n_atoms);
  };
  std::string out = fmt::format("{:>8}{:>14}{:>14}{:>14}   energies per atom\n", "step", "kinetic",
                                "potential", "total");
  const std::size_t last = outcome.energies.size() - 1;  // of a run that ended early the last good
  for (std::size_t step = 0; step <= last; step += std::max<std::size_t>(1, last / 5)) {
    const Vector& one = outcome.energies[step];
    out += fmt::format("{:>8}{:>14.6f}{:>14.6f}{:>14.6f}\n", step, per_atom(one, 0),
                       per_atom(one, 1), per_atom(one, 2));
  }
  for (const tess::balance::Round& round : outcome.rounds)
    out +=
        fmt::format("balance round {}: {} of {} computes moved, max/average {:.3f} -> {:.3f}\n",
                    round.number, round.n_moved, round.n_elements, round.before, round.predicted);
  out += fmt::format(
      "{} atoms, {} cells, {} steps: {:.6f} s, {:.3f} ms a step; energy drift {:.3e}{}; hash "
      "{:016x}\n",
      outcome.n_atoms, cells(options), last, outcome.seconds,
      1e3 * outcome.seconds / static_cast<double>(std::max<std::size_t>(1, last)), outcome.drift(),
      outcome.wrong_forces == 0 ? "; forces as of all pairs" : "", outcome.hash);
  return out;
}

kit::Json json_of(const Options& options, const Outcome& outcome) {
  const Problem& p = options.problem;
  kit::Json rounds = kit::Json::array();
  for (const tess::balance::Round& round : outcome.rounds)
    rounds.push_back({{"moved", round.n_moved},
                      {"max_over_average", round.before},
                      {"predicted", round.predicted},
                      {"phase_seconds", round.phase_seconds},
                      {"round_seconds", round.round_seconds}});
  const std::int64_t wrong = outcome.wrong_forces;
  return {{"atoms", outcome.n_atoms},
          {"cells", p.box.n_cells},
          {"steps", options.n_steps},
          {"dt", p.dt},
          {"cutoff", p.cutoff},
          {"seconds", outcome.seconds},
          {"energy", outcome.energy()},
          {"energy_drift", outcome.drift()},
          {"wrong_forces", wrong >= 0 ? kit::Json(wrong) : kit::Json()},
          {"balance_rounds", std::move(rounds)},
          {"result_hash", kit::hex(outcome.hash)}};
}

}  // namespace leanmd
