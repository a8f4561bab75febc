#include "collide/parallel/neighbours.hpp"

#include "runtime/core/error.hpp"

#include <tuple>
#include <utility>

namespace tess::collide {
namespace {

/// Zero if two differ.
struct SameOrNone {
  std::uint64_t operator()(std::uint64_t a, std::uint64_t b) const { return a == b ? a : 0; }
};

void refuse_capsules(std::span<const Capsule> capsules) {
  if (!capsules.empty())
    fail(
        ErrorCode::bad_argument, "collider: ", capsules.size(),
        " capsules were submitted to a collider with a slack, which takes boxes only: make it with "
        "slack 0, or submit no capsules");
}

}  // namespace

void Neighbours::submit(const Objects& objects) {
  refuse_capsules(objects.capsules);
  pending_.append(objects, pe());
}

void Neighbours::submit(const std::vector<Item>& items, std::span<const Capsule> capsules) {
  refuse_capsules(capsules);
  pending_.append(items, {}, pe());
}

void Neighbours::prepare(std::uint64_t step, const Callback<std::uint64_t>& target) {
  Round& r = round(step);
  r.now = std::move(pending_);
  pending_ = std::move(spare_);
  if (kept_ != nullptr && kept_->hold_for(r.now)) r.pairs = kept_;
  contribute(SameOrNone{}, r.pairs == nullptr ? std::uint64_t{0} : r.pairs->step(), target);
}

void Neighbours::enlarge(std::uint64_t step, std::uint64_t search, bool larger,
                         std::size_t n_sampled, const Callback<Summary>& target) {
  Round& r = round(step);
  ObjectList objects;
  if (larger) {
    r.pairs = std::make_shared<KeptPairs>(step, pe());
    r.is_search = true;
    objects = larger_objects(r.now, slack_, pe());
  } else {
    objects = std::move(r.now);
    rounds_.erase(step);
    kept_.reset();
    keeps_none_ = true;
  }
  contribute(JoinSummaries{}, managers_.local().take(search, std::move(objects), n_sampled),
             target);
}

void Neighbours::keep(std::uint64_t step, Hits found) {
  Round& r = round(step);
  r.pairs->add(std::move(found), r.now.size());
}

void Neighbours::count(std::uint64_t step, const Callback<bool>& target) {
  contribute(LogicalOr{}, round(step).pairs->are_too_many(), target);
}

auto Neighbours::request_sender(std::uint64_t step) {
  return [this, step](std::int32_t to, auto&& bundle) {
    group()[PeId{to}].send<&Neighbours::receive_requests>(step, std::move(bundle));
  };
}

void Neighbours::match(std::uint64_t step, const HitReceivers& to) {
  Round& r = round(step);
  r.receivers = to;
  r.may_test = true;
  if (r.is_search) {
    r.pairs->ask_for_others([&](std::int32_t of, std::span<const std::uint32_t> positions) {
      r.requests.put(of, positions);
    });
    r.requests.start(request_sender(step));
    answer_if_asked(step, r);
  } else {
    for (const auto& [by, positions] : r.pairs->needed()) {
      std::vector<Aabb> boxes;
      boxes.reserve(positions.size());
      for (const std::uint32_t i : positions) boxes.push_back(r.now.boxes()[i]);
      group()[PeId{by}].send<&Neighbours::receive_boxes>(step, pe().value, std::move(boxes));
    }
    test_if_complete(step, r);
  }
}

void Neighbours::receive_requests(std::uint64_t step, const Bundle<std::uint32_t>& bundle) {
  Round& r = round(step);
  r.requests.receive(bundle, request_sender(step));
  answer_if_asked(step, r);
}

void Neighbours::answer_if_asked(std::uint64_t step, Round& r) {
  if (!r.requests.is_done()) return;
  for (const auto& [by, positions] : r.requests.received()) {
    r.pairs->set_needed(by, positions);
    std::vector<search::Entry> wanted, unused;
    for (const std::uint32_t i : positions) wanted.push_back(search::make_entry(i, 0));
    Copies copies;
    copies.objects.append(r.now, wanted, unused);
    group()[PeId{by}].send<&Neighbours::receive_copies>(step, pe().value, std::move(copies));
  }
  test_if_complete(step, r);
}

void Neighbours::receive_copies(std::uint64_t step, std::int32_t from, Copies copies) {
  Round& r = round(step);
  r.boxes[from].assign(copies.objects.boxes().begin(), copies.objects.boxes().end());
  r.pairs->set_copies(from, std::move(copies.objects));
  test_if_complete(step, r);
}

void Neighbours::receive_boxes(std::uint64_t step, std::int32_t from, std::vector<Aabb> boxes) {
  Round& r = round(step);
  r.boxes[from] = std::move(boxes);
  test_if_complete(step, r);
}

void Neighbours::test_if_complete(std::uint64_t step, Round& r) {
  const bool is_asked = !r.is_search || r.requests.is_done();
  if (!r.may_test || !is_asked || r.boxes.size() < r.pairs->n_others()) return;
  test(step);
}

void Neighbours::test(std::uint64_t step) {
  Round& r = round(step);
  if (r.pairs->test(r.progress, r.now, r.boxes, rules_.touching, r.receivers)) {
    group()[pe()].send<&Neighbours::test>(step);
    return;
  }
  managers_.local().note_kept(r.progress.n_tested, r.is_search);
  if (r.is_search) {
    r.pairs->set_objects(std::move(r.now), slack_);
    kept_ = std::move(r.pairs);
  } else {
    r.now.clear();
    spare_ = std::move(r.now);
  }
  rounds_.erase(step);
}

void Neighbours::forget() {
  kept_.reset();
  spare_ = {};
  keeps_none_ = false;
}

namespace {

void call_neighbours(const Callback<Hits>& callback, Hits&& hits) {
  const auto [id, step] = from_bytes<std::tuple<CollectionId, std::uint64_t>>(callback.where());
  const PeId owner{index_of(hits.owner).x};
  GroupProxy<Neighbours>(id)[owner].send<&Neighbours::keep>(step, std::move(hits));
}
const Callback<Hits>::Kind neighbours_kind{naming::name_of<&call_neighbours>(), &call_neighbours};

}  // namespace

Callback<Hits> report_to_neighbours(const GroupProxy<Neighbours>& neighbours, std::uint64_t step) {
  return {neighbours_kind, std::in_place, neighbours.id(), step};
}

}  // namespace tess::collide
