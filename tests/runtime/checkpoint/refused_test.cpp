// Runs that cannot be saved, and programs that cannot restore: each is an error with a name.
#include "runtime/balance.hpp"
#include "runtime/checkpoint.hpp"
#include "runtime/more/process_group.hpp"
#include "runtime/more/when.hpp"
#include "runtime/runtime.hpp"
#include "runtime/timer.hpp"
#include "tests/runtime/checkpoint/runs.hpp"
#include "tests/support/scratch.hpp"

#include <new>
#include <stdexcept>

namespace {

using tess::test::completes;
using tess::test::has;

class Cell : public tess::Chare<Cell> {
 public:
  void add(int value) { sum_ += value; }
  void sum(tess::Callback<int> target) { contribute(tess::sum, sum_, target); }
  tess::Task wait(tess::ElementProxy<Cell, tess::Index1> /*for_it*/) {
    tess::Future<int> never;
    co_await never;
  }
  void sync() { at_sync(); }
  void resume_from_sync() {}
  void serialize(auto& ar) { ar(sum_); }

 private:
  int sum_ = 0;
};

/// It cannot migrate.
class Rock : public tess::Chare<Rock> {
 public:
  explicit Rock(int weight) : weight_(weight) {}
  void add(int value) { weight_ += value; }

 private:
  int weight_;
};

/// Its members cannot absorb each other.
class Table : public tess::Group<Table> {
 public:
  void put(int value) { value_ = value; }
  void sum(tess::Callback<int> target) { contribute(tess::sum, value_, target); }
  void serialize(auto& ar) { ar(value_); }

 private:
  int value_ = 7;
};

struct State {
  tess::ArrayProxy<Cell> cells;
  tess::GroupProxy<Table> tables;
};

using Prepare = void (*)(const State&);

/// The error of a checkpoint after prepare(); the run goes on and ends well if it can.
tess::Task try_to_save(std::string folder, Prepare prepare, std::string& error) {
  State state;
  state.cells = tess::create<Cell>(tess::range(6));
  state.tables = tess::create<Table>(tess::each_pe);
  prepare(state);
  try {
    co_await tess::checkpoint(folder, state);
  } catch (const tess::Error& wrong) {
    error = wrong.what();
  }
  tess::exit(0);
}

std::string error_after(Prepare prepare) {
  std::string error;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const tess::test::Scratch scratch;
    std::string found;
    completes(3, seed, [&] { return try_to_save(scratch.path("saved"), prepare, found); });
    if (seed == 0) error = found;
    CHECK(found.substr(0, 40) == error.substr(0, 40));
  }
  return error;
}

struct Refusal {
  const char* names;
  Prepare prepare;
  std::vector<std::string> sentences;
  std::vector<std::string> never{};
};

}  // namespace

TEST_CASE("a checkpoint waits for messages that are under way", "[runtime][checkpoint]") {
  CHECK(error_after([](const State& state) {
          for (int i = 0; i < 100; ++i) state.cells[{i % 6}].send<&Cell::add>(i);
        }).empty());
}

TEST_CASE("a checkpoint that is refused names what prevents it", "[runtime][checkpoint]") {
  const std::vector<Refusal> refusals{
      {"the coroutine that waits",
       [](const State& state) { state.cells[{4}].send<&Cell::wait>(state.cells[{1}]); },
       {"no checkpoint can be made here", "Cell[4]", "waits for a future of int"},
       {"the main program"}},
      {"the reduction that is not complete",
       [](const State& state) {
         state.cells[{4}].send<&Cell::sum>(state.cells[{0}].target<&Cell::add>());
       },
       {"Cell: reduction 0"}},
      {"the element that a message waits for",
       [](const State& state) { state.cells[{77}].send<&Cell::add>(1); },
       {"Cell[77], which does not exist"}},
      {"the element that waits at its barrier",
       [](const State& state) { state.cells[{2}].send<&Cell::sync>(); },
       {"Cell[2] waits at at_sync()"}},
      {"the PE of a timer",
       [](const State& state) {
         state.cells[{2}].send_after<&Cell::add>(std::chrono::hours(1), 3);
       },
       {"1 timer is set on PE 0"}},
      {"the class that cannot be saved",
       [](const State&) { (void)tess::create<Rock>(tess::range(3), 5); },
       {"Rock cannot be saved: give it a default constructor and a public serialize()"}},
      {"data that the PEs of a process share",
       [](const State&) { (void)tess::create_read_only(std::vector<int>(4)); },
       {"ReadOnlyPart", "the PEs of a process share it: destroy() it before the checkpoint"},
       {"serialize"}}};
  for (const Refusal& refusal : refusals) {
    const std::string error = error_after(refusal.prepare);
    INFO(refusal.names << ": " << error);
    for (const std::string& sentence : refusal.sentences) CHECK(has(error, sentence));
    for (const std::string& sentence : refusal.never) CHECK_FALSE(has(error, sentence));
  }
}

