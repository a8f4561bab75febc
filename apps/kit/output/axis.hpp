// An axis of a chart: its range, and where it is labelled with which text.
//
//     linear         0  500  1 000  1 500        a multiple of 1, 2 or 5 times a power of ten
//     logarithmic    0.01  0.1  1  10  100  10⁶  1, 2 and 5 if it is short
//     PEs, counts    1  2  4  8  16              the values themselves, if they are few whole ones
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace kit {

struct Axis {
  double low = 0, high = 1;
  bool log = false;
  std::vector<std::pair<double, std::string>> ticks{};

  /// The place of a value, 0 to 1 between the ends.
  [[nodiscard]] double part(double value) const;
};

/// An axis for these values, positive ones if it is logarithmic. Labelled at `ticks` if given.
/// `from_zero`: a linear axis ends at labels, at 0 if its least value is less than half of the
/// greatest; otherwise with the values.
[[nodiscard]] Axis axis_of(std::vector<double> values, bool log, std::vector<double> ticks,
                           bool from_zero);

/// A number as a reader writes it: 1 024, 0.05, 10⁶, 2·10⁻⁵.
[[nodiscard]] std::string number_text(double value);

}  // namespace kit
