#include "apps/bench/report.hpp"

#include "apps/kit/median.hpp"
#include "apps/kit/version.hpp"
#include "runtime/core/escape.hpp"
#include "runtime/here.hpp"
#include "runtime/run.hpp"
#include "runtime/scheduler/pe.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

namespace bench {
namespace {

/// Four digits, without an exponent where the number is large.
std::string shown(double value) {
  return std::abs(value) < 1000 ? fmt::format("{:.4g}", value) : fmt::format("{:.0f}", value);
}

}  // namespace

Stopwatch::Stopwatch() : begin_(tess::now()) {}
double Stopwatch::nanoseconds() const {
  return std::chrono::duration<double, std::nano>(tess::now() - begin_).count();
}

double Samples::median() const {
  return kit::median(values_);
}
double Samples::least() const {
  return *std::min_element(values_.begin(), values_.end());
}
double Samples::spread() const {
  const auto [least, greatest] = std::minmax_element(values_.begin(), values_.end());
  return median() == 0 ? 0 : (*greatest - *least) / std::abs(median());
}

Row make_row(std::string_view name, const Samples& samples, std::string_view unit, double limit) {
  return {.name = std::string(name),
          .median = samples.median(),
          .unit = std::string(unit),
          .least = samples.least(),
          .spread = samples.spread(),
          .limit = limit};
}

std::string csv_header() {
  return "name,median,unit,least,spread,limit,ratio,pes,ranks,machine,preset,commit\n";
}

std::string csv_line(const Row& row, const Origin& common) {
  const Origin origin = row.origin.value_or(common);
  const std::string limit =
      row.limit == 0 ? "," : fmt::format("{},{:.3f}", shown(row.limit), row.median / row.limit);
  return fmt::format("{},{},{},{},{:.2f},{},{},{},\"{}\",{},{}\n", row.name, shown(row.median),
                     row.unit, shown(row.least), row.spread, limit, origin.pes, origin.ranks,
                     origin.machine, kit::build_preset(), kit::build_commit());
}

std::string json_text(const std::vector<Row>& rows, const Origin& common) {
  std::string out = "{\"rows\": [";
  for (const Row& row : rows) {
    const Origin origin = row.origin.value_or(common);
    const std::string limit = row.limit == 0 ? "\"limit\": null, \"ratio\": null"
                                             : fmt::format("\"limit\": {:.6g}, \"ratio\": {:.4f}",
                                                           row.limit, row.median / row.limit);
    out += fmt::format(
        "{}\n  {{\"name\": {}, \"median\": {:.6g}, \"unit\": {}, \"least\": {:.6g}, "
        "\"spread\": {:.4f}, {}, \"pes\": {}, \"ranks\": {}, \"machine\": {}, \"preset\": {}, "
        "\"commit\": {}}}",
        &row == rows.data() ? "" : ",", tess::json_string(row.name), row.median,
        tess::json_string(row.unit), row.least, row.spread, limit, origin.pes, origin.ranks,
        tess::json_string(origin.machine), tess::json_string(kit::build_preset()),
        tess::json_string(kit::build_commit()));
  }
  return out + "\n]}\n";
}

void Report::header() const {
  tess::print(csv_header());
}
void Report::row(std::string_view name, const Samples& samples, std::string_view unit,
                 double limit) const {
  tess::print(csv_line(make_row(name, samples, unit, limit), origin_));
}

}  // namespace bench
