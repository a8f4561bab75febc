// A Jacobi stencil over a two-dimensional array of blocks. A step is one coroutine: send the edges,
// await the neighbours', relax, contribute the change; the reduction's result starts the next step.
// Blocks may migrate between any two steps. The program prints the time and the distance of the
// values from the exact iterate. With --checkpoint the main coroutine pauses the blocks and saves
// them; with --restart it continues from there. With --repeat it runs again from zero, as often as
// asked for, and the time is the median.
#include "apps/kit/checkpoints.hpp"
#include "apps/kit/driver.hpp"
#include "apps/kit/median.hpp"
#include "apps/kit/rows.hpp"
#include "apps/stencil/grid.hpp"
#include "runtime/more/monitor.hpp"
#include "runtime/runtime.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fmt/core.h>
#include <optional>

namespace stencil {
namespace {

struct Edge {
  std::int32_t step = 0;
  Side side{};
  std::vector<double> values;
};

class Block : public tess::Chare<Block, tess::Index2> {
 public:
  Block() = default;
  explicit Block(const Grid& grid) : grid_(grid), tile_(grid.tile(index())) {}

  /// Runs on until `until` steps are done; `paused` receives the last change.
  void run(std::int32_t until, const tess::Callback<double>& paused) {
    until_ = until;
    paused_ = paused;
    array()[index()].send<&Block::step>(step_);
  }

  tess::Task step(std::int32_t step) {
    const auto links = grid_.links(index());
    for (const auto& [side, neighbour] : links)
      array()[neighbour].send<&Block::receive>(Edge{step, opposite(side), tile_.edge(side)});
    for (std::size_t n = links.size(); n > 0; --n) {
      Edge edge = co_await edges_.take(step);
      tile_.set_halo(edge.side, edge.values);
    }
    contribute(tess::max, tile_.jacobi(), array().target<&Block::decide>());
    show();
  }
  void receive(Edge edge) { edges_.put(std::move(edge)); }

  void decide(double change) {
    if (grid_.logs_steps && index() == tess::Index2{0, 0}) log_step();
    if (++step_ < until_) {
      array()[index()].send<&Block::step>(step_);
    } else {
      contribute(tess::max, change, paused_);
    }
  }
  void compare(const tess::Callback<Outcome>& result) {
    contribute(Combine(), tile_.compare(step_), result);
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(grid_, tile_, edges_, step_, until_, paused_);
  }

 private:
  /// The time of day and the processor time of this process, in seconds.
  void log_step() const {
    const std::chrono::duration<double> now = std::chrono::system_clock::now().time_since_epoch();
    tess::print(fmt::format("step {} {:.6f} {:.6f}\n", step_, now.count(),
                            static_cast<double>(std::clock()) / CLOCKS_PER_SEC));
  }
  /// The block's part of the picture on the page of --monitor.
  void show() const {
    const std::int32_t stride = (grid_.problem.size + 255) / 256;
    const std::int32_t side = (grid_.problem.size + stride - 1) / stride;
    tess::show("temperature", [&] {
      Tile::Sampled part = tile_.sampled(stride);
      return tess::Picture{side, side, part.x, part.y, part.columns, std::move(part.values)};
    });
  }

