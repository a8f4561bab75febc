// All means of control in one program, at the same time: replies with errors, deadlines, when_all
// and when_any, sections that are made, used and destroyed while their members migrate, are created
// and end, priorities and expedited messages, delayed sends and periodic timers, nested epochs,
// mailboxes, elements created on demand, a single chare, a group, a process group, read-only data,
// reductions, scans, a user-defined map, elements of two arrays behind one interface, and between
// the phases checkpoints, with a restart on another number of PEs.
//
// The oracle: each message that must arrive carries a token, and each element adds up the tokens
// that reached it. After each phase the sums over all collections equal the sum of what was sent.
// Replies are what the function would return. A result of a section has one contribution of each
// member that has not ended, and all of them to the same multicast.
#include "apps/protocol_fuzz/citizen.hpp"
#include "apps/protocol_fuzz/city_life.hpp"
#include "apps/protocol_fuzz/scenarios.hpp"
#include "runtime/checkpoint.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace tess::fuzz::city_life {

struct State {
  std::int32_t phase = 0, n_indices = 0, n_singers = 0, n_sung = 0;
  ArrayProxy<Citizen> citizens;
  ArrayProxy<Singer> singers;
  ArrayProxy<Spot> spots;
  ChareProxy<Mayor> mayor;
  GroupProxy<Office> offices;
  std::vector<Index1> members;
  SectionProxy<Singer> choir;
  Count sent, spent;  // spent: what the process groups of earlier phases held
  template <class Ar>
  void serialize(Ar& ar) {
    ar(phase, n_indices, n_singers, n_sung, citizens, singers, spots, mayor, offices, members,
       choir, sent, spent);
  }
};

void found_city(State& state, int n_singers) {
  state.citizens = create<Citizen>(mapped(range(city->n_citizens), ByLot{city->seed}));
  state.singers = create<Singer>(range(n_singers));
  state.spots = create<Spot>(sparse);
  state.spots["first"].insert();
  state.mayor = create_one<Mayor>();
  state.offices = create_group<Office>();
  for (int index = 0; index < n_singers; index += 2) state.members.push_back({index});
  state.choir = create_section(state.singers, state.members);
  state.n_indices = n_singers;
  city->n_singers = n_singers;
}

/// At most 20 calls, each with a message.
Timer start_ticks(GroupProxy<Office> offices) {
  // Messages of a slow kind take a tenth of a virtual second, in which a PE should not only tick.
  const Time period(machine().virtual_time() ? 50'000 + static_cast<int>(city->longest) : 200'000);
  return every(period, [offices, n = std::make_shared<int>(0)] {
    if (++*n > 20) return;
    ++city->n_ticks_sent;
    offices[PeId{*n % tess::n_pes()}].send<&Office::tick>();
  });
}

Task run_phase(State& state) {
  const std::int32_t phase = state.phase++;
  Random random(mix(city->seed + static_cast<std::uint64_t>(phase)));
  ProcessGroupProxy<Treasury> treasuries;
  ReadOnly<Prices> prices;
  co_await epoch([&] {
    treasuries = create_process_group<Treasury>();
    Prices made;
    for (std::uint64_t i = 0; i < 10; ++i) made.each.push_back(mix(i));
    prices = create_read_only(std::move(made));
  });
  const std::int32_t first_new = state.n_indices;
  state.n_indices += draw(random, 4);
  city->n_singers += state.n_indices - first_new;
  Future<std::vector<std::int32_t>> began;
  std::vector<Future<Chorus>> sung(static_cast<std::size_t>(1 + draw(random, 3)));
  const auto n_sung = static_cast<std::int32_t>(sung.size());
  const Orders orders{phase,       city->n_steps, state.n_indices, state.singers, state.spots,
                      state.mayor, state.offices, treasuries,      prices,        began.callback()};
  const Timer ticks = start_ticks(state.offices);
  co_await epoch([&] {
    state.citizens.broadcast<&Citizen::live>(orders);
    for (const auto& result : sung)
      state.choir.broadcast<&Singer::sing>(Cue{state.choir, result.callback()});
    for (int index = first_new; index < state.n_indices; ++index) state.singers[{index}].insert();
  });
  ticks.cancel();
  expect(city->n_ranked.exchange(0) == city->n_citizens,
         "an epoch ends before the results of a scan");
  expect(began.await_ready(), "an epoch ends before a reduction of it");
  const std::vector<std::int32_t> all = co_await began;
  expect(all.size() == static_cast<std::size_t>(city->n_citizens) &&
             std::is_sorted(all.begin(), all.end()),
         "a reduction in order has ", all.size(), " contributions");
  const std::vector<Chorus> choruses = co_await when_all(std::move(sung));
  check_choruses(choruses, state.members, state.n_sung);
  state.n_sung += n_sung;

  const std::uint64_t question = token(random);
  const std::uint64_t answer = co_await state.mayor.element().ask<&Mayor::answer>(question);
  expect(answer == answer_of(question, -1), "the single chare has another answer");
  auto of_citizens = state.citizens.reduce<&Citizen::report>();
  auto of_spots = state.spots.reduce<&Spot::report>();
  Future<Count> of_mayor;
  state.mayor.send<&Mayor::report>(of_mayor.callback());
  auto of_offices = state.offices.reduce<&Office::report>(treasuries);
  auto half = state.singers.reduce<&Singer::count>();
  auto of_singers = state.singers.reduce<&Singer::report>();
  const auto [citizens, singers, spots, mayor, offices, singers_by_two] =
      co_await when_all(of_citizens, of_singers, of_spots, of_mayor, of_offices, half);
  state.spent = state.spent + offices[1];
  const Count arrived = citizens + singers + spots + mayor + offices[0] + state.spent;
  state.sent = city->sent;
  state.n_singers = city->n_singers;
  expect(arrived == state.sent, "phase ", phase, ": ", state.sent.n, " tokens were sent, ",
         arrived.n, " have arrived, or others");
  expect(2 * singers_by_two == state.n_singers, "phase ", phase, ": ", 2 * singers_by_two,
         " singers of ", state.n_singers);
  treasuries.destroy();
  prices.destroy();
}

