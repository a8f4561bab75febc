// What the kernel has noted of the pages of a block says whether large ones were asked for.
#include "tests/support/catch.hpp"

#include <cstdint>
#include <fstream>
#include <malloc.h>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <vector>

namespace {

constexpr std::size_t mib = std::size_t{1} << 20U;

bool has_large_pages() {
  std::ifstream mode("/sys/kernel/mm/transparent_hugepage/enabled");
  return static_cast<bool>(mode);
}

/// Whether the mapping that holds the address is advised to have large pages ("hg").
bool asks_for_large_pages(const void* address) {
  std::ifstream maps("/proc/self/smaps");
  const auto at = reinterpret_cast<std::uintptr_t>(address);
  bool is_here = false;
  for (std::string line; std::getline(maps, line);) {
    std::uintptr_t begin = 0, end = 0;
    char dash = 0;
    std::istringstream range(line);
    if (range >> std::hex >> begin >> dash >> end && dash == '-') is_here = begin <= at && at < end;
    if (is_here && line.starts_with("VmFlags:")) return line.find(" hg") != std::string::npos;
  }
  return false;
}

}  // namespace

TEST_CASE("large blocks ask for large pages, and small ones do not", "[core]") {
  if (!has_large_pages()) return;
  // Blocks of 128 KiB and more are mappings of their own, whatever was freed before.
  REQUIRE(mallopt(M_MMAP_THRESHOLD, 128 << 10) == 1);
  const std::vector<std::byte> large(64 * mib + 5), small(mib);
  CHECK(asks_for_large_pages(large.data() + 2 * mib));
  CHECK(asks_for_large_pages(large.data() + 61 * mib));
  CHECK_FALSE(asks_for_large_pages(small.data()));
}

TEST_CASE("blocks of any size and alignment can be written and freed", "[core]") {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{4096}, 4 * mib - 1,
                                 4 * mib, 4 * mib + 1, 9 * mib + 3})
    for (const std::size_t alignment :
         {std::size_t{1}, std::size_t{64}, std::size_t{4096}, 8 * mib}) {
      INFO(size << " bytes, aligned to " << alignment);
      const std::align_val_t align{alignment};
      auto* const block = static_cast<std::byte*>(alignment == 1 ? ::operator new(size)
                                                                 : ::operator new(size, align));
      REQUIRE(block != nullptr);
      CHECK(reinterpret_cast<std::uintptr_t>(block) % alignment == 0);
      if (size > 0) block[0] = block[size - 1] = std::byte{7};
      if (alignment == 1)
        ::operator delete(block);
      else
        ::operator delete(block, align);
    }
}

TEST_CASE("a block that cannot exist throws bad_alloc", "[core]") {
  volatile std::size_t too_large = SIZE_MAX - 100;
  CHECK_THROWS_AS(::operator new(too_large), std::bad_alloc);
  CHECK_THROWS_AS(::operator new(too_large, std::align_val_t{4096}), std::bad_alloc);
}
