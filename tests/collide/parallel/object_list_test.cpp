// The owners of the objects of a list.
#include "collide/parallel/object_list.hpp"

#include "tests/support/catch.hpp"

#include <cstdint>
#include <vector>

namespace tess::collide {
namespace {

constexpr std::uint32_t n_in_list = 100, n_turns = 3;

/// Of each owner one object after another, with a number that says which.
std::vector<Item> in_turns() {
  std::vector<Item> items;
  for (std::uint32_t time = 0; time < n_turns; ++time)
    for (std::uint32_t owner = 0; owner < n_in_list; ++owner)
      items.push_back({{}, {OwnerId{owner}, LocalId{1000 * time + owner}, ModelId{owner / 2}}});
  return items;
}

/// Of the objects from `begin` on.
void check_in_turns(const ObjectList& list, std::uint32_t begin) {
  REQUIRE(list.size() == begin + n_turns * n_in_list);
  REQUIRE(list.sources().size() == n_in_list);
  for (std::uint32_t i = 0; i < n_turns * n_in_list; ++i) {
    const std::uint32_t object = begin + i, source = list.source(object), owner = i % n_in_list;
    CHECK(list.sources()[source].owner == OwnerId{owner});
    CHECK(list.model(object) == ModelId{owner / 2});
    CHECK(list.local(object, source) == LocalId{1000 * (i / n_in_list) + owner});
  }
}

}  // namespace

TEST_CASE("each of many owners is one source of a list, in whatever order their objects come",
          "[collide][parallel]") {
  const std::vector<Aabb> boxes(5);
  ObjectList list, copy;
  for (int time = 0; time < 2; ++time) {  // the memory is used again
    list.clear();
    list.append(in_turns(), {}, PeId{3});
    check_in_turns(list, 0);
    list.clear();
    list.append(Objects{OwnerId{1}, ModelId{0}, boxes, LocalId{50}}, PeId{3});
    list.append(in_turns(), {}, PeId{3});
    check_in_turns(list, 5);
    CHECK(list.source(0) == list.source(5 + 1));
    CHECK(list.local(4, list.source(4)) == LocalId{54});

    std::vector<search::Entry> entries, copies;
    for (std::uint32_t i = 5; i < list.size(); ++i) entries.push_back(search::make_entry(i, 0));
    copy.clear();
    copy.append(list, entries, copies);
    check_in_turns(copy, 0);
  }
}

}  // namespace tess::collide
