// The scenario all_at_once: its oracle, the chares that receive tokens, and the members of its
// sections. Each message that must arrive carries a token; the sums of tokens are compared.
#pragma once

#include "apps/protocol_fuzz/trial.hpp"
#include "runtime/index_map.hpp"
#include "runtime/interface.hpp"
#include "runtime/process_group.hpp"
#include "runtime/scan.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <set>

namespace tess::fuzz::city_life {

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

struct City {
  Trial& trial;
  std::uint64_t seed = 0;
  int n_citizens = 0, n_steps = 0;
  std::uint64_t longest = 0;  // ns of a deadline or delay
  double move_chance = 0, end_chance = 0;
  std::mutex mutex{};
  Count sent{};
  std::map<std::uint64_t, int> hops{};  // by epoch
  std::atomic<int> n_singers{0}, n_ticks_sent{0}, n_ticks{0}, n_cut{0}, n_ranked{0};
};
inline City* city = nullptr;

template <class... Parts>
void expect(bool holds, const Parts&... parts) {
  city->trial.expect(holds, parts...);
}
inline std::uint64_t answer_of(std::uint64_t question, int index) {
  return mix(question ^ static_cast<std::uint64_t>(index) << 40U);
}
inline bool refuses(std::uint64_t question) {
  return question % 5 == 0;
}
/// A number that must arrive, at so many elements.
inline std::uint64_t token(Random& random, int n_copies = 1) {
  const std::uint64_t drawn = random();
  const std::lock_guard lock(city->mutex);
  for (int i = 0; i < n_copies; ++i) city->sent.note(drawn);
  return drawn;
}
inline int draw(Random& random, int n) {
  return static_cast<int>(random.below(static_cast<std::uint64_t>(n)));
}
inline Time delay(Random& random) {
  return Time(static_cast<std::int64_t>(random.below(city->longest)));
}

// --- What receives tokens.

class Counting {
 public:
  void add(std::uint64_t token) { count_.note(token); }
  [[nodiscard]] Count count() const { return count_; }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(count_);
  }

 protected:
  Count count_;
};

class Spot : public Chare<Spot, std::string>, public Counting {
 public:
  void report(Callback<Count> target) { contribute(sum, count(), target); }
};

/// The single chare.
class Mayor : public Chare<Mayor>, public Counting {
 public:
  [[nodiscard]] std::uint64_t answer(std::uint64_t question) {
    add(question);
    return answer_of(question, -1);
  }
  void report(Callback<Count> target) { contribute(sum, count(), target); }
};

class Treasury : public Counting {};

/// What elements of two arrays are, so that they can be called alike.
class Resident {
 public:
  virtual ~Resident() = default;
  virtual void add(std::uint64_t token) = 0;
  [[nodiscard]] virtual std::uint64_t age(std::uint64_t question) = 0;
};

using Both = std::array<Count, 2>;  // the group's and the process group's

class Office : public Group<Office>, public Counting {
 public:
  void tick() { ++city->n_ticks; }
  void report(ProcessGroupProxy<Treasury> treasuries, Callback<Both> target) {
    const bool first = machine().is_first_of_process(pe());
    const Count treasury = treasuries.read([](const Treasury& one) { return one.count(); });
    contribute(sum, Both{count_, first ? treasury : Count{}}, target);
  }
  void absorb(Office&& other) { count_ = count_ + other.count_; }
};

// --- Members of sections.

using Chorus = std::vector<std::pair<Index1, std::int32_t>>;  // (index, which of its contributions)

/// A reduction with a finishing step.
struct HalfOfAll {
  int combine(int a, int b) const { return a + b; }
  double finish(int all) const { return 0.5 * all; }
};

class Singer;
struct Cue {
  SectionProxy<Singer> section;
  Callback<Chorus> result;
};

class Singer : public Chare<Singer, Index1>, public Resident {
 public:
  static bool is_mortal(int index) { return index % 3 != 0; }

  void add(std::uint64_t token) override { counted_.add(token); }
  [[nodiscard]] std::uint64_t age(std::uint64_t question) override {
    return answer_of(question, index().x);
  }
  void end() {
    if (!std::exchange(ends_, true)) --city->n_singers;
    destroy();
  }
  /// Contributes at once, or after it has asked another one. All members give their nth
  /// contribution to the target of the nth multicast.
  Task sing(Cue cue) {
    results_[cue.section].push_back(cue.result);
    Random random(mix(city->seed ^ static_cast<std::uint64_t>(index().x * 1000 + n_sung_++)));
    if (random.chance(0.3)) {
      const std::uint64_t question = random();
      const std::uint64_t answer = co_await array()[{0}].ask<&Singer::age>(question);
      expect(answer == answer_of(question, 0), "a member of a section gets another answer");
    }
    const std::int32_t nth = n_given_[cue.section]++;
    contribute(cue.section, gather, nth, results_[cue.section][static_cast<std::size_t>(nth)]);
    if (random.chance(city->move_chance)) migrate_to(any_pe(random));
  }
  void count(Callback<double> target) { contribute(HalfOfAll{}, 1, target); }
  void report(Callback<Count> target) { contribute(sum, counted_.count(), target); }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(counted_, results_, n_given_, n_sung_, ends_);
  }

 private:
  std::map<SectionProxy<Singer>, std::vector<Callback<Chorus>>> results_;
  std::map<SectionProxy<Singer>, std::int32_t> n_given_;
  Counting counted_;
  int n_sung_ = 0;
  bool ends_ = false;
};

/// One result: `members` are the indices of the section.
inline void check_chorus(const Chorus& chorus, const std::vector<Index1>& members) {
  std::set<int> found;
  for (const auto& [index, nth] : chorus) {
    expect(nth == chorus.front().second, "a result of a section has contributions to ", nth,
           " and ", chorus.front().second);
    expect(found.empty() || *found.rbegin() < index.x, "element ", index.x,
           " is in a result of a section twice, or not in order");
    found.insert(index.x);
  }
  std::size_t n_members = 0;
  for (const Index1& index : members) {
    n_members += found.count(index.x);
    expect(Singer::is_mortal(index.x) || found.contains(index.x), "a result of a section lacks ",
           index.x);
  }
  expect(n_members == found.size(), "a result of a section has contributions of others");
}
/// All results of a section.
inline void check_choruses(const std::vector<Chorus>& choruses, const std::vector<Index1>& members,
                           int first = 0) {
  std::set<int> numbers;
  for (const Chorus& chorus : choruses) {
    check_chorus(chorus, members);
    if (!chorus.empty()) numbers.insert(chorus.front().second);
  }
  expect(numbers.size() == choruses.size() && *numbers.begin() == first,
         "the results of a section are not those of its reductions");
}

}  // namespace tess::fuzz::city_life
