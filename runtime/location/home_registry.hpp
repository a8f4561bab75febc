// The home of an index knows where its element is. One record an index that has left home, lives
// elsewhere, or died; an element that lives on its home PE needs none. Messages that know more than
// the record, or that come before the element does, wait here.
//
//     absent, dead(i)  -- grant -->     live(pe, incarnation i + 1)
//     live             -- it left -->   live(its next PE, version + 1, not landed)
//     live             -- landed -->    live(that PE and version), if newer
//     live             -- died -->      dead(incarnation)
//
// A grant makes the record live at once: the PE that asked keeps what reaches it until the grant
// does, so of two PEs that ask at once exactly one creates, and nothing needs to wait for a
// confirmation.
#pragma once

#include "runtime/index.hpp"
#include "runtime/location/element_message.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

#include <string>
#include <vector>

namespace tess {

/// What a home knows of one index.
struct HomeRecord {
  PeId pe{};
  Version version{};
  bool landed = true;
  bool dead = false;
};

template <class Index>
class HomeRegistry {
 public:
  using Waiting = std::vector<ElementMessage<Index>*>;

  [[nodiscard]] HomeRecord* find(const Index& index) {
    const auto at = records_.find(index);
    return at == records_.end() ? nullptr : &at->second;
  }
  HomeRecord& at(const Index& index) { return records_[index]; }
  void erase(const Index& index) { records_.erase(index); }

  void wait(ElementMessage<Index>* message) { waiting_[message->index].push_back(message); }
  /// Takes out all that waits for an index; the caller routes it again.
  [[nodiscard]] Waiting take_waiting(const Index& index) {
    const auto at = waiting_.find(index);
    if (at == waiting_.end()) return {};
    Waiting messages = std::move(at->second);
    waiting_.erase(at);
    return messages;
  }
  [[nodiscard]] const auto& waiting() const { return waiting_; }
  void clear_waiting() { waiting_.clear(); }

 private:
  boost::unordered_flat_map<Index, HomeRecord, IndexHash<Index>> records_;
  boost::unordered_flat_map<Index, Waiting, IndexHash<Index>> waiting_;
};

}  // namespace tess
