#include "runtime/balance/rounds/balancer.hpp"

#include "runtime/scheduler/runtime.hpp"

namespace tess::balance {
namespace {

/// Waits on each PE until the array is known there.
struct Attach {
  CollectionId balancer{};
};
void attach_arrives(Collection& array, Attach&& m) {
  GroupProxy<Balancer>(m.balancer).local().attach(array);
}

double seconds(Time time) {
  return std::chrono::duration<double>(time).count();
}

}  // namespace

Balancer::Balancer(const Plan& plan)
    : plan_(plan),
      barrier_(current_pe(),
               *current_pe().birth_collection(),
               plan.coordinator,
               group()[plan.coordinator].target<&Balancer::reached>()),
      measured_(current_pe()) {
  Pe& pe = current_pe();
  send_to_collection<&attach_arrives>(pe, plan_.array, pe.id(), Attach{group().id()});
}

void Balancer::attach(Collection& array) {
  TESS_CHECK(array.watcher() == nullptr, array.name(), " has a balancer already");
  array_ = &array;
  array.set_watcher(*this);
  measured_.attach(array);
  if (plan_.passes) {
    for (Element* element : array.elements())
      if (element != nullptr) at_sync(*element);
  } else {
    barrier_.attach(array);
  }
  Meter& meter = current_pe().start_meter();
  if (plan_.when == BalanceWhen::periodic)
    meter.add_alarm(meter.ticks(1e-9 * static_cast<double>(plan_.period_ns)), [this] { alarm(); });
}

const std::vector<Round>& Balancer::history() const {
  TESS_CHECK(coordinator_ != nullptr, "the history of rounds is kept on ", plan_.coordinator);
  return coordinator_->history();
}

void Balancer::entered(Element& element) {
  measured_.entered(element);
  if (!plan_.passes) {
    barrier_.entered(element);
  } else {
    pass(element);
  }
}

void Balancer::left(Element& element) {
  measured_.left(element);
  if (!plan_.passes) barrier_.left(element);
}

void Balancer::died(Element& element) {
  if (!plan_.passes) barrier_.died(element);
}

void Balancer::at_sync(Element& element) {
  if (plan_.passes) {
    pass(element);
  } else {
    barrier_.at_sync(element);
  }
}

void Balancer::pass(Element& element) {
  SyncState& sync = Collection::record_of(element)->sync;
  if (sync.phase != SyncPhase::waits) return;
  sync.phase = SyncPhase::resumes;
  array_->resume(element);
}

Task Balancer::reached(std::uint64_t /*n_elements*/) {
  const std::uint32_t barrier = barriers_++;
  bool worth = true;
  if (plan_.when == BalanceWhen::automatic) {
    Future<PhaseSums> sums;
    group().broadcast<&Balancer::sum_up>(sums.callback());
    const PhaseSums phase = co_await sums;
    worth = coordinator_->worth(phase);
  }
  if (worth) {
    co_await round();
  } else {
    group().broadcast<&Balancer::forget>(n_rounds_);
  }
  phase_began_ = current_pe().now();
  group().broadcast<&Balancer::resume>(barrier);
}

Task Balancer::due(std::uint64_t seen) {
  // Several PEs ring, each in its own time; one round answers them all.
  const Time period(plan_.period_ns);
  if (running_ || seen < n_rounds_ || current_pe().now() - phase_began_ < period * 9 / 10)
    co_return;
  running_ = true;
  co_await round();
  phase_began_ = current_pe().now();
  running_ = false;
}

Task Balancer::round() {
  Pe& pe = current_pe();
  const Time began = pe.now();
  ++n_rounds_;
  Future<std::vector<PeReport>> collected;
  group().broadcast<&Balancer::collect>(collected.callback());
  const std::vector<PeReport> reports = co_await collected;
  std::vector<std::vector<Move>> moves = coordinator_->decide(reports);
  co_await epoch([&] {
    for (std::size_t to = 0; to < moves.size(); ++to)
      if (!moves[to].empty()) group()[pe_at(to)].send<&Balancer::move>(std::move(moves[to]));
  });
  const Round& round =
      coordinator_->finish(seconds(pe.now() - began), seconds(began - phase_began_));
  if (coordinator_->options().lines == RoundLines::print) {
    const std::vector<Round>& history = coordinator_->history();
    pe.runtime().error_line(
        describe(round, history.size() > 1 ? &history[history.size() - 2] : nullptr));
  }
}

void Balancer::sum_up(Callback<PhaseSums> target) {
  const auto self = static_cast<std::size_t>(pe().value);
  const double speed = plan_.speeds.empty() ? 1 : plan_.speeds[self];
  contribute(MergeSums{}, measured_.sums(speed), std::move(target));
}

void Balancer::collect(Callback<std::vector<PeReport>> target) {
  ++n_rounds_seen_;
  std::vector<PeReport> mine;
  mine.push_back(measured_.report(n_collected_++));
  contribute(in_order(concatenate), std::move(mine), std::move(target));
}

void Balancer::move(std::vector<Move> moves) {
  measured_.move(moves);
}

void Balancer::resume(std::uint32_t round) {
  barrier_.resume(round);
}

void Balancer::forget(std::uint64_t /*round*/) {
  measured_.clear();
}

void Balancer::alarm() {
  group()[plan_.coordinator].send<&Balancer::due>(n_rounds_seen_);
}

GroupProxy<Balancer> start(CollectionId array, const BalanceOptions& options, Strategy users) {
  Pe& pe = current_pe();
  validate(options, pe.n_pes());
  const bool passes = options.when == BalanceWhen::at_sync && options.strategy == "none" && !users;
  const GroupProxy<Balancer> group = create_group<Balancer>(Balancer::Plan{
      array, pe.id(), options.when, options.period.count(), passes, options.speeds});
  group.local().coordinate(std::make_unique<Coordinator>(options, std::move(users)));
  return group;
}

}  // namespace tess::balance
