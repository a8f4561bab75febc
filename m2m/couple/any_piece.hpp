// What couplings see of a chare that holds a piece of a mesh, whatever its class is: its mesh, the
// entry methods that receive the messages of searches and applications (messages.hpp), and the
// state of its couplings. The work is in SourceSide and TargetSide.
//
//   step       at the source            message         at the target
//   ---------  -----------------------  --------------  --------------------------------------
//   submit     boxes of its cover       → collider ←    boxes around its points
//   hits                                                collects the source pieces near
//   ask                                 ← DonorQuery    sends its points there
//   answer     locates the points,      DonorAnswer →   keeps the best candidate of each
//              those of all queries that have arrived in one pass over its tetrahedra
//   outside    its nearest vertex       ← NearestQuery  if the policy says so
//                                       NearestAnswer →
//   choose     keeps what was chosen    ← Choice        decides
//   attach     remembers it             ←               if no source piece gives it values
//   give       interpolates             GivenValues →   writes a round that is complete
//
// For conservative couplings it is in OverlapSource and OverlapTarget (overlap_messages.hpp):
//
//   submit     boxes of its cover       → collider ←    boxes of its cover; reports its points
//   hits                                                collects the source pieces near
//   ask                                 ← OverlapQuery  sends its tetrahedra there
//   answer     rows of weights          OverlapAnswer → adds up what is covered
//   share                               ← SharedRows    names the rows of several source pieces
//   part       gives these away         PartialRows →   adds them up
//   finish                                              masses; reports to the pieces beside it
//   give       loads                    GivenValues →   starts a projection
//   solve                                               GhostValues to and from pieces beside it
#pragma once

#include "collide/hit.hpp"
#include "m2m/couple/accessors.hpp"
#include "m2m/couple/couplings.hpp"
#include "m2m/mesh_view.hpp"
#include "m2m/policy.hpp"
#include "m2m/status.hpp"
#include "runtime/group.hpp"

#include <span>
#include <vector>

namespace tess::collide {
struct Hits;
}  // namespace tess::collide

namespace tess::m2m {

struct CouplingSetup;
struct DonorQuery;
struct DonorAnswer;
struct NearestQuery;
struct NearestAnswer;
struct Choice;
struct GivenValues;
struct GivenRows;
struct SourcePiece;
struct OverlapQuery;
struct OverlapAnswer;
struct SharedRows;
struct SharedPoints;
struct PartialRows;
struct GhostValues;
class RowBook;
class PieceArray;
class TargetSide;

class AnyPiece {
 public:
  Couplings couplings;  ///< serialised by the chare if it migrates

  AnyPiece(const AnyPiece&) = delete;
  AnyPiece& operator=(const AnyPiece&) = delete;

  /// Where the points of this piece lie in the source of a coupling: per point owned.
  [[nodiscard]] std::span<const Status> status(CouplingId id) const;
  /// How far the points of this piece lie from the source, in units of the mesh: per point owned. 0
  /// if inside or on the boundary; if snapped, from the tetrahedron; if outside, from the nearest
  /// vertex. Empty for conservative kinds.
  [[nodiscard]] std::span<const double> distance(CouplingId id) const;
  /// The policy of a coupling whose target this piece belongs to.
  [[nodiscard]] const OutsidePolicy& policy(CouplingId id) const;

  // Entry methods of a search. All names begin with m2m_, since the user's class inherits them.
  void m2m_submit_source(const CouplingSetup& setup);
  void m2m_submit_target(const CouplingSetup& setup);
  void m2m_hits(CouplingId id, const collide::Hits& hits);
  void m2m_ask(CouplingId id);
  void m2m_answer(DonorQuery query);
  void m2m_answer_all(CouplingId id);
  void m2m_receive_donors(const DonorAnswer& answer);
  void m2m_name_source(CouplingId id);
  void m2m_ask_nearest(CouplingId id, const std::vector<SourcePiece>& sources);
  void m2m_answer_nearest(NearestQuery query);
  void m2m_receive_nearest(const NearestAnswer& answer);
  void m2m_choose(Choice choice);
  void m2m_attach_if_alone(CouplingId id, collide::OwnerId source);
  void m2m_attach(CouplingId id, collide::OwnerId target);

  // Of a conservative search.
  void m2m_submit_overlap_source(const CouplingSetup& setup);
  void m2m_submit_overlap_target(const CouplingSetup& setup);
  void m2m_share_points(CouplingId id, const SharedPoints& shared);
  void m2m_ask_overlaps(CouplingId id);
  void m2m_answer_overlaps(const OverlapQuery& query);
  void m2m_receive_overlaps(const OverlapAnswer& answer);
  void m2m_share_rows(CouplingId id);
  void m2m_part(const SharedRows& shared);
  void m2m_receive_rows(PartialRows partial);
  void m2m_finish_search(CouplingId id);
  void m2m_greet(CouplingId id, collide::OwnerId neighbour);

  // Of an application. The k-th call of every source piece belongs to the k-th round; a target
  // piece gets a round when it is complete. A piece without sources has nothing to wait for: an
  // application by the handle reaches it directly, and a round of pieces through the one source
  // piece that it is attached to.
  void m2m_give_values(CouplingId id, detail::Giver give, detail::Taker take);
  void m2m_take_if_alone(CouplingId id, detail::Taker take);
  void m2m_take(GivenValues given);
  void m2m_take_ghosts(GhostValues ghosts);

  // Of weights (coupling_weights.hpp): they go to the pieces of the target.
  void m2m_give_rows(CouplingId id, GroupProxy<RowBook> book);
  void m2m_take_rows(GivenRows given);

  void m2m_release(CouplingId id);

 protected:
  AnyPiece() = default;
  virtual ~AnyPiece() = default;
  /// Gives values, and announces the round to the target pieces that are attached to this one.
  void m2m_give_round(CouplingId id, detail::Giver give, detail::Taker take);

 private:
  [[nodiscard]] virtual MeshView m2m_view() const = 0;
  [[nodiscard]] virtual collide::OwnerId m2m_owner() const = 0;
  /// New values were written.
  virtual void m2m_received(CouplingId id) = 0;

  [[nodiscard]] CouplingSides& m2m_sides() const { return *couplings.sides_; }
  /// Sends a message that says from which piece it is.
  template <auto F, class Message>
  void m2m_send(const PieceArray& pieces, collide::OwnerId to, Message message);
  /// Goes on with a search once all answers are there.
  void m2m_ask_on(TargetSide& to);
  void m2m_give_loads(CouplingId id, std::span<const double> values, detail::Taker take);
  /// Goes on with a projection as far as its messages allow.
  void m2m_project(CouplingId id, detail::Taker take);
};

}  // namespace tess::m2m
