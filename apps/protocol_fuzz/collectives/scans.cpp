// Scans over elements that a map places and that migrate, are created in the middle of a step and
// end, with several scans under way at once.
//
// The operation joins lists of (index, number of the element's contribution), so that each result
// names the contributions it is made of. The oracle: put in the order of indices, the results of
// one scan grow by one contribution each, that of the element itself, and each contribution has one
// result.
#include "apps/protocol_fuzz/scenarios.hpp"
#include "runtime/index_map.hpp"
#include "runtime/scan.hpp"
#include "runtime/when.hpp"

#include <algorithm>
#include <atomic>
#include <deque>
#include <map>
#include <set>
#include <utility>

namespace tess::fuzz {
namespace {

struct Given {
  std::int32_t index = 0;
  std::int32_t nth = 0;  // of its contributions
  friend auto operator<=>(const Given&, const Given&) = default;
};
using List = std::vector<Given>;

struct Join {
  List operator()(List a, const List& b) const {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  }
};

struct Chain {
  Trial& trial;
  std::uint64_t seed = 0;
  double move_chance = 0, create_chance = 0, end_chance = 0;
  std::atomic<std::int32_t> n_indices{0};
  std::atomic<int> n_given{0};  // contributions of a leg, in this process
  std::mutex mutex{};
  std::vector<List> results{};  // inclusive: the last one is the element's own contribution
};
Chain* chain = nullptr;

void note(List result) {
  const std::lock_guard lock(chain->mutex);
  chain->results.push_back(std::move(result));
}

struct Leg {
  std::int32_t number = 0;
  std::int32_t n_scans = 0;
};

class Racer : public Chare<Racer, Index1> {
 public:
  Task run(Leg leg) {
    const int me = index().x;
    const bool mortal = me % 3 != 0;
    Random random(mix(chain->seed ^ mix(static_cast<std::uint64_t>(leg.number * 1000 + me))));
    if (random.chance(chain->create_chance)) array()[{chain->n_indices++}].insert();
    std::deque<Future<List>> before;
    std::vector<Given> own;
    for (std::int32_t scan = 0; scan < leg.n_scans; ++scan) {
      const Given mine{me, n_given_++};
      ++chain->n_given;
      // Equal for all elements.
      Random kind(mix(chain->seed + static_cast<std::uint64_t>(leg.number * 100 + scan)));
      const bool one_by_one = kind.chance(0.3);
      if (kind.chance(0.5)) {
        const auto target = mortal || random.chance(0.3) ? array()[{0}].target<&Racer::placed>()
                                                         : self().target<&Racer::placed>();
        if (one_by_one) {
          contribute(inclusive_scan(in_order(Join())), List{mine}, target);
        } else {
          contribute(inclusive_scan(Join()), List{mine}, target);
        }
        continue;
      }
      const List first{{-1, scan}};
      own.push_back(mine);
      before.emplace_back();
      if (one_by_one) {
        contribute(exclusive_scan(in_order(Join()), first), List{mine}, before.back().callback());
      } else {
        contribute(exclusive_scan(Join(), first), List{mine}, before.back().callback());
      }
      firsts_.push_back(first.front());
    }
    if (random.chance(chain->move_chance)) migrate_to(any_pe(random));
    for (std::size_t i = 0; i < before.size(); ++i) {
      List result = co_await before[i];
      chain->trial.expect(!result.empty() && result.front() == firsts_[i],
                          "an exclusive scan does not begin with its first value");
      result.erase(result.begin());
      result.push_back(own[i]);
      note(std::move(result));
    }
    firsts_.clear();
    if (mortal && random.chance(chain->end_chance)) destroy();
  }
  void placed(List result) { note(std::move(result)); }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(n_given_, firsts_);
  }

 private:
  std::int32_t n_given_ = 0;
  List firsts_;
};

PeId last_pe(Index1 /*index*/, std::int32_t n_pes) {
  return PeId{n_pes - 1};
}

ArrayProxy<Racer> create_runners(std::int32_t n, std::uint64_t draw) {
  const Range of = range(n);
  switch (draw % 6) {
    case 0:
      return create<Racer>(mapped(of, block));
    case 1:
      return create<Racer>(mapped(of, round_robin));
    case 2:
      return create<Racer>(mapped<&last_pe>(of));
    case 3:
      return create<Racer>(of);
    default:
      return create<Racer>(mapped(of, ByLot{draw}));
  }
}

/// The results of all scans of a leg, which began with the scan of this number.
void check_leg(std::int32_t first_scan, std::int32_t n_scans) {
  std::vector<List> results = std::exchange(chain->results, {});
  std::map<std::int32_t, std::vector<List>> by_scan;
  for (List& result : results) {
    chain->trial.expect(result.front().index == 0, "a result lacks the contribution of element 0");
    by_scan[result.front().nth].push_back(std::move(result));
  }
  chain->trial.expect(by_scan.size() == static_cast<std::size_t>(n_scans), by_scan.size(),
                      " scans have results, not ", n_scans);
  std::set<Given> given;
  for (auto& [scan, of] : by_scan) {
    chain->trial.expect(scan >= first_scan && scan < first_scan + n_scans, "a result of scan ",
                        scan, " comes late or early");
    std::sort(of.begin(), of.end(),
              [](const List& a, const List& b) { return a.back().index < b.back().index; });
    List all;
    for (const List& result : of) {
      all.push_back(result.back());
      chain->trial.expect(result == all, "element ", result.back().index, " gets ", result.size(),
                          " contributions of scan ", scan, ", not the ", all.size(),
                          " up to its own");
      chain->trial.expect(given.insert(result.back()).second, "a contribution has two results");
    }
  }
  const int n_given = chain->n_given.exchange(0);
  chain->trial.expect(given.size() == static_cast<std::size_t>(n_given), given.size(), " of ",
                      n_given, " contributions have a result");
}

Task run_legs(std::int32_t n_runners, std::uint64_t map, std::vector<std::int32_t> legs) {
  ArrayProxy<Racer> runners;
  co_await epoch([&] { runners = create_runners(n_runners, map); });
  Leg leg;
  std::int32_t n_scans = 0;
  for (const std::int32_t of_leg : legs) {
    leg.n_scans = of_leg;
    co_await epoch([&] { runners.broadcast<&Racer::run>(leg); });
    check_leg(n_scans, of_leg);
    n_scans += of_leg;
    ++leg.number;
  }
}

}  // namespace

void scans(Trial& trial) {
  Chain here{trial, trial.random()(), 0.3 * trial.draw(0, 2), 0.2 * trial.draw(0, 2),
             0.2 * trial.draw(0, 2)};
  chain = &here;
  const std::int32_t n_runners = trial.draw(1, 30);
  here.n_indices = n_runners;
  std::vector<std::int32_t> legs(static_cast<std::size_t>(trial.draw(1, 4)));
  for (std::int32_t& n_scans : legs) n_scans = trial.draw(1, 4);
  const std::uint64_t map = trial.random()();
  trial.run_clean([&] { return run_legs(n_runners, map, legs); });
}

}  // namespace tess::fuzz
