// Planted errors are found, shrunk to the few decisions that they need, and repeated by the text
// that is printed; correct programs pass.
#include "runtime/more/testing/apart.hpp"
#include "tests/runtime/more/testing/programs.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numeric>

using namespace tess;
using namespace tess::test::planted;
using tess::test::Failure;
using tess::test::for_seeds;

namespace {

/// Sets TESS_TEST_REPEAT during a scope.
class Repeating {
 public:
  explicit Repeating(const std::string& text) { ::setenv("TESS_TEST_REPEAT", text.c_str(), 1); }
  Repeating(const Repeating&) = delete;
  Repeating& operator=(const Repeating&) = delete;
  ~Repeating() { ::unsetenv("TESS_TEST_REPEAT"); }
};

/// What for_seeds() throws for the first seed of 0 … n − 1 that fails; empty if all pass.
template <class Program>
std::string failure_of(std::uint64_t n, Program program, const test::SeedOptions& options = {}) {
  try {
    for_seeds(0, n, program, options);
  } catch (const Failure& failure) {
    return failure.what();
  }
  return {};
}

std::string between(const std::string& text, const std::string& before, char after) {
  const std::size_t at = text.find(before);
  if (at == std::string::npos) return {};
  const std::size_t from = at + before.size();
  return text.substr(from, text.find(after, from) - from);
}

/// The part of a failure between its number of decisions and its command: the decisions in words.
std::string decisions_of(const std::string& failure) {
  const std::size_t from = failure.find(":\n    ") + 2;
  return failure.substr(from, failure.find("\n  repeat with") - from);
}

/// The failure is shrunk to at most so many decisions, and the text that it gives repeats it.
template <class Program>
std::string check_found(Program program, std::size_t most_decisions) {
  const std::string failure = failure_of(1000, program);
  CAPTURE(failure);
  const std::string n_kept = between(failure, "shrunk to ", ' ');
  REQUIRE(!n_kept.empty());
  CHECK(std::stoul(n_kept) >= 1);
  CHECK(std::stoul(n_kept) <= most_decisions);
  CHECK(failure.find("it passes without any one of these") != std::string::npos);
  const std::string words = decisions_of(failure);
  CHECK(static_cast<std::size_t>(std::count(words.begin(), words.end(), '\n')) + 1 ==
        std::stoul(n_kept));

  const Repeating again(between(failure, "TESS_TEST_REPEAT=", ' '));
  const std::string repeated = failure_of(1000, program);
  CHECK(repeated.substr(0, repeated.find('\n')) == failure.substr(0, failure.find('\n')));
  CHECK(decisions_of(repeated) == words);
  CHECK(between(repeated, "TESS_TEST_REPEAT=", ' ') == between(failure, "TESS_TEST_REPEAT=", ' '));
  return failure;
}

/// Runs these cases of this program in a process of their own; returns what they print.
std::string output_of(const std::string& cases) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  std::FILE* const pipe = ::popen(("'" + program + "' '" + cases + "' 2>&1").c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::string output;
  std::array<char, 4096> block{};
  while (const std::size_t n = std::fread(block.data(), 1, block.size(), pipe))
    output.append(block.data(), n);
  CHECK(::pclose(pipe) != 0);
  return output;
}

void reports_in_order(std::uint64_t seed) {
  std::vector<int> order, wanted(static_cast<std::size_t>(n_reporters));
  std::iota(wanted.begin(), wanted.end(), 0);
  const test::Machine machine{.pes = 4, .per_process = 4, .seed = seed, .migration = 0};
  machine.run([&]() -> Task { return collect_in_order(order); }).require_success();
  test::expect(order == wanted, "the first report is of element ", order.front());
}

void counts_calls(std::uint64_t seed) {
  int n = 0;
  const test::Machine machine{.pes = 4, .per_process = 1, .seed = seed, .migration = 0.1};
  machine.run([&]() -> Task { return count_calls(n); }).require_success();
  test::expect(n == n_reporters * n_rounds, "some calls are not counted");
}

test::Result holds(std::uint64_t seed) {
  bool done = false;
  const test::Machine machine{.pes = 2, .seed = seed, .migration = 0.1};
  return machine.run([&]() -> Task { return hold(done); });
}

}  // namespace

TEST_CASE("two messages that are taken to arrive in order are found", "[runtime][testing]") {
  const std::string failure = check_found(&run_register<&Register::write_latest>, 2);
  CHECK(failure.find("the register holds 10") != std::string::npos);
  CHECK(failure.find("the message ") != std::string::npos);
  CHECK(failure.find("Register::write_latest from PE 0 to PE ") != std::string::npos);
  CHECK(failure.find(" behind ") != std::string::npos);
}

