#include "apps/bench/report.hpp"

#include "apps/kit/median.hpp"
#include "apps/kit/rows.hpp"
#include "runtime/here.hpp"
#include "runtime/pe/pe.hpp"
#include "runtime/run.hpp"
#include "runtime/version.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

namespace bench {
namespace {

using R = const Row&;
using kit::Json, kit::rounded;

std::optional<double> ratio(R row) {
  return row.limit ? std::optional(row.samples.median() / *row.limit) : std::nullopt;
}
/// Four digits, without an exponent where the number is large.
std::string shown(double value) {
  return std::abs(value) < 1000 ? fmt::format("{:.4g}", value) : fmt::format("{:.0f}", value);
}

std::string csv_line(R row) {
  const std::string limit =
      row.limit ? fmt::format("{},{:.3f}", shown(*row.limit), *ratio(row)) : ",";
  return fmt::format("{},{},{},{},{:.2f},{},{},{},\"{}\",{},{}\n", row.name,
                     shown(row.samples.median()), row.unit, shown(row.samples.least()),
                     row.samples.spread(), limit, row.origin.pes, row.origin.ranks,
                     row.origin.machine, tess::build().preset, tess::build().commit);
}

constexpr kit::Column<Row> columns[] = {
    {"name", "", nullptr, kit::of<&Row::name>},
    {"median", "", nullptr, [](R r) { return rounded(r.samples.median()); }},
    {"unit", "", nullptr, kit::of<&Row::unit>},
    {"least", "", nullptr, [](R r) { return rounded(r.samples.least()); }},
    {"spread", "", nullptr, [](R r) { return rounded(r.samples.spread()); }},
    {"limit", "", nullptr, [](R r) { return r.limit ? rounded(*r.limit) : Json(); }},
    {"ratio", "", nullptr, [](R r) { return r.limit ? rounded(*ratio(r)) : Json(); }},
    {"pes", "", nullptr, [](R r) -> Json { return r.origin.pes; }},
    {"ranks", "", nullptr, [](R r) -> Json { return r.origin.ranks; }},
    {"machine", "", nullptr, [](R r) -> Json { return r.origin.machine; }},
    {"preset", "", nullptr, [](R) -> Json { return tess::build().preset; }}};

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

void Report::header() const {
  tess::print("name,median,unit,least,spread,limit,ratio,pes,ranks,machine,preset,commit\n");
}
void Report::row(std::string_view name, const Samples& samples, std::string_view unit, double limit,
                 std::optional<Origin> origin) {
  rows_.push_back({std::string(name), samples, std::string(unit),
                   limit == 0 ? std::nullopt : std::optional(limit), origin.value_or(origin_)});
  tess::print(csv_line(rows_.back()));
}
kit::Json Report::json() const {
  return kit::Rows<Row>(columns).json(rows_);
}

}  // namespace bench
