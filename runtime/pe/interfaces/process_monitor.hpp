// The interface by which the runtime and tess::show() report to the monitor of their process
// (--monitor). The live view (runtime/watch/monitor/) implements it, in programs that link it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tess::detail {

class Pe;
class Runtime;
struct MonitorOptions;

/// What a balance round did, for the monitor.
struct BalanceNote {
  std::string text;      ///< one line that describes it
  double before = 1;     ///< max/average that was measured before the round
  double predicted = 1;  ///< the strategy's prediction

  template <class Ar>
  void serialize(Ar& ar) {
    ar(text, before, predicted);
  }
};

/// One picture, or a part of one, that the program draws: rows of values from the top left.
struct PicturePart {
  std::string name;
  std::int32_t width = 0, height = 0;  ///< of the whole picture
  std::int32_t x = 0, y = 0;           ///< where the part begins
  std::int32_t columns = 0;            ///< of the part
  std::vector<float> values;           ///< of the part, row by row

  template <class Ar>
  void serialize(Ar& ar) {
    ar(name, width, height, x, y, columns, values);
  }
};

class ProcessMonitor {
 public:
  ProcessMonitor() = default;
  ProcessMonitor(const ProcessMonitor&) = delete;
  ProcessMonitor& operator=(const ProcessMonitor&) = delete;
  virtual ~ProcessMonitor() = default;

  /// A balance round is over. Called on the PE that decided.
  virtual void balanced(Pe& pe, BalanceNote note) = 0;
  /// True if this part of a picture is wanted: once between two samples of the PE.
  [[nodiscard]] virtual bool wants_part(const Pe& pe, std::string_view name,
                                        std::uint64_t part) = 0;
  virtual void draw(Pe& pe, PicturePart part) = 0;
  /// The PEs leave the run: nothing is posted to them any more. Any PE thread.
  virtual void close() = 0;
};

/// Makes the monitor of a process. The live view sets it before main(); null in a program without.
extern std::unique_ptr<ProcessMonitor> (*make_monitor)(Runtime& runtime,
                                                       const MonitorOptions& options);

}  // namespace tess::detail
