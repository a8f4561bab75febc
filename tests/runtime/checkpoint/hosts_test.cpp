// Which processes are on one host, and which PE keeps the copy of another's file.
#include "runtime/checkpoint/hosts.hpp"

#include "runtime/checkpoint/files.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <filesystem>

using tess::PeId;
using tess::detail::buddy_of;
using tess::detail::hosts_of;

TEST_CASE("a buddy is on another host, and in another process, if there is one",
          "[runtime][checkpoint]") {
  const std::vector<std::vector<std::string>> jobs{
      {"a"},           {"a", "a"},      {"a", "b"},           {"a", "a", "b"},
      {"a", "b", "b"}, {"a", "b", "a"}, {"a", "a", "b", "b"}, {"a", "b", "a", "b", "c"}};
  for (const auto& names : jobs) {
    for (const std::int32_t per_process : {1, 2, 3}) {
      const tess::detail::Hosts hosts = hosts_of(names, per_process);
      const auto n_pes = static_cast<std::int32_t>(names.size()) * per_process;
      REQUIRE(hosts.of_pe.size() == static_cast<std::size_t>(n_pes));
      const auto name = [&](PeId pe) {
        return names[static_cast<std::size_t>(pe.value / per_process)];
      };
      for (std::int32_t at = 0; at < n_pes; ++at) {
        const PeId buddy = buddy_of(PeId{at}, hosts, per_process);
        INFO("PE " << at << " of " << n_pes << ", its buddy " << buddy.value);
        REQUIRE(buddy.value >= 0);
        REQUIRE(buddy.value < n_pes);
        CHECK((name(buddy) != name(PeId{at})) == (hosts.first.size() > 1));
        CHECK((buddy.value / per_process != at / per_process) == (names.size() > 1));
        CHECK((buddy.value != at) == (n_pes > 1));
      }
    }
  }
  CHECK(hosts_of({"a", "b", "a", "c"}, 2).first == std::vector{PeId{0}, PeId{2}, PeId{6}});
}

TEST_CASE("processes that see the same folder are on one host", "[runtime][checkpoint]") {
  namespace fs = std::filesystem;
  const tess::test::Scratch scratch;
  fs::create_directories(scratch.path("one"));
  fs::create_directories(scratch.path("two"));
  fs::create_directory_symlink(scratch.path("one"), scratch.path("link"));
  const auto host = [&](const char* name) {
    return tess::detail::look_at(scratch.path(name)).host;
  };
  CHECK(host("one") == host("link"));
  CHECK(host("one") != host("two"));
  CHECK(host("one") != host("none"));
}

TEST_CASE("the checkpoints of all hosts are listed", "[runtime][checkpoint]") {
  const tess::detail::Listing listing = tess::detail::list_hosts(
      {{"a", {4, 3, 2}, {3, 2}}, {"b", {5, 3}, {3}}, {"a", {4, 3, 2}, {3, 2}}}, 1);
  CHECK(listing.numbers == std::vector<std::uint64_t>{5, 4, 3, 2});
  CHECK(listing.complete_on == std::vector<std::set<std::uint64_t>>{{2, 3}, {3}});
  CHECK_FALSE(listing.is_complete(5));
  CHECK_FALSE(listing.is_complete(4));
  CHECK(listing.is_complete(2));
}
