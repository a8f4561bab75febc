// A mailbox of a chare: messages wait in it by key until a coroutine of the chare takes them.
// Messages and coroutines may arrive in either order. It is a member of the chare; serialise it
// with the other members, then early messages migrate with the chare.
//
//     tess::Mailbox<&Edge::step> edges_;     void receive(Edge e) { edges_.put(std::move(e)); }
//     Edge edge = co_await edges_.take(step);
#pragma once

#include "runtime/core/serialize.hpp"
#include "runtime/task.hpp"

#include <functional>
#include <map>
#include <optional>
#include <vector>

namespace tess {

namespace detail {
template <class M>
struct KeyTraits;
template <class K, class T>
struct KeyTraits<K T::*> {
  using Key = K;
  using Value = T;
};
}  // namespace detail

template <auto KeyMember>
class Mailbox {
 public:
  using Key = typename detail::KeyTraits<decltype(KeyMember)>::Key;
  using Value = typename detail::KeyTraits<decltype(KeyMember)>::Value;

  /// Passes a message to the coroutine that has waited longest for its key; if there is none, keeps
  /// it. Messages of one key are taken in the order in which they were put.
  void put(Value value) {
    const Key& key = value.*KeyMember;
    for (auto at = waiting_.begin(); at != waiting_.end(); ++at) {
      if (!((*at)->key_ == key)) continue;
      Take* take = *at;
      waiting_.erase(at);
      take->value_ = std::move(value);
      resume_later(take->task_);
      return;
    }
    kept_.emplace(key, std::move(value));
  }

  class Take {
   public:
    [[nodiscard]] bool await_ready() {
      const auto at = box_.kept_.lower_bound(key_);  // the oldest message of this key
      if (at == box_.kept_.end() || box_.kept_.key_comp()(key_, at->first)) return false;
      value_ = std::move(at->second);
      box_.kept_.erase(at);
      return true;
    }
    void await_suspend(Task::Handle task) {
      task_ = task;
      box_.waiting_.push_back(this);
      suspend(task,
              [this] { return text("a message of key ", key_, " (", name_of_type<Value>, ")"); });
    }
    Value await_resume() { return std::move(*value_); }

   private:
    friend class Mailbox;
    Take(Mailbox& box, Key key) : box_(box), key_(std::move(key)) {}
    Mailbox& box_;
    Key key_;
    Task::Handle task_;
    std::optional<Value> value_;
  };

  /// When awaited, returns the next message of this key.
  [[nodiscard]] Take take(Key key) { return Take(*this, std::move(key)); }

  [[nodiscard]] std::size_t size() const { return kept_.size(); }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(kept_);
  }

 private:
  // Equal keys stay in the order in which they were put.
  std::multimap<Key, Value, std::less<>, detail::PoolAllocator<std::pair<const Key, Value>>> kept_;
  std::vector<Take*> waiting_;
};

}  // namespace tess
