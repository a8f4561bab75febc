// libFuzzer over the serial face: any bytes are a set of boxes or triangles and options. The pairs
// are those of brute force; objects that are not finite, or inside out, are an Error that names the
// first.
//
//     cmake/setup.sh --fuzz
//     cmake --preset clang -B build/fuzz -DTESS_FUZZ=ON -DTESS_SANITIZE=address,undefined,fuzzer-no-link
//     cmake --build build/fuzz --target fuzz_pairs fuzz_surface fuzz_mesh
//     mkdir -p build/corpus/pairs && build/fuzz/bin/fuzz_pairs -max_total_time=600 build/corpus/pairs
#include "collide/pairs.hpp"

#include "collide/triangle.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fuzzer/FuzzedDataProvider.h>
#include <string>

namespace {

using namespace tess::collide;

[[noreturn]] void fail(const char* what) {
  std::fprintf(stderr, "fuzz_pairs: %s\n", what);
  std::abort();
}

/// Any bits, or a small multiple of a quarter, so that coordinates are often equal.
template <class Real>
Real coordinate(FuzzedDataProvider& data, bool any_bits) {
  if (!any_bits) return static_cast<Real>(data.ConsumeIntegral<std::int8_t>()) / 4;
  Real x = 0;
  data.ConsumeData(&x, sizeof x);
  return x;
}

template <class Real, std::size_t D>
void draw(FuzzedDataProvider& data, bool any_bits, Box<Real, D>& box) {
  for (std::size_t k = 0; k < D; ++k) {
    box.lo[k] = coordinate<Real>(data, any_bits);
    box.hi[k] = any_bits ? coordinate<Real>(data, true)
                         : box.lo[k] + static_cast<Real>(data.ConsumeIntegral<std::uint8_t>()) / 8;
  }
}
template <class Real>
void draw(FuzzedDataProvider& data, bool any_bits, TriangleOf<Real>& triangle) {
  for (auto& corner : triangle.corners)
    for (Real& x : corner) x = coordinate<Real>(data, any_bits);
}

template <class Real, std::size_t D>
bool is_pair(const Box<Real, D>& a, const Box<Real, D>& b, Touching touching) {
  return overlap(a, b, touching);
}
template <class Real>
bool is_pair(const TriangleOf<Real>& a, const TriangleOf<Real>& b, Touching touching) {
  return intersect(a, b, touching);
}

template <class Object>
void try_objects(FuzzedDataProvider& data) {
  PairOptions options;
  options.touching = data.ConsumeBool() ? Touching::counts : Touching::does_not_count;
  options.method = data.PickValueInArray(
      {PairMethod::automatic, PairMethod::all_pairs, PairMethod::sweep, PairMethod::bisection});
  options.voxel_size = data.PickValueInArray({0.0, 0.0, 0.05, 0.25, 0.3, 1.0, 7.0, 1e-300, 1e300});
  const bool any_bits = data.ConsumeBool(), has_models = data.ConsumeBool();
  // Copies of them, moved along an axis, so that few bytes make many voxels.
  const auto n_copies = data.ConsumeIntegralInRange<std::size_t>(1, 40);
  std::vector<Object> objects;
  while (data.remaining_bytes() > 4 && objects.size() < 200)
    draw(data, any_bits, objects.emplace_back());
  const std::size_t n = objects.size();
  for (std::size_t copy = 1; copy < n_copies && objects.size() < 700; ++copy)
    objects.insert(objects.end(), objects.begin(),
                   objects.begin() + static_cast<std::ptrdiff_t>(n));
  std::vector<std::uint32_t> models;
  for (std::uint32_t i = 0; i < objects.size(); ++i) models.push_back(i % 3);
  if (has_models) {
    options.models = models;
    options.within_model = WithinModel::skip;
  }

  std::size_t bad = 0;
  while (bad < objects.size() && is_valid(box_of(objects[bad]))) ++bad;
  std::vector<Pair> found;
  try {
    found = pairs(std::span<const Object>(objects), options);
  } catch (const tess::Error& error) {
    const std::string text = error.what();
    if (bad < objects.size() && text.find("object " + std::to_string(bad) + " ") != text.npos)
      return;
    if (options.voxel_size != 0 && text.find("voxel size") != text.npos) return;
    fail(error.what());
  }
  if (bad < objects.size()) fail("an object that is not valid was taken");
  std::vector<Pair> expected;
  for (std::uint32_t i = 0; i < objects.size(); ++i)
    for (std::uint32_t j = i + 1; j < objects.size(); ++j)
      if ((!has_models || models[i] != models[j]) &&
          is_pair(objects[i], objects[j], options.touching))
        expected.push_back({i, j});
  std::ranges::sort(found);
  if (found != expected) fail("other pairs than those of brute force");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t n) {
  FuzzedDataProvider data(bytes, n);
  switch (data.ConsumeIntegralInRange(0, 5)) {
    case 0:
      try_objects<Aabb>(data);
      break;
    case 1:
      try_objects<Box<float, 3>>(data);
      break;
    case 2:
      try_objects<Box<double, 2>>(data);
      break;
    case 3:
      try_objects<Box<float, 4>>(data);
      break;
    case 4:
      try_objects<TriangleOf<float>>(data);
      break;
    default:
      try_objects<Triangle>(data);
  }
  return 0;
}
