#include "tests/fuzz/collide/look.hpp"

#include "runtime/core/hash.hpp"

#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace collide_fuzz {
namespace {

template <class T, std::size_t N>
T one_of(tess::Random& random, const std::array<T, N>& values) {
  return values[random.below(N)];
}

/// Most scenes are small; one in 25 has so many objects that voxels are chosen and divided.
std::uint32_t drawn_size(tess::Random& random) {
  const std::uint64_t kind = random.below(50);
  if (kind < 2) return static_cast<std::uint32_t>(600 + random.below(3000));
  if (kind < 15) return static_cast<std::uint32_t>(100 + random.below(200));
  return static_cast<std::uint32_t>(random.below(100));
}

}  // namespace

Look look_of(std::uint64_t seed) {
  tess::Random random(tess::mix(seed + 0x636f6c6c));
  Look look;
  look.seed = seed;
  look.shape = static_cast<Shape>(random.below(shape_names.size()));
  look.place =
      random.chance(0.3) ? Place::lattice : static_cast<Place>(random.below(place_names.size()));
  look.n = drawn_size(random);
  look.scale = one_of(random, std::array{1.0, 1.0, 1.0, 1e9, 1e-9, 0x1p-20, 1e3});
  look.offset = one_of(random, std::array{0.0, 0.0, 0.0, 1e12, -1e12, -3.7, 1e3}) *
                one_of(random, std::array{1.0, look.scale});
  look.largest = one_of(random, std::array{0.02, 0.1, 0.3, 1.0});
  look.decades = one_of(random, std::array{0.0, 0.0, 1.0, 3.0, 6.0});
  look.no_extent = one_of(random, std::array{0.0, 0.1, 0.5, 1.0});
  look.repeated = one_of(random, std::array{0.0, 0.1, 0.4});
  look.degenerate = one_of(random, std::array{0.0, 0.1, 0.5, 0.95});
  look.has_large_one = random.chance(0.1);
  look.n_models = static_cast<std::uint32_t>(1 + random.below(4));
  look.within_model =
      random.chance(0.4) ? tess::collide::WithinModel::test : tess::collide::WithinModel::skip;
  look.touching = random.chance(0.6) ? tess::collide::Touching::counts
                                     : tess::collide::Touching::does_not_count;
  const double size = one_of(random, std::array{0.0, 0.05, 0.1, 0.3, 0.125, 0.25, 1.0, 4.0});
  look.voxel_size = size * (random.chance(0.8) ? look.scale : 1);
  look.with_capsules = one_of(random, std::array{0.0, 0.7, 1.0});
  const double length = one_of(
      random, std::array{0.0, 0.005, 0.02, 0.1, 0.5, std::numeric_limits<double>::infinity()});
  look.piece_length = length * look.scale;
  look.slack = one_of(random, std::array{0.0, 0.0, 1e-4, 0.02, 0.3}) * look.scale;
  return look;
}

std::string describe(const Look& look) {
  return fmt::format(
      "{} {} {}, offset {:g}, scale {:g}, largest {:g} over {:g} decades, {} models{}, {}, voxel "
      "size {:g}, {:g} of the clients with capsules, pieces {:g}, slack {:g}",
      look.n, shape_names[static_cast<std::size_t>(look.shape)],
      place_names[static_cast<std::size_t>(look.place)], look.offset, look.scale, look.largest,
      look.decades, look.n_models,
      look.within_model == tess::collide::WithinModel::test ? " and pairs within" : "",
      look.touching == tess::collide::Touching::counts ? "closed" : "open", look.voxel_size,
      look.with_capsules, look.piece_length, look.slack);
}

}  // namespace collide_fuzz
