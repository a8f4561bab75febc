// Memory of the PEs under a placement that changes:
//
//     a PE's memory =  its own working memory
//                    + the resident size of each element there
//                    + each shared block that any of them uses, once
//                    + the largest working memory of an element there, since one works at a time
//
// (The model of the load-balancing tools of DARMA-tasking: LB-analysis-framework, Rank and Object.)
// An element that leaves never adds to the memory of its PE.
#pragma once

#include "runtime/balance/snapshot.hpp"

#include <map>

namespace tess::balance {

class Memory {
 public:
  /// Of the present placement. The snapshot outlives it.
  explicit Memory(const Snapshot& snapshot);

  void move(std::size_t element, std::size_t from, std::size_t to);
  [[nodiscard]] std::uint64_t bytes(std::size_t pe) const { return bytes_[pe] + most_work(pe); }
  /// With an element added that is elsewhere.
  [[nodiscard]] std::uint64_t bytes_with(std::size_t element, std::size_t pe) const;

 private:
  void put(std::size_t element, std::size_t pe);
  [[nodiscard]] std::uint64_t most_work(std::size_t pe) const {
    return working_.empty() || working_[pe].empty() ? 0 : working_[pe].rbegin()->first;
  }

  const Snapshot& snapshot_;
  std::vector<std::uint64_t> bytes_;  // all but the largest working memory
  // Per PE: elements per shared block, and per working memory. Empty if the snapshot has none.
  std::vector<std::map<std::size_t, std::size_t>> users_;
  std::vector<std::map<std::uint64_t, std::size_t>> working_;
};

/// The memory of every PE under an assignment.
[[nodiscard]] std::vector<std::uint64_t> memory_of(const Snapshot& snapshot,
                                                   const Assignment& assignment);

}  // namespace tess::balance
