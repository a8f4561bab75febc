// Runs one graph of transfers, a study, or a drift table, as the command line asks for. All PEs
// read the input together, PE 0 writes the output. Errors of the input are found before a mesh is
// cut.
#pragma once

#include "apps/m2m_transfer/input/problem.hpp"
#include "runtime/runtime.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tess {
class CommandLine;
}  // namespace tess

namespace m2m_transfer {

struct DriverOptions {
  Request request;
  std::vector<std::string> policies{"keep"};
  std::optional<std::int32_t> repeat;  ///< default: 1, in a study 3
  std::string out, json, picture;
  std::string step, weights, from_weights;  ///< file_fields.hpp
  bool explain = false;
  std::optional<std::string> study;  ///< "h", "kind" or "steps"
  std::string plot;                  ///< the folder for files of studies and drift; empty: default
  std::string round_trips;           ///< "1,2,5"; empty: no drift table
  bool stability = false;            ///< set by --stability, which m2m_stability carries out
  bool kind_is_given = false;        ///< otherwise tables of kinds have all of them
  bool partition_is_given = false;
  /// Knows which options were given (contradictions.hpp); null if the options are not from one.
  const tess::CommandLine* line = nullptr;
};

/// Returns the exit code.
int drive(Setup& setup, const DriverOptions& options);

}  // namespace m2m_transfer
