// The load of an element: the time that it computed in a phase. It is known if a whole phase of the
// element was measured. A strategy that took an unknown load for 0 would treat a busy element as
// idle, so a Load is no number: it must be asked.
//
//     load.is_known()         an element of unknown load stays, whatever a strategy returns
//     load.seconds()          throws Error if the load is unknown
//     load.seconds_or(mean)   for a strategy that estimates unknown loads
#pragma once

namespace tess::balance {

/// Seconds on a PE of speed 1, or unknown. It is as small as a double.
class Load {
 public:
  /// The load is unknown.
  Load() = default;
  /// The load is known. Throws Error if it is below 0, or not a number.
  Load(double seconds) : seconds_(seconds) {  // NOLINT(google-explicit-constructor)
    if (!is_known()) [[unlikely]]
      refuse(seconds);
  }
  [[nodiscard]] static Load unknown() { return {}; }

  [[nodiscard]] bool is_known() const { return seconds_ >= 0; }
  [[nodiscard]] double seconds() const {
    if (!is_known()) [[unlikely]]
      refuse_unknown();
    return seconds_;
  }
  [[nodiscard]] double seconds_or(double assumed) const { return is_known() ? seconds_ : assumed; }

  friend bool operator==(Load, Load) = default;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(seconds_);
  }

 private:
  [[noreturn]] static void refuse(double seconds);
  [[noreturn]] static void refuse_unknown();

  double seconds_ = -1;  // below 0: unknown
};

}  // namespace tess::balance
