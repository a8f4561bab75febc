#include "apps/collide_scene/study/pes.hpp"

#include "apps/collide_scene/input/load.hpp"
#include "apps/collide_scene/input/motion.hpp"
#include "apps/collide_scene/run/parallel.hpp"
#include "apps/kit/ladder.hpp"
#include "apps/kit/median.hpp"
#include "runtime/balance.hpp"
#include "runtime/core/hilbert.hpp"
#include "runtime/core/number.hpp"
#include "runtime/wire/machine/simulated.hpp"
#include "runtime/wire/machine/threads.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <fmt/format.h>
#include <thread>
#include <utility>

namespace collide_scene {
namespace {

using tess::collide::SimulatedCosts;

constexpr int period = 5;  // steps between two rounds of the balancer

/// The objects along a curve through cells of some hundred objects; those of a cell by models, so
/// that the pieces of PEs are compact and have few runs of a model.
std::vector<std::uint32_t> order_in_space(const Scene& scene) {
  const std::vector<tess::collide::Aabb> boxes = boxes_of(scene);
  auto all = tess::collide::no_box<double, 3>();
  for (const auto& box : boxes) all = merged(all, box);
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, all.hi[k] - all.lo[k]);
  unsigned levels = 1;
  while ((std::size_t{256} << (2 * levels)) < boxes.size()) ++levels;
  const double per_length = longest > 0 ? static_cast<double>(1U << levels) / longest : 0;
  std::vector<std::array<std::uint64_t, 3>> places;  // cell, model, object
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    std::array<std::uint32_t, 3> cell{};
    for (std::size_t k = 0; k < 3; ++k)
      cell[k] = std::min(static_cast<std::uint32_t>((boxes[i].lo[k] - all.lo[k]) * per_length),
                         (1U << levels) - 1);
    places.push_back(
        {tess::hilbert_key(cell, 3, levels), scene.models.empty() ? 0 : scene.models[i], i});
  }
  std::ranges::sort(places);
  std::vector<std::uint32_t> order;
  for (const auto& place : places) order.push_back(static_cast<std::uint32_t>(place[2]));
  return order;
}

Scene arranged(const Scene& scene, const std::vector<std::uint32_t>& order) {
  Scene out;
  for (const std::uint32_t i : order) {
    if (scene.triangles.empty())
      out.boxes.push_back(scene.boxes[i]);
    else
      out.triangles.push_back(scene.triangles[i]);
    if (!scene.models.empty()) out.models.push_back(scene.models[i]);
  }
  return out;
}

/// A scene, and what is done with it on each machine.
struct Case {
  Scene scene;
  Motion motion;
  std::vector<std::uint32_t> order;
  std::int32_t n_steps;
  Rules rules;
  SimulatedCosts costs;
};

Case case_of(const Options& options, std::uint64_t times) {
  std::vector<std::string> inputs = options.inputs;
  if (times != 1)
    for (std::string& input : inputs) {
      const SceneKind& kind = *find_scene_kind(input);
      const std::size_t colon = input.find(':');
      const std::uint64_t n =
          colon == std::string::npos
              ? kind.default_n
              : tess::parse_number<std::uint64_t>(std::string_view(input).substr(colon + 1))
                    .value_or(0);
      input = fmt::format("{}:{}", kind.name, n * times);
    }
  Scene scene = load(inputs, options.seed);
  Motion motion(options.move, scene);
  std::vector<std::uint32_t> order = order_in_space(scene);
  const auto& cost = options.ladder.costs;
  return {std::move(scene), motion,        std::move(order),
          options.steps,    options.rules, {cost[0], cost[1], cost[2], cost[3], cost[4], cost[5]}};
}

/// Sets `seconds` to those of a step, and the row's other numbers of a run.
tess::Task run_steps(const Case& given, PesRow& row, double& seconds) {
  Scene scene = given.scene;
  Scene dealt = arranged(scene, given.order);
  ParallelCollisions collisions(dealt, given.rules, given.costs);
  co_await collisions.begin();
  const tess::collide::Collider collider = collisions.collider();
  tess::BalancerProxy balancer;
  const bool is_balanced = row.balance != "none";
  if (is_balanced) balancer = tess::start_balancing(collider.voxels, {.strategy = row.balance});
  std::vector<double> of_steps;
  for (std::int32_t step = 0; step < given.n_steps; ++step) {
    if (step > 0 && given.motion.moves()) {
      given.motion.place(step, scene);
      dealt = arranged(scene, given.order);
    }
    StepResult result;
    co_await collisions.step(step, 1, result, nullptr);
    row.answer += result.answer;
    of_steps.push_back(result.seconds);
    if (is_balanced && (step + 1) % period == 0) {
      const tess::Time begin = tess::now();
      co_await balancer.round();
      row.balancing += tess::seconds(tess::now() - begin) / given.n_steps;
      co_await tess::epoch([&] { collider.retire(); });
    }
  }
  for (const tess::balance::Round& round : balancer.history()) row.n_moved += round.n_moved;
  if (of_steps.size() > 1) of_steps.erase(of_steps.begin());
  seconds = kit::median(std::move(of_steps)) + row.balancing;
}

