// The hosts of a run, as far as a folder of checkpoints is concerned: two PEs are on one host if
// they see the same folder of one machine. Without buddy copies the folder is one that all reach,
// and counts as one host.
//
// With buddy copies the folder is local to each host, such as one in /dev/shm. A host then holds
// the files of its own PEs, copies of files of the PEs whose buddies it has, "main" and the
// manifest:
//
//     host 0 (PEs 0, 1)    pe-0  pe-1  pe-2.copy  pe-3.copy  main  manifest.json
//     host 1 (PEs 2, 3)    pe-2  pe-3  pe-0.copy  pe-1.copy  main  manifest.json
#pragma once

#include "runtime/core/ids.hpp"

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace tess::detail {

/// What a process sees of a folder.
struct SeenFolder {
  std::string host;  ///< equal on the processes of one machine that see the same folder
  std::vector<std::uint64_t> numbers;   ///< of the checkpoints there, the latest first
  std::vector<std::uint64_t> complete;  ///< those with a manifest
};
[[nodiscard]] SeenFolder look_at(const std::string& folder);

struct Hosts {
  std::vector<std::uint32_t> of_pe;  ///< 0, 1, …
  std::vector<PeId> first;           ///< the first PE of each host
};
/// All PEs on one host.
[[nodiscard]] Hosts one_host(std::int32_t n_pes);
/// From the names of the hosts of all processes.
[[nodiscard]] Hosts hosts_of(const std::vector<std::string>& names, std::int32_t pes_per_process);
/// The PE that keeps the copy of a PE's file: of the next process on another host; if there is no
/// other host, of the next process; if there is only one, the next PE.
[[nodiscard]] PeId buddy_of(PeId pe, const Hosts& hosts, std::int32_t pes_per_process);
[[nodiscard]] std::string name_of_copy(const std::string& name);

/// The checkpoints that the hosts have.
struct Listing {
  Hosts hosts;
  std::vector<std::uint64_t> numbers;                ///< on any host, the latest first
  std::vector<std::set<std::uint64_t>> complete_on;  ///< by host
  [[nodiscard]] bool is_complete(std::uint64_t number) const;
};
/// Of a folder that all processes can reach, as the caller sees it.
[[nodiscard]] Listing list_shared(const std::string& folder, std::int32_t n_pes);
/// `seen`: by process.
[[nodiscard]] Listing list_hosts(const std::vector<SeenFolder>& seen, std::int32_t pes_per_process);

}  // namespace tess::detail
