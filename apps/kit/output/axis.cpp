#include "apps/kit/output/axis.hpp"

#include "apps/kit/output/ticks.hpp"
#include "runtime/core/sort_unique.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>

namespace kit {
namespace {

constexpr std::size_t most_counts = 12;  // labels of an axis of counts
constexpr double slack = 1e-9;           // ends are not rounded away from their labels

bool is_whole(double value) {
  return value == std::round(value);
}

/// Digits in groups of three, with thin spaces.
std::string grouped(std::string digits) {
  const auto first = static_cast<std::ptrdiff_t>(digits.starts_with('-'));
  for (auto at = std::ssize(digits) - 3; at > first; at -= 3)
    digits.insert(static_cast<std::size_t>(at), "\u2009");
  return digits;
}

std::string superscript(int exponent) {
  constexpr std::array digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = exponent < 0 ? "⁻" : "";
  for (const char c : fmt::format("{}", std::abs(exponent)))
    out += digits[static_cast<std::size_t>(c - '0')];
  return out;
}

std::vector<double> linear_ticks(double low, double high) {
  const double step = tick_step(high - low);
  std::vector<double> ticks;
  for (double n = std::floor(low / step + slack); n <= std::ceil(high / step - slack); ++n)
    ticks.push_back(n * step);
  return ticks;
}

std::vector<double> log_ticks(double low, double high) {
  const bool short_range = high / low < 1e3;
  std::vector<double> ticks;
  const auto last = static_cast<int>(std::ceil(std::log10(high) - slack));
  for (int power = static_cast<int>(std::floor(std::log10(low) + slack)); power <= last; ++power)
    for (const double factor : {1.0, 2.0, 5.0})
      if (factor == 1 || (short_range && power < last)) {
        // Exact where it can be: 0.01, not 0.010000000000000002.
        ticks.push_back(power < 0 ? factor / std::pow(10, -power) : factor * std::pow(10, power));
      }
  // From the last at or below the values to the first at or above them.
  while (ticks.size() > 2 && ticks[1] <= low * (1 + slack)) ticks.erase(ticks.begin());
  while (ticks.size() > 2 && ticks[ticks.size() - 2] >= high * (1 - slack)) ticks.pop_back();
  return ticks;
}

}  // namespace

double Axis::part(double value) const {
  return log ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

std::string number_text(double value) {
  if (value == 0) return "0";
  const double size = std::abs(value);
  const std::string three = fmt::format("{:.2e}", value);
  const bool is_round = std::strtod(three.c_str(), nullptr) == value;
  if (is_whole(value) && (size < 1e6 || (size < 1e15 && !is_round)))
    return grouped(fmt::format("{:.0f}", value));
  if (size >= 1e-3 && size < 1e3) return fmt::format("{:.3g}", value);
  if (size >= 1e3 && size < 1e6) return grouped(fmt::format("{:.0f}", value));
  const auto exponent = static_cast<int>(std::floor(std::log10(size) + 1e-12));
  const std::string factor =
      fmt::format("{:.3g}", std::strtod(three.c_str(), nullptr) / std::pow(10, exponent));
  return (factor == "1" ? "" : factor == "-1" ? "-" : factor + "·") + "10" + superscript(exponent);
}

Axis axis_of(std::vector<double> values, bool log, std::vector<double> ticks, bool from_zero) {
  tess::sort_unique(values);
  double low = values.front(), high = values.back();
  const auto counts = [&] {  // their labels do not touch
    return log && high > low && high < 1e4 && values.size() <= most_counts &&
           std::ranges::all_of(values, is_whole) &&
           std::ranges::adjacent_find(values, [&](double a, double b) {
             return std::log(b / a) < 0.06 * std::log(high / low);
           }) == values.end();
  };
  if (ticks.empty() && counts()) ticks = values;
  if (!ticks.empty()) {
    tess::sort_unique(ticks);
    // It ends with the data and the labels, not at a round number.
    low = std::min(low, ticks.front()), high = std::max(high, ticks.back());
  } else {
    if (!log && from_zero && low > 0 && low < high / 2) low = 0;
    if (low == high)
      low -= low == 0 ? 1 : std::abs(low) / 2, high += high == 0 ? 1 : std::abs(high) / 2;
    ticks = log && high / low > 3 ? log_ticks(low, high) : linear_ticks(low, high);
    if (log && ticks.front() <= 0) ticks.erase(ticks.begin());
    if (log || from_zero)
      low = std::min(low, ticks.front()), high = std::max(high, ticks.back());
    else  // it ends with the data
      std::erase_if(ticks, [&](double tick) { return tick < low || tick > high; });
  }
  if (low == high) low *= log ? 0.5 : 1 - 1e-6, high *= log ? 2 : 1 + 1e-6;
  Axis axis{low, high, log};
  for (const double tick : ticks) axis.ticks.emplace_back(tick, number_text(tick));
  // Labels that are equal in three digits are told apart by more.
  for (int digits = 4; digits <= 17; ++digits) {
    const auto same = [](const auto& a, const auto& b) { return a.second == b.second; };
    if (std::ranges::adjacent_find(axis.ticks, same) == axis.ticks.end()) break;
    for (auto& [tick, text] : axis.ticks) text = fmt::format("{:.{}g}", tick, digits);
  }
  return axis;
}

}  // namespace kit
