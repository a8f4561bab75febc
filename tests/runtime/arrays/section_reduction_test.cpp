// The reduction tree over the members of a section, by itself: one part per PE, messages in any
// order, and members that migrate and are destroyed at any time, also before the root knows how many
// there are.
//
// The oracles: a result has the contribution of each member that was not destroyed before, once,
// and none comes later; the epochs of its contributions are open until then, and done afterwards.
#include "runtime/reduce/reduction_tree.hpp"
#include "tests/runtime/arrays/network.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <optional>
#include <set>

namespace {

using namespace tess;
using namespace tess::detail;
using test::Bag;
using Givers = test::Contributors;
using test::Ledgers;

struct Participant {
  int id = 0;
  std::uint32_t next = 0;
};

class Parts;

/// The host of a part that asks for nothing.
class SectionHost : public ReductionHost {
 public:
  using ReductionHost::send;
  void send(PeId /*to*/, const ReductionBegin& /*begin*/) final { FAIL("a section asks"); }
  [[nodiscard]] std::uint64_t applied_broadcast() const final { return 0; }
  void postpone_new_elements() final { FAIL("a member is postponed"); }
};

class PartHost final : public SectionHost {
 public:
  PartHost(Parts& parts, PeId here) : parts_(parts), here_(here) {}
  using SectionHost::send;
  void send(PeId to, ReductionReport&& report) override;
  void deliver(Partial& result, EpochId epoch) override;

  std::vector<Participant> members;

 private:
  Parts& parts_;
  const PeId here_;
};

/// A section on all PEs.
class Parts {
 public:
  Parts(std::int32_t n_pes, std::uint64_t seed, std::size_t n_reductions)
      : bag(seed), ledgers(n_pes), n_wanted(n_reductions), root(any_of(n_pes)) {
    for (std::int32_t i = 0; i < n_pes; ++i) {
      hosts.push_back(std::make_unique<PartHost>(*this, PeId{i}));
      of_pes.push_back(std::make_unique<ReductionTree>(
          *hosts.back(), ledgers.at(PeId{i}), PeId{i}, root, n_pes,
          TreeWords{"test", [](std::uint32_t) { return "others"; }}, MembersOf::section));
    }
  }
  [[nodiscard]] PeId any_pe() { return any_of(static_cast<std::int32_t>(of_pes.size())); }
  [[nodiscard]] ReductionTree& part(PeId pe) { return *of_pes[static_cast<std::size_t>(pe.value)]; }
  /// What waits on all PEs, in words.
  [[nodiscard]] std::vector<std::string> waiting() const {
    std::vector<std::string> lines;
    for (const auto& part : of_pes) part->describe_waiting(lines);
    return lines;
  }
  [[nodiscard]] PartHost& host(PeId pe) { return *hosts[static_cast<std::size_t>(pe.value)]; }
  [[nodiscard]] static EpochId epoch(std::uint32_t number, int which) {
    return Ledgers::epoch(2 * number + static_cast<std::uint64_t>(which));
  }

  /// A member is on a PE; the root counts it only once begin() is called.
  void add(PeId pe) {
    alive.insert(n_members);
    enter(pe, Participant{n_members++, 0});
  }
  void begin() { part(root).begin(static_cast<std::uint64_t>(n_members)); }
  void step(double disturbance) {
    const PeId pe = any_pe();
    std::vector<Participant>& members = host(pe).members;
    if (!members.empty()) {
      const std::size_t at = bag.random.below(members.size());
      if (bag.random.chance(disturbance)) {
        // Member 0 stays, so that each reduction has a contribution.
        if (members[at].id == 0 || bag.random.chance(0.8)) {
          migrate(pe, at);
        } else {
          destroy(pe, at);
        }
      } else if (members[at].next < n_wanted) {
        contribute(pe, members[at]);
      }
    }
    if (!bag.empty()) bag.deliver_one();
  }
  /// All members move to one PE, or to PE `id` modulo the number of PEs.
  void move_all(std::optional<PeId> to) {
    for (std::size_t i = 0; i < of_pes.size(); ++i)
      while (!hosts[i]->members.empty()) {
        const Participant member = leave(PeId{static_cast<std::int32_t>(i)}, 0);
        const PeId own{member.id % static_cast<std::int32_t>(of_pes.size())};
        bag.post([this, at = to.value_or(own), member] { enter(at, member); });
      }
    while (!bag.empty()) bag.deliver_one();
  }
  /// Each member contributes once, undisturbed.
  void one_round() {
    for (std::size_t i = 0; i < of_pes.size(); ++i)
      for (Participant& member : hosts[i]->members)
        contribute(PeId{static_cast<std::int32_t>(i)}, member);
    while (!bag.empty()) bag.deliver_one();
  }
  void end() {
    ended = true;
    for (const auto& part : of_pes) part->end();
    while (!bag.empty()) bag.deliver_one();
  }

