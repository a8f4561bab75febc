#include "runtime/watch/service/service.hpp"

#include "runtime/pe/census.hpp"
#include "runtime/pe/pe_action.hpp"
#include "runtime/pe/runtime.hpp"
#include "runtime/watch/service/hang_watch.hpp"
#include "runtime/watch/service/job_report.hpp"
#include "runtime/watch/service/process_census.hpp"
#include "runtime/watch/service/timekeeper.hpp"

#include <array>
#include <csignal>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

namespace tess::detail {
namespace {

using namespace std::chrono_literals;
using Clock = Timekeeper::Clock;

/// The time in which a PE answers, and after which the job is aborted, both since the signal.
constexpr auto answer_time = 300ms;
constexpr auto abort_time = 700ms;
/// The time in which the other processes report to process 0, and in which it confirms.
constexpr auto job_time = 1s;

constexpr std::array taken_signals{SIGINT, SIGTERM, SIGUSR1};

const char* name_of_signal(int signal) {
  return signal == SIGINT ? "SIGINT" : signal == SIGTERM ? "SIGTERM" : "SIGUSR1";
}

/// In place of a signal: no entry method has begun for the time of --hang-report.
constexpr int hang = 0;
/// In place of a signal: a browser asks.
constexpr int browser = -1;

struct CensusAsked {
  std::uint64_t round = 0;
};
struct SignalExit {
  int signal = 0;
};
/// Process 0 asks the other processes.
struct JobAsk {
  std::uint64_t round = 0;
  int signal = 0;
};
struct Fetch {
  std::uint8_t none = 0;
};
Service::Loop& loop_of(Pe& pe) {
  return static_cast<Service&>(pe.runtime().service()).loop();
}
void census_is_asked(Pe& pe, CensusAsked&& asked);
void signal_exit_arrives(Pe& pe, SignalExit&& exit) {
  pe.runtime().exit(pe, 128 + exit.signal, exit.signal);
}
void job_is_asked(Pe& pe, JobAsk&& ask);
void job_ask_is_sent(Pe& pe, JobAsk&& ask);
void report_is_fetched(Pe& pe, Fetch&& fetch);
void report_arrives(Pe& pe, ProcessReport&& report);
void report_is_confirmed(Pe& pe, Fetch&& fetch);

}  // namespace

class Service::Loop {
 public:
  Loop(Runtime& runtime, bool signals) : runtime_(runtime), machine_(runtime.machine()) {
    const Time limit = runtime.options().hang_report;
    const std::lock_guard lock(mutex_);
    if (limit.count() != 0 && !machine_.virtual_time()) {
      watch_.emplace(runtime, limit);
      look_later();
    }
    if (signals) thread_.take_signals(taken_signals, [this](int signal) { on_signal(signal); });
  }
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;
  ~Loop() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    for (const auto& [due, one] : later_) discard(one.second);
  }

  void post_after(PeId to, Envelope* message, Time delay) {
    const auto due = Clock::now() + delay;
    const std::lock_guard lock(mutex_);
    const auto at = later_.emplace(due, std::pair(to, message));
    if (at == later_.begin()) arm();
  }

  /// A PE answers; `round` 0: to whatever census ends the run.
  void take(std::uint64_t round, PeId pe, Waits waits, const std::vector<AuditRow>& counted) {
    const std::lock_guard lock(mutex_);
    if (!census_ || (round != 0 && round != census_->round())) return;
    if (!census_->take(pe, std::move(waits), counted)) return;
    if (ending_) return report();
    thread_.soon([this, of = census_->round()] { close_census(of); });
  }

  void ends_by_signal(int signal, PeId pe, Waits waits) {
    {
      const std::lock_guard lock(mutex_);
      if (!ending_) {  // another process received the signal
        ending_ = true;
        new_census(signal);
        if (thread_.started()) limit_census();
      }
    }
    take(0, pe, std::move(waits), {});
  }

