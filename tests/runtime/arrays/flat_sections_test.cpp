// Lists of a section that are made again and again leave no memory behind, as the system sees it.
#include "runtime/more/section.hpp"
#include "runtime/runtime.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/resident.hpp"

namespace {

class Wanderer : public tess::Chare<Wanderer> {
 public:
  void move(tess::PeId to) { migrate_to(to); }
  void serialize(auto& /*ar*/) {}
};

/// After each multicast all members are elsewhere, so the next one needs new lists.
tess::Task move_often(tess::test::Growth& growth) {
  const auto wanderers = tess::create<Wanderer>(tess::range(32));
  const auto all = tess::create_section_if(wanderers, [](tess::Index1) { return true; });
  for (int round = 1; round <= growth.n_rounds(); ++round) {
    co_await tess::epoch([&] { all.broadcast<&Wanderer::move>(tess::PeId{round % 2}); });
    growth.after(round);
  }
}

TEST_CASE("lists of a section that are made ten thousand times leave memory flat",
          "[runtime][section]") {
  tess::test::Growth growth(10'000);
  tess::Setup setup{tess::make_threads_machine(2), {}};
  REQUIRE(tess::run(setup, [&]() -> tess::Task { return move_often(growth); }) == 0);
  INFO("grows by " << growth.bytes() << " bytes from round 2500 to 10000");
  REQUIRE(growth.bytes() >= 0);
  CHECK(growth.bytes() < 1 << 20);
}

}  // namespace
