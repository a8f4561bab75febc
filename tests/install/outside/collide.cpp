#include <collide/pairs.hpp>
#include <cstdio>
#include <vector>

using namespace tess::collide;

int main() {
  std::vector<Aabb> boxes;
  for (int i = 0; i < 4; ++i) boxes.push_back({{0.8 * i, 0, 0}, {0.8 * i + 1, 1, 1}});
  std::vector<int> partners(boxes.size());
  for_each_pair(std::span<const Aabb>(boxes), {}, [&](std::uint32_t a, std::uint32_t b) {
    ++partners[a];
    ++partners[b];
  });
  std::printf("pairs %d\n", (partners[0] + partners[1] + partners[2] + partners[3]) / 2);
}
