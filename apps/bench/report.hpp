// A figure that is measured several times, and the CSV row that shows it beside its limit. A row is
// printed only after its result was checked.
#pragma once

#include "runtime/wire/machine/machine.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kit {
class Json;
}

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
  Samples samples;
  std::string unit;
  std::optional<double> limit;  ///< what the machine allows at best, in the same unit
  Origin origin;
};

/// Prints rows as they come, and keeps them for JSON.
class Report {
 public:
  explicit Report(Origin origin) : origin_(std::move(origin)) {}
  [[nodiscard]] const Origin& origin() const { return origin_; }

  /// "name,median,unit,least,spread,limit,ratio,pes,ranks,machine,preset,commit", a line.
  void header() const;
  /// `limit` 0: not known. `origin`: if it is not that of the other rows.
  void row(std::string_view name, const Samples& samples, std::string_view unit, double limit = 0,
           std::optional<Origin> origin = {});
  /// An array with an object per row. An absent limit is null.
  [[nodiscard]] kit::Json json() const;

 private:
  Origin origin_;
  std::vector<Row> rows_;
};

}  // namespace bench
