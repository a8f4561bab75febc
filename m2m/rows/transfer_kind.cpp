#include "m2m/transfer_kind.hpp"

#include "m2m/mesh.hpp"
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

void require_dimension(TransferKind kind, std::int32_t dimension) {
  if (dimension == 3 || kind == TransferKind::linear || kind == TransferKind::nearest ||
      kind == TransferKind::projection || kind == TransferKind::moving_least_squares)
    return;
  fail(ErrorCode::bad_argument, "kind ", name_of(kind), " needs tetrahedra; the mesh has ",
       cells_of(dimension), ": choose linear, nearest or projection");
}

TransferKind parse_transfer_kind(const std::string& text) {
  std::string names;
  for (const TransferKind kind : all_transfer_kinds) {
    if (text == name_of(kind)) return kind;
    names += (names.empty() ? "" : ", ") + std::string(name_of(kind));
  }
  fail(ErrorCode::bad_argument, "kind '", text, "' is unknown; choose one of ", names);
}

}  // namespace tess::m2m
