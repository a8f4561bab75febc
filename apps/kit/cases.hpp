// A stability report: cases at the edge of what a program computes, each judged against what must
// hold there. It prints a line per case as it comes, counts those that fail, and gives the JSON and
// the exit code.
//
//     kit::Cases report;
//     report.add({.name = "cfl 1", .met = error, .tolerance = 1e-9, .ok = error < 1e-9});
//     …
//     return report.finish(driver);
//
// A program that shows more of a case derives its row from Case and gives the columns for it.
#pragma once

#include "apps/kit/rows.hpp"
#include "runtime/run.hpp"

#include <optional>
#include <string>
#include <vector>

namespace kit {

class Driver;

struct Case {
  std::string name;
  std::string parameter{};            ///< the quantity that is varied, as "k dt²/m"; may be empty
  std::optional<double> value{};      ///< of the parameter
  std::optional<double> met{};        ///< error or excess, relative where a scale exists
  std::optional<double> tolerance{};  ///< of `met`
  bool ok = false;
  std::string note{};  ///< what was expected, or why it was refused
};

/// What each of the standard columns shows of a case.
[[nodiscard]] Json value_of_case(const Case& one);
[[nodiscard]] Json verdict(const Case& one);
/// Prints the last lines, "N cases, M failed" below `remark`, writes the file of --json; returns
/// the exit code.
int finish_cases(const Driver& driver, const Json& results, std::size_t n_failed,
                 const std::string& remark);

template <class Row = Case>
class Cases {
 public:
  /// `more`: columns between the parameter and the verdict.
  explicit Cases(std::span<const Column<Row>> more = {}) : columns_(first) {
    columns_.add(more);
    columns_.add(last);
  }

  void add(Row row) {
    if (rows_.empty()) tess::print_text(columns_.head());
    tess::print_text(columns_.line(row));
    rows_.push_back(std::move(row));
  }
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  [[nodiscard]] std::size_t n_failed() const {
    std::size_t n = 0;
    for (const Row& row : rows_) n += row.ok ? 0U : 1U;
    return n;
  }
  [[nodiscard]] int finish(const Driver& driver, const std::string& remark = "") const {
    return finish_cases(driver, columns_.json(std::span<const Row>(rows_)), n_failed(), remark);
  }

 private:
  static constexpr Column<Row> first[] = {
      {"case", "case", "<46", [](const Row& r) -> Json { return r.name; }},
      {"parameter", "", "<9", [](const Row& r) -> Json { return r.parameter; }},
      {"value", "value", "9.4g", [](const Row& r) { return value_of_case(r); }},
  };
  static constexpr Column<Row> last[] = {
      {"met", "met", "9.2e", [](const Row& r) -> Json { return r.met; }},
      {"tolerance", "tolerance", "9.2e", [](const Row& r) -> Json { return r.tolerance; }},
      {"ok", "", nullptr, [](const Row& r) -> Json { return r.ok; }},
      {"note", "", nullptr, [](const Row& r) -> Json { return r.note; }},
      {"", "", "<", [](const Row& r) { return verdict(r); }},
  };

  Rows<Row> columns_;
  std::vector<Row> rows_;
};

}  // namespace kit
