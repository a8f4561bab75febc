#include "runtime/watch/monitor/sample.hpp"

#include "runtime/base/usable_memory.hpp"
#include "runtime/core/escape.hpp"
#include "runtime/pe/measure/idle_time.hpp"

#include <fmt/core.h>
#include <fstream>

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

std::string command_of_process() {
  std::ifstream file("/proc/self/cmdline");
  std::string program, command, word;
  for (bool hidden = false; std::getline(file, word, '\0');) {
    if (program.empty()) program = word.substr(word.rfind('/') + 1);
    constexpr std::string_view token = "--monitor-token";
    if (hidden) word = "…";
    hidden = word == token;
    if (word.starts_with(std::string(token) + '=')) word = std::string(token) + "=…";
    command += (command.empty() ? "" : " ") + word;
  }
  return fmt::format(R"({{"program":{},"command":{}}})", json_string(program),
                     json_string(command));
}

}  // namespace tess::detail
