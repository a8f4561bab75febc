// Watch points: the values of the source at points that --watch names, at every step. They are
// targets of the same kind, with a search of their own.
#pragma once

#include "apps/kit/rows.hpp"
#include "apps/m2m_transfer/names.hpp"
#include "m2m/field.hpp"
#include "m2m/status.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace m2m_transfer {

/// A component of a field at a point.
struct Watched {
  double time = 0;
  Point at{};
  std::string field{};  ///< "v[2]" is a component of several
  Status status{};
  std::optional<double> value{};  ///< none outside, whatever the policy
};

/// A cloud of the points "x,y,z". Throws Error (bad_argument) with the text that is none.
[[nodiscard]] TetMesh watch_points(const std::vector<std::string>& texts);

/// Appends rows of one time, by points and then by fields.
void add_watched(std::vector<Watched>& rows, double time, const TetMesh& cloud,
                 std::span<const Field> fields, std::span<const Status> status);

/// time, x, y, z, field, value, status ("inside", "snapped" or "outside").
[[nodiscard]] const kit::Rows<Watched>& watch_rows();

}  // namespace m2m_transfer
