// The stability report: stiff and extreme simulations. Those that can run must agree with all
// pairs, keep their energy, and return to their start when the velocities are reversed; the others
// must be refused with the right reason.
#pragma once

#include "apps/leanmd/simulation.hpp"

#include <string>
#include <vector>

namespace leanmd {

struct StabilityRow {
  std::string name;
  std::string expected;  ///< part of the error; empty: it runs
  std::string note{};    ///< the error of the run
  std::int64_t n_atoms = 0;
  double drift = 0, most_drift = 0;  ///< per atom; the bound of a row that runs
  bool ok = false;
};

/// On PE 0. Takes about a second.
tess::Task stability_report(std::vector<StabilityRow>& rows);

[[nodiscard]] std::string stability_table(const std::vector<StabilityRow>& rows);

}  // namespace leanmd
