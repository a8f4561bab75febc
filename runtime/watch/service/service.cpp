#include "runtime/watch/service/service.hpp"

#include "runtime/pe/census.hpp"
#include "runtime/pe/pe_action.hpp"
#include "runtime/pe/runtime.hpp"
#include "runtime/watch/service/hang_watch.hpp"
#include "runtime/watch/service/timekeeper.hpp"
#include "runtime/watch/service/wait_round.hpp"

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

/// A simulated run that waits for ever would tick for ever: after the report the ticks become
/// rarer, each after twice the time of the last one, and after so many nothing is expected any more.
constexpr std::uint32_t most_late_ticks = 16;

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
/// What the PEs of a process have answered.
struct ProcessReport {
  ProcessId process{};
  std::uint64_t job_round = 0;  ///< the round of process 0 that asked for it; 0: a signal did
  WaitAnswer answer;
};
struct Nothing {
  std::uint8_t none = 0;
};
/// PE 0 of a simulated machine looks for a hang.
struct VirtualTick {
  std::uint32_t n_late = 0;  // ticks since the report
};
Service::Loop& loop_of(Pe& pe) {
  return static_cast<Service&>(pe.runtime().service()).loop();
}
void census_is_asked(Pe& pe, CensusAsked&& asked);
void signal_exit_arrives(Pe& pe, SignalExit&& exit) {
  pe.runtime().exit(pe, 128 + exit.signal, exit.signal);
}
void pe_is_free(Pe& pe, Nothing&& nothing);
void job_is_asked(Pe& pe, JobAsk&& ask);
void report_arrives(Pe& pe, ProcessReport&& report);
void report_is_confirmed(Pe& pe, Nothing&& nothing);
void virtual_tick_arrives(Pe& pe, VirtualTick&& tick);

void set_virtual_tick(Pe& pe, Time delay, const VirtualTick& tick) {
  auto* const message = make_message<&virtual_tick_arrives>(pe, tick);
  message->source = pe.id();
  message->counted = false;
  pe.post_after(delay, message);
}

std::string hang_heading(Time idle) {
  return text("tessera: hang: no entry method has begun on any PE for ",
              seconds_text(seconds(idle)), "; ");
}

}  // namespace

