#include "runtime/arrays/typed/section_roster.hpp"

#include "tests/support/catch.hpp"

#include <map>
#include <vector>

using tess::PeId;
using tess::detail::Place;
using tess::detail::SectionRoster;
using tess::detail::Version;
using Lists = std::map<PeId, std::vector<std::uint32_t>>;

TEST_CASE("new lists have the members that have joined, at their newest places",
          "[runtime][section]") {
  SectionRoster roster;
  roster.create(4);
  CHECK(roster.n_unjoined() == 4);
  CHECK(roster.seen(0, Place{PeId{2}, Version{1, 5}}));
  CHECK(roster.seen(1, Place{PeId{3}, Version{1, 1}}));
  CHECK(roster.seen(3, Place{PeId{3}, Version{1, 1}}));
  CHECK_FALSE(roster.seen(0, Place{PeId{1}, Version{1, 4}}));  // overtaken by the newer place
  CHECK_FALSE(roster.gone(3));
  CHECK(roster.any_outside());
  CHECK(roster.new_lists() == Lists{{PeId{2}, {0}}, {PeId{3}, {1}}});
  CHECK_FALSE(roster.any_outside());
  CHECK(roster.n_unjoined() == 1);
}

TEST_CASE("a member that was destroyed before it joined does not come back", "[runtime][section]") {
  SectionRoster roster;
  roster.create(2);
  CHECK(roster.gone(1));
  CHECK_FALSE(roster.seen(1, Place{PeId{0}, Version{1, 1}}));
  CHECK(roster.n_unjoined() == 1);
  CHECK(roster.seen(0, Place{PeId{0}, Version{1, 1}}));
  CHECK(roster.new_lists() == Lists{{PeId{0}, {0}}});
}

TEST_CASE("new lists are wanted once a sixteenth of the members is stale", "[runtime][section]") {
  SectionRoster roster;
  roster.create(32);
  for (std::uint32_t i = 0; i < 32; ++i) CHECK(roster.seen(i, Place{PeId{0}, Version{1, 1}}));
  CHECK(roster.wants_lists());
  (void)roster.new_lists();
  CHECK_FALSE(roster.wants_lists());
  CHECK_FALSE(roster.gone(7));
  CHECK_FALSE(roster.wants_lists());  // 1 of 31
  CHECK_FALSE(roster.seen(8, Place{PeId{1}, Version{1, 2}}));
  CHECK(roster.wants_lists());
}
