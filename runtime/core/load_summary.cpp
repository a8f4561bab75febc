#include "runtime/core/load_summary.hpp"

#include <algorithm>
#include <fmt/core.h>

namespace tess {
namespace {

constexpr double least_gain = 0.005;  // less is noise of the loads

std::string percent(double share) {
  return fmt::format("{:.{}f} %", 100 * share, share < 0.0995 ? 1 : 0);
}

}  // namespace

LoadSummary summarise(const std::vector<PeLoad>& pes) {
  LoadSummary summary;
  double seconds = 0, work = 0, speed = 0, most = 0, largest = 0, busy = 0, fastest = 0;
  double in_elements = pes.empty() ? -1 : 0;
  for (const PeLoad& pe : pes) {
    seconds = std::max(seconds, pe.seconds);
    busy += pe.busy;
    work += pe.busy * pe.speed;
    speed += pe.speed;
    fastest = std::max(fastest, pe.speed);
    most = std::max(most, pe.busy);
    in_elements = in_elements < 0 || pe.in_elements < 0 ? -1 : in_elements + pe.in_elements;
    if (pe.element.empty() || (!summary.largest.empty() && pe.largest * pe.speed <= largest))
      continue;
    largest = pe.largest * pe.speed;
    summary.largest = pe.element;
  }
  if (!(seconds > 0)) return summary;
  const auto n = static_cast<double>(pes.size());
  const double mean = work / speed;
  const auto share = [seconds](double of) { return std::clamp(of / seconds, 0.0, 1.0); };
  summary.wait = share(seconds - busy / n);
  summary.balance = share(most - mean);
  if (in_elements >= 0) summary.runtime = share((busy - in_elements) / n);
  if (!summary.largest.empty()) summary.element = share(most - std::max(mean, largest / fastest));
  return summary;
}

std::string describe(const LoadSummary& summary) {
  if (summary.wait < 0) return "the loads of PEs were not measured";
  std::string text = "PEs wait " + percent(summary.wait) + " of the time; ";
  if (summary.balance < least_gain) {
    text += "nothing is to be gained by balance";
  } else {
    text += "perfect balance would save " + percent(summary.balance);
    if (summary.element >= 0)
      text += fmt::format(
          "; the largest element, {}, allows {}", summary.largest,
          summary.element < least_gain ? "no balancer a gain" : percent(summary.element));
  }
  if (summary.runtime >= 0)
    text += "; the runtime and its messages cost " + percent(summary.runtime);
  return text;
}

}  // namespace tess
