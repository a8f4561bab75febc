#include "runtime/watch/monitor/pe_heat.hpp"

#include "runtime/core/cpu_clock.hpp"

#include <algorithm>
#include <tuple>

namespace tess::detail {
namespace {

constexpr std::size_t most_scopes = 8192;  // in a window; the PEs of a simulated machine share more
constexpr std::size_t least_scopes = 64;
constexpr double shortest_window = 1e-3;     // seconds: shares of shorter ones would mislead
constexpr std::size_t most_counted = 65536;  // elements of a process in a period
constexpr std::size_t least_counted = 64;    // of a PE
constexpr std::size_t counted_first = 1024;  // of a PE, until its first pass is over
constexpr double long_seconds = 20e-6;       // a stretch of code so long may have been interrupted
constexpr double cpu_again_seconds = 1e-4;   // the thread's clock costs up to microseconds

}  // namespace

std::vector<HeatCells> PeHeat::begin(const std::vector<HeatQuery>& queries, bool entries_too) {
  std::vector<HeatCells> out;
  if (open_) out = close_window();
  watch(queries);
  bool by_load = entries_too;
  for (auto& [query, map] : maps_) {
    if (query.map.by == HeatBy::load) {
      by_load = true;
    } else if (count(query, map)) {
      out.push_back(map.sent);
    }
  }
  if (by_load) begin_window();
  return out;
}

void PeHeat::watch(const std::vector<HeatQuery>& queries) {
  std::erase_if(maps_, [&](const auto& one) {
    return std::find(queries.begin(), queries.end(), one.first) == queries.end() ||
           pe_.collections().find(one.first.map.array) == nullptr;
  });
  for (const HeatQuery& query : queries) {
    const HostedCollection* collection = pe_.collections().find(query.map.array);
    if (collection != nullptr) maps_.try_emplace(query, collection->range());
  }
}

void PeHeat::begin_window() {
  Meter& meter = pe_.measuring().start_brief_meter();
  open_ = listens_ = true;
  spent_.clear();
  running_ = {};
  cpu_at_ = 0;
  const auto n_pes_here = static_cast<std::size_t>(pe_.machine().n_pes_here());
  most_scopes_ = pe_.machine().virtual_time() ? std::max(least_scopes, 8 * most_scopes / n_pes_here)
                                              : most_scopes;
  began_ = meter.now();
  meter.set_listener(this);
}

void PeHeat::stop_metering() {
  if (!open_) return;
  open_ = listens_ = false;
  if (pe_.meter() == nullptr) return;
  pe_.meter()->set_listener(nullptr);
  pe_.measuring().stop_brief_meter();
}

void PeHeat::changed(std::uint64_t at) {
  if (running_.action != nullptr) add(at - since_);
  running_ = {};
  if (spent_.size() >= most_scopes_) {
    ended_ = at;
    listens_ = false;  // the meter goes on until the window is closed, outside of any scope
    pe_.meter()->set_listener(nullptr);
    return;
  }
  const Element* element = pe_.context().element;
  if (element == nullptr) return;
  running_.action = pe_.context().action;
  since_ = pe_.meter()->now();
  if (!pe_.machine().virtual_time() &&
      (cpu_at_ == 0 || pe_.meter()->seconds(since_ - cpu_at_) > cpu_again_seconds)) {
    cpu_seen_ = thread_cpu_seconds();
    cpu_at_ = since_ = pe_.meter()->now();
  }
  for (auto& [query, map] : maps_) {
    if (query.map.by != HeatBy::load) continue;
    const HostedCollection* collection = pe_.collections().find(query.map.array);
    const std::int64_t rank = collection != nullptr ? collection->rank_of(*element) : -1;
    if (rank < 0) continue;
    running_.map = &map;
    running_.cell = map.grid.cell_of(rank);
    return;
  }
}

void PeHeat::add(std::uint64_t ticks) {
  if (pe_.machine().virtual_time()) {
    // It may charge for messages instead of the time of their code.
    ticks += static_cast<std::uint64_t>(pe_.machine().message_cost().count());
  } else if (const Meter& meter = *pe_.meter(); meter.seconds(ticks) > long_seconds) {
    // Another thread may have had the core.
    const std::uint64_t before = since_ - cpu_at_,
                        ran = meter.ticks(thread_cpu_seconds() - cpu_seen_);
    ticks = std::min(ticks, ran - std::min(ran, before));
  }
  const auto key = [](const Spent& of) { return std::tuple(of.map, of.cell, of.action); };
  if (spent_.empty() || key(spent_.back()) != key(running_)) spent_.push_back(running_);
  spent_.back().ticks += ticks;
}

std::vector<HeatCells> PeHeat::end_window() {
  if (!open_) return {};
  const bool is_short =
      spent_.empty() || pe_.meter()->seconds(pe_.meter()->now() - began_) < shortest_window;
  if (listens_ && is_short) return {};
  return close_window();
}

std::vector<HeatCells> PeHeat::close_window() {
  if (listens_) ended_ = pe_.meter()->now();
  stop_metering();
  std::vector<HeatCells> out;
  const double passed = std::max(1.0, static_cast<double>(ended_ - began_));
  std::sort(spent_.begin(), spent_.end(), [](const Spent& a, const Spent& b) {
    return std::pair(a.map, a.cell) < std::pair(b.map, b.cell);
  });
  for (auto& [query, map] : maps_) {
    if (query.map.by != HeatBy::load) continue;
    HeatCells& part = out.emplace_back();
    part.of = query;
    part.pe = pe_.id();
    part.range = map.range;
    for (const Spent& one : spent_) {
      if (one.map != &map) continue;
      if (part.cells.empty() || part.cells.back() != one.cell) {
        part.cells.push_back(one.cell);
        part.values.push_back(0);
      }
      part.values.back() += static_cast<float>(static_cast<double>(one.ticks) / passed);
    }
  }
  entries_.clear();
  measured_ = true;
  for (const Spent& one : spent_) {
    const auto at = std::find_if(entries_.begin(), entries_.end(),
                                 [&](const auto& entry) { return entry.first == one.action; });
    auto& entry = at != entries_.end() ? *at : entries_.emplace_back(one.action, 0);
    entry.second += static_cast<double>(one.ticks) / passed;
  }
  spent_.clear();
  return out;
}

void PeHeat::give_entries(PeSample& sample) {
  sample.measured = std::exchange(measured_, false);
  for (const auto& [action, part] : std::exchange(entries_, {}))
    sample.entries.push_back({plain_name(action->name()), part});
}

bool PeHeat::count(const HeatQuery& query, Map& map) {
  const HostedCollection& collection = *pe_.collections().find(query.map.array);
  const std::vector<Element*>& elements = collection.elements();
  const auto n_pes_here = static_cast<std::size_t>(pe_.machine().n_pes_here());
  // The PEs of a simulated machine share a thread, and may answer rarely.
  const std::size_t least = map.sent.cells.empty() ? counted_first : least_counted;
  const std::size_t most =
      pe_.machine().virtual_time() ? std::max(least, most_counted / n_pes_here) : most_counted;
  const std::size_t end = std::min(elements.size(), map.next + most);
  std::uint32_t last_cell = 0;
  std::uint32_t* counter = nullptr;  // neighbours are mostly in one cell
  for (; map.next < end; ++map.next) {
    const Element* element = elements[map.next];
    const std::int64_t rank = element != nullptr ? collection.rank_of(*element) : -1;
    if (rank < 0) continue;
    const std::uint32_t cell = map.grid.cell_of(rank);
    if (counter == nullptr || cell != last_cell) counter = &map.counts[cell];
    last_cell = cell;
    ++*counter;
  }
  if (map.next < elements.size()) return false;

  map.next = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> sorted(map.counts.begin(), map.counts.end());
  map.counts.clear();
  std::sort(sorted.begin(), sorted.end());
  HeatCells found{query, pe_.id(), map.range, {}, {}};
  for (const auto& [cell, n] : sorted) {
    found.cells.push_back(cell);
    found.values.push_back(static_cast<float>(n));
  }
  if (found.cells == map.sent.cells && found.values == map.sent.values) return false;
  map.sent = std::move(found);
  return true;
}

}  // namespace tess::detail
