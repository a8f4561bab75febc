// Snapshots as JSON files in the schema of vt's load-balancing tools ("LBDatafile" of
// DARMA-tasking/vt, scripts/LBDatafile_schema.py): phases of tasks and communications. Those tools
// open our files, one per rank, and the laboratory replays theirs.
//
// Files whose name ends in ".br" are compressed with brotli, as those tools do by default.
//
// Values that the schema does not define are in its free fields, as plain numbers: memory and
// position in a task's `user_defined`; speeds, background and memory limits of PEs in the phase's.
// Memory has the names that vt's balancers read:
//
//     task_footprint_bytes    memory_bytes of the element      shared_id     block, below 0: none
//     task_working_bytes      its working_bytes                shared_bytes  size of the block
//     task_serialized_bytes   its size_bytes                   home_rank     home of the block
//     rank_working_bytes      working_bytes of its PE
//
// `index` is the index of the element, if the snapshot has it: [3], [1, 2], ["name"]; otherwise its
// hash.
//
// Entity ids are packed as in vt: sequence number << 18 | home modulo 2^16 << 2 | 3 (2: does not
// migrate).
#pragma once

#include "runtime/balance/snapshot.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tess::balance {

/// The measurements between two balance rounds.
struct Phase {
  std::uint64_t id = 0;
  Snapshot snapshot;
  std::size_t n_left_out = 0;  ///< communications that are not from a task of a file to one
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
/// that is one number, otherwise its id. Only messages between objects ("SendRecv") count. Where
/// tasks disagree on a shared block's size or on a PE's working memory, the largest counts. If no
/// file describes PEs, their number is the highest node plus one, and their speed is 1. Throws
/// Error, one line with file and place, if a file is damaged or names one of several tasks.
[[nodiscard]] std::vector<Phase> parse_lb_datafiles(const std::vector<LbDatafile>& files);

/// The bytes of a file of this name with this text: compressed if the name ends in ".br".
[[nodiscard]] std::string lb_datafile_bytes(std::string_view path, const std::string& text);

/// Reads, unpacks and parses the files. Throws Error that names the file if it cannot be read, is
/// truncated or damaged, or unpacks to more than 64 MiB and 1000 times its size, or 4 GiB.
[[nodiscard]] std::vector<Phase> read_lb_datafiles(const std::vector<std::string>& paths);

}  // namespace tess::balance
