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

struct SampleAsked {
  std::vector<HeatQuery> heat;
};
struct WindowEnds {};
/// Process 0 tells the others which heat maps are watched, and whether pictures are.
struct HeatWanted {
  std::uint64_t version = 0;  // newer ones are greater
  std::vector<HeatQuery> queries;
  bool pictures = false;
};

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
void heat_is_wanted(Pe& pe, HeatWanted&& wanted);
void heat_arrives(Pe& pe, HeatCells&& part);
void window_ends(Pe& pe, WindowEnds&& ends);
void sample_is_asked(Pe& pe, SampleAsked&& asked);
void sample_arrives(Pe& pe, PeSample&& sample);
void part_arrives(Pe& pe, PicturePart&& part);
void note_arrives(Pe& pe, BalanceNote&& note);

}  // namespace

class Monitor::Loop {
 public:
  Loop(Runtime& runtime, const MonitorOptions& options)
      : runtime_(runtime),
        machine_(runtime.machine()),
        period_(std::chrono::milliseconds(options.period_ms)),
        began_(Clock::now()),
        of_pes_(static_cast<std::size_t>(machine_.n_pes_here())) {
    if (machine_.process().value == 0) serve(options);
    timer_.expires_after(period_);
    wait();
    thread_ = std::thread([this] { io_.run(); });
  }
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;
  ~Loop() {
    io_.stop();
    thread_.join();
  }

  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  /// A PE of this process has taken its sample.
  void answered(Pe& pe, PeSample sample) {
    {
      const std::lock_guard lock(mutex_);
      OfPe& of = of_pe(pe.id());
      of.asked = false;
      of.parts.begin_period(heat_.pictures);
    }
    if (is_on_process_0(pe)) return arrived(std::move(sample));
    send_uncounted<&sample_arrives>(pe, PeId{0}, std::move(sample));
  }
  /// On process 0, as draw() and note().
  void arrived(PeSample sample) {
    const std::lock_guard lock(mutex_);
    board_->arrived(std::move(sample));
  }
  /// A period of the heat maps begins on a PE of this process.
  void begin_heat(Pe& pe, const std::vector<HeatQuery>& queries) {
    std::unique_ptr<PeHeat>& heat = of_pe(pe.id()).heat;
    if (!heat && queries.empty()) return;
    if (!heat) heat = std::make_unique<PeHeat>(pe);
    report_heat(pe, heat->begin(queries));
    if (queries.empty()) heat.reset();
  }
  void end_heat_window(Pe& pe) {
    if (auto& heat = of_pe(pe.id()).heat) report_heat(pe, heat->end_window());
  }
  void take(HeatCells&& part) {
    const std::lock_guard lock(mutex_);
    board_->take(std::move(part));
  }
  /// On process 0: what the other processes have not been told yet.
  [[nodiscard]] std::optional<HeatWanted> heat_to_tell() {
    const std::lock_guard lock(mutex_);
    if (std::exchange(told_, heat_.version) == heat_.version) return std::nullopt;
    return heat_;
  }
  /// On other processes.
  void want_heat(HeatWanted&& wanted) {
    const std::lock_guard lock(mutex_);
    if (wanted.version > heat_.version) heat_ = std::move(wanted);
  }
  [[nodiscard]] bool wants_part(const Pe& pe, std::string_view name, std::uint64_t part) {
    // Only this PE's thread uses its parts; answered() runs on the same thread.
    return of_pe(pe.id()).parts.wants(name, part);
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
    bool asked = false;  // and has not answered yet
    // Only its thread uses these.
    PartsOfPe parts;
    std::unique_ptr<PeHeat> heat;  // while heat maps are watched
  };

  void report_heat(Pe& pe, std::vector<HeatCells>&& parts) {
    for (HeatCells& part : parts) {
      if (is_on_process_0(pe))
        take(std::move(part));
      else
        send_uncounted<&heat_arrives>(pe, PeId{0}, std::move(part));
    }
  }

  [[nodiscard]] PeId first_pe() const { return machine_.first_pe(machine_.process()); }
  [[nodiscard]] OfPe& of_pe(PeId pe) {
    return of_pes_.at(static_cast<std::size_t>(pe.value - first_pe().value));
  }