  void report_job(std::function<void(std::string&&)> done) {
    const std::lock_guard lock(mutex_);
    if (closed_ || ending_) return;
    thread_.soon([this, done = std::move(done)] {
      if (closed_ || ending_) return;
      askers_.push_back(done);
      begin_job(browser);
    });
  }

  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }

  // For the report of the job. On the threads of PEs.

  /// True for the first PE of process 0 that asks the other processes in this round.
  [[nodiscard]] bool asks_first(std::uint64_t round) {
    const std::lock_guard lock(mutex_);
    return std::exchange(asked_others_in_, round) != round;
  }
  /// Process 0 asks this process.
  void asked(const JobAsk& ask) {
    const std::lock_guard lock(mutex_);
    if (closed_ || ending_ || ask.round <= last_asked_) return;
    last_asked_ = ask.round;
    thread_.soon([this, ask] { answer(ask); });
  }
  /// This process's report, for the first PE that fetches it.
  [[nodiscard]] std::optional<ProcessReport> fetch() {
    const std::lock_guard lock(mutex_);
    if (fetched_ || !outgoing_) return std::nullopt;
    fetched_ = true;
    return outgoing_;
  }
  void confirmed() {
    const std::lock_guard lock(mutex_);
    outgoing_.reset();
  }
  /// Process 0 receives the report of another process.
  void take_report(ProcessReport&& report) {
    const std::lock_guard lock(mutex_);
    if (closed_ || !thread_.started()) return;
    thread_.soon([this, report = std::move(report)]() mutable {
      if (closed_ || ending_) return;
      if (report.job_round == 0 && (job_ || Clock::now() - job_printed_ > job_time))
        begin_job(SIGUSR1);  // another process got the signal
      if (!job_ || (report.job_round != 0 && report.job_round != job_->round())) return;
      take_part(std::move(report));
    });
  }

 private:
  // Called under the lock.

  [[nodiscard]] PeId first_pe() const { return machine_.first_pe(machine_.process()); }
  /// The processes of the job in different memories.
  [[nodiscard]] std::int32_t n_processes() const {
    return machine_.n_pes_here() == machine_.n_pes() ? 1 : machine_.n_processes();
  }
  [[nodiscard]] bool leads() const { return machine_.process().value == 0; }
  template <auto Handler>
  void send_to_pes(const typename PeAction<Handler>::Payload& payload) {
    if (closed_) return;
    for (std::int32_t i = 0; i < machine_.n_pes_here(); ++i) {
      const PeId to{first_pe().value + i};
      machine_.hand_in(to, make_outside<Handler>(to, payload));
    }
  }
  void after(Timekeeper::Timer& timer, Time delay, std::function<void()> run) {
    thread_.set(timer, Clock::now() + delay, [this, run = std::move(run)] {
      if (!closed_) run();
    });
  }

  /// Waits for the message that is due first.
  void arm() {
    if (!later_.empty()) thread_.set(timer_, later_.begin()->first, [this] { post_due(); });
  }

  void new_census(int signal, std::uint64_t job_round = 0) {
    census_.emplace(signal, ++n_rounds_, job_round, first_pe(), machine_.n_pes_here());
  }
  void begin_census(int signal, std::uint64_t job_round = 0) {
    new_census(signal, job_round);
    send_to_pes<&census_is_asked>(CensusAsked{census_->round()});
    limit_census();
  }
  void limit_census() {
    after(answers_due_, answer_time, [this, round = census_->round()] {
      if (census_->round() == round) report();
    });
  }
  void begin_job(int signal) {
    if (job_) {  // one report serves both
      if (job_signal_ == browser && signal == SIGUSR1) print_later(signal);
      if (job_signal_ == hang && signal == SIGUSR1) signalled_in_hang_ = true;
      return;
    }
    print_later(signal);
    job_.emplace(++n_jobs_, n_processes());
    after(job_due_, answer_time + job_time, [this] {
      if (job_ && !ending_) print_job();
    });
    if (n_processes() > 1) send_to_pes<&job_ask_is_sent>(JobAsk{n_jobs_, signal});
    begin_census(signal, n_jobs_);
  }
  void print_later(int signal) {
    job_signal_ = signal;
    job_heading_ = heading(signal);
  }
  void take_part(ProcessReport&& report) {
    job_->take(std::move(report));
    if (job_->complete()) print_job();
  }
  void print_job();
  /// Has a PE send the report to process 0; prints it here if process 0 does not confirm it.
  void send_report(ProcessReport&& report) {
    outgoing_ = std::move(report);
    fetched_ = false;
    send_to_pes<&report_is_fetched>(Fetch{});
    after(confirmed_due_, job_time, [this] {
      if (!outgoing_ || outgoing_->active || ending_) return;
      Waits& waits = outgoing_->waits;
      runtime_.error_line(text(
          "tessera: ", machine_.process(), " reports itself, since process 0 has not answered: ",
          waits.empty() ? "nothing waits" : list_of_waiting(std::move(waits))));
      outgoing_.reset();
    });
  }

  [[nodiscard]] std::string heading(int signal) const {
    if (signal == browser) return {};
    if (signal == hang) return hang_heading(watch_->idle(Clock::now()));
    return text("tessera: ", name_of_signal(signal), ": ");
  }

  /// Ends the census of this process, and says what the PEs run that have not answered.
  void report();

  // On the thread of the service.

  void close_census(std::uint64_t round) {
    if (!closed_ && !ending_ && census_->round() == round) report();
  }
  void answer(const JobAsk& ask) {
    if (closed_ || ending_) return;
    if (ask.signal == hang && watch_ && watch_->idle(Clock::now()) < watch_->limit() * 3 / 4) {
      ProcessReport busy;
      busy.process = machine_.process();
      busy.job_round = ask.round;
      busy.active = true;
      send_report(std::move(busy));
    } else if (census_ && !census_->reported()) {
      census_->serve_job(ask.round);  // the signal came here, too
    } else {
      begin_census(ask.signal, ask.round);
    }
  }
  void look_later() {
    after(look_due_, watch_->period(), [this] {
      const auto now = Clock::now();
      for (const std::string& line : watch_->look(now))
        runtime_.error_line("tessera: hang: " + line);
      if (leads() && !ending_ && !job_ && watch_->due(now)) begin_job(hang);
      look_later();
    });
  }
  void on_signal(int signal);
  void post_due() {
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
  std::mutex mutex_;  // guards what follows
  std::multimap<Clock::time_point, std::pair<PeId, Envelope*>> later_;
  std::optional<HangWatch> watch_;
  std::optional<ProcessCensus> census_;
  std::uint64_t n_rounds_ = 0;
  std::optional<JobReport> job_;  // process 0 collects the report of the job
  int job_signal_ = 0;
  bool signalled_in_hang_ = false;  // SIGUSR1 came while it was asked whether the job hangs
  std::string job_heading_;
  std::uint64_t n_jobs_ = 0, asked_others_in_ = 0;
  Clock::time_point job_printed_{};
  std::vector<std::function<void(std::string&&)>> askers_;  // of the job's report, beside a signal
  std::optional<ProcessReport> outgoing_;  // other processes: not yet confirmed by process 0
  bool fetched_ = false;
  std::uint64_t last_asked_ = 0;
  bool signalled_ = false;  // a signal that ends the run has come to this process
  bool ending_ = false;     // or to another one
  bool closed_ = false;
  Timekeeper::Timer timer_, answers_due_, abort_due_, job_due_, confirmed_due_, look_due_;
  Timekeeper thread_{mutex_};  // the last: it ends before what it uses
};