  Grid grid_;
  Tile tile_;
  tess::Mailbox<&Edge::step> edges_;
  std::int32_t step_ = 0, until_ = 0;
  tess::Callback<double> paused_;
};

/// The state of the main coroutine, as a checkpoint saves it.
struct State {
  Grid grid;
  tess::ArrayProxy<Block> blocks;
  std::int32_t step = 0;
};

struct Options {
  Grid grid{{64}, 4, 10'000};
  std::optional<std::int32_t> repeat;  ///< runs that count, after one that warms up
  kit::Checkpoints checkpoints;
};

tess::ArrayProxy<Block> make_blocks(const Grid& grid) {
  return tess::create<Block>(tess::range(grid.n_blocks, grid.n_blocks), grid);
}

/// Goes on to the last step. Returns the elapsed seconds.
tess::TaskOf<double> run(State& state, kit::Checkpoints& checkpoints) {
  const std::int32_t last = state.grid.n_steps;
  const tess::Time begin = tess::now();
  while (state.step < last) {
    const std::int32_t from = state.step;
    state.step = checkpoints.pause_after(from, last);
    co_await state.blocks.reduce<&Block::run>(state.step);
    co_await checkpoints.save_if_due(state, from, last);
  }
  co_return tess::seconds(tess::now() - begin);
}

tess::Task relax(Options options, kit::Driver& driver) {
  driver.progress().phase("steps");
  State state;
  if (options.checkpoints.restarts()) {
    co_await options.checkpoints.restart(state, options.grid.n_steps);
    state.grid.n_steps = options.grid.n_steps;
  } else {
    state.grid = options.grid;
    state.blocks = make_blocks(state.grid);
  }
  const Grid& grid = state.grid;
  const std::int32_t first = state.step;
  double seconds = co_await run(state, options.checkpoints);
  std::vector<double> times;
  for (std::int32_t left = options.repeat.value_or(0); left > 0; --left) {
    co_await tess::epoch([&] { state.blocks.destroy(); });
    state.blocks = make_blocks(grid);
    state.step = 0;
    seconds = co_await run(state, options.checkpoints);
    times.push_back(seconds);
  }
  if (!times.empty()) seconds = kit::median(times);
  const Outcome outcome = co_await state.blocks.reduce<&Block::compare>();
  driver.progress().clear();
  const auto per_step = [&](double time) {
    return time * 1e6 / std::max(1, grid.n_steps - first) / grid.n_blocks / grid.n_blocks;
  };
  tess::print(fmt::format(
      "{0} x {0} points, {1} x {1} blocks, {2} steps: {3:.6f} s, {4:.3f} us per block and step\n"
      "from the exact iterate {5:.3e}, from the solution {6:.3e}, hash {7:016x}\n",
      grid.problem.size, grid.n_blocks, grid.n_steps, seconds, per_step(seconds),
      outcome.from_iterate, outcome.from_solution, outcome.hash));
  TESS_CHECK(outcome.from_iterate <= grid.problem.rounding(grid.n_steps), "the values are ",
             outcome.from_iterate, " away from the Jacobi iterate");
  if (!times.empty()) {
    const auto [least, greatest] = std::minmax_element(times.begin(), times.end());
    tess::print(fmt::format(
        "the time is the median of {} runs, after one that warms up; {:.3f} to {:.3f} us\n",
        times.size(), per_step(*least), per_step(*greatest)));
  }
  driver.write(std::array{kit::Json{{"size", grid.problem.size},
                                    {"blocks", grid.n_blocks},
                                    {"steps", grid.n_steps},
                                    {"from_iterate", kit::rounded(outcome.from_iterate)},
                                    {"result_hash", kit::hex(outcome.hash)}}});
}

}  // namespace
}  // namespace stencil

int main(int argc, char** argv) {
  return tess::guarded(argc, argv, [&](tess::Setup& setup) {
    stencil::Options options;
    stencil::Grid& grid = options.grid;
    kit::Driver driver(setup, "A two-dimensional Jacobi stencil on chares.");
    driver.option("--blocks", grid.n_blocks, "blocks on each axis").between(1, 4096);
    driver.option("--size", grid.problem.size, "grid points on each axis").between(1, 65536);
    driver.option("--steps", grid.n_steps, "Jacobi steps").between(1, 1'000'000'000);
    driver.flag("--log-steps", grid.logs_steps,
                "print the time of day and the processor time of a process at each step");
    driver
        .option("--repeat", options.repeat,
                "runs that count, after one that warms up; the time is their median (default: one "
                "run, without a warm-up)")
        .between(1, 1000);
    driver.json();
    options.checkpoints.add_options(driver);
    if (!driver.parse(argc, argv)) return 0;
    // Each repeated run starts from zero, and the steps of all would be in one log.
    for (const char* option : {"--checkpoint", "--restart", "--log-steps"})
      driver.refuse_both(option, "--repeat");
    options.checkpoints.check(driver.line(), {"--blocks", "--size", "--log-steps"});
    // A restart takes what is not given from the checkpoint.
    if (!options.checkpoints.restarts() && grid.n_blocks > grid.problem.size)
      tess::fail(tess::ErrorCode::bad_argument, "--blocks: ", grid.n_blocks,
                 " blocks on an axis of ", grid.problem.size,
                 " points: give at most one per point");
    return tess::run(setup, [&] { return stencil::relax(options, driver); });
  });
}
