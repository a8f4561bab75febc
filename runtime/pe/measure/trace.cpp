#include "runtime/pe/measure/trace.hpp"

#include "runtime/core/error.hpp"
#include "runtime/core/escape.hpp"
#include "runtime/core/registry.hpp"
#include "runtime/wire/messages/envelope.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fmt/core.h>
#include <limits>
#include <map>
#include <memory>
#include <unordered_map>
#include <utility>

namespace tess::detail {
namespace {

constexpr std::uint32_t most_numbers = Envelope::most_trace;

/// The number of an arrow, unique in the job.
std::uint64_t arrow(PeId source, std::uint32_t number) {
  return static_cast<std::uint64_t>(source.value) << 32U | number;
}

constexpr const char* of_runtime = "runtime";

/// The send of a slice's message; null if it is not among the records.
const Trace::Send* send_of(const std::vector<TraceOfPe>& pes, const Trace::Slice& slice) {
  const auto at = static_cast<std::size_t>(slice.source.value);
  return at < pes.size() ? pes[at].trace->send_of(slice.number) : nullptr;
}

class TraceWriter {
 public:
  TraceWriter(const std::string& path, const std::vector<TraceOfPe>& pes)
      : path_(path), pes_(pes), file_(std::fopen(path.c_str(), "w"), &std::fclose) {
    if (!file_) fail(ErrorCode::environment, "--trace ", path, ": the file cannot be written");
    put(R"({"displayTimeUnit":"ns","traceEvents":[)");
    for (const TraceOfPe& of : pes)
      for (const Trace::Slice& slice : of.trace->slices())
        if (is_users(slice)) shown_.push_back(arrow(slice.source, slice.number));
    std::sort(shown_.begin(), shown_.end());
  }

  void write() {
    for (const TraceOfPe& of : pes_) pe(of);
    put("\n]}\n");
    if (std::fflush(file_.get()) != 0)
      fail(ErrorCode::environment, "--trace ", path_, ": the file cannot be written whole");
  }

 private:
  void pe(const TraceOfPe& of) {
    if (of.process != process_) {
      process_ = of.process;
      entry(fmt::format(
          R"({{"ph":"M","name":"process_name","pid":{0},"args":{{"name":"process {0}"}}}})",
          process_.value));
    }
    entry(fmt::format(
        R"({{"ph":"M","name":"thread_name","pid":{},"tid":{},"args":{{"name":"PE {}"}}}})",
        process_.value, of.pe.value, of.pe.value));
    const std::vector<Trace::Slice>& slices = of.trace->slices();
    for (std::size_t i = 0; i < slices.size(); ++i) {
      const Trace::Slice& slice = slices[i];
      const double begin = of.seconds(slice.begin);
      if (is_users(slice)) {
        span(name_of(slice), of.pe, begin, of.seconds(slice.end),
             send_of(pes_, slice) ? flow("in", slice.source, slice.number) : "");
        continue;
      }
      double end = of.seconds(slice.end);
      for (; i + 1 < slices.size() && !is_users(slices[i + 1]) &&
             of.seconds(slices[i + 1].begin) - end <= of.pause;
           ++i)
        end = of.seconds(slices[i + 1].end);
      span(of_runtime, of.pe, begin, end, "");
    }
    for (const Trace::Send& send : of.trace->sends())
      if (const double at = of.seconds(send.at);
          std::binary_search(shown_.begin(), shown_.end(), arrow(of.pe, send.number)))
        span("send", of.pe, at, at, flow("out", of.pe, send.number));
    for (const Trace::Event& one : of.trace->events()) {
      const double begin = of.seconds(one.begin);
      if (one.begin == one.end)
        event("i", one.name, of.pe, begin, R"(,"s":"t")");
      else
        span(one.name, of.pe, begin, of.seconds(one.end), "");
    }
    if (of.trace->n_dropped() != 0)
      std::fprintf(stderr, "tessera: --trace %s: PE %d had %llu records more than fit\n",
                   path_.c_str(), of.pe.value,
                   static_cast<unsigned long long>(of.trace->n_dropped()));
  }

