// The frame of a program: its options and the modes in which each means something, the options that
// all programs share, the files that it writes, its progress line, and the one shape of its JSON.
//
//     int start(tess::Setup& setup, int argc, char** argv) {
//       kit::Driver driver(setup, "Heats a plate.");
//       driver.option("--steps", n_steps, "time steps").between(1, 1'000'000);
//       driver.in(kit::Mode::run);               // means nothing in a study: refused there
//       driver.option("--order", order, "of the scheme").between(1, 3);
//       driver.study("each order with each size: error against run time");
//       driver.json();
//       if (!driver.parse(argc, argv)) return 0;
//       return tess::run(setup, [&] { return driver.mode() == kit::Mode::study ? … : …; });
//     }
//
// The file of --json, in all programs and modes:
//
//     {"program": "heat", "version": "0.2.0", "commit": "4f1c2e0", "compiler": "g++ 12.2.0",
//      "mpi": "Open MPI 4.1.4", "machine": "…", "options": {"steps": "10", …}, "results": [{…}, …]}
//
// `results` has an object per run, case or row of a study. Members that only one program has follow.
#pragma once

#include "apps/kit/output/file_names.hpp"
#include "apps/kit/output/json.hpp"
#include "apps/kit/progress.hpp"
#include "runtime/command_line.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kit {

struct Chart;

/// A set of modes; a program is in one of them at a time.
using Modes = std::uint32_t;
struct Mode {
  static constexpr Modes run = 1, study = 2, stability = 4;
  static constexpr Modes all = ~Modes{0};
  /// The modes that a program has beside these, from 0 on.
  static constexpr Modes own(unsigned number) { return Modes{8} << number; }
};

/// The whole of a JSON file, for programs whose options the driver does not read.
[[nodiscard]] Json document(const std::string& program, const std::string& machine,
                            const Json& options, const Json& results, const Json& more = {});

class Driver {
 public:
  Driver(tess::Setup& setup, const std::string& description);

  /// As of tess::CommandLine.
  void footer(const std::string& text) { line_.footer(text); }
  void examples(std::initializer_list<const char*> commands) { line_.examples(commands); }
  /// The options that follow stand below this heading in the help.
  void group(const std::string& heading) { line_.group(heading); }
  /// The options that follow mean something in these modes only, and are refused in others.
  void in(Modes modes) { modes_ = modes; }
  /// As tess::CommandLine::option().
  template <class T>
  tess::Option option(const std::string& name, T& value, const std::string& meaning) {
    remember(name);
    return line_.option(name, value, meaning);
  }
  tess::Option flag(const std::string& name, bool& value, const std::string& meaning);
  /// The option names a folder to write to, which parse() makes, so that other files may go there.
  void folder(const std::string& name, std::string& path, const std::string& meaning);
  /// The program is in this mode if the option is given, or given with this value. Of several modes
  /// of one option that fit, the last counts.
  void enters(const std::string& option, Modes mode, const std::string& value = "");

  // Options that all programs share. Each says what it means in this one.
  void study(const std::string& meaning);
  void stability(const std::string& meaning);
  /// In run and study.
  void explain(const std::string& meaning = "print what this run uses and what it leaves out");
  void repeat(std::int32_t& n, const std::string& meaning = "runs, of which the fastest counts");
  void json(const std::string& meaning = "write the results as JSON");
  /// A picture FILE.svg with its data as CSV, in the present modes.
  void picture(const std::string& meaning);

  /// False if it printed the help or the version: the program is done. Throws tess::Error for bad
  /// options, for two that do not work together, and for files that cannot be written.
  [[nodiscard]] bool parse(int argc, char** argv);

  [[nodiscard]] Modes mode() const { return mode_; }
  /// Changes to a mode that follows from the values of options; `reason` is what was given for it.
  void enter(Modes mode, const std::string& reason);

  [[nodiscard]] bool is_given(const std::string& option) const { return line_.is_given(option); }
  [[nodiscard]] std::string value(const std::string& option) const { return line_.value(option); }
  [[nodiscard]] const tess::CommandLine& line() const { return line_; }
  /// Throws tess::Error if both options are given.
  void refuse_both(const char* option, const char* other) const;

  /// The files of this run, for the program to add its own; those of --json, --trace and the
  /// picture are there.
  [[nodiscard]] FileNames& files() { return files_; }
  [[nodiscard]] bool explains() const { return explains_; }
  /// True on the process that prints.
  [[nodiscard]] bool speaks() const { return speaks_; }
  [[nodiscard]] Progress& progress() { return *progress_; }

  /// The whole of the JSON: `results`, and the members of `more` below them.
  [[nodiscard]] Json document(const Json& results, const Json& more = {}) const;
  /// Writes the file of --json if it is given; the picture likewise.
  void write(const Json& results, const Json& more = {}) const;
  void draw(const Chart& chart) const;

 private:
  struct Known {
    std::string name;
    Modes modes;
  };
  struct ModeOption {
    std::string option, value;  // of any value if it is empty
    Modes mode;
  };

  void remember(const std::string& name);
  void refuse_others(const std::string& reason) const;

  tess::CommandLine line_;
  std::string machine_, trace_, program_;
  bool speaks_, explains_ = false, is_study_ = false, is_stability_ = false;
  std::string json_, picture_, shows_progress_ = "auto";
  Modes modes_ = Mode::all, mode_ = Mode::run;
  std::vector<Known> known_;
  std::vector<ModeOption> mode_options_;
  std::vector<std::string> folders_;  // options
  FileNames files_;
  std::optional<Progress> progress_;
};

}  // namespace kit
