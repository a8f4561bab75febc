// The texts of reports, and the comparison of an audit, without a run.
#include "runtime/pe/report/waiting.hpp"

#include "runtime/core/hash.hpp"
#include "runtime/pe/report/audit.hpp"
#include "runtime/pe/report/pe_watch.hpp"
#include "tests/support/catch.hpp"

#include <atomic>
#include <memory>
#include <thread>

namespace {

using tess::PeId;
using tess::detail::Audit;
using tess::detail::AuditResult;
using tess::detail::AuditRow;
using tess::detail::Need;
using tess::detail::WaitRank;
using tess::detail::Waits;

Need need(const std::string& asker, const std::string& asked) {
  return {{asker, "<" + asker + ">"}, {asked, "<" + asked + ">.f"}};
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

AuditResult compared(const std::vector<const Audit*>& audits) {
  std::vector<AuditRow> rows;
  for (const Audit* audit : audits) {
    const auto more = audit->rows();
    rows.insert(rows.end(), more.begin(), more.end());
  }
  return compare(
      rows, [](std::uint32_t action) { return "f" + std::to_string(action); },
      [](PeId) { return true; });
}

}  // namespace

TEST_CASE("a cycle of replies is found, and a chain is none", "[runtime][report]") {
  CHECK(tess::detail::cycles_of_replies({need("a", "b"), need("b", "c")}).empty());
  const auto cycles = tess::detail::cycles_of_replies(
      {need("x", "b"), need("b", "c"), need("c", "b"), need("c", "d"), need("e", "e")});
  REQUIRE(cycles.size() == 2);
  CHECK(cycles[0] == "cycle of replies: <b> waits for <c>.f, <c> waits for <b>.f");
  CHECK(cycles[1] == "cycle of replies: <e> waits for <e>.f");
}

TEST_CASE("a chain of a million replies is searched without recursion", "[runtime][report]") {
  std::vector<Need> needs;
  constexpr int n = 100'000;
  for (int i = 0; i < n; ++i) needs.push_back(need(std::to_string(i), std::to_string((i + 1) % n)));
  CHECK(tess::detail::cycles_of_replies(needs).size() == 1);
}

TEST_CASE("a long list is ordered by rank and shortened with the number left out",
          "[runtime][report]") {
  Waits one, other;
  for (int i = 0; i < 3000; ++i) one.add(WaitRank::coroutine, "coroutine " + std::to_string(i));
  one.add(WaitRank::handler, "a handler runs");
  other.add(WaitRank::queue, "PE 3: 1 timer is set");
  other.add(WaitRank::collective, "a reduction");
  one.merge(std::move(other));
  CHECK(one.lines.size() == 1003);
  const std::string list = list_of_waiting(std::move(one));
  CHECK(list.starts_with("3003 wait:\n  a handler runs\n  a reduction\n  coroutine 0\n"));
  CHECK(list.ends_with("\n  … and 2980 more like the last one\n  PE 3: 1 timer is set"));
  CHECK(count(list, "\n  coroutine ") == 20);
}

TEST_CASE("an audit names a message that is lost and one that arrives twice",
          "[runtime][report][audit]") {
  Audit sender(PeId{0}), receiver(PeId{2}), bystander(PeId{1});
  for (int i = 0; i < 10; ++i) {
    const std::uint32_t number = sender.sent(PeId{2}, 7);
    if (number != 6) receiver.received(PeId{0}, 7, number);
  }
  AuditResult result = compared({&sender, &receiver, &bystander});
  CHECK(result.n_sent == 10);
  CHECK(result.differences ==
        std::vector<std::string>{"message 6 (f7) from PE 0 to PE 2 was sent and has not arrived"});
  receiver.received(PeId{0}, 7, 6);
  CHECK(compared({&sender, &receiver}).differences.empty());
  receiver.received(PeId{0}, 7, 9);
  CHECK(compared({&sender, &receiver}).differences ==
        std::vector<std::string>{"message 9 (f7) from PE 0 to PE 2 arrived twice"});
}

TEST_CASE("an audit finds a lost message beside one that arrives twice",
          "[runtime][report][audit]") {
  Audit sender(PeId{3}), receiver(PeId{0});
  for (int i = 0; i < 5; ++i) {
    const std::uint32_t number = sender.sent(PeId{0}, 1);
    receiver.received(PeId{3}, 1, number == 2 ? 4 : number);
  }
  const AuditResult result = compared({&sender, &receiver});
  REQUIRE(result.differences.size() == 1);
  CHECK(result.differences[0] ==
        "of the messages (f1) from PE 3 to PE 0 as many arrived as were sent, but some twice and "
        "some not");
}

TEST_CASE("an element does not end while its name is read", "[runtime][report][threads]") {
  using Name = std::atomic<int>;
  tess::detail::PeWatch watch;
  std::atomic<bool> stop{false};
  int n_looks = 0, n_dead = 0;
  std::thread pe([&] {
    while (!stop) {
      auto name = std::make_unique<Name>(7);
      watch.enters(reinterpret_cast<const tess::detail::Element*>(name.get()), nullptr);
      watch.leaves();
      name->store(0);
    }
  });
  while (n_looks < 2000) {
    watch.look([&](const tess::detail::Element* element, const auto*, double) {
      if (element == nullptr) return;
      ++n_looks;
      if (reinterpret_cast<const Name*>(element)->load() != 7) ++n_dead;
    });
  }
  stop = true;
  pe.join();
  CHECK(n_dead == 0);
}
