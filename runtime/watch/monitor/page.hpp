// The page of the monitor: page.html, which the build puts into the program.
#pragma once

#include <string>

namespace tess::detail {

[[nodiscard]] std::string monitor_page();

}  // namespace tess::detail
