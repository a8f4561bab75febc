// Collisions of a scene on chares, by the parallel face of the library (collide/collider.hpp). PE 0
// has the scene and moves it; each client, one per PE, gets a piece of it, submits its boxes, and
// receives their pairs. Exact tests are made by the clients.
//
//     PE 0                    client a (pairs of a, b: a < b)        client b
//     take(piece) ──────────► submit ► collider ► receive(hits)
//                                                  triangles of a ──► test: counts the pair
#pragma once

#include "apps/collide_scene/options.hpp"
#include "apps/collide_scene/run/result.hpp"
#include "apps/collide_scene/scenes/scene.hpp"
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

/// Owns a piece of the scene, on a PE.
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
  /// Gives the memory of the process; only the first of its PEs contributes it.
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

/// The collider and its clients, on PE 0. Begin, steps, end.
class ParallelCollisions {
 public:
  /// The scene must outlive this; its objects may move between steps. `costs` are those of a
  /// simulated machine.
  ParallelCollisions(const Scene& scene, const Rules& rules,
                     const tess::collide::SimulatedCosts& costs = {});

  tess::Task begin();
  /// Hands out the objects where they are now, then collides them; only the second is timed, and
  /// `repeat` times: the fastest counts. Appends the pairs to `pairs`, if it is not null.
  tess::Task step(int step, int repeat, StepResult& result, std::vector<ScenePair>* pairs);
  /// Fills in what is known of the grid and the memory, and frees the collider.
  tess::Task end(RunResult& result);
  /// Known after begin().
  [[nodiscard]] const tess::collide::Collider& collider() const { return collider_; }

 private:
  const Scene& scene_;
  const Rules rules_;
  const tess::collide::SimulatedCosts costs_;
  tess::collide::Collider collider_;
  tess::ArrayProxy<Client> clients_;
  tess::collide::CollisionStatistics last_;
};

}  // namespace collide_scene
