#include "apps/m2m_transfer/output/kinds_table.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace m2m_transfer {
namespace {

std::string pair_text(const TransferReport& r) {
  return r.source + " -> " + r.target;
}

}  // namespace

std::string kinds_table(const std::vector<TransferReport>& reports) {
  const TransferReport& first = reports.front();
  std::size_t wide_pair = 4, wide_field = 5;
  for (const TransferReport& r : reports) {
    wide_pair = std::max(wide_pair, pair_text(r).size());
    for (const FieldError& field : r.fields) wide_field = std::max(wide_field, field.name.size());
  }
  std::string out = fmt::format("every kind\n  {:<12} {}\n  {:<12} {} per mesh\n", "machine",
                                first.machine, "chares", first.chares);
  out += fmt::format("  {:<20} {:<{}} {:<{}} {:>8} {:>11} {:>11} {:>11} {:>10} {:>9} {:>9}  {}\n",
                     "kind", "pair", wide_pair, "field", wide_field, "outside", "L2", "relative",
                     "Linf", "integral", "search, s", "apply, s", "result");
  const TransferReport* last = nullptr;
  for (const TransferReport& r : reports) {
    for (std::size_t f = 0; f < r.fields.size(); ++f) {
      const FieldError& field = r.fields[f];
      out += fmt::format(
          "  {:<20} {:<{}} {:<{}} {:>8} {:>11.4e} {:>11.4e} {:>11.4e} {:>10.2e} {:>9.4f} {:>9.4f}  "
          "{:016x}\n",
          f == 0 && (last == nullptr || last->kind != r.kind) ? r.kind : "",
          f == 0 ? pair_text(r) : "", wide_pair, field.name, wide_field, r.tally.counts[3],
          field.norms.l2, field.norms.l2_relative, field.norms.linf,
          field.target_integral - field.source_integral, r.seconds.broad + r.seconds.narrow,
          r.seconds.apply, r.result_hash);
    }
    last = &r;
  }
  return out +
         "  errors over all vertices (--kind KIND has those over the vertices found); "
         "integral: that over the\n  target without that over the source\n";
}

}  // namespace m2m_transfer
