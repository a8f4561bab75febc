// Constructors that contribute to a reduction and wait at the balance barrier. The oracle: the
// contributions of the initial elements' constructors form one reduction of them all, and an
// element that is rebuilt after a migration does neither again.
#include "apps/protocol_fuzz/scenarios.hpp"
#include "runtime/balance.hpp"

#include <atomic>

namespace tess::fuzz {
namespace {

struct Nursery {
  bool syncs = false;
  Callback<int> created{};
  Callback<int> members{};
  std::atomic<int> n_resumed{0};
};
Nursery* nursery = nullptr;

class NewElement : public Chare<NewElement, Index1> {
 public:
  NewElement() {
    contribute(sum, 1, nursery->created);
    if (nursery->syncs) at_sync();
    if (index().x % 3 == 0) migrate_to(PeId{(tess::my_pe().value + index().x) % tess::n_pes()});
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

Task construct_all(Trial& trial, int n, int n_rounds) {
  Future<int> created, members;
  nursery->created = created.callback();
  nursery->members = members.callback();
  const auto elements = tess::create<NewElement>(range(n));
  create_group<Midwife>();
  BalanceOptions options;
  options.strategy = "rotate";
  if (nursery->syncs) start_balancing(elements, options);
  const int n_created = co_await created, n_members = co_await members;
  trial.expect(n_created == n, n_created, " of ", n, " constructors' contributions are in the sum");
  trial.expect(n_members == trial.n_pes(), n_members, " members' contributions are in the sum");
  for (int round = 0; round < n_rounds; ++round) {
    const int n_given = co_await elements.reduce<&NewElement::give>();
    trial.expect(n_given == n, n_given, " of ", n, " contribute in round ", round);
  }
}

}  // namespace

void constructors(Trial& trial) {
  Nursery here;
  nursery = &here;
  const int n = trial.draw(1, 24), n_rounds = trial.draw(0, 6);
  here.syncs = trial.draw(0, 1) == 1;
  trial.run_clean([&]() -> Task { return construct_all(trial, n, n_rounds); });
  trial.expect(here.n_resumed == (here.syncs ? n : 0), here.n_resumed.load(), " are resumed");
}

}  // namespace tess::fuzz
