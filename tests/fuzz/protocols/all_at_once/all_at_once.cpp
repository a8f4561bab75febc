// All means of control in one program, at the same time: replies with errors, deadlines, when_all
// and when_any, sections that are made, used and destroyed while their listed migrate, are created
// and end, priorities and expedited messages, delayed sends and periodic timers, nested epochs,
// mailboxes, elements created on demand, a single chare, a group, a process group, read-only data,
// reductions, scans, a user-defined map, elements of two arrays behind one interface, and between
// the phases checkpoints, with a restart on another number of PEs.
//
// The oracle: each message that must arrive carries a token, and each element adds up the tokens
// that reached it. After each phase the sums over all collections equal the sum of what was sent.
// Replies are what the function would return. A result of a section has one contribution of each
// member that has not ended, and all of them to the same multicast.
#include "runtime/checkpoint.hpp"
#include "runtime/more/section.hpp"
#include "runtime/more/singleton.hpp"
#include "tests/fuzz/protocols/all_at_once/caller.hpp"
#include "tests/fuzz/protocols/all_at_once/collections.hpp"
#include "tests/fuzz/protocols/scenarios.hpp"
#include "tests/support/scratch.hpp"

#include <algorithm>

namespace tess::fuzz::all_kinds {

struct State {
  std::int32_t phase = 0, n_indices = 0, n_elements = 0, n_reductions = 0;
  ArrayProxy<Caller> callers;
  ArrayProxy<SectionMember> elements;
  ArrayProxy<OnDemand> on_demand;
  ChareProxy<Single> single;
  GroupProxy<PerPe> per_pe;
  std::vector<Index1> listed;
  SectionProxy<SectionMember> section;
  Count sent, spent;  // spent: what the process groups of earlier phases held
  void serialize(auto& ar) {
    ar(phase, n_indices, n_elements, n_reductions, callers, elements, on_demand, single, per_pe,
       listed, section, sent, spent);
  }
};

void create_all(State& state, int n_elements) {
  state.callers = create<Caller>(mapped(range(record->n_callers), ByLot{record->seed}));
  state.elements = create<SectionMember>(range(n_elements));
  state.on_demand = create<OnDemand>(sparse);
  state.on_demand["first"].insert();
  state.single = create<Single>(one);
  state.per_pe = create<PerPe>(each_pe);
  for (int index = 0; index < n_elements; index += 2) state.listed.push_back({index});
  state.section = create_section(state.elements, state.listed);
  state.n_indices = n_elements;
  record->n_elements = n_elements;
}

/// At most 20 calls, each with a message.
Timer start_ticks(GroupProxy<PerPe> per_pe) {
  // Messages of a slow kind take a tenth of a virtual second, in which a PE should not only tick.
  const Time period(machine().virtual_time() ? 50'000 + static_cast<int>(record->longest)
                                             : 200'000);
  return every(period, [per_pe, n = std::make_shared<int>(0)] {
    if (++*n > 20) return;
    ++record->n_ticks_sent;
    per_pe[PeId{*n % tess::n_pes()}].send<&PerPe::tick>();
  });
}

Task run_phase(State& state) {
  const std::int32_t phase = state.phase++;
  Random random(mix(record->seed + static_cast<std::uint64_t>(phase)));
  ProcessGroupProxy<PerProcess> per_process;
  ReadOnly<Table> table;
  co_await epoch([&] {
    per_process = create<PerProcess>(each_process);
    Table made;
    for (std::uint64_t i = 0; i < 10; ++i) made.each.push_back(mix(i));
    table = create_read_only(std::move(made));
  });
  const std::int32_t first_new = state.n_indices;
  state.n_indices += draw(random, 4);
  record->n_elements += state.n_indices - first_new;
  Future<std::vector<std::int32_t>> began;
  std::vector<Future<SectionResult>> in_section(static_cast<std::size_t>(1 + draw(random, 3)));
  const auto n_reductions = static_cast<std::int32_t>(in_section.size());
  const Work work{phase,        record->n_steps, state.n_indices, state.elements, state.on_demand,
                  state.single, state.per_pe,    per_process,     table,          began.callback()};
  const Timer ticks = start_ticks(state.per_pe);
  co_await epoch([&] {
    state.callers.broadcast<&Caller::step>(work);
    for (const auto& result : in_section)
      state.section.broadcast<&SectionMember::give>(Multicast{state.section, result.callback()});
    for (int index = first_new; index < state.n_indices; ++index) state.elements[{index}].insert();
  });
  ticks.cancel();
  expect(record->n_ranked.exchange(0) == record->n_callers,
         "an epoch ends before the results of a scan");
  expect(began.await_ready(), "an epoch ends before a reduction of it");
  const std::vector<std::int32_t> all = co_await began;
  expect(all.size() == static_cast<std::size_t>(record->n_callers) &&
             std::is_sorted(all.begin(), all.end()),
         "a reduction in order has ", all.size(), " contributions");
  const std::vector<SectionResult> all_given = co_await when_all(std::move(in_section));
  check_results(all_given, state.listed, state.n_reductions);
  state.n_reductions += n_reductions;

  const std::uint64_t question = token(random);
  const std::uint64_t answer = co_await state.single.element().ask<&Single::answer>(question);
  expect(answer == answer_of(question, -1), "the single chare has another answer");
  auto of_callers = state.callers.reduce<&Caller::report>();
  auto of_on_demand = state.on_demand.reduce<&OnDemand::report>();
  Future<Count> of_single;
  state.single.send<&Single::report>(of_single.callback());
  auto of_per_pe = state.per_pe.reduce<&PerPe::report>(per_process);
  auto half = state.elements.reduce<&SectionMember::count>();
  auto of_elements = state.elements.reduce<&SectionMember::report>();
  const auto [callers, elements, on_demand, single, per_pe, elements_by_two] =
      co_await when_all(of_callers, of_elements, of_on_demand, of_single, of_per_pe, half);
  state.spent = state.spent + per_pe[1];
  const Count arrived = callers + elements + on_demand + single + per_pe[0] + state.spent;
  state.sent = record->sent;
  state.n_elements = record->n_elements;
  expect(arrived == state.sent, "phase ", phase, ": ", state.sent.n, " tokens were sent, ",
         arrived.n, " have arrived, or others");
  expect(2 * elements_by_two == state.n_elements, "phase ", phase, ": ", 2 * elements_by_two,
         " elements of ", state.n_elements);
  per_process.destroy();
  table.destroy();
}

/// A checkpoint after each phase whose number is at least `save_from`; none if that is negative.
Task run_phases(State& state, int last, int save_from, std::string folder) {
  while (state.phase < last) {
    co_await run_phase(state);
    if (save_from >= 0 && state.phase >= save_from) co_await checkpoint(folder, state);
  }
}
Task run_first(int n_elements, int last, int save_from, std::string folder) {
  State state;
  co_await epoch([&] { create_all(state, n_elements); });
  co_await run_phases(state, last, save_from, folder);
  if (save_from < 0) co_return;
  co_await run_phase(state);  // the restart does not know of it
}
Task run_restarted(int last, std::string folder) {
  State state = co_await restart<State>(folder);
  record->sent = state.sent;
  record->n_elements = state.n_elements;
  record->hops.clear();
  co_await run_phases(state, last, -1, folder);
}

/// What is dropped with a section is counted and reported; nothing else is.
void run(Case& test, const std::function<Task()>& main) {
  const Result result = test.run(main);
  expect_exit(result);
  expect(result.report.empty() ||
             (record->n_cut > 0 && result.report.size() == 1 && n_not_delivered(result) > 0),
         "report: ", result.failure());
}

}  // namespace tess::fuzz::all_kinds

namespace tess::fuzz {

void all_at_once(Case& test) {
  using namespace all_kinds;
  const bool long_run = test.seed % 50 == 0;
  Record here{test.random(),
              test.draw(1, 16),
              long_run ? 60 : test.draw(1, 12),
              100ULL << test.draw(0, 12),
              0.3 * test.draw(0, 2),
              0.3 * test.draw(0, 2)};
  record = &here;
  const int n_elements = test.draw(1, 20);
  if (test.draw(0, 2) != 0) {
    const int n_phases = test.draw(1, 2);
    all_kinds::run(test, [&] { return run_first(n_elements, n_phases, -1, ""); });
  } else {
    const test::Scratch folder;
    const int n_phases = test.draw(1, 2), n_more = test.draw(1, 2);
    const int save_from = test.draw(1, n_phases);
    all_kinds::run(
        test, [&] { return run_first(n_elements, n_phases, save_from, folder.path("saved")); });
    test.machine.pes = test.draw(1, 8);
    all_kinds::run(test, [&] { return run_restarted(n_phases + n_more, folder.path("saved")); });
  }
  expect(here.n_ticks == here.n_ticks_sent, here.n_ticks.load(), " of ", here.n_ticks_sent.load(),
         " messages of periodic timers have arrived");
}

}  // namespace tess::fuzz
