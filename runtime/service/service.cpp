#include "runtime/service/service.hpp"

#include "runtime/scheduler/pe_action.hpp"
#include "runtime/scheduler/runtime.hpp"

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>

#include <array>
#include <csignal>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace tess::detail {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// The time in which a PE answers, and after which the job is aborted, both since the signal.
constexpr auto answer_time = 300ms;
constexpr auto abort_time = 700ms;

constexpr std::array taken_signals{SIGINT, SIGTERM, SIGUSR1};

/// Has Asio take a signal that has the system's default action, which Asio gives back. System calls
/// that it interrupts are restarted.
void take_signal(boost::asio::signal_set& set, int signal) {
  struct sigaction action {};
  if (sigaction(signal, nullptr, &action) != 0 || action.sa_handler != SIG_DFL) return;
  set.add(signal);
  sigaction(signal, nullptr, &action);
  action.sa_flags |= SA_RESTART;
  sigaction(signal, &action, nullptr);
}

const char* name_of_signal(int signal) {
  return signal == SIGINT ? "SIGINT" : signal == SIGTERM ? "SIGTERM" : "SIGUSR1";
}

struct CensusAsked {
  std::uint64_t round = 0;
};
struct SignalExit {
  int signal = 0;
};
void census_is_asked(Pe& pe, CensusAsked&& asked) {
  pe.runtime().service().take_census(asked.round, pe.id(), pe.census_of_running());
}
void signal_exit_arrives(Pe& pe, SignalExit&& exit) {
  pe.runtime().exit(pe, 128 + exit.signal, exit.signal);
}

}  // namespace

class Service::Loop {
 public:
  Loop(Runtime& runtime, bool signals) : runtime_(runtime), machine_(runtime.machine()) {
    if (!signals) return;
    for (const int signal : taken_signals) take_signal(signals_, signal);
    wait_for_signal();
    start();
  }
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;
  ~Loop() {
    io_.stop();
    if (thread_.joinable()) thread_.join();
    for (const auto& [due, one] : later_) discard(one.second);
  }

  void post_after(PeId to, Envelope* message, Time delay) {
    const auto due = Clock::now() + delay;
    const std::lock_guard lock(mutex_);
    const auto at = later_.emplace(due, std::pair(to, message));
    if (at != later_.begin()) return;
    start();
    boost::asio::post(io_, [this] {
      const std::lock_guard here(mutex_);
      arm();
    });
  }

  /// A PE answers; `round` 0: to whatever census ends the run.
  void take(std::uint64_t round, PeId pe, std::vector<std::string> lines) {
    const std::lock_guard lock(mutex_);
    if (!census_ || (round != 0 && round != census_->round)) return;
    auto& answer = census_->answers.at(static_cast<std::size_t>(pe.value - first_pe().value));
    if (answer) return;
    answer = std::move(lines);
    if (--census_->n_missing == 0) report();
  }