namespace {

tess::Task save_twice_at_once(std::string folder, std::string& error) {
  const tess::Task first = tess::checkpoint(folder, 1);  // it goes on when this coroutine has ended
  const int state = 1;
  try {
    co_await tess::checkpoint(folder, state);
  } catch (const tess::Error& wrong) {
    error = wrong.what();
  }
}

/// Classes that a later version of the program has given another member.
bool is_later_version = false;
struct Growing {
  int first = 1;
  int later = 2;
  void serialize(auto& ar) {
    ar(first);
    if (is_later_version) ar(later);
  }
};
class Grown : public tess::Chare<Grown> {
 public:
  void serialize(auto& ar) { ar(members_); }

 private:
  Growing members_;
};

struct Versions {
  static tess::Task save_state(std::string folder) { co_await tess::checkpoint(folder, Growing()); }
  static tess::Task restart_state(std::string folder) {
    (void)co_await tess::restart<Growing>(folder);
  }
  static tess::Task save_elements(std::string folder) {
    (void)tess::create<Grown>(tess::range(5));
    co_await tess::checkpoint(folder, 1);
  }
  static tess::Task restart_elements(std::string folder) {
    (void)co_await tess::restart<int>(folder);
  }
};

/// What the restart reports when the classes have lost or got a member since the checkpoint.
std::string other_members(tess::Task (*save)(std::string), tess::Task (*restart)(std::string),
                          bool later_saves) {
  const tess::test::Scratch scratch;
  const std::string folder = scratch.path("saved");
  is_later_version = later_saves;
  completes(3, 1, [&] { return save(folder); });
  is_later_version = !later_saves;
  const auto after =
      tess::test::run_on(tess::test::adversarial(2, 1), [&] { return restart(folder); });
  CHECK(after.exit_code == 2);
  is_later_version = false;
  return after.report;
}

}  // namespace

TEST_CASE("a checkpoint is refused while another is under way, which goes on",
          "[runtime][checkpoint]") {
  const tess::test::Scratch scratch;
  const std::string folder = scratch.path("saved");
  std::string error;
  completes(3, 1, [&] { return save_twice_at_once(folder, error); });
  CHECK(has(error, "another checkpoint() is under way; await it first"));
  CHECK(!tess::latest_checkpoint(folder).empty());
}

TEST_CASE("a restart names the class or the state that has other members than it was saved with",
          "[runtime][checkpoint]") {
  for (const bool later_saves : {false, true}) {
    INFO((later_saves ? "fewer" : "more"));
    const std::string state =
        other_members(&Versions::save_state, &Versions::restart_state, later_saves);
    INFO(state);
    CHECK(has(state, "the checkpoint does not fit this program: its state "));
    CHECK(has(state, "Growing has other members"));
    CHECK(has(state, "restart with the program that wrote it"));
    const std::string element =
        other_members(&Versions::save_elements, &Versions::restart_elements, later_saves);
    INFO(element);
    CHECK(has(element, "the checkpoint does not fit this program: Grown["));
    CHECK(has(element, "restart with the program that wrote it"));
  }
}

