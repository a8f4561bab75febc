// A user's map of an array's indices to PEs (runtime/more/index_map.hpp), without the types of the index
// and of the map. It is the same on every PE, and goes into checkpoints.
#pragma once

#include "runtime/core/ids.hpp"
#include "runtime/core/index.hpp"
#include "runtime/core/registry.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace tess::detail {

class IndexMap;

/// Makes a map from bytes; one static object for each pair of chare class and type of map.
struct IndexMapKind : Registered {
  using Unpack = std::shared_ptr<const IndexMap> (*)(Reader&);
  IndexMapKind(naming::Name name, Unpack unpack_) : Registered(name), unpack(unpack_) {}
  Unpack unpack;
};

class IndexMap {
 public:
  IndexMap() = default;
  IndexMap(const IndexMap&) = delete;
  IndexMap& operator=(const IndexMap&) = delete;
  virtual ~IndexMap() = default;

  /// The home of an index, of the array's type.
  [[nodiscard]] virtual PeId home(const void* index, const Range& range,
                                  std::int32_t n_pes) const = 0;
  [[nodiscard]] virtual const IndexMapKind& kind() const = 0;
  virtual void pack(Writer& ar) const = 0;
};

/// For checkpoints; empty for no map.
[[nodiscard]] std::vector<std::byte> to_saved(const IndexMap* map);
[[nodiscard]] std::shared_ptr<const IndexMap> from_saved(std::span<const std::byte> bytes);

}  // namespace tess::detail
