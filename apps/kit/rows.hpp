// What a program reports: rows of one type, described once as a list of columns. The table, the CSV,
// the JSON and the charts follow from the list.
//
//     constexpr kit::Column<Row> columns[] = {
//         {"order", "order", "5", kit::of<&Row::order>},
//         {"seconds", "seconds", "9.4f", [](const Row& r) -> kit::Json { return r.run.seconds; }}};
//     const kit::Rows<Row> report(columns);
//     tess::print_text(report.head() + report.line(row));        // as the rows come, or
//     tess::print_text(report.table(rows));                      // with widths that fit all rows
//     driver.write(report.json(rows));
#pragma once

#include "apps/kit/output/chart.hpp"
#include "apps/kit/output/json.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kit {

/// A column without its type of row.
struct Heading {
  const char* name;    ///< in JSON and CSV, with its unit; empty: the column is in the table only
  const char* title;   ///< in the table
  const char* format;  ///< in the table: "[<]width[.digits and type]"; null: in files only
};

/// One number or word of a row. Null is "-" in the table and empty in CSV. A last column without a
/// title and with the format "<" holds remarks.
template <class Row>
struct Column {
  const char* name;
  const char* title;
  const char* format;
  Json (*value)(const Row&);
};

namespace detail {
template <class Row, class T>
Row row_of(T Row::*);
}  // namespace detail

/// The value of a column that is a member of the row.
template <auto member>
Json of(const decltype(detail::row_of(member))& row) {
  return row.*member;
}

/// A hash as all programs write it.
[[nodiscard]] std::string hex(std::uint64_t hash);

/// A number with six digits: more are noise of a clock.
[[nodiscard]] Json rounded(double value);

[[nodiscard]] std::string head_line(std::span<const Heading> headings);
[[nodiscard]] std::string table_line(std::span<const Heading> headings, const Json& cells);
/// `cells`: an array of arrays.
[[nodiscard]] std::string table_text(std::span<const Heading> headings, const Json& cells);
[[nodiscard]] std::string csv_text(std::span<const Heading> headings, const Json& cells);
[[nodiscard]] Json json_rows(std::span<const Heading> headings, const Json& cells);

/// Appends a point to the series of this name, which is made where there is none. A null is no
/// point. Returns the point, to add the ends of its error bar; null if there is none.
Point* add_point(Chart& chart, const std::string& series, const Json& x, const Json& y);

template <class Row>
class Rows {
 public:
  using Value = Json (*)(const Row&);

  explicit Rows(std::span<const Column<Row>> columns) { add(columns); }
  template <std::size_t n>
  explicit Rows(const Column<Row> (&columns)[n]) : Rows(std::span<const Column<Row>>(columns)) {}

  /// Appends columns.
  void add(std::span<const Column<Row>> columns) {
    for (const Column<Row>& c : columns) {
      headings_.push_back({c.name, c.title, c.format});
      values_.push_back(c.value);
    }
  }

  /// The line above rows that are printed as they come.
  [[nodiscard]] std::string head() const { return head_line(headings_); }
  [[nodiscard]] std::string line(const Row& row) const { return table_line(headings_, cells(row)); }
  [[nodiscard]] std::string table(std::span<const Row> rows) const {
    return table_text(headings_, cells(rows));
  }
  [[nodiscard]] std::string csv(std::span<const Row> rows) const {
    return csv_text(headings_, cells(rows));
  }
  /// An array with an object per row.
  [[nodiscard]] Json json(std::span<const Row> rows) const {
    return json_rows(headings_, cells(rows));
  }

 private:
  [[nodiscard]] Json cells(const Row& row) const {
    Json out = Json::array();
    for (const Value value : values_) out.push_back(value(row));
    return out;
  }
  [[nodiscard]] Json cells(std::span<const Row> rows) const {
    Json out = Json::array();
    for (const Row& row : rows) out.push_back(cells(row));
    return out;
  }

  std::vector<Heading> headings_;
  std::vector<Value> values_;
};

/// The power p of the best fit y = c x^p over the rows; none where fewer than two of them count.
[[nodiscard]] std::optional<double> fitted_order(const Json& x, const Json& y);
template <class Row>
[[nodiscard]] std::optional<double> fitted_order(std::span<const Row> rows, Json (*x)(const Row&),
                                                 Json (*y)(const Row&)) {
  Json xs = Json::array(), ys = Json::array();
  for (const Row& row : rows) xs.push_back(x(row)), ys.push_back(y(row));
  return fitted_order(xs, ys);
}
/// The power between two points; none where a value is not positive.
[[nodiscard]] std::optional<double> order_between(Point a, Point b);

}  // namespace kit
