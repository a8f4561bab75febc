// Checkpoints that are damaged: each is refused with the file and what is wrong, and the one before
// is used.
#include "runtime/checkpoint.hpp"
#include "runtime/checkpoint/manifest.hpp"
#include "tests/runtime/checkpoint/runs.hpp"
#include "tests/runtime/checkpoint/world.hpp"
#include "tests/support/scratch.hpp"

#include <fstream>

namespace {

namespace fs = std::filesystem;
using tess::test::has;

tess::Task write_three(std::string folder) {
  world::State state;
  co_await world::make(state);
  for (int n = 0; n < 3; ++n) {
    co_await world::advance(state);
    co_await tess::checkpoint(folder, state);
  }
}

tess::Task read(std::string folder, std::int32_t& step) {
  const auto state = co_await tess::restart<world::State>(folder);
  step = state.step;
}

struct Outcome : tess::test::Ended {
  std::int32_t step = -1;
};

/// Three steps with a checkpoint after each; the last two checkpoints are kept.
void write_on(int n_pes, const std::string& folder) {
  tess::test::completes(n_pes, 4, [&] { return write_three(folder); });
}

/// Restarts on two PEs.
Outcome restart_from(const std::string& folder) {
  std::int32_t step = -1;
  const auto ended =
      tess::test::run_on(tess::test::adversarial(2, 5), [&] { return read(folder, step); });
  return {ended, step};
}

void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// Does damage to the latest of the two checkpoints that are kept, number 3, and restarts.
template <class Damage>
Outcome after(const Damage& damage) {
  const tess::test::Scratch scratch;
  const std::string folder = scratch.path("saved");
  write_on(3, folder);
  REQUIRE(tess::detail::numbers_in(folder) == std::vector<std::uint64_t>{3, 2});
  damage(tess::detail::folder_of(folder, 3) + "/");
  return restart_from(folder);
}

/// The report names the file and says what is wrong with it, and checkpoint 2 was used.
void refused(const Outcome& outcome, const std::string& file, const std::string& wrong) {
  INFO(outcome.report);
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.step == 2);
  CHECK(has(outcome.report, "checkpoint-000003/" + file));
  CHECK(has(outcome.report, wrong));
  CHECK(has(outcome.report, "checkpoint-000002\n"));
}

}  // namespace

TEST_CASE("a good checkpoint is used without a word", "[runtime][checkpoint]") {
  const Outcome outcome = after([](const std::string& /*path*/) {});
  CHECK(outcome.step == 3);
  CHECK(outcome.report.empty());
  CHECK(outcome.n_undelivered == 0);
}

TEST_CASE("a checkpoint with a missing file is refused by name", "[runtime][checkpoint]") {
  for (const char* file : {"pe-0", "pe-1", "pe-2", "main"}) {
    refused(after([file](const std::string& path) { fs::remove(path + file); }), file,
            "No such file");
  }
  refused(after([](const std::string& path) { fs::remove(path + "manifest.json"); }),
          "manifest.json", "is missing: the checkpoint was not finished");
}

TEST_CASE("a checkpoint with a truncated file is refused by name", "[runtime][checkpoint]") {
  for (const char* file : {"pe-2", "main"}) {
    for (const int left : {0, 1, 31, 32, -1}) {
      INFO(file << " " << left);
      refused(after([file, left](const std::string& path) {
                const auto size = fs::file_size(path + file);
                fs::resize_file(path + file,
                                left < 0 ? size - 1 : static_cast<std::uintmax_t>(left));
              }),
              file, "but the manifest says");
    }
    refused(after([file](const std::string& path) {
              fs::resize_file(path + file, fs::file_size(path + file) + 1);
            }),
            file, "but the manifest says");
  }
  refused(after([](const std::string& path) { fs::resize_file(path + "manifest.json", 40); }),
          "manifest.json", "is damaged");
}

TEST_CASE("a checkpoint with one flipped bit anywhere is refused by name",
          "[runtime][checkpoint]") {
  const tess::test::Scratch scratch;
  const std::string folder = scratch.path("saved");
  write_on(2, folder);
  const std::string path = tess::detail::folder_of(folder, 3) + "/";
  for (const char* file : {"pe-0", "main", "manifest.json"}) {
    const std::string good = tess::test::slurp(path + file);
    for (std::size_t n = 0; n < 40; ++n) {
      const std::size_t at = n < 32 ? n * 37 % good.size() : tess::mix(n) % good.size();
      const char bit = static_cast<char>(1 << n % 8);
      // White space between the words of JSON means nothing.
      if (std::string(file) == "manifest.json" && std::isspace(good[at]) != 0) continue;
      std::string bad = good;
      bad[at] = static_cast<char>(bad[at] ^ bit);
      write_bytes(path + file, bad);
      INFO("bit " << n % 8 << " of byte " << at << " of " << file);
      const Outcome outcome = restart_from(folder);
      INFO(outcome.report);
      CHECK(outcome.step == 2);
      CHECK(has(outcome.report, std::string("checkpoint-000003/") + file));
    }
    write_bytes(path + file, good);
  }
  CHECK(restart_from(folder).step == 3);
}