  void ends_by_signal(int signal, PeId pe, std::vector<std::string> lines) {
    {
      const std::lock_guard lock(mutex_);
      if (!ending_) {  // another process received the signal
        ending_ = true;
        begin_census(signal);
      }
    }
    take(0, pe, std::move(lines));
  }

  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }

 private:
  struct Census {
    int signal = 0;
    std::uint64_t round = 0;
    std::vector<std::optional<std::vector<std::string>>> answers;  // by PE of this process
    std::size_t n_missing = 0;
    bool reported = false;
  };

  // Called under the lock.

  void start() {
    if (!thread_.joinable()) thread_ = std::thread([this] { io_.run(); });
  }
  [[nodiscard]] PeId first_pe() const {
    return PeId{machine_.process().value * machine_.pes_per_process()};
  }
  template <auto Handler>
  void send_to_pes(const typename PeAction<Handler>::Payload& payload) {
    if (closed_) return;
    for (std::int32_t i = 0; i < machine_.n_pes_here(); ++i) {
      const PeId to{first_pe().value + i};
      machine_.hand_in(to, make_outside<Handler>(to, payload));
    }
  }

  /// Waits for the timer that is due first.
  void arm() {
    if (later_.empty()) return;
    timer_.expires_at(later_.begin()->first);
    timer_.async_wait([this](const boost::system::error_code& error) {
      if (!error) post_due();
    });
  }

  void begin_census(int signal) {
    const auto n = static_cast<std::size_t>(machine_.n_pes_here());
    census_ = Census{signal, ++n_rounds_, {}, n, false};
    census_->answers.resize(n);
  }

  /// Prints the census, and says what the PEs run that have not answered.
  void report() {
    if (std::exchange(census_->reported, true)) return;
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < census_->answers.size(); ++i) {
      if (auto& answer = census_->answers[i]; answer) {
        lines.insert(lines.end(), answer->begin(), answer->end());
        continue;
      }
      const PeId pe{first_pe().value + static_cast<std::int32_t>(i)};
      const Action* action = runtime_.pe(pe).running();
      lines.push_back(
          text(pe, " has not answered within ", answer_time.count(), " ms: it runs ",
               action != nullptr ? plain_name(action->name()) : std::string("nothing")));
    }
    const std::string where =
        machine_.n_processes() > 1 && machine_.n_pes_here() != machine_.n_pes()
            ? text("on ", machine_.process(), ", ")
            : std::string();
    runtime_.error_line(text("tessera: ", name_of_signal(census_->signal),
                             ending_ ? " ends the run; " : ": ", where,
                             lines.empty() ? "nothing waits" : list_of_waiting(std::move(lines))));
    if (ending_) send_to_pes<&signal_exit_arrives>(SignalExit{census_->signal});
  }

  // On the thread of the service.

  void wait_for_signal() {
    signals_.async_wait([this](const boost::system::error_code& error, int signal) {
      if (error) return;
      on_signal(signal);
      wait_for_signal();
    });
  }
  void on_signal(int signal);
  void post_due() {
    const std::lock_guard lock(mutex_);
    if (closed_) return;
    const auto now = Clock::now();
    while (!later_.empty() && later_.begin()->first <= now) {
      const auto [to, message] = later_.begin()->second;
      later_.erase(later_.begin());
      machine_.hand_in(to, message);
    }
    arm();
  }

  Runtime& runtime_;
  Machine& machine_;
  boost::asio::io_context io_{1};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> keeps_running_{
      io_.get_executor()};
  boost::asio::signal_set signals_{io_};
  boost::asio::steady_timer timer_{io_}, answers_due_{io_}, abort_due_{io_};
  std::mutex mutex_;  // guards what follows
  std::multimap<Clock::time_point, std::pair<PeId, Envelope*>> later_;
  std::optional<Census> census_;
  std::uint64_t n_rounds_ = 0;
  bool signalled_ = false;  // a signal that ends the run has come to this process
  bool ending_ = false;     // or to another one
  bool closed_ = false;
  std::thread thread_;
};

void Service::Loop::on_signal(int signal) {
  const std::lock_guard lock(mutex_);
  if (closed_) return;  // the run ends anyway
  const bool ends = signal != SIGUSR1;
  if (ends && signalled_) machine_.abort(128 + signal);
  signalled_ = signalled_ || ends;
  if (!ending_) {
    ending_ = ends;
    begin_census(signal);
    const std::uint64_t round = census_->round;
    send_to_pes<&census_is_asked>(CensusAsked{round});
    answers_due_.expires_after(answer_time);
    answers_due_.async_wait([this, round](const boost::system::error_code& error) {
      const std::lock_guard here(mutex_);
      if (!error && census_->round == round) report();
    });
  }
  if (!ends) return;
  abort_due_.expires_after(abort_time);
  abort_due_.async_wait([this, signal](const boost::system::error_code& error) {
    const std::lock_guard here(mutex_);
    if (!error && !closed_) machine_.abort(128 + signal);
  });
}

Service::Service(Runtime& runtime, bool signals)
    : loop_(std::make_unique<Loop>(runtime, signals)) {}
Service::~Service() = default;

void Service::take_census(std::uint64_t round, PeId pe, std::vector<std::string> lines) {
  loop_->take(round, pe, std::move(lines));
}

void Service::post_after(PeId to, Envelope* message, Time delay) {
  loop_->post_after(to, message, delay);
}
void Service::ends_by_signal(int signal, PeId pe, std::vector<std::string> lines) {
  loop_->ends_by_signal(signal, pe, std::move(lines));
}
void Service::close() {
  loop_->close();
}

}  // namespace tess::detail