namespace {

struct Restarting {
  static tess::Task save(const std::string& folder) {
    State state;
    state.cells = tess::create<Cell>(tess::range(6));
    state.tables = tess::create<Table>(tess::each_pe);
    co_await tess::checkpoint(folder, state);
  }
  static tess::Task restart(const std::string& folder, int& sum) {
    const auto state = co_await tess::restart<State>(folder);
    const int found = co_await state.tables.reduce<&Table::sum>();
    sum = found;
  }
  static tess::Task restart_with_future(const std::string& folder) {
    const tess::Future<int> made;
    (void)made.callback();
    (void)co_await tess::restart<State>(folder);
  }
  static tess::Task restart_after_an_array(const std::string& folder) {
    co_await tess::epoch([] { tess::create<Cell>(tess::range(2)).destroy(); });
    (void)co_await tess::restart<State>(folder);
  }
  static tess::Task restart_with_timer(const std::string& folder) {
    (void)tess::after(std::chrono::hours(1), [] {});
    (void)co_await tess::restart<State>(folder);
  }
  static tess::Task restart_only(const std::string& folder) {
    (void)co_await tess::restart<State>(folder);
  }
  /// Another coroutine of the main program sleeps while all messages are awaited.
  static tess::Task sleep_long() { (void)co_await tess::sleep(std::chrono::hours(1)); }
  static tess::Task restart_beside_sleep(const std::string& folder) {
    std::vector<tess::Task> both;
    both.push_back(restart_only(folder));
    both.push_back(sleep_long());
    co_await tess::when_all(std::move(both));
  }
  static tess::Task restart_late(const std::string& folder) {
    (void)tess::create<Cell>(tess::range(2));
    (void)co_await tess::restart<State>(folder);
  }
};

}  // namespace

TEST_CASE("a group restarts on the same number of PEs, or its class says how",
          "[runtime][checkpoint]") {
  const tess::test::Scratch scratch;
  const std::string folder = scratch.path("saved");
  completes(3, 1, [&] { return Restarting::save(folder); });
  int sum = 0;
  completes(3, 2, [&] { return Restarting::restart(folder, sum); });
  CHECK(sum == 21);
  const auto restart = [&](const std::string& of) { return Restarting::restart(of, sum); };
  const struct {
    int n_pes;
    std::function<tess::Task(const std::string&)> main;
    std::vector<std::string> sentences;
  } refusals[]{
      {2, restart, {"Table", "has 3 members, but this run has", "absorb("}},
      {4, restart, {"Table", "has 3 members, but this run has", "absorb("}},
      {3, &Restarting::restart_late, {"restart() comes first, but this run has already made Cell"}},
      {3,
       &Restarting::restart_with_future,
       {"restart() comes first, but this run has already made a future"}},
      {3,
       &Restarting::restart_after_an_array,
       {"already made an array, group or section that has ended"}},
      {3,
       &Restarting::restart_with_timer,
       {"restart() comes first, but this run has already set a timer"}},
      {3,
       &Restarting::restart_beside_sleep,
       {"restart() waits for all messages, but 1 timer is set on PE 0"}}};
  for (const auto& refusal : refusals) {
    const auto ended = tess::test::run_on(tess::test::adversarial(refusal.n_pes, 3),
                                          [&] { return refusal.main(folder); });
    INFO(ended.report);
    CHECK(ended.exit_code == 2);
    for (const std::string& sentence : refusal.sentences) CHECK(has(ended.report, sentence));
  }
}

namespace {

class Beat : public tess::Chare<Beat> {
 public:
  void phase() {
    ++n_phases_;
    at_sync();
  }
  void resume_from_sync() { contribute(tess::sum, n_phases_, target_); }
  void start(tess::Callback<int> target) {
    target_ = target;
    phase();
  }
  void serialize(auto& ar) { ar(n_phases_, target_); }

 private:
  int n_phases_ = 0;
  tess::Callback<int> target_;
};

struct Balanced {
  static tess::Task phases(const tess::ArrayProxy<Beat>& beats, int n, int& sum) {
    for (int i = 0; i < n; ++i) {
      const int found = co_await beats.reduce<&Beat::start>();
      sum = found;
    }
  }
  static tess::Task save(std::string folder, int& sum) {
    const auto beats = tess::create<Beat>(tess::range(9));
    const tess::BalanceOptions options{.strategy = "rotate"};
    co_await tess::epoch([&] { tess::start_balancing(beats, options); });
    co_await phases(beats, 3, sum);
    co_await tess::checkpoint(folder, beats);
  }
  static tess::Task restart(std::string folder, int& sum) {
    const auto beats = co_await tess::restart<tess::ArrayProxy<Beat>>(folder);
    const tess::BalanceOptions options{.strategy = "rotate"};
    co_await tess::epoch([&] { tess::start_balancing(beats, options); });
    co_await phases(beats, 2, sum);
  }
};

}  // namespace

