// Messages of the rounds of a coupling's channels. Source pieces give round after round and wait
// for nothing, so messages of later rounds can arrive before those of the present one.
#pragma once

#include "m2m/couple/messages.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace tess::m2m {

class Rounds {
 public:
  void add(GivenValues message) { rounds_[message.number].push_back(std::move(message)); }
  /// True if `n` messages of the next round are here.
  [[nodiscard]] bool has_next(std::size_t n) const {
    const auto at = rounds_.find(next_);
    return at != rounds_.end() && at->second.size() >= n;
  }
  /// The messages of the next round, which then ends.
  [[nodiscard]] std::vector<GivenValues> take() {
    auto node = rounds_.extract(next_++);
    return std::move(node.mapped());
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(next_, rounds_);
  }

 private:
  std::uint32_t next_ = 0;
  std::map<std::uint32_t, std::vector<GivenValues>> rounds_;
};

}  // namespace tess::m2m
