// The driver of seeds: runs them here, and a seed that fails again and again in child processes.
#include "runtime/core/check.hpp"
#include "runtime/more/testing.hpp"
#include "runtime/more/testing/explain.hpp"
#include "runtime/more/testing/shrink.hpp"
#include "runtime/more/testing/trial.hpp"

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

}  // namespace

std::string report_of(const Repeat& repeat, const Outcome& outcome, const std::string& facts,
                      const std::string& name) {
  std::string out =
      text("seed ", repeat.seed, " fails: ", indented(outcome.failure), "\n  ", facts);
  for (const std::string& sentence : outcome.words) out += "\n    " + sentence;
  return out + "\n  repeat with: " + repeat_line(repeat, name);
}

namespace {

std::string count(std::size_t n, const char* one, const char* several) {
  return text(n, " ", n == 1 ? one : several);
}

/// A failure of a seed with as few decisions as were found.
struct Found {
  std::uint64_t seed = 0;
  Outcome outcome;  // with all decisions
  Shrunk shrunk;
};

/// A try counts only if it fails in the same way.
Found shrink_seed(const Program& program, std::uint64_t seed, const Outcome& outcome,
                  unsigned most_tries) {
  const std::string kind = kind_of(outcome.failure);
  const auto fails = [&](const DecisionIds& some) -> std::optional<DecisionIds> {
    const Outcome one = run_apart(program, seed, {.keep = some});
    if (one.failure.empty() || kind_of(one.failure) != kind) return std::nullopt;
    return one.taken.value_or(some);
  };
  return {seed, outcome, shrink(outcome.taken.value_or(DecisionIds{}), fails, most_tries)};
}

}  // namespace

std::string explain(const Program& program, std::uint64_t seed, std::uint64_t end,
                    const Outcome& first, const SeedOptions& options) {
  constexpr std::uint64_t most_seeds = 20;
  Found best = shrink_seed(program, seed, first, options.most_tries);
  const std::size_t n_of_first = best.shrunk.kept.size();
  unsigned n_tries = best.shrunk.n_tries;
  for (std::uint64_t other = seed + 1; other < std::min(end, seed + most_seeds); ++other) {
    if (best.shrunk.kept.size() < 2 || n_tries >= options.most_tries) break;
    ++n_tries;
    const Outcome outcome = run_apart(program, other, {});
    if (kind_of(outcome.failure) != kind_of(first.failure)) continue;
    Found found = shrink_seed(program, other, outcome, options.most_tries - n_tries);
    n_tries += found.shrunk.n_tries;
    if (found.shrunk.kept.size() < best.shrunk.kept.size()) best = std::move(found);
  }
  const Repeat repeat{best.seed, best.shrunk.kept};
  const std::size_t n_all = best.outcome.taken.value_or(DecisionIds{}).size();
  const Outcome last = run_apart(program, best.seed, {.keep = repeat.keep, .in_words = true});
  if (kind_of(last.failure) != kind_of(first.failure))
    return report_of({seed, std::nullopt}, first,
                     "it did not fail again in the same way: the program depends on more than the "
                     "seed",
                     options.name);
  if (repeat.keep->empty())
    return report_of(repeat, last, "no disorder is needed: it fails in the plain order too",
                     options.name);
  const std::string also =
      best.seed == seed ? "" : text(" (seed ", seed, " fails too, and needs ", n_of_first, ")");
  return report_of(
      repeat, last,
      text("shrunk to ", repeat.keep->size(), " of ", count(n_all, "decision", "decisions"), " in ",
           count(n_tries, "try", "tries"), also,
           best.shrunk.is_minimal
               ? "; it passes without any one of these:"
               : ", which is the limit (SeedOptions::most_tries); these are left:"),
      options.name);
}

namespace {

// What a run that ends the process in its midst needs. Only one for_seeds() runs at a time.
struct Running {
  const Program& program;
  const SeedOptions& options;
  std::uint64_t seed;
  std::uint64_t end;  // of the seeds that may be tried; the seed itself: it is not shrunk
  Trial& trial;
};
const Running* running = nullptr;
std::array<char, 4096> crash_line{};  // written by the handler of a crash
std::array<struct sigaction, crashes.size()> handlers_before{};
CheckAbort abort_before = nullptr;

void on_check() {
  if (const Running* const run = std::exchange(running, nullptr)) {
    const Outcome found = outcome_so_far(check_failure, run->trial);
    const Repeat repeat{run->seed, run->trial.keep};
    std::fprintf(stderr, "%s\n",
                 (run->seed != run->end
                      ? explain(run->program, run->seed, run->end, found, run->options)
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
                    std::uint64_t end, Trial& trial) {
  const Running run{program, options, seed, end, trial};
  const Watch watch(run);
  return run_here(program, seed, trial);
}

void note(std::uint64_t seed, const char* what) {
  std::fprintf(stderr, "tessera: TESS_TEST_REPEAT: seed %llu %s\n",
               static_cast<unsigned long long>(seed), what);
}

}  // namespace

void note_absent(const Repeat& repeat, const Outcome& outcome) {
  const DecisionIds taken = outcome.taken.value_or(DecisionIds{});
  const auto n_absent = std::ranges::count_if(
      *repeat.keep, [&](DecisionId id) { return !std::ranges::binary_search(taken, id); });
  if (n_absent != 0)
    note(repeat.seed, text("lacks ", n_absent, " of ", repeat.keep->size(),
                           " decisions here: they are of another build, program or command line")
                          .c_str());
}

namespace {

void run_repeat(std::uint64_t first, std::uint64_t end, const Repeat& repeat,
                const Program& program, const SeedOptions& options) {
  if (repeat.seed < first || repeat.seed >= end) {
    note(repeat.seed, "is none of this test, which is skipped");
    return;
  }
  Trial trial{.keep = repeat.keep, .in_words = repeat.keep.has_value()};
  const std::uint64_t last = repeat.keep ? repeat.seed : repeat.seed + 1;
  const Outcome outcome = run_watched(program, options, repeat.seed, last, trial);
  if (repeat.keep) note_absent(repeat, outcome);
  if (!outcome.failure.empty())
    throw Failure(repeat.keep ? report_of(repeat, outcome, "with these decisions:", options.name)
                              : explain(program, repeat.seed, last, outcome, options));
  note(repeat.seed, "passes");
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
    const Outcome outcome = run_watched(program, options, seed, end, trial);
    if (!outcome.failure.empty()) throw Failure(explain(program, seed, end, outcome, options));
  }
}

}  // namespace tess::test::detail
