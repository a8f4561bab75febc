// Every element visits every PE while messages from all PEs follow it.
#include "apps/protocol_fuzz/scenarios.hpp"

#include <algorithm>

namespace tess::fuzz {
namespace {

struct Chase {
  Trial& trial;
  std::mutex mutex{};
  std::vector<int> delivered{};
  int n_finished = 0;
};
Chase* chase = nullptr;

class Tourist : public Chare<Tourist, Index3> {
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
      const std::lock_guard lock(chase->mutex);
      ++chase->n_finished;
      return;
    }
    Random random(mix(static_cast<std::uint64_t>(n_stops * 1000 + index().x)));
    migrate_to(left[random.below(left.size())]);
    array()[index()].send<&Tourist::visit>(n_stops + 1);
  }
  void note(int token) {
    const std::lock_guard lock(chase->mutex);
    ++chase->delivered[static_cast<std::size_t>(token)];
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(seen_);
  }

 private:
  std::vector<bool> seen_{};
};

struct Hunt {
  ArrayProxy<Tourist> array;
  int n_elements = 0;
  int n_rounds = 0;
};

/// On each PE: sends to every element again and again.
class Hunter : public Group<Hunter> {
 public:
  void hunt(Hunt hunt, int round) {
    const int n_per_pe = hunt.n_elements * hunt.n_rounds;
    for (int i = 0; i < hunt.n_elements; ++i)
      hunt.array[{i, 0, 1}].send<&Tourist::note>(pe().value * n_per_pe + round * hunt.n_elements +
                                                 i);
    if (round + 1 < hunt.n_rounds) group()[pe()].send<&Hunter::hunt>(hunt, round + 1);
  }
};

}  // namespace

void tour(Trial& trial) {
  Chase here{trial};
  chase = &here;
  const int n = trial.draw(1, 20), n_rounds = trial.draw(1, 10);
  here.delivered.assign(static_cast<std::size_t>(trial.n_pes() * n * n_rounds), 0);
  trial.run_clean([&] {
    const auto array = tess::create<Tourist>(range(n, 1, 2));
    const auto hunters = create_group<Hunter>();
    for (int i = 0; i < n; ++i) array[{i, 0, 1}].send<&Tourist::visit>(0);
    hunters.broadcast<&Hunter::hunt>(Hunt{array, n, n_rounds}, 0);
  });
  trial.expect(here.n_finished == n, here.n_finished, " of ", n, " tours ended");
  for (std::size_t i = 0; i < here.delivered.size(); ++i)
    trial.expect(here.delivered[i] == 1, "message ", i, " was delivered ", here.delivered[i],
                 " times");
}

}  // namespace tess::fuzz
