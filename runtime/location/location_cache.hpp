// Where elements were when this PE last heard of them. A hint: a message that follows a stale one
// is forwarded. Bounded: past its bound the cache forgets everything, which costs one trip through
// the home for each index in use.
#pragma once

#include "runtime/index.hpp"
#include "runtime/location/element_message.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

#include <cstddef>

namespace tess {

struct Place {
  PeId pe{};
  Version version{};
};

template <class Index>
class LocationCache {
 public:
  static constexpr std::size_t bound = 1U << 18U;

  [[nodiscard]] const Place* find(const Index& index) const {
    const auto at = places_.find(index);
    return at == places_.end() ? nullptr : &at->second;
  }
  /// Only newer knowledge applies.
  void learn(const Index& index, const Place& place) {
    if (places_.size() >= bound) places_.clear();
    Place& known = places_[index];
    if (place.version > known.version) known = place;
  }
  void forget(const Index& index) { places_.erase(index); }

 private:
  boost::unordered_flat_map<Index, Place, IndexHash<Index>> places_;
};

}  // namespace tess
