#include "runtime/checkpoint/hosts.hpp"

#include "runtime/checkpoint/files.hpp"
#include "runtime/core/text.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <sys/stat.h>
#include <unistd.h>

namespace tess::detail {

SeenFolder look_at(const std::string& folder) {
  // Hosts may have equal names, and containers on one host have folders of their own.
  std::string boot;
  std::ifstream("/proc/sys/kernel/random/boot_id") >> boot;
  std::array<char, 256> name{};
  (void)::gethostname(name.data(), name.size() - 1);
  SeenFolder seen;
  seen.host = text(name.data(), " ", boot);
  struct stat found {};
  if (::stat(folder.c_str(), &found) == 0) seen.host += text(" ", found.st_dev, " ", found.st_ino);
  seen.numbers = numbers_in(folder);
  for (const std::uint64_t number : seen.numbers)
    if (is_complete(folder, number)) seen.complete.push_back(number);
  return seen;
}

Hosts one_host(std::int32_t n_pes) {
  return {std::vector<std::uint32_t>(static_cast<std::size_t>(n_pes), 0), {PeId{0}}};
}

Hosts hosts_of(const std::vector<std::string>& names, std::int32_t pes_per_process) {
  Hosts hosts;
  std::vector<std::string> known;
  for (std::size_t process = 0; process < names.size(); ++process) {
    const auto at = std::find(known.begin(), known.end(), names[process]);
    const auto host = static_cast<std::uint32_t>(at - known.begin());
    if (at == known.end()) {
      known.push_back(names[process]);
      hosts.first.push_back(PeId{static_cast<std::int32_t>(process) * pes_per_process});
    }
    hosts.of_pe.insert(hosts.of_pe.end(), static_cast<std::size_t>(pes_per_process), host);
  }
  return hosts;
}

PeId buddy_of(PeId pe, const Hosts& hosts, std::int32_t pes_per_process) {
  const auto n_pes = static_cast<std::int32_t>(hosts.of_pe.size());
  const auto host = [&](std::int32_t of) { return hosts.of_pe[static_cast<std::size_t>(of)]; };
  for (std::int32_t ahead = pes_per_process; ahead < n_pes; ahead += pes_per_process)
    if (const std::int32_t other = (pe.value + ahead) % n_pes; host(other) != host(pe.value))
      return PeId{other};
  return PeId{(pe.value + (pes_per_process < n_pes ? pes_per_process : 1)) % n_pes};
}

std::string name_of_copy(const std::string& name) {
  return name + ".copy";
}

bool Listing::is_complete(std::uint64_t number) const {
  return std::ranges::any_of(complete_on, [&](const auto& has) { return has.contains(number); });
}

Listing list_shared(const std::string& folder, std::int32_t n_pes) {
  return list_hosts({look_at(folder)}, n_pes);
}

Listing list_hosts(const std::vector<SeenFolder>& seen, std::int32_t pes_per_process) {
  std::vector<std::string> names;
  names.reserve(seen.size());
  for (const SeenFolder& one : seen) names.push_back(one.host);
  Listing listing;
  listing.hosts = hosts_of(names, pes_per_process);
  listing.complete_on.resize(listing.hosts.first.size());
  std::set<std::uint64_t> numbers;
  for (std::size_t process = 0; process < seen.size(); ++process) {
    const SeenFolder& one = seen[process];
    numbers.insert(one.numbers.begin(), one.numbers.end());
    const auto pe = process * static_cast<std::size_t>(pes_per_process);
    listing.complete_on[listing.hosts.of_pe[pe]].insert(one.complete.begin(), one.complete.end());
  }
  listing.numbers.assign(numbers.rbegin(), numbers.rend());
  return listing;
}

}  // namespace tess::detail