/// A checkpoint after each phase whose number is at least `save_from`; none if that is negative.
Task run_phases(State& state, int last, int save_from, std::string folder) {
  while (state.phase < last) {
    co_await run_phase(state);
    if (save_from >= 0 && state.phase >= save_from) co_await checkpoint(folder, state);
  }
}
Task run_first(int n_singers, int last, int save_from, std::string folder) {
  State state;
  co_await epoch([&] { found_city(state, n_singers); });
  co_await run_phases(state, last, save_from, folder);
  if (save_from < 0) co_return;
  co_await run_phase(state);  // the restart does not know of it
}
Task run_restarted(int last, std::string folder) {
  State state = co_await restart<State>(folder);
  city->sent = state.sent;
  city->n_singers = state.n_singers;
  city->hops.clear();
  co_await run_phases(state, last, -1, folder);
}

class Folder {
 public:
  Folder() : path_((std::filesystem::temp_directory_path() / "tess-fuzz-XXXXXX").string()) {
    if (::mkdtemp(path_.data()) == nullptr) fail(ErrorCode::environment, "no folder like ", path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] std::string path() const { return path_ + "/saved"; }

 private:
  std::string path_;
};

/// What is dropped with a section is counted and reported; nothing else is.
void run(Trial& trial, const std::function<Task()>& main) {
  const Ending ending = trial.run(main);
  trial.expect(ending.exit_code == 0, "exit code ", ending.exit_code, "; ", ending.report);
  trial.expect(
      ending.report.empty() || (city->n_cut > 0 && ending.report.ends_with("not delivered\n") &&
                                std::count(ending.report.begin(), ending.report.end(), '\n') == 1),
      "report: ", ending.report);
}

}  // namespace tess::fuzz::city_life

namespace tess::fuzz {

void all_at_once(Trial& trial) {
  using namespace city_life;
  const bool long_run = trial.seed() % 50 == 0;
  City here{trial,
            trial.random()(),
            trial.draw(1, 16),
            long_run ? 60 : trial.draw(1, 12),
            100ULL << trial.draw(0, 12),
            0.3 * trial.draw(0, 2),
            0.3 * trial.draw(0, 2)};
  city = &here;
  const int n_singers = trial.draw(1, 20);
  if (trial.draw(0, 2) != 0) {
    const int n_phases = trial.draw(1, 2);
    city_life::run(trial, [&] { return run_first(n_singers, n_phases, -1, ""); });
  } else {
    const Folder folder;
    const int n_phases = trial.draw(1, 2), n_more = trial.draw(1, 2);
    const int save_from = trial.draw(1, n_phases);
    city_life::run(trial, [&] { return run_first(n_singers, n_phases, save_from, folder.path()); });
    trial.change_pes(trial.draw(1, 8));
    city_life::run(trial, [&] { return run_restarted(n_phases + n_more, folder.path()); });
  }
  trial.expect(here.n_ticks == here.n_ticks_sent, here.n_ticks.load(), " of ",
               here.n_ticks_sent.load(), " messages of periodic timers have arrived");
}

}  // namespace tess::fuzz
