// Paths of blocks in the oct-tree.
#include "apps/amr/block_index.hpp"

#include "tests/support/catch.hpp"

using namespace amr;

TEST_CASE("a path holds the level and the coordinates of a block", "[apps][amr]") {
  CHECK(BlockIndex{}.level() == 0);
  const BlockIndex index = BlockIndex{}.child(5).child(2);
  CHECK(index.level() == 2);
  CHECK(index.octant() == 2);
  CHECK(index.parent() == BlockIndex{}.child(5));
  CHECK(index.coordinates() == std::array<std::int32_t, 3>{2, 1, 2});
  for (std::int32_t x = 0; x < 8; ++x)
    CHECK(BlockIndex::at(3, {x, 7 - x, 3}).coordinates() ==
          std::array<std::int32_t, 3>{x, 7 - x, 3});
}

TEST_CASE("neighbours are mutual, and the cube is periodic", "[apps][amr]") {
  for (std::int32_t x = 0; x < 4; ++x)
    for (std::int32_t y = 0; y < 4; ++y)
      for (Face face = 0; face < n_faces; ++face) {
        const BlockIndex index = BlockIndex::at(2, {x, y, 3}), beside = index.neighbour(face);
        CHECK(beside != index);
        CHECK(beside.neighbour(face ^ 1) == index);
      }
  CHECK(BlockIndex::at(2, {3, 0, 1}).neighbour(1) == BlockIndex::at(2, {0, 0, 1}));
  CHECK(BlockIndex::at(2, {3, 0, 1}).neighbour(2) == BlockIndex::at(2, {3, 3, 1}));
  for (Face face = 0; face < n_faces; ++face) CHECK(BlockIndex{}.neighbour(face) == BlockIndex{});
}

TEST_CASE("a quarter of a face and the child that touches it name each other", "[apps][amr]") {
  for (Face face = 0; face < n_faces; ++face)
    for (std::int32_t quadrant = 0; quadrant < n_quadrants; ++quadrant) {
      const std::int32_t octant = octant_at(face, quadrant);
      CHECK(is_outer(octant, face));
      CHECK_FALSE(is_outer(octant, face ^ 1));
      CHECK(quadrant_of(octant, face / 2) == quadrant);
    }
}
