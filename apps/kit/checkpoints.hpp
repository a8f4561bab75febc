// The options of a program that writes checkpoints and restarts, and both for its main coroutine:
//
//     kit::Checkpoints checkpoints;
//     checkpoints.add_options(line);            // --checkpoint, --checkpoint-every, --restart, …
//     …
//     checkpoints.check(line, {"--size"});      // after the command line was parsed
//     …
//     State state;                              // in the main coroutine
//     if (checkpoints.restarts())
//       co_await checkpoints.restart(state, n_steps);
//     else
//       state = …;
//     while (state.step < n_steps) {
//       const auto from = state.step;
//       state.step = checkpoints.pause_after(from, n_steps);
//       …                                       // run to state.step, and await it
//       co_await checkpoints.save_if_due(state, from, n_steps);
//     }
//
// A checkpoint holds the values of the options that describe the problem. A restart takes them from
// there; an option that is given again must have the value that it had.
#pragma once

#include "runtime/checkpoint.hpp"
#include "runtime/command_line.hpp"
#include "runtime/core/duration.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace kit {

class Checkpoints {
 public:
  /// `line`: a kit::Driver or a tess::CommandLine.
  template <class Line>
  void add_options(Line& line) {
    line.option("--checkpoint DIR", folder_,
                "write checkpoints into this folder; the last two are kept");
    line.option("--checkpoint-every STEPS|TIME", every_,
                "steps (20) or seconds (30s) between checkpoints");
    line.flag("--checkpoint-buddy", buddy_copies_,
              "that folder is local to each host (/dev/shm/NAME): another host has copies of its "
              "files");
    line.option("--restart DIR", restart_, "continue from the last good checkpoint in this folder");
  }
  /// Throws tess::Error for values that cannot be used, and for a folder with checkpoints of
  /// another run. `of_problem`: the options whose values a restart cannot change. Called before the
  /// program changes the values of its options.
  void check(const tess::CommandLine& line, const std::vector<std::string>& of_problem);

  /// True if --checkpoint or --restart is given.
  [[nodiscard]] bool are_used() const { return !folder_.empty() || restarts(); }
  [[nodiscard]] bool restarts() const { return !restart_.empty(); }

  /// Restores the state. `n_steps` becomes the checkpoint's unless --steps is given. Throws
  /// tess::Error if options do not fit the checkpoint.
  template <class State>
  tess::Task restart(State& state, std::int32_t& n_steps) {
    auto saved = co_await tess::restart<Saved<State>>(restart_);
    state = std::move(saved.state);
    if (!gives_steps_) n_steps = saved.n_steps;
    take(std::move(saved.problem), state.step, n_steps);
  }

  /// The step at which the program pauses next; `last` if it writes no checkpoint before.
  [[nodiscard]] std::int32_t pause_after(std::int32_t step, std::int32_t last);
  /// Writes a checkpoint if it is time for one: steps `from` + 1 to state.step have been done since
  /// the last call.
  template <class State>
  tess::Task save_if_due(const State& state, std::int32_t from, std::int32_t last) {
    if (!is_due(from, state.step)) co_return;
    const Saved<State> saved{state, last, problem_};
    co_await tess::checkpoint(folder_, saved, {.buddy_copies = buddy_copies_}, note_of(state.step));
  }

 private:
  using Clock = std::chrono::steady_clock;
  using Values = std::map<std::string, std::string>;  // by option

  template <class State>
  struct Saved {
    State state;
    std::int32_t n_steps = 0;
    Values problem;
    template <class Ar>
    void serialize(Ar& ar) {
      ar(state, n_steps, problem);
    }
  };

  void check_folders();
  void check_every();
  void take(Values saved, std::int32_t step, std::int32_t n_steps);
  [[nodiscard]] bool is_due(std::int32_t from, std::int32_t step);
  [[nodiscard]] std::string note_of(std::int32_t step) const;

  std::string folder_, restart_, every_ = "100";
  bool buddy_copies_ = false;
  Values problem_, given_;
  bool gives_steps_ = false;
  std::int32_t steps_ = 0;  // 0: by time
  std::chrono::duration<double> period_{0};
  Clock::time_point written_ = Clock::now();  // the last checkpoint, or the start
  Clock::time_point paused_ = Clock::now();
  std::int32_t length_ = 0;  // steps between two pauses
};

}  // namespace kit
