// The stability report: stiff and extreme cases of every rule, against closed forms and bounds. A
// program prints it (--stability), a test asserts it. About a second.
#pragma once

#include <string>
#include <vector>

namespace tess::dn {

struct StabilityRow {
  std::string name;       ///< of the case
  std::string parameter;  ///< what is varied, as "k dt²/m"
  double value = 0;       ///< of the parameter
  double met = 0;         ///< the error or excess that came out, relative where a scale exists
  double tolerance = 0;
  bool ok = false;  ///< met <= tolerance
};

[[nodiscard]] std::vector<StabilityRow> stability_report();

}  // namespace tess::dn