  Bag bag;
  Ledgers ledgers;
  std::vector<std::unique_ptr<PartHost>> hosts;
  std::vector<std::unique_ptr<ReductionTree>> of_pes;
  const std::size_t n_wanted;
  const PeId root;
  std::set<int> alive;
  int n_members = 0;
  std::vector<std::vector<int>> given = std::vector<std::vector<int>>(n_wanted);
  std::size_t n_results = 0, n_reports = 0, n_attaches = 0;
  bool one_epoch = false;  // of all reductions
  bool ended = false;

 private:
  friend class PartHost;
  [[nodiscard]] PeId any_of(std::int32_t n_pes) {
    return PeId{static_cast<std::int32_t>(bag.random.below(static_cast<std::uint64_t>(n_pes)))};
  }
  void enter(PeId pe, const Participant& member) {
    host(pe).members.push_back(member);
    part(pe).enter(member.next);
    part(pe).advance();
  }
  Participant leave(PeId pe, std::size_t at) {
    std::vector<Participant>& members = host(pe).members;
    std::swap(members[at], members.back());
    const Participant member = members.back();
    members.pop_back();
    part(pe).leave(member.next);
    part(pe).advance();
    return member;
  }
  void migrate(PeId pe, std::size_t at) {
    const Participant member = leave(pe, at);
    bag.post([this, to = any_pe(), member] {
      if (!ended) enter(to, member);
    });
  }
  void destroy(PeId pe, std::size_t at) {
    const Participant member = leave(pe, at);
    alive.erase(member.id);
    bag.post([this, next = member.next] {
      if (!ended) part(root).member_destroyed(next);
    });
  }
  void contribute(PeId pe, Participant& member) {
    const std::uint32_t number = member.next++;
    given[number].push_back(member.id);
    const EpochId in = epoch(one_epoch ? 0 : number, bag.random.chance(0.2) ? 1 : 0);
    if (Partial* open = part(pe).open_sum(number, Givers::its_kind(), in); open != nullptr) {
      static_cast<Givers*>(open)->ids.push_back(member.id);
      part(pe).added(number, {});
    } else {
      part(pe).contribute(number, in, std::make_unique<Givers>(member.id));
    }
  }
  void deliver(Partial& result) {
    const auto number = static_cast<std::uint32_t>(n_results++);
    REQUIRE(number < n_wanted);
    auto ids = static_cast<Givers&>(result).ids;
    auto expected = given[number];
    std::sort(ids.begin(), ids.end());
    std::sort(expected.begin(), expected.end());
    REQUIRE(ids == expected);
    for (const int id : alive) REQUIRE(std::binary_search(ids.begin(), ids.end(), id));
    if (!one_epoch) REQUIRE(n_open(number) == expected.size());
    if (!one_epoch && number > 0) REQUIRE(n_open(number - 1) == 0);
  }
  [[nodiscard]] std::uint64_t n_open(std::uint32_t number) {
    return ledgers.n_open(epoch(number, 0)) + ledgers.n_open(epoch(number, 1));
  }
};

void PartHost::send(PeId to, ReductionReport&& report) {
  using What = ReductionReport::What;
  const bool attaches = report.what == What::attached || report.what == What::detached;
  ++(attaches ? parts_.n_attaches : parts_.n_reports);
  const auto held = std::make_shared<ReductionReport>(std::move(report));
  REQUIRE(held->child == here_);
  parts_.bag.post([&parts = parts_, to, held] {
    if (parts.ended) {
      settle(parts.ledgers.at(to), held->sum.shares);
    } else {
      parts.part(to).on_report(std::move(*held));
    }
  });
}
void PartHost::deliver(Partial& result, EpochId /*epoch*/) {
  REQUIRE(here_ == parts_.root);
  parts_.deliver(result);
}

/// The root of a section without members on its PE, and the contributors to its results.
class Root final : public SectionHost {
 public:
  Root()
      : tree(*this, ledger.completion, PeId{0}, PeId{0}, 1,
             TreeWords{"test", [](std::uint32_t) { return std::string(); }}, MembersOf::section) {}
  using SectionHost::send;
  void send(PeId /*to*/, ReductionReport&& /*report*/) override { FAIL("the root reports"); }
  void deliver(Partial& result, EpochId /*epoch*/) override {
    results.push_back(static_cast<Givers&>(result).ids);
  }

