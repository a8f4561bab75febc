#include "runtime/watch/monitor/monitor.hpp"

#include "runtime/core/escape.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/pe/pe_action.hpp"
#include "runtime/pe/runtime.hpp"
#include "runtime/watch/monitor/board.hpp"
#include "runtime/watch/monitor/pe_heat.hpp"
#include "runtime/watch/monitor/server.hpp"

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <unordered_set>
#include <utility>
#include <vector>

namespace tess::detail {
namespace {

using Clock = std::chrono::steady_clock;

/// A period begins on a PE, in which these heat maps are watched.
struct SampleAsked {
  std::vector<HeatQuery> heat;
  bool watched = false;  // browsers listen: pictures and entry methods are wanted
};
struct WindowEnds {};

/// The parts of pictures that a PE has sent since its last sample. It ends a period early once all
/// parts seem to be there: when for long each part that was shown had been sent. Every so many
/// samples it does not, for parts that are shown rarely.
class PartsOfPe {
 public:
  void begin_period(bool wanted) {
    sent_.clear();
    n_again_ = 0;
    ++n_periods_;
    open_ = wanted;
  }
  [[nodiscard]] bool wants(std::string_view name, std::uint64_t part) {
    if (!open_) return false;
    if (sent_.insert(mix(std::hash<std::string_view>()(name)) ^ mix(part)).second) {
      n_again_ = 0;
      return true;
    }
    if (++n_again_ > 3 * sent_.size() && n_periods_ % whole_period != 0) open_ = false;
    return false;
  }

 private:
  static constexpr std::uint64_t whole_period = 16;

  bool open_ = false;
  std::unordered_set<std::uint64_t> sent_;  // hashes
  std::size_t n_again_ = 0;                 // shown since the last new one
  std::uint64_t n_periods_ = 0;
};

/// A report of what waits, which the service's thread makes. It may come after the monitor's end.
struct Reported {
  std::mutex mutex;
  std::optional<std::string> text;
};

bool is_on_process_0(Pe& pe) {
  return pe.machine().process().value == 0;
}

// The messages of the monitor; they call its loop, which is below.
void heat_arrives(Pe& pe, HeatCells&& part);
void window_ends(Pe& pe, WindowEnds&& ends);
void sample_is_asked(Pe& pe, SampleAsked&& asked);
void sample_arrives(Pe& pe, PeSample&& sample);
void part_arrives(Pe& pe, PicturePart&& part);
void note_arrives(Pe& pe, BalanceNote&& note);

/// Passes a payload to its handler on process 0; there at once.
template <auto Handler>
void to_process_0(Pe& pe, typename PeAction<Handler>::Payload&& payload) {
  if (is_on_process_0(pe))
    Handler(pe, std::move(payload));
  else
    send_uncounted<Handler>(pe, PeId{0}, std::move(payload));
}

}  // namespace

class Monitor::Loop {
 public:
  Loop(Runtime& runtime, const MonitorOptions& options)
      : runtime_(runtime),
        machine_(runtime.machine()),
        period_(std::chrono::milliseconds(options.period_ms)),
        began_(Clock::now()),
        of_pes_(static_cast<std::size_t>(machine_.n_pes_here())) {
    if (machine_.process().value != 0) return;
    asked_.resize(static_cast<std::size_t>(machine_.n_pes()));
    serve(options);
    timer_.expires_after(period_);
    wait();
    thread_ = std::thread([this] { io_.run(); });
  }
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;
  ~Loop() {
    io_.stop();
    if (thread_.joinable()) thread_.join();
  }

  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }

  // On the thread of a PE, for that PE.

