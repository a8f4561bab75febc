// The member of a group that sets up a distributed mesh (m2m/placement.hpp). It keeps a range of
// the points and of the tetrahedra, and builds the parts whose Workers are at home on its PE.
#pragma once

#include "m2m/field.hpp"
#include "m2m/mesh/checks/mesh_extent.hpp"
#include "m2m/mesh/checks/mesh_findings.hpp"
#include "m2m/mesh/partition/curve_cut.hpp"
#include "m2m/mesh/partition/id_set.hpp"
#include "m2m/mesh/partition/split.hpp"
#include "m2m/mesh/workers/worker.hpp"
#include "m2m/rows/weights/tets_of_vertices.hpp"
#include "runtime/core/algorithm.hpp"

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tess::m2m {

/// What all Placers know from the start.
struct PlacerSetup {
  std::string name;        ///< of the file; empty if the ranges are sent
  std::string shown_name;  ///< of the mesh, in errors
  GlobalId n_points = 0, n_tets = 0;
  std::int32_t dimension = 3;  ///< of the cells
  std::int32_t halo_layers = 0;
  std::vector<FormulaField> fields;
  ArrayProxy<Worker> workers;
  std::int32_t n_parts = 1;
  bool lacks_elements = false;  ///< MeshPart::lacks_elements
  bool is_survey = false;       ///< ends with finish_survey(), and builds no parts
};

/// The error with the least key of all PEs, if there is one.
struct FirstError {
  std::int64_t key = -1;
  std::int32_t code = 0;
  std::string message{};
  void keep_first(const FirstError& other) {
    if (other.key >= 0 && (key < 0 || other.key < key)) *this = other;
  }
};

/// Contributed at the end of a step; a step fills in what it finds.
struct PlacerReport {
  MeshFindings findings{};
  FirstError error{};
  std::uint64_t n_unused = 0;
  CellCounts counts{};  ///< for a round of a CurveCut
  MeshExtent extent{};  ///< in a survey
};
struct JoinReports {
  PlacerReport operator()(PlacerReport a, const PlacerReport& b) const {
    a.findings.join(b.findings);
    a.error.keep_first(b.error);
    a.n_unused += b.n_unused;
    a.counts = JoinCounts{}(std::move(a.counts), b.counts);
    a.extent.join(b.extent);
    return a;
  }
};

/// A range of a mesh, from the PE that holds all of it.
struct RangeLoad {
  std::vector<Point> points{};
  std::vector<Tet> tets{};
};

/// Tetrahedra for the parts of one PE, part by part.
struct TetBatch {
  PeId from{}, to{};
  std::vector<std::int32_t> parts{};
  std::vector<std::int32_t> sizes{};  ///< tetrahedra per part
  std::vector<std::int32_t> ids{};    ///< ascending in each part
  std::vector<Tet> tets{};
};

/// Which of your points are at these vertices? Asks for those of some parts of one PE, part by part,
/// or, without parts, for corners of the range of that PE.
struct PointQuery {
  PeId from{}, to{};
  std::vector<std::int32_t> parts{};
  std::vector<std::int32_t> sizes{};  ///< vertices per part; of corners one size
  std::vector<VertexId> ids{};        ///< ascending in each part
};
/// A part that has ghosts of another one.
struct GhostUse {
  std::int32_t owner = 0, user = 0;
  auto operator<=>(const GhostUse&) const = default;
};
/// In the order of a PointQuery.
struct PointAnswer {
  std::vector<std::int32_t> parts{};
  std::vector<std::int32_t> sizes{};
  std::vector<VertexId> firsts{};  ///< the first vertex of each part
  std::vector<Point> points{};
  std::vector<std::int32_t> owners{};   ///< per point, if parts ask
  std::vector<std::int32_t> n_users{};  ///< per point, if there is a halo
  std::vector<std::int32_t> users{};    ///< the parts whose tetrahedra use the points
  std::vector<GhostUse> ghost_uses{};   ///< of the points that these parts own
};
/// A vertex of a part, as its keeper describes it.
struct PartPoint {
  VertexId id = 0;
  std::int32_t owner = 0;
  Point at{};
};

/// Which tetrahedra of your part are around these vertices?
struct AroundQuery {
  std::int32_t asker = 0;
  std::int32_t part = 0;
  std::vector<VertexId> vertices;
};
/// A tetrahedron of a halo. Its corners are ids in the whole mesh.
struct HaloTet {
  std::int32_t id = 0;
  Tet corners{};
  auto operator<=>(const HaloTet&) const = default;
};
struct AroundAnswer {
  std::int32_t asker = 0;
  std::vector<HaloTet> tets{};
};

/// Ghosts of one part in another one.
struct GhostList {
  std::int32_t owner = 0, user = 0;
  std::vector<VertexId> ids;        ///< ascending
  std::vector<std::int32_t> there;  ///< their positions in the user
};

class Placer : public Group<Placer> {
 public:
  explicit Placer(const PlacerSetup& setup);

  // Phase 1: reads and checks the mesh, and counts where to cut.

  /// Reads the ranges, unless the load has them, checks them, and asks for the corners that other
  /// PEs keep.
  void read(RangeLoad load, Callback<PlacerReport> target);
  /// Checks the shapes of the tetrahedra, finds their cells in a cube around the mesh, and counts
  /// them for the first round of a CurveCut. Begins when the corners are here.
  void measure(const Aabb& bounds, Callback<PlacerReport> target);
  /// Counts for a later round.
  void count(const CurveCut& cut, Callback<PlacerReport> target);
  /// The end of a survey, when all corners have been asked for: evaluates the fields at the points.
  void finish_survey(Callback<PlacerReport> target);

  // Phase 2: tetrahedra go to their parts.

  /// Asks for the points of the parts here when all of their tetrahedra have arrived: the cut says
  /// how many these are.
  void send_tets(const CurveCut& cut);
  void receive_tets(TetBatch batch);

  // Phase 3: keepers give points to the parts. Corners in phase 1 and points of the halo in phase 4
  // are asked for alike.

  /// Answers, or keeps the query until the answer is known.
  void receive_query(PointQuery query);
  /// Decides about the owners, and answers the queries of all parts. Without a halo, finish()
  /// follows when the points asked for are here.
  void answer_parts(Callback<PlacerReport> finished);
  void receive_points(const PointAnswer& answer);
  /// Vertices that no tetrahedron uses, for the parts here that own them. Most often none.
  void receive_unused(const std::vector<PartPoint>& unused);

  // Phase 4: a halo, layer by layer, if there is one; then the parts are built.

  void ask_around();
  void answer_around(const AroundQuery& query);
  void receive_around(const AroundAnswer& answer);
  void ask_halo_points();
  /// Builds the parts, and tells the owners of their ghosts. Without a halo, load_workers() follows
  /// when the ghosts of the parts here are known, and the points say from how many parts.
  void finish();
  void receive_ghosts(GhostList list);
  void load_workers();

 private:
  static bool by_id(const PartPoint& a, const PartPoint& b) { return a.id < b.id; }
  /// Replaces vertices by their positions in the set.
  static void number_corners(std::vector<Tet>& tets, const IdSet& vertices) {
    for (Tet& tet : tets)
      for (VertexId& v : tet) v = vertices.rank(v);
  }
  /// A part under construction. The corners of its tetrahedra are ids in the whole mesh if there is
  /// a halo, and otherwise positions in `asked`.
  struct Draft {
    MeshPart mesh{};
    std::vector<PartPoint> points{};  // known so far; of the vertices asked, in their order
    std::vector<VertexId> asked{};    // in the queries under way, ascending
    std::size_t n_known = 0;          // points before those that are asked for
    std::vector<PartPoint> unused{};  // that it owns but does not use
    struct Seen {
      std::int32_t part;
      VertexId vertex;
      auto operator<=>(const Seen&) const = default;
    };
    std::vector<Seen> others{};  // parts that use points found in the last layer
    std::vector<HaloTet> halo{};
    std::optional<IdSet> own_vertices{};     // for answer_around()
    std::optional<TetsOfVertices> around{};  // own vertices, by rank
    std::vector<double> rows{};
  };

  [[nodiscard]] GlobalId first_of(GlobalId n, std::int32_t pe) const { return n * pe / n_pes_; }
  /// The PE that keeps a vertex.
  [[nodiscard]] std::int32_t keeper_of(GlobalId v) const {
    return static_cast<std::int32_t>(((v + 1) * n_pes_ - 1) / setup_.n_points);
  }
  [[nodiscard]] PeId home_of(std::int32_t part) const;
  [[nodiscard]] std::int32_t first_part_of(std::int32_t pe) const {
    return static_cast<std::int32_t>((std::int64_t{pe} * setup_.n_parts + n_pes_ - 1) / n_pes_);
  }
  /// The part that owns a vertex which no tetrahedron uses.
  [[nodiscard]] std::int32_t owner_of_unused(GlobalId v) const {
    return static_cast<std::int32_t>(v * setup_.n_parts / setup_.n_points);
  }
  [[nodiscard]] GlobalId first_unused_of(std::int32_t part) const {
    return (part * setup_.n_points + setup_.n_parts - 1) / setup_.n_parts;
  }
  [[nodiscard]] Draft& part(std::int32_t k) {
    return parts_[static_cast<std::size_t>(k - first_part_)];
  }
  template <class List>
  static void drop(List& list) {  // frees its memory
    List().swap(list);
  }
  [[nodiscard]] bool has_halo() const { return setup_.halo_layers > 0; }
  /// In a survey: tetrahedra use these vertices, kept here or elsewhere.
  void mark_used(std::span<const VertexId> vertices);
  void ask_corners();
  void measure_if_complete();
  void ask_points_if_complete();
  void make_drafts();
  void send_unused();
  void finish_if_complete();
  void load_if_complete();
  [[nodiscard]] std::array<Point, 4> corners_of(const Tet& tet) const;
  /// Calls visit(keeper, ids of that keeper) for ascending ids.
  template <class Visit>
  void for_each_keeper(std::span<const VertexId> ids, const Visit& visit) const;
  /// Asks the keepers for the points of the parts.
  void ask_points_of_parts();
  void send_query(PointQuery query);
  [[nodiscard]] PointAnswer answer(const PointQuery& query) const;
  static void index_tets(Draft& part);
  void build(std::int32_t k, const std::vector<Formula>& formulas, FirstError& error);
  /// Fills the rows of the part with the values of formulas.
  void evaluate(Draft& part, const std::vector<Formula>& formulas, FirstError& error) const;

  PlacerSetup setup_;
  std::int32_t n_pes_ = 1, me_ = 0;
  GlobalId first_point_ = 0, first_tet_ = 0;
  std::vector<Point> points_;  // kept here, from first_point_
  std::vector<Tet> tets_;      // of the range, from first_tet_
  std::optional<IdSet> far_;   // corners of the range that others keep
  std::vector<Point> far_points_;
  /// What it knows of the points kept here.
  enum class Knows : std::uint8_t { nothing, refused, points, owners } knows_ = Knows::nothing;
  std::vector<PointQuery> queries_;  // that wait for it
  std::size_t n_answers_due_ = 0;
  std::size_t n_unused_due_ = 0;  // messages
  std::optional<Aabb> measures_;  // from measure() on, until it begins
  Callback<PlacerReport> measured_;
  MeshExtent extent_;                        // of the range, in a survey
  std::vector<std::uint8_t> used_;           // per point kept here, in a survey
  std::vector<std::uint64_t> cells_;         // per tetrahedron of the range
  std::uint64_t n_tets_here_ = 0;            // in batches_
  std::optional<std::uint64_t> n_tets_due_;  // from send_tets() on, until all are here
  Callback<PlacerReport> finished_;          // from answer_parts() on, until the parts are built
  PlacerReport report_;
  std::vector<GhostUse> ghost_uses_;  // of parts here
  bool is_built_ = false;
  std::vector<TetBatch> batches_;
  std::vector<std::int32_t> owners_;        // per point kept here
  std::vector<std::uint32_t> users_begin_;  // if there is a halo: per point kept here, in users_
  std::vector<std::int32_t> users_;         // parts that use it
  std::int32_t first_part_ = 0;
  std::vector<Draft> parts_;
  std::vector<GhostList> ghosts_;
};

template <class Visit>
void Placer::for_each_keeper(std::span<const VertexId> ids, const Visit& visit) const {
  while (!ids.empty()) {
    const GlobalId v = ids.front();
    const std::int32_t keeper = keeper_of(v);
    const GlobalId end = first_of(setup_.n_points, keeper + 1);
    const auto n =
        static_cast<std::size_t>(std::lower_bound(ids.begin(), ids.end(), end) - ids.begin());
    visit(keeper, ids.first(n));
    ids = ids.subspan(n);
  }
}

}  // namespace tess::m2m
