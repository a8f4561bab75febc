// Finds the PE that finishes first with one more element. PEs are ordered by their time, one order
// per distinct speed, since among PEs of equal speed the least loaded one wins for every element.
// Ties go to the PE that was given fewer elements (so that elements without load spread as well),
// then to the lower number. A query costs O(number of speeds), a change O(log n_pes).
#pragma once

#include "runtime/balance/loads.hpp"

#include <map>
#include <set>
#include <tuple>

namespace tess::balance {

class Soonest {
 public:
  Soonest(const Snapshot& s, const Loads& loads)
      : snapshot_(s), loads_(loads), given_(s.pes.size(), 0), key_(s.pes.size()) {
    std::map<double, std::size_t> class_of;
    for (const double speed : s.pes.speed) {
      class_.push_back(class_of.try_emplace(speed, class_of.size()).first->second);
    }
    classes_.resize(class_of.size());
    for (std::size_t p = 0; p < s.pes.size(); ++p) {
      key_[p] = {loads.time(p), 0, p};
      classes_[class_[p]].insert(key_[p]);
    }
  }

  /// The PE that finishes first with the element, which occupies `from`, among those with room.
  /// `from` always has room.
  [[nodiscard]] std::size_t best(std::size_t element, std::size_t from) const {
    const double load = snapshot_.elements.load[element].seconds();
    Key best{0, 0, from};
    bool found = false;
    for (const auto& one_speed : classes_) {
      for (const Key& key : one_speed) {
        const auto [time, given, pe] = key;
        if (!loads_.fits(element, from, pe)) continue;
        const Key candidate{loads_.time(pe, load), given, pe};
        if (!found || candidate < best) best = candidate;
        found = true;
        break;
      }
    }
    return std::get<2>(best);
  }

  /// Must be called after the loads of a PE have changed.
  void update(std::size_t pe) {
    auto& one_speed = classes_[class_[pe]];
    auto node = one_speed.extract(key_[pe]);
    key_[pe] = {loads_.time(pe), ++given_[pe], pe};
    node.value() = key_[pe];
    one_speed.insert(std::move(node));
  }

 private:
  using Key = std::tuple<double, std::size_t, std::size_t>;  // time, elements given, PE

  const Snapshot& snapshot_;
  const Loads& loads_;
  std::vector<std::size_t> given_;
  std::vector<Key> key_;
  std::vector<std::size_t> class_;
  std::vector<std::set<Key>> classes_;
};

}  // namespace tess::balance
