// What couplings see of a chare that holds a piece of a mesh, whatever its class is: its mesh, the
// entry methods that receive the messages of searches and applications (messages.hpp), and the
// state of its couplings. The work is in SourceSide and TargetSide. Kinds that interpolate and
// conservative kinds take the same steps:
//
//   step     at the source              message          at the target
//   -------  -------------------------  ---------------  -----------------------------------------
//   submit   boxes of its cover         → collider ←     boxes around its points or tetrahedra
//   hits                                                 collects the source pieces near
//   ask                                 ← SearchQuery    sends its points or tetrahedra there
//   answer   locates points, all that   SearchAnswer →   keeps the best candidate of each point;
//            have arrived in one pass;                   adds up how much of each tetrahedron is
//            makes rows of overlaps                      covered
//   name     names itself (Ledger)                       asks for nearest vertices likewise, if
//                                                        points outside need them; with kind
//                                                        projection for nearest cells
//   choose   keeps what was chosen      ← Choice         decides
//   give     multiplies                 GivenValues →    writes a round that is complete, with
//                                                        conservative kinds after a projection
//
// Only conservative kinds have two more things. A source piece gives away the rows that others have
// a part of, too: PartialRows are its SearchAnswer to the Choice. And the pieces of the target
// exchange the values of points that they share: before `ask` a PointDirectory reports to them
// which ones these are (SharedPoints), those that have sources greet the others in the end
// (Greeting), and GivenValues go between them in each step of a projection.
//
// A transposed coupling has no geometry: its target pieces start from the donors that they hold
// (source_side.hpp), a PointDirectory reports to them the owners of their ghosts, its source pieces name
// the points that got these donors (DonatedPoints), and the weights of ghosts go to the owners
// (TransposedWeights), which choose. `give` then sends raw values, to which the target applies rows.
//
// A target piece that no source piece gives values attaches itself to one by a Choice. That source
// piece announces to it the rounds that pieces start.
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
struct SourcePiece;
struct SearchQuery;
struct SearchAnswer;
struct Choice;
struct GivenValues;
struct GivenRows;
class IntegralBook;
class RowBook;
class PieceArray;

class AnyPiece {
 public:
  Couplings couplings;  ///< serialised by the chare if it migrates

  AnyPiece(const AnyPiece&) = delete;
  AnyPiece& operator=(const AnyPiece&) = delete;

  /// Where the points of this piece lie in the source of a coupling: per point owned.
  [[nodiscard]] std::span<const Status> status(CouplingId id) const;
  /// How far the points of this piece lie from the source, in units of the mesh: per point owned. 0
  /// if inside or on the boundary; if snapped, from the nearest cell; if outside, from the nearest
  /// vertex. Empty for conservative kinds.
  [[nodiscard]] std::span<const double> distance(CouplingId id) const;
  /// On which side of a source of triangles the points of this piece lie, per point owned: 1 where
  /// the normal of the donor points to, -1 on the other side, 0 in its plane or without a donor.
  /// Beyond an edge the sides of its two triangles may differ. Empty if all are 0.
  [[nodiscard]] std::span<const std::int8_t> side(CouplingId id) const;
  /// The policy of a coupling whose target this piece belongs to.
  [[nodiscard]] const OutsidePolicy& policy(CouplingId id) const;

  // Entry methods of a search. All names begin with m2m_, since the user's class inherits them.
  // `side`: source_model or target_model.
  void m2m_submit(const CouplingSetup& setup, collide::ModelId side);
  void m2m_hits(CouplingId id, const collide::Hits& hits);
  void m2m_ask(CouplingId id);
  void m2m_query(SearchQuery query);
  void m2m_answer(CouplingId id);
  void m2m_receive(SearchAnswer answer);
  void m2m_name_points(CouplingId id);
  void m2m_name(CouplingId id);
  void m2m_receive_names(CouplingId id, const std::vector<SourcePiece>& sources);
  void m2m_choose(Choice choice);

  // Of an application. The k-th call of every source piece belongs to the k-th round; a target
  // piece gets a round when it is complete. A piece without sources has nothing to wait for: an
  // application by the handle reaches it directly, and a round of pieces through the one source
  // piece that it is attached to.
  void m2m_give_values(CouplingId id, detail::Giver give, detail::Taker take);
  void m2m_take(GivenValues given);
  void m2m_take_if_alone(CouplingId id, detail::Taker take);

  // Of weights (coupling_weights.hpp): they go to the pieces of the target.
  void m2m_give_rows(CouplingId id, GroupProxy<RowBook> book);
  void m2m_take_rows(GivenRows given);

  // Scaled transfers (scaled.hpp) call these.
  void m2m_integrate(CouplingId id, GroupProxy<IntegralBook> book, detail::Giver give);
  void m2m_integrate_taken(CouplingId id, GroupProxy<IntegralBook> book, detail::Taker take);
  void m2m_scale(CouplingId id, detail::Taker take, const std::vector<double>& factors);

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

  /// Sends a message that says from which piece it is.
  template <auto F, class Message>
  void m2m_send(const PieceArray& pieces, collide::OwnerId to, Message message);
};

}  // namespace tess::m2m
