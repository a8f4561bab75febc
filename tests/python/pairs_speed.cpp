// For speed.py: the library's pairs of the boxes in a file of doubles, six per box, in C++
// alone. Prints the processor's seconds of the fastest of N runs, and the number of pairs.
//
//     python_pairs_speed FILE N
#include "collide/pairs.hpp"

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

int main(int argc, char** argv) {
  using namespace tess::collide;
  std::FILE* const file = argc == 3 ? std::fopen(argv[1], "rb") : nullptr;
  if (file == nullptr) return 2;
  std::vector<Aabb> boxes;
  for (Aabb box; std::fread(&box, sizeof box, 1, file) == 1;) boxes.push_back(box);
  std::fclose(file);
  double best = HUGE_VAL;
  std::size_t n_pairs = 0;
  for (int run = 0; run < std::atoi(argv[2]); ++run) {
    const std::clock_t begin = std::clock();
    n_pairs = pairs(std::span<const Aabb>(boxes)).size();
    best = std::min(best, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  std::printf("%.9f %zu\n", best, n_pairs);
}
