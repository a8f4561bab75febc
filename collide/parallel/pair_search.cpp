#include "collide/parallel/pair_search.hpp"

#include "collide/problem/costs.hpp"
#include "collide/problem/piece_pairs.hpp"
#include "collide/search/voxel_search.hpp"

#include <algorithm>
#include <utility>

namespace tess::collide {
namespace {

using Search = search::VoxelSearch<double, 3>;
using PiecePairs = search::PiecePairs<PieceTable>;

/// The scratch memory of a thread.
struct Scratch {
  VoxelProblem problem;
  PiecePairs of_pieces;
  Search search{{}, false, {nullptr, nullptr}};
};
Scratch& scratch() {
  static thread_local Scratch memory;
  return memory;
}

/// Ends a search early.
struct TooManyPairs {};

/// Sorts pairs by the owners of their objects.
struct Receiver {
  const HitReceivers& receivers;
  const Plan& plan;
  const ObjectList* of_a = nullptr;  // of the current search
  const ObjectList* of_b = nullptr;
  HitSorter hits{};
  std::size_t n_pairs = 0;

  static void call(void* context, const std::uint32_t* first, const std::uint32_t* second,
                   std::size_t n, bool swapped) {
    auto& self = *static_cast<Receiver*>(context);
    const ObjectList &of_first = swapped ? *self.of_b : *self.of_a,
                     &of_second = swapped ? *self.of_a : *self.of_b;
    if (of_first.pieces().empty()) return self.add(of_first, first, of_second, second, n);
    PiecePairs& pairs = scratch().of_pieces;
    for (std::size_t begin = 0; begin < n; begin += PiecePairs::most) {
      pairs.find(of_first.pieces(), first + begin, of_second.pieces(), second + begin,
                 std::min(n - begin, PiecePairs::most), self.plan.rules.touching);
      self.add(of_first, pairs.x(), of_second, pairs.y(), pairs.size());
    }
  }
  void add(const ObjectList& of_first, const std::uint32_t* first, const ObjectList& of_second,
           const std::uint32_t* second, std::size_t n) {
    n_pairs += n;
    if (n_pairs > most_pairs) throw TooManyPairs{};
    hits.add({of_first, first}, {of_second, second}, n, receivers, my_pe());
  }
};

void solve(const PairSets& sets, Receiver& receiver, Search& search) {
  const Problem& problem = sets.problem;
  receiver.of_a = sets.of_a;
  receiver.of_b = sets.of_b;
  charge_each(receiver.plan.costs.search, problem.a.size() + problem.b.size());
  // Few objects are compared wherever they are.
  const bool is_small = problem.a.size() + problem.b.size() <= search::costs::few_objects;
  const Aabb bounds = is_small ? Aabb{} : search::bounds_of(problem.boxes_a, problem.a);
  static_cast<void>(search.solve(problem, bounds, false));
}

/// Calls run(search) for a search that has the receiver; false if there were too many pairs.
template <class Run>
bool run_search(const VoxelProblem& voxel, Receiver& receiver, const Run& run) {
  Search& search = scratch().search;
  const Plan& plan = receiver.plan;
  PairOptions options;
  // Boxes of pieces touch where their objects may overlap.
  options.touching = plan.pieces.used ? Touching::counts : plan.rules.touching;
  options.models = voxel.models();
  options.within_model = options.models.empty() ? WithinModel::test : WithinModel::skip;
  search.restart(options, !options.models.empty(), {&receiver, &Receiver::call});
  try {
    run(search);
    charge_each(plan.costs.pair, receiver.n_pairs);
    charge_each(plan.costs.reply, receiver.hits.size());
    return true;
  } catch (const TooManyPairs&) {
    return false;
  }
}

}  // namespace

bool search_at_once(std::span<const Part> parts) {
  VoxelProblem& voxel = scratch().problem;
  const Delivery& delivery = parts.front().delivery();
  voxel.gather(parts, delivery.plan.rules.within_model);
  charge_each(delivery.plan.costs.copy, voxel.n_copied());
  Receiver receiver{delivery.receivers, delivery.plan};
  const bool found = run_search(voxel, receiver, [&](Search& search) {
    voxel.for_each_search([&](const PairSets& sets) { solve(sets, receiver, search); });
  });
  if (found) receiver.hits.send(delivery.receivers.call);
  return found;
}

PortionSearch::PortionSearch(std::vector<Part> parts) : parts_(std::move(parts)) {
  objects_.gather(parts_, parts_.front().delivery().plan.rules.within_model);
  objects_.for_each_search([&](const PairSets& sets) { remaining_.push_back(sets); });
}

HitSorter PortionSearch::next() {
  const Delivery& delivery = parts_.front().delivery();
  while (!remaining_.empty()) {
    const PairSets sets = remaining_.back();
    remaining_.pop_back();
    Receiver receiver{delivery.receivers, delivery.plan};
    if (!run_search(objects_, receiver, [&](Search& search) { solve(sets, receiver, search); }))
      divide(sets);
    else if (!receiver.hits.empty())
      return std::move(receiver.hits);
  }
  return {};
}

void PortionSearch::divide(const PairSets& sets) {
  const Problem& problem = sets.problem;
  const auto add = [&](const Problem& part) { remaining_.push_back({part, sets.of_a, sets.of_b}); };
  const auto half = [](std::span<const search::Entry> all, bool second) {
    const std::size_t n = all.size() / 2;
    return second ? all.subspan(n) : all.first(n);
  };
  Problem one = problem, other = problem;
  if (problem.within_a) {
    const auto a1 = half(problem.a, false), a2 = half(problem.a, true);
    one.a = a1;
    other.a = a2;
    one.b = other.b = {};
    remaining_.push_back({{problem.boxes_a, problem.boxes_a, a1, a2, false}, sets.of_a, sets.of_a});
    if (!problem.b.empty()) add({problem.boxes_a, problem.boxes_b, problem.a, problem.b, false});
  } else if (problem.a.size() > problem.b.size()) {
    one.a = half(problem.a, false);
    other.a = half(problem.a, true);
  } else {
    one.b = half(problem.b, false);
    other.b = half(problem.b, true);
  }
  add(one);
  add(other);
}

}  // namespace tess::collide
