// What process 0 knows of all PEs, and the events for browsers that it makes of it: lines of JSON.
//
//     frame    utilisation, rates, queues of each PE since the last frame; memory; chares; epochs
//     round    a balance round
//     picture  what the program draws
//     census   what waits, after a browser asked
//
// It keeps the frames and rounds of the last minutes and the last picture of each name, for a
// browser that comes late. Not for several threads at once.
#pragma once

#include "runtime/machine/machine.hpp"
#include "runtime/monitor/monitor.hpp"
#include "runtime/monitor/sample.hpp"

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace tess::detail {

/// An event as browsers receive it: its kind, and one line of JSON.
struct Event {
  std::string kind;
  std::string json;
};

class Board {
 public:
  explicit Board(const Machine& machine);

  void arrived(PeSample sample);
  void note(const BalanceNote& note);
  void draw(const PicturePart& part);
  /// The events since the last call, of which the last one is a frame. `runs(pe)` names the entry
  /// method that a PE of this process runs, or nothing. `seconds` is the wall time of the run.
  [[nodiscard]] std::vector<Event> take_events(double seconds,
                                               const std::function<std::string(PeId)>& runs);
  /// What a browser that comes now must know.
  [[nodiscard]] std::vector<Event> past() const;
  /// Collects the census of the samples that come from now on.
  void begin_census();

 private:
  struct OfPe {
    PeSample last, before;
    bool is_new = false;  // came since the last frame
    int percent = 0;      // busy
    double rate = 0;      // messages a second
  };
  struct Picture {
    std::int32_t width = 0, height = 0;
    std::vector<float> values;
    bool changed = false;
  };
  [[nodiscard]] std::string frame(double seconds, const std::function<std::string(PeId)>& runs);
  [[nodiscard]] std::string collections() const;
  [[nodiscard]] static Event event_of(const std::string& name, const Picture& picture);
  void collect_census(PeSample& sample);

  const std::int32_t n_pes_, n_processes_;
  const bool virtual_time_;
  double seconds_ = 0;
  std::vector<OfPe> pes_;
  std::vector<std::string> new_rounds_;
  std::map<std::string, Picture> pictures_;
  std::deque<Event> past_;
  bool takes_census_ = false;
  std::set<std::int32_t> census_from_;
  Waits census_;
};

}  // namespace tess::detail
