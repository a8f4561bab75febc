// The futures that are in use on a PE, by number: where a result from another PE finds the future it
// belongs to. A future that moves, has its result or is destroyed says so, and a number is not used
// again, so that a late result finds nothing. One thread.
//
//     number = place | how often the place had been used before << 32
//
// A restart continues the numbers behind those of the saved run. Its own futures keep their numbers;
// the main program has none before it.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace tess::detail {

class FutureTable {
 public:
  /// Returns the number of a new future.
  std::uint64_t enter(void* future);
  void move(std::uint64_t id, void* future);
  void leave(std::uint64_t id);
  /// Null if the future is no longer in use.
  [[nodiscard]] void* find(std::uint64_t id);
  /// Ends the job with a sentence that says why the future is not there.
  [[nodiscard]] void* require(std::uint64_t id);

  [[nodiscard]] bool empty() const { return unused_.size() + 1 == places_.size(); }
  /// The places of all numbers so far are below this one.
  [[nodiscard]] std::uint32_t n_places() const {
    return first_ + static_cast<std::uint32_t>(places_.size());
  }
  /// The places of new numbers begin with this one.
  void begin_behind(std::uint32_t n_places);

 private:
  struct Place {
    void* future = nullptr;  // null: not in use
    std::uint32_t n_used = 0;
  };
  [[nodiscard]] Place* place_of(std::uint64_t id);
  /// Where the table keeps the future; null if it is no longer there.
  [[nodiscard]] void** known(std::uint64_t id);

  std::uint32_t first_ = 0;       // the number of the first place; above those of the run that a
                                  // restart continues
  std::vector<Place> places_{1};  // the first is never used: no future has number 0
  std::vector<std::uint32_t> unused_;
  std::vector<std::pair<std::uint64_t, void*>> before_restart_;  // made before it, by their numbers
};

}  // namespace tess::detail
