// Owns a piece of a scene, on a PE: see run/parallel.hpp.
#pragma once

#include "apps/collide_scene/run/result.hpp"
#include "collide/collider.hpp"
#include "collide/triangle.hpp"
#include "runtime/runtime.hpp"

#include <vector>

namespace collide_scene {

/// The position of the first object of a client's piece of n_objects.
[[nodiscard]] std::uint32_t first_of(std::int32_t client, std::uint64_t n_objects);

/// Consecutive objects of a scene: triangles, or boxes.
struct Piece {
  std::uint64_t n_objects = 0;  ///< of the scene
  bool exact = false;           ///< pairs of triangles are tested exactly
  bool open = false;            ///< what only touches is no pair
  bool keep_pairs = false;
  std::int32_t step = 0;
  std::vector<tess::collide::Triangle> triangles{};
  std::vector<tess::collide::Aabb> boxes{};
  std::vector<std::uint32_t> models{};  ///< one per object, or none
};

/// Candidates of two clients for the exact test, with the triangles of the one that sends them.
struct Candidates {
  struct Pair {
    ScenePair pair;
    std::uint32_t triangle = 0;  ///< of theirs, in `triangles`
    std::uint32_t mine = 0;      ///< number at the receiver
  };
  std::vector<tess::collide::Triangle> triangles;
  std::vector<Pair> pairs;
};

struct AddAnswers {
  Answer operator()(Answer a, const Answer& b) const { return a += b; }
};

class Client : public tess::Chare<Client, tess::Index1> {
 public:
  // Entry methods.
  void take(Piece piece);
  void submit(const tess::collide::Collider& collider);
  void receive(const tess::collide::Hits& hits);
  void test(const Candidates& candidates);
  /// The answer since the last take() or forget().
  void give_answer(tess::Callback<Answer> target);
  void give_pairs(tess::Callback<std::vector<ScenePair>> target);
  /// Of the process, from the first of its PEs.
  void give_memory(tess::Callback<std::uint64_t> target);
  void forget();

  template <class Ar>
  void serialize(Ar& ar) {
    ar(piece_, boxes_, answer_, pairs_);
  }

 private:
  void found(ScenePair pair);

  [[nodiscard]] bool meet(const tess::collide::Triangle& a, const tess::collide::Triangle& b) const;

  Piece piece_;
  std::vector<tess::collide::Aabb> boxes_;  // of the last submit(); the memory is kept
  Answer answer_;
  std::vector<ScenePair> pairs_;
};

}  // namespace collide_scene
