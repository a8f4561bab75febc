// Sections that overlap, each with several multicasts and reductions under way, while their members
// migrate, are created late and are destroyed. The oracle: each member receives each multicast of
// its section once and in one order, as long as it lives; result r of a section has the r-th
// contribution of each of its members, of all that did not end before.
#include "runtime/more/section.hpp"
#include "tests/fuzz/protocols/scenarios.hpp"

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
class SectionMember;

struct SectionState {
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
struct SectionRecord {
  std::uint64_t seed = 0;
  double move_chance = 0, late_chance = 0, end_chance = 0;
  std::vector<SectionState> sections{};
  std::map<int, std::map<int, int>> ended{};  // index -> section -> multicasts met
  std::map<int, int> n_messages{};            // index -> how many it gets at the start
  GroupProxy<Caller> callers{};
};
SectionRecord* section_record = nullptr;

struct Call {
  SectionProxy<SectionMember> section;
  std::int32_t number = 0;  // of the section
  std::int32_t round = 0;
};

class SectionMember : public Chare<SectionMember, Index1> {
 public:
  void receive(Call call) {
    const int me = index().x;
    const int place = next_[call.number]++;
    {
      const std::lock_guard lock(oracle);
      SectionState& of = section_record->sections[static_cast<std::size_t>(call.number)];
      // The first member that gets so far says which is the next.
      const int round = of.order.emplace(place, call.round).first->second;
      expect(round == call.round, "section ", call.number, ": element ", me, " receives multicast ",
             call.round, " in the place of ", round);
      expect(of.met[place].insert(me).second, "section ", call.number, ": element ", me,
             " receives multicast ", call.round, " twice");
    }
    Random random = draws(call, 1);
    if (random.chance(section_record->move_chance)) move(random);
    if (random.chance(section_record->late_chance)) {
      ++n_late_;
      self().send<&SectionMember::give_late>(call);
    } else {
      give(call);
      end(random);
    }
  }
  void give_late(Call call) {
    --n_late_;
    give(call);
    Random random = draws(call, 2);
    if (random.chance(section_record->move_chance)) move(random);
    end(random);
  }
  /// A message to each index, sent right after the section was made.
  void begin(Call call) {
    ++n_begun_;
    give(call);
    Random random = draws(call, 3);
    if (random.chance(section_record->move_chance)) move(random);
    end(random);
  }

  void serialize(auto& ar) { ar(next_, given_, n_late_, n_begun_); }

 private:
  [[nodiscard]] Random draws(const Call& call, int what) const {
    return Random(mix(section_record->seed ^
                      mix(static_cast<std::uint64_t>(
                          ((call.number * 4 + what) * 1000 + call.round) * 1000 + index().x))));
  }
  void give(const Call& call);
  void move(Random& random) { migrate_to(any_pe(random)); }
  void end(Random& random) {
    if (index().x == 0 || n_late_ != 0 || !random.chance(section_record->end_chance)) return;
    const std::lock_guard lock(oracle);
    // Messages to it would be dead letters.
    const auto expected = section_record->n_messages.find(index().x);
    if (expected != section_record->n_messages.end() && n_begun_ != expected->second) return;
    if (!section_record->ended.emplace(index().x, next_).second) return;
    destroy();
  }

  std::map<int, int> next_, given_;  // by section: the next multicast, and contributions
  int n_late_ = 0, n_begun_ = 0;
};

/// Makes a section, on any PE, and starts its multicasts.
class Caller : public Group<Caller> {
 public:
  void begin(ArrayProxy<SectionMember> elements, std::int32_t number) {
    SectionState& of = section_record->sections[static_cast<std::size_t>(number)];
    std::vector<Index1> indices;
    for (const std::int32_t index : of.list) indices.push_back({index});
    Part& part = parts_[number];
    part.section = create_section(elements, indices);
    if (of.starts_by_messages)
      for (const Index1& index : indices)
        elements[index].send<&SectionMember::begin>(Call{part.section, number, -1});
    for (int i = 0; i < of.depth; ++i) call(number, part);
  }
  struct Result {
    std::int32_t number = 0;
    std::vector<Item> items;
  };
  void result(Result result) {
    Part& part = parts_.at(result.number);
    SectionState& of = section_record->sections[static_cast<std::size_t>(result.number)];
    {
      const std::lock_guard lock(oracle);
      const int round = result.items.front().nth;  // results may arrive in any order
      expect(of.results.insert(round).second, "section ", result.number, ": a second result ",
             round);
      ++of.n_results;
      std::set<int> indices;
      bool sorted = true, in_time = true;
      for (const Item& item : result.items) {
        sorted = sorted && (indices.empty() || *indices.rbegin() < item.index);
        in_time = in_time && item.nth == round;
        indices.insert(item.index);
      }
      expect(sorted, "section ", result.number, ": result ", round,
             " is not in order, or has a contribution twice");
      expect(in_time, "section ", result.number, ": result ", round,
             " has contributions to another");
      expect(indices == of.given[round], "section ", result.number, ": result ", round, " has ",
             indices.size(), " contributions of ", of.given[round].size());
      for (const int index : of.list)
        expect(indices.contains(index) || section_record->ended.contains(index), "section ",
               result.number, ": result ", round, " without ", index);
    }
    if (part.n_called < of.n_rounds) return call(result.number, part);
    if (of.ends && of.n_results == of.n_rounds + (of.starts_by_messages ? 1 : 0))
      part.section.destroy();
  }

