// Constructors that contribute to a reduction and wait at the balance barrier. The oracle: what the
// first elements of an array contribute in their constructors is one reduction of them all, and an
// element that is made again where it migrated does neither again.
#include "apps/protocol_fuzz/scenarios.hpp"
#include "runtime/balance.hpp"

#include <atomic>

namespace tess::fuzz {
namespace {

struct Nursery {
  bool syncs = false;
  Callback<int> born{};
  Callback<int> members{};
  std::atomic<int> n_resumed{0};
};
Nursery* nursery = nullptr;

class Newborn : public Chare<Newborn, Index1> {
 public:
  Newborn() {
    contribute(sum, 1, nursery->born);
    if (nursery->syncs) at_sync();
    if (index().x % 3 == 0)
      migrate_to(PeId{(current_pe().id().value + index().x) % current_pe().n_pes()});
  }
  void give(Callback<int> target) { contribute(sum, 1, target); }
  void resume_from_sync() { ++nursery->n_resumed; }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(none_);
  }

 private:
  int none_ = 0;
};

class Midwife : public Group<Midwife> {
 public:
  Midwife() { contribute(sum, 1, nursery->members); }
};

Task bear_all(Trial& trial, int n, int n_rounds) {
  Future<int> born, members;
  nursery->born = born.callback();
  nursery->members = members.callback();
  const auto newborns = tess::create<Newborn>(range(n));
  create_group<Midwife>();
  BalanceOptions options;
  options.strategy = "rotate";
  if (nursery->syncs) start_balancing(newborns, options);
  const int n_born = co_await born, n_members = co_await members;
  trial.expect(n_born == n, n_born, " of ", n, " constructors' contributions are in the sum");
  trial.expect(n_members == trial.n_pes(), n_members, " members' contributions are in the sum");
  for (int round = 0; round < n_rounds; ++round) {
    Future<int> given;
    newborns.broadcast<&Newborn::give>(given.callback());
    const int n_given = co_await given;
    trial.expect(n_given == n, n_given, " of ", n, " contribute in round ", round);
  }
}

}  // namespace

void constructors(Trial& trial) {
  Nursery here;
  nursery = &here;
  const int n = trial.draw(1, 24), n_rounds = trial.draw(0, 6);
  here.syncs = trial.draw(0, 1) == 1;
  trial.run_clean([&]() -> Task { return bear_all(trial, n, n_rounds); });
  trial.expect(here.n_resumed == (here.syncs ? n : 0), here.n_resumed.load(), " are resumed");
}

}  // namespace tess::fuzz
