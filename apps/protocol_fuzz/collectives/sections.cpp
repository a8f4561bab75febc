// Sections that overlap, each with several multicasts and reductions under way, while their members
// migrate, are created late and are destroyed. The oracle: each member receives each multicast of
// its section once and in one order, as long as it lives; result r of a section has the r-th
// contribution of each of its members, of all that did not end before.
#include "apps/protocol_fuzz/scenarios.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace tess::fuzz {
namespace {

struct Item {
  std::int32_t index = 0;
  std::int32_t nth = 0;  // of its contributions to the section
};

class Caller;
class Singer;

struct Score {
  std::vector<std::int32_t> list;        // indices
  bool starts_by_messages = false;       // reduction 0 is contributed to before any multicast
  int n_rounds = 0, depth = 1;           // multicasts, and how many are under way at once
  bool ends = false;                     // destroyed after its last result
  std::map<int, int> order{};            // of the multicasts: place -> round
  std::map<int, std::set<int>> met{};    // place -> indices
  std::map<int, std::set<int>> given{};  // reduction -> indices
  std::set<int> results{};
  int n_results = 0;
};
struct Concert {
  Trial& trial;
  std::uint64_t seed = 0;
  double move_chance = 0, late_chance = 0, end_chance = 0;
  std::mutex mutex{};
  std::vector<Score> scores{};
  std::map<int, std::map<int, int>> ended{};  // index -> section -> multicasts met
  std::map<int, int> n_messages{};            // index -> how many it gets at the start
  GroupProxy<Caller> callers{};
};
Concert* concert = nullptr;

struct Cue {
  SectionProxy<Singer> section;
  std::int32_t number = 0;  // of the section
  std::int32_t round = 0;
};

class Singer : public Chare<Singer, Index1> {
 public:
  void sing(Cue cue) {
    const int me = index().x;
    const int place = next_[cue.number]++;
    {
      const std::lock_guard lock(concert->mutex);
      Score& score = concert->scores[static_cast<std::size_t>(cue.number)];
      // The first member that gets so far says which is the next.
      const int round = score.order.emplace(place, cue.round).first->second;
      concert->trial.expect(round == cue.round, "section ", cue.number, ": element ", me,
                            " receives multicast ", cue.round, " in the place of ", round);
      concert->trial.expect(score.met[place].insert(me).second, "section ", cue.number,
                            ": element ", me, " receives multicast ", cue.round, " twice");
    }
    Random random = draws(cue, 1);
    if (random.chance(concert->move_chance)) move(random);
    if (random.chance(concert->late_chance)) {
      ++n_late_;
      self().send<&Singer::give_late>(cue);
    } else {
      give(cue);
      end(random);
    }
  }
  void give_late(Cue cue) {
    --n_late_;
    give(cue);
    Random random = draws(cue, 2);
    if (random.chance(concert->move_chance)) move(random);
    end(random);
  }
  /// A message to each index, sent right after the section was made.
  void begin(Cue cue) {
    ++n_begun_;
    give(cue);
    Random random = draws(cue, 3);
    if (random.chance(concert->move_chance)) move(random);
    end(random);
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(next_, given_, n_late_, n_begun_);
  }

 private:
  [[nodiscard]] Random draws(const Cue& cue, int what) const {
    return Random(
        mix(concert->seed ^ mix(static_cast<std::uint64_t>(
                                ((cue.number * 4 + what) * 1000 + cue.round) * 1000 + index().x))));
  }
  void give(const Cue& cue);
  void move(Random& random) { migrate_to(any_pe(random)); }
  void end(Random& random) {
    if (index().x == 0 || n_late_ != 0 || !random.chance(concert->end_chance)) return;
    const std::lock_guard lock(concert->mutex);
    // Messages to it would be dead letters.
    const auto expected = concert->n_messages.find(index().x);
    if (expected != concert->n_messages.end() && n_begun_ != expected->second) return;
    if (!concert->ended.emplace(index().x, next_).second) return;
    destroy();
  }

  std::map<int, int> next_, given_;  // by section: the next multicast, and contributions
  int n_late_ = 0, n_begun_ = 0;
};

/// Makes a section, on any PE, and starts its multicasts.
class Caller : public Group<Caller> {
 public:
  void begin(ArrayProxy<Singer> singers, std::int32_t number) {
    Score& score = concert->scores[static_cast<std::size_t>(number)];
    std::vector<Index1> indices;
    for (const std::int32_t index : score.list) indices.push_back({index});
    Part& part = parts_[number];
    part.section = create_section(singers, indices);
    if (score.starts_by_messages)
      for (const Index1& index : indices)
        singers[index].send<&Singer::begin>(Cue{part.section, number, -1});
    for (int i = 0; i < score.depth; ++i) call(number, part);
  }
  struct Result {
    std::int32_t number = 0;
    std::vector<Item> items;
  };
  void result(Result result) {
    Part& part = parts_.at(result.number);
    Score& score = concert->scores[static_cast<std::size_t>(result.number)];
    {
      const std::lock_guard lock(concert->mutex);
      const int round = result.items.front().nth;  // results may arrive in any order
      concert->trial.expect(score.results.insert(round).second, "section ", result.number,
                            ": a second result ", round);
      ++score.n_results;
      std::set<int> indices;
      bool sorted = true, in_time = true;
      for (const Item& item : result.items) {
        sorted = sorted && (indices.empty() || *indices.rbegin() < item.index);
        in_time = in_time && item.nth == round;
        indices.insert(item.index);
      }
      concert->trial.expect(sorted, "section ", result.number, ": result ", round,
                            " is not in order, or has a contribution twice");
      concert->trial.expect(in_time, "section ", result.number, ": result ", round,
                            " has contributions to another");
      concert->trial.expect(indices == score.given[round], "section ", result.number, ": result ",
                            round, " has ", indices.size(), " contributions of ",
                            score.given[round].size());
      for (const int index : score.list)
        concert->trial.expect(indices.contains(index) || concert->ended.contains(index), "section ",
                              result.number, ": result ", round, " without ", index);
    }
    if (part.n_called < score.n_rounds) return call(result.number, part);
    if (score.ends && score.n_results == score.n_rounds + (score.starts_by_messages ? 1 : 0))
      part.section.destroy();
  }

