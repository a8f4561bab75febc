// The report of a transfer, as a table and as JSON.
#pragma once

#include "apps/kit/json.hpp"
#include "apps/m2m_transfer/report.hpp"

#include <string>
#include <vector>

namespace m2m_transfer {

[[nodiscard]] std::string table(const TransferReport& report);
/// The meaning of the numbers in a table.
[[nodiscard]] std::string legend();
/// {"definitions": {…}, "pairs": [{…}]}
[[nodiscard]] kit::Json json_of(const std::vector<TransferReport>& reports);
[[nodiscard]] std::string json(const std::vector<TransferReport>& reports);

}  // namespace m2m_transfer