class Service::Loop {
 public:
  Loop(Runtime& runtime, bool signals) : runtime_(runtime), machine_(runtime.machine()) {
    const Time limit = runtime.options().hang_report;
    const std::lock_guard lock(mutex_);
    if (limit.count() != 0) {
      const bool is_virtual = machine_.virtual_time();
      watch_.emplace(runtime, limit, is_virtual ? Clock::time_point() : Clock::now());
      if (!is_virtual) look_later();
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
  void take(std::uint64_t round, PeId pe, Waits&& waits) {
    const std::lock_guard lock(mutex_);
    if (!census_ || (round != 0 && round != census_->number())) return;
    const auto i = static_cast<std::size_t>(pe.value - first_pe().value);
    if (!census_->take(i, {std::move(waits), {}})) return;
    if (ending_) return report();
    thread_.soon([this, of = census_->number()] { close_census(of); });
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
    take(0, pe, std::move(waits));
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

  /// The first PE that is free sends what leaves this process.
  void send_pending(Pe& pe) {
    std::function<void(Pe&)> send;
    {
      const std::lock_guard lock(mutex_);
      send = std::exchange(pending_send_, nullptr);
    }
    if (send) send(pe);
  }
  /// Process 0 asks this process.
  void asked(const JobAsk& ask) {
    const std::lock_guard lock(mutex_);
    if (closed_ || ending_ || ask.round <= last_asked_) return;
    last_asked_ = ask.round;
    thread_.soon([this, ask] { answer(ask); });
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
      if (!job_ || (report.job_round != 0 && report.job_round != job_->number())) return;
      take_part(report.process, std::move(report.answer));
    });
  }

  // On a simulated machine, on PE 0.

  void begins(Pe& pe) const {
    if (watch_ && machine_.virtual_time()) set_virtual_tick(pe, watch_->limit() / 2, {});
  }
  void look(Pe& pe, std::uint32_t n_late);

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
    census_.emplace(++n_rounds_, static_cast<std::size_t>(machine_.n_pes_here()));
    census_signal_ = signal;
    census_job_ = job_round;
  }
  void begin_census(int signal, std::uint64_t job_round = 0) {
    new_census(signal, job_round);
    send_to_pes<&census_is_asked>(CensusAsked{census_->number()});
    limit_census();
  }
  void limit_census() {
    after(answers_due_, answer_time, [this, round = census_->number()] {
      if (census_->number() == round) report();
    });
  }
  void begin_job(int signal) {
    if (job_) {  // one report serves both
      if (job_signal_ == browser && signal == SIGUSR1) print_later(signal);
      if (job_signal_ == hang && signal == SIGUSR1) signalled_in_hang_ = true;
      return;
    }
    print_later(signal);
    job_.emplace(++n_jobs_, static_cast<std::size_t>(n_processes()));
    after(job_due_, answer_time + job_time, [this] {
      if (job_ && !ending_) print_job();
    });
    if (n_processes() > 1)
      on_free_pe([ask = JobAsk{n_jobs_, signal}](Pe& pe) {
        for (std::int32_t to = pe.machine().pes_per_process(); to < pe.n_pes(); ++to)
          send_uncounted<&job_is_asked>(pe, PeId{to}, ask);
      });
    begin_census(signal, n_jobs_);
  }
  void print_later(int signal) {
    job_signal_ = signal;
    job_heading_ = heading(signal);
  }
  void take_part(ProcessId process, WaitAnswer&& answer) {
    if (job_->take(static_cast<std::size_t>(process.value), std::move(answer))) print_job();
  }
  void print_job();
  /// Has the first PE of this process that is free call `send`; a later call replaces one that waits.
  void on_free_pe(std::function<void(Pe&)> send) {
    pending_send_ = std::move(send);
    send_to_pes<&pe_is_free>(Nothing{});
  }
  /// Has a PE send the report to process 0; prints it here if process 0 does not confirm it.
  void send_report(ProcessReport&& report) {
    outgoing_ = report.answer;
    on_free_pe([report = std::move(report)](Pe& pe) {
      send_uncounted<&report_arrives>(pe, PeId{0}, report);
    });
    after(confirmed_due_, job_time, [this] {
      if (!outgoing_ || outgoing_->active || ending_) return;
      runtime_.error_line(text("tessera: ", machine_.process(),
                               " reports itself, since process 0 has not answered: ",
                               list_of_waiting(std::move(outgoing_->waits))));
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
    if (!closed_ && !ending_ && census_->number() == round) report();
  }
  void answer(const JobAsk& ask) {
    if (closed_ || ending_) return;
    if (ask.signal == hang && watch_ && watch_->idle(Clock::now()) < watch_->limit() * 3 / 4) {
      WaitAnswer busy;
      busy.active = true;
      send_report({machine_.process(), ask.round, std::move(busy)});
    } else if (census_ && !census_->ended()) {
      census_job_ = ask.round;  // the signal came here, too
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
  std::optional<WaitRound> census_;  // of the PEs of this process
  int census_signal_ = 0;
  std::uint64_t census_job_ = 0;  // the round of process 0 that asks for it; 0: none does
  std::uint64_t n_rounds_ = 0;
  std::optional<WaitRound> job_;  // of the processes of the job; on process 0
  int job_signal_ = 0;
  bool signalled_in_hang_ = false;  // SIGUSR1 came while it was asked whether the job hangs
  std::string job_heading_;
  std::uint64_t n_jobs_ = 0;
  Clock::time_point job_printed_{};
  std::vector<std::function<void(std::string&&)>> askers_;  // of the job's report, beside a signal
  std::optional<WaitAnswer> outgoing_;     // other processes: not yet confirmed by process 0
  std::function<void(Pe&)> pending_send_;  // on_free_pe()
  std::uint64_t last_asked_ = 0;
  bool signalled_ = false;  // a signal that ends the run has come to this process
  bool ending_ = false;     // or to another one
  bool closed_ = false;
  Timekeeper::Timer timer_, answers_due_, abort_due_, job_due_, confirmed_due_, look_due_;
  Timekeeper thread_{mutex_};  // the last: it ends before what it uses
};

void Service::Loop::report() {
  if (census_->ended()) return;
  WaitAnswer answer = census_->end([this](std::size_t i, WaitAnswer& sum) {
    const PeId pe{first_pe().value + static_cast<std::int32_t>(i)};
    sum.silent.push_back(pe);
    sum.waits.add(WaitRank::handler, text(pe, " has not answered within ", answer_time.count(),
                                          " ms: ", runtime_.running_text(pe)));
  });
  if (ending_) {
    const std::string where = n_processes() > 1 ? text("on ", machine_.process(), ", ") : "";
    runtime_.error_line(text("tessera: ", name_of_signal(census_signal_), " ends the run; ", where,
                             list_of_waiting(std::move(answer.waits))));
    send_to_pes<&signal_exit_arrives>(SignalExit{census_signal_});
  } else if (!leads()) {
    send_report({machine_.process(), census_job_, std::move(answer)});
  } else if (job_) {
    take_part(machine_.process(), std::move(answer));
  }
}

void Service::Loop::print_job() {
  WaitAnswer done = job_->end([this](std::size_t i, WaitAnswer& sum) {
    const ProcessId process{static_cast<std::int32_t>(i)};
    const std::int32_t n_pes = n_processes() > 1 ? machine_.pes_per_process() : machine_.n_pes();
    for (std::int32_t pe = 0; pe < n_pes; ++pe)
      sum.silent.push_back(PeId{machine_.first_pe(process).value + pe});
    if (n_processes() > 1)
      sum.waits.add(
          WaitRank::handler,
          text(process, " has not answered: all its PEs are in entry methods, or it has ended"));
  });
  job_.reset();
  const bool signalled = std::exchange(signalled_in_hang_, false);
  if (job_signal_ == hang && done.active) {  // no hang; the askers want the whole report
    watch_->ask_later(Clock::now());
    if (signalled || !askers_.empty()) begin_job(signalled ? SIGUSR1 : browser);
    return;
  }
  if (job_signal_ == hang) watch_->reported();
  const std::string words = text_of(runtime_, std::move(done));
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

void Service::Loop::look(Pe& pe, std::uint32_t n_late) {
  if (pe.stopped() || n_late == most_late_ticks) return;
  const auto now = Clock::time_point(pe.now());
  (void)watch_->look(now);  // no other PE is in an entry method
  const Time limit = watch_->limit(), idle = watch_->idle(now);
  if (idle < limit) return set_virtual_tick(pe, limit / 2, {});
  if (n_late == 0)
    runtime_.error_line(hang_heading(idle) + text_of(runtime_, answer_of_all(runtime_, pe.now())));
  set_virtual_tick(pe, limit * (1U << n_late), {n_late + 1});
}

namespace {

void census_is_asked(Pe& pe, CensusAsked&& asked) {
  loop_of(pe).take(asked.round, pe.id(), census_of_running(pe));
}
void pe_is_free(Pe& pe, Nothing&& /*nothing*/) {
  loop_of(pe).send_pending(pe);
}
void job_is_asked(Pe& pe, JobAsk&& ask) {
  loop_of(pe).asked(ask);
}
void report_arrives(Pe& pe, ProcessReport&& report) {
  const PeId from = pe.machine().first_pe(report.process);
  loop_of(pe).take_report(std::move(report));
  for (std::int32_t i = 0; i < pe.machine().pes_per_process(); ++i)
    send_uncounted<&report_is_confirmed>(pe, PeId{from.value + i}, Nothing{});
}
void report_is_confirmed(Pe& pe, Nothing&& /*nothing*/) {
  loop_of(pe).confirmed();
}
void virtual_tick_arrives(Pe& pe, VirtualTick&& tick) {
  loop_of(pe).look(pe, tick.n_late);
}

}  // namespace

Service::Service(Runtime& runtime, bool signals)
    : loop_(std::make_unique<Loop>(runtime, signals)) {}
Service::~Service() = default;

void Service::begins(Pe& pe) {
  loop_->begins(pe);
}
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
