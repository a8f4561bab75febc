// A figure that is measured several times, and the CSV row that shows it beside its limit. A row is
// printed only after its result was checked.
#pragma once

#include "runtime/machine/machine.hpp"

#include <optional>
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
  [[nodiscard]] bool empty() const { return values_.empty(); }
  [[nodiscard]] double median() const;
  /// The figure when nothing else runs on the machine.
  [[nodiscard]] double least() const;
  /// (largest − smallest) / median, which is taken without its sign
  [[nodiscard]] double spread() const;

 private:
  std::vector<double> values_;
};

/// Where rows were measured.
struct Origin {
  std::string machine;
  std::int32_t pes = 1;
  std::int32_t ranks = 1;
};

/// One figure as it is shown.
struct Row {
  std::string name;
  double median = 0;
  std::string unit;
  double least = 0;
  double spread = 0;
  double limit = 0;  ///< what the machine allows at best, in the same unit; 0: not known
  std::optional<Origin> origin{};  ///< if it is not that of the other rows
};
[[nodiscard]] Row make_row(std::string_view name, const Samples& samples, std::string_view unit,
                           double limit = 0);

/// "name,median,unit,least,spread,limit,ratio,pes,ranks,machine,preset,commit", a line.
[[nodiscard]] std::string csv_header();
[[nodiscard]] std::string csv_line(const Row& row, const Origin& origin);

/// An object with the list "rows"; each has the columns of the CSV as keys. An absent limit is
/// null.
[[nodiscard]] std::string json_text(const std::vector<Row>& rows, const Origin& origin);

/// Prints rows as they come.
class Report {
 public:
  explicit Report(const std::string& machine) : origin_{machine} {}
  void header() const;
  void row(std::string_view name, const Samples& samples, std::string_view unit,
           double limit = 0) const;

 private:
  Origin origin_;
};

}  // namespace bench
