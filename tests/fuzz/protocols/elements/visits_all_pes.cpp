// Every element visits every PE while messages from all PEs follow it.
#include "tests/fuzz/protocols/scenarios.hpp"

#include <algorithm>

namespace tess::fuzz {
namespace {

struct VisitsRecord {
  std::vector<int> delivered{};
  int n_finished = 0;
};
VisitsRecord* visits_record = nullptr;

class Visitor : public Chare<Visitor, Index3> {
 public:
  /// One more stop: marks this PE, and goes to one not seen yet.
  void visit(int n_stops) {
    const auto n_pes = static_cast<std::size_t>(tess::n_pes());
    seen_.resize(n_pes);
    seen_[static_cast<std::size_t>(tess::my_pe().value)] = true;
    std::vector<PeId> left;
    for (std::size_t pe = 0; pe < n_pes; ++pe)
      if (!seen_[pe]) left.push_back(PeId{static_cast<std::int32_t>(pe)});
    if (left.empty()) {
      const std::lock_guard lock(oracle);
      ++visits_record->n_finished;
      return;
    }
    Random random(mix(static_cast<std::uint64_t>(n_stops * 1000 + index().x)));
    migrate_to(left[random.below(left.size())]);
    array()[index()].send<&Visitor::visit>(n_stops + 1);
  }
  void note(int token) {
    locked([&] { ++visits_record->delivered[static_cast<std::size_t>(token)]; });
  }
  void serialize(auto& ar) { ar(seen_); }

 private:
  std::vector<bool> seen_{};
};

struct Sending {
  ArrayProxy<Visitor> array;
  int n_elements = 0;
  int n_rounds = 0;
};

/// On each PE: sends to every element again and again.
class VisitorSender : public Group<VisitorSender> {
 public:
  void send_round(Sending send_round, int round) {
    const int n_per_pe = send_round.n_elements * send_round.n_rounds;
    for (int i = 0; i < send_round.n_elements; ++i)
      send_round.array[{i, 0, 1}].send<&Visitor::note>(pe().value * n_per_pe +
                                                       round * send_round.n_elements + i);
    if (round + 1 < send_round.n_rounds)
      group()[pe()].send<&VisitorSender::send_round>(send_round, round + 1);
  }
};

}  // namespace

void visits_all_pes(Case& test) {
  VisitsRecord here{};
  visits_record = &here;
  const int n = test.draw(1, 20), n_rounds = test.draw(1, 10);
  here.delivered.assign(static_cast<std::size_t>(test.machine.pes * n * n_rounds), 0);
  test.run_clean([&] {
    const auto array = tess::create<Visitor>(range(n, 1, 2));
    const auto senders = create<VisitorSender>(each_pe);
    for (int i = 0; i < n; ++i) array[{i, 0, 1}].send<&Visitor::visit>(0);
    senders.broadcast<&VisitorSender::send_round>(Sending{array, n, n_rounds}, 0);
  });
  expect(here.n_finished == n, here.n_finished, " of ", n, " tours ended");
  for (std::size_t i = 0; i < here.delivered.size(); ++i)
    expect(here.delivered[i] == 1, "message ", i, " was delivered ", here.delivered[i], " times");
}

}  // namespace tess::fuzz
