// Sections that end in mid-use, on any PE and twice at once: with multicasts and contributions
// under way, before their elements have joined, or with an index that never has one. The oracle:
// what is delivered until then is right (each member receives each multicast at most once and in
// one order, a result has all members), the epoch in which a section ends returns, and later
// sections of the same elements lack nothing.
#include "apps/protocol_fuzz/scenarios.hpp"

#include <map>
#include <set>

namespace tess::fuzz {
namespace {

class Rower;

struct Race {
  Trial& trial;
  std::uint64_t seed = 0;
  int n_elements = 0, n_rounds = 0;
  double move_chance = 0, end_chance = 0;
  std::mutex mutex{};
  std::map<int, std::map<int, int>> order{};          // heat -> place -> round
  std::map<int, std::map<int, std::set<int>>> met{};  // heat -> round -> indices
};
Race* race = nullptr;

struct Stroke {
  SectionProxy<Rower> section;
  Callback<std::vector<std::pair<Index1, std::int32_t>>> result;
  std::int32_t heat = 0;
  std::int32_t round = 0;
  bool may_end = false;
};

class Rower : public Chare<Rower, Index1> {
 public:
  void row(Stroke stroke) {
    const int me = index().x;
    const int place = next_[stroke.heat]++;
    {
      const std::lock_guard lock(race->mutex);
      const int round = race->order[stroke.heat].emplace(place, stroke.round).first->second;
      race->trial.expect(round == stroke.round, "heat ", stroke.heat, ": element ", me,
                         " receives multicast ", stroke.round, " in the place of ", round);
      race->trial.expect(race->met[stroke.heat][stroke.round].insert(me).second, "heat ",
                         stroke.heat, ": element ", me, " receives multicast ", stroke.round,
                         " twice");
    }
    contribute(stroke.section, gather, place, stroke.result);
    Random random(mix(race->seed ^
                      static_cast<std::uint64_t>((stroke.heat * 100 + stroke.round) * 1000 + me)));
    if (stroke.may_end && random.chance(race->end_chance)) stroke.section.destroy();
    if (random.chance(race->move_chance)) migrate_to(any_pe(random));
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(next_);
  }

 private:
  std::map<int, int> next_;  // by heat
};

/// Receives the results of a heat, on PE 0.
class Umpire : public Group<Umpire> {
 public:
  void result(std::vector<std::pair<Index1, std::int32_t>> items) {
    const std::lock_guard lock(race->mutex);
    race->trial.expect(items.size() == static_cast<std::size_t>(race->n_elements), "a result of ",
                       items.size(), " members, of ", race->n_elements);
    std::set<std::int32_t> nth;
    for (const auto& [index, place] : items) nth.insert(place);
    race->trial.expect(nth.size() == 1, "a result has contributions to several");
    ++n_results;
  }
  void end(SectionProxy<Rower> section) { section.destroy(); }
  int n_results = 0;
};

Task row_heats(int n_heats) {
  const auto rowers = tess::create<Rower>(range(race->n_elements));
  const auto umpires = create_group<Umpire>();
  std::vector<Index1> all;
  for (int x = 0; x < race->n_elements; ++x) all.push_back({x});
  for (int heat = 0; heat < n_heats; ++heat) {
    const bool cut = heat + 1 < n_heats;  // the last heat is rowed to its end
    Random random(mix(race->seed + static_cast<std::uint64_t>(heat)));
    const bool lacks_one = cut && random.chance(0.3);
    std::vector<Index1> list = all;
    if (lacks_one) list.push_back({race->n_elements + heat});
    const int n_before = umpires.local().n_results;
    co_await epoch([&] {
      const auto section = create_section(rowers, list);
      const auto target = umpires[PeId{0}].target<&Umpire::result>();
      for (int round = 0; round < race->n_rounds; ++round)
        section.broadcast<&Rower::row>(Stroke{section, target, heat, round, cut});
      if (cut && random.chance(0.5)) {
        section.destroy();
      } else if (lacks_one) {
        umpires[any_pe(random)].send<&Umpire::end>(section);
      }
    });
    if (cut) continue;
    for (int round = 0; round < race->n_rounds; ++round)
      race->trial.expect(
          race->met[heat][round].size() == static_cast<std::size_t>(race->n_elements),
          "the last heat lacks a call of multicast ", round);
    const int n = umpires.local().n_results - n_before;
    race->trial.expect(n == race->n_rounds, n, " results came of the last heat, which has ",
                       race->n_rounds);
  }
}

}  // namespace

void sections_end(Trial& trial) {
  Race here{trial, trial.random()(), trial.draw(1, 20), trial.draw(1, 8)};
  here.move_chance = trial.draw(0, 2) * 0.3;
  here.end_chance = trial.draw(0, 2) * 0.1;
  race = &here;
  const int n_heats = trial.draw(2, 5);
  const Ending ending = trial.run([&]() -> Task { return row_heats(n_heats); });
  trial.expect(ending.exit_code == 0, "exit code ", ending.exit_code, "; ", ending.report);
  // What is dropped with a section is counted.
  trial.expect(ending.report.empty() || ending.report.ends_with("not delivered\n"),
               "report: ", ending.report);
}

}  // namespace tess::fuzz
