#include "runtime/watch/monitor/board.hpp"

#include "runtime/core/escape.hpp"
#include "runtime/pe/runtime.hpp"
#include "runtime/watch/monitor/level.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <fmt/format.h>
#include <limits>
#include <utility>

namespace tess::detail {
namespace {

constexpr std::size_t most_past = 600;  // frames and rounds: five minutes
constexpr std::size_t most_pixels = 1 << 20;
constexpr std::size_t most_entries = 16;  // in a frame

/// Values as text for JSON: the grey levels between `least` and `most`.
std::string as_levels(const std::vector<float>& values, float least, float most) {
  std::string out;
  out.reserve(2 * values.size());
  // In double: a range of floats may be below or above the range of float.
  const double low = least, scale = most > least ? 255 / (double{most} - low) : 0;
  for (const float value : values)
    add_level(out, std::isfinite(value) ? std::lround((double{value} - low) * scale) : 0);
  return out;
}

}  // namespace

Board::Board(const Machine& machine)
    : n_pes_(machine.n_pes()),
      n_processes_(machine.n_processes()),
      virtual_time_(machine.virtual_time()),
      pes_(static_cast<std::size_t>(machine.n_pes())) {}

void Board::arrived(PeSample sample) {
  OfPe& of = pes_.at(static_cast<std::size_t>(sample.pe.value));
  // Of two samples in one period the frame shows the sum.
  if (!of.is_new) of.before = std::move(of.last);
  of.last = std::move(sample);
  of.is_new = true;
}

void Board::note(const BalanceNote& note) {
  new_rounds_.push_back(
      fmt::format(R"({{"t":{:.3f},"text":{},"before":{:.4g},"predicted":{:.4g}}})", seconds_,
                  json_string(note.text), note.before, note.predicted));
}

bool Board::draw(const PicturePart& part) {
  const auto n_pixels =
      static_cast<std::size_t>(part.width) * static_cast<std::size_t>(part.height);
  if (part.columns <= 0 || n_pixels > most_pixels) return true;
  if (!pictures_.contains(part.name) && pictures_.size() == most_pictures) return false;
  Picture& picture = pictures_[part.name];
  if (picture.width != part.width || picture.height != part.height)
    picture = Picture{part.width, part.height,
                      std::vector<float>(n_pixels, std::numeric_limits<float>::quiet_NaN()), false};
  for (std::size_t i = 0; i < part.values.size(); ++i) {
    const std::int32_t x = part.x + static_cast<std::int32_t>(i) % part.columns;
    const std::int32_t y = part.y + static_cast<std::int32_t>(i) / part.columns;
    if (x < part.width && y < part.height)
      picture.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(part.width) +
                     static_cast<std::size_t>(x)] = part.values[i];
  }
  picture.changed = true;
  return true;
}

std::vector<Event> Board::take_events(double seconds,
                                      const std::function<std::string(PeId)>& runs) {
  seconds_ = seconds;
  std::vector<Event> events;
  for (std::string& round : std::exchange(new_rounds_, {}))
    events.push_back({"round", std::move(round)});
  events.push_back({"frame", frame(seconds, runs)});
  past_.insert(past_.end(), events.begin(), events.end());
  while (past_.size() > most_past) past_.pop_front();
  for (auto& [name, picture] : pictures_) {
    if (std::exchange(picture.changed, false)) events.push_back(event_of(name, picture));
  }
  for (auto& [id, heat] : heat_) {
    if (auto event = heat.map.take_event(name_of(id.array)))
      events.push_back({"heat", std::move(*event), id});
  }
  return events;
}

std::vector<Event> Board::past(const Topic& topic) const {
  if (topic) {
    const auto at = heat_.find(*topic);
    if (at == heat_.end() || at->second.map.last_event().empty()) return {};
    return {{"heat", at->second.map.last_event(), topic}};
  }
  std::vector<Event> events(past_.begin(), past_.end());
  for (const auto& [name, picture] : pictures_) events.push_back(event_of(name, picture));
  return events;
}

void Board::watch_heat(const std::vector<HeatMapId>& watched) {
  std::erase_if(heat_, [&](const auto& one) {
    return std::find(watched.begin(), watched.end(), one.first) == watched.end();
  });
  for (const HeatMapId& id : watched)
    if (!heat_.contains(id)) heat_.emplace(id, WatchedHeat{++n_watches_, {id.by, n_pes_}});
}

std::vector<HeatQuery> Board::heat_queries() const {
  std::vector<HeatQuery> queries;
  for (const auto& [id, heat] : heat_) queries.push_back({id, heat.watch});
  return queries;
}

void Board::take(HeatCells&& part) {
  const auto at = heat_.find(part.of.map);
  if (at != heat_.end() && at->second.watch == part.of.watch) at->second.map.take(std::move(part));
}

std::string Board::name_of(CollectionId id) const {
  for (const OfPe& of : pes_)
    for (const CollectionSample& here : of.last.collections)
      if (here.id == id) return here.name;
  return {};
}

