// Interpolation: the donors of target points, and the values that they give. A Donor is a row of
// four weights. As Rows they took 56 bytes per point in place of 48, and an application of one
// component about twice as long (1.4 in place of .7 ms for 180 000 points). They would also lose
// that a weight of 0 takes nothing of NaN, and the corners that a value is clamped to.
#include "m2m/couple/source_side.hpp"
#include "m2m/rows/reconstruct/gradients.hpp"
#include "m2m/rows/reconstruct/second_order.hpp"
#include "m2m/rows/weights/point_rows.hpp"
#include "runtime/core/sort_unique.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace tess::m2m {
namespace {

bool needs_gradients(TransferKind kind) {
  return kind == TransferKind::second_order || kind == TransferKind::limited;
}

std::vector<std::int32_t> points_of_nearest(const MeshView& mesh) {
  std::vector<std::uint8_t> counts(mesh.points.size(), mesh.tets.empty() ? 1 : 0);
  for (const Tet& tet : mesh.tets)
    for (const VertexId v : tet) counts[static_cast<std::size_t>(v)] = 1;
  std::vector<std::int32_t> points;
  for (std::int32_t v = 0; v < mesh.n_owned; ++v)
    if (counts[static_cast<std::size_t>(v)] != 0) points.push_back(v);
  return points;
}

/// The value, or the least or greatest of a vertex of the donor if it is beyond. NaN stays NaN.
double clamped(double value, const Donor& donor, const double* values, std::size_t stride) {
  double low = values[static_cast<std::size_t>(donor.vertices[0]) * stride], high = low;
  for (const VertexId v : donor.vertices) {
    const double at = values[static_cast<std::size_t>(v) * stride];
    low = at < low ? at : low;
    high = at > high ? at : high;
  }
  return value < low ? low : value > high ? high : value;
}

/// Writes the values of the rows that are not empty; a weight of 0 takes nothing of NaN.
void put_rows(const Rows<double>& rows, std::span<const double> values, std::size_t n_components,
              bool clamp, std::span<double> out) {
  for (std::size_t row = 0; row < rows.n_rows(); ++row) {
    const std::span<const VertexId> columns = rows.columns_of(row);
    for (std::size_t c = 0; c < n_components && !columns.empty(); ++c) {
      const auto value = [&](std::size_t k) {
        return values[static_cast<std::size_t>(columns[k]) * n_components + c];
      };
      double sum = weighted(rows.weights_of(row)[0], value(0)), low = value(0), high = low;
      for (std::size_t k = 1; k < columns.size(); ++k) {
        sum += weighted(rows.weights_of(row)[k], value(k));
        low = value(k) < low ? value(k) : low;
        high = value(k) > high ? value(k) : high;
      }
      out[row * n_components + c] = !clamp ? sum : sum < low ? low : sum > high ? high : sum;
    }
  }
}

/// Names the place for a field in tetrahedra: rows of values in place of vertices.
Donor in_tet(std::int32_t tet, const Weights& weights, Centring centring) {
  if (centring == Centring::cells) return donor_at(tet);
  return {{4 * tet, 4 * tet + 1, 4 * tet + 2, 4 * tet + 3}, weights};
}

}  // namespace

Aabb box_of_nearest(const MeshView& mesh, const CouplingSetup& setup) {
  Aabb box = collide::no_box<double, 3>();
  if (setup.seeks_nearest_cells()) {
    for (const Tet& cell : mesh.own_tets())
      for (const VertexId v : cell) grow(box, mesh.points[static_cast<std::size_t>(v)]);
    return box;
  }
  for (const std::int32_t v : points_of_nearest(mesh))
    grow(box, mesh.points[static_cast<std::size_t>(v)]);
  return box;
}

DonorAnswer SourceSide::answer_points(const SearchQuery& query, BestDonors found) {
  Given& given = given_[query.from];
  if (setup.kind == TransferKind::native)
    for (std::size_t i = 0; i < found.donors.size(); ++i)
      given.points.push_back({std::get<DonorQuery>(query.what).points[found.points[i]],
                              {found.tets[i], found.donors[i].weights},
                              found.candidates[i].status == Status::snapped});
  if (setup.source_values != Centring::nodes)
    for (std::size_t i = 0; i < found.donors.size(); ++i)
      found.donors[i] = in_tet(found.tets[i], found.donors[i].weights, setup.source_values);
  given.donors.insert(given.donors.end(), found.donors.begin(), found.donors.end());
  return {std::move(found.points), std::move(found.candidates)};
}

NearestAnswer SourceSide::answer_nearest(const MeshView& mesh, const NearestQuery& query) {
  if (!nearest_)
    nearest_.emplace(mesh.owned(), mesh.point_ids.first(mesh.owned().size()),
                     points_of_nearest(mesh));
  NearestAnswer answer;
  const auto add = [&](std::size_t i, double squared_distance, VertexId vertex) {
    answer.keys.push_back(query.keys[i]);
    answer.squared_distances.push_back(squared_distance);
    answer.vertices.push_back(vertex);
    answer.ids.push_back(mesh.point_ids[static_cast<std::size_t>(vertex)]);
    if (query.n_nearest > 1) answer.points.push_back(mesh.points[static_cast<std::size_t>(vertex)]);
  };
  std::vector<NearestVertex::Neighbour> several;
  for (std::size_t i = 0; i < query.keys.size(); ++i) {
    if (query.n_nearest > 1) {
      nearest_->find(query.points[i], query.n_nearest, query.squared_reaches[i], several);
      for (const NearestVertex::Neighbour& found : several)
        add(i, found.squared_distance, found.vertex);
    } else if (const auto found = nearest_->find(query.points[i], query.squared_reaches[i]);
               found.vertex >= 0) {
      add(i, found.squared_distance, found.vertex);
    }
  }
  return answer;
}

