#include "runtime/watch/monitor/heat_map.hpp"

#include "runtime/core/escape.hpp"
#include "runtime/watch/monitor/level.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <fmt/format.h>
#include <utility>

namespace tess::detail {
namespace {

constexpr double fades = 0.93;             // in a period: half of it is gone after ten
constexpr std::uint64_t most_missed = 20;  // periods for which a late report counts

}  // namespace

HeatMap::HeatMap(HeatBy by, std::int32_t n_pes)
    : by_(by),
      reported_in_(static_cast<std::size_t>(n_pes)),
      held_(by == HeatBy::pe ? static_cast<std::size_t>(n_pes) : 0) {}

void HeatMap::take(HeatCells&& part) {
  if (!grid_) {
    grid_.emplace(part.range);
    if (by_ == HeatBy::load) load_.resize(grid_->n_cells());
  }
  changed_ = true;
  const auto pe = static_cast<std::size_t>(part.pe.value);
  if (by_ == HeatBy::pe) {
    held_.at(pe).clear();
    for (std::size_t i = 0; i < part.cells.size(); ++i)
      held_[pe].push_back({part.cells[i], static_cast<std::uint32_t>(part.values[i])});
    return;
  }
  // A report speaks for all periods since the last one: a PE in a long entry method gives none.
  std::uint64_t& last = reported_in_.at(pe);
  const std::uint64_t n = std::clamp<std::uint64_t>(n_periods_ + 1 - last, 1, most_missed);
  last = n_periods_ + 1;
  for (std::size_t i = 0; i < part.cells.size(); ++i)
    load_.at(part.cells[i]) += static_cast<double>(n) * static_cast<double>(part.values[i]);
}

std::optional<std::string> HeatMap::take_event(const std::string& name) {
  ++n_periods_;
  weight_ = weight_ * fades + 1;
  if (!grid_) return std::nullopt;
  std::optional<std::string> event;
  if (std::exchange(changed_, false))
    event = last_event_ = by_ == HeatBy::load ? event_by_load(name) : event_by_pe(name);
  for (double& load : load_) load *= fades;
  return event;
}

std::string HeatMap::head(const std::string& name, const std::string& summary) const {
  return fmt::format(R"({{"name":{},"by":"{}","shape":[{}],"summary":{},)", json_string(name),
                     by_ == HeatBy::load ? "load" : "pe", fmt::join(grid_->shape(), ","),
                     json_string(summary));
}

std::string HeatMap::event_by_load(const std::string& name) const {
  // Per index, so that cells at the border, which hold fewer, compare.
  std::vector<double> load(load_.size());
  double most = 0, sum = 0;
  std::size_t hottest = 0, n_cold = 0;
  for (std::size_t cell = 0; cell < load.size(); ++cell) {
    const std::uint64_t n_indices = grid_->n_indices(static_cast<std::uint32_t>(cell));
    load[cell] = load_[cell] / weight_ / static_cast<double>(n_indices);
    sum += load[cell];
    if (load[cell] == 0) ++n_cold;
    if (load[cell] <= most) continue;
    most = load[cell];
    hottest = cell;
  }
  std::string values;
  values.reserve(2 * load.size());
  for (const double one : load) add_level(values, most > 0 ? std::lround(255 * one / most) : 0);
  const std::string summary =
      most == 0 ? "no load was seen yet"
                : fmt::format(
                      "hottest {}: {:.3g} % of a PE for each element, {:.3g} x the mean of "
                      "{} cells; {} without load",
                      grid_->text_of(static_cast<std::uint32_t>(hottest)), 100 * most,
                      most * static_cast<double>(load.size()) / sum, load.size(), n_cold);
  return head(name, summary) + fmt::format(R"("most":{:.4g},"values":"{}"}})", most, values);
}

std::string HeatMap::event_by_pe(const std::string& name) const {
  struct Most {
    std::uint32_t n = 0;
    std::int32_t pe = -1;
  };
  std::vector<Most> most(grid_->n_cells());
  std::uint64_t n_elements = 0;
  std::uint64_t greatest = 0;
  std::size_t n_holders = 0, fullest = 0;
  for (std::size_t pe = 0; pe < held_.size(); ++pe) {
    std::uint64_t n_here = 0;
    for (const Held& held : held_[pe]) {
      n_here += held.n;
      Most& of = most.at(held.cell);
      if (held.n > of.n) of = {held.n, static_cast<std::int32_t>(pe)};
    }
    n_elements += n_here;
    if (n_here != 0) ++n_holders;
    if (n_here <= greatest) continue;
    greatest = n_here;
    fullest = pe;
  }
  std::vector<std::int32_t> pes;
  pes.reserve(most.size());
  for (const Most& one : most) pes.push_back(one.pe);
  const std::string summary =
      n_elements == 0 ? "no element was seen yet"
                      : fmt::format("{} elements on {} of {} PEs, at most {} on PE {}", n_elements,
                                    n_holders, held_.size(), greatest, fullest);
  return head(name, summary) +
         fmt::format(R"("pes":{},"values":[{}]}})", held_.size(), fmt::join(pes, ","));
}

}  // namespace tess::detail
