// Starting a run: tess::run(argc, argv, function) takes the options below out of the command line,
// chooses the machine, runs `function` on PE 0 as the first message, and returns the exit code at
// quiescence.
//
//     --pes N      PEs of each process (default: all cores; under mpirun: the cores each process
//     was given)
//     --sim KEYS   the simulated machine: pes=8,latency=2us,bandwidth=10GB/s,cost=100ns,seed=7
//     --message-memory SIZE   most bytes under way from one process to another (default 32MiB)
//     --stats      what each PE did, at the end
//     --trace F    what each PE ran when, as JSON for Perfetto
#pragma once

#include "runtime/core/error.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/scheduler/runtime.hpp"
#include "runtime/task.hpp"

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <type_traits>
#include <utility>

namespace tess {

/// A machine and how to run on it.
struct Setup {
  std::unique_ptr<Machine> machine;
  RuntimeOptions options;
  bool started = false;  ///< run_on() was called
};

/// Takes the runtime's options out of argc and argv, and makes the machine they name. Throws Error
/// for a bad value.
[[nodiscard]] Setup take_options(int& argc, char** argv);

/// The lines of --help that describe the runtime's options.
[[nodiscard]] std::string options_help();

/// Runs `main` on PE 0 of that machine; returns the exit code.
int run_on(Setup& setup, std::function<void()> main);

/// A whole program, for main(): takes the runtime's options, runs `body`, returns its exit code. An
/// Error is one line and exit code 2: of a job under mpirun, too, in which all processes meet the
/// same fault of the command line. `argc` holds what is left when `body` runs.
int guarded(int& argc, char** argv, const std::function<int(Setup&)>& body);

/// The same for a program that makes no machine, or several.
int guarded(const char* program, const std::function<int()>& body);

namespace detail {
/// For a program without options: true if it was asked for help, which is printed then. Any other
/// option is an Error.
bool asks_for_help(int argc, char** argv);
template <class Main>
std::function<void()> as_message(Main main) {
  if constexpr (std::is_same_v<std::invoke_result_t<Main>, Task>) {
    return [main = std::move(main)] { const Task task = main(); };
  } else {
    return std::function<void()>(std::move(main));
  }
}
}  // namespace detail

template <class Main>
int run(Setup& setup, Main main) {
  return run_on(setup, detail::as_message(std::move(main)));
}

/// For programs without options of their own.
template <class Main>
int run(int argc, char** argv, Main main) {
  return guarded(argc, argv, [&](Setup& setup) {
    if (detail::asks_for_help(argc, argv)) return 0;
    return run_on(setup, detail::as_message(std::move(main)));
  });
}

/// On the simulated machine: this PE works for that long, in virtual time. True there; on a real
/// machine nothing happens, and the caller does the work itself.
bool charge(std::chrono::nanoseconds work);

/// Ends the run on all PEs; no user code runs afterwards. The greatest code that any PE gives is
/// the exit code: 0 … 255; the system passes no other on.
void exit(int code);

/// Writes the parts to standard output in one piece.
void print_text(const std::string& text);
template <class... Parts>
void print(const Parts&... parts) {
  print_text(text(parts...));
}

}  // namespace tess
