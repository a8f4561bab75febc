#include "apps/bench/report.hpp"

#include "apps/bench/build.hpp"
#include "runtime/run.hpp"
#include "runtime/scheduler/pe.hpp"

#include <algorithm>
#include <fmt/core.h>

namespace bench {

Stopwatch::Stopwatch() : begin_(tess::current_pe().now()) {}
double Stopwatch::nanoseconds() const {
  return std::chrono::duration<double, std::nano>(tess::current_pe().now() - begin_).count();
}

double Samples::median() const {
  std::vector<double> sorted = values_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}
double Samples::least() const {
  return *std::min_element(values_.begin(), values_.end());
}
double Samples::spread() const {
  const auto [least, greatest] = std::minmax_element(values_.begin(), values_.end());
  return (*greatest - *least) / median();
}

Report::Report(const std::string& machine) : machine_(machine) {}

void Report::header() const {
  tess::print("name,median,unit,least,spread,reference,ratio,machine,preset,commit\n");
}

void Report::row(std::string_view name,
                 const Samples& samples,
                 std::string_view unit,
                 double reference) const {
  const double value = samples.median();
  const std::string against =
      reference == 0 ? "," : fmt::format("{},{:.3f}", reference, value / reference);
  tess::print(fmt::format("{},{:.1f},{},{:.1f},{:.2f},{},{},{},{}\n",
                          name,
                          value,
                          unit,
                          samples.least(),
                          samples.spread(),
                          against,
                          machine_,
                          build_preset,
                          build_commit));
}

}  // namespace bench
