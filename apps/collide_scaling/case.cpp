#include "apps/collide_scaling/case.hpp"

#include "apps/collide_scaling/pieces.hpp"
#include "apps/kit/median.hpp"
#include "collide/collider.hpp"
#include "runtime/balance.hpp"
#include "runtime/machine/simulated.hpp"
#include "runtime/runtime.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace collide_scaling {
namespace {

using namespace tess::collide;

/// Times of a PE in a step, since the start of the run; then of all PEs.
struct Times {
  std::int64_t first = 0, last = 0;
  std::uint64_t n_pairs = 0;
};
struct JoinTimes {
  Times operator()(const Times& a, const Times& b) const {
    return {std::max(a.first, b.first), std::max(a.last, b.last), a.n_pairs + b.n_pairs};
  }
};

/// The client of a PE, and its stop watch.
class Client : public tess::Group<Client> {
 public:
  explicit Client(const Case& given) : given_(given) {}

  void submit(const Collider& collider, std::int32_t step) {
    times_ = {};
    const std::int32_t me = tess::my_pe().value;
    for (const Body& body : given_.is_strong ? bodies_of(given_, me, step) : tile_of(given_, me)) {
      const bool is_second = given_.two_owners && static_cast<std::uint32_t>(body.model) % 2 == 1;
      const tess::PeId owner{is_second ? me + tess::n_pes() : me};
      collider.submit(Objects{owner_of(owner), body.model, body.boxes});
    }
  }
  void receive(const Hits& hits) { n_received_ += hits.pairs.size(); }
  /// A voxel on this PE has found pairs.
  void found(std::size_t n_pairs) {
    times_.last = tess::now().count();
    if (times_.n_pairs == 0) times_.first = times_.last;
    times_.n_pairs += n_pairs;
  }
  void gather(tess::Callback<Times> target) { contribute(JoinTimes{}, times_, std::move(target)); }

 private:
  const Case given_;
  Times times_;
  std::uint64_t n_received_ = 0;
};

/// Runs on the PE of the voxel, once per owner of the pairs. Both receive them; one counts them.
void charge_and_send(const tess::Callback<Hits>& callback, Hits&& hits) {
  const tess::GroupProxy<Client> clients(tess::from_bytes<tess::CollectionId>(callback.where()));
  if (hits.owner <= hits.other) clients.local().found(hits.pairs.size());
  const tess::PeId owner{index_of(hits.owner).x % tess::n_pes()};
  clients[owner].send<&Client::receive>(std::move(hits));
}
const tess::Callback<Hits>::Kind charged_owner{tess::naming::name_of<&charge_and_send>(),
                                               &charge_and_send};

tess::Task run_steps(const Case& given, Row& row) {
  Collider collider;
  tess::GroupProxy<Client> clients;
  const double size = given.voxel_size / std::sqrt(given.thinned);
  SimulatedCosts costs;
  for (const PartOfStep& part : parts) costs.*part.cost = given.thinned * (given.costs.*part.cost);
  co_await tess::epoch([&] {
    collider = make_collider({.voxel_size = {size, size, size},
                              .rules = {.within_model = tess::collide::WithinModel::skip},
                              .simulated_costs = costs});
    clients = tess::create_group<Client>(given);
  });
  tess::BalancerProxy balancer;
  const bool is_balanced = given.balance != "none";
  if (is_balanced) balancer = tess::start_balancing(collider.voxels, {.strategy = given.balance});
  const Report report{tess::Callback<Hits>(charged_owner, tess::to_bytes(clients.id())), {}};
  std::vector<StepTimes> steps;
  for (std::int32_t step = 0; step < given.steps; ++step) {
    co_await tess::epoch([&] { clients.broadcast<&Client::submit>(collider, step); });
    const std::int64_t begin = tess::now().count();
    co_await collider.run(report);
    const std::int64_t end = tess::now().count();
    const Times times = co_await clients.reduce<&Client::gather>();
    const auto since = [&](std::int64_t t) { return 1e-9 * static_cast<double>(t - begin); };
    steps.push_back({since(end), since(times.first), since(times.last), times.n_pairs});
    if (is_balanced && (step + 1) % given.period == 0) {
      co_await balancer.round();
      co_await tess::epoch([&] { collider.retire(); });
    }
  }
  const CollisionStatistics statistics = co_await collider.statistics();
  row.voxel_size = statistics.grid.voxel_size;
  if (is_balanced)
    for (const tess::balance::Round& round : balancer.history()) {
      row.n_moves += round.n_moved;
      row.balance_seconds += round.round_seconds / given.steps;
    }
  if (steps.size() > 1) steps.erase(steps.begin());
  const auto median_of = [&](double StepTimes::*member) {
    std::vector<double> values;
    for (const StepTimes& step : steps) values.push_back(step.*member);
    return kit::median(std::move(values));
  };
  row.step = {median_of(&StepTimes::seconds), median_of(&StepTimes::first_hits),
              median_of(&StepTimes::last_hits), steps.back().n_pairs};
}

}  // namespace

Row run_case(const Case& given) {
  tess::SimulatedOptions options;
  options.n_pes = given.n_pes;
  options.pes_per_process = given.n_pes == 1 ? 1 : given.per_process;
  options.latency = tess::Time(given.latency_ns);
  options.bandwidth = given.bandwidth / given.thinned;
  if (given.work == Work::model) options.cost = tess::Time(given.message_ns);
  return run_case(given, tess::make_simulated_machine(options));
}

Row run_case(const Case& given, std::unique_ptr<tess::Machine> machine) {
  Row row;
  row.given = given;
  // The PEs of a process share the crowd that the first call makes.
  if (given.is_strong) (void)bodies_of(given, 0, 0);
  tess::Setup setup{std::move(machine), {}};
  const auto begin = std::chrono::steady_clock::now();
  const int code = tess::run(setup, [&] { return run_steps(given, row); });
  if (code != 0) std::exit(code);
  row.wall_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return row;
}

}  // namespace collide_scaling
