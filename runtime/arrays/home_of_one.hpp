// The home of a single chare (runtime/more/singleton.hpp): the PE on which it was created. Without it all
// single chares would have the same home, since they have the same index. A checkpoint saves it with
// the PE on which the chare is then; a restart on as many PEs finds the chare there again.
#pragma once

#include "runtime/arrays/elements/index_map.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace tess::detail {

class HomeOfOne final : public IndexMap {
 public:
  /// `given`: the PE that the program chose; on another number of PEs it is that modulo their number.
  /// −1: the runtime chooses, by the id of the chare's array.
  HomeOfOne(CollectionId of, PeId given, std::int32_t n_pes);

  [[nodiscard]] PeId home(const void* index, const Range& range, std::int32_t n_pes) const override;
  [[nodiscard]] const IndexMapKind& kind() const override;
  void pack(Writer& ar) const override { ar(of_, given_, pe_, n_pes_); }

  /// to_saved() of the map of a single chare that is on this PE; empty for another map.
  [[nodiscard]] static std::vector<std::byte> saved_from(const IndexMap* map, PeId pe,
                                                         std::int32_t n_pes);

 private:
  HomeOfOne(CollectionId of, PeId given, PeId pe, std::int32_t n_pes)
      : of_(of), given_(given), pe_(pe), n_pes_(n_pes) {}
  static std::shared_ptr<const IndexMap> unpack(Reader& ar);
  static const IndexMapKind kind_;

  const CollectionId of_;
  const PeId given_;
  const PeId pe_;  // the home in a run with this many PEs
  const std::int32_t n_pes_;
};

}  // namespace tess::detail
