// The index table of one array on one PE: one small record per index, found by one lookup.
//
//     state      on the PE that …                                record
//     here       has the element                                 the element
//     hint       has heard where the element was                 PE and version
//     departed   had it; its home has not confirmed the move     PE and version
//     live       is the home; the element is on another PE       PE and version
//     moving     is the home; the element left this PE           PE and version
//     destroyed  is the home; the element was destroyed          the version of its last life
//
// A record may also say that messages to the index are parked here (Parked). Indices within the
// array's initial range are found by their rank, in pages that are allocated on first use; others
// in a hash table with linear probing, usually within one cache line.
#pragma once

#include "runtime/arrays/location/version.hpp"
#include "runtime/core/ids.hpp"
#include "runtime/core/index.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace tess::detail {

enum class IndexState : std::uint8_t { unknown, here, hint, departed, live, moving, destroyed };

/// Why messages to an index are parked; one bit each. The messages are in a separate table.
enum class Parked : std::uint8_t {
  pending = 1,    ///< this PE has asked the home for permission to create the element
  destroyed = 2,  ///< the element was destroyed here; the home has not confirmed it
  waiting = 4,    ///< this is the home: there is no element, or its place is unknown
};

template <class Element>
class IndexRecord {
 public:
  [[nodiscard]] IndexState state() const { return state_; }
  /// The element, if it is here; null otherwise.
  [[nodiscard]] Element* element() const { return state_ == IndexState::here ? element_ : nullptr; }
  /// The element's PE as far as known, and the version of this knowledge; not if the element is
  /// here.
  [[nodiscard]] PeId pe() const { return pe_; }
  [[nodiscard]] Version version() const { return version_; }

  void set_here(Element& element) {
    element_ = &element;
    state_ = IndexState::here;
  }
  void set(IndexState state, PeId pe, Version version) {
    version_ = version;
    pe_ = pe;
    state_ = state;
  }
  void set_unknown() { set(IndexState::unknown, PeId{}, Version{}); }
  /// Turns `departed` into a hint, which may be forgotten.
  void confirm() { state_ = IndexState::hint; }

  [[nodiscard]] bool parks(Parked why) const {
    return (parked_ & static_cast<std::uint8_t>(why)) != 0;
  }
  [[nodiscard]] bool parks_any() const { return parked_ != 0; }
  void park(Parked why) { parked_ |= static_cast<std::uint8_t>(why); }
  void unpark(Parked why) {
    parked_ = static_cast<std::uint8_t>(parked_ & ~static_cast<unsigned>(why));
  }
  [[nodiscard]] bool empty() const { return state_ == IndexState::unknown && parked_ == 0; }

 private:
  union {
    Element* element_;  // if the state is `here`
    Version version_{};
  };
  PeId pe_{};
  IndexState state_ = IndexState::unknown;
  std::uint8_t parked_ = 0;
};

/// A pointer or reference to a record is valid until the next record is made or erased.
template <class Index, class Element>
class IndexTable {
 public:
  using Record = IndexRecord<Element>;

  explicit IndexTable(const Range& range) : range_(range) {}

  [[nodiscard]] Record* find(const Index& index) {
    if constexpr (Coordinates<Index>) {
      if (const std::int64_t rank = rank_in(range_, index); rank >= 0) {
        const auto page = static_cast<std::size_t>(rank) / page_size;
        if (page >= pages_.size() || !pages_[page]) return nullptr;
        return &(*pages_[page])[static_cast<std::size_t>(rank) % page_size];
      }
    }
    if (n_used_ == 0) return nullptr;
    for (std::size_t at = ideal(index);; at = next(at)) {
      Bucket& bucket = buckets_[at];
      if (!bucket.used) return nullptr;
      if (bucket.index == index) return &bucket.record;
    }
  }

