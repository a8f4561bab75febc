// Snapshots as JSON files in the schema of vt's load-balancing tools ("LBDatafile" of
// DARMA-tasking/vt, scripts/LBDatafile_schema.py): phases of tasks and communications. Those tools
// open our files, one per rank, and the laboratory replays theirs.
//
// Values that the schema does not define are in its free fields, as plain numbers: sizes and
// positions in a task's `user_defined`; speeds, background and memory limits of PEs in the phase's.
// Entity ids are packed as in vt: sequence number << 18 | home << 2 | 3 (2: does not migrate).
#pragma once

#include "runtime/balance/snapshot.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tess::balance {

/// The measurements between two balance rounds.
struct Phase {
  std::uint64_t id = 0;
  Snapshot snapshot;
};

/// A file's content, and its name for error messages.
struct LbDatafile {
  std::string name;
  std::string text;
};

/// The phases as one document. With `rank`, only tasks on that PE and messages from them, as the
/// tools expect one file per rank. Bytes of messages are exact below 2^53.
[[nodiscard]] std::string write_lb_datafile(const std::vector<Phase>& phases,
                                            std::optional<PeId> rank = std::nullopt);

/// The phases of one run from all of its files. An element's key is its collection and its index if
/// that is one number, otherwise its id. Only messages between objects ("SendRecv") count. If no
/// file describes PEs, their number is the highest node plus one, and their speed is 1. Throws
/// Error, one line with file and place, if a file is damaged or refers to an entity that no file
/// defines.
[[nodiscard]] std::vector<Phase> parse_lb_datafiles(const std::vector<LbDatafile>& files);

/// Reads and parses the files. Throws Error if a file cannot be read.
[[nodiscard]] std::vector<Phase> read_lb_datafiles(const std::vector<std::string>& paths);

}  // namespace tess::balance