  void serve(const MonitorOptions& options) {
    board_.emplace(machine_);
    Server::Source source;
    source.past = [this] {
      const std::lock_guard lock(mutex_);
      return board_->past();
    };
    source.past_heat = [this](const HeatMapId& id) {
      const std::lock_guard lock(mutex_);
      return board_->past_heat(id);
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
    if (server_) watch_heat();
    const bool by_load =
        std::any_of(heat_.queries.begin(), heat_.queries.end(),
                    [](const HeatQuery& query) { return query.map.by == HeatBy::load; });
    std::vector<PeId> asked;
    for (std::int32_t i = 0; i < machine_.n_pes_here(); ++i) {
      const PeId to{first_pe().value + i};
      if (std::exchange(of_pe(to).asked, true)) continue;
      machine_.hand_in(to, make_outside<&sample_is_asked>(to, SampleAsked{heat_.queries}));
      if (by_load) asked.push_back(to);
    }
    if (by_load) end_windows_later(std::move(asked));
  }
  void watch_heat() {
    board_->watch_heat(server_->watched());
    std::vector<HeatQuery> queries = board_->heat_queries();
    const bool pictures = server_->has_listeners();
    if (queries == heat_.queries && pictures == heat_.pictures) return;
    ++heat_.version;
    heat_.queries = std::move(queries);
    heat_.pictures = pictures;
  }
  void end_windows_later(std::vector<PeId> of) {
    window_timer_.expires_after(
        std::max<Clock::duration>(period_ / 200, std::chrono::milliseconds(1)));
    window_timer_.async_wait([this, of = std::move(of)](const boost::system::error_code& error) {
      const std::lock_guard lock(mutex_);
      if (error || closed_) return;
      for (const PeId to : of) machine_.hand_in(to, make_outside<&window_ends>(to, WindowEnds{}));
    });
  }
  void publish() {
    if (!server_) return;
    std::vector<Event> events;
    std::vector<std::pair<HeatMapId, Event>> heat;
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
      heat = board_->take_heat_events();
    }
    {
      const std::lock_guard lock(reported_->mutex);
      if (reported_->text) events.push_back({"report", json_string(*reported_->text)});
      reported_->text.reset();
    }
    server_->publish(events);
    for (const auto& [id, event] : heat) server_->publish(id, event);
  }

  Runtime& runtime_;
  Machine& machine_;
  const Clock::duration period_;
  const Clock::time_point began_;
  const std::shared_ptr<Reported> reported_ = std::make_shared<Reported>();
  std::mutex mutex_;  // guards what follows, but not what only a PE uses
  std::vector<OfPe> of_pes_;
  std::optional<Board> board_;  // on process 0
  bool said_left_out_ = false;  // pictures
  HeatWanted heat_;
  std::uint64_t told_ = 0;  // the version that the other processes have been told
  bool closed_ = false;
  boost::asio::io_context io_{1};
  boost::asio::steady_timer timer_{io_}, window_timer_{io_};
  std::optional<Server> server_;  // on process 0
  std::thread thread_;
};

namespace {

Monitor::Loop& loop_of(Pe& pe) {
  return static_cast<Monitor&>(*pe.runtime().monitor()).loop();
}

void heat_is_wanted(Pe& pe, HeatWanted&& wanted) {
  loop_of(pe).want_heat(std::move(wanted));
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
  if (pe.id().value == 0) {  // the other processes hear of it from PE 0
    if (const auto wanted = loop.heat_to_tell()) {
      for (std::int32_t first = pe.machine().n_pes_here(); first < pe.n_pes();
           first += pe.machine().pes_per_process())
        send_uncounted<&heat_is_wanted>(pe, PeId{first}, HeatWanted(*wanted));
    }
  }
  loop.begin_heat(pe, asked.heat);
  loop.answered(pe, sample_of(pe));
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
  if (is_on_process_0(pe)) return loop_->note(note);
  send_uncounted<&note_arrives>(pe, PeId{0}, std::move(note));
}
void Monitor::close() {
  loop_->close();
}
bool Monitor::wants_part(const Pe& pe, std::string_view name, std::uint64_t part) {
  return loop_->wants_part(pe, name, part);
}

void Monitor::draw(Pe& pe, PicturePart part) {
  if (is_on_process_0(pe)) return loop_->draw(part);
  send_uncounted<&part_arrives>(pe, PeId{0}, std::move(part));
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
