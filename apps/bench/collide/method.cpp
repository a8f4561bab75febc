#include "apps/bench/collide/method.hpp"

#include <cmath>
#include <limits>
#if defined(TESS_WITH_EMBREE)
#include <embree3/rtcore_config.h>
#else
#define RTC_VERSION_STRING "3"
#endif
#if defined(TESS_WITH_FCL)
#include <fcl/config.h>
#else
#define FCL_VERSION "0"
#endif

namespace bench {
namespace {

/// The largest float that is at most x, and the smallest that is at least x.
float rounded_down(double x) {
  const auto near = static_cast<float>(x);
  return static_cast<double>(near) <= x
             ? near
             : std::nextafter(near, -std::numeric_limits<float>::infinity());
}
float rounded_up(double x) {
  return -rounded_down(-x);
}

class BruteForce : public Method {
 public:
  explicit BruteForce(const Problem& problem) : problem_(problem) {}

  std::uint64_t count() override {
    std::uint64_t n = 0;
    for_each([&](std::uint32_t, std::uint32_t) { ++n; });
    return n;
  }
  std::vector<PackedPair> pairs() override {
    std::vector<PackedPair> found;
    for_each([&](std::uint32_t a, std::uint32_t b) { found.push_back(packed(a, b)); });
    return found;
  }

 private:
  template <class Found>
  void for_each(Found&& found) const {
    const auto n = static_cast<std::uint32_t>(problem_.boxes.size());
    for (std::uint32_t a = 0; a < n; ++a)
      for (std::uint32_t b = a + 1; b < n; ++b)
        if (overlap(problem_.boxes[a], problem_.boxes[b], problem_.touching) &&
            problem_.wants(a, b))
          found(a, b);
  }
  const Problem& problem_;
};

constexpr MethodKind kinds[] = {
    {"double", "ours on boxes of doubles", Whose::ours, our_doubles},
    {"float", "ours on boxes of floats", Whose::ours, our_floats},
    {"embree",
     "Embree " RTC_VERSION_STRING
     "'s rtcCollide with building its tree of float boxes; its callback tests doubles",
     Whose::peer, embree_pairs},
    {"fcl",
     "FCL " FCL_VERSION "'s dynamic tree of boxes with building it; its objects are made before",
     Whose::peer, fcl_pairs},
    {"brute", "all pairs of boxes of doubles, tested one after the other", Whose::brute_force,
     brute_force},
};

}  // namespace

std::span<const MethodKind> method_kinds() {
  return kinds;
}

FloatBox rounded_outward(const Aabb& box) {
  return {{rounded_down(box.lo[0]), rounded_down(box.lo[1]), rounded_down(box.lo[2])},
          {rounded_up(box.hi[0]), rounded_up(box.hi[1]), rounded_up(box.hi[2])}};
}

std::unique_ptr<Method> brute_force(const Problem& problem) {
  if (problem.boxes.size() > 8'192) return nullptr;
  return std::make_unique<BruteForce>(problem);
}

}  // namespace bench
