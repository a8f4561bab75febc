#include "apps/m2m_transfer/run/footprint.hpp"

#include <algorithm>
#include <sys/resource.h>

namespace m2m_transfer {
namespace {

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace

Footprint JoinFootprints::operator()(Footprint a, const Footprint& b) const {
  a.peak_memory_bytes += b.peak_memory_bytes;
  a.greatest_peak_memory_bytes =
      std::max(a.greatest_peak_memory_bytes, b.greatest_peak_memory_bytes);
  a.bytes_sent += b.bytes_sent;
  return a;
}

void Gauge::read(Callback<Footprint> target) {
  const Machine& machine = tess::machine();
  Footprint mine;
  mine.bytes_sent = statistics().bytes_sent;
  // All simulated processes share the memory of process 0.
  if (machine.process_of(pe()) == machine.process() && machine.is_first_of_process(pe()))
    mine.peak_memory_bytes = mine.greatest_peak_memory_bytes = peak_memory_bytes();
  contribute(JoinFootprints{}, mine, std::move(target));
}

}  // namespace m2m_transfer