 private:
  struct Part {
    SectionProxy<Singer> section;
    int n_called = 0;
  };
  void call(std::int32_t number, Part& part) {
    if (part.n_called < concert->scores[static_cast<std::size_t>(number)].n_rounds)
      part.section.broadcast<&Singer::sing>(Cue{part.section, number, part.n_called++});
  }
  std::map<int, Part> parts_;
};

struct Append {
  Caller::Result operator()(Caller::Result a, const Caller::Result& b) const {
    a.items.insert(a.items.end(), b.items.begin(), b.items.end());
    return a;
  }
};

void Singer::give(const Cue& cue) {
  const int nth = given_[cue.number]++;
  {
    const std::lock_guard lock(concert->mutex);
    auto& given = concert->scores[static_cast<std::size_t>(cue.number)].given[nth];
    concert->trial.expect(given.insert(index().x).second, "section ", cue.number, ": element ",
                          index().x, " contributes twice to ", nth);
  }
  const PeId pe{cue.number % tess::n_pes()};
  contribute(cue.section, in_order(Append{}), Caller::Result{cue.number, {Item{index().x, nth}}},
             concert->callers[pe].target<&Caller::result>());
}

void play(int n_first, int n_indices) {
  const auto singers = tess::create<Singer>(range(n_first));
  concert->callers = create_group<Caller>();
  for (std::size_t s = 0; s < concert->scores.size(); ++s) {
    const auto number = static_cast<std::int32_t>(s);
    concert->callers[PeId{number % tess::n_pes()}].send<&Caller::begin>(singers, number);
  }
  for (int index = n_first; index < n_indices; ++index) singers[{index}].insert();
}

}  // namespace

void sections(Trial& trial) {
  Concert here{trial, trial.random()()};
  concert = &here;
  const int n_first = trial.draw(1, 20), n_indices = n_first + trial.draw(0, 1) * trial.draw(0, 5);
  const bool long_run = trial.seed() % 50 == 0;
  here.move_chance = trial.draw(0, 2) * 0.3;
  here.late_chance = trial.draw(0, 2) * 0.3;
  here.end_chance = trial.draw(0, 1) * (long_run ? 0.002 : 0.1) * trial.random().unit();
  const int n_sections = trial.draw(1, 6);
  for (int s = 0; s < n_sections; ++s) {
    Score score;
    const double share = trial.random().unit();
    score.list.push_back(0);  // it never ends, so that each reduction has a result
    for (int index = 1; index < n_indices; ++index)
      if (trial.random().chance(share)) score.list.push_back(index);
    score.starts_by_messages = trial.draw(0, 1) == 1;
    score.n_rounds = long_run ? 100 : trial.draw(1, 12);
    score.depth = trial.draw(1, 4);
    score.ends = trial.draw(0, 1) == 1;
    if (score.starts_by_messages)
      for (const int index : score.list) ++here.n_messages[index];
    here.scores.push_back(std::move(score));
  }
  trial.run_clean([&] { play(n_first, n_indices); });
  for (std::size_t s = 0; s < here.scores.size(); ++s) {
    Score& score = here.scores[s];
    const int n_results = score.n_rounds + (score.starts_by_messages ? 1 : 0);
    trial.expect(score.n_results == n_results, "section ", s, ": ", score.n_results, " results of ",
                 n_results);
    std::set<int> rounds;
    for (const auto& [place, round] : score.order) rounds.insert(round);
    trial.expect(rounds.size() == static_cast<std::size_t>(score.n_rounds), "section ", s, ": ",
                 rounds.size(), " different multicasts of ", score.n_rounds);
    for (int round = 0; round < score.n_rounds; ++round) {
      for (const int index : score.list) {
        const auto end = here.ended.find(index);
        const bool met = end == here.ended.end() || end->second[static_cast<int>(s)] > round;
        trial.expect(score.met[round].contains(index) == met, "section ", s, ": element ", index,
                     met ? " misses multicast " : " receives after its end ", round);
      }
    }
  }
}

}  // namespace tess::fuzz
