// The stability report: stiff and extreme cases of every rule against closed forms and bounds. The
// program prints it (--stability), a test asserts it. It takes about a second.
#pragma once

#include <string>
#include <vector>

namespace tess::dn {

struct StabilityRow {
  std::string name;
  std::string parameter;  ///< the quantity that is varied, as "k dt²/m"
  double value = 0;       ///< of the parameter
  double met = 0;         ///< error or excess, relative where a scale exists
  double tolerance = 0;
  bool ok = false;  ///< met <= tolerance
};

[[nodiscard]] std::vector<StabilityRow> stability_report();

/// A line for each row, and how many failed.
[[nodiscard]] std::string text_of(const std::vector<StabilityRow>& rows);

}  // namespace tess::dn
