#include "apps/leanmd/study.hpp"

#include <cmath>

namespace leanmd {

tess::Task study(Options options, InitialState state, std::vector<Row>& rows) {
  const double dt = options.problem.dt;
  const double time = dt * options.n_steps;
  for (const double factor : {2.0, 1.0, 0.5, 0.25, 0.125}) {
    options.problem.dt = dt * factor;
    options.n_steps = static_cast<std::int32_t>(std::lround(time / options.problem.dt));
    const Motion motion(options.problem.box.edge, options.problem.dt);
    Row row{options, {}};
    co_await simulate(row.options, initial_atoms(state, motion), row.outcome);
    if (!rows.empty() && rows.back().outcome.error.empty() && row.outcome.error.empty())
      row.order = kit::order_between({rows.back().options.problem.dt, rows.back().outcome.drift()},
                                     {row.options.problem.dt, row.outcome.drift()});
    rows.push_back(std::move(row));
  }
}

}  // namespace leanmd