std::string Board::frame(double seconds, const std::function<std::string(PeId)>& runs) {
  std::vector<int> busy, rates, queues;
  std::vector<std::uint64_t> memory;
  std::uint64_t n_epochs = 0, n_migrations = 0, n_bytes = 0;
  double latest = 0, n_measured = 0;
  std::string late;
  const bool passes_on = n_processes_ > 1 && pes_.front().is_new;
  for (OfPe& of : pes_) {
    const PeSample& now = of.last;
    const auto passed = static_cast<double>(now.at_ns - of.before.at_ns);
    const auto idle = static_cast<double>(now.idle_ns - of.before.idle_ns);
    if (of.is_new && passed > 0) {
      const auto ran = static_cast<double>(now.counts.messages - of.before.counts.messages);
      of.percent = static_cast<int>(std::lround(std::clamp(100 * (1 - idle / passed), 0.0, 100.0)));
      of.rate = std::min(ran * 1e9 / passed, 2e9);
    }
    if (of.is_new)
      of.n_missed = 0;
    else if (passes_on)
      ++of.n_missed;
    of.runs.clear();
    if (!of.is_new) {  // perhaps it runs something long
      const auto index = static_cast<std::int32_t>(&of - pes_.data());
      std::string action = runs(PeId{index});
      // Samples of other processes come through PE 0.
      if (action.empty() && passes_on && of.n_missed > 1) action = "something long";
      if (!action.empty()) {
        of.percent = 100;
        of.rate = 0;
        late += fmt::format("{}[{},{}]", late.empty() ? "" : ",", index, json_string(action));
        of.runs = std::move(action);
      }
    }
    of.is_new = false;
    n_measured += now.measured || !of.runs.empty() ? 1 : 0;
    busy.push_back(of.percent);
    rates.push_back(static_cast<int>(of.rate));
    queues.push_back(static_cast<int>(std::min<std::uint64_t>(now.n_ready, 2'000'000'000)));
    if (now.process_bytes != 0) memory.push_back(now.process_bytes);
    n_epochs = std::max(n_epochs, now.n_epochs);  // all PEs that took part know an epoch
    n_migrations += now.counts.migrations;
    n_bytes += now.counts.bytes_sent;
    latest = std::max(latest, static_cast<double>(now.at_ns) * 1e-9);
  }
  std::string out =
      fmt::format(R"({{"t":{:.3f},"pes":{},"processes":{},"epochs":{},"migrations":{},"bytes":{},)",
                  seconds, n_pes_, n_processes_, n_epochs, n_migrations, n_bytes);
  if (virtual_time_) out += fmt::format(R"("virtual":{:.9g},)", latest);
  std::vector<PeLoad> loads;
  for (const OfPe& of : pes_) loads.push_back(of.last.load);
  out += "\"limits\":" + json_string(tess::describe(summarise(loads))) + ",";
  out += fmt::format(R"("busy":[{}],"rate":[{}],"queue":[{}],"memory":[{}],"late":[{}],)",
                     fmt::join(busy, ","), fmt::join(rates, ","), fmt::join(queues, ","),
                     fmt::join(memory, ","), late);
  out += fmt::format(R"("measured":{:.4g},)", n_measured / n_pes_);  // part of the PEs' time
  return out + "\"entries\":[" + entries() + "],\"collections\":[" + collections() + "]}";
}

/// The parts of the time of all PEs that entry methods take, the greatest first.
std::string Board::entries() const {
  std::map<std::string, double> sums;
  for (const OfPe& of : pes_) {
    if (!of.runs.empty()) {
      sums[of.runs] += 1;
      continue;
    }
    for (const EntrySample& entry : of.last.entries) sums[entry.name] += entry.part;
  }
  std::vector<std::pair<std::string, double>> sorted(sums.begin(), sums.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  sorted.resize(std::min(sorted.size(), most_entries));
  std::string out;
  for (const auto& [name, sum] : sorted)
    out += fmt::format("{}[{},{:.4g}]", out.empty() ? "" : ",", json_string(name),
                       sum / static_cast<double>(n_pes_));
  return out;
}

std::string Board::collections() const {
  struct Sum {
    std::string name;
    std::uint64_t all = 0, least = ~std::uint64_t{0}, most = 0;
    std::size_t n_pes = 0;
  };
  std::map<CollectionId, Sum> sums;
  for (const OfPe& of : pes_) {
    for (const CollectionSample& here : of.last.collections) {
      Sum& sum = sums[here.id];
      sum.name = here.name;
      sum.all += here.n_local;
      sum.least = std::min(sum.least, here.n_local);
      sum.most = std::max(sum.most, here.n_local);
      ++sum.n_pes;
    }
  }
  std::string out;
  for (const auto& [id, sum] : sums)
    out += fmt::format(R"({}{{"id":"{:x}","name":{},"n":{},"least":{},"most":{}}})",
                       out.empty() ? "" : ",", id.value, json_string(sum.name), sum.all,
                       sum.n_pes < pes_.size() ? 0 : sum.least, sum.most);
  return out;
}

Event Board::event_of(const std::string& name, const Picture& picture) {
  float least = std::numeric_limits<float>::infinity(), most = -least;
  for (const float value : picture.values) {
    if (!std::isfinite(value)) continue;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  if (least > most) least = most = 0;
  return {"picture",
          fmt::format(
              R"({{"name":{},"width":{},"height":{},"least":{:.6g},"most":{:.6g},"values":"{}"}})",
              json_string(name), picture.width, picture.height, least, most,
              as_levels(picture.values, least, most))};
}

}  // namespace tess::detail