  void begin_period(Pe& pe, const SampleAsked& asked) {
    OfPe& of = of_pe(pe.id());
    of.parts.begin_period(asked.watched);
    const bool measures = asked.watched || !asked.heat.empty();
    if (!of.heat && !measures) return;
    if (!of.heat) of.heat = std::make_unique<PeHeat>(pe);
    report_heat(pe, of.heat->begin(asked.heat, asked.watched));
    if (!measures) of.heat.reset();
    if (!of.heat || !of.heat->window_is_open() || machine_.virtual_time()) return;
    auto* const message = make_message<&window_ends>(pe, WindowEnds{});
    message->source = pe.id();
    message->counted = false;
    pe.post_after(std::max<Time>(period_ / 200, std::chrono::milliseconds(1)), message);
  }
  void end_heat_window(Pe& pe) {
    if (auto& heat = of_pe(pe.id()).heat) report_heat(pe, heat->end_window());
  }
  void give_entries(PeSample& sample) {
    if (const auto& heat = of_pe(sample.pe).heat) heat->give_entries(sample);
  }
  [[nodiscard]] bool wants_part(const Pe& pe, std::string_view name, std::uint64_t part) {
    return of_pe(pe.id()).parts.wants(name, part);
  }

  // On process 0, on the thread of a PE.

  /// PE 0 asks the PEs of other processes.
  void ask_others(Pe& pe, const SampleAsked& question) {
    std::vector<PeId> others;
    {
      const std::lock_guard lock(mutex_);
      for (std::int32_t to = machine_.n_pes_here(); to < machine_.n_pes(); ++to)
        if (mark_asked(PeId{to})) others.push_back(PeId{to});
    }
    for (const PeId to : others) send_uncounted<&sample_is_asked>(pe, to, question);
  }
  void arrived(PeSample&& sample) {
    const std::lock_guard lock(mutex_);
    asked_.at(static_cast<std::size_t>(sample.pe.value)) = false;
    board_->arrived(std::move(sample));
  }
  void take(HeatCells&& part) {
    const std::lock_guard lock(mutex_);
    board_->take(std::move(part));
  }
  void draw(const PicturePart& part) {
    const std::lock_guard lock(mutex_);
    if (!board_->draw(part) && !std::exchange(said_left_out_, true))
      runtime_.error_line(text("tessera: show(\"", part.name, "\"): the page has its ",
                               Board::most_pictures,
                               " pictures; this and later ones are left out"));
  }
  void note(const BalanceNote& note) {
    const std::lock_guard lock(mutex_);
    board_->note(note);
  }

 private:
  struct OfPe {
    PartsOfPe parts;
    std::unique_ptr<PeHeat> heat;  // while a browser watches
  };

  static void report_heat(Pe& pe, std::vector<HeatCells>&& parts) {
    for (HeatCells& part : parts) to_process_0<&heat_arrives>(pe, std::move(part));
  }
  [[nodiscard]] OfPe& of_pe(PeId pe) {
    const PeId first = machine_.first_pe(machine_.process());
    return of_pes_.at(static_cast<std::size_t>(pe.value - first.value));
  }
  /// Marks that a PE is asked; false if it has not answered the last question yet. Under the lock.
  [[nodiscard]] bool mark_asked(PeId pe) {
    auto asked = asked_.at(static_cast<std::size_t>(pe.value));
    const bool waits = asked;
    asked = true;
    return !waits;
  }

  void serve(const MonitorOptions& options) {
    board_.emplace(machine_);
    Server::Source source;
    source.past = [this, command = command_of_process()](const Topic& topic) {
      const std::lock_guard lock(mutex_);
      std::vector<Event> past = board_->past(topic);
      if (!topic) past.insert(past.begin(), {"run", command});
      return past;
    };
    source.ask_report = [this] {
      runtime_.service().report_job([reported = reported_](std::string&& text) {
        const std::lock_guard lock(reported->mutex);
        reported->text = std::move(text);
      });
    };
    server_.emplace(io_, options, std::move(source));
    const bool six = options.address.find(':') != std::string::npos;  // IPv6: [::1]
    runtime_.error_line(text("tessera: monitor on http://", six ? "[" : "", options.address,
                             six ? "]" : "", ":", server_->port(), "/",
                             options.token.empty() ? "" : "?token=…"));
  }

  // On the thread of the monitor.

