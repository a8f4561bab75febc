#include "runtime/balance/rounds/pe_report.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

namespace tess::balance {
namespace {

void append(Snapshot& s, const PeReport& report, std::size_t pe) {
  Elements& e = s.elements;
  e.key.insert(e.key.end(), report.keys.begin(), report.keys.end());
  e.pe.insert(e.pe.end(), report.keys.size(), pe_at(pe));
  e.load.insert(e.load.end(), report.loads.begin(), report.loads.end());
  e.migratable.insert(e.migratable.end(), report.migratable.begin(), report.migratable.end());
  e.size_bytes.insert(e.size_bytes.end(), report.size_bytes.begin(), report.size_bytes.end());
  e.position.insert(e.position.end(), report.positions.begin(), report.positions.end());
  e.index.insert(e.index.end(), report.indices.begin(), report.indices.end());
}

}  // namespace

Snapshot snapshot_of(const std::vector<PeReport>& reports, const BalanceOptions& options) {
  Snapshot s;
  bool any_parcels = false;
  for (std::size_t pe = 0; pe < reports.size(); ++pe) {
    append(s, reports[pe], pe);
    s.pes.background.push_back(reports[pe].background);
    s.pes.speed.push_back(options.speeds.empty() ? 1 : options.speeds[pe]);
    s.pes.memory_limit_bytes.push_back(
        options.memory_limit_bytes.empty() ? 0 : options.memory_limit_bytes[pe]);
    any_parcels = any_parcels || !reports[pe].parcels.empty();
  }
  s.elements.memory_bytes = s.elements.size_bytes;
  // If one element gives no position, no position is used: a strategy needs all.
  if (s.elements.position.size() != s.elements.size()) s.elements.position.clear();
  if (!any_parcels) return s;
  boost::unordered_flat_map<ElementKey, std::size_t, ElementKeyHash> at;
  at.reserve(s.elements.size());
  for (std::size_t i = 0; i < s.elements.size(); ++i) at.emplace(s.elements.key[i], i);
  std::size_t first = 0;
  for (const PeReport& report : reports) {
    for (const Parcel& parcel : report.parcels)
      if (const auto to = at.find(parcel.to); to != at.end())
        s.edges.push_back({first + parcel.from, to->second, parcel.bytes, parcel.messages});
    first += report.keys.size();
  }
  return s;
}

}  // namespace tess::balance