TEST_CASE("collections that do not fit each other are refused, also if all sums are right",
          "[runtime][checkpoint]") {
  namespace detail = tess::detail;
  // Checkpoint 3, whose file main is changed and whose sums are made again.
  const auto restart_with = [](const auto& change) {
    const tess::test::Scratch scratch;
    const std::string folder = scratch.path("saved");
    write_on(3, folder);
    const std::string path = detail::folder_of(folder, 3);
    detail::Manifest manifest = detail::read_manifest(path);
    const detail::Buffer bytes = detail::read_file(path, manifest.files.back());
    auto main = tess::from_bytes<detail::MainPart>({bytes.data(), bytes.size()});
    REQUIRE(main.collections.size() >= 2);
    change(main);
    fs::remove(path + "/main");
    manifest.files.back() = detail::write_file(path, "main", tess::to_bytes(main));
    fs::remove(path + "/manifest.json");
    detail::write_manifest(path, detail::to_text(manifest, main));
    return restart_from(folder);
  };
  const auto same = restart_with([](detail::MainPart& /*main*/) {});
  CHECK(same.step == 3);
  const auto other =
      restart_with([](detail::MainPart& main) { main.collections[0].id.value += 64; });
  CHECK(other.exit_code != 0);
  CHECK(has(other.report, "has elements of a collection"));
  const auto twice =
      restart_with([](detail::MainPart& main) { main.collections[0].id = main.collections[1].id; });
  CHECK(twice.exit_code != 0);
  CHECK(has(twice.report, "twice: restart from another checkpoint"));
}

TEST_CASE("a checkpoint of another version is refused by name", "[runtime][checkpoint]") {
  refused(after([](const std::string& path) {
            std::string bytes = tess::test::slurp(path + "pe-1");
            bytes[8] = 9;
            write_bytes(path + "pe-1", bytes);
          }),
          "pe-1", "has version 9, but this program reads 6");
  refused(after([](const std::string& path) {
            std::string text = tess::test::slurp(path + "manifest.json");
            const std::string one = "\"tessera_checkpoint\": 6";
            text.replace(text.find(one), one.size(), "\"tessera_checkpoint\": 8");
            write_bytes(path + "manifest.json", text);
          }),
          "manifest.json", "has version 8, but this program reads 6");
}

TEST_CASE("a checkpoint that a killed run left unfinished is refused, and removed by the next one",
          "[runtime][checkpoint]") {
  const tess::test::Scratch scratch;
  const std::string folder = scratch.path("saved");
  write_on(3, folder);
  const std::string partial = tess::detail::folder_of(folder, 4);
  fs::create_directory(partial);
  write_bytes(partial + "/pe-1.part", "half of a fil");
  write_bytes(partial + "/pe-0", "whatever");
  const Outcome outcome = restart_from(folder);
  CHECK(outcome.step == 3);
  CHECK(has(outcome.report, "checkpoint-000004/manifest.json is missing"));
  struct Next {
    static tess::Task main(const std::string& in) {
      auto state = co_await tess::restart<world::State>(in);
      co_await world::advance(state);
      co_await tess::checkpoint(in, state);
    }
  };
  tess::test::completes(2, 4, [&] { return Next::main(folder); });
  CHECK(tess::detail::numbers_in(folder) == std::vector<std::uint64_t>{5, 3});
  CHECK(restart_from(folder).step == 4);
}

TEST_CASE("a restart without a good checkpoint is an error that names the folder",
          "[runtime][checkpoint]") {
  const tess::test::Scratch scratch;
  const Outcome none = restart_from(scratch.path("nothing"));
  CHECK(none.exit_code == 2);
  CHECK(has(none.report, "nothing: no checkpoint is in this folder"));
  fs::create_directories(tess::detail::folder_of(scratch.path("saved"), 1));
  const Outcome bad = restart_from(scratch.path("saved"));
  CHECK(bad.exit_code == 2);
  CHECK(has(bad.report, "there is none before"));
  CHECK(has(bad.report, "no checkpoint in this folder can be used"));
}

TEST_CASE("a class that the program has not is named", "[runtime][checkpoint]") {
  const tess::test::Scratch scratch;
  const std::string folder = scratch.path("saved");
  write_on(3, folder);
  // The file "main" as another program would have written it.
  const std::string path = tess::detail::folder_of(folder, 3);
  tess::detail::Manifest manifest = tess::detail::read_manifest(path);
  const auto bytes = tess::detail::read_file(path, manifest.files.back());
  auto main = tess::from_bytes<tess::detail::MainPart>({bytes.data(), bytes.size()});
  const auto rewrite = [&] {
    manifest.files.back() = tess::detail::write_file(path, "main", tess::to_bytes(main));
    tess::detail::write_manifest(path, tess::detail::to_text(manifest, main));
    return restart_from(folder);
  };
  const std::string key = main.collections.front().key;
  main.collections.front().key = "of another program";
  const Outcome unknown = rewrite();
  CHECK(unknown.exit_code == 2);
  CHECK(has(unknown.report, "elements of the class world::Atom, which this program has not"));
  main.collections.front().key = key;
  manifest.program ^= 1;
  const Outcome other = rewrite();
  CHECK(other.exit_code == 2);
  CHECK(has(other.report, "other classes or entry methods"));
  manifest.program ^= 1;
  main.state_type = "Something";
  const Outcome state = rewrite();
  CHECK(state.exit_code == 2);
  CHECK(has(state.report, "a state of type Something, but restart<world::State>()"));
}
