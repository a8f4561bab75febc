// The reduction tree by itself: one tree per PE, messages in any order, and elements that come, go
// and migrate at any time. Two programs run on it:
//
//     rounds     a broadcast, to which every element that receives it contributes; the result starts
//                the next broadcast
//     own time   each element contributes a fixed number of times, whenever it likes, while
//                broadcasts come at any time
//
// The oracles: a result has each contribution to its number once, and none comes later; no epoch of
// a contribution is done before the result is delivered. In rounds the element that receives
// broadcast b + 1 contributes to reduction b.
#include "runtime/reduce/reduction_tree.hpp"

#include "tests/runtime/arrays/network.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>

namespace {

using namespace tess;
using namespace tess::detail;
using test::Bag;
using test::Contributors;
using test::Ledgers;

/// An element's part in rounds, as Collection keeps it.
struct Voter {
  int id = 0;
  std::uint64_t seen = 0;
  std::uint32_t created_after = 0;
  std::uint32_t next = 0;
  bool owes = false;  // it has received a broadcast and has yet to contribute
};

class Trees;

class TreeHost final : public ReductionHost {
 public:
  TreeHost(Trees& trees, PeId here) : trees_(trees), here_(here) {}
  void send(PeId to, ReductionReport&& report) override;
  void send(PeId to, const ReductionBegin& begin) override;
  [[nodiscard]] std::uint64_t applied_broadcast() const override { return applied; }
  void postpone_new_elements() override;
  void deliver(Partial& result, EpochId epoch) override;

  std::uint64_t applied = 0;
  std::vector<std::uint64_t> early;  // broadcasts that have arrived before their turn
  std::vector<Voter> elements;

 private:
  Trees& trees_;
  const PeId here_;
};

class Trees {
 public:
  Trees(std::int32_t n_pes, std::uint64_t seed, std::size_t n_reductions)
      : bag(seed), ledgers(n_pes), n_wanted(n_reductions), root_(any_of(n_pes)) {
    for (std::int32_t i = 0; i < n_pes; ++i) {
      hosts.push_back(std::make_unique<TreeHost>(*this, PeId{i}));
      of_pes.push_back(std::make_unique<ReductionTree>(
          *hosts.back(), ledgers.at(PeId{i}), PeId{i}, root_, n_pes,
          TreeWords{"test", [](std::uint32_t) { return std::string(); }}));
    }
  }

  [[nodiscard]] PeId any_pe() { return any_of(static_cast<std::int32_t>(of_pes.size())); }
  [[nodiscard]] ReductionTree& tree(PeId pe) { return *of_pes[static_cast<std::size_t>(pe.value)]; }
  [[nodiscard]] TreeHost& host(PeId pe) { return *hosts[static_cast<std::size_t>(pe.value)]; }
  /// Each round's contributions are in one of two epochs.
  [[nodiscard]] static EpochId epoch(std::uint32_t round, int which) {
    return Ledgers::epoch(2 * round + static_cast<std::uint64_t>(which));
  }

  void start_broadcast() {
    n_complete_at_start_.push_back(tree(root_).n_complete());
    const std::uint64_t number = n_complete_at_start_.size();
    for (std::size_t i = 0; i < of_pes.size(); ++i) {
      const PeId to{static_cast<std::int32_t>(i)};
      bag.post([this, to, number] { arrive(to, number); });
    }
  }

  void create(PeId pe) {
    Voter element{n_created++, host(pe).applied, static_cast<std::uint32_t>(host(pe).applied),
                  tree(pe).joins_at()};
    tree(pe).add_member(element.next);
    list(pe, element);
  }
  /// A random element of a PE migrates or is destroyed, or one is created there.
  void disturb() {
    const PeId pe = any_pe();
    std::vector<Voter>& elements = host(pe).elements;
    if (elements.empty() || bag.random.chance(0.3)) return create(pe);
    const std::size_t at = bag.random.below(elements.size());
    if (elements[at].id == 0 || bag.random.chance(0.7)) return migrate(pe, at);
    const Voter element = unlist(pe, at);
    tree(pe).remove_member(element.next);
    tree(pe).advance();
  }
  /// One step of the elements that contribute in their own time.
  void step_in_own_time(double disturbance) {
    if (bag.random.chance(disturbance)) disturb();
    if (n_complete_at_start_.size() < n_wanted && bag.random.chance(0.02)) start_broadcast();
    const PeId pe = any_pe();
    std::vector<Voter>& elements = host(pe).elements;
    if (!elements.empty()) {
      Voter& element = elements[bag.random.below(elements.size())];
      const bool led = bag.random.chance(0.3);
      if (element.next < n_wanted)
        contribute(pe, element, led ? static_cast<std::uint32_t>(element.seen) : 0);
    }
    if (!bag.empty()) bag.deliver_one();
  }
  void step(double disturbance) {
    if (bag.random.chance(disturbance)) disturb();
    // An element that owes a contribution makes it, wherever it is.
    const PeId pe = any_pe();
    for (Voter& element : host(pe).elements) {
      if (!element.owes || !bag.random.chance(0.5)) continue;
      element.owes = false;
      contribute_in_round(pe, element);
      break;  // the elements may have changed
    }
    if (!bag.empty()) bag.deliver_one();
  }
  [[nodiscard]] bool any_owes() const {
    return std::any_of(hosts.begin(), hosts.end(), [](const auto& host) {
      return std::any_of(host->elements.begin(), host->elements.end(),
                         [](const Voter& element) { return element.owes; });
    });
  }
  void end() {
    ended = true;
    for (const auto& part : of_pes) part->end();
    while (!bag.empty()) bag.deliver_one();
  }

