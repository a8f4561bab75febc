// How much memory this process may use, which is checked before something large is allocated, and
// how much it does use.
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>

namespace tess::detail {

/// In bytes: the machine's memory, or less if the shell (RLIMIT_AS) or a container limits it.
/// Memory that other processes use is not subtracted.
[[nodiscard]] double usable_memory();

/// In bytes: what the pages of this process fill now; 0 if the system does not say.
[[nodiscard]] std::uint64_t resident_memory();

/// The smallest memory limit of a process's control groups and their ancestors; HUGE_VAL if there
/// is none. `groups` has the format of /proc/self/cgroup; `mount` is /sys/fs/cgroup, of either
/// version.
[[nodiscard]] double control_group_limit(std::istream& groups, const std::filesystem::path& mount);

}  // namespace tess::detail
