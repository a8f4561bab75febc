#include "runtime/pe/runtime.hpp"

#include "runtime/base/program_name.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/pe/census.hpp"
#include "runtime/pe/interfaces/seed_search.hpp"
#include "runtime/pe/measure/critical_path.hpp"
#include "runtime/pe/pe_action.hpp"
#include "runtime/pe/report/pe_watch.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fmt/core.h>

namespace tess::detail {

std::unique_ptr<ProcessMonitor> (*make_monitor)(Runtime&, const MonitorOptions&) = nullptr;
int (*search_seeds)(const SeedRange&, const std::function<int()>&) = nullptr;
const Disturb* disturb = nullptr;

namespace {

struct Code {
  int value = 0;
};
struct ExitAsked {
  int code = 0;
  int signal = 0;  // 0: none
};
struct Stop {
  int signal = 0;
};
struct Stopped {
  int code = 0;
  Runtime::Records records;
};
struct Nothing {
  std::uint8_t none = 0;
};

void main_program(Pe& pe, Nothing&& /*nothing*/) {
  pe.runtime().run_main(pe);
}
void exit_asked_arrives(Pe& pe, ExitAsked&& asked) {
  pe.runtime().on_exit_asked(pe, asked.code, asked.signal);
}
void stop_arrives(Pe& pe, Stop&& stop) {
  pe.runtime().on_stop(pe, stop.signal);
}
void thaw_arrives(Pe& pe, Nothing&& /*nothing*/) {
  pe.timers().thaw();
}
void stopped_arrives(Pe& pe, Stopped&& stopped) {
  pe.runtime().on_stopped(pe, stopped.code, std::move(stopped.records));
}
void leave_arrives(Pe& pe, Code&& code) {
  pe.runtime().on_leave(code.value);
}
void census_asked_arrives(Pe& pe, Nothing&& /*nothing*/) {
  pe.runtime().on_census_asked(pe);
}
void census_arrives(Pe& pe, Runtime::Census&& census) {
  pe.runtime().on_census(pe, std::move(census));
}

// A PE keeps so many records of each kind (about 60 MB); at the end process 0 keeps those of all.
constexpr std::size_t most_trace_records = 1'000'000, most_of_job = 64'000'000;
constexpr std::size_t reserve_bytes = 1U << 20U;

template <auto Handler, class Payload>
void send_to_each(Pe& pe, const Payload& payload) {
  for (std::int32_t to = 0; to < pe.n_pes(); ++to) send_uncounted<Handler>(pe, PeId{to}, payload);
}

/// The beginning of a line of error, as guarded() writes it. A report of a test has no name.
std::string heading(const RuntimeOptions& options) {
  return options.report ? "error: " : error_heading();
}

std::string context_of_this_thread() {
  Pe* pe = current_pe_or_null();
  return pe == nullptr ? std::string() : pe->runtime().describe(*pe);
}

}  // namespace

Runtime::Runtime(Machine& machine, const RuntimeOptions& options, const ElementWords& words,
                 std::function<void()> main)
    : machine_(machine),
      options_(options),
      element_words_(words),
      main_(std::move(main)),
      first_(machine.first_pe(machine.process())),
      reserve_(std::make_unique_for_overwrite<std::byte[]>(reserve_bytes)) {
  const std::int32_t n_here = machine.n_pes_here();
  asked_.resize(static_cast<std::size_t>(n_here), -1);
  for (std::int32_t i = 0; i < n_here; ++i) {
    pes_.push_back(std::make_unique<Pe>(PeId{first_.value + i}, *this, machine,
                                        pools_.emplace_back(), options.seed, options.messages));
    Pe& pe = *pes_.back();
    pe.forced_migrations().set(options.migration_chance, options.mover);
    if (options.statistics) {
      pe.measuring().start_meter();
      pe.measuring().start_elements();
    }
    if (!options.trace.empty())
      pe.measuring().start_trace(
          std::min(most_trace_records, most_of_job / static_cast<std::size_t>(machine.n_pes())));
    if (options.hang_report.count() != 0) pe.measuring().start_watch();
    if (options.audit) pe.measuring().start_audit(options.fault);
  }
  set_check_context(&context_of_this_thread);
}

Runtime::~Runtime() = default;

void Runtime::watch(ProcessMonitor& monitor) {
  monitor_ = &monitor;
  for (const auto& pe : pes_) pe->measuring().start_idle_time();
}

void Runtime::prepare() const {
  if (!options_.trace.empty() && machine_.process().value == 0)
    require_writable_trace(options_.trace);
}

int Runtime::refuse_job(std::string_view why) {
  if (machine_.process().value == 0) error_line(heading(options_) + std::string(why));
  // A process that leaves ends the others: wait until the line is printed.
  (void)machine_.agree(0);
  return 2;
}

int Runtime::run() {
  Registry::seal();
  struct Common {
    std::uint64_t value;
    std::string_view differs;
  };
  const std::array<Common, 6> common{{
      {Registry::fingerprint(),
       "the processes of this job run different programs: start the same build everywhere"},
      {options_.audit ? 1U : 0U,
       "only some processes of this job were given --audit: give it to all"},
      {options_.trace.empty() ? 0U : 1U,
       "only some processes of this job were given --trace: give it to all"},
      {options_.statistics ? 1U : 0U,
       "only some processes of this job were given --stats: give it to all"},
      {options_.monitor ? 1U : 0U,
       "only some processes of this job were given --monitor: give it to all"},
      {options_.messages.memory_bytes,
       "the processes of this job were given different --message-memory: give the same to all"},
  }};
  std::uint64_t all = 0;
  for (const Common& one : common) all = mix(all ^ one.value);
  // Which of them differs is asked only then. It also holds the others until a process that was
  // refused (run.cpp) ends the job with its own error.
  if (!machine_.agree(all))
    for (const Common& one : common)
      if (!machine_.agree(one.value)) return refuse_job(one.differs);
  machine_.run(*this);
  write_trace_of_job();
  if (const std::string left_out = machine_.left_out(); !left_out.empty())
    error_line("tessera: " + left_out);
  if (options_.statistics && !records_.empty()) {
    std::vector<PeLoad> loads;
    for (Records& one : records_) loads.push_back(std::move(one.load));
    error_line("stats: " + tess::describe(summarise(loads)));
  }
  if (left_) return exit_code_;
  // Only a simulated machine can notice that no message is under way any more.
  const std::string gave_up = machine_.gave_up();
  std::string report =
      gave_up.empty()
          ? "tessera: no message is under way, but the run has not ended: this is a bug of the "
            "runtime"
          : "tessera: " + gave_up;
  const std::string audit = audit_text(still_.audit, [](PeId) { return true; });
  if (!still_.empty()) report += "; " + list_of_waiting(std::move(still_));
  error_line(report + audit);
  return 3;
}

void Runtime::start(PeId id) {
  if (id.value != 0) return;
  Pe& pe0 = pe(id);
  const RunsOn here(pe0);
  send_system<&main_program>(pe0, id, Nothing{});
  if (service_ != nullptr) service_->begins(pe0);
}

void Runtime::run_main(Pe& pe) {
  const MainScope scope(pe);
  main_();
}

void Runtime::placed(PeId id, Link* message) {
  const RunsOn here(pe(id));
  pe(id).hand_over(static_cast<Envelope*>(message), sizeof(Envelope));
}

void Runtime::finish(PeId id) {
  const RunsOn here(pe(id));
  if (options_.statistics) print_statistics(id);
  if (!left_) still_.merge(census(pe(id)));
  pe(id).drop_all();
}

void Runtime::print_statistics(PeId id) {
  Pe& of = pe(id);
  const PeStatistics& s = of.statistics();
  const double busy = of.meter()->seconds(of.meter()->busy()) +
                      seconds(machine_.message_cost()) * static_cast<double>(s.messages);
  std::size_t chares = 0;
  for (const HostedCollection* collection : of.collections().all()) chares += collection->n_local();
  error_line(fmt::format(
      "stats: PE {} messages {} sent {} bytes {} busy {:.6f} s idle {:.6f} s chares {} forwards {} "
      "migrations {} dead letters {}",
      id.value, s.messages, s.sent_remote, s.bytes_sent, busy,
      std::max(0.0, of.meter()->age() - busy), chares, s.forwards, s.migrations, s.dead_letters));
}

void Runtime::write_trace_of_job() {
  if (options_.trace.empty() || machine_.process().value != 0) return;
  if (records_.empty())  // the simulated machine gave up
    for (const auto& pe : pes_) records_.push_back(records_of(*pe));
  std::sort(records_.begin(), records_.end(),
            [](const Records& a, const Records& b) { return a.pe < b.pe; });
  std::vector<TraceOfPe> all;
  for (const Records& of : records_) {
    const bool is_here = of.pe.value < machine_.n_pes_here();
    all.push_back({of.pe, is_here ? pe(of.pe).measuring().trace() : &of.trace, of.seconds_per_tick,
                   of.origin, 1e-6 + 2 * seconds(machine_.message_cost()),
                   machine_.process_of(of.pe), 0});
  }
  if (machine_.n_pes_here() != machine_.n_pes()) align_clocks(all);
  write_trace(options_.trace, all);
  const bool complete = std::all_of(all.begin(), all.end(),
                                    [](const TraceOfPe& pe) { return pe.trace->n_dropped() == 0; });
  error_line(complete ? "tessera: " + detail::describe(critical_path(all))
                      : "tessera: the critical path is not known: the trace is not complete");
}

void Runtime::error_line(const std::string& line) {
  const std::lock_guard lock(output_);
  if (options_.report) {
    options_.report(line);
    return;
  }
  std::fflush(stdout);
  std::fprintf(stderr, "%s\n", line.c_str());
  std::fflush(stderr);
}

std::string Runtime::describe(Pe& pe) const {
  const Context& context = pe.context();
  std::string out = text("on ", pe.id());
  if (pe.nesting().constructed_index() != nullptr)
    return out + text(", ",
                      pe.nesting().constructing_collection()->constructed_text(
                          pe.nesting().constructed_index()),
                      ", in the constructor");
  if (context.element != nullptr) out += text(", ", element_words_.text(*context.element));
  if (context.action != nullptr) out += text(", in ", plain_name(context.action->name()));
  if (context.epoch.value != 0) out += text(", epoch ", context.epoch.value >> 24U);
  return out;
}

void Runtime::bad_input(Pe& pe, std::string_view what) {
  if (!said_bad_input_.exchange(true)) error_line(heading(options_) + one_line(what));
  exit(pe, 2);
}

void Runtime::out_of_memory(Pe& pe, const std::string& place) {
  if (!said_out_of_memory_.exchange(true)) {
    reserve_.reset();
    error_line(text(heading(options_), "memory is exhausted ", place.empty() ? describe(pe) : place,
                    "; ask for less, or spread the run over more machines"));
  }
  exit(pe, 2);
}

void Runtime::post_after(PeId to, Envelope* message, Time delay) {
  TESS_CHECK(service_ != nullptr, "this run has no service, which timers need");
  service_->post_after(to, message, delay);
}

void Runtime::exit(Pe& pe, int code, int signal) {
  int& asked = asked_[static_cast<std::size_t>(pe.id().value - first_.value)];
  const bool first = asked < 0;
  asked = std::max(asked, code);
  pe.stop_user_code();
  if (first) send_uncounted<&exit_asked_arrives>(pe, PeId{0}, ExitAsked{code, signal});
}

void Runtime::on_exit_asked(Pe& pe, int code, int signal) {
  end_with(pe, code, signal);
}

void Runtime::end_with(Pe& pe, int code, int signal) {
  exit_code_ = std::max(exit_code_.load(), code);
  if (stopping_) return;
  stopping_ = true;
  n_answers_ = pe.n_pes();
  send_to_each<&stop_arrives>(pe, Stop{signal});
}

void Runtime::on_stop(Pe& pe, int signal) {
  if (signal != 0) machine_.hurry(128 + signal);
  if (signal != 0 && service_ != nullptr)
    service_->ends_by_signal(signal, pe.id(), census_of_running(pe));
  pe.stop_user_code();
  const int asked = asked_[static_cast<std::size_t>(pe.id().value - first_.value)];
  send_uncounted<&stopped_arrives>(pe, PeId{0}, Stopped{std::max(asked, 0), records_of(pe)});
}

Runtime::Records Runtime::records_of(Pe& pe) const {
  Records records;
  records.pe = pe.id();
  if (options_.statistics) records.load = pe.measuring().load();
  if (pe.measuring().trace() == nullptr) return records;
  // By the process, whose PEs share a clock.
  records.origin = pes_.front()->meter()->made();
  records.seconds_per_tick = pe.meter()->seconds(1'000'000'000) * 1e-9;
  if (machine_.process().value != 0) records.trace = std::move(*pe.measuring().trace());
  return records;
}

void Runtime::on_stopped(Pe& pe, int code, Records&& records) {
  exit_code_ = std::max(exit_code_.load(), code);
  records_.push_back(std::move(records));
  if (--n_answers_ != 0) return;
  send_to_each<&leave_arrives>(pe, Code{exit_code_});
  // At once: as soon as another PE of this process receives its message, it stops the process, and
  // this PE would leave with the packed messages for the other processes.
  pe.peers().flush();
}

void Runtime::on_leave(int code) {
  exit_code_ = code;
  left_ = true;
  if (service_ != nullptr) service_->close();
  if (monitor_ != nullptr) monitor_->close();
  machine_.stop();
}

void Runtime::quiescent(Pe& pe) {
  // A census that is under way sees that messages were sent since, and has epoch 0 checked again.
  if (stopping_ || takes_census_) return;
  takes_census_ = true;
  n_sent_by_all_ = pe.completion().run_sent_by_all();
  n_answers_ = pe.n_pes();
  census_ = Census{};
  empty_on_.clear();
  send_to_each<&census_asked_arrives>(pe, Nothing{});
}

void Runtime::on_census_asked(Pe& pe) {
  pe.timers().freeze();
  std::vector<EmptyArray> empty;
  for (HostedCollection* collection : pe.collections().all()) {
    const auto [array, section] = collection->has_nothing_to_reduce();
    if (array) empty.push_back({collection->id(), collection->name()});
    if (section) empty.push_back({{}, "a section of " + collection->name()});
  }
  send_uncounted<&census_arrives>(
      pe, PeId{0},
      Census{census(pe), pe.statistics().dead_letters, std::move(empty), pe.stopped(),
             pe.completion().run_sent(), pe.timers().n_periodic()});
}

void Runtime::on_census(Pe& pe, Census&& census) {
  if (stopping_) return;  // exit() was called meanwhile; it counts its own answers
  census_.waits.merge(std::move(census.waits));
  census_.dead_letters += census.dead_letters;
  for (EmptyArray& array : census.empty)
    if (array.id == CollectionId{} || ++empty_on_[array.id] == pe.n_pes())
      census_.empty.push_back(std::move(array));
  census_.exits = census_.exits || census.exits;
  census_.n_sent += census.n_sent;
  census_.n_periodic += census.n_periodic;
  if (--n_answers_ != 0) return;
  takes_census_ = false;
  if (census_.exits) return;
  // A periodic timer, which may have ended since, sent messages after epoch 0 was found to be done.
  // Epoch 0 counts these messages: it is checked again after the last timer has thawed.
  if (census_.n_sent != n_sent_by_all_) {
    for (std::int32_t to = 0; to < pe.n_pes(); ++to)
      send_system<&thaw_arrives>(pe, PeId{to}, Nothing{});
    return;
  }
  end_with_census(pe);
}

void Runtime::end_with_census(Pe& pe) {
  if (census_.dead_letters != 0)
    error_line(text("tessera: ", census_.dead_letters,
                    census_.dead_letters == 1
                        ? " message to an element that had been destroyed was not delivered"
                        : " messages to elements that had been destroyed were not delivered"));
  const bool all_arrived = report_audit();
  if (!census_.waits.empty()) {
    std::string report = "tessera: deadlock: nothing runs and nothing is under way, but " +
                         list_of_waiting(std::move(census_.waits));
    // A waiter for such a result does not know the array that it comes from.
    for (const EmptyArray& array : census_.empty)
      report += text("\n  note: ", array.name, " has no elements: its reductions have no result");
    if (const std::uint64_t n = census_.n_periodic; n != 0)
      report += text("\n  note: ", n, n == 1 ? " timer of every() is" : " timers of every() are",
                     " set: a run does not wait for their next calls");
    error_line(report);
    end_with(pe, 1);
    return;
  }
  end_with(pe, all_arrived ? 0 : 1);
}

}  // namespace tess::detail
