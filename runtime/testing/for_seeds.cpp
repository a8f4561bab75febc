// The driver of seeds: runs them here, and a seed that fails again and again in child processes.
#include "runtime/core/check.hpp"
#include "runtime/testing.hpp"
#include "runtime/testing/apart.hpp"
#include "runtime/testing/shrink.hpp"
#include "runtime/testing/trial.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fmt/core.h>
#include <fstream>
#include <iterator>
#include <signal.h>  // NOLINT: sigaction is of POSIX
#include <string_view>
#include <unistd.h>

namespace tess::test::detail {
namespace {

/// Without digits, the first line of two failures of one kind is the same.
std::string kind_of(const std::string& failure) {
  std::string kind = failure.substr(0, failure.find('\n'));
  std::erase_if(kind, [](char c) { return c >= '0' && c <= '9'; });
  return kind;
}

std::string quoted(const std::string& word) {
  constexpr std::string_view plain = "_-./=:,+@%";
  const bool is_plain = !word.empty() && std::all_of(word.begin(), word.end(), [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           plain.find(c) != std::string_view::npos;
  });
  if (is_plain) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// The command line of this process; with a name of a test case this program and that name.
std::string command(const std::string& name) {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  const std::string all{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  std::string out;
  for (std::size_t at = 0; at < all.size();) {
    const std::size_t end = std::min(all.find('\0', at), all.size());
    out.append(" ").append(quoted(all.substr(at, end - at)));
    at = end + 1;
    if (!name.empty()) return out.append(" ").append(quoted(name));
  }
  return out;
}

std::string repeat_line(const Repeat& repeat, const std::string& name) {
  return "TESS_TEST_REPEAT=" + repeat_text(repeat) + command(name);
}

std::string indented(const std::string& lines) {
  std::string out = lines;
  for (std::size_t at = 0; (at = out.find('\n', at)) != std::string::npos; ++at)
    out.insert(at + 1, "  ");
  return out;
}

/// `facts` says how many decisions there are and where they come from.
std::string report_of(const Repeat& repeat, const Outcome& outcome, const std::string& facts,
                      const std::string& name) {
  std::string out =
      text("seed ", repeat.seed, " fails: ", indented(outcome.failure), "\n  ", facts);
  for (const std::string& sentence : outcome.words) out += "\n    " + sentence;
  return out + "\n  repeat with: " + repeat_line(repeat, name);
}

std::string count(std::size_t n, const char* one, const char* several) {
  return text(n, " ", n == 1 ? one : several);
}

/// Shrinks a failure, and describes it.
std::string explain(const Program& program, std::uint64_t seed, const Outcome& found,
                    const SeedOptions& options) {
  const DecisionIds all = found.taken.value_or(DecisionIds{});
  const std::string kind = kind_of(found.failure);
  const auto fails = [&](const DecisionIds& some) -> std::optional<DecisionIds> {
    const Outcome outcome = run_apart(program, seed, {.keep = some});
    if (outcome.failure.empty() || kind_of(outcome.failure) != kind) return std::nullopt;
    return outcome.taken.value_or(some);
  };
  const Shrunk shrunk = shrink(all, fails, options.most_tries);
  const Repeat repeat{seed, shrunk.kept};
  const Outcome last = run_apart(program, seed, {.keep = shrunk.kept, .in_words = true});
  if (kind_of(last.failure) != kind)
    return report_of({seed, std::nullopt}, found,
                     text("it did not fail again in the same way with ",
                          count(shrunk.kept.size(), "decision", "decisions"), " of ", all.size(),
                          ": the program depends on more than the seed"),
                     options.name);
  if (shrunk.kept.empty())
    return report_of(repeat, last, "no disorder is needed: it fails in the plain order too",
                     options.name);
  return report_of(
      repeat, last,
      text("shrunk to ", shrunk.kept.size(), " of ", count(all.size(), "decision", "decisions"),
           " in ", count(shrunk.n_tries, "try", "tries"),
           shrunk.is_minimal ? "; it passes without any one of these:"
                             : ", which is the limit (SeedOptions::most_tries); these are left:"),
      options.name);
}

// What a run that ends the process in its midst needs. Only one for_seeds() runs at a time.
struct Running {
  const Program& program;
  const SeedOptions& options;
  std::uint64_t seed;
  Trial& trial;
  bool shrinks;
};
const Running* running = nullptr;
std::array<char, 4096> crash_line{};  // written by the handler of a crash
std::array<struct sigaction, crashes.size()> handlers_before{};
CheckAbort abort_before = nullptr;

void on_check() {
  if (const Running* const run = std::exchange(running, nullptr)) {
    const Outcome found = outcome_so_far(check_failure, run->trial);
    const Repeat repeat{run->seed, run->trial.keep};
    std::fprintf(
        stderr, "%s\n",
        (run->shrinks ? explain(run->program, run->seed, found, run->options)
                      : report_of(repeat, found, "with these decisions:", run->options.name))
            .c_str());
    std::fflush(nullptr);
  }
  if (abort_before != nullptr) abort_before();
}

void on_crash(int signal) {
  [[maybe_unused]] const auto n =
      ::write(STDERR_FILENO, crash_line.data(), std::strlen(crash_line.data()));
  for (std::size_t i = 0; i < crashes.size(); ++i)
    if (crashes[i] == signal) ::sigaction(signal, &handlers_before[i], nullptr);
  ::raise(signal);
}

/// Reports the seed of a run that ends the process.
class Watch {
 public:
  explicit Watch(const Running& run) {
    running = &run;
    const std::string line =
        "tessera: repeat with: " +
        repeat_line({run.seed, run.trial.keep}, run.options.name).substr(0, 4000) + "\n";
    std::strncpy(crash_line.data(), line.c_str(), crash_line.size() - 1);
    abort_before = set_check_abort(&on_check);
    struct sigaction action {};
    action.sa_handler = &on_crash;
    for (std::size_t i = 0; i < crashes.size(); ++i)
      ::sigaction(crashes[i], &action, &handlers_before[i]);
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
  ~Watch() {
    for (std::size_t i = 0; i < crashes.size(); ++i)
      ::sigaction(crashes[i], &handlers_before[i], nullptr);
    set_check_abort(abort_before);
    running = nullptr;
  }
};

Outcome run_watched(const Program& program, const SeedOptions& options, std::uint64_t seed,
                    Trial& trial, bool shrinks) {
  const Running run{program, options, seed, trial, shrinks};
  const Watch watch(run);
  return run_here(program, seed, trial);
}

void run_repeat(std::uint64_t first, std::uint64_t end, const Repeat& repeat,
                const Program& program, const SeedOptions& options) {
  if (repeat.seed < first || repeat.seed >= end) {
    std::fprintf(stderr, "tessera: TESS_TEST_REPEAT: seed %llu is none of this test\n",
                 static_cast<unsigned long long>(repeat.seed));
    return;
  }
  Trial trial{.keep = repeat.keep, .in_words = repeat.keep.has_value()};
  const Outcome outcome = run_watched(program, options, repeat.seed, trial, !repeat.keep);
  if (outcome.failure.empty()) return;
  throw Failure(repeat.keep ? report_of(repeat, outcome, "with these decisions:", options.name)
                            : explain(program, repeat.seed, outcome, options));
}

}  // namespace

void for_seeds(std::uint64_t first, std::uint64_t end, const Program& program,
               const SeedOptions& options) {
  if (first >= end)
    fail(ErrorCode::bad_argument, "for_seeds(): there is no seed in ", first, " … ", end, " − 1");
  if (current_trial() != nullptr)
    fail(ErrorCode::bad_argument, "for_seeds() is called inside the program of another one");
  if (const auto repeat = requested_repeat())
    return run_repeat(first, end, *repeat, program, options);
  for (std::uint64_t seed = first; seed < end; ++seed) {
    Trial trial;
    const Outcome outcome = run_watched(program, options, seed, trial, true);
    if (!outcome.failure.empty()) throw Failure(explain(program, seed, outcome, options));
  }
}

}  // namespace tess::test::detail
