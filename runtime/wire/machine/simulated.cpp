#include "runtime/wire/machine/simulated.hpp"

#include "runtime/base/mpsc_queue.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/core/text.hpp"
#include "runtime/wire/machine/adversary.hpp"
#include "runtime/wire/machine/work_clock.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <queue>
#include <utility>

namespace tess::detail {
namespace {

struct Event {
  std::int64_t time;
  std::uint64_t order;  // order of events at equal times: the order of posting, or random
  std::int32_t pe;
  bool remote;     // another PE of the process sent it: it costs the receiver the overhead
  Link* message;   // null: the PE checks its queue
  Parcel* parcel;  // or takes a transfer of another process; a buffer if it has no parts
  friend bool operator<(const Event& a, const Event& b) {
    return a.time != b.time ? a.time > b.time : a.order > b.order;
  }
};

std::size_t bytes_of_parts(const Parcel& parcel) {
  std::size_t n_bytes = 0;
  for (const auto part : parcel.parts) n_bytes += part.size();
  return n_bytes;
}

/// A message of a thread that is no PE.
struct Outside : Link {
  PeId to;
  Link* message = nullptr;
};

/// A PE checks its inbox after so much work, about as on real machines (team.cpp).
constexpr std::int64_t nanoseconds_per_step = 30'000;
constexpr std::int64_t most_per_step = 64;
/// Under a fixed cost per message: what the simulation itself may take for one, and the sum beyond
/// it and beyond what was charged that is reported, if it is also a tenth of what was charged.
constexpr std::int64_t nanoseconds_per_message = 3'000;
constexpr std::int64_t nanoseconds_reported = 10'000'000;
/// The program learns with this period that a PE is busy, as on real machines.
constexpr std::int64_t nanoseconds_busy = 1'000'000;

class SimulatedMachine final : public Machine {
 public:
  explicit SimulatedMachine(const SimulatedOptions& options)
      : options_(options),
        within_(options.within_process()),
        between_(options.between_processes()),
        most_(options.cost || intercepts_local() ? 1 : most_per_step),
        random_(options.seed.value_or(0)),
        clocks_(static_cast<std::size_t>(options.n_pes), Clock{}) {
    if (measures() || (options.watches_cost && !intercepts_local())) work_.emplace();
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
    const NotWork pause(*this);
    push(departs({from, to, message, {}}, bytes, bytes, traffic, within_), to.value, message,
         nullptr, from != to);
  }
  void hand_in(PeId to, Link* message) override {
    auto* outside = new Outside;
    outside->to = to;
    outside->message = message;
    outside_.push(outside);
  }
  [[nodiscard]] bool post_after(PeId to, Link* message, Time delay) override {
    push(now(to).count() + delay.count(), to.value, message, nullptr);  // exact: no wire is between
    return true;
  }
  void send(PeId from, ProcessId to, Buffer&& bytes) override {
    const NotWork pause(*this);
    const PeId taker = first_pe(to);
    const std::int64_t time = departs({from, taker, nullptr, {bytes.data(), bytes.size()}},
                                      bytes.size(), bytes.size(), Traffic::user, between_);
    // A copy: the sender keeps its memory, as it does on a real machine.
    Buffer copy(bytes.size());
    std::copy(bytes.data(), bytes.data() + bytes.size(), copy.data());
    push(time, taker.value, nullptr, new Parcel{std::move(copy), {}, {}});
  }
  void send(PeId from, ProcessId to, Parcel&& parcel) override {
    const NotWork pause(*this);
    const std::size_t n_head = parcel.head.size();
    const PeId taker = first_pe(to);
    const std::int64_t time =
        departs({from, taker, nullptr, {parcel.head.data(), n_head}},
                n_head + bytes_of_parts(parcel), n_head, Traffic::user, between_);
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
  [[nodiscard]] std::string left_out() const override {
    if (uncharged_ < nanoseconds_reported || uncharged_ < charged_ / 10) return {};
    return text("--sim cost=", message_cost().count(), "ns: virtual time leaves out ",
                seconds(Time(uncharged_)), " s that entry methods ran, and has ",
                seconds(Time(charged_)),
                " s that were charged: leave cost out to measure them, or charge() what they take");
  }
  [[nodiscard]] std::string describe() const override {
    const bool two = n_processes_ > 1 && (options_.process_latency || options_.process_bandwidth);
    return text("simulated: ", options_.n_pes, " PEs in ", n_processes_, " processes, latency ",
                within_.latency.count(), " ns, ", within_.bandwidth / 1e9, " GB/s",
                two ? text(", between processes ", between_.latency.count(), " ns, ",
                           between_.bandwidth / 1e9, " GB/s")
                    : "",
                options_.seed ? text(", seed ", *options_.seed) : "");
  }

 private:
  struct Clock {
    std::int64_t now = 0;
    bool looks = false;      // an event to check the queue is under way
    std::size_t most = 1;    // messages of the next step
    std::int64_t works = 0;  // nanoseconds in steps since it was idle
  };

  /// The scope of what the simulation does inside a call of the program.
  class NotWork {
   public:
    explicit NotWork(SimulatedMachine& machine)
        : clock_(machine.work_ && machine.running_ >= 0 ? &*machine.work_ : nullptr) {
      if (clock_ != nullptr) clock_->pause();
    }
    ~NotWork() {
      if (clock_ != nullptr) clock_->resume();
    }
    NotWork(const NotWork&) = delete;
    NotWork& operator=(const NotWork&) = delete;

   private:
    WorkClock<>* clock_;
  };

  /// The program works on this PE from here on.
  void begin_work(std::int32_t pe) {
    running_ = pe;
    if (!work_) return;
    work_->resume();
    work_began_ = work_->read();
  }
  /// Returns what it worked; the caller advances the clock of the PE if the cost is measured.
  std::int64_t end_work() {
    running_ = -1;
    if (!work_) return 0;
    work_->pause();
    return work_->read() - work_began_;
  }

  void push(std::int64_t time, std::int32_t pe, Link* message, Parcel* parcel,
            bool remote = false) {
    ++n_posted_;
    events_.push(Event{time, draws() ? random_() : n_posted_, pe, remote, message, parcel});
  }
  /// The disorder is drawn from the seed here.
  [[nodiscard]] bool draws() const {
    return options_.seed.has_value() && options_.adversary == nullptr;
  }
  /// What passing on so many bytes takes each end, if they are copied.
  static Time cpu_time(const Wire& wire, std::size_t bytes) {
    if (wire.copy == 0) return wire.overhead;
    return wire.overhead +
           Time(static_cast<std::int64_t>(static_cast<double>(bytes) * 1e9 / wire.copy));
  }
  /// A message is sent, of which some bytes are copied: charges the sender, and returns when it
  /// arrives.
  std::int64_t departs(const Sending& sending, std::size_t bytes, std::size_t copied,
                       Traffic traffic, const Wire& wire) {
    if (sending.from != sending.to) charge(sending.from, cpu_time(wire, copied));
    return arrival(sending, bytes, traffic, wire);
  }
  std::int64_t arrival(Sending sending, std::size_t bytes, Traffic traffic, const Wire& wire) {
    auto delay = static_cast<double>(wire.latency.count()) +
                 static_cast<double>(bytes) * 1e9 / wire.bandwidth;
    if (draws()) {
      const double u = random_.unit();
      const double spread = u < 0.8 ? 4 : u < 0.95 ? 50 : 500;
      delay *= random_.unit() * spread * slowness_[static_cast<std::size_t>(traffic)];
    }
    sending.due = now(sending.from) + Time(static_cast<std::int64_t>(delay));
    if (options_.adversary != nullptr) sending.due += options_.adversary->delay(sending);
    return sending.due.count();
  }
  /// False if the program charges a fixed cost per message.
  [[nodiscard]] bool measures() const { return !options_.cost; }
  [[nodiscard]] std::int64_t elapsed() const {
    return measures() ? work_->read() - work_began_ : 0;
  }
  void look(std::int32_t pe) {
    Clock& clock = clocks_[static_cast<std::size_t>(pe)];
    if (clock.looks) return;
    clock.looks = true;
    push(clock.now, pe, nullptr, nullptr);
  }

  void deliver(Program& program, PeId pe, const Parcel& parcel);
  void run_step(Program& program, PeId pe);
  void take_outside(Program& program);
  [[nodiscard]] bool gives_up(std::uint64_t n_events);

  const SimulatedOptions options_;
  const Wire within_, between_;
  const std::size_t most_;  // messages of a step
  Random random_;
  std::vector<Clock> clocks_;
  std::array<double, 4> slowness_{};
  std::priority_queue<Event> events_;
  MpscQueue outside_;
  std::uint64_t n_posted_ = 0;
  std::int32_t running_ = -1;
  mutable std::optional<WorkClock<>> work_;  // absent if nothing needs it
  std::int64_t work_began_ = 0;
  // Under a fixed cost, nanoseconds of all PEs: work beyond what was charged, and what was charged.
  std::int64_t uncharged_ = 0, charged_ = 0;
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
      if (event.remote) charge(pe, within_.overhead);
      program.accept(pe, event.message);
      look(event.pe);
    } else if (event.parcel != nullptr) {
      charge(pe, cpu_time(between_, event.parcel->head.size()));
      deliver(program, pe, *std::unique_ptr<Parcel>(event.parcel));
      look(event.pe);
    } else {
      clock.looks = false;
      run_step(program, pe);
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

void SimulatedMachine::run_step(Program& program, PeId pe) {
  Clock& clock = clocks_[static_cast<std::size_t>(pe.value)];
  if (draws() ? random_.chance(0.1)
              : options_.adversary != nullptr && options_.adversary->interrupts(pe))
    program.idle(pe);
  const std::int64_t began = clock.now;
  begin_work(pe.value);
  const std::size_t ran = program.step(pe, clock.most);
  const std::int64_t worked = end_work();
  if (ran == 0) {
    clock.works = 0;
    if (program.idle(pe)) look(pe.value);
    return;
  }
  if (measures()) {
    clock.now += worked;
  } else {
    const std::int64_t charged = clock.now - began;
    const auto most = static_cast<std::int64_t>(ran) * nanoseconds_per_message;
    charged_ += charged;
    uncharged_ += std::max<std::int64_t>(0, worked - charged - most);
  }
  // Measured and charged time: it begins with one message, and grows while steps are full and
  // short.
  const std::int64_t took = clock.now - began;
  if (took > 2 * nanoseconds_per_step) {
    clock.most = static_cast<std::size_t>(std::clamp<std::int64_t>(
        static_cast<std::int64_t>(ran) * nanoseconds_per_step / took, 1, most_per_step));
  } else if (took < nanoseconds_per_step && ran == clock.most) {
    clock.most = std::min(most_, clock.most * 2);
  }
  clock.works += took;
  if (clock.works >= nanoseconds_busy) {
    clock.works = 0;
    program.busy(pe);
  }
  look(pe.value);
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
  begin_work(pe.value);
  const std::span<const std::byte> head(parcel.head.data(), parcel.head.size());
  if (parcel.parts.empty()) {
    program.receive(pe, head);
  } else {
    std::vector<std::uint64_t> sizes;
    for (const auto part : parcel.parts) sizes.push_back(part.size());
    std::vector<std::span<std::byte>> places;
    Link* const message = program.place(pe, head, sizes, places);
    {
      const NotWork pause(*this);  // the bandwidth stands for the copies
      for (std::size_t i = 0; i < places.size(); ++i)
        std::copy(parcel.parts[i].begin(), parcel.parts[i].end(), places[i].begin());
    }
    program.placed(pe, message);
  }
  const std::int64_t worked = end_work();
  if (measures()) clocks_[static_cast<std::size_t>(pe.value)].now += worked;
}

}  // namespace

std::unique_ptr<Machine> make_simulated_machine(const SimulatedOptions& options) {
  return std::make_unique<SimulatedMachine>(options);
}

}  // namespace tess::detail
