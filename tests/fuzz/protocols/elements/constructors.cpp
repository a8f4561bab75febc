// Constructors that contribute to a reduction and wait at the balance barrier. The oracle: the
// contributions of the initial elements' constructors form one reduction of them all, and an
// element that is rebuilt after a migration does neither again.
#include "runtime/balance.hpp"
#include "tests/fuzz/protocols/scenarios.hpp"

#include <atomic>

namespace tess::fuzz {
namespace {

struct Construction {
  bool syncs = false;
  Callback<int> created{};
  Callback<int> members{};
  std::atomic<int> n_resumed{0};
};
Construction* construction = nullptr;

class NewElement : public Chare<NewElement, Index1> {
 public:
  NewElement() {
    contribute(sum, 1, construction->created);
    if (construction->syncs) at_sync();
    if (index().x % 3 == 0) migrate_to(PeId{(tess::my_pe().value + index().x) % tess::n_pes()});
  }
  void give(Callback<int> target) { contribute(sum, 1, target); }
  void resume_from_sync() { ++construction->n_resumed; }
  void serialize(auto& /*ar*/) {}
};

class NewMember : public Group<NewMember> {
 public:
  NewMember() { contribute(sum, 1, construction->members); }
};

Task construct_all(int n, int n_rounds) {
  Future<int> created, members;
  construction->created = created.callback();
  construction->members = members.callback();
  const auto elements = tess::create<NewElement>(range(n));
  create<NewMember>(each_pe);
  BalanceOptions options;
  options.strategy = "rotate";
  if (construction->syncs) start_balancing(elements, options);
  const int n_created = co_await created, n_members = co_await members;
  expect(n_created == n, n_created, " of ", n, " constructors' contributions are in the sum");
  expect(n_members == tess::n_pes(), n_members, " members' contributions are in the sum");
  for (int round = 0; round < n_rounds; ++round) {
    const int n_given = co_await elements.reduce<&NewElement::give>();
    expect(n_given == n, n_given, " of ", n, " contribute in round ", round);
  }
}

}  // namespace

void constructors(Case& test) {
  Construction here;
  construction = &here;
  const int n = test.draw(1, 24), n_rounds = test.draw(0, 6);
  here.syncs = test.draw(0, 1) == 1;
  test.run_clean([&]() -> Task { return construct_all(n, n_rounds); });
  expect(here.n_resumed == (here.syncs ? n : 0), here.n_resumed.load(), " are resumed");
}

}  // namespace tess::fuzz
