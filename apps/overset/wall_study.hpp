// The time of the inside test against the size of the wall.
#pragma once

#include <string>

namespace overset {

/// A row per size, up to 1e5 triangles: processor time of a million random points in the box of the
/// wall. `shape` as in body.hpp. 200 of them are compared with sums of solid angles; a difference
/// ends the program.
[[nodiscard]] std::string wall_study(const std::string& shape);

}  // namespace overset
