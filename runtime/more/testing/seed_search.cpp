// --sim seeds=FIRST..LAST: which order of messages makes a program print something else? It runs once
// in the plain order, then once per seed, each time in a child process. The first seed that prints
// something else is shrunk, as a test's is.
#include "runtime/pe/interfaces/seed_search.hpp"

#include "runtime/core/check.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/text.hpp"
#include "runtime/more/testing/disorder.hpp"
#include "runtime/more/testing/explain.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <sys/mman.h>
#include <unistd.h>

namespace tess::test::detail {
namespace {

using tess::detail::RuntimeOptions;
using tess::detail::SeedRange;

/// Takes what this process prints, as long as it lives.
class Capture {
 public:
  Capture() : file_(::memfd_create("output", MFD_CLOEXEC)), before_(::dup(STDOUT_FILENO)) {
    if (file_ < 0 || before_ < 0)
      fail(ErrorCode::environment, "--sim seeds: the output cannot be taken; free some files");
    std::fflush(stdout);
    ::dup2(file_, STDOUT_FILENO);
  }
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;
  ~Capture() {
    std::fflush(stdout);
    ::dup2(before_, STDOUT_FILENO);
    ::close(before_);
    ::close(file_);
  }
  [[nodiscard]] std::string text() const {
    std::fflush(stdout);
    std::string out;
    std::array<char, 4096> block{};
    while (true) {
      const ssize_t n = ::pread(file_, block.data(), block.size(), static_cast<off_t>(out.size()));
      if (n <= 0) return out;
      out.append(block.data(), static_cast<std::size_t>(n));
    }
  }

 private:
  int file_, before_;
};

/// Runs the program in this process, with the disorder of a seed and of the current trial.
int run_disturbed(const std::function<int()>& program, std::uint64_t seed) {
  std::optional<Disorder> disorder;
  const tess::detail::Disturb disturb = [&](SimulatedOptions& simulated, RuntimeOptions& options) {
    simulated.seed = seed;
    if (!simulated.cost) simulated.cost = Time(100);  // with which a run repeats bit for bit
    simulated.watches_cost = false;
    if (simulated.pes_per_process == 0)
      simulated.pes_per_process = simulated.n_pes;  // as it prints
    disorder.emplace(*current_trial(), simulated, options, 0.5);
  };
  struct Reset {
    Reset() = default;
    Reset(const Reset&) = delete;
    Reset& operator=(const Reset&) = delete;
    ~Reset() { tess::detail::disturb = nullptr; }
  } const reset;
  tess::detail::disturb = &disturb;
  return program();
}

/// What counts: in the lines with the word, it and what follows it.
std::string lines_with(std::string_view text, const std::string& word) {
  std::string out;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    const std::size_t at = line.find(word);
    if (at != std::string_view::npos) out.append(line.substr(at)).append("\n");
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  return out;
}

/// Where the output differs first; empty if it does not.
std::string difference(std::string_view plain, std::string_view found) {
  for (int number = 1; plain != found; ++number) {
    const std::string_view a = plain.substr(0, plain.find('\n'));
    const std::string_view b = found.substr(0, found.find('\n'));
    if (a != b || plain.empty() || found.empty())
      return text("it prints \"", b, "\" in line ", number, ", and \"", a, "\" in the plain order");
    plain.remove_prefix(std::min(a.size() + 1, plain.size()));
    found.remove_prefix(std::min(b.size() + 1, found.size()));
  }
  return {};
}

/// What a run says beside its output.
constexpr std::string_view success = "exit code 0\n";

int search(const SeedRange& given, const std::function<int()>& program) {
  const auto output = [&](std::uint64_t seed) {
    const Capture capture;
    const int code = run_disturbed(program, seed);
    return text("exit code ", code, "\n", capture.text());
  };
  const std::optional<Repeat> repeat = requested_repeat();
  SeedRange seeds = given;
  if (repeat) seeds.first = seeds.last = repeat->seed;
  const auto began = std::chrono::steady_clock::now();
  const Outcome plain = run_apart(output, seeds.first, {.keep = DecisionIds{}});
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  if (!plain.failure.starts_with(success)) {  // it says why, here
    Trial trial{.keep = DecisionIds{}};
    const InTrial in(trial);
    const int code = run_disturbed(program, seeds.first);
    if (code != 0) return code;
    fail(ErrorCode::bad_argument,
         "--sim seeds: the program does not end in the plain order: ", plain.failure);
  }
  const auto counted = [&](std::string_view all) {
    return lines_with(all.substr(success.size()), seeds.compare);
  };
  const std::string expected = counted(plain.failure);
  if (expected.empty())
    fail(ErrorCode::bad_argument,
         "--sim seeds: there is nothing to compare: the program prints no line",
         seeds.compare.empty() ? "" : " with '" + seeds.compare + "'", "; let it print its result");
  std::string shown;
  const Program compare = [&](std::uint64_t seed) {
    shown = output(seed);
    return shown.starts_with(success) ? difference(expected, counted(shown))
                                      : shown.substr(0, shown.find('\n'));
  };
  const Outcome again = run_apart(compare, seeds.first, {.keep = DecisionIds{}});
  if (!again.failure.empty())
    fail(ErrorCode::bad_argument,
         "--sim seeds: a second run in the plain order differs: ", again.failure,
         "; does the program print times, or find files that it wrote before? ",
         "compare=WORD compares only WORD and what follows it on a line");
  if (repeat && repeat->keep) {
    Trial trial{.keep = repeat->keep, .in_words = true};
    const Outcome outcome = run_here(compare, repeat->seed, trial);
    print_text(shown.substr(shown.find('\n') + 1));
    note_absent(*repeat, outcome);
    if (outcome.failure.empty()) return 0;
    std::fprintf(stderr, "tessera: %s\n",
                 report_of(*repeat, outcome, "with these decisions:", {}).c_str());
    return 1;
  }
  limit_children(10 + static_cast<unsigned>(10 * took.count()));
  for (std::uint64_t seed = seeds.first; seed <= seeds.last; ++seed) {
    const Outcome outcome = run_apart(compare, seed, {});
    if (outcome.failure.empty()) continue;
    std::fprintf(
        stderr, "tessera: %s%s\n", explain(compare, seed, seeds.last + 1, outcome, {}).c_str(),
        seeds.compare.empty()
            ? "\n  (times differ in any order: compare=WORD compares only WORD and what follows "
              "it on a line)"
            : "");
    return 1;
  }
  print_text(expected);
  std::fprintf(stderr, "tessera: the seeds %llu to %llu print the same as the plain order\n",
               static_cast<unsigned long long>(seeds.first),
               static_cast<unsigned long long>(seeds.last));
  return 0;
}

}  // namespace

// Before main(): the program that links this library offers --sim seeds=….
extern "C" {
extern const bool tess_seed_search_is_linked;  // the linker is asked for it (CMakeLists.txt)
const bool tess_seed_search_is_linked = (tess::detail::search_seeds = &search, true);
}

}  // namespace tess::test::detail
