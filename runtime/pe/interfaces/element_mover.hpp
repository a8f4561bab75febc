// What moves elements by force on a simulated machine: it is asked after each message to an element
// that could migrate then. Without one, such moves are drawn at random (RuntimeOptions).
#pragma once

#include "runtime/core/ids.hpp"

#include <cstdint>

namespace tess::detail {

class TessElement;
struct Action;

/// The end of a message on an element.
struct AfterMessage {
  const TessElement& element;
  std::uint64_t key = 0;  ///< the same for an element on whatever PE it is
  PeId pe;                ///< where it is
  const Action* action = nullptr;
};

class ElementMover {
 public:
  ElementMover() = default;
  ElementMover(const ElementMover&) = delete;
  ElementMover& operator=(const ElementMover&) = delete;
  virtual ~ElementMover() = default;

  /// The PE that the element moves to, or `after.pe`.
  virtual PeId move(const AfterMessage& after) = 0;
};

}  // namespace tess::detail