double run_on(std::unique_ptr<tess::Machine> machine, const Case& given, PesRow& row) {
  tess::Setup setup{std::move(machine), {}};
  double seconds = 0;
  const int code = tess::run(setup, [&] { return run_steps(given, row, seconds); });
  if (code != 0) std::exit(code);
  return seconds;
}

PesRow measure(const Case& given, const tess::SimulatedOptions& machine,
               const std::string& balance) {
  PesRow row{.n_pes = machine.n_pes, .balance = balance, .n_objects = given.scene.n_objects()};
  row.predicted = run_on(tess::make_simulated_machine(machine), given, row);
  if (machine.n_pes > static_cast<std::int32_t>(std::thread::hardware_concurrency())) return row;
  PesRow again = row;
  again.balancing = 0;
  again.answer = {};
  row.measured = run_on(tess::make_threads_machine(machine.n_pes), given, again);
  row.agrees = again.answer.has_pairs_of(row.answer);
  return row;
}

tess::SimulatedOptions machine_of(const Ladder& ladder, std::int32_t n_pes) {
  tess::SimulatedOptions machine = kit::machine_of(ladder.network, n_pes);
  machine.watches_cost = false;  // the work of this program is left out
  return machine;
}

using kit::Json, kit::of;

constexpr kit::Column<PesRow> pes_columns[] = {
    {"pes", "PEs", "6", of<&PesRow::n_pes>},
    {"balance", "balance", "<14", of<&PesRow::balance>},
    {"objects", "objects", "10", of<&PesRow::n_objects>},
    {"predicted_seconds", "predicted s", "12.6f", of<&PesRow::predicted>},
    {"balancing_seconds", "balancing", "10.6f", of<&PesRow::balancing>},
    {"moved", "moved", "8", of<&PesRow::n_moved>},
    {"speedup", "speed-up", "8.2f", of<&PesRow::speed_up>},
    {"efficiency", "efficiency", "10.3f", of<&PesRow::efficiency>},
    {"seconds", "measured s", "12.6f", of<&PesRow::measured>},
    {"pairs", "pairs", "12", [](const PesRow& r) -> Json { return r.answer.n_pairs; }},
    {"result_hash", "result", "16",
     [](const PesRow& r) -> Json { return kit::hex(r.answer.hash); }},
    {"", "", "<", [](const PesRow& r) -> Json { return r.agrees ? "" : "OTHER PAIRS"; }}};

}  // namespace

void check_ladder(const Options& options) {
  using tess::fail, tess::ErrorCode;
  const Ladder& ladder = options.ladder;
  for (const std::string& input : options.inputs)
    if (ladder.is_weak && find_scene_kind(input) == nullptr)
      fail(ErrorCode::bad_argument, "--weak: ", input,
           " is no scene made by rule; give scenes such as planes:65536, or leave it out");
  for (const std::int32_t n : ladder.pes) (void)machine_of(ladder, n);
  for (const std::string& balance : ladder.balance) {
    if (balance == "none") continue;
    (void)tess::parse_balance(balance);
    if (options.steps <= period)
      fail(ErrorCode::bad_value, "--steps ", options.steps, ": ", balance, " balances after every ",
           period, " steps, so none of these is balanced; give ", period + 1, " or more");
  }
}

std::vector<PesRow> study_pes(const Options& options, kit::Progress& progress,
                              const std::function<void(const PesRow&)>& found) {
  const Ladder& ladder = options.ladder;
  std::vector<PesRow> rows;
  for (const std::int32_t n : ladder.pes) {
    const Case given = case_of(options, ladder.is_weak ? static_cast<std::uint64_t>(n) : 1);
    for (const std::string& balance : ladder.balance) {
      progress.part(rows.size() + 1, ladder.pes.size() * ladder.balance.size());
      progress.phase("study: PEs");
      PesRow row = measure(given, machine_of(ladder, n), balance);
      const PesRow& first = rows.empty() ? row : rows.front();
      row.speed_up = first.predicted / row.predicted * static_cast<double>(row.n_objects) /
                     static_cast<double>(first.n_objects);
      row.efficiency = row.speed_up * first.n_pes / n;
      const auto same = std::ranges::find(rows, row.n_objects, &PesRow::n_objects);
      row.agrees = row.agrees && (same == rows.end() || row.answer.has_pairs_of(same->answer));
      rows.push_back(row);
      progress.clear();
      found(row);
    }
  }
  return rows;
}

const kit::Rows<PesRow>& pes_report() {
  static const kit::Rows<PesRow> rows(pes_columns);
  return rows;
}

kit::Chart chart_of(const std::vector<PesRow>& rows, bool is_weak) {
  kit::Chart chart{.title = is_weak ? "as many objects on each PE" : "a scene on more and more PEs",
                   .x_label = "PEs",
                   .y_label = is_weak ? "efficiency, %" : "ms per step",
                   .x_log = true,
                   .y_log = !is_weak};
  for (const PesRow& row : rows)
    kit::add_point(chart, row.balance, row.n_pes,
                   is_weak ? 100 * row.efficiency : 1e3 * row.predicted);
  if (is_weak)  // 0.44 s a step on 1 PE, 0.73 on 1 500 (section 4.2)
    chart.series.push_back({.name = "Lawlor and Kalé 2002, planes",
                            .points = {{1, 100}, {1500, 60.3}},
                            .style = kit::Style::published});
  return chart;
}

}  // namespace collide_scene
