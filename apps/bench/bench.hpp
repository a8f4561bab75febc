// A measurement and what it needs. A shape is one program in miniature (apps/bench/shapes/, a file
// each); it is run on fresh machines, takes samples in turns, checks what was done, and gives rows.
//
//     main           for each chosen shape: run(shape, bench) on every process
//     shape.measure  a coroutine on PE 0, which fills a figure per row
//     shape.run      of some instead: bench.run(coroutine) once or more; then bench.row(…)
//
// The first sample of a figure is a warm-up and not counted.
#pragma once

#include "apps/bench/report.hpp"
#include "runtime/run.hpp"
#include "runtime/task.hpp"

#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bench {

/// Works in an entry method: keeps the core busy for this time, or takes it on the simulated
/// machine.
void work(std::chrono::nanoseconds time);

/// The longest that one sample is meant to last.
inline constexpr double sample_nanoseconds = 0.3e9;

struct Options {
  std::int32_t repeat = 5;
  bool quick = false;
  std::vector<std::string> names;  // of shapes or rows; empty: all
  std::string json;
};

/// On which machines a row has a meaning.
enum class Needs : std::uint8_t {
  nothing,
  two_pes,
  two_cores,      ///< PE 0 and the last PE are threads of one process, in real time
  two_processes,  ///< PE 0 and the last PE are in different processes, joined by MPI
};

/// What --list says about a row, and the unit of its figure.
struct RowText {
  std::string name;
  std::string meaning;
  Needs needs = Needs::nothing;
  std::string_view unit = "ns";
};

/// The samples of a row, and of its limit where that is measured in the same turns.
struct Figure {
  Samples samples, limit;
};

class Bench {
 public:
  /// `command_line` as main() got it; `machine` is one that it names.
  Bench(Options options, std::vector<char*> command_line, const tess::Machine& machine);

  /// Runs `main` on PE 0 of a fresh machine; returns the exit code.
  template <class Main>
  [[nodiscard]] int run(Main main) const {
    tess::Setup setup = fresh();
    return tess::run(setup, std::move(main));
  }

  [[nodiscard]] std::int32_t repeat() const { return options_.repeat; }
  /// The size of a shape, or the one that --quick gives it.
  template <class T>
  [[nodiscard]] T size(T full, T quick) const {
    return options_.quick ? quick : full;
  }
  [[nodiscard]] bool has(Needs needs) const;
  [[nodiscard]] std::int32_t ranks() const { return origin().ranks; }
  /// True on the process that prints.
  [[nodiscard]] bool speaks() const { return speaks_; }
  /// True if the row is asked for, by its name or its shape's, and this machine has what it needs.
  [[nodiscard]] bool wants(std::string_view row) const;

  /// Shows a row, if it is wanted. Process 0 speaks; on the others nothing happens.
  void row(std::string_view name, const Samples& samples, std::string_view unit, double limit = 0);
  [[nodiscard]] const Report& report() const { return report_; }
  [[nodiscard]] const Origin& origin() const { return report_.origin(); }

  /// Called by main: the names of the rows to come.
  void choose(std::vector<std::string> wanted) { wanted_ = std::move(wanted); }

 private:
  [[nodiscard]] tess::Setup fresh() const;

  Options options_;
  std::vector<char*> command_line_;
  Report report_;
  bool virtual_time_;
  bool speaks_;
  std::vector<std::string> wanted_;
};

struct Shape {
  std::string name;
  std::string meaning;
  std::vector<RowText> rows;
  tess::Task (*measure)(const Bench&, std::span<Figure> of_rows) = nullptr;
  int (*run)(Bench&) = nullptr;  ///< in place of `measure`, where one run is not enough
};

/// Measures a shape, and shows its rows. Returns the exit code.
[[nodiscard]] int run(const Shape& shape, Bench& bench);

/// How often something that takes `nanoseconds` fits into a sample; at least once, at most `most`.
[[nodiscard]] std::int64_t times_in_sample(double nanoseconds, std::int64_t most);

}  // namespace bench
