#include "apps/collide_scaling/calibrate.hpp"

#include "apps/collide_scaling/pieces.hpp"
#include "apps/kit/median.hpp"
#include "collide/parallel/voxel_home.hpp"
#include "runtime/machine/mpi.hpp"
#include "runtime/machine/threads.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>

namespace collide_scaling {
namespace {

using namespace tess::collide;

/// The case that real PEs run to be compared with a prediction.
Case as_measured(const Case& given, std::int32_t n_pes, std::int32_t per_process) {
  Case out = given;
  out.n_pes = n_pes;
  out.per_process = per_process;
  out.thinned = 1;
  out.steps = 12;
  out.balance = "none";
  return out;
}

std::vector<Case> scenes_of(const Case& one, double size) {
  std::vector<Case> scenes(5, one);
  scenes[1].two_owners = true;
  constexpr std::array factors{0.6, 1.4, 2.0};
  const std::array gaps{0.6, 2.0, 10 + 2 * size};  // each plane is 8 high
  for (std::size_t i = 0; i < gaps.size(); ++i)
    if (one.is_strong)
      scenes[2 + i].voxel_size = factors[i] * size;
    else
      scenes[2 + i].gap = gaps[i];
  return scenes;
}

/// Returns seconds per step on real PEs. The cases take turns, so that a machine that becomes slower
/// does so for all of them.
std::vector<double> measured(const std::vector<Case>& cases) {
  std::vector<std::vector<double>> seconds(cases.size());
  for (int turn = 0; turn < 5; ++turn)
    for (std::size_t i = 0; i < cases.size(); ++i)
      seconds[i].push_back(
          run_case(cases[i], tess::make_threads_machine(cases[i].n_pes)).step.seconds);
  std::vector<double> medians(cases.size());
  std::ranges::transform(seconds, medians.begin(), kit::median);
  return medians;
}

double predicted(Case given, const SimulatedCosts& costs) {
  given.costs = costs;
  return run_case(given).step.seconds;
}

/// Counts the items of a part: the step is longer by a nanosecond per item if each costs that much.
MeasuredStep counted(const Case& scene, double seconds) {
  const double of_messages = 1e9 * predicted(scene, {});
  MeasuredStep step{.nanoseconds = std::max(1.0, 1e9 * seconds - of_messages)};
  for (std::size_t k = 0; k < n_fitted; ++k) {
    SimulatedCosts one_each;
    one_each.*parts[k].cost = 1;
    step.n_items[k] = std::round(1e9 * predicted(scene, one_each) - of_messages);
  }
  return step;
}

template <class Run>
double nanoseconds_each(std::size_t n, const Run& run) {
  constexpr int n_runs = 20;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < n_runs; ++i) run();
  const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - begin;
  return time.count() / n_runs / static_cast<double>(n);
}

/// Copies the boxes of each voxel, and compares the records of two PEs that have the same voxels.
void time_alone(const Case& one, double size, SimulatedCosts& costs) {
  ObjectList objects, copies;
  for (const Body& body : one.is_strong ? bodies_of(one, 0, 0) : tile_of(one, 0))
    objects.append(Objects{owner_of(tess::PeId{0}), body.model, body.boxes}, tess::PeId{0});
  VoxelSort sort;
  sort.run(make_plan(Summary(objects, 0, 0), 1, {.voxel_size = {size, size, size}}, 1), objects);
  const std::vector<VoxelAnswer> all_are_made(sort.records().size(), VoxelAnswer{1, {}});
  std::vector<search::Entry> sorted, places;
  sort.write_sorted(all_are_made, sorted);
  costs.copy = nanoseconds_each(sorted.size(), [&] {
    copies.clear();
    places.clear();
    copies.append(objects, sorted, places);
  });
  const std::array<RecordsOf, 2> records{
      {{tess::PeId{0}, sort.records()}, {tess::PeId{1}, sort.records()}}};
  costs.record = nanoseconds_each(2 * sort.records().size(),
                                  [&] { (void)answers_to(records, WithinModel::skip); });
}

}  // namespace

double chosen_voxel_size(const Case& given) {
  return run_case(as_measured(given, 1, 1)).voxel_size;
}

std::optional<bool> calibrate(Case& given, int& argc, char**& argv) {
  const Case one = as_measured(given, 1, 1);
  Case half = one, two = as_measured(given, 2, 2);
  half.n_triangles /= 2;
  const auto of_two_processes = [&] {
    two.per_process = 1;
    two.steps = 60;  // of one run, without turns
    return run_case(two, tess::make_mpi_machine(argc, argv, {.pes_per_process = 1})).step.seconds;
  };
  if (!tess::speaks_for_job()) {  // it waits there, and leaves the cores alone
    (void)of_two_processes();
    return std::nullopt;
  }
  const double size = chosen_voxel_size(one);
  std::vector<Case> cases = scenes_of(one, size);
  const std::size_t n_scenes = cases.size();
  cases.insert(cases.end(), {one, half});
  if (!tess::under_mpirun()) cases.push_back(two);
  std::vector<double> seconds = measured(cases);
  if (tess::under_mpirun()) {
    seconds.push_back(of_two_processes());
    cases.push_back(two);
  }
  std::vector<MeasuredStep> steps;
  for (std::size_t i = 0; i < n_scenes; ++i) steps.push_back(counted(cases[i], seconds[i]));
  given.costs = fitted_costs(steps);
  time_alone(one, size, given.costs);
  for (const PartOfStep& part : parts)  // what is printed is what is charged
    given.costs.*part.cost = std::round(100 * (given.costs.*part.cost)) / 100;

  constexpr double most_off = 0.15;
  bool are_close = true;
  fmt::print(
      "| PEs | processes | triangles | predicted, ms per step | measured | ratio |\n"
      "|---|---|---|---|---|---|\n");
  for (std::size_t i = n_scenes; i < cases.size(); ++i) {
    const Case& c = cases[i];
    const double prediction = predicted(c, given.costs), ratio = prediction / seconds[i];
    are_close = are_close && std::abs(ratio - 1) <= most_off;
    fmt::print("| {} | {} | {} | {:.2f} | {:.2f} | {:.2f} |\n", c.n_pes, c.n_pes / c.per_process,
               c.n_triangles * (c.is_strong ? 1 : static_cast<std::uint64_t>(c.n_pes)),
               1e3 * prediction, 1e3 * seconds[i], ratio);
  }
  fmt::print("\n{} within {:.0f} % of what was measured.\n\n",
             are_close ? "All predictions are" : "Not all predictions are", 100 * most_off);
  return are_close;
}

}  // namespace collide_scaling
