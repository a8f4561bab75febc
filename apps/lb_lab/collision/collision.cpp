#include "apps/lb_lab/collision/collision.hpp"

#include "apps/lb_lab/collision/owner.hpp"
#include "apps/lb_lab/run/balanced.hpp"
#include "apps/lb_lab/run/stepped.hpp"
#include "collide/collide_serial.hpp"
#include "collide/voxel_size.hpp"

#include <fmt/format.h>

namespace lb_lab {
namespace {

constexpr std::int32_t owners_a_pe = 4;

class Collision final : public Stepped {
 public:
  Collision(const Experiment& experiment, tess::GroupProxy<Station> stations, Outcome& outcome)
      : experiment_(experiment), stations_(stations), outcome_(outcome) {}

  tess::BalancerProxy create() override {
    const Domain& domain = experiment_.plan.problem.domain;
    const double columns = domain.columns, rows = domain.rows;
    // Two deep: all boxes are in one layer.
    collider_ = tess::collide::make_collider(
        {.size = {domain.width / columns, domain.height / rows, 2}, .rules = pair_rules});
    const std::int32_t n = owners_a_pe * tess::n_pes();
    owners_ = tess::create<Owner>(tess::range(n), stations_, n);
    return balances(experiment_) ? start_balancing(collider_.voxels, experiment_, outcome_)
                                 : tess::BalancerProxy();
  }
  tess::Task begin() override { co_return; }
  tess::Task step(std::int32_t iteration) override {
    co_await tess::epoch([&] { owners_.broadcast<&Owner::submit>(collider_, iteration); });
    const tess::collide::Report report = report_to(owners_, stations_);
    co_await tess::collide::run_collision(collider_, report);
  }
  tess::Task end() override {
    co_await tess::epoch([this] { owners_.broadcast<&Owner::end>(); });
    // Nothing is submitted: every voxel is empty, and ends.
    const tess::collide::Report none;
    co_await tess::collide::run_collision(collider_, none);
  }

 private:
  const Experiment& experiment_;
  const tess::GroupProxy<Station> stations_;
  Outcome& outcome_;
  tess::collide::Collider collider_;
  tess::ArrayProxy<Owner> owners_;
};

tess::Task run_collision(const Experiment& experiment, tess::GroupProxy<Station> stations,
                         Outcome& outcome) {
  Collision workload(experiment, stations, outcome);
  co_await run_stepped(experiment, stations, workload, outcome);
}

/// The serial collider, on a grid of its own.
std::uint64_t serial_answer_of_collision(const Problem& p) {
  const Clusters clusters(p);
  std::uint64_t answer = 0;
  for (std::int32_t t = 0; t < p.n_iterations; ++t) {
    const std::vector<tess::collide::Item> items = clusters.items(0, clusters.n_objects(), {}, t);
    const tess::collide::VoxelGrid grid(tess::collide::suggested_voxel_size(items));
    const auto found = [&](const tess::collide::Item& a, const tess::collide::Item& b) {
      answer += answer_of_pair(a.id.local, b.id.local, t);
    };
    tess::collide::collide_serial(items, grid, pair_rules, found);
  }
  return answer;
}

std::string describe_collision(const Problem& p) {
  return fmt::format(
      "{} boxes in clusters that drift over {} x {} cells, {} owners per PE; voxels are made on "
      "demand, and end when no box touches them; slower PEs do extra work instead",
      Clusters(p).n_objects(), p.domain.width, p.domain.height, owners_a_pe);
}

}  // namespace

const Kind collision_kind{&serial_answer_of_collision, &nominal_seconds, &describe_collision,
                          &run_collision};

}  // namespace lb_lab
