// What limits a part of a run (core/load_summary.hpp), as --stats reports it of the whole:
//
//     tess::LoadMeasurement measurement;
//     co_await measurement.begin();
//     …                                       // the work
//     std::vector<tess::PeLoad> pes;
//     co_await measurement.end(&pes);
//     tess::print_text(describe(tess::summarise(pes)) + "\n");
//
// Meanwhile each call of an entry method reads a clock twice, and each element has a record of about
// 150 bytes. Only one part is measured at a time. With --stats the loads are those since the start of
// the run.
#pragma once

#include "runtime/core/load_summary.hpp"
#include "runtime/group.hpp"
#include "runtime/task.hpp"

#include <vector>

namespace tess {

namespace detail {
class LoadMeter;
}

class LoadMeasurement {
 public:
  [[nodiscard]] Task begin();
  /// Gives what each PE measured. `pes` lives until then.
  [[nodiscard]] Task end(std::vector<PeLoad>* pes);

 private:
  GroupProxy<detail::LoadMeter> meters_;
};

}  // namespace tess