void Service::Loop::report() {
  if (census_->reported()) return;
  ProcessReport of = census_->finish(runtime_, answer_time);
  if (ending_) {
    const std::string where = n_processes() > 1 ? text("on ", machine_.process(), ", ") : "";
    runtime_.error_line(
        text("tessera: ", name_of_signal(census_->signal()), " ends the run; ", where,
             of.waits.empty() ? "nothing waits" : list_of_waiting(std::move(of.waits))));
    send_to_pes<&signal_exit_arrives>(SignalExit{census_->signal()});
  } else if (!leads()) {
    send_report(std::move(of));
  } else if (job_) {
    take_part(std::move(of));
  }
}

void Service::Loop::print_job() {
  JobReport done = std::move(*job_);
  job_.reset();
  const bool signalled = std::exchange(signalled_in_hang_, false);
  if (job_signal_ == hang && done.active()) {  // no hang; the askers want the whole report
    watch_->ask_later(Clock::now());
    if (signalled || !askers_.empty()) begin_job(signalled ? SIGUSR1 : browser);
    return;
  }
  if (job_signal_ == hang) watch_->reported();
  const std::string words = done.finish(runtime_);
  for (const auto& asker : std::exchange(askers_, {})) asker(std::string(words));
  if (job_signal_ == browser) return;
  runtime_.error_line(job_heading_ + words);
  job_printed_ = Clock::now();
}

void Service::Loop::on_signal(int signal) {
  if (closed_) return;  // the run ends anyway
  if (signal == SIGUSR1) {
    if (ending_) return;
    if (leads())
      begin_job(signal);
    else
      begin_census(signal);
    return;
  }
  if (signalled_) machine_.abort(128 + signal);
  signalled_ = true;
  if (!ending_) {
    ending_ = true;
    begin_census(signal);
  }
  after(abort_due_, abort_time, [this, signal] { machine_.abort(128 + signal); });
}

namespace {

void census_is_asked(Pe& pe, CensusAsked&& asked) {
  loop_of(pe).take(asked.round, pe.id(), census_of_running(pe), pe.measuring().audit_rows());
}
void job_ask_is_sent(Pe& pe, JobAsk&& ask) {
  if (!loop_of(pe).asks_first(ask.round)) return;
  for (std::int32_t to = pe.machine().pes_per_process(); to < pe.n_pes(); ++to)
    send_uncounted<&job_is_asked>(pe, PeId{to}, ask);
}
void job_is_asked(Pe& pe, JobAsk&& ask) {
  loop_of(pe).asked(ask);
}
void report_is_fetched(Pe& pe, Fetch&& /*fetch*/) {
  if (auto report = loop_of(pe).fetch())
    send_uncounted<&report_arrives>(pe, PeId{0}, std::move(*report));
}
void report_arrives(Pe& pe, ProcessReport&& report) {
  const PeId from = pe.machine().first_pe(report.process);
  loop_of(pe).take_report(std::move(report));
  for (std::int32_t i = 0; i < pe.machine().pes_per_process(); ++i)
    send_uncounted<&report_is_confirmed>(pe, PeId{from.value + i}, Fetch{});
}
void report_is_confirmed(Pe& pe, Fetch&& /*fetch*/) {
  loop_of(pe).confirmed();
}

}  // namespace

Service::Service(Runtime& runtime, bool signals)
    : loop_(std::make_unique<Loop>(runtime, signals)) {}
Service::~Service() = default;

void Service::post_after(PeId to, Envelope* message, Time delay) {
  loop_->post_after(to, message, delay);
}
void Service::ends_by_signal(int signal, PeId pe, Waits waits) {
  loop_->ends_by_signal(signal, pe, std::move(waits));
}
void Service::report_job(std::function<void(std::string&&)> done) {
  loop_->report_job(std::move(done));
}
void Service::close() {
  loop_->close();
}

}  // namespace tess::detail