TEST_CASE("reports that are taken to arrive in order are found", "[runtime][testing]") {
  const std::string failure = check_found(&reports_in_order, 3);
  CHECK(failure.find("was delayed by ") != std::string::npos);
}

TEST_CASE("a member that serialize() forgets is found", "[runtime][testing]") {
  const std::string failure = check_found(&counts_calls, 2);
  CHECK(failure.find("Reporter[") != std::string::npos);
  CHECK(failure.find(" was moved from PE ") != std::string::npos);
  CHECK(failure.find(" after test::planted::Reporter::") != std::string::npos);
}

TEST_CASE("correct programs pass a thousand seeds", "[runtime][testing]") {
  CHECK(failure_of(1000, &run_register<&Register::write_newest>).empty());
}

TEST_CASE("a seed gives the same run each time, and another gives another", "[runtime][testing]") {
  const auto order_for = [](std::uint64_t seed) {
    std::vector<int> order;
    const test::Machine machine{.pes = 4, .seed = seed};
    machine.run([&]() -> Task { return collect_in_order(order); }).require_success();
    return order;
  };
  std::size_t n_different = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CHECK(order_for(seed) == order_for(seed));
    n_different += order_for(seed) == order_for(seed + 1) ? 0U : 1U;
  }
  CHECK(n_different > 10);
}

TEST_CASE("without disorder messages arrive as they are sent", "[runtime][testing]") {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    int found = 0;
    const test::Machine machine{.pes = 4, .seed = seed, .reordering = 0, .migration = 0};
    machine.run([&]() -> Task { return write_twice<&Register::write_latest>(found); })
        .require_success();
    REQUIRE(found == 20);
  }
}

TEST_CASE("a failure that needs no disorder says so", "[runtime][testing]") {
  const std::string failure = failure_of(10, [](std::uint64_t seed) {
    return test::Machine{.seed = seed}.run([] { throw std::runtime_error("always"); });
  });
  INFO(failure);
  CHECK(failure.find("seed 0 fails: exit code 1") == 0);
  CHECK(failure.find("always") != std::string::npos);
  CHECK(failure.find("no disorder is needed") != std::string::npos);
  CHECK(between(failure, "TESS_TEST_REPEAT=", ' ') == "seed=0,keep=none");
}

