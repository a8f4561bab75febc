#include "apps/bench/collide/method.hpp"
#include "runtime/core/check.hpp"

#if defined(TESS_WITH_EMBREE)
#include <cmath>
#include <embree3/rtcore.h>
#endif

namespace bench {

#if defined(TESS_WITH_EMBREE)
namespace {

RTCDevice device() {
  static const RTCDevice one = [] {
    const RTCDevice made = rtcNewDevice("threads=1");
    TESS_CHECK(made != nullptr, "rtcNewDevice fails with ",
               static_cast<int>(rtcGetDeviceError(nullptr)));
    return made;
  }();
  return one;
}

/// A tree over a range of boxes.
class Tree {
 public:
  explicit Tree(std::span<const Aabb> boxes) : boxes_(boxes), scene_(rtcNewScene(device())) {
    // The quickest build is the best for one query; a better tree costs more than it saves.
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);
    const RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(boxes.size()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(
        geometry,
        [](const RTCBoundsFunctionArguments* of) {
          const Aabb& box = static_cast<const Tree*>(of->geometryUserPtr)->boxes_[of->primID];
          const FloatBox rounded = rounded_outward(box);
          RTCBounds& out = *of->bounds_o;
          out.lower_x = rounded.lo[0];
          out.lower_y = rounded.lo[1];
          out.lower_z = rounded.lo[2];
          out.upper_x = rounded.hi[0];
          out.upper_y = rounded.hi[1];
          out.upper_z = rounded.hi[2];
        },
        nullptr);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    const RTCError error = rtcGetDeviceError(device());
    TESS_CHECK(error == RTC_ERROR_NONE, "Embree's build fails with ", static_cast<int>(error));
  }
  Tree(const Tree&) = delete;
  Tree& operator=(const Tree&) = delete;
  ~Tree() { rtcReleaseScene(scene_); }

  [[nodiscard]] RTCScene scene() const { return scene_; }

 private:
  std::span<const Aabb> boxes_;
  RTCScene scene_;
};

/// A set with itself is found twice, (a, b) and (b, a): only one of them is passed on.
class EmbreePairs : public Method {
 public:
  explicit EmbreePairs(const Problem& problem) : problem_(problem) { (void)device(); }

  std::uint64_t count() override {
    std::uint64_t n = 0;
    for_each([&](std::uint32_t a, std::uint32_t b) {
      if (is_pair(a, b)) ++n;
    });
    return n;
  }
  std::vector<PackedPair> pairs() override {
    std::vector<PackedPair> found;
    for_each([&](std::uint32_t a, std::uint32_t b) {
      if (is_pair(a, b)) found.push_back(packed(a, b));
    });
    return found;
  }
  std::vector<PackedPair> candidates() override {
    std::vector<PackedPair> found;
    for_each([&](std::uint32_t a, std::uint32_t b) {
      if (problem_.wants(a, b)) found.push_back(packed(a, b));
    });
    return found;
  }

 private:
  template <class Found>
  struct Visit {
    Found& found;
    std::uint32_t second;
  };

  [[nodiscard]] bool is_pair(std::uint32_t a, std::uint32_t b) const {
    return overlap(problem_.boxes[a], problem_.boxes[b], tess::collide::Touching::counts) &&
           problem_.wants(a, b);
  }

  template <class Found>
  void for_each(Found found) const {
    const std::size_t split = problem_.second_set();
    const std::span<const Aabb> boxes(problem_.boxes);
    Visit<Found> visit{found, static_cast<std::uint32_t>(split)};
    if (split > 0) {
      const Tree first(boxes.first(split)), second(boxes.subspan(split));
      rtcCollide(
          first.scene(), second.scene(),
          [](void* at, RTCCollision* hits, unsigned n) {
            const auto& to = *static_cast<Visit<Found>*>(at);
            for (unsigned i = 0; i < n; ++i) to.found(hits[i].primID0, hits[i].primID1 + to.second);
          },
          &visit);
      return;
    }
    const Tree tree(boxes);
    rtcCollide(
        tree.scene(), tree.scene(),
        [](void* at, RTCCollision* hits, unsigned n) {
          const auto& to = *static_cast<Visit<Found>*>(at);
          for (unsigned i = 0; i < n; ++i)
            if (hits[i].primID0 < hits[i].primID1) to.found(hits[i].primID0, hits[i].primID1);
        },
        &visit);
  }
  const Problem& problem_;
};

}  // namespace

std::unique_ptr<Method> embree_pairs(const Problem& problem) {
  if (problem.touching != tess::collide::Touching::counts) return nullptr;
  return std::make_unique<EmbreePairs>(problem);
}

#else

std::unique_ptr<Method> embree_pairs(const Problem& /*problem*/) {
  return nullptr;
}

#endif

}  // namespace bench