 private:
  struct Part {
    SectionProxy<SectionMember> section;
    int n_called = 0;
  };
  void call(std::int32_t number, Part& part) {
    if (part.n_called < section_record->sections[static_cast<std::size_t>(number)].n_rounds)
      part.section.broadcast<&SectionMember::receive>(Call{part.section, number, part.n_called++});
  }
  std::map<int, Part> parts_;
};

struct Append {
  Caller::Result operator()(Caller::Result a, const Caller::Result& b) const {
    a.items.insert(a.items.end(), b.items.begin(), b.items.end());
    return a;
  }
};

void SectionMember::give(const Call& call) {
  const int nth = given_[call.number]++;
  {
    const std::lock_guard lock(oracle);
    auto& given = section_record->sections[static_cast<std::size_t>(call.number)].given[nth];
    expect(given.insert(index().x).second, "section ", call.number, ": element ", index().x,
           " contributes twice to ", nth);
  }
  const PeId pe{call.number % tess::n_pes()};
  contribute(call.section, in_order(Append{}), Caller::Result{call.number, {Item{index().x, nth}}},
             section_record->callers[pe].target<&Caller::result>());
}

void begin_all(int n_first, int n_indices) {
  const auto elements = tess::create<SectionMember>(range(n_first));
  section_record->callers = create<Caller>(each_pe);
  for (std::size_t s = 0; s < section_record->sections.size(); ++s) {
    const auto number = static_cast<std::int32_t>(s);
    section_record->callers[PeId{number % tess::n_pes()}].send<&Caller::begin>(elements, number);
  }
  for (int index = n_first; index < n_indices; ++index) elements[{index}].insert();
}

}  // namespace

void sections(Case& test) {
  SectionRecord here{test.random()};
  section_record = &here;
  const int n_first = test.draw(1, 20), n_indices = n_first + test.draw(0, 1) * test.draw(0, 5);
  const bool long_run = test.seed % 50 == 0;
  here.move_chance = test.draw(0, 2) * 0.3;
  here.late_chance = test.draw(0, 2) * 0.3;
  here.end_chance = test.draw(0, 1) * (long_run ? 0.002 : 0.1) * test.random.unit();
  const int n_sections = test.draw(1, 6);
  for (int s = 0; s < n_sections; ++s) {
    SectionState of;
    const double share = test.random.unit();
    of.list.push_back(0);  // it never ends, so that each reduction has a result
    for (int index = 1; index < n_indices; ++index)
      if (test.random.chance(share)) of.list.push_back(index);
    of.starts_by_messages = test.draw(0, 1) == 1;
    of.n_rounds = long_run ? 100 : test.draw(1, 12);
    of.depth = test.draw(1, 4);
    of.ends = test.draw(0, 1) == 1;
    if (of.starts_by_messages)
      for (const int index : of.list) ++here.n_messages[index];
    here.sections.push_back(std::move(of));
  }
  test.run_clean([&] { begin_all(n_first, n_indices); });
  for (std::size_t s = 0; s < here.sections.size(); ++s) {
    SectionState& of = here.sections[s];
    const int n_results = of.n_rounds + (of.starts_by_messages ? 1 : 0);
    expect(of.n_results == n_results, "section ", s, ": ", of.n_results, " results of ", n_results);
    std::set<int> rounds;
    for (const auto& [place, round] : of.order) rounds.insert(round);
    expect(rounds.size() == static_cast<std::size_t>(of.n_rounds), "section ", s, ": ",
           rounds.size(), " different multicasts of ", of.n_rounds);
    for (int round = 0; round < of.n_rounds; ++round) {
      for (const int index : of.list) {
        const auto end = here.ended.find(index);
        const bool met = end == here.ended.end() || end->second[static_cast<int>(s)] > round;
        expect(of.met[round].contains(index) == met, "section ", s, ": element ", index,
               met ? " misses multicast " : " receives after its end ", round);
      }
    }
  }
}

}  // namespace tess::fuzz
