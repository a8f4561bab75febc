#include "apps/amr/simulate.hpp"

#include "runtime/balance.hpp"

#include <algorithm>
#include <cmath>

namespace amr {
namespace {

using Blocks = tess::ArrayProxy<Block>;

/// All that a checkpoint holds beside the blocks.
struct State {
  Problem problem;
  std::int32_t change_every = 0;
  Blocks blocks{};
  std::int32_t step = 0;  // done
  Outcome outcome;        // so far
};

/// Each leaf chooses its level, and the tree changes.
tess::Task change_tree(Blocks blocks) {
  co_await tess::epoch([&] { blocks.broadcast<&Block::plan>(); });
  co_await tess::epoch([&] { blocks.broadcast<&Block::change>(); });
}

/// Counts the leaves, and compares with the field at a time.
tess::Task take_census(Blocks blocks, double time, Outcome& outcome) {
  const std::int64_t n_before = outcome.end.n_blocks;
  const Census found = co_await blocks.reduce<&Block::count>(time);
  outcome.end = found;
  outcome.n_created += found.n_new;
  outcome.n_destroyed += n_before + found.n_new - found.n_blocks;
  outcome.most_blocks = std::max(outcome.most_blocks, found.n_blocks);
}

/// Adds the rounds from `n_counted` on, of which a checkpoint saves what they moved.
void count_moves(const tess::BalancerProxy& balancer, std::size_t& n_counted, Outcome& outcome) {
  const auto& rounds = balancer.history();
  for (; n_counted < rounds.size(); ++n_counted) outcome.n_moved += rounds[n_counted].n_moved;
}

/// Uniform blocks of the least level, then as fine as the field at time 0 demands.
tess::Task plant(Blocks blocks, const Problem& problem, Outcome& outcome) {
  const std::int32_t edge = 1 << problem.least_level;
  co_await tess::epoch([&] {
    for (std::int32_t i = 0; i < edge * edge * edge; ++i) {
      const BlockIndex index =
          BlockIndex::at(problem.least_level, {i % edge, i / edge % edge, i / edge / edge});
      std::vector<Quanta> masses(static_cast<std::size_t>(problem.cells_per_block()));
      blocks[index].send_or_create_home<&Block::begin>(Birth{problem, -1, {}, std::move(masses)});
    }
  });
  for (std::int32_t level = problem.least_level;; ++level) {
    co_await tess::epoch([&] { blocks.broadcast<&Block::fill>(); });
    co_await take_census(blocks, 0, outcome);
    if (level == problem.most_level) break;
    co_await change_tree(blocks);
  }
  outcome.mass_at_start = outcome.end.norms.mass;
}

}  // namespace

double Outcome::l2() const {
  return std::sqrt(static_cast<double>(end.norms.l2) * 0x1p-60);
}

tess::Task simulate(Settings& settings, Outcome& outcome, std::function<void(std::int32_t)> part) {
  Problem& problem = settings.problem;
  State state{problem, settings.change_every, {}, 0, {}};
  const bool restarts = settings.checkpoints.restarts();
  if (restarts) {
    co_await settings.checkpoints.restart(state, problem.n_steps);
    state.problem.n_steps = problem.n_steps;
    state.problem.end = problem.n_steps * state.problem.dt;
    problem = state.problem;
  } else {
    state.blocks = tess::create<Block>(tess::sparse);
  }
  const Blocks blocks = state.blocks;
  outcome = state.outcome;
  tess::BalancerProxy balancer;
  if (settings.balance) balancer = tess::start_balancing(blocks, *settings.balance);
  if (restarts)
    co_await balancer.place_again();
  else
    co_await plant(blocks, problem, outcome);

  std::size_t n_counted = 0;
  while (state.step < problem.n_steps) {
    const tess::Time begin = tess::now();
    const std::int32_t from = state.step;
    // A checkpoint of the last step may stand between two changes.
    const std::int32_t since = from % state.change_every;
    const std::int32_t n = std::min(state.change_every - since, problem.n_steps - from);
    if (part) part(from);
    if (from > 0 && since == 0) {
      co_await change_tree(blocks);
      co_await take_census(blocks, from * problem.dt, outcome);
      co_await balancer.round();
    }
    co_await tess::epoch([&] { blocks.broadcast<&Block::advance>(from, n); });
    outcome.cell_steps += outcome.end.n_blocks * problem.cells_per_block() * n;
    outcome.seconds += tess::seconds(tess::now() - begin);
    count_moves(balancer, n_counted, outcome);
    state.step = from + n;
    state.outcome = outcome;
    co_await settings.checkpoints.save_if_due(state, from, problem.n_steps);
  }
  co_await take_census(blocks, problem.n_steps * problem.dt, outcome);
  count_moves(balancer, n_counted, outcome);
  blocks.destroy();
}

}  // namespace amr
