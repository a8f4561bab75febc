// Where a program writes the rows of its runs: --json, and --plot for the rows of a study.
#pragma once

#include "apps/plot/chart.hpp"
#include "apps/plot/json.hpp"
#include "runtime/command_line.hpp"

#include <string>

namespace apps {

class RowFiles {
 public:
  void add_options(tess::CommandLine& line);
  /// Throws tess::Error for a file that cannot be written, for two that are one (also `trace`, the
  /// file of --trace), and for a picture without a study.
  void check(bool is_study, const std::string& trace) const;

  /// What is asked for: the rows with the machine that they are from, and the picture.
  void write(const plot::Json& rows, const plot::Chart& chart) const;

 private:
  std::string json_, picture_;
};

}  // namespace apps
