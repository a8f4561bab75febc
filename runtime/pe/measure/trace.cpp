#include "runtime/pe/measure/trace.hpp"

#include "runtime/core/error.hpp"
#include "runtime/core/escape.hpp"
#include "runtime/wire/messages/envelope.hpp"

#include <cstdio>
#include <fmt/core.h>
#include <memory>
#include <utility>

namespace tess::detail {
namespace {

constexpr std::uint32_t most_numbers = Envelope::most_trace;

/// The number of an arrow, unique in the job.
std::uint64_t arrow(PeId source, std::uint32_t number) {
  return static_cast<std::uint64_t>(source.value) << 32U | number;
}

class TraceWriter {
 public:
  TraceWriter(const std::string& path, ProcessId process)
      : path_(path), process_(process), file_(std::fopen(path.c_str(), "w"), &std::fclose) {
    if (!file_) fail(ErrorCode::environment, "--trace ", path, ": the file cannot be written");
    put("{\"displayTimeUnit\":\"ns\",\"traceEvents\":[\n");
    put(
        fmt::format("{{\"ph\":\"M\",\"name\":\"process_name\",\"pid\":{},\"args\":{{\"name\":"
                    "\"process {}\"}}}}",
                    process_.value, process_.value));
  }

  void pe(const TraceOfPe& of) {
    put(
        fmt::format(",\n{{\"ph\":\"M\",\"name\":\"thread_name\",\"pid\":{},\"tid\":{},\"args\":{{"
                    "\"name\":\"PE {}\"}}}}",
                    process_.value, of.pe.value, of.pe.value));
    for (const Trace::Slice& slice : of.trace->slices()) {
      const double begin = micros(of, slice.begin);
      event("X", plain_name(slice.action->name()), of.pe, begin,
            fmt::format(",\"dur\":{:.3f}", micros(of, slice.end) - begin));
      if (slice.number != 0)
        event("f", "message", of.pe, begin,
              fmt::format(R"(,"bp":"e","cat":"m","id":{})", arrow(slice.source, slice.number)));
    }
    for (const Trace::Send& send : of.trace->sends())
      event("s", "message", of.pe, micros(of, send.at),
            fmt::format(R"(,"cat":"m","id":{})", arrow(of.pe, send.number)));
    for (const Trace::Event& one : of.trace->events()) {
      const double begin = micros(of, one.begin);
      if (one.begin == one.end) {
        event("i", one.name, of.pe, begin, R"(,"s":"t")");
      } else {
        event("X", one.name, of.pe, begin,
              fmt::format(",\"dur\":{:.3f}", micros(of, one.end) - begin));
      }
    }
    if (of.trace->n_dropped() != 0)
      std::fprintf(stderr, "tessera: --trace %s: PE %d had %llu records more than fit\n",
                   path_.c_str(), of.pe.value,
                   static_cast<unsigned long long>(of.trace->n_dropped()));
  }

  void end() {
    put("\n]}\n");
    if (std::fflush(file_.get()) != 0)
      fail(ErrorCode::environment, "--trace ", path_, ": the file cannot be written whole");
  }

 private:
  [[nodiscard]] static double micros(const TraceOfPe& of, std::uint64_t ticks) {
    return 1e6 * of.seconds_per_tick * static_cast<double>(ticks - of.origin);
  }
  void event(const char* phase, const std::string& name, PeId pe, double at,
             const std::string& more) {
    put(fmt::format(",\n{{\"ph\":\"{}\",\"name\":{},\"pid\":{},\"tid\":{},\"ts\":{:.3f}{}}}", phase,
                    json_string(name), process_.value, pe.value, at, more));
  }
  void put(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size())
      fail(ErrorCode::environment, "--trace ", path_, ": the file cannot be written whole");
  }

  const std::string path_;
  const ProcessId process_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

}  // namespace

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

void Trace::ran(const Action* action, std::uint64_t begin, std::uint64_t end, PeId source,
                std::uint32_t number) {
  in_slice_ = false;
  if (slices_.size() < most_) {
    slices_.push_back({action, begin, end, source, number});
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

void write_trace(const std::string& path, ProcessId process, const std::vector<TraceOfPe>& pes) {
  TraceWriter write(path, process);
  for (const TraceOfPe& pe : pes) write.pe(pe);
  write.end();
}

}  // namespace tess::detail
