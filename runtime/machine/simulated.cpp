#include "runtime/machine/simulated.hpp"

#include "runtime/base/mpsc_queue.hpp"
#include "runtime/core/cpu_clock.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/machine/adversary.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <queue>

namespace tess::detail {
namespace {

struct Event {
  std::int64_t time;
  std::uint64_t order;  // order of events at equal times: the order of posting, or random
  std::int32_t pe;
  Link* message;   // null: the PE checks its queue
  Parcel* parcel;  // or takes a transfer of another process; a buffer if it has no parts
  friend bool operator<(const Event& a, const Event& b) {
    return a.time != b.time ? a.time > b.time : a.order > b.order;
  }
};

/// A message of a thread that is no PE.
struct Outside : Link {
  PeId to;
  Link* message = nullptr;
};

class SimulatedMachine final : public Machine {
 public:
  explicit SimulatedMachine(const SimulatedOptions& options)
      : options_(options),
        random_(options.seed.value_or(0)),
        clocks_(static_cast<std::size_t>(options.n_pes)) {
    pes_per_process_ = options.pes_per_process;
    if (pes_per_process_ == 0) {
      pes_per_process_ = options.n_pes;
      if (options.seed) {
        std::array<std::int32_t, 3> choice{1, 1, options.n_pes};
        if (options.n_pes % 2 == 0) choice[1] = 2;
        pes_per_process_ = choice[random_.below(3)];
      }
    }
    n_processes_ = options.n_pes / pes_per_process_;
    for (double& factor : slowness_) {
      constexpr std::array<double, 5> choices{1, 1, 1, 20, 200};
      factor = draws() ? choices[random_.below(5)] : 1;
    }
  }
  ~SimulatedMachine() override {
    for (; !events_.empty(); events_.pop()) delete events_.top().parcel;
  }
  SimulatedMachine(const SimulatedMachine&) = delete;
  SimulatedMachine& operator=(const SimulatedMachine&) = delete;

  [[nodiscard]] std::int32_t n_pes_here() const override { return options_.n_pes; }
  [[nodiscard]] bool intercepts_local() const override {
    return options_.seed.has_value() || options_.adversary != nullptr;
  }
  [[nodiscard]] unsigned patience() const override { return 1; }

  void post(PeId from, PeId to, Link* message, std::size_t bytes, Traffic traffic) override {
    push(arrival({from, to, message, {}}, bytes, traffic), to.value, message, nullptr);
  }
  void hand_in(PeId to, Link* message) override {
    auto* outside = new Outside;
    outside->to = to;
    outside->message = message;
    outside_.push(outside);
  }
  [[nodiscard]] bool post_after(PeId to, Link* message, Time delay) override {
    std::int64_t time = now(to).count() + delay.count();
    if (options_.adversary != nullptr) {
      time += options_.adversary->delay({to, to, message, {}, Time(time)}).count();
    } else if (options_.seed) {  // it is late by the time that a message to itself takes
      time += arrival({to, to, message, {}}, 0, Traffic::user) - now(to).count();
    }
    push(time, to.value, message, nullptr);
    return true;
  }
  void send(PeId from, ProcessId to, Buffer&& bytes) override {
    const PeId taker{to.value * pes_per_process_};
    const std::int64_t time =
        arrival({from, taker, nullptr, {bytes.data(), bytes.size()}}, bytes.size(), Traffic::user);
    push(time, taker.value, nullptr, new Parcel{std::move(bytes), {}, {}});
  }
  void send(PeId from, ProcessId to, Parcel&& parcel) override {
    std::size_t n_bytes = parcel.head.size();
    for (const auto part : parcel.parts) n_bytes += part.size();
    const PeId taker{to.value * pes_per_process_};
    const std::int64_t time = arrival(
        {from, taker, nullptr, {parcel.head.data(), parcel.head.size()}}, n_bytes, Traffic::user);
    push(time, taker.value, nullptr, new Parcel(std::move(parcel)));
  }

  void run(Program& program) override;
  void stop() override { stopped_ = true; }
  [[noreturn]] void abort(int exit_code) override { std::_Exit(exit_code); }

  [[nodiscard]] Time now(PeId pe) const override {
    return Time(clocks_[static_cast<std::size_t>(pe.value)].now +
                (running_ == pe.value ? elapsed() : 0));
  }
  [[nodiscard]] bool virtual_time() const override { return true; }
  [[nodiscard]] Time message_cost() const override { return options_.cost.value_or(Time(0)); }
  void charge(PeId pe, Time work) override {
    clocks_[static_cast<std::size_t>(pe.value)].now += work.count();
  }
  [[nodiscard]] std::string gave_up() const override { return gave_up_; }
  [[nodiscard]] std::string describe() const override {
    return text("simulated: ", options_.n_pes, " PEs in ", n_processes_, " processes, latency ",
                options_.latency.count(), " ns, ", options_.bandwidth / 1e9, " GB/s",
                options_.seed ? text(", seed ", *options_.seed) : "");
  }