  /// Contributions of so many members arrive.
  void arrive(std::uint32_t number, int n) {
    ReductionReport late{ReductionReport::What::late, PeId{1}, {}, number, {}};
    for (int id = 0; id < n; ++id)
      late.sum.add(ledger.completion, EpochId{}, std::make_unique<Givers>(id));
    tree.on_report(std::move(late));
  }
  [[nodiscard]] std::vector<std::string> waiting() const {
    std::vector<std::string> lines;
    tree.describe_waiting(lines);
    return lines;
  }

  std::vector<std::vector<int>> results;
  test::Ledger ledger;
  ReductionTree tree;
};

}  // namespace

TEST_CASE("a section reduction has each member's contribution once, wherever members are",
          "[runtime][collections][section_reduction]") {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    INFO("seed " << seed);
    Parts parts(1 + static_cast<std::int32_t>(seed % 30), seed, 12);
    parts.one_epoch = seed % 4 == 0;
    const std::uint64_t n = 1 + parts.bag.random.below(20);
    for (std::uint64_t i = 0; i < n; ++i) parts.add(parts.any_pe());
    const double disturbance = seed % 3 == 0 ? 0.03 : 0.4;
    // The root may get contributions before it has the list of members.
    for (std::uint64_t i = parts.bag.random.below(30); i > 0; --i) parts.step(disturbance);
    REQUIRE(parts.n_results == 0);
    parts.begin();
    for (int i = 0; i < 400; ++i) parts.step(disturbance);
    int n_steps = 0;
    while ((parts.n_results < parts.n_wanted || !parts.bag.empty()) && ++n_steps < 100'000)
      parts.step(0);
    REQUIRE(parts.n_results == parts.n_wanted);
    REQUIRE(parts.waiting().empty());
    for (std::uint32_t number = 0; number < parts.n_wanted; ++number)
      for (const int which : {0, 1})
        REQUIRE(parts.ledgers.n_open(Parts::epoch(number, which)) == 0);
  }
}

TEST_CASE("members that stay cost one report per PE on their way to the root",
          "[runtime][collections][section_reduction]") {
  constexpr std::int32_t n_pes = 30;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    INFO("seed " << seed);
    Parts parts(n_pes, seed, 10);
    for (int i = 0; i < 3 * n_pes; ++i) parts.add(PeId{i % n_pes});
    parts.begin();
    // All PEs but the root leave the tree and come back. The first reports may find it incomplete,
    // then each PE but the root sends one.
    parts.one_round();
    parts.move_all(parts.root);
    parts.one_round();
    parts.move_all(std::nullopt);
    for (int i = 0; i < 2; ++i) parts.one_round();
    const std::size_t before = parts.n_reports, attaches = parts.n_attaches;
    for (int i = 0; i < 6; ++i) parts.one_round();
    CHECK(parts.n_reports - before == 6 * (n_pes - 1));
    CHECK(parts.n_attaches == attaches);
    CHECK(parts.n_results == 10);
  }
}

