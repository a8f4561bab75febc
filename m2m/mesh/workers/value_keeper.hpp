// The values of a mesh in the order of the vertices, a range on each PE: for hash_values()
// (field_norms.hpp). The hash of a list is that of its ranges one after the other, each with the hash
// so far as the start.
#pragma once

#include "m2m/mesh.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <vector>

namespace tess::m2m {

/// Rows of vertices within the range of one PE.
struct KeptRows {
  std::vector<GlobalId> vertices;
  std::vector<double> values;  ///< vertices.size() × n_components, row-major
};

/// Some components in a row, and the hash of what comes before them.
struct HashStart {
  std::uint64_t first = 0, n = 1;  ///< components
  std::uint64_t hash = 0;
};

class ValueKeeper : public Group<ValueKeeper> {
 public:
  ValueKeeper(GlobalId n_vertices, std::uint64_t n_components);
  /// The first vertex of a PE's range.
  [[nodiscard]] static GlobalId first_of(GlobalId n_vertices, std::int32_t pe, std::int32_t n_pes) {
    return n_vertices * pe / n_pes;
  }
  void take(const KeptRows& rows);
  /// The hash after the components of this range.
  [[nodiscard]] std::uint64_t extend(const HashStart& start);

 private:
  GlobalId first_ = 0;
  std::uint64_t n_components_ = 0;
  std::uint64_t n_due_ = 0;     // vertices that have not come
  std::vector<double> values_;  // row-major
};

}  // namespace tess::m2m
