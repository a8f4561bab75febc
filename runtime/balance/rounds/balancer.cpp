#include "runtime/balance/rounds/balancer.hpp"

#include "runtime/pe/runtime.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

#include <algorithm>

namespace tess::balance {
namespace {

/// Waits on each PE until the array and the exchange (if there is one) are known there. It belongs
/// to the epoch in which start_balancing() runs: when the epoch ends, all elements are measured.
struct Attach {
  CollectionId balancer{};
  CollectionId array{};

  /// The array or the exchange has ended: then the balancer ends, too.
  [[nodiscard]] std::uint64_t drop(Pe& /*pe*/) const {
    if (Balancer* member = GroupProxy<Balancer>(balancer).local_or_null(); member != nullptr)
      member->cannot_attach();
    return 0;
  }
};
void attach_arrives(Collection& array, Attach&& m, Counted /*counted*/) {
  // The balancer may have ended: then the array's end is under way to this PE.
  if (Balancer* member = GroupProxy<Balancer>(m.balancer).local_or_null(); member != nullptr)
    member->attach(array);
}
void exchange_known(Collection& exchange, Attach&& m, Counted /*counted*/) {
  Pe& pe = exchange.pe();
  send_to_collection<&attach_arrives>(pe, m.array, pe.id(), m);
}

struct MergeRoundSums {
  Balancer::RoundSums operator()(const Balancer::RoundSums& a, const Balancer::RoundSums& b) const {
    return {MergeSums()(a.phase, b.phase), a.n_elements + b.n_elements, a.n_moved + b.n_moved,
            a.moved_bytes + b.moved_bytes};
  }
};

struct MergePast {
  PastLoad operator()(const PastLoad& a, const PastLoad& b) const {
    return {a.of_last_phase + b.of_last_phase, a.since_then + b.since_then};
  }
};

}  // namespace

Balancer::Balancer(const Plan& plan)
    : plan_(plan),
      barrier_(current_pe(), *constructing_collection(current_pe()), plan.coordinator,
               group()[plan.coordinator].target<&Balancer::reached>()),
      measured_(current_pe(), plan.indices,
                plan.speeds.empty() ? 1 : plan.speeds[slot(current_pe().id())]) {
  Pe& pe = current_pe();
  if (plan_.when == BalanceWhen::periodic) constructing_collection(pe)->expedite_reductions();
  // Immediately if the array is known: messages sent after start_balancing() arrive later.
  if (Collection* array = find_collection(pe, plan_.array); array != nullptr) watch(*array);
  const Attach attach{group().id(), plan_.array};
  if (plan_.distributed == DistributedStrategy::none) {
    send_to_collection<&attach_arrives>(pe, plan_.array, pe.id(), attach);
  } else {
    send_to_collection<&exchange_known>(pe, plan_.exchange.id(), pe.id(), attach);
  }
}

void Balancer::watch(Collection& array) {
  TESS_CHECK(array.balanced().watcher() == nullptr, array.name(), " has a balancer already");
  array_ = &array;
  array_name_ = array.name();
  array.balanced().watch(*this);
  measured_.attach(array);
}

void Balancer::attach(Collection& array) {
  if (array_ == nullptr) watch(array);
  barrier_is_open_ = true;
  if (plan_.passes) {
    for (Element* element : array.elements())
      if (element != nullptr) pass(*element);
  } else {
    barrier_.attach(array);
  }
  Meter& meter = current_pe().measuring().start_meter();
  if (plan_.when == BalanceWhen::periodic)
    meter.add_alarm(meter.ticks(1e-9 * static_cast<double>(plan_.period_ns)), this,
                    [this] { alarm(); });
  // Only the barrier has to know which elements are under way.
  contribute(sum, plan_.passes ? 0 : array.balanced().n_away(),
             group()[plan_.coordinator].target<&Balancer::attached_everywhere>());
}

void Balancer::array_ends() {
  if (array_ended_) return;
  detach();
  array_ended_ = true;
  end_if_over();
}

void Balancer::cannot_attach() {
  // The coordinator may wait until all have attached; by now the exchange is known or has ended
  // here.
  contribute(sum, std::int64_t{0},
             group()[plan_.coordinator].target<&Balancer::attached_everywhere>());
  array_ends();
}

void Balancer::group_ends() {
  detach();
}

void Balancer::detach() {
  current_pe().measuring().start_meter().remove_alarms(this);
  measured_.detach();
  barrier_.detach();
  if (array_ != nullptr) array_->balanced().unwatch();
  array_ = nullptr;
}

void Balancer::end_if_over() {
  if (!array_ended_ || running_ || coordinator_ == nullptr) return;
  group().destroy();
  if (plan_.distributed != DistributedStrategy::none) plan_.exchange.destroy();
}

void Balancer::attached_everywhere(std::int64_t n_under_way) {
  attached_ = true;
  if (when_attached_) when_attached_();
  n_under_way_ += n_under_way;
  begin_if_ready();
}

void Balancer::late_arrival() {
  --n_under_way_;
  begin_if_ready();
}

void Balancer::begin_if_ready() {
  if (!attached_ || n_under_way_ != 0) return;
  ready_ = true;
  phase_began_ = current_pe().now();
  group().broadcast<&Balancer::begin>();
}

void Balancer::begin() {
  if (!plan_.passes) barrier_.begin();
}

const std::vector<Round>& Balancer::history() const {
  TESS_CHECK(coordinator_ != nullptr, "the history of rounds is kept on ", plan_.coordinator);
  return coordinator_->history();
}

void Balancer::entered(Element& element) {
  measured_.entered(element);
  if (!barrier_is_open_) return;
  if (plan_.passes) {
    pass(element);
    return;
  }
  const auto coordinator = group()[plan_.coordinator];
  switch (barrier_.entered(element)) {
    case Barrier::Entrant::usual:
      break;
    case Barrier::Entrant::late:
      coordinator.send<&Balancer::late_arrival>();
      break;
    case Barrier::Entrant::newcomer:
      coordinator.send<&Balancer::admit>(pe(), barrier_.hold(element));
      break;
  }
}

void Balancer::admit(PeId asker, std::uint32_t ticket) {
  group()[asker].send<&Balancer::joins>(ticket, barrier_.admit());
}

void Balancer::joins(std::uint32_t ticket, std::uint32_t round) {
  barrier_.joins(ticket, round);
}

void Balancer::left(Element& element) {
  measured_.left(element);
  if (barrier_is_open_ && !plan_.passes) barrier_.left(element);
}

void Balancer::destroyed(Element& element) {
  if (!plan_.passes) barrier_.destroyed(element);
}

void Balancer::at_sync(Element& element) {
  if (!barrier_is_open_) return;
  if (plan_.passes) {
    pass(element);
  } else {
    barrier_.at_sync(element);
  }
}

void Balancer::pass(Element& element) {
  const SyncState& sync = BalancedElements::record_of(element)->sync;
  if (sync.phase == SyncPhase::waits) array_->resume(element);
}

Task Balancer::reached(std::uint64_t /*n_elements*/) {
  // The elements of a round may all have ended while it runs, and others reach the next barrier.
  if (++n_reached_ > 1) co_return;
  for (; n_reached_ != 0; --n_reached_) {
    if (array_ended_) co_return;
    co_await phase_ends(Others::balanced);
    group().broadcast<&Balancer::resume>(barriers_++);
  }
}

Task Balancer::attached() {
  if (attached_) co_return;
  Future<void> everywhere;
  when_attached_ = everywhere.callback();
  co_await everywhere;
}

Task Balancer::begin_phase() {
  TESS_CHECK(coordinator_ != nullptr, "phases are begun on ", plan_.coordinator, " only");
  TESS_CHECK(!running_, "a phase begins while a round runs: await that one first");
  running_ = true;
  co_await attached();
  co_await forget_all(Phase::begins);
  round_is_over();
}

Task Balancer::forget_all(Phase phase) {
  co_await group().reduce<&Balancer::forget>(phase);
}

// The phase that a checkpoint interrupted counts if it was at least half as long as the last one.
Task Balancer::place_again() {
  TESS_CHECK(coordinator_ != nullptr, "rounds are requested on ", plan_.coordinator, " only");
  TESS_CHECK(
      !running_,
      "a round while another runs: await that one first; where elements call at_sync(), the rounds "
      "begin by themselves and round() is not called");
  running_ = true;
  co_await attached();
  const PastLoad past = co_await group().reduce<&Balancer::sum_past>();
  const std::uint64_t n_known =
      co_await group().reduce<&Balancer::recall>(2 * past.since_then >= past.of_last_phase);
  if (n_known != 0) {
    co_await round(Others::fixed);
    co_await forget_all(Phase::begins_behind_moves);
  } else {
    co_await forget_all(Phase::begins);
  }
  round_is_over();
}

Task Balancer::phase_ends(Others others) {
  TESS_CHECK(coordinator_ != nullptr, "rounds are requested on ", plan_.coordinator, " only");
  TESS_CHECK(plan_.when != BalanceWhen::periodic,
             "round() of a balancer with when = periodic, whose rounds begin by themselves: choose "
             "at_sync or automatic");
  TESS_CHECK(!array_ended_, "a round of an array that was destroyed");
  TESS_CHECK(!running_, "a round while another runs: await that one first");
  running_ = true;
  co_await attached();
  bool worth = true;
  if (plan_.when == BalanceWhen::automatic) {
    const PhaseSums phase = co_await group().reduce<&Balancer::sum_up>(others);
    worth = coordinator_->worth(phase);
  }
  if (worth) {
    co_await round(others);
    // After a barrier resume() begins the phase.
    if (others == Others::fixed) co_await forget_all(Phase::begins_behind_moves);
  } else {
    co_await forget_all(Phase::ends);
  }
  round_is_over();
}

void Balancer::due(std::uint64_t seen) {
  // Several PEs may request a round, each by its own clock; one round answers them all.
  const Time period(plan_.period_ns);
  if (!ready_ || running_ || array_ended_ || seen < n_rounds_ ||
      current_pe().now() - phase_began_ < period * 9 / 10)
    return;
  running_ = true;
  if (plan_.distributed != DistributedStrategy::none) {
    const Task task = distributed_round_beside();
    return;
  }
  begin_round();
  group().broadcast<&Balancer::collect>(Others::balanced,
                                        group()[pe()].target<&Balancer::collected>());
}

void Balancer::collected(const std::vector<PeReport>& reports) {
  std::vector<std::vector<Move>> moves = decide(reports);
  n_moving_ = 1;
  for (std::size_t to = 0; to < moves.size(); ++to) {
    if (moves[to].empty()) continue;
    ++n_moving_;
    group()[pe_at(to)].send<&Balancer::move_beside>(std::move(moves[to]));
  }
  moved();
}

void Balancer::move_beside(const std::vector<Move>& moves) {
  move(moves);
  group()[plan_.coordinator].send<&Balancer::moved>();
}

void Balancer::moved() {
  if (--n_moving_ != 0) return;
  end_round();
  round_is_over();
}

Task Balancer::distributed_round_beside() {
  co_await round(Others::balanced);
  round_is_over();
}

void Balancer::round_is_over() {
  phase_began_ = current_pe().now();
  running_ = false;
  end_if_over();
}

Task Balancer::round(Others others) {
  begin_round();
  if (plan_.distributed == DistributedStrategy::none) {
    co_await central_round(others);
  } else {
    co_await distributed_round(others);
  }
  end_round();
}

void Balancer::begin_round() {
  ++n_rounds_;
  round_began_ = current_pe().now();
}

void Balancer::end_round() {
  Pe& pe = current_pe();
  const Round& round =
      coordinator_->finish(seconds(pe.now() - round_began_), seconds(round_began_ - phase_began_));
  const bool prints = coordinator_->options().lines == RoundLines::print;
  detail::ProcessMonitor* const monitor = pe.runtime().monitor();
  if (!prints && monitor == nullptr) return;
  const std::vector<Round>& history = coordinator_->history();
  const std::string line =
      describe(round, history.size() > 1 ? &history[history.size() - 2] : nullptr);
  if (prints) pe.runtime().error_line(line);
  if (monitor != nullptr) {
    detail::BalanceNote note{line, round.before, round.predicted};
    monitor->balanced(pe, std::move(note));
  }
}

std::vector<std::vector<Move>> Balancer::decide(const std::vector<PeReport>& reports) {
  try {
    return coordinator_->decide(reports);
  } catch (const Error& error) {
    fail(error.code(), "array ", array_name_, ": ", error.what());
  }
}

Task Balancer::central_round(Others others) {
  const std::vector<PeReport> reports = co_await group().reduce<&Balancer::collect>(others);
  std::vector<std::vector<Move>> moves = decide(reports);
  co_await epoch([&] {
    for (std::size_t to = 0; to < moves.size(); ++to)
      if (!moves[to].empty()) group()[pe_at(to)].send<&Balancer::move>(std::move(moves[to]));
  });
}

Task Balancer::distributed_round(Others others) {
  const PhaseSums before = co_await group().reduce<&Balancer::prepare>(others);
  const double average = before.average_time();
  Future<void> traded;
  plan_.exchange[pe()].send<&Exchange::run>(
      Exchange::Order{plan_.distributed, average, before.mean_load(), coordinator_->options().seed},
      traded.callback());
  co_await traded;
  co_await epoch([this] { group().broadcast<&Balancer::fetch>(); });
  const RoundSums sums = co_await group().reduce<&Balancer::sum_round>();
  Round round;
  round.n_elements = sums.n_elements;
  round.n_unknown = before.n_unknown;
  round.n_moved = sums.n_moved;
  round.moved_bytes = sums.moved_bytes;
  round.before = before.max_over_average();
  round.predicted = average > 0 ? sums.phase.slowest / average : 1;
  coordinator_->record_distributed(std::move(round));
}

void Balancer::sum_up(Others others, const Callback<PhaseSums>& target) {
  contribute(MergeSums{}, measured_.sums(others), target);
}

void Balancer::collect(Others others, const Callback<std::vector<PeReport>>& target) {
  ++n_rounds_seen_;
  std::vector<PeReport> mine;
  mine.push_back(measured_.report(n_collected_++, others));
  contribute(in_order(concatenate), std::move(mine), target);
}

void Balancer::move(const std::vector<Move>& moves) {
  const Measured::Moved moved = measured_.move(moves);
  sums_.n_moved += moved.n_elements;
  sums_.moved_bytes += moved.n_bytes;
}

void Balancer::resume(std::uint32_t round) {
  measured_.round_ends();
  barrier_.resume(round);
}

void Balancer::forget(Phase phase, const Callback<void>& done) {
  switch (phase) {
    case Phase::ends:
      measured_.pass_phase();
      break;
    case Phase::begins_behind_moves:
      measured_.round_ends();
      break;
    case Phase::begins:
      measured_.clear();
      break;
  }
  contribute(done);
}

void Balancer::sum_past(const Callback<PastLoad>& target) {
  contribute(MergePast{}, measured_.past(), target);
}

void Balancer::recall(bool interrupted, const Callback<std::uint64_t>& done) {
  contribute(sum, measured_.recall(interrupted), done);
}

void Balancer::prepare(Others others, const Callback<PhaseSums>& target) {
  ++n_rounds_seen_;
  const PhaseSums before = measured_.sums(others);
  const PeReport report = measured_.report(n_collected_++, others);
  const std::uint64_t limit =
      plan_.memory_limit_bytes.empty() ? 0 : plan_.memory_limit_bytes[slot(pe())];
  plan_.exchange.local().hold(report, measured_.speed(), limit);
  sums_ = {};
  sums_.n_elements = report.keys.size();
  contribute(MergeSums{}, before, target);
}

void Balancer::fetch() {
  boost::unordered_flat_map<PeId, std::vector<Move>, std::hash<PeId>> wanted;
  for (const Item& item : plan_.exchange.local().arrived())
    wanted[origin_of(item.element)].push_back({position_of(item.element), pe()});
  for (auto& [origin, moves] : wanted) group()[origin].send<&Balancer::move>(std::move(moves));
}

void Balancer::sum_round(const Callback<RoundSums>& target) {
  const PeSummary& summary = plan_.exchange.local().summary();
  sums_.phase = {summary.time(), summary.time() * summary.speed, summary.speed};
  contribute(MergeRoundSums{}, sums_, target);
}

void Balancer::alarm() {
  // A PE without elements leaves it to others; an array that has ended has no more rounds.
  if (array_ == nullptr) return;
  const auto& here = array_->elements();
  if (std::none_of(here.begin(), here.end(), [](const Element* e) { return e != nullptr; })) return;
  group()[plan_.coordinator].send<&Balancer::due>(n_rounds_seen_);
}

GroupProxy<Balancer> start(CollectionId array, const BalanceOptions& options, Strategy users) {
  if (array == CollectionId{}) detail::refuse_empty_proxy("start_balancing() of");
  Pe& pe = current_pe();
  TESS_CHECK(!pe.collections().ended(array), "start_balancing() of an array that was destroyed on ",
             pe.id());
  validate(options, pe.n_pes(), users ? StrategyOf::user : StrategyOf::runtime);
  const bool passes =
      options.when == BalanceWhen::periodic ||
      (options.when == BalanceWhen::at_sync && options.strategy == "none" && !users);
  const DistributedStrategy distributed =
      users ? DistributedStrategy::none : distributed_strategy(options.strategy);
  GroupProxy<Exchange> exchange;
  if (distributed != DistributedStrategy::none) exchange = create<Exchange>(each_pe);
  const GroupProxy<Balancer> group =
      create<Balancer>(each_pe, Balancer::Plan{array, pe.id(), options.when, options.period.count(),
                                               passes, options.speeds, options.memory_limit_bytes,
                                               distributed, exchange, options.indices});
  group.local().coordinate(std::make_unique<Coordinator>(options, std::move(users)));
  return group;
}

}  // namespace tess::balance
