// The checkpoints of one run are never mixed with those of another: which folder a run may write
// to, and which checkpoints it keeps there.
#include "runtime/checkpoint.hpp"
#include "runtime/checkpoint/files.hpp"
#include "runtime/core/error.hpp"
#include "tests/runtime/checkpoint/runs.hpp"
#include "tests/runtime/checkpoint/world.hpp"
#include "tests/support/scratch.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <set>
#include <span>
#include <sys/syscall.h>
#include <unistd.h>
#include <vector>

namespace {

std::mutex of_synced;
std::set<std::string> synced;  // all paths that fsync() made durable

}  // namespace

/// In place of the C library's.
extern "C" int fsync(int file) {
  std::array<char, 4096> path{};
  const std::string link = "/proc/self/fd/" + std::to_string(file);
  if (::readlink(link.c_str(), path.data(), path.size() - 1) > 0) {
    const std::scoped_lock lock(of_synced);
    synced.insert(path.data());
  }
  return static_cast<int>(::syscall(SYS_fsync, file));
}

namespace {

namespace fs = std::filesystem;
using Numbers = std::vector<std::uint64_t>;

/// Some steps with a checkpoint after each, which begin with a restart if `from` is given. A
/// checkpoint that is refused is reported, and the steps go on.
struct Job {
  std::string from, folder;
  int n_steps = 1;
  std::string second{};  ///< each checkpoint is written into this folder, too
  std::string other{};   ///< after the first step this checkpoint is put into the folder
  std::string refused{};
  std::int32_t step = 0;

  tess::Task run() {
    world::State state;
    if (from.empty()) {
      co_await world::make(state);
    } else {
      state = co_await tess::restart<world::State>(from);
    }
    for (int n = 0; n < n_steps; ++n) {
      co_await world::advance(state);
      try {
        co_await tess::checkpoint(folder, state);
        if (!second.empty()) co_await tess::checkpoint(second, state);
      } catch (const tess::Error& error) {
        refused += error.what();
      }
      if (n == 0 && !other.empty())
        fs::copy(other, tess::detail::folder_of(folder, 9), fs::copy_options::recursive);
    }
    step = state.step;
  }
};

Job run(Job job) {
  tess::test::completes(3, 7, [&] { return job.run(); });
  return job;
}

}  // namespace

TEST_CASE("a run that begins anew writes no checkpoint beside those of another run",
          "[runtime][checkpoint]") {
  const tess::test::Scratch scratch;
  const std::string folder = scratch.path("saved");
  const Job first = run({.from = "", .folder = folder, .n_steps = 2});
  CHECK(first.refused.empty());
  CHECK(tess::latest_checkpoint(folder) == tess::detail::folder_of(folder, 2));

  const Job anew = run({.from = "", .folder = folder});
  CHECK(anew.refused == folder +
                            "/checkpoint-000002 is a checkpoint of another run: restart from " +
                            folder + ", or give another folder");
  CHECK(anew.step == 1);
  CHECK(tess::detail::numbers_in(folder) == Numbers{2, 1});
  CHECK(fs::exists(folder + "/checkpoint-000001/manifest.json"));

  // Nor does one that restarted elsewhere; the folder may be written in any way.
  const Job elsewhere = run({.from = "", .folder = scratch.path("elsewhere")});
  const Job mixed = run({.from = scratch.path("elsewhere"), .folder = folder});
  CHECK_FALSE(mixed.refused.empty());
  const Job same = run({.from = folder, .folder = scratch.path("elsewhere/../saved/.")});
  CHECK(same.refused.empty());
  CHECK(tess::detail::numbers_in(folder) == Numbers{3, 2});
}

TEST_CASE("a run with two folders goes on with both after a restart from one",
          "[runtime][checkpoint]") {
  const tess::test::Scratch scratch;
  const std::string often = scratch.path("often"), rarely = scratch.path("rarely");
  const Job first = run({.from = "", .folder = often, .n_steps = 2, .second = rarely});
  const Job again = run({.from = often, .folder = often, .n_steps = 2, .second = rarely});
  CHECK(again.refused.empty());
  CHECK(tess::detail::numbers_in(rarely) == Numbers{4, 3});
  std::ofstream(tess::detail::folder_of(rarely, 4) + "/manifest.json") << "{";
  const Job past_damage = run({.from = often, .folder = often, .second = rarely});
  CHECK(past_damage.refused.empty());
  CHECK(tess::latest_checkpoint(rarely) == tess::detail::folder_of(rarely, 5));

  const Job other = run({.from = "", .folder = scratch.path("other"), .second = rarely});
  CHECK(other.refused.find("rarely/checkpoint-000005 is a checkpoint of another run") !=
        std::string::npos);
}

TEST_CASE("two runs that restart from one checkpoint write into folders of their own",
          "[runtime][checkpoint]") {
  const tess::test::Scratch scratch;
  const std::string saved = scratch.path("saved"), beside = scratch.path("beside");
  const Job common = run({.from = "", .folder = saved, .second = beside});
  const Job one = run({.from = saved, .folder = scratch.path("one"), .n_steps = 2});
  CHECK(one.refused.empty());
  const Job two = run({.from = saved, .folder = one.folder});
  CHECK(two.refused.find("one/checkpoint-000002 is a checkpoint of another run") !=
        std::string::npos);
  CHECK(tess::detail::numbers_in(one.folder) == Numbers{2, 1});
  const Job further = run({.from = one.folder, .folder = one.folder});
  CHECK(further.refused.empty());
  CHECK(tess::detail::numbers_in(one.folder) == Numbers{3, 2});

  // A folder that the common run began may be gone on with again when a restart was in vain.
  for (const std::uint64_t number : {2U, 3U}) {
    const Job again = run({.from = saved, .folder = beside});
    CHECK(again.refused.empty());
    CHECK(tess::detail::numbers_in(beside) == Numbers{number, number - 1});
    if (number == 2) continue;
    const Job too_late = run({.from = saved, .folder = beside});
    CHECK_FALSE(too_late.refused.empty());  // both that are left are of those restarts
  }
}

