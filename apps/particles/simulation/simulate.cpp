#include "apps/particles/simulation/simulate.hpp"

#include "apps/particles/simulation/block.hpp"
#include "runtime/balance.hpp"
#include "runtime/base/usable_memory.hpp"

#include <algorithm>
#include <cmath>

namespace particles {
namespace {

/// The next multiple of `every` after `step`; `last` where there is none before.
std::int32_t next_after(std::int32_t step, std::int32_t every, std::int32_t last) {
  if (every <= 0) return last;
  return static_cast<std::int32_t>(
      std::min<std::int64_t>((std::int64_t{step} / every + 1) * every, last));
}

/// The measures that the scene asks for after `step` steps.
std::uint32_t asked(const Scene& scene, std::int32_t step) {
  const Outputs& outputs = scene.outputs;
  const bool at_end = step == 0 || step == scene.steps;
  std::uint32_t ask = Stretch::nothing;
  if (at_end || (outputs.statistics > 0 && step % outputs.statistics == 0)) ask |= Stretch::measure;
  if (traces(scene, step)) ask |= Stretch::trace;
  if (step == scene.steps && n_audited(scene) < scene.n_particles()) ask |= Stretch::judge;
  return ask;
}

/// The edge of the blocks: as the scene gives it, or chosen.
double block_edge(const Scene& scene) {
  constexpr double particles_a_block = 2000, most_an_axis = 8;
  if (scene.block > 0) return scene.block;
  const tess::dn::Vec3 size = Source(scene).bounds().size();
  const double longest = std::max({size.x, size.y, size.z});
  const double an_axis = std::cbrt(static_cast<double>(scene.n_particles()) / particles_a_block);
  return longest > 0 ? longest / std::clamp(an_axis, 1.0, most_an_axis) : 1;
}

/// The display of the run's progress, if there is one.
struct Shown {
  kit::Progress* progress = nullptr;
  void phase(const char* name) const {
    if (progress != nullptr) progress->phase(name);
  }
  void part(int part, int n_parts) const {
    if (progress != nullptr) progress->part(part, n_parts);
  }
};

tess::Task build_fields(const Stage& stage, tess::GroupProxy<Station> stations, Shown shown) {
  shown.phase("building fields");
  co_await tess::epoch([&] { stations.broadcast<&Station::begin_fields>(); });
  int n_stages = 0;  // the same in all processes
  for (const FieldInTheMaking& field : stage.fields)
    n_stages = std::max(n_stages, field.n_stages());
  for (std::int32_t filled = 0; filled < n_stages; ++filled) {
    shown.part(filled + 1, n_stages);
    co_await tess::epoch([&] { stations.broadcast<&Station::fill_fields>(filled); });
  }
  shown.part(0, 0);
  co_await tess::epoch([&] { stations.broadcast<&Station::finish_fields>(); });
}

void add_sizes(const Stage& stage, RunResult& result) {
  for (const FieldInTheMaking& field : stage.fields) {
    result.fields.cells += field.field().grid.size();
    result.fields.bytes += field.flat_bytes();
    if (field.field().planes != nullptr) result.fields.bytes_used += field.field().bytes();
  }
}

}  // namespace

bool traces(const Scene& scene, std::int32_t step) {
  const std::int32_t every = scene.outputs.trajectories;
  if (every <= 0 || step < 0 || step > scene.steps) return false;
  return step % every == 0 || step == scene.steps;
}

void check_memory(const Scene& scene, int n_processes) {
  constexpr double bytes_per_particle = 6 * sizeof(double) + sizeof(std::uint64_t) + 1;
  const auto n = static_cast<double>(scene.n_particles());
  double needed = bytes_per_particle * n / n_processes;
  if (builds_fields(scene))
    for (const SceneObject& object : scene.objects)
      needed += tess::dn::building_bytes_per_voxel({.method = object.method}) *
                static_cast<double>(object.grid.size());
  if (const double usable = tess::detail::usable_memory(); needed > usable)
    tess::fail(tess::ErrorCode::environment, scene.name, ": the fields and ", scene.n_particles(),
               " particles make the run ", needed / 1e9, " GB large, and this process may have ",
               usable / 1e9, " GB; ask for fewer particles, or a lower resolution");
}

tess::Task simulate(std::shared_ptr<Stage> stage, RunResult& result, RunOptions options) {
  const Scene& scene = stage->scene;
  const StageHandle handle{stage};
  const auto stations = tess::create<Station>(tess::each_pe);
  const auto blocks = tess::create<Block>(tess::sparse);
  const Shown shown{options.progress};
  const auto hand_out = [&] {
    const tess::Machine& machine = tess::machine();
    for (std::int32_t process = 0; process < machine.n_processes(); ++process)
      stations[machine.first_pe(tess::ProcessId{process})].send<&Station::take>(handle);
  };
  co_await tess::epoch(hand_out);
  co_await build_fields(*stage, stations, shown);
  result.block = block_edge(scene);
  constexpr int usual_exchange = 8;
  result.exchange = scene.exchange > 0 ? scene.exchange : usual_exchange;
  result.audited = stage->n_audited;
  co_await tess::epoch([&] { stations.broadcast<&Station::prepare>(result.block); });
  shown.phase("placing particles");
  co_await tess::epoch([&] { stations.broadcast<&Station::emit>(blocks); });

  tess::BalancerProxy balancer;
  if (options.balance) {
    co_await tess::epoch([&] { balancer = tess::start_balancing(blocks, *options.balance); });
    co_await balancer.begin_phase();
  }
  const bool rounds_between =
      options.balance && options.balance->when != tess::BalanceWhen::periodic;

  Stretch stretch;
  const auto move = [&] { blocks.broadcast<&Block::move>(stretch); };
  std::int32_t step = 0;
  shown.phase("steps");
  while (true) {
    shown.part(step, scene.steps);
    stretch.first = step;
    stretch.n_steps = 0;
    stretch.ask = asked(scene, step);
    if (stretch.ask != Stretch::nothing) co_await tess::epoch(move);
    if ((stretch.ask & Stretch::measure) != 0) {
      const Measured measured = co_await stations.reduce<&Station::give_measured>();
      result.rows.push_back({step, step * scene.dt, measured});
    }
    if ((stretch.ask & Stretch::trace) != 0) {
      std::vector<Sample> all = co_await stations.reduce<&Station::give_samples>();
      std::ranges::sort(all, {}, &Sample::id);
      result.trajectories.push_back({step, std::move(all)});
    }
    if (step == scene.steps) break;
    const Outputs& outputs = scene.outputs;
    const std::int32_t to = std::min({next_after(step, result.exchange, scene.steps),
                                      next_after(step, outputs.statistics, scene.steps),
                                      next_after(step, outputs.trajectories, scene.steps)});
    stretch.n_steps = to - step;
    stretch.ask = Stretch::nothing;
    const tess::Time begin = tess::now();
    co_await tess::epoch(move);
    if (rounds_between) co_await balancer.round();
    result.seconds += tess::seconds(tess::now() - begin);
    step = to;
  }
  if (options.balance) result.rounds = balancer.history();
  for (const Spent& of_pe : co_await stations.reduce<&Station::give_spent>()) {
    result.loop_seconds += of_pe.rules, result.audit_seconds += of_pe.audit;
    result.fields.build_seconds = std::max(result.fields.build_seconds, of_pe.build);
  }
  add_sizes(*stage, result);
}

}  // namespace particles
