// Decides whether a mesh is the one of the last call, without a copy of it. A search keeps what it
// made of a source that has not moved.
//
// The first calls compare a few points only, so a mesh that moves in every step costs nothing. Once
// these stay, the whole mesh is hashed: a change of one number is always noticed, and one of
// several with a chance of 1 - 2^-64.
#pragma once

#include "m2m/mesh_view.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace tess::m2m {

/// Independent hashes of every fourth word.
using MeshHash = std::array<std::uint64_t, 4>;
/// Of all that a view shows: coordinates, corners, ids, and how many of them are its own.
[[nodiscard]] MeshHash hash_of(const MeshView& mesh);

class SameMesh {
 public:
  enum class Answer : std::uint8_t {
    moved,   ///< or not known: it may be another mesh than last time
    stayed,  ///< as far as some points show: from now on it pays to keep what is made of it
    same     ///< as in the last call, which answered `stayed` or `same`
  };
  [[nodiscard]] Answer ask(const MeshView& mesh);

  template <class Ar>
  void serialize(Ar& ar) {
    ar(is_known_, some_, all_);
  }

 private:
  static constexpr std::size_t n_some = 8;
  bool is_known_ = false;
  std::array<Point, n_some> some_{};
  std::optional<MeshHash> all_;
};

}  // namespace tess::m2m
