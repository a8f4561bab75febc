// Buddy copies: every file of a checkpoint is kept twice, and a restart uses the copy of one that
// is damaged or lost.
#include "runtime/checkpoint.hpp"
#include "runtime/checkpoint/files.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/runtime/checkpoint/runs.hpp"
#include "tests/runtime/checkpoint/world.hpp"
#include "tests/support/scratch.hpp"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sys/resource.h>

namespace {

namespace fs = std::filesystem;

using tess::test::has;
constexpr std::int32_t last_step = 6;

/// From step `first`, with a restart unless it is 0, to step `last`, with a checkpoint after each.
tess::Task steps(std::string folder, std::int32_t first, std::int32_t last, world::State& state) {
  if (first == 0) {
    co_await world::make(state);
  } else {
    state = co_await tess::restart<world::State>(folder);
  }
  while (state.step < last) {
    co_await world::advance(state);
    co_await tess::checkpoint(folder, state, {.buddy_copies = true});
  }
}

struct Ended : tess::test::Ended {
  std::uint64_t log = 0;
};

Ended run(tess::Setup setup, const std::string& folder, std::int32_t first, std::int32_t last) {
  world::State state;
  const auto ended =
      tess::test::run_on(std::move(setup), [&] { return steps(folder, first, last, state); });
  return {ended, state.log};
}

std::uint64_t log_of_whole() {
  static const std::uint64_t log = [] {
    const tess::test::Scratch scratch;
    const Ended whole = run(tess::test::adversarial(3, 1), scratch.path("saved"), 0, last_step);
    REQUIRE(whole.exit_code == 0);
    return whole.log;
  }();
  return log;
}

void flip_a_bit(const std::string& path, std::size_t at) {
  std::string bytes = tess::test::slurp(path);
  char& one = bytes.at(at % bytes.size());
  one = static_cast<char>(one ^ 4);
  std::ofstream(path, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

TEST_CASE("a run restarts from copies of files that are damaged or lost", "[runtime][checkpoint]") {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    INFO("seed " << seed);
    const tess::test::Scratch scratch;
    const std::string folder = scratch.path("saved");
    const auto draw = [&](std::uint64_t what, std::uint64_t n) {
      return tess::mix(seed * 64 + what) % n;
    };
    const auto n_pes = static_cast<int>(1 + draw(0, 5));
    const auto stop = static_cast<std::int32_t>(1 + draw(1, last_step - 1));
    REQUIRE(run(tess::test::adversarial(n_pes, seed), folder, 0, stop).report.empty());
    // Of each pair one is damaged, one is lost, or both are good.
    const std::string latest = tess::latest_checkpoint(folder);
    std::vector<std::string> damaged;
    for (int pe = 0; pe < n_pes; ++pe) {
      const auto key = static_cast<std::uint64_t>(10 * pe);
      const std::string own = latest + "/pe-" + std::to_string(pe);
      const std::string one = draw(key + 2, 2) == 0 ? own : own + ".copy";
      REQUIRE(tess::test::slurp(own) == tess::test::slurp(own + ".copy"));
      if (const auto what = draw(key + 3, 3); what == 0) {
        flip_a_bit(one, draw(key + 4, 1000));
        if (one == own) damaged.push_back(one);
      } else if (what == 1) {
        fs::remove(one);
      }
    }
    const Ended next = run(tess::test::adversarial(static_cast<int>(1 + draw(5, 6)), seed + 1000),
                           folder, stop, last_step);
    INFO(next.report);
    CHECK(next.exit_code == 0);
    CHECK(next.log == log_of_whole());
    CHECK(static_cast<std::size_t>(std::ranges::count(next.report, '\n')) == damaged.size());
    for (const std::string& file : damaged)
      CHECK(has(next.report, "a file of a checkpoint is refused: " + file + " "));
  }
}

TEST_CASE("a checkpoint whose file and copy are both damaged is refused by name",
          "[runtime][checkpoint]") {
  const auto after = [](auto damage) {
    const tess::test::Scratch scratch;
    const std::string folder = scratch.path("saved");
    REQUIRE(run(tess::test::adversarial(3, 1), folder, 0, 3).report.empty());
    damage(tess::latest_checkpoint(folder));
    const Ended next = run(tess::test::adversarial(2, 2), folder, 3, last_step);
    CHECK(next.exit_code == 0);
    CHECK(next.log == log_of_whole());
    CHECK(has(next.report, "a checkpoint is refused: "));
    CHECK(has(next.report, "; the one before is used: "));
    return next.report;
  };
  const std::string damaged = after([](const std::string& path) {
    flip_a_bit(path + "/pe-1", 90);
    flip_a_bit(path + "/pe-1.copy", 91);
  });
  INFO(damaged);
  CHECK(has(damaged, "/checkpoint-000003/pe-1.copy is damaged"));
  const std::string lost = after([](const std::string& path) {
    fs::remove(path + "/pe-2");
    fs::remove(path + "/pe-2.copy");
  });
  INFO(lost);
  CHECK(has(lost, "/checkpoint-000003/pe-2 is on no host of this run, nor is its copy pe-2.copy"));
  const std::string half = after([](const std::string& path) {
    fs::remove(path + "/pe-2");
    fs::resize_file(path + "/pe-2.copy", 40);
  });
  INFO(half);
  CHECK(has(half, "/checkpoint-000003/pe-2.copy has 40 bytes, but the manifest says"));
}

namespace {

/// Files of this process cannot grow beyond so many bytes, as if the memory were full.
class FileLimit {
 public:
  explicit FileLimit(rlim_t n_bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit less{n_bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &less);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  FileLimit(const FileLimit&) = delete;
  FileLimit& operator=(const FileLimit&) = delete;
  ~FileLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    (void)std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

struct Full {
  static tess::Task main(std::string folder, std::string& error) {
    world::State state;
    co_await steps(folder, 0, 2, state);
    try {
      const FileLimit limit(40);
      co_await tess::checkpoint(folder, state, {.buddy_copies = true});
    } catch (const tess::Error& wrong) {
      error = wrong.what();
    }
    co_await world::advance(state);
    co_await tess::checkpoint(folder, state, {.buddy_copies = true});
  }
};

}  // namespace

TEST_CASE("a checkpoint that cannot be written is removed, and the run goes on",
          "[runtime][checkpoint]") {
  const tess::test::Scratch scratch;
  const std::string folder = scratch.path("saved");
  std::string error;
  tess::test::completes(3, 5, [&] { return Full::main(folder, error); });
  INFO(error);
  CHECK(has(error, "the checkpoint failed: " + folder + "/checkpoint-000003/pe-"));
  CHECK(has(error, "cannot be written: File too large"));
  // Number 3 was removed and is given again.
  CHECK(tess::detail::numbers_in(folder) == std::vector<std::uint64_t>{3, 2});
  CHECK(run(tess::test::adversarial(2, 2), folder, 3, last_step).log == log_of_whole());
}

namespace {

struct Noted {
  static tess::Task main(std::string folder, std::string& error) {
    world::State state;
    try {
      co_await tess::checkpoint(folder, state, {}, "caf\xe9");
    } catch (const tess::Error& wrong) {
      error = wrong.what();
    }
    co_await steps(folder, 0, 2, state);
  }
};

}  // namespace

TEST_CASE("a note that is no UTF-8 is refused, and the run goes on", "[runtime][checkpoint]") {
  const tess::test::Scratch scratch;
  const std::string folder = scratch.path("saved");
  std::string error;
  tess::test::completes(3, 5, [&] { return Noted::main(folder, error); });
  CHECK(has(error, "the note of a checkpoint is no text in UTF-8"));
  CHECK(tess::detail::numbers_in(folder) == std::vector<std::uint64_t>{2, 1});
}

TEST_CASE("buddy copies on threads", "[runtime][checkpoint]") {
  for (int i = 0; i < 4; ++i) {
    const tess::test::Scratch scratch;
    const std::string folder = scratch.path("saved");
    REQUIRE(run({tess::make_threads_machine(1 + i), {}}, folder, 0, 2 + i).report.empty());
    fs::remove(tess::latest_checkpoint(folder) + "/pe-" + std::to_string(i / 2));
    const Ended next = run({tess::make_threads_machine(4 - i), {}}, folder, 2 + i, last_step);
    CHECK(next.report.empty());
    CHECK(next.log == log_of_whole());
  }
}