TEST_CASE("an array that is balanced restarts with a new balancer", "[runtime][checkpoint]") {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    INFO("seed " << seed);
    const tess::test::Scratch scratch;
    int sum = 0;
    completes(3, seed, [&] { return Balanced::save(scratch.path("saved"), sum); });
    CHECK(sum == 27);
    completes(5, seed, [&] { return Balanced::restart(scratch.path("saved"), sum); });
    CHECK(sum == 45);
  }
}

namespace {

enum class Thrown : std::uint8_t { nothing, error, runtime_error, no_memory, number };
Thrown by_clay = Thrown::nothing, by_state = Thrown::nothing;

/// What a user's serialize() may do where it writes.
template <class Ar>
void may_throw(Thrown what, const Ar& /*ar*/) {
  if (Ar::is_reading) return;
  if (what == Thrown::error) tess::fail(tess::ErrorCode::bad_value, "the clay is too hard");
  if (what == Thrown::runtime_error) throw std::runtime_error("the clay is too soft");
  if (what == Thrown::no_memory) throw std::bad_alloc();
  if (what == Thrown::number) throw 7;
}

class Clay : public tess::Chare<Clay> {
 public:
  void form() { ++n_; }
  [[nodiscard]] int formed() const { return n_; }
  void serialize(auto& ar) {
    if (index().x == 3) may_throw(by_clay, ar);
    ar(n_);
  }

 private:
  int n_ = 0;
};

struct Pottery {
  tess::ArrayProxy<Clay> clay;
  void serialize(auto& ar) {
    may_throw(by_state, ar);
    ar(clay);
  }

  /// A checkpoint that fails for each kind of exception, in the elements and in the state; the run
  /// goes on, and then saves.
  static tess::Task main(std::string folder, std::vector<std::string>& errors) {
    Pottery state;
    state.clay = tess::create<Clay>(tess::range(6));
    int n_ticks = 0;
    const tess::Timer ticks = tess::every(std::chrono::milliseconds(1), [&] { ++n_ticks; });
    for (Thrown* const by : {&by_clay, &by_state}) {
      for (const Thrown what :
           {Thrown::error, Thrown::runtime_error, Thrown::no_memory, Thrown::number}) {
        *by = what;
        std::string error = "none";
        try {
          co_await tess::checkpoint(folder, state);
        } catch (const tess::Error& wrong) {
          error = wrong.what();
        }
        *by = Thrown::nothing;
        errors.push_back(error);
        CHECK(tess::latest_checkpoint(folder).empty());
        co_await tess::epoch([&] { state.clay.broadcast<&Clay::form>(); });
        const int before = n_ticks;
        (void)co_await tess::sleep(std::chrono::seconds(3));
        CHECK(n_ticks > before);  // timers go on
      }
    }
    ticks.cancel();
    co_await tess::checkpoint(folder, state);
    CHECK(!tess::latest_checkpoint(folder).empty());
    const int formed = co_await state.clay[{3}].ask<&Clay::formed>();
    CHECK(formed == 8);
  }
};

}  // namespace

TEST_CASE("an exception of serialize() is the Error of the checkpoint, and the run goes on",
          "[runtime][checkpoint]") {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    CAPTURE(seed);
    const tess::test::Scratch scratch;
    std::vector<std::string> errors;
    auto setup = tess::test::adversarial(3, seed);
    setup.options.migration_chance = 0;  // a migration would throw, too
    tess::test::completes_on(std::move(setup),
                             [&] { return Pottery::main(scratch.path("saved"), errors); });
    CHECK(errors == std::vector<std::string>{
                        "the checkpoint failed: Clay[3]: the clay is too hard",
                        "the checkpoint failed: Clay[3]: the clay is too soft",
                        "the checkpoint failed: Clay[3]: std::bad_alloc",
                        "the checkpoint failed: an exception that is not a std::exception",
                        "the clay is too hard", scratch.path("saved: the clay is too soft"),
                        scratch.path("saved: std::bad_alloc"),
                        scratch.path("saved: an exception that is not a std::exception")});
  }
}
