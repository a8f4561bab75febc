#include "runtime/more/load_measurement.hpp"

#include "runtime/pe/runtime.hpp"
#include "runtime/runtime.hpp"

namespace tess {
namespace detail {

/// Starts and stops the measurement of its PE.
class LoadMeter : public Group<LoadMeter> {
 public:
  LoadMeter() {
    if (!is_of_run()) measuring().start_elements();
  }
  void give(const Callback<std::vector<PeLoad>>& target) {
    contribute(in_order(concatenate), std::vector<PeLoad>{measuring().load()}, target);
    if (!is_of_run()) measuring().stop_elements();
  }

 private:
  /// --stats measures the whole run.
  [[nodiscard]] static bool is_of_run() { return current_pe().runtime().options().statistics; }
  [[nodiscard]] static Measuring& measuring() { return current_pe().measuring(); }
};

}  // namespace detail

Task LoadMeasurement::begin() {
  co_await epoch([&] { meters_ = create<detail::LoadMeter>(each_pe); });
}

Task LoadMeasurement::end(std::vector<PeLoad>* pes) {
  *pes = co_await meters_.reduce<&detail::LoadMeter::give>();
  co_await epoch([&] { meters_.destroy(); });
}

}  // namespace tess
