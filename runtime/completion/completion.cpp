#include "runtime/completion/completion.hpp"

#include "runtime/base/spanning_tree.hpp"
#include "runtime/check.hpp"
#include "runtime/scheduler/pe.hpp"
#include "runtime/scheduler/pe_action.hpp"

namespace tess {
namespace {

// Control messages of epoch 0 are not counted as hops: they would keep alive what they measure.
void telling_arrives(Pe& pe, Completion::Telling&& m) {
  pe.completion().on_telling(m);
}
void wave_arrives(Pe& pe, Completion::Wave&& m) {
  pe.completion().on_wave(m);
}
void echo_arrives(Pe& pe, Completion::Echo&& m) {
  pe.completion().on_echo(m);
}
void end_arrives(Pe& pe, Completion::End&& m) {
  pe.completion().on_end(m);
}

/// The PE that opened the epoch; of the run, PE 0.
PeId coordinator_of(EpochId epoch) {
  return PeId{static_cast<std::int32_t>(epoch.value & 0xffffffU)};
}

template <auto Handler, class Payload>
void send_control(Pe& pe, PeId to, const Payload& payload) {
  if (payload.epoch.value == 0) {
    send_uncounted<Handler>(pe, to, payload);
  } else {
    send_system<Handler>(pe, to, payload);
  }
}

}  // namespace

bool Tellings::take(PeId from, const Counters& counters) {
  Counters& known = by_pe_[from];
  if (counters.sent < known.sent || counters.processed < known.processed) return false;
  sum_.sent += counters.sent - known.sent;
  sum_.processed += counters.processed - known.processed;
  known = counters;
  return true;
}

Completion::Completion(Pe& pe) : pe_(pe) {
  if (pe.id().value == 0) coordinated_[EpochId{}].closed = true;
}

void Completion::find_local(EpochId epoch) {
  Local& local = local_[epoch];
  if (!local.listed) {
    local.listed = true;
    changed_.push_back(epoch);
  }
  last_epoch_ = epoch;
  last_ = &local.now;
}

EpochId Completion::open(EpochId parent, std::function<void()> on_done) {
  const EpochId epoch{(++n_opened_ << 24U) | static_cast<std::uint64_t>(pe_.id().value)};
  Coordinated& of = coordinated_[epoch];
  of.parent = parent;
  of.on_done = std::move(on_done);
  sent(parent);
  return epoch;
}

void Completion::close(EpochId epoch) {
  Coordinated& of = coordinated_.at(epoch);
  of.closed = true;
  find_local(epoch);  // an empty body is told of, too
}

bool Completion::tell_epochs() {
  if (changed_.empty()) return false;
  std::vector<EpochId> changed;
  changed.swap(changed_);
  for (const EpochId epoch : changed) {
    const auto at = local_.find(epoch);
    if (at == local_.end()) continue;
    at->second.listed = false;
    forget_last();  // each time: telling one epoch may have counted for the next of this list
    const Counters now = at->second.now;
    tell(epoch, coordinator_of(epoch), now);
  }
  return true;
}

bool Completion::tell_run() {
  if (!run_changed()) return false;
  run_told_ = run_ + run_below_.sum();
  const PeId root = coordinator_of(EpochId{});
  tell(EpochId{},
       pe_.id() == root ? root : SpanningTree(pe_.id(), root, pe_.n_pes()).parent(),
       run_told_);
  return true;
}

void Completion::tell(EpochId epoch, PeId whom, const Counters& counters) {
  const Telling telling{epoch, pe_.id(), counters};
  if (whom == pe_.id()) {
    on_telling(telling);
  } else {
    send_control<&telling_arrives>(pe_, whom, telling);
  }
}

void Completion::on_telling(const Telling& telling) {
  if (pe_.id() != coordinator_of(telling.epoch)) {  // on its way up the tree
    run_below_.take(telling.from, telling.counters);
    return;
  }
  const auto at = coordinated_.find(telling.epoch);
  if (at == coordinated_.end()) return;  // told twice, done meanwhile
  if (at->second.told.take(telling.from, telling.counters)) check(telling.epoch, at->second);
}

void Completion::check(EpochId epoch, Coordinated& of) {
  if (!of.closed || of.told.sum().sent != of.told.sum().processed) return;
  if (of.wave_runs) {
    of.again = true;
    return;
  }
  of.wave_runs = true;
  of.again = false;
  of.processed_before_wave = of.told.sum().processed;
  on_wave(Wave{epoch, pe_.id(), ++of.wave});
}

Counters Completion::reading(EpochId epoch) const {
  if (epoch.value == 0) return run_;
  const auto at = local_.find(epoch);
  return at == local_.end() ? Counters{} : at->second.now;
}

void Completion::on_wave(const Wave& wave) {
  Relay relay{wave, reading(wave.epoch), 0};
  for (const PeId child : SpanningTree(pe_.id(), wave.root, pe_.n_pes()).children()) {
    ++relay.waiting;
    send_control<&wave_arrives>(pe_, child, wave);
  }
  if (relay.waiting == 0) {
    echo(relay);
  } else {
    relays_[wave.epoch] = relay;
  }
}

void Completion::on_echo(const Echo& message) {
  Relay& relay = relays_.at(message.epoch);
  TESS_CHECK(relay.wave.number == message.number,
             "epoch ",
             message.epoch.value,
             ": echo of wave ",
             message.number,
             " while wave ",
             relay.wave.number,
             " runs");
  relay.sum.sent += message.sum.sent;
  relay.sum.processed += message.sum.processed;
  if (--relay.waiting != 0) return;
  Relay complete = relay;
  relays_.erase(message.epoch);
  echo(complete);
}

void Completion::echo(Relay& relay) {
  const EpochId epoch = relay.wave.epoch;
  if (relay.wave.root != pe_.id()) {
    const PeId parent = SpanningTree(pe_.id(), relay.wave.root, pe_.n_pes()).parent();
    send_control<&echo_arrives>(pe_, parent, Echo{epoch, relay.wave.number, relay.sum});
    return;
  }
  Coordinated& of = coordinated_.at(epoch);
  of.wave_runs = false;
  if (relay.sum.sent != of.processed_before_wave) {
    if (of.again) check(epoch, of);
    return;
  }
  if (epoch.value == 0) {
    pe_.quiescent();
    return;
  }
  for (const auto& [pe, counters] : of.told.by_pe()) {
    if (pe != pe_.id()) send_system<&end_arrives>(pe_, pe, End{epoch});
  }
  const EpochId parent = of.parent;
  const auto on_done = std::move(of.on_done);
  forget_last();
  local_.erase(epoch);
  coordinated_.erase(epoch);
  on_done();
  processed(parent);
}

void Completion::on_end(const End& end) {
  forget_last();
  local_.erase(end.epoch);
}

void Completion::describe_open(std::vector<std::string>& lines) const {
  for (const auto& [epoch, of] : coordinated_) {
    if (epoch.value == 0) continue;
    lines.push_back(text("epoch ",
                         epoch.value >> 24U,
                         " opened on ",
                         pe_.id(),
                         ": ",
                         of.told.sum().sent,
                         " messages sent, ",
                         of.told.sum().processed,
                         " done"));
  }
}

}  // namespace tess
