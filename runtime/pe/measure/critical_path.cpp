#include "runtime/pe/measure/critical_path.hpp"

#include "runtime/wire/messages/envelope.hpp"

#include <algorithm>
#include <fmt/core.h>
#include <map>
#include <numeric>
#include <optional>

namespace tess::detail {
namespace {

/// A slice by its PE (the place in the list) and its number there.
struct At {
  std::size_t pe = 0, slice = 0;
};

class Walk {
 public:
  explicit Walk(const std::vector<TraceOfPe>& pes) : pes_(pes) {}

  [[nodiscard]] CriticalPath path() {
    CriticalPath path;
    std::optional<At> at = last();
    double until = at ? time(*at, slice(*at).end) : 0;
    while (at) {
      const Trace::Slice& here = slice(*at);
      const double begin = time(*at, here.begin);
      path.links.push_back({here.action, pes_[at->pe].pe, begin, until - begin, false});
      path.running += until - begin;
      const auto [cause, caused] = cause_of(*at, begin);
      if (cause) {
        path.links.push_back({here.action, pes_[at->pe].pe, caused, begin - caused, true});
        path.waiting += begin - caused;
      }
      at = cause;
      until = caused;
    }
    std::reverse(path.links.begin(), path.links.end());
    return path;
  }

 private:
  [[nodiscard]] const Trace::Slice& slice(At at) const {
    return pes_[at.pe].trace->slices()[at.slice];
  }
  [[nodiscard]] double time(At at, std::uint64_t ticks) const { return pes_[at.pe].seconds(ticks); }
  [[nodiscard]] std::optional<At> last() const {
    std::optional<At> best;
    double end = 0;
    for (std::size_t pe = 0; pe < pes_.size(); ++pe) {
      const auto& slices = pes_[pe].trace->slices();
      const auto users = std::find_if(slices.rbegin(), slices.rend(), [](const Trace::Slice& one) {
        return static_cast<const Action&>(Registry::at(one.action)).traffic == Traffic::user;
      });
      if (users == slices.rend()) continue;
      const At at{pe, static_cast<std::size_t>(slices.rend() - users) - 1};
      if (!best || time(at, slice(at).end) > end) {
        best = at;
        end = time(at, slice(at).end);
      }
    }
    return best;
  }

  struct Cause {
    std::optional<At> slice;
    double time = 0;
  };
  /// The slice that a slice waited for, and the time from which on it no longer did.
  [[nodiscard]] Cause cause_of(At at, double begin) const {
    Cause before;
    if (at.slice > 0) {
      const At last{at.pe, at.slice - 1};
      before = {last, std::min(time(last, slice(last).end), begin)};
      if (begin - before.time <= pes_[at.pe].pause) return before;
    }
    const Cause sent = sender_of(slice(at));
    return sent.slice ? sent : before;
  }
  /// The slice in which a message was sent, and when.
  [[nodiscard]] Cause sender_of(const Trace::Slice& of) const {
    const auto source = static_cast<std::size_t>(of.source.value);
    if (source >= pes_.size()) return {};
    const Trace& trace = *pes_[source].trace;
    const Trace::Send* const send = trace.send_of(of.number);
    if (send == nullptr || send->slice >= trace.slices().size()) return {};
    const At sender{source, send->slice};
    return {sender, time(sender, std::min(send->at, slice(sender).end))};
  }

  const std::vector<TraceOfPe>& pes_;
};

std::string milliseconds(double seconds) {
  return fmt::format("{:.6g} ms", 1e3 * seconds);
}

}  // namespace

CriticalPath critical_path(const std::vector<TraceOfPe>& pes) {
  return Walk(pes).path();
}

std::string describe(const CriticalPath& path, std::size_t n_longest) {
  const double all = path.running + path.waiting;
  std::string out = fmt::format("critical path: {} links, {}: {} in entry methods, {} of waiting",
                                path.links.size(), milliseconds(all), milliseconds(path.running),
                                milliseconds(path.waiting));
  struct Sum {
    double seconds = 0;
    std::size_t n = 0;
  };
  std::map<std::string, Sum> by_action;
  for (const auto& link : path.links) {
    if (link.waits) continue;
    Sum& sum = by_action[trace_name(link.action)];
    sum.seconds += link.seconds;
    ++sum.n;
  }
  std::vector<std::pair<std::string, Sum>> sorted(by_action.begin(), by_action.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return a.second.seconds > b.second.seconds;
  });
  for (std::size_t i = 0; i < std::min(sorted.size(), n_longest) && sorted[i].second.seconds > 0;
       ++i)
    out += fmt::format("\n  {:5.1f} % {}, {} times",
                       all > 0 ? 100 * sorted[i].second.seconds / all : 0, sorted[i].first,
                       sorted[i].second.n);
  std::vector<std::size_t> order(path.links.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::size_t n = std::min(n_longest, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(n), order.end(),
                    [&](std::size_t a, std::size_t b) {
                      const double x = path.links[a].seconds, y = path.links[b].seconds;
                      return x != y ? x > y : a < b;
                    });
  if (n > 0) out += "\n  its longest links:";
  for (std::size_t i = 0; i < n; ++i) {
    const auto& link = path.links[order[i]];
    out += fmt::format("\n    {:>13} {} on PE {}, at {}", milliseconds(link.seconds),
                       (link.waits ? "until the beginning of " : "in ") + trace_name(link.action),
                       link.pe.value, milliseconds(link.begin));
  }
  return out;
}

}  // namespace tess::detail