TEST_CASE("PEs without members take no part in a section reduction",
          "[runtime][collections][section_reduction]") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    INFO("seed " << seed);
    Parts parts(100, seed, 10);
    for (int i = 0; i < 5; ++i) parts.add(PeId{(parts.root.value + 60) % 100});
    parts.begin();
    for (int i = 0; i < 4; ++i) parts.one_round();
    const std::size_t before = parts.n_reports;
    for (int i = 0; i < 6; ++i) parts.one_round();
    // Of rank 60 in a tree of fan-out 4: 60, 14, 3, root.
    CHECK(parts.n_reports - before == 18);
    CHECK(parts.n_attaches == 3);
  }
}

TEST_CASE("a section that ends settles the contributions that are under way",
          "[runtime][collections][section_reduction]") {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    INFO("seed " << seed);
    Parts parts(1 + static_cast<std::int32_t>(seed % 13), seed, 200);
    for (int i = 0; i < 10; ++i) parts.add(parts.any_pe());
    if (seed % 2 == 0) parts.begin();
    for (std::uint64_t i = parts.bag.random.below(300); i > 0; --i) parts.step(0.2);
    parts.end();
    for (std::uint32_t number = 0; number < parts.n_wanted; ++number)
      for (const int which : {0, 1}) CHECK(parts.ledgers.n_open(Parts::epoch(number, which)) == 0);
    for (const std::string& line : parts.waiting())
      CHECK(line.find("contribution") == std::string::npos);
  }
}

TEST_CASE("contributions wait on their PE for a member that has yet to contribute",
          "[runtime][collections][section_reduction]") {
  Parts parts(2, 1, 3);
  const PeId other{1 - parts.root.value};
  parts.add(other);
  parts.add(other);
  parts.begin();
  while (!parts.bag.empty()) parts.bag.deliver_one();
  ReductionTree& part = parts.part(other);
  part.contribute(0, Parts::epoch(0, 0), std::make_unique<Givers>(0));
  CHECK(parts.waiting() == std::vector<std::string>{text("test 0 has 1 contribution on ", other,
                                                         "; it waits for others")});
  CHECK(parts.n_reports == 0);
  parts.given[0] = {0, 1};
  part.contribute(0, Parts::epoch(0, 0), std::make_unique<Givers>(1));
  CHECK(parts.waiting().empty());
  CHECK(parts.n_reports == 1);
  while (!parts.bag.empty()) parts.bag.deliver_one();
  CHECK(parts.n_results == 1);
}

TEST_CASE("no reduction of a section is complete before its list is known",
          "[runtime][collections][section_reduction]") {
  Root root;
  root.arrive(0, 2);
  CHECK(root.results.empty());
  CHECK_FALSE(root.tree.is_empty());
  root.tree.begin(2);
  CHECK(root.results == std::vector<std::vector<int>>{{0, 1}});
  CHECK_FALSE(root.tree.is_empty());
}

TEST_CASE("the reductions of a section are complete in their order",
          "[runtime][collections][section_reduction]") {
  Root root;
  root.tree.begin(2);
  root.arrive(1, 2);
  CHECK(root.results.empty());
  root.arrive(0, 2);
  CHECK(root.results.size() == 2);
}

TEST_CASE("a destroyed member is missing from its next reduction on",
          "[runtime][collections][section_reduction]") {
  Root root;
  root.tree.begin(3);
  root.arrive(1, 2);
  root.arrive(0, 2);
  CHECK(root.results.empty());  // number 0 comes first, and has two of three
  CHECK(root.waiting().front() == "test 0 has 2 contributions of 3 members");
  root.tree.member_destroyed(1);
  CHECK(root.results.empty());  // it is still a member of 0
  CHECK(root.waiting().back() == "test 1 has 2 contributions of 2 members");
  root.arrive(0, 1);
  CHECK(root.results == std::vector<std::vector<int>>{{0, 1, 0}, {0, 1}});
  root.tree.member_destroyed(2);
  root.arrive(2, 1);
  CHECK(root.results.size() == 3);
  CHECK(root.waiting().empty());
  CHECK_FALSE(root.tree.is_empty());
  root.tree.member_destroyed(3);
  CHECK(root.tree.is_empty());
}
