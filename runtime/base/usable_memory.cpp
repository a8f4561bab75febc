#include "runtime/base/usable_memory.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <sys/resource.h>
#include <unistd.h>

namespace tess::detail {
namespace {
namespace fs = std::filesystem;

/// The smallest number in the files `name` of a control group and all its ancestors; "max" means
/// none.
double least_limit(const fs::path& mount, fs::path group, const char* name) {
  double least = HUGE_VAL;
  for (group = group.relative_path();; group = group.parent_path()) {
    std::ifstream file(mount / group / name);
    double limit = 0;
    if (file >> limit) least = std::min(least, limit);
    if (group.empty()) return least;
  }
}

}  // namespace

double control_group_limit(std::istream& groups, const fs::path& mount) {
  double least = HUGE_VAL;
  // number:controllers:path; version 2 has one line without controllers.
  for (std::string line; std::getline(groups, line);) {
    const auto first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string_view controllers =
        std::string_view(line).substr(first + 1, second - first - 1);
    const fs::path group = line.substr(second + 1);
    if (controllers.empty()) least = std::min(least, least_limit(mount, group, "memory.max"));
    if (controllers.find("memory") != std::string::npos)
      least = std::min(least, least_limit(mount / "memory", group, "memory.limit_in_bytes"));
  }
  return least;
}

double usable_memory() {
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
  double there =
      pages > 0 && page > 0 ? static_cast<double>(pages) * static_cast<double>(page) : HUGE_VAL;
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    there = std::min(there, static_cast<double>(limit.rlim_cur));
  std::ifstream groups("/proc/self/cgroup");
  return std::min(there, control_group_limit(groups, "/sys/fs/cgroup"));
}

std::uint64_t resident_memory() {
  // Not a stream: the number is read often, and a stream allocates.
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen("/proc/self/statm", "r"),
                                                             &std::fclose);
  unsigned long long all = 0, resident = 0;
  if (!file || std::fscanf(file.get(), "%llu %llu", &all, &resident) != 2) return 0;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace tess::detail