TEST_CASE("a run without end is stopped as a livelock", "[runtime][testing]") {
  const auto spin = [](const test::Machine& machine) {
    return machine.run([] { create<Spinner>(range(2))[{1}].send<&Spinner::spin>(); });
  };
  const test::Result by_events = spin({.pes = 2, .seed = 1, .most_events = 10'000});
  CHECK(by_events.exit_code == 3);
  CHECK(by_events.failure().find("more than 10000 events: is it a livelock?") != std::string::npos);
  const test::Result by_time = spin({.pes = 2, .seed = 1, .most_time = std::chrono::seconds(1)});
  CHECK(by_time.exit_code == 3);
  CHECK(by_time.failure().find("more than 1 s of virtual time") != std::string::npos);
  const test::Result plain = spin({.pes = 2, .seed = 1, .cost = {}, .most_events = 10'000});
  CHECK(plain.exit_code == 3);
}

TEST_CASE("a result says how the run ended", "[runtime][testing]") {
  const test::Machine machine{.pes = 3, .seed = 5};
  const test::Result good = machine.run([] {});
  CHECK(good.ok());
  CHECK(good.failure().empty());
  const test::Result thrown = machine.run([] { fail(ErrorCode::bad_value, "7 is not a size"); });
  CHECK(thrown.exit_code == 2);
  CHECK(thrown.exception == "7 is not a size");
  const test::Result unknown = machine.run([] { throw std::runtime_error("broken"); });
  CHECK(unknown.exit_code == 1);
  CHECK(unknown.exception == "broken");
  CHECK_THROWS_AS(unknown.require_success(), Failure);
  CHECK(machine.run([] { tess::exit(9); }).failure() == "exit code 9");
}

TEST_CASE("a program without a machine, a range without a seed and wrong options are refused",
          "[runtime][testing]") {
  CHECK(failure_of(3, [](std::uint64_t) {}).find("ran no tess::test::Machine") !=
        std::string::npos);
  CHECK_THROWS_AS(for_seeds(3, 3, [](std::uint64_t) {}), Error);
  const auto run = [](const test::Machine& machine) { return machine.run([] {}).exit_code; };
  CHECK_THROWS_AS(run({.pes = 0}), Error);
  CHECK_THROWS_AS(run({.pes = 4, .per_process = 3}), Error);
  CHECK_THROWS_AS(run({.reordering = 1.5}), Error);
  CHECK_THROWS_AS(run({.migration = -1}), Error);
}

TEST_CASE("the number of tries is bounded and printed", "[runtime][testing]") {
  const std::string failure = failure_of(1000, &counts_calls, {.most_tries = 2});
  CHECK(failure.find("in 2 tries, which is the limit") != std::string::npos);
  const std::string named =
      failure_of(1000, &counts_calls, {.name = "an element's state", .most_tries = 2});
  CHECK(named.find(" 'an element'\\''s state'") != std::string::npos);
}

TEST_CASE("a repeated seed runs alone", "[runtime][testing]") {
  std::vector<std::uint64_t> seeds;
  const auto note = [&](std::uint64_t seed) {
    seeds.push_back(seed);
    return test::Machine{.seed = seed}.run([] {});
  };
  const Repeating only("seed=6");
  for_seeds(0, 10, note);
  CHECK(seeds == std::vector<std::uint64_t>{6});
  for_seeds(7, 10, note);
  CHECK(seeds.size() == 1);
}

// The next two cases end their process, and are run by the ones behind them.
TEST_CASE("a neighbour is used after it has left", "[.][ends]") {
  for_seeds(0, 1000, &holds);
}
TEST_CASE("a program crashes with the fourth seed", "[.][crashes]") {
  for_seeds(0, 10, [](std::uint64_t seed) {
    if (seed == 3) std::abort();
    return test::Machine{.seed = seed}.run([] {});
  });
}

TEST_CASE("a check that fails ends the process with the shrunk decisions", "[runtime][testing]") {
  const std::string output = output_of("[ends]");
  INFO(output);
  CHECK(output.find("a neighbour has left") != std::string::npos);
  CHECK(output.find("fails: a check failed\n  shrunk to 1 of ") != std::string::npos);
  CHECK(output.find(" was moved from PE ") != std::string::npos);
  const std::string repeat = between(output, "TESS_TEST_REPEAT=", ' ');
  REQUIRE(repeat.find(",keep=") != std::string::npos);
  const Repeating again(repeat);
  const std::string repeated = output_of("[ends]");
  INFO(repeated);
  CHECK(repeated.find("a neighbour has left") != std::string::npos);
  CHECK(decisions_of(repeated) == decisions_of(output));
}

TEST_CASE("a crash ends the process with the seed", "[runtime][testing]") {
  const std::string output = output_of("[crashes]");
  INFO(output);
  CHECK(output.find("repeat with: TESS_TEST_REPEAT=seed=3 ") != std::string::npos);
}

TEST_CASE("a child process that exits or does not end says which decisions it took",
          "[runtime][testing]") {
  using namespace test::detail;
  enum class End { by_exit, in_no_entry_method, in_one };
  const auto end_of = [](End end) {
    const Program program = [end](std::uint64_t seed) -> std::string {
      int found = 0;
      const test::Machine machine{.pes = 4, .seed = seed, .most_events = 1'000'000'000};
      machine
          .run([&]() -> Task {
            co_await write_twice<&Register::write_newest>(found);
            if (end == End::by_exit) std::exit(7);  // NOLINT(concurrency-mt-unsafe)
            for (volatile bool goes_on = true; goes_on;)
              if (end == End::in_no_entry_method)
                co_await write_twice<&Register::write_newest>(found);
          })
          .require_success();
      return {};
    };
    return run_apart(program, 3, {});
  };
  const auto check = [&](End end, const std::string& failure) {
    const Outcome outcome = end_of(end);
    CHECK(outcome.failure == failure);
    REQUIRE(outcome.taken);
    CHECK(!outcome.taken->empty());
  };
  check(End::by_exit, "it ended the process with exit code 7");
  limit_children(1);
  check(End::in_no_entry_method, "it does not end; it was given 1 s");
  check(End::in_one, "it does not end; it was given 1 s");
  limit_children(0);
}

TEST_CASE("only the failure that was found is shrunk", "[runtime][testing]") {
  const auto count_with_another_failure = [](const std::string& of_wrong,
                                             const std::string& of_right) {
    bool has_failed = false;  // so in the child processes of the search
    return failure_of(1000, [&](std::uint64_t seed) -> std::string {
      int n = 0;
      const test::Machine machine{.pes = 4, .per_process = 1, .seed = seed, .migration = 0.1};
      machine.run([&]() -> Task { return count_calls(n); }).require_success();
      const bool is_wrong = n != n_reporters * n_rounds;
      if (has_failed) return is_wrong ? of_wrong : of_right;
      has_failed = is_wrong;
      return is_wrong ? "counted wrong" : "";
    });
  };
  const std::string shrunk = count_with_another_failure("counted wrong", "another failure");
  INFO(shrunk);
  CHECK(shrunk.find(" fails: counted wrong\n  shrunk to 1 of ") != std::string::npos);
  const std::string once = count_with_another_failure("another failure", "");
  INFO(once);
  CHECK(once.find(" fails: counted wrong\n  it did not fail again in the same way") !=
        std::string::npos);
}
