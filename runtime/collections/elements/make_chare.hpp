// Construction of chares and group members, so that an exception there can be reported.
#pragma once

#include "runtime/core/registry.hpp"
#include "runtime/scheduler/pe.hpp"

#include <string>
#include <type_traits>
#include <utility>

namespace tess::detail {

/// Constructs a chare. If the constructor throws, the report names it.
template <class C, class... Args>
[[nodiscard]] C* make_chare(Args&&... args) {
  try {
    return new C(std::forward<Args>(args)...);
  } catch (...) {
    std::string types;
    ((types += (types.empty() ? "" : ", ") + plain_name(name_of_type<std::decay_t<Args>>)), ...);
    current_pe().note_constructor(text(plain_name(name_of_type<C>), "(", types, ")"));
    throw;
  }
}

}  // namespace tess::detail
