// Scans over elements that a map places and that migrate, are created in the middle of a step and
// end, with several scans under way at once.
//
// The operation joins lists of (index, number of the element's contribution), so that each result
// names the contributions it is made of. The oracle: put in the order of indices, the results of
// one scan grow by one contribution each, that of the element itself, and each contribution has one
// result.
#include "runtime/more/index_map.hpp"
#include "runtime/more/scan.hpp"
#include "runtime/more/when.hpp"
#include "tests/fuzz/protocols/scenarios.hpp"

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

struct ScanRecord {
  std::uint64_t seed = 0;
  double move_chance = 0, create_chance = 0, end_chance = 0;
  std::atomic<std::int32_t> n_indices{0};
  std::atomic<int> n_given{0};  // contributions of a step, in this process
  std::vector<List> results{};  // inclusive: the last one is the element's own contribution
};
ScanRecord* scan_record = nullptr;

void note(List result) {
  locked([&] { scan_record->results.push_back(std::move(result)); });
}

struct Step {
  std::int32_t number = 0;
  std::int32_t n_scans = 0;
};

class Scanner : public Chare<Scanner, Index1> {
 public:
  Task run(Step step) {
    const int me = index().x;
    const bool may_end = me % 3 != 0;
    Random random(
        mix(scan_record->seed ^ mix(static_cast<std::uint64_t>(step.number * 1000 + me))));
    if (random.chance(scan_record->create_chance)) array()[{scan_record->n_indices++}].insert();
    std::deque<Future<List>> before;
    std::vector<Given> own;
    for (std::int32_t scan = 0; scan < step.n_scans; ++scan) {
      const Given mine{me, n_given_++};
      ++scan_record->n_given;
      // Equal for all elements.
      Random kind(mix(scan_record->seed + static_cast<std::uint64_t>(step.number * 100 + scan)));
      const bool one_by_one = kind.chance(0.3);
      if (kind.chance(0.5)) {
        const auto target = may_end || random.chance(0.3) ? array()[{0}].target<&Scanner::placed>()
                                                          : self().target<&Scanner::placed>();
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
    if (random.chance(scan_record->move_chance)) migrate_to(any_pe(random));
    for (std::size_t i = 0; i < before.size(); ++i) {
      List result = co_await before[i];
      expect(!result.empty() && result.front() == firsts_[i],
             "an exclusive scan does not begin with its first value");
      result.erase(result.begin());
      result.push_back(own[i]);
      note(std::move(result));
    }
    firsts_.clear();
    if (may_end && random.chance(scan_record->end_chance)) destroy();
  }
  void placed(List result) { note(std::move(result)); }

  void serialize(auto& ar) { ar(n_given_, firsts_); }

 private:
  std::int32_t n_given_ = 0;
  List firsts_;
};

PeId last_pe(Index1 /*index*/, std::int32_t n_pes) {
  return PeId{n_pes - 1};
}

ArrayProxy<Scanner> create_scanners(std::int32_t n, std::uint64_t draw) {
  const Range of = range(n);
  switch (draw % 6) {
    case 0:
      return create<Scanner>(mapped(of, block));
    case 1:
      return create<Scanner>(mapped(of, round_robin));
    case 2:
      return create<Scanner>(mapped<&last_pe>(of));
    case 3:
      return create<Scanner>(of);
    default:
      return create<Scanner>(mapped(of, ByLot{draw}));
  }
}

/// The results of all scans of a step, which began with the scan of this number.
void check_step(std::int32_t first_scan, std::int32_t n_scans) {
  std::vector<List> results = std::exchange(scan_record->results, {});
  std::map<std::int32_t, std::vector<List>> by_scan;
  for (List& result : results) {
    expect(result.front().index == 0, "a result lacks the contribution of element 0");
    by_scan[result.front().nth].push_back(std::move(result));
  }
  expect(by_scan.size() == static_cast<std::size_t>(n_scans), by_scan.size(),
         " scans have results, not ", n_scans);
  std::set<Given> given;
  for (auto& [scan, of] : by_scan) {
    expect(scan >= first_scan && scan < first_scan + n_scans, "a result of scan ", scan,
           " comes late or early");
    std::sort(of.begin(), of.end(),
              [](const List& a, const List& b) { return a.back().index < b.back().index; });
    List all;
    for (const List& result : of) {
      all.push_back(result.back());
      expect(result == all, "element ", result.back().index, " gets ", result.size(),
             " contributions of scan ", scan, ", not the ", all.size(), " up to its own");
      expect(given.insert(result.back()).second, "a contribution has two results");
    }
  }
  const int n_given = scan_record->n_given.exchange(0);
  expect(given.size() == static_cast<std::size_t>(n_given), given.size(), " of ", n_given,
         " contributions have a result");
}

Task run_steps(std::int32_t n_scanners, std::uint64_t map, std::vector<std::int32_t> steps) {
  ArrayProxy<Scanner> scanners;
  co_await epoch([&] { scanners = create_scanners(n_scanners, map); });
  Step step;
  std::int32_t n_scans = 0;
  for (const std::int32_t of_step : steps) {
    step.n_scans = of_step;
    co_await epoch([&] { scanners.broadcast<&Scanner::run>(step); });
    check_step(n_scans, of_step);
    n_scans += of_step;
    ++step.number;
  }
}

}  // namespace

void scans(Case& test) {
  ScanRecord here{test.random(), 0.3 * test.draw(0, 2), 0.2 * test.draw(0, 2),
                  0.2 * test.draw(0, 2)};
  scan_record = &here;
  const std::int32_t n_scanners = test.draw(1, 30);
  here.n_indices = n_scanners;
  std::vector<std::int32_t> steps(static_cast<std::size_t>(test.draw(1, 4)));
  for (std::int32_t& n_scans : steps) n_scans = test.draw(1, 4);
  const std::uint64_t map = test.random();
  test.run_clean([&] { return run_steps(n_scanners, map, steps); });
}

}  // namespace tess::fuzz