 private:
  struct Clock {
    std::int64_t now = 0;
    bool looks = false;  // an event to check the queue is under way
  };

  void push(std::int64_t time, std::int32_t pe, Link* message, Parcel* parcel) {
    ++n_posted_;
    events_.push(Event{time, draws() ? random_() : n_posted_, pe, message, parcel});
  }
  /// The disorder is drawn from the seed here.
  [[nodiscard]] bool draws() const {
    return options_.seed.has_value() && options_.adversary == nullptr;
  }
  std::int64_t arrival(Sending sending, std::size_t bytes, Traffic traffic) {
    auto delay = static_cast<double>(options_.latency.count()) +
                 static_cast<double>(bytes) * 1e9 / options_.bandwidth;
    if (draws()) {
      const double u = random_.unit();
      const double spread = u < 0.8 ? 4 : u < 0.95 ? 50 : 500;
      delay *= random_.unit() * spread * slowness_[static_cast<std::size_t>(traffic)];
    }
    sending.due = now(sending.from) + Time(static_cast<std::int64_t>(delay));
    if (options_.adversary != nullptr) sending.due += options_.adversary->delay(sending);
    return sending.due.count();
  }
  [[nodiscard]] std::int64_t elapsed() const {
    return options_.cost ? 0 : thread_cpu_nanoseconds() - step_began_;
  }
  void look(std::int32_t pe) {
    Clock& clock = clocks_[static_cast<std::size_t>(pe)];
    if (clock.looks) return;
    clock.looks = true;
    push(clock.now, pe, nullptr, nullptr);
  }

  static void deliver(Program& program, PeId pe, const Parcel& parcel);
  void take_outside(Program& program);
  [[nodiscard]] bool gives_up(std::uint64_t n_events);

  const SimulatedOptions options_;
  Random random_;
  std::vector<Clock> clocks_;
  std::array<double, 4> slowness_{};
  std::priority_queue<Event> events_;
  MpscQueue outside_;
  std::uint64_t n_posted_ = 0;
  std::int32_t running_ = -1;
  std::int64_t step_began_ = 0;  // CPU time of this thread, in ns
  bool stopped_ = false;
  std::string gave_up_;
};

void SimulatedMachine::run(Program& program) {
  for (std::int32_t pe = 0; pe < options_.n_pes; ++pe) {
    running_ = -1;
    program.start(PeId{pe});
    look(pe);
  }
  std::uint64_t n_events = 0;
  while (!stopped_ && !events_.empty()) {
    if (gives_up(++n_events)) break;
    if (!outside_.empty()) [[unlikely]]
      take_outside(program);
    const Event event = events_.top();
    events_.pop();
    const PeId pe{event.pe};
    Clock& clock = clocks_[static_cast<std::size_t>(event.pe)];
    clock.now = std::max(clock.now, event.time);
    if (event.message != nullptr) {
      event.message->next = nullptr;
      program.accept(pe, event.message);
      look(event.pe);
    } else if (event.parcel != nullptr) {
      deliver(program, pe, *std::unique_ptr<Parcel>(event.parcel));
      look(event.pe);
    } else {
      clock.looks = false;
      if (draws() && random_.chance(0.1)) program.idle(pe);
      running_ = event.pe;
      if (!options_.cost) step_began_ = thread_cpu_nanoseconds();
      const std::size_t ran = program.step(pe, 1);
      const std::int64_t cost =
          options_.cost ? 0 : elapsed();  // the program charges a fixed cost per message
      running_ = -1;
      if (ran != 0) {
        clock.now += cost;
        look(event.pe);
      } else if (program.idle(pe)) {
        look(event.pe);
      }
    }
  }
  // Messages still under way belong to the program, which frees them.
  take_outside(program);
  for (; !events_.empty(); events_.pop()) {
    const Event& event = events_.top();
    delete event.parcel;
    if (event.message == nullptr) continue;
    event.message->next = nullptr;
    program.accept(PeId{event.pe}, event.message);
  }
  for (std::int32_t pe = 0; pe < options_.n_pes; ++pe) program.finish(PeId{pe});
}

bool SimulatedMachine::gives_up(std::uint64_t n_events) {
  if (options_.most_events != 0 && n_events > options_.most_events) {
    gave_up_ = text("more than ", options_.most_events, " events");
  } else if (options_.most_time.count() != 0 && events_.top().time > options_.most_time.count()) {
    gave_up_ = text("more than ", seconds(options_.most_time), " s of virtual time");
  } else {
    return false;
  }
  gave_up_ = text("the simulated run needs ", gave_up_, ": is it a livelock?");
  return true;
}

void SimulatedMachine::take_outside(Program& program) {
  for (Link* link = outside_.take_all(); link != nullptr;) {
    const std::unique_ptr<Outside> outside(static_cast<Outside*>(link));
    link = link->next;
    outside->message->next = nullptr;
    program.accept(outside->to, outside->message);
    look(outside->to.value);
  }
}

void SimulatedMachine::deliver(Program& program, PeId pe, const Parcel& parcel) {
  const std::span<const std::byte> head(parcel.head.data(), parcel.head.size());
  if (parcel.parts.empty()) return program.receive(pe, head);
  std::vector<std::uint64_t> sizes;
  for (const auto part : parcel.parts) sizes.push_back(part.size());
  std::vector<std::span<std::byte>> places;
  Link* const message = program.place(pe, head, sizes, places);
  for (std::size_t i = 0; i < places.size(); ++i)
    std::copy(parcel.parts[i].begin(), parcel.parts[i].end(), places[i].begin());
  program.placed(pe, message);
}

double number_of(const std::string& value, const std::string& part, std::string* unit) {
  double number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error != std::errc())
    fail(ErrorCode::bad_argument, "--sim ", part, ": ", value, " is not a number");
  *unit = std::string(end, value.data() + value.size());
  return number;
}

Time time_of(const std::string& value, const std::string& part) {
  std::string unit;
  const double number = number_of(value, part, &unit);
  const double factor = unit.empty() || unit == "ns" ? 1
                        : unit == "us"               ? 1e3
                        : unit == "ms"               ? 1e6
                        : unit == "s"                ? 1e9
                                                     : -1;
  if (factor < 0 || number < 0)
    fail(ErrorCode::bad_argument, "--sim ", part, ": ", value,
         " is not a time (a number with ns, us, ms or s)");
  return Time(static_cast<std::int64_t>(number * factor));
}

}  // namespace

