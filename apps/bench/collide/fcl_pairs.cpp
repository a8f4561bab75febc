#include "apps/bench/collide/method.hpp"

#if defined(TESS_WITH_FCL)
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/narrowphase/collision_object.h>
#endif

namespace bench {

#if defined(TESS_WITH_FCL)
namespace {

/// A geometry whose box is given. A Box of FCL is centred, which rounds its corners.
class GivenBox : public fcl::CollisionGeometryd {
 public:
  explicit GivenBox(const Aabb& box) {
    aabb_local.min_ = {box.lo[0], box.lo[1], box.lo[2]};
    aabb_local.max_ = {box.hi[0], box.hi[1], box.hi[2]};
  }
  void computeLocalAABB() override {}
};

class FclPairs : public Method {
 public:
  /// `object_of(box)`: a collision object.
  template <class ObjectOf>
  FclPairs(const Problem& problem, ObjectOf object_of) : problem_(problem) {
    objects_.reserve(problem.boxes.size());
    for (const Aabb& box : problem.boxes) {
      auto& object = objects_.emplace_back(object_of(box));
      object->setUserData(reinterpret_cast<void*>(objects_.size() - 1));
    }
    const std::size_t split = problem.second_set();
    for (std::size_t i = 0; i < objects_.size(); ++i)
      (i < split ? first_ : rest_).push_back(objects_[i].get());
  }

  std::uint64_t count() override {
    std::uint64_t n = 0;
    for_each([&n](std::uint32_t, std::uint32_t) { ++n; });
    return n;
  }
  std::vector<PackedPair> pairs() override {
    std::vector<PackedPair> found;
    for_each([&found](std::uint32_t a, std::uint32_t b) { found.push_back(packed(a, b)); });
    return found;
  }

 private:
  using Tree = fcl::DynamicAABBTreeCollisionManager<double>;
  template <class Found>
  struct Visit {
    const Problem& problem;
    Found& found;
  };

  static std::uint32_t number(const fcl::CollisionObjectd* object) {
    return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(object->getUserData()));
  }
  template <class Found>
  void for_each(Found found) {
    Visit<Found> visit{problem_, found};
    const fcl::CollisionCallBack<double> hit = [](fcl::CollisionObjectd* a,
                                                  fcl::CollisionObjectd* b, void* at) {
      const auto& to = *static_cast<Visit<Found>*>(at);
      if (to.problem.wants(number(a), number(b))) to.found(number(a), number(b));
      return false;
    };
    Tree rest;
    rest.registerObjects(rest_);
    rest.setup();
    if (first_.empty()) {
      rest.collide(&visit, hit);
      return;
    }
    Tree first;
    first.registerObjects(first_);
    first.setup();
    first.collide(&rest, &visit, hit);
  }

  const Problem& problem_;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
  std::vector<fcl::CollisionObjectd*> first_, rest_;
};

}  // namespace

std::unique_ptr<Method> fcl_pairs(const Problem& problem) {
  if (problem.touching != tess::collide::Touching::counts) return nullptr;
  return std::make_unique<FclPairs>(problem, [](const Aabb& box) {
    return std::make_unique<fcl::CollisionObjectd>(std::make_shared<GivenBox>(box));
  });
}

std::unique_ptr<Method> fcl_centred_pairs(const Problem& problem) {
  if (problem.touching != tess::collide::Touching::counts) return nullptr;
  return std::make_unique<FclPairs>(problem, [](const Aabb& box) {
    fcl::Vector3d sides, centre;
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      sides[k] = box.hi[axis] - box.lo[axis];
      centre[k] = (box.lo[axis] + box.hi[axis]) / 2;
    }
    return std::make_unique<fcl::CollisionObjectd>(std::make_shared<fcl::Boxd>(sides),
                                                   fcl::Matrix3d::Identity(), centre);
  });
}

#else

std::unique_ptr<Method> fcl_pairs(const Problem& /*problem*/) {
  return nullptr;
}
std::unique_ptr<Method> fcl_centred_pairs(const Problem& /*problem*/) {
  return nullptr;
}

#endif

}  // namespace bench
