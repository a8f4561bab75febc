// The rows of bench_collide: printed as they come, if they are wanted, and kept for JSON.
#pragma once

#include "apps/bench/report.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace bench {

struct CollideOptions {
  std::int32_t repeat = 5;
  bool quick = false;
  bool growth = false;
  std::vector<std::string> names;  ///< of cases or rows; empty: all
};

class Output {
 public:
  Output(const CollideOptions& options, std::string machine)
      : options_(options), report_({std::move(machine)}) {}

  [[nodiscard]] const CollideOptions& options() const { return options_; }
  /// True if a row is asked for by its name or its case's.
  [[nodiscard]] bool wants(std::string_view of, std::string_view row) const;
  /// True if the case, or a row that begins with its name, is asked for.
  [[nodiscard]] bool wants_any(std::string_view of) const;

  void row(std::string_view of, const std::string& name, const Samples& samples,
           std::string_view unit, double limit = 0, std::optional<Origin> origin = {});
  /// A row of one value.
  void row(std::string_view of, const std::string& name, double value, std::string_view unit);
  [[nodiscard]] const Report& report() const { return report_; }

 private:
  const CollideOptions& options_;
  Report report_;
};

}  // namespace bench
