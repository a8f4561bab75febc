// Energy drift against time step: the same stretch of time in steps of different length.
#pragma once

#include "apps/kit/rows.hpp"
#include "apps/leanmd/simulation.hpp"

#include <optional>
#include <string>
#include <vector>

namespace leanmd {

struct StudyRow {
  double dt = 0;
  std::int32_t n_steps = 0;
  double drift = 0;  ///< greatest change of the total energy per atom
  double seconds = 0;
  std::optional<double> order{};  ///< from the row before: 2 for velocity Verlet
  std::string error{};            ///< an unstable row has no drift
  bool is_wrong = false;          ///< the error is a wrong result
};

/// Runs steps of 2, 1, 1/2, 1/4, 1/8 times dt.
tess::Task study(Options options, InitialState state, std::vector<StudyRow>& rows);

[[nodiscard]] const kit::Rows<StudyRow>& study_rows();
/// The order of the drift over all rows, by least squares of the logarithms; none without two rows.
[[nodiscard]] std::optional<double> fitted_order(const std::vector<StudyRow>& rows);
/// Drift against run time, beside a line of order 2.
[[nodiscard]] kit::Chart study_chart(const std::vector<StudyRow>& rows);

}  // namespace leanmd
