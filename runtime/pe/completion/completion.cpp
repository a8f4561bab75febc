#include "runtime/pe/completion/completion.hpp"

#include "runtime/core/check.hpp"
#include "runtime/core/text.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

#include <utility>

namespace tess::detail {
namespace {

/// The PE that opened the epoch; PE 0 for epoch 0.
PeId coordinator_of(EpochId epoch) {
  return PeId{static_cast<std::int32_t>(epoch.value & 0xffffffU)};
}

}  // namespace

struct Completion::Relay {
  Wave wave;
  Counters sum;
  std::int32_t waiting = 0;
};

/// What a PE knows of the epochs other than 0; `coordinated` has epoch 0, too, on PE 0.
struct Completion::Epochs {
  struct Coordinated {
    std::uint64_t wave = 0;
    std::uint64_t processed_before_wave = 0;
    bool wave_runs = false, again = false, closed = false;
    EpochId parent{};
    std::function<void()> on_done;
  };
  template <class Value>
  using ByEpoch = boost::unordered_flat_map<EpochId, Value, std::hash<EpochId>>;

  ByEpoch<Tally> tallies;
  ByEpoch<Coordinated> coordinated;
  ByEpoch<Relay> relays;
};

Completion::Completion(CompletionMessages& messages, PeId here, std::int32_t n_pes)
    : messages_(messages), here_(here), n_pes_(n_pes), epochs_(std::make_unique<Epochs>()) {
  if (here.value == 0) epochs_->coordinated[EpochId{}].closed = true;
}

Completion::~Completion() = default;

std::uint64_t Completion::run_sent_by_all() const {
  return epochs_->coordinated.at(EpochId{}).processed_before_wave;
}

std::size_t Completion::n_epochs() const {
  return epochs_->tallies.size();
}

SpanningTree Completion::tree_of(EpochId epoch) const {
  return {here_, coordinator_of(epoch), n_pes_};
}

Tally* Completion::find(EpochId epoch) {
  if (epoch.value == 0) return &run_;
  const auto at = epochs_->tallies.find(epoch);
  return at == epochs_->tallies.end() ? nullptr : &at->second;
}

void Completion::list(EpochId epoch, Tally& tally) {
  if (epoch.value == 0 || tally.listed) return;
  tally.listed = true;
  changed_.push_back(epoch);
}

void Completion::find_own(EpochId epoch) {
  Tally& tally = epochs_->tallies[epoch];
  list(epoch, tally);
  last_epoch_ = epoch;
  last_ = &tally.own;
}

void Completion::processed_by_call(EpochId epoch) {
  processed(epoch);
}

EpochId Completion::open(EpochId parent, std::function<void()> on_done) {
  const EpochId epoch{(++n_opened_ << 24U) | static_cast<std::uint64_t>(here_.value)};
  Epochs::Coordinated& of = epochs_->coordinated[epoch];
  of.parent = parent;
  of.on_done = std::move(on_done);
  sent(parent);
  return epoch;
}

void Completion::close(EpochId epoch) {
  epochs_->coordinated.at(epoch).closed = true;
  find_own(epoch);
  check_later(epoch);
}

void Completion::check_later(EpochId epoch) {
  Tally& tally = *find(epoch);
  tally.reported = Counters{~std::uint64_t{0}, ~std::uint64_t{0}};  // different from any sum
  list(epoch, tally);
}

bool Completion::report_epochs() {
  if (changed_.empty() || !reports_) return false;
  std::vector<EpochId> changed;
  changed.swap(changed_);
  bool any = false;
  for (const EpochId epoch : changed) {
    const auto at = epochs_->tallies.find(epoch);
    if (at == epochs_->tallies.end()) continue;
    at->second.listed = false;
    forget_last();  // in each pass: reporting one epoch may have counted messages of the next
    any = report(epoch, at->second) || any;
  }
  return any;
}

bool Completion::is_over(EpochId epoch) const {
  return coordinator_of(epoch) == here_ && !epochs_->coordinated.contains(epoch);
}

bool Completion::report(EpochId epoch, Tally& tally) {
  if (is_over(epoch)) {
    end(epoch);
    return true;
  }
  const SpanningTree tree = tree_of(epoch);
  bool any = tally.owed != 0;
  for (std::int32_t slot = 0; tally.owed != 0; ++slot, tally.owed >>= 1U)
    if ((tally.owed & 1U) != 0) messages_.send(tree.child(slot), Answer{epoch});
  const Counters sum = tally.sum();
  if (sum == tally.reported || tally.unanswered) return any;
  tally.reported = sum;
  if (coordinator_of(epoch) == here_) {
    check(epoch, sum);
  } else {
    tally.unanswered = true;
    messages_.send(tree.parent(), Report{epoch, here_, sum});
  }
  return true;
}

void Completion::on(const Report& report) {
  if (is_over(report.epoch)) {  // the runtime may still count its own work there
    messages_.send(report.from, End{report.epoch});
    return;
  }
  if (report.epoch.value != 0) forget_last();
  Tally& tally = report.epoch.value == 0 ? run_ : epochs_->tallies[report.epoch];
  const std::int32_t slot = tree_of(report.epoch).slot_of(report.from);
  tally.below.at(static_cast<std::size_t>(slot)) = report.counters;
  const auto bit = static_cast<std::uint8_t>(1U << static_cast<unsigned>(slot));
  tally.heard |= bit;
  tally.owed |= bit;
  list(report.epoch, tally);
}

void Completion::on(const Answer& answer) {
  Tally* tally = find(answer.epoch);
  if (tally == nullptr) return;  // the end of the epoch overtook this message
  tally->unanswered = false;
  list(answer.epoch, *tally);
}

void Completion::check(EpochId epoch, Counters sum) {
  Epochs::Coordinated& of = epochs_->coordinated.at(epoch);
  if (!of.closed || sum.sent != sum.processed) return;
  if (of.wave_runs) {
    of.again = true;
    return;
  }
  of.wave_runs = true;
  of.again = false;
  of.processed_before_wave = sum.processed;
  on(Wave{epoch, here_, ++of.wave});
}

Counters Completion::reading(EpochId epoch) const {
  if (epoch.value == 0) return run_.own;
  const auto at = epochs_->tallies.find(epoch);
  return at == epochs_->tallies.end() ? Counters{} : at->second.own;
}

void Completion::on(const Wave& wave) {
  Relay relay{wave, reading(wave.epoch), 0};
  for (const PeId child : SpanningTree(here_, wave.root, n_pes_).children()) {
    ++relay.waiting;
    messages_.send(child, wave);
  }
  if (relay.waiting == 0) {
    echo(relay);
  } else {
    epochs_->relays[wave.epoch] = relay;
  }
}

void Completion::on(const Echo& message) {
  Relay& relay = epochs_->relays.at(message.epoch);
  TESS_CHECK(relay.wave.number == message.number, "epoch ", message.epoch.value, ": echo of wave ",
             message.number, " while wave ", relay.wave.number, " runs");
  relay.sum = relay.sum + message.sum;
  if (--relay.waiting != 0) return;
  Relay complete = relay;
  epochs_->relays.erase(message.epoch);
  echo(complete);
}

void Completion::echo(Relay& relay) {
  const EpochId epoch = relay.wave.epoch;
  if (relay.wave.root != here_) {
    const PeId parent = SpanningTree(here_, relay.wave.root, n_pes_).parent();
    messages_.send(parent, Echo{epoch, relay.wave.number, relay.sum});
    return;
  }
  Epochs::Coordinated& of = epochs_->coordinated.at(epoch);
  of.wave_runs = false;
  if (relay.sum.sent != of.processed_before_wave) {
    if (of.again) check_later(epoch);
    return;
  }
  if (epoch.value == 0) {
    messages_.quiescent();
    return;
  }
  end(epoch);
  const EpochId parent = of.parent;
  const auto on_done = std::move(of.on_done);
  epochs_->coordinated.erase(epoch);
  on_done();
  processed(parent);
}

/// Frees the epoch's tallies here and on all PEs below.
void Completion::end(EpochId epoch) {
  const auto at = epochs_->tallies.find(epoch);
  if (at == epochs_->tallies.end()) return;
  const SpanningTree tree = tree_of(epoch);
  for (std::int32_t slot = 0; slot < tree.n_children(); ++slot)
    if ((static_cast<unsigned>(at->second.heard) >> static_cast<unsigned>(slot) & 1U) != 0)
      messages_.send(tree.child(slot), End{epoch});
  forget_last();
  epochs_->tallies.erase(epoch);
}

void Completion::on(const End& end_of) {
  end(end_of.epoch);
}

void Completion::describe_open(std::vector<std::string>& lines) const {
  for (const auto& [epoch, of] : epochs_->coordinated) {
    if (epoch.value == 0) continue;
    const auto at = epochs_->tallies.find(epoch);
    const Counters sum = at == epochs_->tallies.end() ? Counters{} : at->second.sum();
    lines.push_back(text("epoch ", epoch.value >> 24U, " opened on ", here_, ": ", sum.sent,
                         " messages sent, ", sum.processed, " done"));
  }
}

}  // namespace tess::detail
