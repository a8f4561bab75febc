// Snapshots as JSON files in the schema that vt's load-balancing tools read and write ("LBDatafile"
// of DARMA-tasking/vt, scripts/LBDatafile_schema.py): phases of tasks and communications. Those
// tools open ours, one file a rank, and the laboratory replays theirs.
//
// What the schema does not know stands in its free fields, as plain numbers: sizes and positions in
// a task's `user_defined`, speeds, background and memory limits of PEs in the phase's. Entity ids
// are packed as vt packs them: sequence number << 18 | home << 2 | 3 (2: does not migrate).
#pragma once

#include "runtime/balance/snapshot.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tess::balance {

/// What was measured between two balance rounds.
struct Phase {
  std::uint64_t id = 0;
  Snapshot snapshot;
};

/// A file's content, with the name that errors tell.
struct LbDatafile {
  std::string name;
  std::string text;
};

/// The phases as one document; with `rank` only tasks on that PE and messages from them, as the
/// tools expect one file a rank. Bytes of messages are exact below 2^53.
[[nodiscard]] std::string write_lb_datafile(const std::vector<Phase>& phases,
                                            std::optional<PeId> rank = std::nullopt);

/// The phases of one run from all of its files. An element's key is its collection and its index
/// where that is one number, else its id. Only messages from object to object ("SendRecv") count.
/// Where no file tells of PEs, there are as many as the highest node has, of speed 1.
/// Throws Error, one line with file and place, where a file is damaged or names what no file has.
[[nodiscard]] std::vector<Phase> parse_lb_datafiles(const std::vector<LbDatafile>& files);

/// The same from disk. Throws Error where a file cannot be read.
[[nodiscard]] std::vector<Phase> read_lb_datafiles(const std::vector<std::string>& paths);

}  // namespace tess::balance
