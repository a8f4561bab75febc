#include "apps/bench/bench.hpp"

#include <algorithm>

namespace bench {
namespace {

/// "threads: 2 PEs" of "threads: 2 PEs on cores 0, 1; …".
std::string short_description(const tess::Machine& machine) {
  const std::string text = machine.describe();
  return text.substr(0, std::min(text.find(';'), text.find(" on ")));
}

}  // namespace

void work(std::chrono::nanoseconds time) {
  if (tess::charge(time)) return;
  const Stopwatch watch;
  while (watch.nanoseconds() < static_cast<double>(time.count())) {
  }
}

Bench::Bench(Options options, std::vector<char*> command_line, const tess::Machine& machine)
    : options_(std::move(options)),
      command_line_(std::move(command_line)),
      report_({short_description(machine), machine.n_pes(), machine.n_processes()}),
      virtual_time_(machine.virtual_time()),
      speaks_(machine.process().value == 0) {}

tess::Setup Bench::fresh() const {
  std::vector<char*> line = command_line_;
  auto argc = static_cast<int>(line.size());
  line.push_back(nullptr);
  return tess::take_options(argc, line.data());
}

bool Bench::has(Needs needs) const {
  switch (needs) {
    case Needs::nothing:
      return true;
    case Needs::two_pes:
      return origin().pes > 1;
    case Needs::two_cores:
      return origin().pes > 1 && origin().ranks == 1 && !virtual_time_;
    case Needs::two_processes:
      return origin().ranks > 1 && !virtual_time_;
  }
  return false;
}

bool Bench::wants(std::string_view row) const {
  return std::find(wanted_.begin(), wanted_.end(), row) != wanted_.end();
}

void Bench::row(std::string_view name, const Samples& samples, std::string_view unit,
                double limit) {
  if (speaks_ && wants(name)) report_.row(name, samples, unit, limit);
}

int run(const Shape& shape, Bench& bench) {
  if (shape.run != nullptr) return shape.run(bench);
  std::vector<Figure> figures(shape.rows.size());
  const int code = bench.run([&] { return shape.measure(bench, figures); });
  for (std::size_t i = 0; code == 0 && i < figures.size(); ++i)
    bench.row(shape.rows[i].name, figures[i].samples, shape.rows[i].unit,
              figures[i].limit.empty() ? 0 : figures[i].limit.median());
  return code;
}

std::int64_t times_in_sample(double nanoseconds, std::int64_t most) {
  const double n = sample_nanoseconds / std::max(nanoseconds, 1e-3);
  return n >= static_cast<double>(most) ? most
                                        : std::max<std::int64_t>(1, static_cast<std::int64_t>(n));
}

}  // namespace bench
