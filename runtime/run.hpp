// Starting a run.
//
//     int main(int argc, char** argv) {
//       return tess::run(argc, argv, [] { … });
//     }
//
// run() removes the options below from the command line, chooses the machine, runs the function on
// PE 0 as the first message, and returns the exit code at quiescence.
//
//     --pes N                 PEs per process (default: one per core; under mpirun: one per core
//                             that was given to the process)
//     --sim KEYS              the simulated machine: pes=8,latency=2us,bandwidth=10GB/s,cost=100ns
//     --message-memory SIZE   most bytes under way from one process to another (default 32MiB)
//     --hang-report SECONDS   report what waits when no entry method has begun for so long
//     --audit                 count the messages between PEs at both ends, and name lost ones
//     --monitor ADDRESS       show the run in a browser: PORT, or ADDRESS:PORT
//     --monitor-token TOKEN   what a browser on another machine has to know
//     --stats                 print the counters of each PE at the end
//     --trace FILE            write what each PE ran, as JSON for Perfetto
//
// SIGINT and SIGTERM end the run on all processes with exit code 128 + signal, and each process
// reports what waits on its PEs; SIGUSR1 reports it and the run goes on. A signal that the program
// handles or ignores itself is left alone; RuntimeOptions::signals turns this off.
#pragma once

#include "runtime/core/duration.hpp"
#include "runtime/core/error.hpp"
#include "runtime/pe/interfaces/runtime_options.hpp"
#include "runtime/task.hpp"
#include "runtime/wire/machine/machine.hpp"

#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

namespace tess {

/// A machine and the options of the run.
struct Setup {
  std::unique_ptr<Machine> machine;
  RuntimeOptions options;
  bool started = false;  ///< the run has begun
};

/// Removes the runtime's options from argc and argv, and makes the machine that they name. Throws
/// Error for an invalid value.
[[nodiscard]] Setup take_options(int& argc, char** argv);

/// The lines of --help that describe the runtime's options.
[[nodiscard]] std::string options_help();

/// Runs `main` on PE 0 of this machine; returns the exit code.
int run_on(Setup& setup, std::function<void()> main);

/// A whole program, for main(): takes the runtime's options, runs `body`, returns its exit code. An
/// Error is printed in one line and gives exit code 2; under mpirun it is printed once if all
/// processes have the same error in their command line. When `body` runs, `argc` counts the
/// remaining words. A run answers --help and refuses options among them, unless tess::CommandLine
/// (runtime/command_line.hpp) has read them, or the program itself, which then sets argc to 1.
int guarded(int& argc, char** argv, const std::function<int(Setup&)>& body);

/// Does the same for a program that makes no machine or several.
int guarded(const char* program, const std::function<int()>& body);

namespace detail {
/// The words that guarded() gave to its body have been read.
void words_are_read();
/// A program without words of its own calls it: it throws for those that are left.
void refuse_words(int argc, char** argv);
template <class Main>
std::function<void()> as_message(Main main) {
  if constexpr (std::is_same_v<std::invoke_result_t<Main>, Task>) {
    return [main = std::move(main)] { const Task task = main(); };
  } else {
    static_assert(!std::is_base_of_v<AnyTask, std::invoke_result_t<Main>>,
                  "the function given to run() returns void or tess::Task: nothing would take a "
                  "value");
    return std::function<void()>(std::move(main));
  }
}
}  // namespace detail

template <class Main>
int run(Setup& setup, Main main) {
  return run_on(setup, detail::as_message(std::move(main)));
}

/// Programs without options of their own call this.
template <class Main>
int run(int argc, char** argv, Main main) {
  return guarded(argc, argv, [&](Setup& setup) {
    detail::refuse_words(argc, argv);
    return run_on(setup, detail::as_message(std::move(main)));
  });
}

/// Advances the virtual clock of this PE on the simulated machine by the duration of its work, and
/// returns true. On a real machine it does nothing and returns false, and the caller does the work.
bool charge(std::chrono::nanoseconds work);

/// Ends the run on all PEs; no user code runs afterwards. If several PEs call it, the greatest code
/// is the exit code. The code must be in 0 … 255, which is what the system passes on.
void exit(int code);

/// Writes the parts to standard output in one piece. (mpirun passes on what it reads in pieces of 4
/// KiB, so it may mix lines of processes that print much at once.)
void print_text(const std::string& text);
/// Writes parts that text() can write. An index is printed as print(index_text(index())).
template <class... Parts>
void print(const Parts&... parts) {
  static_assert((Writable<Parts> && ...),
                "print() takes numbers, strings and what has an operator<< for std::ostream; it "
                "takes an index as index_text(index())");
  if constexpr ((Writable<Parts> && ...)) print_text(text(parts...));
}

}  // namespace tess
