// A Jacobi stencil over a two-dimensional array of blocks. A step is one coroutine: send the edges,
// await the neighbours', relax, contribute the change; the reduction's result starts the next step.
// Blocks may migrate between any two steps. The program prints the time and the distance of the
// values from the exact iterate.
#include "apps/command_line.hpp"
#include "apps/stencil/grid.hpp"
#include "runtime/monitor.hpp"
#include "runtime/runtime.hpp"

#include <fmt/core.h>

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
  Block(const Grid& grid, tess::Callback<Outcome> result)
      : grid_(grid), tile_(grid.tile(index())), result_(std::move(result)) {}

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

  void decide(double /*change*/) {
    if (++step_ < grid_.n_steps) {
      array()[index()].send<&Block::step>(step_);
    } else {
      contribute(Combine(), tile_.compare(step_), result_);
    }
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(grid_, tile_, edges_, step_, result_);
  }

 private:
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
  std::int32_t step_ = 0;
  tess::Callback<Outcome> result_;
};

tess::Task relax(Grid grid) {
  tess::Future<Outcome> result;
  const auto blocks =
      tess::create<Block>(tess::range(grid.n_blocks, grid.n_blocks), grid, result.callback());
  const tess::Time begin = tess::now();
  blocks.broadcast<&Block::step>(0);
  const Outcome outcome = co_await result;
  const double seconds = tess::seconds(tess::now() - begin);
  tess::print(fmt::format(
      "{0} x {0} points, {1} x {1} blocks, {2} steps: {3:.6f} s, {4:.3f} us per block and step\n"
      "from the exact iterate {5:.3e}, from the solution {6:.3e}, hash {7:016x}\n",
      grid.problem.size, grid.n_blocks, grid.n_steps, seconds,
      seconds * 1e6 / grid.n_steps / grid.n_blocks / grid.n_blocks, outcome.from_iterate,
      outcome.from_solution, outcome.hash));
  TESS_CHECK(outcome.from_iterate < 1e-12, "the values are ", outcome.from_iterate,
             " away from the Jacobi iterate");
}

}  // namespace
}  // namespace stencil

int main(int argc, char** argv) {
  return tess::guarded(argc, argv, [&](tess::Setup& setup) {
    stencil::Grid grid{{64}, 4, 10'000};
    apps::CommandLine line("A two-dimensional Jacobi stencil on chares.");
    line.option("--blocks", grid.n_blocks, "blocks on each axis").between(1, 4096);
    line.option("--size", grid.problem.size, "grid points on each axis").between(1, 65536);
    line.option("--steps", grid.n_steps, "Jacobi steps").between(1, 1'000'000'000);
    if (!line.parse(argc, argv)) return 0;
    if (grid.n_blocks > grid.problem.size)
      tess::fail(tess::ErrorCode::bad_argument, "--blocks: ", grid.n_blocks,
                 " blocks on an axis of ", grid.problem.size,
                 " points: give at most one per point");
    return tess::run(setup, [&] { return stencil::relax(grid); });
  });
}
