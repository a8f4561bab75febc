// The scenario all_at_once: its oracle, the chares that receive tokens, and the listed of its
// sections. Each message that must arrive carries a token; the sums of tokens are compared.
#pragma once

#include "runtime/more/index_map.hpp"
#include "runtime/more/interface.hpp"
#include "runtime/more/process_group.hpp"
#include "runtime/more/scan.hpp"
#include "runtime/more/section.hpp"
#include "tests/fuzz/protocols/case.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <set>

namespace tess::fuzz::all_kinds {

/// What arrived, or was sent.
struct Count {
  std::uint64_t n = 0, total = 0;
  void note(std::uint64_t token) {
    ++n;
    total += token >> 8U;
  }
  friend Count operator+(const Count& a, const Count& b) { return {a.n + b.n, a.total + b.total}; }
  friend bool operator==(const Count&, const Count&) = default;
};

struct Record {
  std::uint64_t seed = 0;
  int n_callers = 0, n_steps = 0;
  std::uint64_t longest = 0;  // ns of a deadline or delay
  double move_chance = 0, end_chance = 0;
  Count sent{};
  std::map<std::uint64_t, int> hops{};  // by epoch
  std::atomic<int> n_elements{0}, n_ticks_sent{0}, n_ticks{0}, n_cut{0}, n_ranked{0};
};
inline Record* record = nullptr;

inline std::uint64_t answer_of(std::uint64_t question, int index) {
  return mix(question ^ static_cast<std::uint64_t>(index) << 40U);
}
inline bool refuses(std::uint64_t question) {
  return question % 5 == 0;
}
/// A number that must arrive, at so many elements.
inline std::uint64_t token(Random& random, int n_copies = 1) {
  const std::uint64_t drawn = random();
  const std::lock_guard lock(oracle);
  for (int i = 0; i < n_copies; ++i) record->sent.note(drawn);
  return drawn;
}
inline Time delay(Random& random) {
  return any_time(random, record->longest);
}

// --- What receives tokens.

class Counting {
 public:
  void add(std::uint64_t token) { count_.note(token); }
  [[nodiscard]] Count count() const { return count_; }
  void serialize(auto& ar) { ar(count_); }

 protected:
  Count count_;
};

class OnDemand : public Chare<OnDemand, std::string>, public Counting {
 public:
  void report(Callback<Count> target) { contribute(sum, count(), target); }
};

/// The single chare.
class Single : public Chare<Single>, public Counting {
 public:
  [[nodiscard]] std::uint64_t answer(std::uint64_t question) {
    add(question);
    return answer_of(question, -1);
  }
  void report(Callback<Count> target) { contribute(sum, count(), target); }
};

class PerProcess : public Counting {};

/// What elements of two arrays are, so that they can be called alike.
class Addable {
 public:
  virtual ~Addable() = default;
  virtual void add(std::uint64_t token) = 0;
  [[nodiscard]] virtual std::uint64_t age(std::uint64_t question) = 0;
};

using Both = std::array<Count, 2>;  // the group's and the process group's

class PerPe : public Group<PerPe>, public Counting {
 public:
  void tick() { ++record->n_ticks; }
  void report(ProcessGroupProxy<PerProcess> per_process, Callback<Both> target) {
    const bool first = machine().is_first_of_process(pe());
    const Count its = per_process.read([](const PerProcess& one) { return one.count(); });
    contribute(sum, Both{count_, first ? its : Count{}}, target);
  }
  void absorb(PerPe&& other) { count_ = count_ + other.count_; }
};

// --- Members of sections.

using SectionResult =
    std::vector<std::pair<Index1, std::int32_t>>;  // (index, which of its contributions)

/// A reduction with a finishing step.
struct HalfOfAll {
  int combine(int a, int b) const { return a + b; }
  double finish(int all) const { return 0.5 * all; }
};

class SectionMember;
struct Multicast {
  SectionProxy<SectionMember> section;
  Callback<SectionResult> result;
};

class SectionMember : public Chare<SectionMember, Index1>, public Addable {
 public:
  static bool may_end(int index) { return index % 3 != 0; }

  void add(std::uint64_t token) override { counted_.add(token); }
  [[nodiscard]] std::uint64_t age(std::uint64_t question) override {
    return answer_of(question, index().x);
  }
  void end() {
    if (!std::exchange(ends_, true)) --record->n_elements;
    destroy();
  }
  /// Contributes at once, or after it has asked another one. All listed give their nth
  /// contribution to the target of the nth multicast.
  Task give(Multicast multicast) {
    results_[multicast.section].push_back(multicast.result);
    Random random(mix(record->seed ^ static_cast<std::uint64_t>(index().x * 1000 + n_called_++)));
    if (random.chance(0.3)) {
      const std::uint64_t question = random();
      const std::uint64_t answer = co_await array()[{0}].ask<&SectionMember::age>(question);
      expect(answer == answer_of(question, 0), "a member of a section gets another answer");
    }
    const std::int32_t nth = n_given_[multicast.section]++;
    contribute(multicast.section, gather, nth,
               results_[multicast.section][static_cast<std::size_t>(nth)]);
    if (random.chance(record->move_chance)) migrate_to(any_pe(random));
  }
  void count(Callback<double> target) { contribute(HalfOfAll{}, 1, target); }
  void report(Callback<Count> target) { contribute(sum, counted_.count(), target); }

  void serialize(auto& ar) { ar(counted_, results_, n_given_, n_called_, ends_); }

 private:
  std::map<SectionProxy<SectionMember>, std::vector<Callback<SectionResult>>> results_;
  std::map<SectionProxy<SectionMember>, std::int32_t> n_given_;
  Counting counted_;
  int n_called_ = 0;
  bool ends_ = false;
};

/// One result: `listed` are the indices of the section.
inline void check_result(const SectionResult& given, const std::vector<Index1>& listed) {
  std::set<int> found;
  for (const auto& [index, nth] : given) {
    expect(nth == given.front().second, "a result of a section has contributions to ", nth, " and ",
           given.front().second);
    expect(found.empty() || *found.rbegin() < index.x, "element ", index.x,
           " is in a result of a section twice, or not in order");
    found.insert(index.x);
  }
  std::size_t n_members = 0;
  for (const Index1& index : listed) {
    n_members += found.count(index.x);
    expect(SectionMember::may_end(index.x) || found.contains(index.x),
           "a result of a section lacks ", index.x);
  }
  expect(n_members == found.size(), "a result of a section has contributions of others");
}
/// All results of a section.
inline void check_results(const std::vector<SectionResult>& all_given,
                          const std::vector<Index1>& listed, int first = 0) {
  std::set<int> numbers;
  for (const SectionResult& given : all_given) {
    check_result(given, listed);
    if (!given.empty()) numbers.insert(given.front().second);
  }
  expect(numbers.size() == all_given.size() && *numbers.begin() == first,
         "the results of a section are not those of its reductions");
}

}  // namespace tess::fuzz::all_kinds
