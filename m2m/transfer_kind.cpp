#include "m2m/transfer_kind.hpp"

#include "runtime/core/error.hpp"

namespace tess::m2m {

TransferKind parse_transfer_kind(const std::string& text) {
  if (text == "linear") return TransferKind::linear;
  if (text == "second-order") return TransferKind::second_order;
  if (text == "limited") return TransferKind::limited;
  fail(ErrorCode::bad_argument, "kind '", text,
       "' is unknown; choose linear, second-order or limited");
}

}  // namespace tess::m2m
