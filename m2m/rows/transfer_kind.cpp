#include "m2m/transfer_kind.hpp"

#include "m2m/mesh.hpp"
#include "runtime/core/did_you_mean.hpp"
#include "runtime/core/error.hpp"

namespace tess::m2m {

const char* name_of(TransferKind kind) noexcept {
  switch (kind) {
    case TransferKind::linear:
      return "linear";
    case TransferKind::second_order:
      return "second-order";
    case TransferKind::limited:
      return "limited";
    case TransferKind::nearest:
      return "nearest";
    case TransferKind::projection:
      return "projection";
    case TransferKind::moving_least_squares:
      return "moving-least-squares";
    case TransferKind::native:
      return "native";
    case TransferKind::conservative:
      return "conservative";
    case TransferKind::conservative_bounded:
      return "conservative-bounded";
    case TransferKind::conservative_lumped:
      return "conservative-lumped";
  }
  return "";
}

void require_dimensions(TransferKind kind, double tolerance, std::int32_t source,
                        std::int32_t target) {
  const bool conserves = is_conservative(kind);
  const bool has_gradients = kind == TransferKind::second_order || kind == TransferKind::limited;
  for (const std::int32_t dimension : {source, conserves ? target : source}) {
    if (dimension == 3 || (conserves ? dimension == 2 : !has_gradients)) continue;
    fail(ErrorCode::bad_argument, "kind ", name_of(kind), " needs tetrahedra",
         conserves ? " or triangles" : "", "; the mesh has ", cells_of(dimension),
         ": choose linear, nearest or projection");
  }
  if (conserves && source != target)
    fail(
        ErrorCode::bad_argument, "kind ", name_of(kind),
        " needs two meshes of the same cells; the source has ", cells_of(source), ", the target ",
        cells_of(target),
        ": take the skin of the tetrahedra (surface.hpp), or choose linear, nearest or projection");
  if (conserves && source == 3 && tolerance > 0)
    fail(ErrorCode::bad_argument, "kind ", name_of(kind),
         " takes a tolerance between triangles only; the meshes have tetrahedra: leave out the "
         "tolerance ",
         tolerance);
}

TransferKind parse_transfer_kind(const std::string& text) {
  std::string names;
  for (const TransferKind kind : all_transfer_kinds) {
    if (text == name_of(kind)) return kind;
    names += (names.empty() ? "" : ", ") + std::string(name_of(kind));
  }
  fail(ErrorCode::bad_argument, "kind '", text, "' is unknown; choose one of ", names,
       did_you_mean(text, names));
}

}  // namespace tess::m2m