  Bag bag;
  Ledgers ledgers;
  std::vector<std::unique_ptr<TreeHost>> hosts;
  std::vector<std::unique_ptr<ReductionTree>> of_pes;
  const std::size_t n_wanted;
  std::vector<std::vector<int>> contributors =
      std::vector<std::vector<int>>(n_wanted);  // to each reduction
  std::size_t n_results = 0;
  int n_created = 0;
  bool ended = false;
  bool in_rounds = true;

 private:
  friend class TreeHost;
  [[nodiscard]] PeId any_of(std::int32_t n_pes) {
    return PeId{static_cast<std::int32_t>(bag.random.below(static_cast<std::uint64_t>(n_pes)))};
  }

  void postpone(PeId pe, Voter& element) {
    if (element.created_after != 0)
      element.next = tree(pe).postpone(element.next, element.created_after);
  }
  void list(PeId pe, Voter element) {
    tree(pe).enter(element.next);
    postpone(pe, element);
    host(pe).elements.push_back(element);
  }
  Voter unlist(PeId pe, std::size_t at) {
    std::vector<Voter>& elements = host(pe).elements;
    std::swap(elements[at], elements.back());
    const Voter element = elements.back();
    elements.pop_back();
    tree(pe).leave(element.next);
    return element;
  }
  void migrate(PeId pe, std::size_t at) {
    const PeId to = any_pe();
    bag.post([this, to, element = unlist(pe, at)]() mutable {
      if (ended) return;
      const auto last = host(to).applied;
      list(to, element);
      for (std::uint64_t number = element.seen + 1; number <= last; ++number)
        receive(to, element.id, number);
    });
    tree(pe).advance();
  }

  void arrive(PeId pe, std::uint64_t broadcast) {
    if (ended) return;
    TreeHost& here = host(pe);
    here.early.push_back(broadcast);
    for (;;) {
      const auto next = std::find(here.early.begin(), here.early.end(), here.applied + 1);
      if (next == here.early.end()) return;
      here.early.erase(next);
      ++here.applied;
      std::vector<int> ids;
      for (const Voter& element : here.elements)
        if (element.seen < here.applied) ids.push_back(element.id);
      for (const int id : ids) receive(pe, id, here.applied);
      tree(pe).applied(here.applied, n_complete_at_start_[here.applied - 1]);
    }
  }
  void receive(PeId pe, int id, std::uint64_t broadcast) {
    std::vector<Voter>& elements = host(pe).elements;
    Voter& element = *std::find_if(elements.begin(), elements.end(),
                                   [id](const Voter& one) { return one.id == id; });
    REQUIRE_FALSE(element.owes);
    element.seen = broadcast;
    if (!in_rounds) return;
    if (bag.random.chance(0.3)) {
      element.owes = true;  // it contributes later, perhaps on another PE
    } else {
      contribute_in_round(pe, element);
    }
  }
  /// Element 0 knows the broadcast that led to its contribution; others may not.
  void contribute_in_round(PeId pe, Voter& element) {
    REQUIRE(element.next + 1 == element.seen);  // neither ahead nor behind
    const bool led = element.id == 0 || bag.random.chance(0.3);
    contribute(pe, element, led ? static_cast<std::uint32_t>(element.seen) : 0);
  }
  void contribute(PeId pe, Voter& element, std::uint32_t led_by) {
    // As Collection does: the tree checks the first contribution of an element.
    Newcomer newcomer{std::exchange(element.created_after, 0), "a voter"};
    if (!in_rounds) newcomer.created_after = 0;
    REQUIRE(element.next >= n_results);
    contributors[element.next].push_back(element.id);
    const EpochId in = epoch(element.next, bag.random.chance(0.5) ? 1 : 0);
    const Cause cause{element.seen, led_by};
    const std::uint32_t number = element.next++;
    Partial* const sum = newcomer.created_after != 0
                             ? nullptr
                             : tree(pe).open_sum(number, Contributors::its_kind(), in);
    if (sum != nullptr) {
      static_cast<Contributors*>(sum)->ids.push_back(element.id);
      tree(pe).added(number, cause);
    } else {
      tree(pe).contribute(number, in, std::make_unique<Contributors>(element.id), cause,
                          std::move(newcomer));
    }
  }

