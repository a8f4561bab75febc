// The report of one transfer, in lines.
#pragma once

#include "apps/m2m_transfer/report.hpp"

#include <string>

namespace m2m_transfer {

[[nodiscard]] std::string table(const TransferReport& report);
/// The meaning of the numbers in a table.
[[nodiscard]] std::string legend();

}  // namespace m2m_transfer
