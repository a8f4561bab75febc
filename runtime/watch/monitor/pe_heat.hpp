// What a PE measures while a browser watches: the time of its entry methods, and its part in heat
// maps. Its cost is bounded, whatever the size of the array.
//
// Entry methods and load: the monitor opens a window of a few milliseconds in each period, in which the meter of the
// PE shows each scope to this listener. The window ends by a message that the monitor posts. If
// nothing has run by then, or the message follows the first one too soon, it stays open for the
// period, so that entry methods that take longer than a window are seen, too. So it does always in
// virtual time. It also ends after a number of scopes.
//
//     period k   begin ──────── few ms ──── end_window: (cell, part of the time) …     period k + 1
//
// PE: in each period it counts a part of its elements by cell. A pass over all of them is reported
// if it differs from the one before.
#pragma once

#include "runtime/pe/interfaces/scope_listener.hpp"
#include "runtime/pe/pe.hpp"
#include "runtime/watch/monitor/heat_cells.hpp"
#include "runtime/watch/monitor/heat_grid.hpp"
#include "runtime/watch/monitor/sample.hpp"

#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

namespace tess::detail {

class PeHeat final : public ScopeListener {
 public:
  explicit PeHeat(Pe& pe) : pe_(pe) {}
  PeHeat(const PeHeat&) = delete;
  PeHeat& operator=(const PeHeat&) = delete;
  /// The PE runs no more code.
  ~PeHeat() override { stop_metering(); }

  // On the PE's thread.

  /// A period begins, in which these maps are watched, and the entry methods if `entries_too`.
  /// Returns what is known of the last one.
  [[nodiscard]] std::vector<HeatCells> begin(const std::vector<HeatQuery>& queries,
                                             bool entries_too);
  /// Puts the entry methods that ran in the last window into a sample, unless they have been taken.
  void give_entries(PeSample& sample);
  /// The window is over: returns what it measured, unless it stays open.
  [[nodiscard]] std::vector<HeatCells> end_window();

  /// True while it measures load.
  [[nodiscard]] bool window_is_open() const { return open_; }

  void changed(std::uint64_t at) override;

 private:
  struct Map {
    explicit Map(const Range& of) : range(of), grid(of) {}
    Range range;
    HeatGrid grid;
    // By PE.
    std::size_t next = 0;  // the slot from which the pass goes on
    std::unordered_map<std::uint32_t, std::uint32_t> counts;
    HeatCells sent;
  };
  struct Spent {
    Map* map = nullptr;  // null: of no map that is watched
    std::uint32_t cell = 0;
    const Action* action = nullptr;  // null: no scope runs
    std::uint64_t ticks = 0;
  };

  /// Adds, and removes, what is watched from now on.
  void watch(const std::vector<HeatQuery>& queries);
  void begin_window();
  [[nodiscard]] std::vector<HeatCells> close_window();
  void stop_metering();
  void add(std::uint64_t ticks);
  /// Counts a part of the elements; true if the pass is over and found something new.
  [[nodiscard]] bool count(const HeatQuery& query, Map& map);

  Pe& pe_;
  std::map<HeatQuery, Map> maps_;
  bool open_ = false;                    // of the window; the meter runs
  bool listens_ = false;                 // to the meter: until the window has seen enough scopes
  std::uint64_t began_ = 0, ended_ = 0;  // ticks; of the window
  // The running scope: when it began, or went on; its entry method and cell. The thread's time was
  // last asked for at `cpu_at_`, at most cpu_again_seconds before.
  std::uint64_t since_ = 0, cpu_at_ = 0;
  double cpu_seen_ = 0;
  Spent running_;
  std::vector<Spent> spent_;
  std::vector<std::pair<const Action*, double>> entries_;  // parts of the last window's time
  bool measured_ = false;                                  // the entries have not been taken
  std::size_t most_scopes_ = 0;
};

}  // namespace tess::detail
