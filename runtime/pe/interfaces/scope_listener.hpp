// The interface by which a PE's meter reports its scopes to the heat maps of the live view.
#pragma once

#include <cstdint>

namespace tess::detail {

/// Sees which element's code runs: it is in the context of the PE.
class ScopeListener {
 public:
  ScopeListener() = default;
  ScopeListener(const ScopeListener&) = delete;
  ScopeListener& operator=(const ScopeListener&) = delete;
  virtual ~ScopeListener() = default;

  /// A scope has begun or ended; `at` in ticks of the meter.
  virtual void changed(std::uint64_t at) = 0;
};

}  // namespace tess::detail
