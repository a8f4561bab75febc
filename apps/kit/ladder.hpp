// The machines of a study of PEs: simulated ones that differ in their PEs only.
#pragma once

#include "runtime/wire/machine/simulated.hpp"

#include <cstdint>
#include <string>

namespace kit {

/// Describes a machine of so many PEs; `network` is what else --sim would say of it, and one PE has
/// one process. Throws tess::Error (bad_argument) for keys that do not fit, and for a number of PEs
/// among them.
[[nodiscard]] tess::SimulatedOptions machine_of(const std::string& network, std::int32_t n_pes);

}  // namespace kit