TEST_CASE("a checkpoint that another run writes meanwhile is noticed", "[runtime][checkpoint]") {
  const tess::test::Scratch scratch;
  const Job other = run({.from = "", .folder = scratch.path("other")});
  Job job{.from = "", .folder = scratch.path("saved"), .n_steps = 2};
  job.other = tess::latest_checkpoint(other.folder);
  job = run(job);
  CHECK(job.refused.find("checkpoint-000009 is a checkpoint of another run") != std::string::npos);
}

TEST_CASE("what a killed run left unfinished does not prevent a new run", "[runtime][checkpoint]") {
  const tess::test::Scratch scratch;
  const std::string folder = scratch.path("saved");
  CHECK(tess::latest_checkpoint(folder).empty());
  fs::create_directories(tess::detail::folder_of(folder, 1));
  CHECK(tess::latest_checkpoint(folder).empty());
  const Job job = run({.from = "", .folder = folder});
  CHECK(job.refused.empty());
  CHECK(tess::detail::numbers_in(folder) == Numbers{2});
}

TEST_CASE("a damaged checkpoint is not one of those that are kept", "[runtime][checkpoint]") {
  const tess::test::Scratch scratch;
  const std::string folder = scratch.path("saved");
  const Job job = run({.from = "", .folder = folder, .n_steps = 3});
  CHECK(tess::detail::numbers_in(folder) == Numbers{3, 2});
  fs::resize_file(tess::latest_checkpoint(folder) + "/main", 5);
  const Job next = run({.from = folder, .folder = folder});
  CHECK(next.step == 3);
  CHECK(tess::detail::numbers_in(folder) == Numbers{4, 2});
}

TEST_CASE("each folder that is made for a checkpoint is an entry of a folder that is durable",
          "[runtime][checkpoint]") {
  const tess::test::Scratch scratch;
  const fs::path root = fs::canonical(scratch.path(""));
  for (const char* name : {"a/b/c", "d/e/", "f/../g/./h"}) {
    CAPTURE(name);
    const std::string folder = scratch.path(name);
    synced.clear();
    const Job job = run({.from = "", .folder = folder});
    REQUIRE(job.refused.empty());
    fs::path at = fs::canonical(tess::latest_checkpoint(folder));
    CHECK(synced.contains(at / "main.part"));  // its name until it is durable
    for (; at != root; at = at.parent_path()) {
      CAPTURE(at);
      CHECK(synced.contains(at.parent_path()));
    }
  }
}

TEST_CASE("a checksum knows the order of a file's blocks, and the length of the last",
          "[runtime][checkpoint]") {
  constexpr std::size_t block = std::size_t{1} << 20U;
  std::vector<std::byte> bytes(3 * block + 5);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i / block);
  const auto hash = [&] { return tess::detail::sum_of("file", bytes).hash; };
  const std::uint64_t before = hash();
  std::swap_ranges(bytes.begin(), bytes.begin() + block, bytes.begin() + 2 * block);
  CHECK(hash() != before);
  std::swap_ranges(bytes.begin(), bytes.begin() + block, bytes.begin() + 2 * block);
  CHECK(hash() == before);
  bytes.push_back(std::byte{0});
  CHECK(hash() != before);
}

TEST_CASE("a file that is written piece by piece has the bytes of one written at once",
          "[runtime][checkpoint]") {
  const tess::test::Scratch scratch;
  std::vector<std::byte> bytes(2'500'000);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i * i >> 7U);
  tess::detail::FileWriter writer(scratch.path(""), "pieces");
  tess::detail::Buffer pending;
  for (std::span<const std::byte> rest(bytes); !rest.empty();) {
    const std::size_t n = std::min<std::size_t>(700'000, rest.size());
    pending.append(rest.first(n));
    writer.write_some(pending);
    rest = rest.subspan(n);
  }
  const tess::detail::FileSum sum = writer.finish({pending.data(), pending.size()});
  CHECK(sum.n_bytes == bytes.size());
  CHECK(sum.hash == tess::detail::sum_of("pieces", bytes).hash);
  const tess::detail::Buffer read = tess::detail::read_file(scratch.path(""), sum);
  CHECK(std::equal(bytes.begin(), bytes.end(), read.data(), read.data() + read.size()));
}

TEST_CASE("only folders that are named as a checkpoint count as one", "[runtime][checkpoint]") {
  const tess::test::Scratch scratch;
  for (const char* name : {"checkpoint-000002", "checkpoint-000010", "checkpoint-000007.old",
                           "checkpoint-", "checkpoint-x", "old-checkpoint-000011", "000012"})
    fs::create_directories(scratch.path(name));
  CHECK(tess::detail::numbers_in(scratch.path("")) == Numbers{10, 2});
}
