// Handles: the small values by which programs name collections, their elements and sections. They
// are stored and sent, compare with ==, and are keys of unordered maps. Two that are equal name the
// same thing.
#pragma once

#include "runtime/core/ids.hpp"

#include <cstddef>
#include <functional>

namespace tess::detail {

/// A class of handles says so by the member type IsHandle; it has hash(), which makes it a key.
template <class H>
concept Handle = requires { typename H::IsHandle; };

}  // namespace tess::detail

template <tess::detail::Handle H>
struct std::hash<H> {
  [[nodiscard]] std::size_t operator()(const H& handle) const { return handle.hash(); }
};
