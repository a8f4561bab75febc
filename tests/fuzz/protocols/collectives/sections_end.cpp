// Sections that end in mid-use, on any PE and twice at once: with multicasts and contributions
// under way, before their elements have joined, or with an index that never has one. The oracle:
// what is delivered until then is right (each member receives each multicast at most once and in
// one order, a result has all members), the epoch in which a section ends returns, and later
// sections of the same elements lack nothing.
#include "runtime/more/section.hpp"
#include "tests/fuzz/protocols/scenarios.hpp"

#include <map>
#include <set>

namespace tess::fuzz {
namespace {

class EndingMember;

struct SectionEndRecord {
  std::uint64_t seed = 0;
  int n_elements = 0, n_rounds = 0;
  double move_chance = 0, end_chance = 0;
  std::map<int, std::map<int, int>> order{};          // turn -> place -> round
  std::map<int, std::map<int, std::set<int>>> met{};  // turn -> round -> indices
};
SectionEndRecord* section_end_record = nullptr;

struct Multicast {
  SectionProxy<EndingMember> section;
  Callback<std::vector<std::pair<Index1, std::int32_t>>> result;
  std::int32_t turn = 0;
  std::int32_t round = 0;
  bool may_end = false;
};

class EndingMember : public Chare<EndingMember, Index1> {
 public:
  void receive(Multicast multicast) {
    const int me = index().x;
    const int place = next_[multicast.turn]++;
    {
      const std::lock_guard lock(oracle);
      const int round =
          section_end_record->order[multicast.turn].emplace(place, multicast.round).first->second;
      expect(round == multicast.round, "turn ", multicast.turn, ": element ", me,
             " receives multicast ", multicast.round, " in the place of ", round);
      expect(section_end_record->met[multicast.turn][multicast.round].insert(me).second, "turn ",
             multicast.turn, ": element ", me, " receives multicast ", multicast.round, " twice");
    }
    contribute(multicast.section, gather, place, multicast.result);
    Random random(
        mix(section_end_record->seed ^
            static_cast<std::uint64_t>((multicast.turn * 100 + multicast.round) * 1000 + me)));
    if (multicast.may_end && random.chance(section_end_record->end_chance))
      multicast.section.destroy();
    if (random.chance(section_end_record->move_chance)) migrate_to(any_pe(random));
  }
  void serialize(auto& ar) { ar(next_); }

 private:
  std::map<int, int> next_;  // by turn
};

/// Receives the results of a turn, on PE 0.
class ResultTaker : public Group<ResultTaker> {
 public:
  void result(std::vector<std::pair<Index1, std::int32_t>> items) {
    const std::lock_guard lock(oracle);
    expect(items.size() == static_cast<std::size_t>(section_end_record->n_elements), "a result of ",
           items.size(), " members, of ", section_end_record->n_elements);
    std::set<std::int32_t> nth;
    for (const auto& [index, place] : items) nth.insert(place);
    expect(nth.size() == 1, "a result has contributions to several");
    ++n_results;
  }
  void end(SectionProxy<EndingMember> section) { section.destroy(); }
  int n_results = 0;
};

Task run_turns(int n_turns) {
  const auto elements = tess::create<EndingMember>(range(section_end_record->n_elements));
  const auto takers = create<ResultTaker>(each_pe);
  std::vector<Index1> all;
  for (int x = 0; x < section_end_record->n_elements; ++x) all.push_back({x});
  for (int turn = 0; turn < n_turns; ++turn) {
    const bool cut = turn + 1 < n_turns;  // the last turn is rowed to its end
    Random random(mix(section_end_record->seed + static_cast<std::uint64_t>(turn)));
    const bool lacks_one = cut && random.chance(0.3);
    std::vector<Index1> list = all;
    if (lacks_one) list.push_back({section_end_record->n_elements + turn});
    const int n_before = takers.local().n_results;
    co_await epoch([&] {
      const auto section = create_section(elements, list);
      const auto target = takers[PeId{0}].target<&ResultTaker::result>();
      for (int round = 0; round < section_end_record->n_rounds; ++round)
        section.broadcast<&EndingMember::receive>(Multicast{section, target, turn, round, cut});
      if (cut && random.chance(0.5)) {
        section.destroy();
      } else if (lacks_one) {
        takers[any_pe(random)].send<&ResultTaker::end>(section);
      }
    });
    if (cut) continue;
    for (int round = 0; round < section_end_record->n_rounds; ++round)
      expect(section_end_record->met[turn][round].size() ==
                 static_cast<std::size_t>(section_end_record->n_elements),
             "the last turn lacks a call of multicast ", round);
    const int n = takers.local().n_results - n_before;
    expect(n == section_end_record->n_rounds, n, " results came of the last turn, which has ",
           section_end_record->n_rounds);
  }
}

}  // namespace

void sections_end(Case& test) {
  SectionEndRecord here{test.random(), test.draw(1, 20), test.draw(1, 8)};
  here.move_chance = test.draw(0, 2) * 0.3;
  here.end_chance = test.draw(0, 2) * 0.1;
  section_end_record = &here;
  const int n_turns = test.draw(2, 5);
  const Result result = test.run([&]() -> Task { return run_turns(n_turns); });
  expect_exit(result);
  // What is dropped with a section is counted.
  expect(result.report.empty() || (n_not_delivered(result) > 0), "report: ", result.failure());
}

}  // namespace tess::fuzz
