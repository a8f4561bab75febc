#include "runtime/base/pool.hpp"

#include "tests/support/catch.hpp"

#include <cstring>
#include <set>
#include <thread>
#include <vector>

namespace tess::detail {
namespace {

TEST_CASE("blocks of all sizes are aligned, apart and writable", "[runtime][base]") {
  Pool pool;
  std::vector<std::pair<unsigned char*, std::size_t>> blocks;
  for (std::size_t bytes = 0; bytes < 3000; bytes += 7) {
    auto* const block = static_cast<unsigned char*>(pool.allocate(bytes));
    REQUIRE(reinterpret_cast<std::uintptr_t>(block) % 16 == 0);
    std::memset(block, static_cast<int>(bytes % 251), bytes);
    blocks.emplace_back(block, bytes);
  }
  std::size_t n_changed = 0;
  for (const auto& [block, bytes] : blocks)
    for (std::size_t i = 0; i < bytes; ++i)
      if (block[i] != bytes % 251) ++n_changed;
  CHECK(n_changed == 0);
  for (const auto& [block, bytes] : blocks) Pool::release(block, &pool);
}

// Under AddressSanitizer no pool reuses a block: these cases are left out there.
constexpr const char* with_reuse = Pool::reuses_blocks ? "[runtime][base]" : "[.][reuse]";

TEST_CASE("a freed block is the next one of its size", with_reuse) {
  Pool pool;
  void* const a = pool.allocate(100);
  Pool::release(a, &pool);
  CHECK(pool.allocate(110) == a);
  Pool::release(a, &pool);
}

std::set<void*> allocate_forty(Pool& pool) {
  std::set<void*> blocks;
  for (int i = 0; i < 40; ++i) blocks.insert(pool.allocate(1000));
  REQUIRE(blocks.size() == 40);
  return blocks;
}

TEST_CASE("blocks freed by another pool come home", with_reuse) {
  Pool home, other;
  const std::set<void*> blocks = allocate_forty(home);
  const std::size_t held = home.held_bytes();
  for (void* block : blocks) Pool::release(block, &other);
  other.flush();
  const std::set<void*> again = allocate_forty(home);
  CHECK(home.held_bytes() == held);
  CHECK(other.held_bytes() == 0);
  for (void* block : again) Pool::release(block, &home);
}

TEST_CASE("blocks freed by a thread without a pool come home", with_reuse) {
  Pool home;
  const std::set<void*> blocks = allocate_forty(home);
  const std::size_t held = home.held_bytes();
  for (void* block : blocks) Pool::release(block, nullptr);
  const std::set<void*> again = allocate_forty(home);
  CHECK(home.held_bytes() == held);
  for (void* block : again) Pool::release(block, &home);
}

// AddressSanitizer also checks that these blocks are freed once.
TEST_CASE("no pool holds a block of a thread without a pool", "[runtime][base]") {
  Pool pool;
  const auto new_block = [] {
    void* const block = Pool::allocate(64, nullptr);
    CHECK(reinterpret_cast<std::uintptr_t>(block) % 16 == 0);
    std::memset(block, 0xAB, 64);
    return block;
  };
  Pool::release(new_block(), &pool);
  Pool::release(new_block(), nullptr);
  CHECK(pool.held_bytes() == 0);
}

// The oracle is the count in flight: never more than `most`, so the pool may hold little more.
TEST_CASE("a flow in one direction does not accumulate memory", "[runtime][base]") {
  constexpr int n_blocks = 100'000;
  constexpr int most = 500;
  Pool producer, consumer;
  MpscQueue inbox;
  std::atomic<int> n_in_flight{0};
  std::jthread other([&] {
    for (int n = 0; n < n_blocks;) {
      Link* link = inbox.take_all();
      if (link == nullptr) std::this_thread::yield();
      while (link != nullptr) {
        Link* const next = link->next;
        Pool::release(link, &consumer);
        link = next;
        ++n;
        --n_in_flight;
      }
    }
    consumer.flush();
  });
  for (int i = 0; i < n_blocks; ++i) {
    while (n_in_flight.load() >= most) std::this_thread::yield();
    ++n_in_flight;
    inbox.push(::new (producer.allocate(40)) Link);
  }
  other.join();
  if (Pool::reuses_blocks) CHECK(producer.held_bytes() < 200'000);
  CHECK(consumer.held_bytes() == 0);
}

}  // namespace
}  // namespace tess::detail
