#include "apps/kit/ladder.hpp"

#include "runtime/core/error.hpp"

#include <fmt/format.h>

namespace kit {

tess::SimulatedOptions machine_of(const std::string& network, std::int32_t n_pes) {
  if (network.starts_with("pes=") || network.find(",pes=") != std::string::npos)
    tess::fail(tess::ErrorCode::bad_argument, "--network ", network,
               " names a number of PEs; give them with --machines 1,4,16");
  return tess::parse_simulated(fmt::format("{}{}pes={}{}", network, network.empty() ? "" : ",",
                                           n_pes, n_pes == 1 ? ",per-process=1" : ""));
}

}  // namespace kit