  [[nodiscard]] const std::string& name_of(const Trace::Slice& slice) {
    std::string& name = names_[slice.action];
    if (name.empty()) name = trace_name(slice.action);
    return name;
  }
  [[nodiscard]] bool is_users(const Trace::Slice& slice) { return name_of(slice) != of_runtime; }
  [[nodiscard]] static std::string flow(const char* direction, PeId source, std::uint32_t number) {
    return fmt::format(R"(,"bind_id":"0x{:x}","flow_{}":true)", arrow(source, number), direction);
  }
  void span(const std::string& name, PeId pe, double begin, double end, const std::string& more) {
    event("X", name, pe, begin, fmt::format(R"(,"dur":{:.3f}{})", 1e6 * (end - begin), more));
  }
  void event(const char* phase, const std::string& name, PeId pe, double at,
             const std::string& more) {
    entry(fmt::format(R"({{"ph":"{}","name":{},"pid":{},"tid":{},"ts":{:.3f}{}}})", phase,
                      json_string(name), process_.value, pe.value, 1e6 * at, more));
  }
  void entry(const std::string& text) { put(std::exchange(comma_, ",\n") + text); }
  void put(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size())
      fail(ErrorCode::environment, "--trace ", path_, ": the file cannot be written whole");
  }

  const std::string path_;
  const std::vector<TraceOfPe>& pes_;
  std::unordered_map<std::uint32_t, std::string> names_;  // by action
  std::vector<std::uint64_t> shown_;                      // arrows to slices of the user, sorted
  ProcessId process_{-1};
  std::string comma_ = "\n";
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

}  // namespace

std::string trace_name(std::uint32_t action) {
  const std::string_view name = Registry::at(action).name();
  if (plain_name(name) == "main_program") return "main program";
  return is_of_runtime(name) ? of_runtime : plain_name(name);
}

/// It finds, for each process, the least time from a send to the slice of its message, by the clocks
/// as they are, from process 0 and to it. The delays cancel out in half their difference. Counters of
/// like machines have one rate, more exactly than each process has measured it.
void align_clocks(std::vector<TraceOfPe>& pes) {
  for (TraceOfPe& pe : pes)
    if (const double rate = pes.front().seconds_per_tick;
        std::abs(pe.seconds_per_tick - rate) < 0.05 * rate)
      pe.seconds_per_tick = rate;
  constexpr double none = std::numeric_limits<double>::infinity();
  std::map<ProcessId, std::array<double, 2>> least;
  for (const TraceOfPe& to : pes)
    for (const Trace::Slice& slice : to.trace->slices()) {
      const Trace::Send* const send = send_of(pes, slice);
      if (send == nullptr) continue;
      const TraceOfPe& from = pes[static_cast<std::size_t>(slice.source.value)];
      const bool outwards = from.process == ProcessId{0};
      if (outwards == (to.process == ProcessId{0})) continue;
      const ProcessId other = outwards ? to.process : from.process;
      double& shortest = least.try_emplace(other, std::array{none, none}).first->second[outwards];
      shortest = std::min(shortest, to.seconds(slice.begin) - from.seconds(send->at));
    }
  for (TraceOfPe& pe : pes)
    if (const auto at = least.find(pe.process);
        at != least.end() && at->second[0] < none && at->second[1] < none)
      pe.late += (at->second[0] - at->second[1]) / 2;
}

std::uint32_t Trace::sent(std::uint64_t at) {
  n_sent_ = n_sent_ % most_numbers + 1;
  if (sends_.size() < most_) {
    const auto n = static_cast<std::uint32_t>(slices_.size());
    sends_.push_back({at, n_sent_, in_slice_ ? n : n == 0 ? no_slice : n - 1});
  } else {
    ++n_dropped_;
  }
  return n_sent_;
}

void Trace::ran(std::uint32_t action, std::uint64_t begin, std::uint64_t end, PeId source,
                std::uint32_t number) {
  in_slice_ = false;
  if (slices_.size() < most_) {
    slices_.push_back({begin, end, action, source, number, 0});
  } else {
    ++n_dropped_;
  }
}

void Trace::event(std::string name, std::uint64_t begin, std::uint64_t end) {
  if (events_.size() < most_) {
    events_.push_back({std::move(name), begin, end});
  } else {
    ++n_dropped_;
  }
}

void require_writable_trace(const std::string& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "w"),
                                                             &std::fclose);
  if (!file) fail(ErrorCode::environment, "--trace ", path, ": the file cannot be written");
}

void write_trace(const std::string& path, const std::vector<TraceOfPe>& pes) {
  TraceWriter(path, pes).write();
}

}  // namespace tess::detail
