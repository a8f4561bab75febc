#include "runtime/watch/monitor/sample.hpp"

#include "runtime/base/usable_memory.hpp"
#include "runtime/pe/measure/idle_time.hpp"

namespace tess::detail {
PeSample sample_of(Pe& pe) {
  PeSample sample;
  sample.pe = pe.id();
  sample.at_ns = pe.now().count();
  sample.idle_ns = pe.measuring().idle_time()->total().count();
  sample.load = pe.measuring().load();
  sample.counts = pe.statistics();
  sample.n_ready = pe.ready().size();
  sample.n_epochs = pe.completion().n_epochs();
  const Machine& machine = pe.machine();
  if (pe.id() == machine.first_pe(machine.process())) sample.process_bytes = resident_memory();
  for (const HostedCollection* collection : pe.collections().all())
    sample.collections.push_back({collection->id(), collection->name(), collection->n_local()});
  return sample;
}

}  // namespace tess::detail
