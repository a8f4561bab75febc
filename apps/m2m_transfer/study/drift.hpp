// How fields drift when they go from one mesh to another and back, many times, with one pair of
// handles. The table is the same bit for bit for any number of parts, PEs and processes
// (m2m/field_norms.hpp).
#pragma once

#include "apps/kit/progress.hpp"
#include "apps/kit/rows.hpp"
#include "apps/m2m_transfer/input/problem.hpp"
#include "apps/m2m_transfer/output/folder.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace m2m_transfer {

/// A field on the first mesh after some round trips, compared with the start.
struct DriftRow {
  std::string kind, field;
  std::int32_t trips = 0;
  double l2_relative = 0;  ///< of the difference, divided by the norm of the start
  double linf = 0;         ///< of the difference
  double l2_kept = 0;      ///< L2 norm, divided by that of the start
  double integral = 0;
  double integral_change = 0;  ///< divided by the integral of |field| at the start
  std::uint64_t hash = 0;      ///< of the values
};

struct Drift {
  std::vector<DriftRow> rows;        ///< by kind, then by trips, then by field
  std::vector<double> trip_seconds;  ///< per kind: one round trip, the mean of all
};

/// "1,2,5": ascending numbers of round trips. Throws Error (bad_argument) for any other text.
[[nodiscard]] std::vector<std::int32_t> parse_trips(const std::string& text);

/// Runs all kinds one after the other. `request` has two meshes and no pairs.
Task measure_drift(Request request, const std::vector<TransferKind>& kinds,
                   const std::vector<std::int32_t>& trips, kit::Progress& progress, Drift& drift);

[[nodiscard]] const kit::Rows<DriftRow>& drift_rows();
/// The differences and the change of the integral against the number of trips.
[[nodiscard]] std::vector<Picture> pictures_of(const std::vector<DriftRow>& rows);

}  // namespace m2m_transfer
