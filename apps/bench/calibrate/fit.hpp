// The parameters of a simulated machine that takes as long as a measured one, and the file of them
// that --sim reads.
//
// The same program is measured and simulated (wire_times.hpp), and what the simulation lacks is the
// parameter. So no cost is counted twice: the simulation runs the runtime's own code.
//
//     overhead    from a message sent and one received by busy PEs, half of it each
//     latency     from a ball that goes to and fro
//     copy        from the same exchange with vectors of packed_bytes, between processes
//     bandwidth   from a ball of large_bytes, between processes
#pragma once

#include "apps/bench/calibrate/wire_times.hpp"
#include "runtime/wire/machine/simulated_options.hpp"

#include <functional>
#include <string>

namespace bench {

/// A run on a simulated machine of two PEs with these parameters.
using SimulateWire = std::function<WireTimes(const tess::Wire&)>;

/// The parameters, and what a simulation with them gives.
struct FittedWire {
  tess::Wire wire;
  WireTimes simulated;
};

/// The parameters that make the simulation as slow as `measured`; a parameter is 0 (the bandwidth
/// 1 TB/s) if the simulation is slower without it.
[[nodiscard]] FittedWire fit_wire(const WireTimes& measured, const SimulateWire& simulate);

/// What a wire joins.
enum class Joins : std::uint8_t { pes, processes };

/// The text of a file with the parameters, and the lines of `before` about the other wire. `note`
/// says where they were measured.
[[nodiscard]] std::string wire_file(Joins joins, const tess::Wire& wire, const std::string& note,
                                    const std::string& before);

}  // namespace bench
