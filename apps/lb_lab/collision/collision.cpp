// The kind of workload in which the chares are the voxels of a collision. They are made on demand
// where clusters of boxes drift, and end when the boxes have passed. A cut of the plane is the grid
// of voxels, and its number of chares per PE an upper bound: voxels without boxes do not exist.
#include "apps/lb_lab/collision/owner.hpp"
#include "apps/lb_lab/run/kind.hpp"
#include "apps/lb_lab/run/stepped.hpp"
#include "collide/pairs.hpp"

#include <fmt/format.h>

namespace lb_lab {
namespace {

constexpr std::int32_t owners_a_pe = 4;

class Collision final : public Stepped {
 public:
  using Stepped::Stepped;

  tess::BalancerProxy create() override {
    const Domain& domain = experiment_.plan.problem.domain;
    const double columns = domain.columns, rows = domain.rows;
    // Two deep: all boxes are in one layer.
    collider_ = tess::collide::make_collider(
        {.voxel_size = {domain.width / columns, domain.height / rows, 2}, .rules = pair_rules});
    const std::int32_t n = owners_a_pe * tess::n_pes();
    owners_ = tess::create<Owner>(tess::range(n), stations_, n);
    return balances(experiment_) ? start_balancing(collider_.voxels, experiment_, outcome_)
                                 : tess::BalancerProxy();
  }
  tess::Task begin() override { co_return; }
  tess::Task step(std::int32_t iteration) override {
    co_await tess::epoch([&] { owners_.broadcast<&Owner::submit>(collider_, iteration); });
    const tess::collide::HitReceivers to = report_to(owners_, stations_);
    co_await collider_.run(to);
  }
  tess::Task end() override {
    co_await tess::epoch([this] { owners_.broadcast<&Owner::end>(); });
    // Idle for two calls: every voxel ends.
    for (int i = 0; i < 2; ++i) co_await tess::epoch([this] { collider_.retire(); });
  }

 private:
  tess::collide::Collider collider_;
  tess::ArrayProxy<Owner> owners_;
};

/// The serial collider, on a grid of its own.
std::uint64_t serial_answer_of_collision(const Problem& p) {
  const Clusters clusters(p);
  std::uint64_t answer = 0;
  for (std::int32_t t = 0; t < p.n_iterations; ++t) {
    const std::vector<tess::collide::Item> items = clusters.items(0, clusters.n_objects(), {}, t);
    std::vector<tess::collide::Aabb> boxes;
    boxes.reserve(items.size());
    for (const tess::collide::Item& item : items) boxes.push_back(item.box);
    tess::collide::for_each_pair(
        std::span<const tess::collide::Aabb>(boxes), {}, [&](std::uint32_t a, std::uint32_t b) {
          answer += answer_of_pair(items[a].id.local, items[b].id.local, t);
        });
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

const Kind collision_kind{Speeds::relative, &serial_answer_of_collision, &nominal_seconds,
                          &describe_collision, &run_stepped<Collision>};

}  // namespace lb_lab
