// The runtime's part of a chare: its collection, its incarnation and version, the broadcasts it has
// received, and its next reduction. The user's class derives from it through Chare or Group.
//
// In a class the names of its base classes are visible before the names around it. So the classes
// between a chare and this one have names that no program has: a chare may use its program's own
// type Element. The runtime calls this one Element too.
#pragma once

#include "runtime/arrays/location/version.hpp"
#include "runtime/core/ids.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace tess {

template <class, class>
class Chare;
template <class>
class Group;

}  // namespace tess

namespace tess::detail {

class BalancedElements;
class Collection;
class Sections;
struct BalanceRecord;
struct LoadRecord;

/// Frees a record, which the meter of this PE forgets; not inline, since most elements have none.
struct EndRecord {
  void operator()(BalanceRecord* record) const;
};

/// In place of ElementState::created_after, while the element's destructor runs.
inline constexpr std::uint32_t destroyed_now = ~std::uint32_t{0};

/// In place of ElementState::inserted_in, for an element that is not new.
inline constexpr EpochId not_new{~std::uint64_t{0}};

/// The part of an element that migrates in addition to the user's members.
struct ElementState {
  Version version{};
  std::uint32_t next_reduction = 0;
  std::uint32_t created_after = 0;  // last broadcast before; 0 once it contributed
  std::uint64_t seen_broadcast = 0;
  EpochId inserted_in = not_new;  // until it contributes: the epoch of its insertion
  std::uint64_t ahead = 0;  // bit j: it has contributed to next_reduction + j; bit 0 is not set
};

class TessElement {
 public:
  TessElement(const TessElement&) = delete;
  TessElement& operator=(const TessElement&) = delete;

 protected:
  TessElement() = default;
  ~TessElement() = default;

  /// Runs `call` once the element under construction is known to its collection. `what` names the
  /// function that needs this.
  static void after_construction(const char* what, std::function<void()> call);

 private:
  friend class BalancedElements;
  friend class Collection;
  friend class Sections;
  template <class>
  friend class ArrayOf;
  template <class>
  friend class Array;
  template <class>
  friend class TessIndexedElement;
  friend class ElementScope;
  template <class, class>
  friend class tess::Chare;
  template <class>
  friend class tess::Group;
  template <class>
  friend class TessContributor;
  friend struct TaskAccount;
  friend std::string element_text(const TessElement& element);

  /// True if none of its code runs or waits, so that code of others calls it as an object
  /// (ArrayProxy::local).
  [[nodiscard]] bool is_called_directly() const {
    return collection_ != nullptr && n_suspended_ == 0;
  }

  Collection* collection_ = nullptr;
  std::unique_ptr<BalanceRecord, EndRecord> balance_;  // if its load is measured
  ElementState state_;
  std::uint32_t slot_ = 0;              // slot in the collection's list
  std::uint32_t n_suspended_ = 0;       // waiting coroutines, running handlers, and n_held_
  PeId migrate_to_{-1};                 // the PE to move to once none of its code runs or waits
  bool has_run_ = false;                // code other than its constructor has run here
  bool destroy_requested_ : 1 = false;  // to be destroyed once none of its code runs or waits
  bool in_sections_ : 1 = false;        // it is a member of sections, which are listed in Sections
  std::uint16_t n_held_ = 0;  // reasons of the runtime for which it stays (Collection::hold)
};

using Element = TessElement;

/// "Block[3,4]".
[[nodiscard]] std::string element_text(const Element& element);
/// Its reply_key().
[[nodiscard]] std::string element_key(const Element& element);
/// The result of its describe_state(), if it has one.
[[nodiscard]] std::string element_state(const Element& element);
/// Its measured load; null if it is not measured.
[[nodiscard]] LoadRecord* element_load(Element& element);

}  // namespace tess::detail
