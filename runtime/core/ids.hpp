// Strong identifiers: a PE cannot be passed where a process or an array is meant. They are plain
// integers in memory, totally ordered and hashable, and messages carry them unchanged.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iosfwd>

namespace tess {

/// A processing element: 0 … n_pes − 1 over the whole job. PEs of one process are consecutive.
struct PeId {
  std::int32_t value = 0;
  friend constexpr auto operator<=>(const PeId&, const PeId&) = default;
};
std::ostream& operator<<(std::ostream& out, PeId pe);

/// A process of the job (an MPI rank): 0 … n_processes − 1.
struct ProcessId {
  std::int32_t value = 0;
  friend constexpr auto operator<=>(const ProcessId&, const ProcessId&) = default;
};
std::ostream& operator<<(std::ostream& out, ProcessId p);

/// An array or a group, the same number on every PE.
struct CollectionId {
  std::uint64_t value = 0;
  friend constexpr auto operator<=>(const CollectionId&, const CollectionId&) = default;
};
std::ostream& operator<<(std::ostream& out, CollectionId id);

/// A scoped epoch. Epoch 0 is the whole run.
struct EpochId {
  std::uint64_t value = 0;
  friend constexpr auto operator<=>(const EpochId&, const EpochId&) = default;
};
std::ostream& operator<<(std::ostream& out, EpochId id);

/// A reduction of an array by its number: 0 is the first one since the array was created or
/// restored.
struct RoundId {
  std::int64_t number = 0;
  friend constexpr auto operator<=>(const RoundId&, const RoundId&) = default;
};

}  // namespace tess

template <>
struct std::hash<tess::PeId> {
  std::size_t operator()(tess::PeId id) const noexcept {
    return static_cast<std::size_t>(id.value);
  }
};
template <>
struct std::hash<tess::CollectionId> {
  std::size_t operator()(tess::CollectionId id) const noexcept {
    return static_cast<std::size_t>(id.value);
  }
};
template <>
struct std::hash<tess::EpochId> {
  std::size_t operator()(tess::EpochId id) const noexcept {
    return static_cast<std::size_t>(id.value);
  }
};