  void wait() {
    timer_.async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      ask();
      publish();
      timer_.expires_at(std::max(timer_.expiry() + period_, Clock::now()));
      wait();
    });
  }
  void ask() {
    const std::lock_guard lock(mutex_);
    if (closed_) return;
    board_->watch_heat(server_->watched());
    const SampleAsked question{board_->heat_queries(), server_->has_listeners()};
    for (std::int32_t i = 0; i < machine_.n_pes_here(); ++i)
      if (const PeId to{i}; mark_asked(to))
        machine_.hand_in(to, make_outside<&sample_is_asked>(to, question));
  }
  void publish() {
    std::vector<Event> events;
    {
      const std::lock_guard lock(mutex_);
      if (closed_) return;
      events = board_->take_events(
          std::chrono::duration<double>(Clock::now() - began_).count(), [this](PeId pe) {
            if (machine_.process_of(pe).value != 0 && machine_.n_pes_here() != machine_.n_pes())
              return std::string();
            const Action* action = runtime_.pe(pe).running();
            return action != nullptr ? plain_name(action->name()) : std::string();
          });
    }
    {
      const std::lock_guard lock(reported_->mutex);
      if (reported_->text) events.push_back({"report", json_string(*reported_->text)});
      reported_->text.reset();
    }
    server_->publish(events);
  }

  Runtime& runtime_;
  Machine& machine_;
  const Clock::duration period_;
  const Clock::time_point began_;
  const std::shared_ptr<Reported> reported_ = std::make_shared<Reported>();
  std::vector<OfPe> of_pes_;  // of this process; each is used by its PE only
  std::mutex mutex_;          // guards what follows
  bool closed_ = false;
  // On process 0.
  std::vector<bool> asked_;  // by PE of the job: it has not answered yet
  std::optional<Board> board_;
  bool said_left_out_ = false;  // pictures
  boost::asio::io_context io_{1};
  boost::asio::steady_timer timer_{io_};
  std::optional<Server> server_;
  std::thread thread_;
};

namespace {

Monitor::Loop& loop_of(Pe& pe) {
  return static_cast<Monitor&>(*pe.runtime().monitor()).loop();
}

void heat_arrives(Pe& pe, HeatCells&& part) {
  loop_of(pe).take(std::move(part));
}
void window_ends(Pe& pe, WindowEnds&& /*ends*/) {
  if (!pe.stopped()) loop_of(pe).end_heat_window(pe);
}
void sample_is_asked(Pe& pe, SampleAsked&& asked) {
  if (pe.stopped()) return;
  Monitor::Loop& loop = loop_of(pe);
  if (pe.id().value == 0) loop.ask_others(pe, asked);
  loop.begin_period(pe, asked);
  PeSample sample = sample_of(pe);
  loop.give_entries(sample);
  to_process_0<&sample_arrives>(pe, std::move(sample));
}
void sample_arrives(Pe& pe, PeSample&& sample) {
  loop_of(pe).arrived(std::move(sample));
}
void part_arrives(Pe& pe, PicturePart&& part) {
  loop_of(pe).draw(part);
}
void note_arrives(Pe& pe, BalanceNote&& note) {
  loop_of(pe).note(note);
}

}  // namespace

Monitor::Monitor(Runtime& runtime, const MonitorOptions& options)
    : loop_(std::make_unique<Loop>(runtime, options)) {
  runtime.watch(*this);
}
Monitor::~Monitor() = default;

void Monitor::balanced(Pe& pe, BalanceNote note) {
  to_process_0<&note_arrives>(pe, std::move(note));
}
void Monitor::close() {
  loop_->close();
}
bool Monitor::wants_part(const Pe& pe, std::string_view name, std::uint64_t part) {
  return loop_->wants_part(pe, name, part);
}

void Monitor::draw(Pe& pe, PicturePart part) {
  to_process_0<&part_arrives>(pe, std::move(part));
}

namespace {
std::unique_ptr<ProcessMonitor> serve_page(Runtime& runtime, const MonitorOptions& options) {
  return std::make_unique<Monitor>(runtime, options);
}
}  // namespace

// Before main(): the program that links this library offers --monitor.
extern "C" {
extern const bool tess_live_view_is_linked;  // the linker is asked for it (CMakeLists.txt)
const bool tess_live_view_is_linked = (make_monitor = &serve_page, true);
}

}  // namespace tess::detail
