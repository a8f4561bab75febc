// A program for a machine without the runtime: tokens that walk over all PEs at random until each
// has made its hops. Within a process a token travels as a link, between processes as bytes of a
// given size. It checks that every token makes exactly its hops, on the right PE, with its bytes
// intact.
#pragma once

#include "runtime/wire/machine/machine.hpp"

#include <atomic>
#include <cstring>
#include <deque>
#include <vector>

namespace tess::test {

using namespace detail;

/// What a token carries when it travels as bytes; filling follows.
struct Stamp {
  std::uint64_t kind = 0;  // 0: a token, 1: so many tokens are done, 2: stop
  std::uint64_t state = 0;
  std::int64_t hops_left = 0;
  std::int32_t to = 0;
  std::int32_t from_process = 0;
};

struct Token : Link {
  Stamp stamp;
};

/// Mixes the bits of a number: the random walk (Steele, Lea and Flood 2014, SplitMix64).
inline std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

/// The tour: `n_tokens` start on each PE and make `n_hops` hops each; PE 0 counts those that ended
/// and stops every process when all have, or stops at once in mid flight if `stop_early`.
class Tour final : public Program {
 public:
  struct Plan {
    std::int32_t n_tokens = 10;
    std::int64_t n_hops = 100;
    /// Sizes of a token between processes, used one after the other.
    std::vector<std::size_t> filling_bytes = {0};
    bool stop_early = false;  // after a tenth of the hops
  };

  Tour(Machine& machine, Plan plan)
      : machine_(machine),
        plan_(std::move(plan)),
        seats_(static_cast<std::size_t>(machine.pes_per_process())) {}

  void start(PeId pe) override {
    for (std::int32_t i = 0; i < plan_.n_tokens; ++i) {
      auto* token = new Token;
      token->stamp = {
          0, mix(static_cast<std::uint64_t>(pe.value) * 1000 + static_cast<std::uint64_t>(i)),
          plan_.n_hops, pe.value, machine_.process().value};
      seat(pe).ready.push_back(token);
    }
  }

  void accept(PeId pe, Link* first) override {
    while (first != nullptr) {
      auto* const token = static_cast<Token*>(first);
      first = first->next;
      seat(pe).ready.push_back(token);
    }
  }

  std::size_t step(PeId pe, std::size_t most) override {
    std::size_t n = 0;
    for (; n < most && !seat(pe).ready.empty(); ++n) {
      Token* const token = seat(pe).ready.front();
      seat(pe).ready.pop_front();
      run(pe, token);
    }
    return n;
  }

  bool idle(PeId) override { return false; }

  void receive(PeId pe, std::span<const std::byte> bytes) override {
    if (bytes.empty()) {
      ++n_empty;
      return;
    }
    auto* const token = new Token;
    std::memcpy(&token->stamp, bytes.data(), sizeof(Stamp));
    if (!filled(bytes.subspan(sizeof(Stamp)), token->stamp.state)) ++n_broken;
    dispatch(pe, token);
  }

  void finish(PeId pe) override {
    for (Token* token : seat(pe).ready) delete token;
    seat(pe).ready.clear();
  }

  /// Over all PEs of this process, after run().
  [[nodiscard]] std::int64_t n_hops_made() const {
    std::int64_t sum = 0;
    for (const Seat& s : seats_) sum += s.n_hops_made;
    return sum;
  }

  std::atomic<std::int64_t> n_broken{0};     // tokens with changed bytes
  std::atomic<std::int64_t> n_misplaced{0};  // tokens that came to another PE
  std::atomic<std::int64_t> n_empty{0};      // buffers of 0 bytes
  std::int64_t n_ended = 0;                  // PE 0: tokens that made all their hops

 private:
  struct alignas(64) Seat {
    std::deque<Token*> ready;
    std::int64_t n_hops_made = 0;
    std::size_t n_sent = 0;
  };

  Seat& seat(PeId pe) {
    return seats_[static_cast<std::size_t>(pe.value % machine_.pes_per_process())];
  }

  void run(PeId pe, Token* token) {
    Stamp& stamp = token->stamp;
    if (stamp.to != pe.value) ++n_misplaced;
    if (stamp.kind == 2) {
      delete token;
      machine_.stop();
      return;
    }
    if (stamp.kind == 1) {
      delete token;
      const std::int64_t all = std::int64_t{machine_.n_pes()} * plan_.n_tokens;
      if (++n_ended == all) stop_all(pe);
      return;
    }
    ++seat(pe).n_hops_made;
    if (plan_.stop_early && pe.value == 0 && seat(pe).n_hops_made == plan_.n_hops / 10)
      stop_all(pe);
    if (--stamp.hops_left == 0) {
      stamp.kind = 1;
      stamp.to = 0;
    } else {
      stamp.state = mix(stamp.state);
      stamp.to =
          static_cast<std::int32_t>(stamp.state % static_cast<std::uint64_t>(machine_.n_pes()));
    }
    dispatch(pe, token);
  }

  void stop_all(PeId pe) {
    for (std::int32_t process = machine_.n_processes() - 1; process >= 0; --process) {
      auto* const token = new Token;
      token->stamp.kind = 2;
      token->stamp.to = machine_.first_pe(ProcessId{process}).value;
      dispatch(pe, token);
    }
  }

  void dispatch(PeId pe, Token* token) {
    const PeId to{token->stamp.to};
    if (machine_.same_process(pe, to)) {
      machine_.post(pe, to, token, sizeof(Token), Traffic::user);
      return;
    }
    const std::size_t filling = plan_.filling_bytes[seat(pe).n_sent++ % plan_.filling_bytes.size()];
    Buffer bytes(sizeof(Stamp) + filling);
    std::memcpy(bytes.data(), &token->stamp, sizeof(Stamp));
    for (std::size_t i = 0; i < filling; ++i)
      bytes[sizeof(Stamp) + i] = fill(i, token->stamp.state);
    delete token;
    machine_.send(pe, machine_.process_of(to), std::move(bytes));
  }

  static std::byte fill(std::size_t i, std::uint64_t state) {
    return static_cast<std::byte>((i * 31 + (i >> 9) + state) & 255U);
  }
  static bool filled(std::span<const std::byte> bytes, std::uint64_t state) {
    for (std::size_t i = 0; i < bytes.size(); ++i)
      if (bytes[i] != fill(i, state)) return false;
    return true;
  }

  Machine& machine_;
  Plan plan_;
  std::vector<Seat> seats_;
};

}  // namespace tess::test
