// How much memory this process may have: what is asked before something large is made.
#pragma once

#include <filesystem>
#include <iosfwd>

namespace tess {

/// Bytes: the machine's memory, or less where the shell (RLIMIT_AS) or a container limits it. What
/// others use of it meanwhile is not taken off.
[[nodiscard]] double usable_memory();

/// The least memory limit of a process's control groups and of those above them; HUGE_VAL: none.
/// `groups`: as in /proc/self/cgroup; `mount`: /sys/fs/cgroup, of either version.
[[nodiscard]] double control_group_limit(std::istream& groups, const std::filesystem::path& mount);

}  // namespace tess
