#include "collide/collider.hpp"

#include "collide/parallel/manager.hpp"
#include "collide/parallel/neighbours.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

namespace tess::collide {

Collider make_collider(const ColliderOptions& options) {
  if (options.voxel_size != Point{0, 0, 0})
    static_cast<void>(VoxelGrid(options.origin, options.voxel_size));  // throws
  if (!(options.piece_length >= 0))
    fail(ErrorCode::bad_argument, "make_collider() with pieces of length ", options.piece_length,
         ": give a positive length, infinity for whole objects, or 0 to have it chosen");
  if (!(options.slack >= 0) || std::isinf(options.slack))
    fail(ErrorCode::bad_argument, "make_collider() with a slack of ", options.slack,
         ": give a positive length, or 0 to search in each collision");
  const auto voxels = create<Voxel>(sparse);
  Collider collider{voxels, create<Manager>(each_pe, voxels), options};
  if (options.slack > 0)
    collider.neighbours =
        create<Neighbours>(each_pe, collider.managers, options.rules, options.slack);
  return collider;
}

namespace {

constexpr auto is_good = [](const Aabb& box) { return is_valid(box); };

}  // namespace

std::size_t Collider::submit(const Objects& objects) const {
  const std::span<const Aabb> boxes = objects.boxes;
  const auto first = static_cast<std::uint64_t>(objects.first);
  // Numbers of more than 32 bits are refused below.
  if (options.invalid_boxes == InvalidBoxes::leave_out && first + boxes.size() <= 1ULL << 32 &&
      !std::ranges::all_of(boxes, is_good)) {
    std::vector<Item> items;
    for (std::uint64_t local = first; const Aabb& box : boxes)
      items.push_back({box, {objects.owner, static_cast<LocalId>(local++), objects.model}});
    return submit(items, objects.capsules);
  }
  if (options.slack > 0)
    neighbours.local().submit(objects);
  else
    managers.local().submit(objects);
  return 0;
}

std::size_t Collider::submit(const std::vector<Item>& items,
                             std::span<const Capsule> capsules) const {
  if (options.invalid_boxes == InvalidBoxes::leave_out &&
      (capsules.empty() || capsules.size() == items.size()) &&
      !std::ranges::all_of(items, is_good, &Item::box)) {
    std::vector<Item> rest;
    std::vector<Capsule> of_rest;
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (!is_valid(items[i].box)) continue;
      rest.push_back(items[i]);
      if (i < capsules.size()) of_rest.push_back(capsules[i]);
    }
    submit(rest, of_rest);
    return items.size() - rest.size();
  }
  if (options.slack > 0)
    neighbours.local().submit(items, capsules);
  else
    managers.local().submit(items, capsules);
  return 0;
}

namespace {

template <class G>
void submit_early_to(const GroupProxy<G>& group, Submission&& objects) {
  if (G* member = group.local_or_null())
    member->receive(objects);
  else
    group[my_pe()].template send<&G::receive>(std::move(objects));
}

void check_not_destroyed_early(bool is_right) {
  TESS_CHECK(is_right,
             "a collider is destroyed while a collision of it runs: co_await its run() first");
}

Manager& remaining(const Collider& collider) {
  Manager* const manager = collider.managers.local_or_null();
  check_not_destroyed_early(manager != nullptr);
  return *manager;
}

std::size_t n_sampled(const Collider& collider) {
  return n_sampled_per_pe(collider.options.voxel_size, n_pes());
}

}  // namespace

void Collider::submit_early(Submission objects) const {
  if (options.slack > 0)
    submit_early_to(neighbours, std::move(objects));
  else
    submit_early_to(managers, std::move(objects));
}

void Collider::destroy() const {
  const Manager* const manager = managers.local_or_null();
  check_not_destroyed_early(manager == nullptr || !manager->is_colliding());
  if (options.slack > 0) {
    const Neighbours* const kept = neighbours.local_or_null();
    check_not_destroyed_early(kept == nullptr || !kept->is_colliding());
    neighbours.destroy();
  }
  voxels.destroy();
  managers.destroy();
}

