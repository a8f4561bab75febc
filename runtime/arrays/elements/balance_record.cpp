#include "runtime/arrays/elements/balance_record.hpp"

#include "runtime/arrays/elements/element.hpp"
#include "runtime/pe/pe.hpp"
#include "runtime/wire/messages/envelope.hpp"

namespace tess::detail {
namespace {

struct PackedEntry {
  std::uint32_t action = 0;
  std::uint32_t none = 0;
  double seconds = 0;
  std::uint64_t calls = 0;
};
struct PackedTraffic {
  ElementKey to;
  SentTo sent;
};

}  // namespace

void EndRecord::operator()(BalanceRecord* record) const {
  if (Pe* const pe = current_pe_or_null()) pe->measuring().forget(record->load);
  delete record;
}

void BalanceRecord::pack(Writer& ar, const Meter& meter) const {
  std::vector<PackedEntry> entries;
  for (const LoadRecord::MethodCost& entry : load.entries)
    entries.push_back({entry.action->id(), 0, meter.seconds(entry.ticks), entry.calls});
  std::vector<PackedTraffic> traffic;
  for (const auto& [to, sent] : load.sent.entries()) traffic.push_back({to, sent});
  ar(sync, past, size_bytes);
  ar(meter.seconds(load.in_run), meter.seconds(load.ticks), load.speed, load.since, entries,
     traffic);
}

void BalanceRecord::unpack(Reader& ar, const Meter& meter) {
  ar(sync, past, size_bytes);
  load.in_run = meter.ticks(ar.take<double>());
  load.ticks = meter.ticks(ar.take<double>());
  ar(load.speed, load.since);
  for (const PackedEntry& entry : ar.take<std::vector<PackedEntry>>())
    load.entries.push_back({&static_cast<const Action&>(Registry::at(entry.action)),
                            meter.ticks(entry.seconds), entry.calls});
  for (const PackedTraffic& one : ar.take<std::vector<PackedTraffic>>())
    load.sent.add(one.to, one.sent);
}

}  // namespace tess::detail
