// Construction of chares and group members, so that an exception there can be reported.
#pragma once

#include "runtime/core/type_name.hpp"
#include "runtime/pe/pe.hpp"

#include <type_traits>
#include <utility>

namespace tess::detail {

/// Constructs a chare. If the constructor throws, the report names it.
template <class C, class... Args>
[[nodiscard]] C* make_chare(Args&&... args) {
  return call_user([&] {
    try {
      return new C(std::forward<Args>(args)...);
    } catch (...) {
      current_pe().error().note_constructor(name_of_type<C>, {name_of_type<std::decay_t<Args>>...});
      throw;
    }
  });
}

}  // namespace tess::detail
