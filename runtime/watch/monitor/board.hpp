// What process 0 knows of all PEs, and the events for browsers that it makes of it: lines of JSON.
//
//     frame    utilisation, rates, queues of each PE since the last frame; entry methods; memory;
//              chares; epochs
//     run      the program and its command line (the monitor adds it)
//     round    a balance round
//     picture  what the program draws
//     heat     a heat map, for the browsers that watch this one
//     report   what waits, when a browser has asked (the monitor adds it)
//     now      the end of what has been (the server adds it)
//
// It keeps the frames and rounds of the last minutes and the last picture of each name, for a
// browser that comes late. Not for several threads at once.
#pragma once

#include "runtime/watch/monitor/heat_map.hpp"
#include "runtime/watch/monitor/monitor.hpp"
#include "runtime/watch/monitor/sample.hpp"
#include "runtime/wire/machine/machine.hpp"

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tess::detail {

/// What a browser listens to: a heat map, or what all hear of the run.
using Topic = std::optional<HeatMapId>;

/// An event as browsers receive it: its kind, and one line of JSON.
struct Event {
  std::string kind;
  std::string json;
  Topic topic{};
};

class Board {
 public:
  static constexpr std::size_t most_pictures = 16;  ///< names

  explicit Board(const Machine& machine);

  void arrived(PeSample sample);
  void note(const BalanceNote& note);
  /// False if it is left out, since the page has its most pictures.
  bool draw(const PicturePart& part);
  /// The events since the last call: rounds and a frame, then pictures, then heat maps. `runs(pe)`
  /// names the entry method that a PE of this process runs, or nothing. `seconds` is the wall time
  /// of the run.
  [[nodiscard]] std::vector<Event> take_events(double seconds,
                                               const std::function<std::string(PeId)>& runs);
  /// What a browser that comes now must know.
  [[nodiscard]] std::vector<Event> past(const Topic& topic) const;

  /// These heat maps are watched from now on.
  void watch_heat(const std::vector<HeatMapId>& watched);
  /// What the PEs are to report for them.
  [[nodiscard]] std::vector<HeatQuery> heat_queries() const;
  void take(HeatCells&& part);

 private:
  struct OfPe {
    PeSample last, before;
    bool is_new = false;  // came since the last frame
    int percent = 0;      // busy
    double rate = 0;      // messages a second
    int n_missed = 0;     // frames since it came in which PE 0 has answered
    std::string runs;     // an entry method for so long that it has not answered
  };
  struct Picture {
    std::int32_t width = 0, height = 0;
    std::vector<float> values;
    bool changed = false;
  };
  [[nodiscard]] std::string frame(double seconds, const std::function<std::string(PeId)>& runs);
  [[nodiscard]] std::string collections() const;
  [[nodiscard]] std::string entries() const;
  [[nodiscard]] static Event event_of(const std::string& name, const Picture& picture);
  [[nodiscard]] std::string name_of(CollectionId id) const;

  const std::int32_t n_pes_, n_processes_;
  const bool virtual_time_;
  double seconds_ = 0;
  std::vector<OfPe> pes_;
  std::vector<std::string> new_rounds_;
  std::map<std::string, Picture> pictures_;
  std::deque<Event> past_;
  struct WatchedHeat {
    std::uint32_t watch = 0;
    HeatMap map;
  };
  std::map<HeatMapId, WatchedHeat> heat_;
  std::uint32_t n_watches_ = 0;
};

}  // namespace tess::detail
