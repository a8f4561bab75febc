// The study of PEs: one transfer on simulated machines of more and more PEs. Each machine has a
// process of its own, which finds no memory that another has freed, cut into small blocks or given
// back. (After six runs on one PE, 256 PEs took seven times as long.)
#pragma once

#include "apps/kit/rows.hpp"
#include "apps/m2m_transfer/input/problem.hpp"
#include "apps/m2m_transfer/output/folder.hpp"
#include "runtime/wire/machine/simulated.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace m2m_transfer {

/// A machine.
struct PesRow {
  std::int32_t pes = 0;
  PhaseSeconds seconds{};
  Tally tally{};
  std::uint64_t result_hash = 0;
  double speed_up = 0, efficiency = 0;  ///< against the machine with the fewest PEs

  /// Set-up, search and one application: the values are at the pieces of the target.
  [[nodiscard]] double together() const { return seconds.setup + seconds.transfer(); }
  [[nodiscard]] bool has_values_of(const PesRow& other) const;
};

[[nodiscard]] const kit::Rows<PesRow>& pes_rows();
[[nodiscard]] Picture picture_of(const std::vector<PesRow>& rows, const std::string& title);

/// The machines of so many PEs, in ascending order; `keys` is what else --sim would say of them.
/// The machine of one PE has one process. Throws Error (bad_argument) for keys that do not fit.
[[nodiscard]] std::vector<SimulatedOptions> machines_of(std::vector<std::int32_t> pes,
                                                        const std::string& keys);

/// Measures one machine in a process of its own, where the fastest of several runs counts. The
/// calling process has no other threads that it needs, and is in no run. Returns the exit code of
/// that process, which prints its errors with `program` in front.
[[nodiscard]] int measure(const char* program, const Request& request,
                          const RuntimeOptions& options, const SimulatedOptions& machine,
                          PesRow& row);

}  // namespace m2m_transfer
