// A heat map on process 0: it collects the cells that PEs report, and makes the event for browsers.
// The load of a cell is the mean of what the PEs reported lately, where new reports count most. Not
// for several threads at once.
#pragma once

#include "runtime/watch/monitor/heat_cells.hpp"
#include "runtime/watch/monitor/heat_grid.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tess::detail {

class HeatMap {
 public:
  HeatMap(HeatBy by, std::int32_t n_pes);

  void take(HeatCells&& part);
  /// A period is over. The event as a line of JSON; nothing if it would not differ from the last
  /// one. `name`: of the array.
  [[nodiscard]] std::optional<std::string> take_event(const std::string& name);
  /// The last event; empty before the first one.
  [[nodiscard]] const std::string& last_event() const { return last_event_; }

 private:
  struct Held {  // elements of a PE in a cell
    std::uint32_t cell = 0, n = 0;
  };
  [[nodiscard]] std::string event_by_load(const std::string& name) const;
  [[nodiscard]] std::string event_by_pe(const std::string& name) const;
  [[nodiscard]] std::string head(const std::string& name, const std::string& summary) const;

  const HeatBy by_;
  std::optional<HeatGrid> grid_;
  bool changed_ = false;
  std::uint64_t n_periods_ = 0;
  // Load: sums over periods in which old ones fade; of each PE the last period in which it
  // reported.
  std::vector<double> load_;  // by cell
  double weight_ = 0;
  std::vector<std::uint64_t> reported_in_;
  std::vector<std::vector<Held>> held_;  // by PE
  std::string last_event_;
};

}  // namespace tess::detail
