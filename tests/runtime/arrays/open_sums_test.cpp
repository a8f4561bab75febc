// What is gathered on one PE, by itself: where a contribution may be added in place, and what is
// left when sums are merged, taken out and dropped.
#include "runtime/reduce/open_sums.hpp"

#include "tests/runtime/arrays/network.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <typeinfo>

namespace {

using namespace tess;
using namespace tess::detail;
using test::Ledgers;

/// A sum of numbers; of several kinds, which differ in their name.
template <int which>
class Total final : public Partial {
 public:
  explicit Total(int first) : value{first} {}
  static const PartialKind& its_kind() {
    static const PartialKind kind(
        {which == 0 ? "tess::test::Total" : "tess::test::OtherTotal", &typeid(Total)}, nullptr);
    return kind;
  }
  [[nodiscard]] const PartialKind& kind() const override { return its_kind(); }
  void merge(Partial&& other) override { value += static_cast<const Total&>(other).value; }
  void pack(Writer& /*ar*/) const override {}
  void complete(Pe& /*pe*/) override {}

  int value;
};

std::unique_ptr<Partial> number(int value) {
  return std::make_unique<Total<0>>(value);
}
int total_of(const Gathered& sum) {
  return static_cast<const Total<0>&>(*sum.value.held).value;
}
std::uint64_t n_in(const Gathered& sum, EpochId epoch) {
  std::uint64_t n = 0;
  for (const EpochShare& share : sum.shares)
    if (share.epoch == epoch) n += share.n;
  return n;
}

const EpochId first_epoch = Ledgers::epoch(0), second_epoch = Ledgers::epoch(1);

}  // namespace

TEST_CASE(
    "a contribution is added in place to the sum that got the last one, of its kind and epoch",
    "[runtime][collections][open_sums]") {
  Ledgers ledgers(1);
  Completion& completion = ledgers.at(PeId{0});
  const PartialKind& kind = Total<0>::its_kind();
  OpenSums<Gathered> sums;
  CHECK(sums.open(3, kind, first_epoch) == nullptr);
  sums.add(completion, 3, first_epoch, number(1));
  CHECK(sums.open(2, kind, first_epoch) == nullptr);
  CHECK(sums.open(3, Total<1>::its_kind(), first_epoch) == nullptr);
  CHECK(sums.open(3, kind, second_epoch) == nullptr);
  Partial* const open = sums.open(3, kind, first_epoch);
  REQUIRE(open != nullptr);
  static_cast<Total<0>*>(open)->value += 2;
  CHECK(&sums.added(completion) == sums.find(3));
  sums.add(completion, 4, first_epoch, number(7));
  CHECK(sums.open(3, kind, first_epoch) == nullptr);
  CHECK(sums.open(4, kind, first_epoch) != nullptr);
  CHECK(sums.find(3)->n == 2);
  CHECK(n_in(*sums.find(3), first_epoch) == 2);
  CHECK(total_of(*sums.find(3)) == 3);
}

TEST_CASE("a sum that was taken out is open no longer", "[runtime][collections][open_sums]") {
  Ledgers ledgers(1);
  Completion& completion = ledgers.at(PeId{0});
  const PartialKind& kind = Total<0>::its_kind();
  OpenSums<Gathered> sums;
  sums.add(completion, 3, first_epoch, number(1));
  CHECK(sums.take(2).n == 0);  // there is none
  CHECK(sums.open(3, kind, first_epoch) != nullptr);
  CHECK(total_of(sums.take(3)) == 1);
  CHECK(sums.empty());
  CHECK(sums.find(3) == nullptr);
  CHECK(sums.open(3, kind, first_epoch) == nullptr);
  (void)sums[3];  // a new one of that number
  CHECK(sums.open(3, kind, first_epoch) == nullptr);
}

TEST_CASE("sums that are dropped count as processed in the epochs of their contributions",
          "[runtime][collections][open_sums]") {
  Ledgers ledgers(1);
  Completion& completion = ledgers.at(PeId{0});
  OpenSums<Gathered> sums;
  for (std::uint32_t i = 0; i < 12; ++i) {
    const EpochId epoch = i % 3 == 0 ? second_epoch : first_epoch;
    sums.add(completion, i % 5, epoch, number(1));
  }
  CHECK(ledgers.n_open(first_epoch) == 8);
  CHECK(ledgers.n_open(second_epoch) == 4);
  sums.drop(completion);
  CHECK(ledgers.n_open(first_epoch) == 0);
  CHECK(ledgers.n_open(second_epoch) == 0);
  CHECK(sums.empty());
  CHECK(sums.open(1, Total<0>::its_kind(), first_epoch) == nullptr);
}

TEST_CASE("contributions that meet in any order give one sum, with one share per epoch",
          "[runtime][collections][open_sums]") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    INFO("seed " << seed);
    Random random(seed);
    Ledgers ledgers(1);
    Completion& completion = ledgers.at(PeId{0});
    // Each is in a part of its own, and any two parts merge next; some parts have no contribution.
    std::vector<Gathered> parts(1 + random.below(12));
    std::uint64_t n = 0, n_in_first = 0;
    int total = 0;
    for (Gathered& part : parts)
      if (random.chance(0.8)) {
        const bool in_first = random.chance(0.5);
        part.add(completion, in_first ? first_epoch : second_epoch, number(1 << n));
        total += 1 << n++;
        n_in_first += in_first ? 1 : 0;
      }
    while (parts.size() > 1) {
      std::swap(parts[random.below(parts.size())], parts.back());
      Gathered last = std::move(parts.back());
      parts.pop_back();
      parts[random.below(parts.size())].merge(std::move(last));
    }
    const Gathered& whole = parts.front();
    REQUIRE(whole.n == n);
    REQUIRE(n_in(whole, first_epoch) == n_in_first);
    REQUIRE(n_in(whole, second_epoch) == n - n_in_first);
    REQUIRE(whole.shares.size() <= 2);
    REQUIRE(ledgers.n_open(first_epoch) == n_in_first);  // until they are settled
    REQUIRE((whole.epoch() == EpochId{}) == (whole.shares.size() != 1));
    if (n != 0) REQUIRE(total_of(whole) == total);
  }
}
