#include "runtime/more/testing/apart.hpp"

#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/serialize.hpp"
#include "runtime/pe/pe.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fcntl.h>
#include <span>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace tess::test::detail {
namespace {

// Of a child process.
int child_writes_to = -1;
Trial* child_trial = nullptr;
unsigned most_seconds = 0;
volatile std::sig_atomic_t is_late = 0;

DecisionIds sorted(DecisionIds ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

void write_all(int file, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(file, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
}

[[noreturn]] void leave_child(const Outcome& outcome) {
  tess::detail::Buffer packed;
  Writer write(packed);
  write(outcome.failure, outcome.taken, outcome.words);
  write_all(child_writes_to, {packed.data(), packed.size()});
  ::_exit(0);  // the parent flushes its output, and runs its destructors
}

void leave_child_on_check() {
  leave_child(outcome_so_far(check_failure, *child_trial));
}

std::string signal_failure(int signal) {
  return text("it ended by signal ", signal, " (", ::sigdescr_np(signal), ")");
}

/// After a crash what is known may be lost: a second crash, or a lock that is never released, ends
/// the child without a word.
void leave_child_on_crash(int signal) {
  for (const int one : crashes) std::signal(one, SIG_DFL);
  ::alarm(5);
  leave_child(outcome_so_far(signal_failure(signal), *child_trial));
}

[[noreturn]] void leave_late() {
  leave_child(
      outcome_so_far(text("it does not end; it was given ", most_seconds, " s"), *child_trial));
}

/// An entry method that does not end asks for nothing, and is left at the second alarm.
void on_alarm(int signal) {
  if (is_late != 0) {
    std::signal(signal, SIG_DFL);
    ::alarm(5);
    leave_late();
  }
  is_late = 1;
  ::alarm(2);
}

void on_exit_of_child(int code, void*) {
  leave_child(outcome_so_far(text("it ended the process with exit code ", code), *child_trial));
}

[[noreturn]] void run_as_child(const Program& program, std::uint64_t seed, Trial trial, int file) {
  child_writes_to = file;
  child_trial = &trial;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::on_exit(&on_exit_of_child, nullptr);
  std::signal(SIGALRM, &on_alarm);
  ::alarm(most_seconds);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  set_check_abort(&leave_child_on_check);
  tess::detail::the_current_pe = nullptr;  // a check that failed inside a run may have led here
  for (const int signal : crashes) std::signal(signal, &leave_child_on_crash);
  leave_child(run_here(program, seed, trial));
}

[[noreturn]] void refuse(const char* call) {
  fail(ErrorCode::environment, call, ": ", std::generic_category().message(errno),
       "; tests that fail are repeated in child processes");
}

std::vector<std::byte> read_all_of(int file) {
  std::vector<std::byte> bytes;
  std::array<std::byte, 4096> block{};
  while (true) {
    const ssize_t n = ::read(file, block.data(), block.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return bytes;
    bytes.insert(bytes.end(), block.begin(), block.begin() + n);
  }
}

}  // namespace

void limit_children(unsigned seconds) {
  most_seconds = seconds;
}

void leave_if_late() {
  if (is_late != 0) leave_late();
}

Outcome run_here(const Program& program, std::uint64_t seed, Trial& trial) {
  const InTrial in(trial);
  Outcome outcome;
  try {
    outcome.failure = program(seed);
    if (outcome.failure.empty() && trial.n_runs == 0)
      outcome.failure = "the program ran no tess::test::Machine";
  } catch (const std::exception& error) {
    outcome.failure = error.what();
    if (outcome.failure.empty()) outcome.failure = "an exception without a text";
  } catch (...) {  // of a test framework
    outcome.failure =
        "an exception that is not a std::exception; its text is printed above if a "
        "test framework threw it";
  }
  return outcome_so_far(std::move(outcome.failure), trial);
}

Outcome outcome_so_far(std::string failure, Trial& trial) {
  if (trial.update_words) trial.update_words();
  return {std::move(failure), sorted(trial.taken), trial.words};
}

Outcome run_apart(const Program& program, std::uint64_t seed, const Trial& trial) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) refuse("pipe2");
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child < 0) refuse("fork");
  if (child == 0) run_as_child(program, seed, trial, ends[1]);
  ::close(ends[1]);
  const std::vector<std::byte> bytes = read_all_of(ends[0]);
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  Outcome outcome;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && !bytes.empty()) {
    Reader read({bytes.data(), bytes.size()});
    read(outcome.failure, outcome.taken, outcome.words);
  } else if (WIFSIGNALED(status)) {
    outcome.failure = signal_failure(WTERMSIG(status));
  } else {
    outcome.failure = text("it ended the process with exit code ", WEXITSTATUS(status));
  }
  return outcome;
}

}  // namespace tess::test::detail
