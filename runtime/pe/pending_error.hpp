// The exception that ends the run of this PE's message, with the place where it was thrown. The
// place is recorded on the way out of the user's code, by the innermost code that knows it.
#pragma once

#include <exception>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace tess::detail {

class Pe;

class PendingError {
 public:
  explicit PendingError(Pe& pe) : pe_(pe) {}

  /// Keeps an exception that no user code may catch: of a coroutine after it has waited, or of a
  /// message that cannot be packed, whose epoch would wait for ever. It is rethrown at the end of
  /// the message that runs.
  void keep(std::exception_ptr error);
  /// An exception leaves the code of an element: records the place for the report.
  void note_place();
  /// It leaves code of no element: `instead` says what ran.
  void note_place(std::string_view instead);
  /// An exception leaves a constructor of a class: records it, with the types of its arguments, for
  /// the report.
  void note_constructor(std::string_view of, std::initializer_list<std::string_view> types);
  /// The exception was caught.
  void forget_place() { place_.clear(); }

  // The PE calls these.

  void rethrow() {
    if (kept_) [[unlikely]]
      std::rethrow_exception(std::exchange(kept_, nullptr));
  }
  /// An exception is reported: nothing is kept. Returns its place, which may be empty.
  [[nodiscard]] std::string take() {
    kept_ = nullptr;
    return std::exchange(place_, {});
  }

 private:
  Pe& pe_;
  std::exception_ptr kept_;
  std::string place_;
};

}  // namespace tess::detail
