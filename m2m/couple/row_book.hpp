// Collects the rows of a coupling as weights over global ids, for files of weights. Source pieces
// send the rows of their donors to the target pieces, which know the ids of the points; these write
// them into the book of their PE.
#pragma once

#include "collide/collider.hpp"
#include "m2m/couple/messages.hpp"
#include "runtime/runtime.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace tess::m2m {

/// Rows of weights. The weights of row i stand behind those of the rows before it.
struct GlobalRows {
  std::vector<GlobalId> targets;     ///< per row
  std::vector<std::uint64_t> sizes;  ///< per row: its weights
  std::vector<GlobalId> columns;     ///< source vertices
  std::vector<double> weights;
};
struct JoinRows {
  GlobalRows operator()(GlobalRows a, const GlobalRows& b) const {
    const auto append = [](auto& to, const auto& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    append(a.targets, b.targets);
    append(a.sizes, b.sizes);
    append(a.columns, b.columns);
    append(a.weights, b.weights);
    return a;
  }
};

class RowBook : public Group<RowBook> {
 public:
  /// Called by target pieces on this PE.
  void add(const GlobalRows& rows) { page_ = JoinRows{}(std::move(page_), rows); }
  /// Entry method: gives the rows of all PEs.
  void close_page(Callback<GlobalRows> target) {
    contribute(JoinRows{}, std::exchange(page_, {}), std::move(target));
  }

 private:
  GlobalRows page_;
};

/// From a source piece to a target piece: the rows of its donors, in the order of the Choice.
struct GivenRows {
  CouplingId coupling{};
  collide::OwnerId from{};
  GroupProxy<RowBook> book;
  GlobalRows rows;  ///< without targets
};

}  // namespace tess::m2m
