#include "runtime/monitor/sample.hpp"

#include "runtime/scheduler/idle_time.hpp"

#include <cstdio>
#include <memory>
#include <unistd.h>

namespace tess::detail {
namespace {

/// The memory that is resident for this process, in bytes; 0 if the system does not say.
std::uint64_t resident_bytes() {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen("/proc/self/statm", "r"),
                                                             &std::fclose);
  unsigned long long all = 0, resident = 0;
  if (!file || std::fscanf(file.get(), "%llu %llu", &all, &resident) != 2) return 0;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

PeSample sample_of(Pe& pe, bool with_census) {
  PeSample sample;
  sample.pe = pe.id();
  sample.at_ns = pe.now().count();
  sample.idle_ns = pe.idle_time()->total().count();
  sample.counts = pe.statistics();
  sample.n_ready = pe.n_ready();
  sample.n_epochs = pe.completion().n_epochs();
  const std::int32_t first = pe.machine().process().value * pe.machine().pes_per_process();
  if (pe.id().value == first) sample.process_bytes = resident_bytes();
  for (const HostedCollection* collection : pe.collections())
    sample.collections.push_back({collection->id(), collection->name(), collection->n_local()});
  sample.has_census = with_census;
  if (with_census) sample.census = pe.census_of_running();
  return sample;
}

}  // namespace tess::detail
