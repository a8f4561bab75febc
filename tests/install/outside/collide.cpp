#include <collide/collide_serial.hpp>
#include <cstdio>
#include <vector>

using namespace tess::collide;

int main() {
  std::vector<Item> items;
  for (std::uint32_t i = 0; i < 4; ++i) {
    Item item{};
    item.box = {{0.8 * i, 0, 0}, {0.8 * i + 1, 1, 1}};
    item.id = {OwnerId{1}, LocalId(i), ModelId(i)};
    items.push_back(item);
  }
  int pairs = 0;
  collide_serial(items, VoxelGrid({0, 0, 0}, {1, 1, 1}), {},
                 [&](const Item&, const Item&) { ++pairs; });
  std::printf("pairs %d\n", pairs);
}
