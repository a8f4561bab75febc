// The stability report: stiff and extreme cases of every rule against closed forms and bounds. The
// program prints it (--stability), a test asserts it. It takes about a second.
#pragma once

#include "apps/kit/cases.hpp"

#include <vector>

namespace tess::dn {

[[nodiscard]] std::vector<kit::Case> stability_report();

}  // namespace tess::dn