  const PeId root_;
  std::vector<std::uint32_t> n_complete_at_start_;
};

void TreeHost::send(PeId to, ReductionReport&& report) {
  const auto held = std::make_shared<ReductionReport>(std::move(report));
  trees_.bag.post([&trees = trees_, to, held] {
    if (trees.ended) {
      settle(trees.ledgers.at(to), held->sum.shares);
    } else {
      trees.tree(to).on_report(std::move(*held));
    }
  });
}
void TreeHost::send(PeId to, const ReductionBegin& begin) {
  trees_.bag.post([&trees = trees_, to, begin] {
    if (!trees.ended) trees.tree(to).on_begin(begin);
  });
}
void TreeHost::postpone_new_elements() {
  for (Voter& element : elements) trees_.postpone(here_, element);
}
void TreeHost::deliver(Partial& result, EpochId epoch) {
  auto ids = static_cast<Contributors&>(result).ids;
  const auto number = static_cast<std::uint32_t>(trees_.n_results++);
  REQUIRE(number < trees_.contributors.size());
  auto expected = trees_.contributors[number];
  const std::uint64_t n_open = trees_.ledgers.n_open(Trees::epoch(number, 0)) +
                               trees_.ledgers.n_open(Trees::epoch(number, 1));
  REQUIRE(n_open == expected.size());
  if (epoch.value != 0) REQUIRE(trees_.ledgers.n_open(epoch) == expected.size());
  std::sort(ids.begin(), ids.end());
  std::sort(expected.begin(), expected.end());
  REQUIRE(ids == expected);
  if (trees_.in_rounds && trees_.n_results < trees_.n_wanted) trees_.start_broadcast();
}

void check_votes_settled(Trees& trees) {
  for (std::uint32_t round = 0; round < trees.n_wanted; ++round)
    for (const int which : {0, 1}) CHECK(trees.ledgers.n_open(Trees::epoch(round, which)) == 0);
}

}  // namespace

TEST_CASE("a reduction has each contribution once, and no element is ahead or behind",
          "[runtime][collections][reduction_tree]") {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    INFO("seed " << seed);
    Trees trees(1 + static_cast<std::int32_t>(seed % 13), seed, 8);
    const std::uint64_t n = 1 + trees.bag.random.below(12);
    for (std::uint64_t i = 0; i < n; ++i) trees.create(trees.any_pe());
    trees.start_broadcast();
    // In a third of the seeds elements seldom come, go and migrate.
    const double disturbance = seed % 3 == 0 ? 0.03 : 0.3;
    int n_steps = 0;
    while (trees.n_results < trees.n_wanted && n_steps++ < 20'000) trees.step(disturbance);
    // Then nothing disturbs, and all messages are delivered.
    while (!trees.bag.empty() || trees.any_owes()) trees.step(0);
    REQUIRE(trees.n_results == trees.n_wanted);
    check_votes_settled(trees);
  }
}

TEST_CASE("elements contribute in their own time, and each reduction has all contributions to it",
          "[runtime][collections][reduction_tree]") {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    INFO("seed " << seed);
    Trees trees(1 + static_cast<std::int32_t>(seed % 13), seed, 40);
    trees.in_rounds = false;
    const std::uint64_t n = 1 + trees.bag.random.below(12);
    for (std::uint64_t i = 0; i < n; ++i) trees.create(trees.any_pe());
    const double disturbance = seed % 3 == 0 ? 0.03 : 0.3;
    for (int i = 0; i < 400; ++i) trees.step_in_own_time(disturbance);
    int n_steps = 0;
    while ((trees.n_results < trees.n_wanted || !trees.bag.empty()) && ++n_steps < 100'000)
      trees.step_in_own_time(0);
    REQUIRE(trees.n_results == trees.n_wanted);
    check_votes_settled(trees);
  }
}

TEST_CASE("the end of a collection settles the contributions that are under way",
          "[runtime][collections][reduction_tree]") {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    INFO("seed " << seed);
    Trees trees(1 + static_cast<std::int32_t>(seed % 13), seed, 100);
    for (int i = 0; i < 10; ++i) trees.create(trees.any_pe());
    trees.start_broadcast();
    for (std::uint64_t i = trees.bag.random.below(300); i > 0; --i) trees.step(0.2);
    trees.end();
    check_votes_settled(trees);
  }
}