  /// Creates the record if it does not exist.
  Record& at(const Index& index) {
    if constexpr (Coordinates<Index>) {
      if (const std::int64_t rank = rank_in(range_, index); rank >= 0) {
        const auto page = static_cast<std::size_t>(rank) / page_size;
        if (page >= pages_.size()) pages_.resize(range_.size() / page_size + 1);
        if (!pages_[page]) pages_[page] = std::make_unique<Page>();
        return (*pages_[page])[static_cast<std::size_t>(rank) % page_size];
      }
    }
    if (8 * (n_used_ + 1) > 7 * buckets_.size()) grow();
    std::size_t at = ideal(index);
    for (; buckets_[at].used; at = next(at))
      if (buckets_[at].index == index) return buckets_[at].record;
    buckets_[at].index = index;
    buckets_[at].used = true;
    ++n_used_;
    return buckets_[at].record;
  }

  /// Frees the record of the index if it holds nothing.
  void tidy(const Index& index) {
    if constexpr (Coordinates<Index>) {
      if (rank_in(range_, index) >= 0) return;
    }
    if (n_used_ == 0) return;
    std::size_t at = ideal(index);
    for (; buckets_[at].used; at = next(at))
      if (buckets_[at].index == index) break;
    if (buckets_[at].used && buckets_[at].record.empty()) erase(at);
  }

  /// Calls f(index, record) for each record; f may change records but must not create or erase any.
  template <class F>
  void for_each(F f) const {
    if constexpr (Coordinates<Index>) {
      for (std::size_t page = 0; page < pages_.size(); ++page) {
        if (!pages_[page]) continue;
        for (std::size_t i = 0; i < page_size; ++i) {
          if ((*pages_[page])[i].empty()) continue;
          f(index_at<Index>(range_, static_cast<std::int64_t>(page * page_size + i)),
            (*pages_[page])[i]);
        }
      }
    }
    for (Bucket& bucket : buckets_)
      if (bucket.used) f(bucket.index, bucket.record);
  }

  /// Forgets all hints.
  void forget_hints() {
    const auto forget = [](const Index& /*index*/, Record& record) {
      if (record.state() == IndexState::hint) record.set_unknown();
    };
    for_each(forget);
    // A record that moves into the place of an erased one is checked again.
    for (std::size_t at = 0; at < buckets_.size();) {
      if (buckets_[at].used && buckets_[at].record.empty()) {
        erase(at);
      } else {
        ++at;
      }
    }
  }

 private:
  struct Bucket {
    Index index{};
    bool used = false;
    Record record;
  };
  using Buckets = std::vector<Bucket>;
  static constexpr std::size_t page_size = 256;
  using Page = std::array<Record, page_size>;

  /// The slot at which the search for an index begins.
  [[nodiscard]] std::size_t ideal(const Index& index) const {
    __extension__ using Wide = unsigned __int128;
    return static_cast<std::size_t>(Wide{IndexHash<Index>()(index)} * buckets_.size() >> 64U);
  }
  [[nodiscard]] std::size_t next(std::size_t at) const {
    return at + 1 == buckets_.size() ? 0 : at + 1;
  }
  void grow() {
    Buckets old(std::max<std::size_t>(16, buckets_.size() + buckets_.size() / 2));
    old.swap(buckets_);
    for (Bucket& bucket : old) {
      if (!bucket.used) continue;
      std::size_t at = ideal(bucket.index);
      while (buckets_[at].used) at = next(at);
      buckets_[at] = std::move(bucket);
    }
  }
  /// Erases a record and moves later ones forward, so that no search stops at the gap.
  void erase(std::size_t gap) {
    for (std::size_t at = next(gap); buckets_[at].used; at = next(at)) {
      const std::size_t begin = ideal(buckets_[at].index);
      // The record may move to the gap unless its search begins behind the gap.
      const bool behind = gap <= at ? gap < begin && begin <= at : gap < begin || begin <= at;
      if (behind) continue;
      buckets_[gap] = std::move(buckets_[at]);
      gap = at;
    }
    buckets_[gap] = Bucket{};
    --n_used_;
  }

  const Range range_;
  std::vector<std::unique_ptr<Page>> pages_;  // by rank
  mutable Buckets buckets_;
  std::size_t n_used_ = 0;
};

}  // namespace tess::detail
