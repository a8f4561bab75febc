// Moves the fields of the source file, step by step, and reads or writes the weights of the
// transfer. There is no truth to compare with: the report says what was found, and the hash of each
// step. Only PE 0 reads and writes files. It holds a batch of steps at a time; each batch is one
// application.
#pragma once

#include "apps/kit/output/json.hpp"
#include "apps/kit/progress.hpp"
#include "apps/m2m_transfer/input/problem.hpp"
#include "apps/m2m_transfer/names.hpp"
#include "apps/m2m_transfer/report.hpp"
#include "apps/m2m_transfer/watch.hpp"
#include "m2m/field.hpp"
#include "m2m/tally.hpp"
#include "m2m/worst_places.hpp"
#include "runtime/runtime.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace m2m_transfer {

/// The options, as on the command line. `fields`: at vertices or in elements of the source file, or
/// formulas; each may list several.
struct FileFieldsRequest : Request {
  std::string step{};                  ///< a number, "all", or empty: the last one
  std::string weights{};               ///< file to write them to
  std::string from_weights{};          ///< file to read them from, in place of a search
  std::string out{};                   ///< ExodusII with all steps, or .vtu with one
  std::vector<std::string> watch{};    ///< "x,y,z"
  std::string watch_file{};            ///< CSV of their values; empty: none
  std::vector<std::string> vectors{};  ///< fields that turn with the source; each may list several
};

struct MovedStep {
  std::size_t step = 0;
  double time = 0;
  std::size_t n_nan = 0;          ///< vertices with a NaN, of the field that has most
  std::size_t n_nan_cells = 0;    ///< the same in cells
  std::uint64_t result_hash = 0;  ///< over the fields at vertices in order, then those in cells
};
struct FileFieldsReport {
  std::string source, target;
  std::vector<std::string> fields;  ///< with their components
  bool searched = false;            ///< otherwise the weights were read
  OtherElements source_elements, target_elements;
  Tally tally;                  ///< after a search
  WorstPlaces worst;            ///< the same
  bool has_cells = false;       ///< fields in elements were moved
  Tally cell_tally;             ///< of target cells, then
  std::uint64_t n_without = 0;  ///< target vertices without weights, if they were read
  std::uint64_t n_weights = 0;  ///< read or written
  std::vector<MovedStep> steps;
  std::vector<Watched> watched;  ///< of every step
};

/// True if the request needs this and not a comparison with formulas: it names a step, a file of
/// weights, or a field that the source file has, or neither a formula nor a field of a file that
/// has fields.
[[nodiscard]] bool is_for_files(const FileFieldsRequest& request);

/// Throws Error with the option, file, field or step that is wrong, before any message is sent.
TaskOf<FileFieldsReport> move_file_fields(const FileFieldsRequest& request,
                                          kit::Progress& progress);

[[nodiscard]] std::string table(const FileFieldsReport& report);
/// One object.
[[nodiscard]] kit::Json json_of(const FileFieldsReport& report);

}  // namespace m2m_transfer