namespace {

/// The Managers have taken objects with this summary. At its end they have dropped them.
Task collide_taken(Collider collider, std::uint64_t step, Summary summary, HitReceivers to) {
  Plan plan;
  std::exception_ptr refused;
  try {
    plan = make_plan(summary, n_pes(), collider.options, step);
  } catch (...) {
    refused = std::current_exception();
  }
  const auto body = [&] { collider.managers.broadcast<&Manager::begin>(step, plan, to); };
  co_await epoch(body);
  remaining(collider).end_step();
  if (refused) std::rethrow_exception(refused);
}

/// Collides the objects of a collision of the Neighbours as they are.
Task search(Collider collider, std::uint64_t step, HitReceivers to) {
  const std::uint64_t own_step = remaining(collider).new_step();
  const Summary summary = co_await collider.neighbours.reduce<&Neighbours::enlarge>(
      step, own_step, false, n_sampled(collider));
  co_await collide_taken(collider, own_step, summary, to);
}

/// Finds pairs to keep. Sets `too_many` if they are, and then nothing is kept; if they are by far,
/// or if a larger box has a coordinate without a cell, larger boxes are not searched.
Task find_kept(Collider collider, std::uint64_t step, bool& too_many) {
  const std::uint64_t own_step = remaining(collider).new_step();
  const std::size_t n_each = n_sampled_per_pe(Point{0, 0, 0}, n_pes());
  Summary summary =
      co_await collider.neighbours.reduce<&Neighbours::enlarge>(step, own_step, true, n_each);
  too_many = are_far_too_many(summary, collider.options.rules, n_pes());
  if (too_many) summary = {};  // nothing is searched
  const HitReceivers to_neighbours{
      report_to_neighbours(collider.neighbours, step), {}, Receivers::one_owner};
  try {
    co_await collide_taken(collider, own_step, summary, to_neighbours);
  } catch (const Error&) {
    too_many = true;  // the boxes as they are may have cells
  }
  if (too_many) co_return;
  too_many = co_await collider.neighbours.reduce<&Neighbours::count>(step);
}

/// A step of the Managers encloses the others, so that the collider is known to collide.
Task collide_with_slack(Collider collider, std::uint64_t step, HitReceivers to,
                        Callback<void> taken) {
  const bool must_search = co_await collider.neighbours.reduce<&Neighbours::prepare>(step) == 0;
  if (taken) taken();
  bool as_they_are = must_search && collider.neighbours.local().keeps_none();
  if (must_search && !as_they_are) co_await find_kept(collider, step, as_they_are);
  if (as_they_are) {
    co_await search(collider, step, to);
    co_return;
  }
  const auto body = [&] { collider.neighbours.broadcast<&Neighbours::match>(step, to); };
  co_await epoch(body);
}

/// Has a collider of its own, which outlives the handle that run() is called on.
Task collide_once(Collider collider, HitReceivers to, Callback<void> taken) {
  if (!to.call)
    fail(ErrorCode::bad_argument,
         "Collider::run() with a report that nothing receives: its hits would be lost; give it "
         "report_to<&Client::receive>(clients)");
  const std::uint64_t step = collider.managers.local().new_step();
  if (collider.options.slack > 0) {
    std::exception_ptr refused;
    try {
      co_await collide_with_slack(collider, step, to, taken);
    } catch (...) {
      refused = std::current_exception();
    }
    const auto drop = [&] { collider.neighbours.broadcast<&Neighbours::drop>(step); };
    if (refused) co_await epoch(drop);
    remaining(collider).end_step();
    if (refused) std::rethrow_exception(refused);
    co_return;
  }
  const Summary summary = co_await collider.managers.reduce<&Manager::prepare>(
      step, n_sampled(collider), collider.voxels);
  if (taken) taken();
  co_await collide_taken(collider, step, summary, to);
}

}  // namespace

Task Collider::run(HitReceivers to, Callback<void> taken) const {
  return collide_once(*this, std::move(to), std::move(taken));
}

Future<CollisionStatistics> Collider::statistics() const {
  return managers.reduce<&Manager::report_last>();
}

void Collider::retire() const {
  voxels.broadcast<&Voxel::retire>();
  managers.broadcast<&Manager::shrink>();
  if (options.slack > 0) neighbours.broadcast<&Neighbours::forget>();
}

}  // namespace tess::collide
