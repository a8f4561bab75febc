// Groups: one member per PE, messages to one and to all, reductions in the order of PEs and in any
// order, and a group made by a member of another group.
#include "tests/fuzz/protocols/scenarios.hpp"

#include <numeric>

namespace tess::fuzz {
namespace {

struct GroupRecord {
  int n_rounds = 0;
  std::vector<int> n_calls{};  // by PE
  int n_results = 0, n_ordered = 0, n_made = 0;
};
GroupRecord* group_record = nullptr;

class Second;

class Member : public Group<Member> {
 public:
  explicit Member(std::string word) : word_(std::move(word)) {
    // Messages of a constructor: the group is not known anywhere yet.
    group()[PeId{(pe().value + 1) % tess::n_pes()}].send<&Member::call>(pe(), 0);
  }

  void call(PeId from, int round) {
    expect(tess::my_pe() == pe(), "a member runs on another PE");
    expect(&group().local() == this, "local() is another member");
    locked([&] { ++group_record->n_calls[static_cast<std::size_t>(pe().value)]; });
    if (round > 0) group()[from].send<&Member::call>(pe(), round - 1);
  }
  void play(int round) {
    if (round % 2 == 0) {
      contribute(in_order(concatenate), std::vector<std::string>{text(word_, pe().value)},
                 group()[PeId{round % tess::n_pes()}].target<&Member::ordered>());
    } else {
      contribute(sum, pe().value, group()[PeId{0}].target<&Member::summed>());
    }
    if (round + 1 < group_record->n_rounds && pe().value == round % tess::n_pes())
      group().broadcast<&Member::play>(round + 1);
  }
  void ordered(std::vector<std::string> words) {
    const std::lock_guard lock(oracle);
    ++group_record->n_ordered;
    const auto n = static_cast<std::size_t>(tess::n_pes());
    expect(words.size() == n, words.size(), " words of ", n, " members");
    for (std::size_t i = 0; i < words.size(); ++i)
      expect(words[i] == text("word ", i), "word ", i, " is ", words[i]);
  }
  void summed(int total) {
    const std::lock_guard lock(oracle);
    ++group_record->n_results;
    const int n = tess::n_pes();
    expect(total == n * (n - 1) / 2, "the sum over all PEs is ", total);
  }
  void make_second();

 private:
  std::string word_;
};

/// A group made on any PE, used by others that may not know it yet.
class Second : public Group<Second> {
 public:
  void call() {
    locked([&] { ++group_record->n_made; });
  }
};

class Sender : public Group<Sender> {
 public:
  void send(GroupProxy<Second> to) {
    to.broadcast<&Second::call>();
    to[PeId{(pe().value + 1) % tess::n_pes()}].send<&Second::call>();
  }
};

void Member::make_second() {
  const auto senders = create<Sender>(each_pe);
  const auto second = create<Second>(each_pe);
  senders.broadcast<&Sender::send>(second);
}

}  // namespace

void groups(Case& test) {
  GroupRecord here{test.draw(1, 20)};
  group_record = &here;
  here.n_calls.assign(static_cast<std::size_t>(test.machine.pes), 0);
  const int n = test.machine.pes, n_hops = test.draw(0, 30);
  const PeId maker{test.draw(0, n - 1)};
  test.run_clean([&] {
    const auto group = create<Member>(each_pe, std::string("word "));
    group.broadcast<&Member::play>(0);
    group.broadcast<&Member::call>(PeId{0}, n_hops);
    group[maker].send<&Member::make_second>();
  });
  const int n_calls = std::accumulate(here.n_calls.begin(), here.n_calls.end(), 0);
  expect(n_calls == n + n * (n_hops + 1), n_calls, " calls of ", n + n * (n_hops + 1));
  expect(here.n_ordered == (here.n_rounds + 1) / 2 && here.n_results == here.n_rounds / 2,
         here.n_ordered + here.n_results, " results of ", here.n_rounds);
  expect(here.n_made == n * n + n, here.n_made, " calls of the second group");
}

}  // namespace tess::fuzz
