// A mailbox of a chare: messages wait in it by key until a coroutine of the chare takes them.
// Messages and coroutines may arrive in either order. It is a member of the chare; serialise it
// with the other members, then early messages migrate with the chare. The key may be of any type
// that is compared with < and ==.
//
//     tess::Mailbox<&Edge::step> edges_;     void receive(Edge e) { edges_.put(std::move(e)); }
//     Edge edge = co_await edges_.take(step);
#pragma once

#include "runtime/core/index.hpp"
#include "runtime/core/serialize.hpp"
#include "runtime/task.hpp"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
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

/// The second parameter distinguishes messages of the same name that are local to two files:
/// without it g++ 12 gives both files one Mailbox<&Local::key>.
template <auto KeyMember, class Message = typename detail::KeyTraits<decltype(KeyMember)>::Value>
class Mailbox {
 public:
  using Key = typename detail::KeyTraits<decltype(KeyMember)>::Key;
  using Value = Message;
  static_assert(
      requires(const Key& key) {
        key < key;
        key == key;
      }, "the key of a mailbox is compared with < and ==: give it a defaulted operator<=>");

  /// Passes a message to the coroutine that has waited longest for its key; if there is none, keeps
  /// it. Messages of one key are taken in the order in which they were put.
  void put(Value value) {
    if (!give(value)) kept_.emplace(value.*KeyMember, std::move(value));
  }

 private:
  /// Passes the message to a coroutine that waits for its key; false if there is none.
  [[nodiscard]] bool give(Value& value) {
    const Key& key = value.*KeyMember;
    for (auto at = waiting_.begin(); at != waiting_.end(); ++at) {
      if (!((*at)->key_ == key)) continue;
      Take* take = *at;
      waiting_.erase(at);
      take->value_ = std::move(value);
      std::exchange(take->waiting_, nullptr)->wake();
      return true;
    }
    return false;
  }
  void put_back(Value value) {
    const Key key = value.*KeyMember;
    kept_.emplace_hint(kept_.lower_bound(key), key, std::move(value));
  }
  /// Gives kept messages of this key, the oldest first, to coroutines that wait for it.
  void give_kept(const Key& key) {
    auto at = kept_.lower_bound(key);
    while (at != kept_.end() && !kept_.key_comp()(key, at->first) && give(at->second))
      at = kept_.erase(at);
  }

 public:
  class Take {
   public:
    [[nodiscard]] bool await_ready() {
      if (value_) return true;
      const auto at = box_.kept_.lower_bound(key_);  // the oldest message of this key
      if (at == box_.kept_.end() || box_.kept_.key_comp()(key_, at->first)) return false;
      value_ = std::move(at->second);
      box_.kept_.erase(at);
      return true;
    }
    void await_suspend(Task::Handle task) {
      own_.start(task, 1);
      wait(own_);
      detail::suspend_on(task, *this);
    }
    Value await_resume() { return std::move(*value_); }

    // when_all and when_any call these.
    void wait(detail::Waiter& waiter) {
      waiting_ = &waiter;
      box_.waiting_.push_back(this);
    }
    /// A message that this has taken is again the oldest of its key. pass_on() follows, once all
    /// that are withdrawn together are.
    void withdraw() {
      if (waiting_ != nullptr) std::erase(box_.waiting_, this);
      waiting_ = nullptr;
      if (value_) box_.put_back(*std::exchange(value_, std::nullopt));
    }
    void pass_on() { box_.give_kept(key_); }
    [[nodiscard]] std::string waits_for() const {
      return text("a message of key ", key_text(), " (", name_of_type<Value>, ")");
    }

   private:
    friend class Mailbox;
    [[nodiscard]] std::string key_text() const {
      if constexpr (Writable<Key>)
        return text(key_);
      else
        return index_text(key_);
    }
    Take(Mailbox& box, Key key) : box_(box), key_(std::move(key)) {}
    Mailbox& box_;
    Key key_;
    detail::Waiter own_;
    detail::Waiter* waiting_ = nullptr;
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
