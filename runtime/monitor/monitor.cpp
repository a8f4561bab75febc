#include "runtime/monitor/monitor.hpp"

#include "runtime/core/hash.hpp"
#include "runtime/monitor/board.hpp"
#include "runtime/monitor/server.hpp"
#include "runtime/scheduler/pe_action.hpp"
#include "runtime/scheduler/runtime.hpp"

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

#include <chrono>
#include <functional>
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
  bool with_census = false;
};
struct CensusWanted {};

bool is_on_process_0(Pe& pe) {
  return pe.machine().process().value == 0;
}

// The messages of the monitor; they call its loop, which is below.
void census_is_wanted(Pe& pe, CensusWanted&& wanted);
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
      of.parts.clear();
    }
    if (is_on_process_0(pe)) return arrived(std::move(sample));
    send_uncounted<&sample_arrives>(pe, PeId{0}, std::move(sample));
  }
  /// On process 0, as draw() and note().
  void arrived(PeSample sample) {
    const std::lock_guard lock(mutex_);
    board_->arrived(std::move(sample));
  }
  /// The next samples of this process say what waits.
  void want_census() {
    const std::lock_guard lock(mutex_);
    wants_census_ = true;
  }
  [[nodiscard]] bool wants_part(const Pe& pe, std::string_view name, std::uint64_t part) {
    // Only this PE's thread uses its set; answered() clears it on the same thread.
    return of_pe(pe.id()).parts.insert(mix(std::hash<std::string_view>()(name)) ^ mix(part)).second;
  }
  void draw(const PicturePart& part) {
    const std::lock_guard lock(mutex_);
    board_->draw(part);
  }
  void note(const BalanceNote& note) {
    const std::lock_guard lock(mutex_);
    board_->note(note);
  }

 private:
  struct OfPe {
    bool asked = false;                       // and has not answered yet
    std::unordered_set<std::uint64_t> parts;  // hashes of those that were sent since its sample
  };

  [[nodiscard]] PeId first_pe() const {
    return PeId{machine_.process().value * machine_.pes_per_process()};
  }
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
    source.begin_census = [this] {
      const std::lock_guard lock(mutex_);
      board_->begin_census();
      wants_census_ = true;
    };
    server_.emplace(io_, options, std::move(source));
    runtime_.error_line(text("tessera: monitor on http://", options.address, ":", server_->port(),
                             "/", options.token.empty() ? "" : "?token=…"));
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
    const bool with_census = std::exchange(wants_census_, false);
    for (std::int32_t i = 0; i < machine_.n_pes_here(); ++i) {
      const PeId to{first_pe().value + i};
      if (std::exchange(of_pe(to).asked, true) && !with_census) continue;
      machine_.hand_in(to, make_outside<&sample_is_asked>(to, SampleAsked{with_census}));
    }
  }
  void publish() {
    if (!server_) return;
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
    server_->publish(events);
  }

  Runtime& runtime_;
  Machine& machine_;
  const Clock::duration period_;
  const Clock::time_point began_;
  std::mutex mutex_;  // guards what follows, but `parts`
  std::vector<OfPe> of_pes_;
  std::optional<Board> board_;  // on process 0
  bool wants_census_ = false;
  bool closed_ = false;
  boost::asio::io_context io_{1};
  boost::asio::steady_timer timer_{io_};
  std::optional<Server> server_;  // on process 0
  std::thread thread_;
};

namespace {

Monitor::Loop& loop_of(Pe& pe) {
  return static_cast<Monitor&>(*pe.runtime().monitor()).loop();
}

void census_is_wanted(Pe& pe, CensusWanted&& /*wanted*/) {
  loop_of(pe).want_census();
}
void sample_is_asked(Pe& pe, SampleAsked&& asked) {
  if (pe.stopped()) return;
  if (asked.with_census && pe.id().value == 0) {  // the other processes hear of it from PE 0
    for (std::int32_t first = pe.machine().n_pes_here(); first < pe.n_pes();
         first += pe.machine().pes_per_process())
      send_uncounted<&census_is_wanted>(pe, PeId{first}, CensusWanted{});
  }
  loop_of(pe).answered(pe, sample_of(pe, asked.with_census));
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

void send_part(Pe& pe, PicturePart part) {
  if (is_on_process_0(pe)) return loop_of(pe).draw(part);
  send_uncounted<&part_arrives>(pe, PeId{0}, std::move(part));
}

}  // namespace tess::detail
