#include "runtime/pe/pending_error.hpp"

#include "runtime/core/text.hpp"
#include "runtime/pe/pe.hpp"
#include "runtime/pe/runtime.hpp"

namespace tess::detail {

void PendingError::keep(std::exception_ptr error) {
  note_place();
  if (!kept_) kept_ = std::move(error);
}

void PendingError::note_place() {
  if (place_.empty()) place_ = pe_.runtime().describe(pe_);
}

void PendingError::note_place(std::string_view instead) {
  if (place_.empty()) place_ = text("on ", pe_.id(), ", ", instead);
}

void PendingError::note_constructor(std::string_view of,
                                    std::initializer_list<std::string_view> types) {
  if (!place_.empty()) return;
  place_ = pe_.runtime().describe(pe_) + " " + plain_name(of) + "(";
  for (const std::string_view& type : types)
    place_ += (&type == types.begin() ? "" : ", ") + plain_name(type);
  place_ += ")";
}

}  // namespace tess::detail
