#include "collide/queries.hpp"
#include "runtime/core/error.hpp"
#include "tests/fuzz/collide/comparison.hpp"
#include "tests/fuzz/collide/objects.hpp"

#include <concepts>
#include <fmt/format.h>
#include <span>
#include <string_view>

namespace collide_fuzz {
namespace {

using namespace tess::collide;

/// Runs a search. Voxels that are too small for the memory are refused, and then chosen.
template <class Search>
PairList search(PairOptions options, Comparison& out, const Search& pairs) {
  try {
    return pairs(options);
  } catch (const tess::Error& error) {
    const bool is_size = std::string_view(error.what()).find("voxel size") != std::string::npos;
    if (options.voxel_size == 0 || !is_size) throw;
  }
  ++out.n_refused;
  options.voxel_size = 0;
  return pairs(options);
}

/// The pairs of one set.
template <class Objects>
PairList brute_force(const Objects& objects, Touching touching) {
  const auto are_pair = pair_test(objects, touching);
  PairList out;
  for (std::uint32_t i = 0; i < objects.size(); ++i)
    for (std::uint32_t j = i + 1; j < objects.size(); ++j)
      if (are_pair(i, j)) out.push_back({i, j});
  return out;
}
PairList across(PairList pairs, std::span<const std::uint32_t> models) {
  std::erase_if(pairs, [&](const Pair& p) { return models[p.first] == models[p.second]; });
  return pairs;
}
/// Those of the objects before `end` with the others, whose positions are from there on.
PairList across(const PairList& pairs, std::uint32_t end) {
  PairList out;
  for (const Pair& p : pairs)
    if (p.first < end && p.second >= end) out.push_back({p.first, p.second - end});
  return out;
}
template <class A, class B>
PairList brute_force(std::span<const A> a, std::span<const B> b, Touching touching) {
  PairList out;
  for (std::uint32_t i = 0; i < a.size(); ++i)
    for (std::uint32_t j = 0; j < b.size(); ++j)
      if (is_pair(a[i], b[j], touching)) out.push_back({i, j});
  return out;
}

template <class Object>
void one_set(const Look& look, const std::vector<Object>& objects,
             std::span<const std::uint32_t> models, Comparison& out) {
  const std::span<const Object> all(objects);
  PairOptions options{.touching = look.touching, .voxel_size = look.voxel_size};
  const PairList expected = brute_force(objects, look.touching);
  for (const auto method :
       {PairMethod::automatic, PairMethod::all_pairs, PairMethod::sweep, PairMethod::bisection}) {
    options.method = method;
    const auto find = [&](const PairOptions& o) { return pairs(all, o); };
    out.pairs(search(options, out, find), expected,
              fmt::format("pairs(), method {}", static_cast<int>(method)));
  }
  options.method = PairMethod::automatic;
  options.models = models;
  options.within_model = WithinModel::skip;
  const auto find = [&](const PairOptions& o) { return pairs(all, o); };
  out.pairs(search(options, out, find), across(expected, models), "pairs() with models");
  options.within_model = WithinModel::test;
  out.pairs(search(options, out, find), expected, "pairs() with models, and within them");
  const auto end = static_cast<std::uint32_t>(all.size() / 3);
  const auto find_across = [&](const PairOptions& o) {
    return pairs(all.first(end), all.subspan(end), o);
  };
  options.models = {};
  out.pairs(search(options, out, find_across), across(expected, end), "pairs() of two sets");
}

template <class A, class B>
void two_sets(const Look& look, std::span<const A> a, std::span<const B> b, std::string_view what,
              Comparison& out) {
  const PairOptions options{.touching = look.touching, .voxel_size = look.voxel_size};
  const auto find = [&](const PairOptions& o) { return pairs(a, b, o); };
  out.pairs(search(options, out, find), brute_force(a, b, look.touching), what);
}

template <class A, class B>
concept CanBePaired = requires(const A& a, const B& b) {
  { intersect(a, b, Touching::counts) } -> std::same_as<bool>;
};

/// The objects against balls, triangles and tetrahedra, of which the test is known.
template <class Other, class Object>
void with_kind(const Look& look, const std::vector<Object>& objects, Shape shape, Comparison& out) {
  if constexpr (CanBePaired<Object, Other>) {
    Look other = look;
    other.seed = look.seed ^ 0x5555;
    other.shape = shape;
    other.n = std::min<std::uint32_t>(look.n, 60);
    const auto others = Drawer(other).objects<Other>();
    two_sets(look, std::span<const Object>(objects).first(std::min<std::size_t>(look.n, 60)),
             std::span<const Other>(others),
             fmt::format("pairs() with {}", shape_names[static_cast<std::size_t>(shape)]), out);
  }
}

/// The queries around an object's corner, and along a ray from there.
template <class Object>
void queries(const Look& look, const std::vector<Object>& objects, Comparison& out) {
  if (objects.empty()) return;
  tess::Random random(tess::mix(look.seed ^ 0x71));
  const Index<Object> index{std::span<const Object>(objects)};
  for (int round = 0; round < 3; ++round) {
    const Aabb at = tess::collide::detail::aabb_of(objects[random.below(objects.size())]);
    const Point p = round == 0 ? at.lo : at.hi;
    const double radius = round == 0 ? 0 : look.scale * random.unit();
    std::vector<std::uint32_t> within;
    std::vector<Neighbour> near;
    for (std::uint32_t i = 0; i < objects.size(); ++i) {
      if (is_pair(Sphere{p, radius}, objects[i], Touching::counts)) within.push_back(i);
      // The distance of the box is a lower bound whatever is rounded, as in the index.
      const Aabb box = tess::collide::detail::aabb_of(objects[i]);
      near.push_back({i, std::max(distance2(box, p), distance2(objects[i], p))});
    }
    out.answer(index.within(p, radius) == within, "within a radius");
    std::ranges::sort(near, [](const Neighbour& a, const Neighbour& b) { return a < b; });
    near.resize(std::min<std::size_t>(near.size(), 5));
    out.answer(index.nearest(p, 5) == near, "nearest");
    if constexpr (tess::collide::detail::CanBeHit<Object>) {
      const Ray ray{p, {random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5}};
      std::vector<RayHit> hits;
      for (std::uint32_t i = 0; i < objects.size(); ++i)
        if (const auto t = hit(objects[i], ray)) hits.push_back({i, *t});
      // The index rounds the entry of the box up to it, so objects are compared, and the places
      // within rounding.
      std::vector<RayHit> found = index.all_hits(ray);
      out.answer(std::is_sorted(found.begin(), found.end()), "hits along a ray");
      const auto by_object = [](const RayHit& a, const RayHit& b) { return a.object < b.object; };
      std::ranges::sort(found, by_object);
      const auto alike = [](const RayHit& a, const RayHit& b) {
        return a.object == b.object && std::abs(a.at - b.at) <= 1e-9 * std::abs(b.at) + 1e-300;
      };
      out.answer(std::ranges::equal(found, hits, alike), "hits of a ray");
      const auto first = index.first_hit(ray);
      const auto least = std::min_element(found.begin(), found.end());
      out.answer(first ? least != found.end() && least->at == first->at : found.empty(),
                 "first hit of a ray");
    }
  }
}

}  // namespace

void compare_serial(const Look& look, Comparison& out) {
  with_objects(look, [&](const auto& objects, Drawer& drawer) {
    using Object = typename std::remove_cvref_t<decltype(objects)>::value_type;
    const std::vector<std::uint32_t> models = drawer.models();
    one_set(look, objects, models, out);
    if constexpr (std::is_same_v<decltype(box_of(std::declval<const Object&>())), Aabb>) {
      with_kind<Sphere>(look, objects, Shape::sphere, out);
      with_kind<Triangle>(look, objects, Shape::triangle, out);
      with_kind<Tetrahedron>(look, objects, Shape::tetrahedron, out);
    }
    if constexpr (tess::collide::detail::HasDistance<Object> &&
                  tess::collide::detail::MeetsSphere<Object>)
      queries(look, objects, out);
  });
}

}  // namespace collide_fuzz
