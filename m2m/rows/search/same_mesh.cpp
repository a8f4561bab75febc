#include "m2m/rows/search/same_mesh.hpp"

#include "runtime/core/hash.hpp"

#include <algorithm>
#include <cstring>

namespace tess::m2m {
namespace {

/// As hash_bytes(), in four lanes: one lane would wait for its own products.
template <class T>
void add(MeshHash& hash, std::span<const T> values) {
  static_assert(sizeof(T) % 8 == 0);
  const std::size_t n_words = values.size() * (sizeof(T) / 8);
  const auto* const bytes = reinterpret_cast<const unsigned char*>(values.data());
  const auto step = [&](std::uint64_t& lane, std::size_t at) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + 8 * at, 8);
    lane = (lane ^ word) * 0x9fb21c651e98df25U;
    lane ^= lane >> 32U;
  };
  MeshHash lanes = hash;
  std::size_t at = 0;
  for (; at + 4 <= n_words; at += 4)
    for (std::size_t k = 0; k < 4; ++k) step(lanes[k], at + k);
  for (; at < n_words; ++at) step(lanes[at % 4], at);
  for (std::uint64_t& lane : lanes) lane = mix(lane ^ n_words);
  hash = lanes;
}

}  // namespace

MeshHash hash_of(const MeshView& mesh) {
  MeshHash hash{static_cast<std::uint64_t>(mesh.n_owned),
                static_cast<std::uint64_t>(mesh.n_own_tets),
                static_cast<std::uint64_t>(mesh.dimension)};
  add(hash, mesh.points);
  add(hash, mesh.tets);
  add(hash, mesh.point_ids);
  add(hash, mesh.tet_ids);
  return hash;
}

SameMesh::Answer SameMesh::ask(const MeshView& mesh) {
  std::array<Point, n_some> some{};
  if (!mesh.points.empty())
    for (std::size_t k = 0; k < n_some; ++k)
      some[k] = mesh.points[k * (mesh.points.size() - 1) / (n_some - 1)];
  const bool stays = is_known_ && some == some_;
  is_known_ = true;
  some_ = some;
  if (!stays) {
    all_.reset();
    return Answer::moved;
  }
  const MeshHash all = hash_of(mesh);
  const bool is_same = all_ == all;
  all_ = all;
  return is_same ? Answer::same : Answer::stayed;
}

}  // namespace tess::m2m
