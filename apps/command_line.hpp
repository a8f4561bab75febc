// Reading a program's own options, after tess::take_options() has taken the runtime's: one line and
// exit 2 for what is wrong (tess::guarded), --help with the runtime's options below the program's.
#pragma once

#include "runtime/machine/mpi.hpp"
#include "runtime/run.hpp"

#include <CLI/CLI.hpp>

namespace apps {

/// Parses the command line into what the program bound to `app`. False if it printed the help: the
/// program is done. Throws tess::Error for bad options.
[[nodiscard]] inline bool parse(CLI::App& app, int argc, char** argv) {
  app.footer(tess::options_help());
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    if (tess::speaks_for_job()) tess::print(app.help());
    return false;
  } catch (const CLI::ParseError& error) {
    tess::fail(tess::ErrorCode::bad_argument, error.what(), " (--help lists the options)");
  }
  return true;
}

}  // namespace apps
