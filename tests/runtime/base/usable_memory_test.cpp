#include "runtime/base/usable_memory.hpp"

#include "tests/support/catch.hpp"

#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <sys/mman.h>
#include <unistd.h>

namespace {
namespace fs = std::filesystem;

/// A tree of control groups.
struct Mount {
  Mount() { fs::create_directories(path); }
  ~Mount() { fs::remove_all(path); }
  Mount(const Mount&) = delete;
  Mount& operator=(const Mount&) = delete;

  void write(const fs::path& file, const char* text) const {
    fs::create_directories((path / file).parent_path());
    std::ofstream(path / file) << text << "\n";
  }
  [[nodiscard]] double limit(const std::string& groups) const {
    std::istringstream in(groups);
    return tess::detail::control_group_limit(in, path);
  }

  fs::path path = fs::temp_directory_path() / ("tess_groups_" + std::to_string(getpid()));
};

TEST_CASE("memory is limited by the least of a process's control groups and those above",
          "[runtime]") {
  const Mount mount;
  CHECK(mount.limit("0::/\n") == HUGE_VAL);
  mount.write("a/memory.max", "5000");
  mount.write("a/b/memory.max", "max");
  mount.write("a/c/memory.max", "3000");
  CHECK(mount.limit("0::/a/b\n") == 5000);
  CHECK(mount.limit("0::/a/c\n") == 3000);
  CHECK(mount.limit("0::/elsewhere/d\n") == HUGE_VAL);
  // Version 1: a tree of each controller, "no limit" is a large number.
  mount.write("memory/memory.limit_in_bytes", "9223372036854771712");
  mount.write("memory/job/memory.limit_in_bytes", "700");
  CHECK(mount.limit("4:memory:/job/x\n1:cpu:/job\n0::/\n") == 700);
  CHECK(mount.limit("4:memory:/\n") > 9e18);
  CHECK(mount.limit("1:cpu:/job\n") == HUGE_VAL);
  CHECK(mount.limit("no groups at all\n") == HUGE_VAL);
}

TEST_CASE("some memory can be used", "[runtime]") {
  CHECK(tess::detail::usable_memory() > 1e7);
  CHECK(tess::detail::usable_memory() < 1e16);
}

TEST_CASE("resident memory grows by the pages that are written", "[runtime]") {
  constexpr std::size_t n_bytes = 64U << 20U;
  // Not from the heap, which may have pages left from earlier tests.
  void* const pages =
      mmap(nullptr, n_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  REQUIRE(pages != MAP_FAILED);
  const std::uint64_t before = tess::detail::resident_memory();
  std::memset(pages, 1, n_bytes);
  const std::uint64_t with = tess::detail::resident_memory();
  munmap(pages, n_bytes);
  CHECK(with > before + n_bytes / 2);
  CHECK(with < before + 4 * n_bytes);
}

}  // namespace
