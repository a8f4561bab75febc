// The decisions of a test's adversary: whether a message is delayed, and how long; whether a PE is
// asked for its counters in the middle of its work; whether an element is moved after a message, and
// where to. Each is drawn from the seed and from what it is
// about, for example the third Cell::ghost from PE 1 to PE 3. So a decision does not change when
// others are left out and the run takes another course, which lets a failure be shrunk.
#pragma once

#include "runtime/more/testing/shrink.hpp"
#include "runtime/pe/interfaces/element_mover.hpp"
#include "runtime/wire/machine/adversary.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace tess::test::detail {

using tess::detail::AfterMessage;
using tess::detail::Sending;

struct DecisionOptions {
  std::uint64_t seed = 0;
  std::int32_t n_pes = 1;
  Time latency{};
  double reordering = 0, migration = 0;
  const DecisionIds* keep = nullptr;  ///< the decisions that are not left out; null: all
  bool in_words = false;              ///< keeps what in_words() needs
};

class Decisions final : public tess::detail::Adversary, public tess::detail::ElementMover {
 public:
  /// Appends to `taken` the decisions that came up and were not left out, in order of time.
  Decisions(const DecisionOptions& options, DecisionIds& taken);

  Time delay(const Sending& sending) override;
  bool interrupts(PeId pe) override;
  PeId move(const AfterMessage& after) override;

  /// The decisions taken so far, as sentences.
  [[nodiscard]] std::vector<std::string> in_words() const;

 private:
  /// A message under way, or a move.
  struct Event {
    bool decided = false;
    bool system = false;  // a message of the runtime
    std::string what;     // "Cell::ghost"; of a move the sentence
    PeId from, to;
    Time due{}, arrives{};
  };
  /// The draws of the next decision about this subject.
  [[nodiscard]] std::uint64_t next(std::uint64_t subject);
  bool take(std::uint64_t draw);
  [[nodiscard]] std::string delay_in_words(const Event& delayed) const;

  const DecisionOptions options_;
  std::array<double, 4> slowness_{};  // of each kind of traffic
  std::unordered_map<std::uint64_t, std::uint64_t> n_of_;
  DecisionIds& taken_;
  std::vector<Event> events_;
};

}  // namespace tess::test::detail
