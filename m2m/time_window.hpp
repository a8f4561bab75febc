// Values of a target piece at the last times of a coupling, and at any time between them. So the two
// codes of a coupling may have time steps of their own:
//
// Sample: tests/m2m/time_window_test.cpp
//
//     class Shell : public tess::Chare<Shell, tess::Index1>, public tess::m2m::Piece<Shell> {
//      public:
//       tess::m2m::TimeWindow load;  // apply() takes the values of the new sample
//       void accept(double time) { load.accept(time); }
//       void step(double time) { advance(time, load.at(time)); }
//       // …
//     for (int half = 1; half <= 2; ++half) {  // the source makes two steps, the target five
//       const double time = h * (step + 0.5 * half);
//       co_await tess::epoch([&] { flow.broadcast<&Flow::step>(time); });
//       // …
//       co_await to_shell.apply<&Flow::pressure, &Shell::load>(
//           [&](tess::m2m::CouplingId) { shell.broadcast<&Shell::accept>(time); });
//     }
//     // …
//     co_await tess::epoch([&] {
//       for (int fifth = 1; fifth <= 5; ++fifth)
//         shell.broadcast<&Shell::step>(h * (step + 0.2 * fifth));
//     });
//
// A piece may as well call accept() in received(). Each of several fields has a window of its own.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tess::m2m {

/// How values follow from samples, and the order of the error in the time between two of these.
enum class TimeMethod : unsigned char {
  linear,   ///< between the two samples around the time: order 2
  cubic,    ///< through the four around it: order 4; through fewer if there are not so many
  hermite,  ///< from the values and rates of the two around it: order 4
};

class TimeWindow {
 public:
  TimeWindow() = default;
  /// `n_values`: points × components. Keeps the last `n_samples`, two or more: as many as a step of
  /// the target reaches back, and four for cubic.
  explicit TimeWindow(std::size_t n_values, TimeMethod method = TimeMethod::linear,
                      std::size_t n_samples = 4);

  // The new sample, for Take of apply(). It begins with the values of the one before.
  [[nodiscard]] std::span<double> values() { return next_.values; }
  [[nodiscard]] auto begin() { return next_.values.begin(); }
  [[nodiscard]] auto end() { return next_.values.end(); }
  /// Its derivatives in time; empty unless the method is hermite.
  [[nodiscard]] std::span<double> rates() { return next_.rates; }

  /// Adds the new sample, as the values at `time`, and drops the oldest one if there are more than
  /// are kept. Replaces a sample of the same time, for codes that repeat a step. Throws Error
  /// (bad_argument) for a time before the last sample's.
  void accept(double time);

  [[nodiscard]] std::size_t n_samples() const { return samples_.size(); }
  /// The times of the oldest and of the last sample, of which there is one.
  [[nodiscard]] double first() const { return samples_.front().time; }
  [[nodiscard]] double last() const { return samples_.back().time; }
  /// The values at a time from first() to last(), up to rounding; at the times of samples their
  /// bits. Throws Error (out_of_range) with the time and the range.
  [[nodiscard]] std::vector<double> at(double time) const;
  void at(double time, std::span<double> to) const;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(method_, n_kept_, next_, samples_);
  }

 private:
  struct Sample {
    double time = 0;
    std::vector<double> values{}, rates{};
    template <class Ar>
    void serialize(Ar& ar) {
      ar(time, values, rates);
    }
  };

  TimeMethod method_ = TimeMethod::linear;
  std::size_t n_kept_ = 4;
  Sample next_;
  std::vector<Sample> samples_;  // by time
};

}  // namespace tess::m2m