void SourceSide::choose_donors(const MeshView& mesh, const Choice& choice,
                               std::uint64_t& n_linear) {
  Given& given = given_[choice.from];
  std::vector<Donor>& donors = given.donors;
  if (setup.kind == TransferKind::native)
    for (const std::uint32_t point : choice.kept)
      add_native_row(mesh, given.points[point], given.rows, n_linear);
  given.points = {};
  if (choice.kept.size() < donors.size()) {
    std::vector<Donor> kept;
    kept.reserve(choice.kept.size() + choice.vertices.size());
    for (const std::uint32_t point : choice.kept) kept.push_back(donors[point]);
    donors = std::move(kept);
  }
  for (const VertexId vertex : choice.vertices) donors.push_back(donor_at(vertex));
  if (given.rows.columns.empty())
    given.rows = {};
  else
    given.rows.begin.resize(donors.size() + 1, given.rows.columns.size());
  if (donors.empty()) given_.erase(choice.from);
}

void SourceSide::prepare(const MeshView& mesh) {
  if (stays_ == SameMesh::Answer::moved) {
    cover_ = {};
    nearest_.reset();
    nearest_cells_.reset();
  }
  if (!needs_gradients(setup.kind) || has_fits_) return;
  has_fits_ = true;
  std::vector<VertexId> wanted, missing;
  for (const auto& [target, given] : given_)
    for (const Donor& donor : given.donors)
      wanted.insert(wanted.end(), donor.vertices.begin(), donor.vertices.end());
  sort_unique(wanted);
  std::set_difference(wanted.begin(), wanted.end(), gradient_vertices_.begin(),
                      gradient_vertices_.end(), std::back_inserter(missing));
  const Rows<Point> fitted = gradient_rows(mesh, mesh.point_ids, missing);
  Rows<Point> rows;
  std::size_t next_kept = 0, next_fitted = 0;
  for (const VertexId v : wanted) {
    while (next_kept < gradient_vertices_.size() && gradient_vertices_[next_kept] < v) ++next_kept;
    const bool is_new = next_fitted < missing.size() && missing[next_fitted] == v;
    const Rows<Point>& from = is_new ? fitted : gradient_rows_;
    rows.add_row(from, is_new ? next_fitted++ : next_kept);
  }
  gradient_vertices_ = std::move(wanted);
  gradient_rows_ = std::move(rows);
}

std::vector<Point> SourceSide::gradients(std::span<const double> values,
                                         std::size_t n_components) const {
  if (!needs_gradients(setup.kind)) return {};
  std::vector<Point> mine(gradient_vertices_.size() * n_components), all(values.size());
  m2m::apply(gradient_rows_, values, n_components, std::span(mine));
  for (std::size_t i = 0; i < gradient_vertices_.size(); ++i)
    std::copy_n(mine.data() + i * n_components, n_components,
                all.data() + static_cast<std::size_t>(gradient_vertices_[i]) * n_components);
  return all;
}

std::vector<double> SourceSide::interpolate(const MeshView& mesh, const Given& given,
                                            std::span<const double> values,
                                            std::span<const Point> gradients,
                                            std::size_t n_components) const {
  const std::span<const Donor> donors = given.donors;
  std::vector<double> out(donors.size() * n_components);
  if (needs_gradients(setup.kind)) {
    std::vector<Tet> tets;
    std::vector<PointInTet> points;
    for (const Donor& donor : donors) {
      points.push_back({static_cast<std::int32_t>(tets.size()), donor.weights});
      tets.push_back(donor.vertices);
    }
    const Limit limit = setup.kind == TransferKind::limited ? Limit::tetrahedron : Limit::none;
    second_order_values({mesh.points, tets}, points, values, gradients, n_components, limit, {},
                        out);
    return out;
  }
  double* to = out.data();
  for (const Donor& donor : donors)
    for (std::size_t c = 0; c < n_components; ++c) {
      const double* const from = values.data() + c;
      const double value = interpolated(donor.weights, donor.vertices, from, n_components);
      *to++ = setup.clamp ? clamped(value, donor, from, n_components) : value;
    }
  if (given.rows.n_rows() > 0) put_rows(given.rows, values, n_components, setup.clamp, out);
  return out;
}

Rows<double> SourceSide::weights_of(const MeshView& mesh, const Given& given) const {
  std::vector<Tet> tets;
  std::vector<PointInTet> points;
  for (const Donor& donor : given.donors) {
    points.push_back({static_cast<std::int32_t>(tets.size()), donor.weights});
    tets.push_back(donor.vertices);
  }
  if (setup.kind != TransferKind::second_order) {
    Rows<double> linear = linear_rows(tets, points);
    if (given.rows.n_rows() == 0) return linear;
    Rows<double> rows;
    for (std::size_t i = 0; i < tets.size(); ++i)
      rows.add_row(given.rows.columns_of(i).empty() ? linear : given.rows, i);
    return rows;
  }
  Rows<Point> gradients;  // one per point of the piece; empty where no donor needs it
  std::size_t next = 0;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    if (next < gradient_vertices_.size() && gradient_vertices_[next] == static_cast<VertexId>(v)) {
      gradients.add_row(gradient_rows_, next++);
    } else {
      gradients.end_row();
    }
  }
  return second_order_rows({mesh.points, tets}, points, gradients);
}

}  // namespace tess::m2m
