// What a benchmark prints: one CSV row a figure, beside what Charm++ reaches on this kind of
// machine. A row is printed only after its result was checked.
#pragma once

#include "runtime/machine/machine.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace bench {

/// Time on the PE it is made on; virtual on the simulated machine.
class Stopwatch {
 public:
  Stopwatch();
  [[nodiscard]] double nanoseconds() const;

 private:
  tess::Time begin_;
};

/// A figure measured several times.
class Samples {
 public:
  void add(double value) { values_.push_back(value); }
  [[nodiscard]] double median() const;
  /// What it takes when nothing else runs on the machine.
  [[nodiscard]] double least() const;
  /// (largest − smallest) / median
  [[nodiscard]] double spread() const;

 private:
  std::vector<double> values_;
};

class Report {
 public:
  explicit Report(const std::string& machine);
  void header() const;
  /// `reference` 0: there is none.
  void row(std::string_view name,
           const Samples& samples,
           std::string_view unit,
           double reference = 0) const;

 private:
  std::string machine_;
};

}  // namespace bench
