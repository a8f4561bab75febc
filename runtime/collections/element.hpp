// What the runtime keeps of a chare: where it is registered, which life and place of its index it
// is, which broadcasts it has met, which reduction it contributes to next. The user's class derives
// from it through Chare or Group.
#pragma once

#include "runtime/core/ids.hpp"
#include "runtime/location/version.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace tess {

class Collection;
struct BalanceRecord;

/// Frees a record; out of line, for most elements have none.
struct EndRecord {
  void operator()(BalanceRecord* record) const;
};

/// The part of an element that travels with it besides the user's members.
struct ElementState {
  Version version{};
  std::uint32_t next_reduction = 0;
  std::uint32_t created_after =
      0;  // the last broadcast before its birth; 0 once it has contributed
  std::uint64_t seen_broadcast = 0;
};

class Element {
 public:
  Element(const Element&) = delete;
  Element& operator=(const Element&) = delete;

 protected:
  Element() = default;
  ~Element() = default;

  /// Runs `call` once the element that is constructed now is known to its collection. `what` needs
  /// that.
  static void after_construction(const char* what, std::function<void()> call);

 private:
  friend class Collection;
  template <class>
  friend class ArrayOf;
  template <class>
  friend class Array;
  template <class>
  friend class IndexedElement;
  friend class ElementScope;
  template <class, class>
  friend class Chare;
  template <class>
  friend class Group;
  friend struct Contribution;
  friend struct TaskAccount;
  friend std::string element_text(const Element& element);

  Collection* collection_ = nullptr;
  std::unique_ptr<BalanceRecord, EndRecord> balance_;  // while a balancer watches its array
  ElementState state_;
  std::uint32_t slot_ = 0;          // in the collection's list
  std::uint32_t n_suspended_ = 0;   // coroutines of this element that wait, and handlers that run
  PeId migrate_to_{-1};             // where it goes once nothing of it runs or waits
  bool destroy_requested_ = false;  // destroyed once nothing of it runs or waits
  bool has_run_ = false;            // code of it has run here, besides its constructor
};

/// "Block[3,4]".
[[nodiscard]] std::string element_text(const Element& element);

}  // namespace tess
