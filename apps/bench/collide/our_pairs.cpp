// Our serial face in the terms of a Method.
#include "apps/bench/collide/method.hpp"
#include "collide/pairs.hpp"
#include "collide/triangle.hpp"

namespace bench {
namespace {

using namespace tess::collide;

template <class Object>
class OurPairs : public Method {
 public:
  OurPairs(const Problem& problem, const std::vector<Object>& objects)
      : objects_(objects), options_{.touching = problem.touching} {
    if (problem.pairing == Pairing::across_models) {
      options_.models = problem.models;
      options_.within_model = WithinModel::skip;
    }
  }

  std::uint64_t count() override { return count_pairs(objects_, options_); }
  std::vector<PackedPair> pairs() override {
    std::vector<PackedPair> found;
    for_each_pair(objects_, options_,
                  [&found](std::uint32_t a, std::uint32_t b) { found.push_back(packed(a, b)); });
    return found;
  }

 private:
  std::span<const Object> objects_;
  PairOptions options_;
};

}  // namespace

std::unique_ptr<Method> our_doubles(const Problem& problem) {
  if (!problem.triangles.empty())
    return std::make_unique<OurPairs<Triangle>>(problem, problem.triangles);
  return std::make_unique<OurPairs<Aabb>>(problem, problem.boxes);
}
std::unique_ptr<Method> our_floats(const Problem& problem) {
  if (!problem.float_triangles.empty())
    return std::make_unique<OurPairs<TriangleOf<float>>>(problem, problem.float_triangles);
  return std::make_unique<OurPairs<FloatBox>>(problem, problem.floats);
}

}  // namespace bench