SimulatedOptions parse_simulated(const std::string& given) {
  SimulatedOptions options;
  std::size_t at = 0;
  while (at < given.size()) {
    const std::size_t comma = std::min(given.find(',', at), given.size());
    const std::string part = given.substr(at, comma - at);
    at = comma + 1;
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos)
      fail(ErrorCode::bad_argument, "--sim: ", part, " is not of the form key=value");
    const std::string key = part.substr(0, equals), value = part.substr(equals + 1);
    std::string unit;
    const auto whole = [&](double least, double most) {
      const double number = number_of(value, key, &unit);
      if (!unit.empty() || number < least || number > most ||
          number != static_cast<double>(static_cast<std::int64_t>(number)))
        fail(ErrorCode::bad_argument, "--sim ", key, ": ", value, " is not a whole number of ",
             least, " … ", most);
      return static_cast<std::int64_t>(number);
    };
    if (key == "pes") {
      options.n_pes = static_cast<std::int32_t>(whole(1, 1 << 20));
    } else if (key == "per-process") {
      options.pes_per_process = static_cast<std::int32_t>(whole(1, 1 << 20));
    } else if (key == "seed") {
      options.seed = static_cast<std::uint64_t>(whole(0, 9e15));
    } else if (key == "latency") {
      options.latency = time_of(value, key);
    } else if (key == "cost") {
      if (value != "measured") options.cost = time_of(value, key);
    } else if (key == "migrate") {
      options.migration_chance = number_of(value, key, &unit);
      if (!unit.empty() || *options.migration_chance < 0 || *options.migration_chance > 1)
        fail(ErrorCode::bad_argument, "--sim migrate: ", value, " is not a probability of 0 … 1");
    } else if (key == "bandwidth") {
      const double number = number_of(value, key, &unit);
      const double factor = unit == "GB/s" ? 1e9 : unit == "MB/s" ? 1e6 : unit.empty() ? 1 : -1;
      if (factor < 0 || number <= 0)
        fail(ErrorCode::bad_argument, "--sim bandwidth: ", value,
             " is not a rate (a number with MB/s or GB/s)");
      options.bandwidth = number * factor;
    } else {
      fail(ErrorCode::bad_argument, "--sim: unknown key ", key,
           " (pes, per-process, latency, bandwidth, cost, seed, migrate)");
    }
  }
  if (options.pes_per_process != 0 && options.n_pes % options.pes_per_process != 0)
    fail(ErrorCode::bad_argument, "--sim: ", options.n_pes, " PEs do not divide into processes of ",
         options.pes_per_process);
  return options;
}

double migration_chance(const SimulatedOptions& options) {
  if (options.migration_chance) return *options.migration_chance;
  if (!options.seed) return 0;
  constexpr std::array<double, 4> choices{0, 0.01, 0.1, 0.5};
  return choices[mix(*options.seed ^ 0x6d696772U) % 4];
}

std::unique_ptr<Machine> make_simulated_machine(const SimulatedOptions& options) {
  return std::make_unique<SimulatedMachine>(options);
}

}  // namespace tess::detail
