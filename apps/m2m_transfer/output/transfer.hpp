// What is shown of one transfer: its report, the text of --explain, and a picture.
#pragma once

#include "apps/m2m_transfer/input/problem.hpp"

#include <string>

namespace m2m_transfer {

/// In lines.
[[nodiscard]] std::string table(const TransferReport& report);
/// The meaning of the numbers in a table.
[[nodiscard]] std::string legend();

/// The output besides the table: none, or the target mesh (--out).
enum class Output { report, mesh };

/// What a transfer uses, and what it leaves out, in lines.
[[nodiscard]] std::string explain(const Problem& problem, Output output);

/// A cut through the last pair's target across its shortest side, as SVG: the first field, and
/// beside it |value - truth|. Each tetrahedron that the plane intersects is a polygon with one
/// colour. Vertices outside have the values of the policy.
[[nodiscard]] std::string picture(const Problem& problem);

}  // namespace m2m_transfer
