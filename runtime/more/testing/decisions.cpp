#include "runtime/more/testing/decisions.hpp"

#include "runtime/arrays/elements/element.hpp"
#include "runtime/core/hash.hpp"
#include "runtime/core/text.hpp"
#include "runtime/more/testing/apart.hpp"
#include "runtime/pe/queues/outbox.hpp"
#include "runtime/wire/messages/envelope.hpp"

#include <algorithm>
#include <cstring>

namespace tess::test::detail {
namespace {

using tess::detail::Action;
using tess::detail::Envelope;
using tess::detail::PackedFrom;
using tess::detail::PackedHeader;
using tess::detail::Registry;
using tess::detail::Traffic;

/// What a message says about itself.
struct Label {
  const Action& action;
  PeId source, target;
  const Action* carried = nullptr;  ///< the user's call in a broadcast
};

Label label_of(const Sending& sending) {
  if (sending.link != nullptr) {
    const auto& envelope = static_cast<const Envelope&>(*sending.link);
    const Action& action = *envelope.action;
    return {action, envelope.source, envelope.target,
            action.carried_by == nullptr ? nullptr : &action.carried_by(envelope)};
  }
  PackedHeader header;  // where messages are intercepted, each has a buffer of its own
  std::memcpy(&header, sending.bytes.subspan(sizeof(PackedFrom)).data(), sizeof header);
  return {static_cast<const Action&>(Registry::at(header.action)), header.source, header.target};
}

std::uint64_t hash_of(const Action& action) {
  return hash_bytes(action.name().data(), action.name().size());
}

}  // namespace

Decisions::Decisions(const DecisionOptions& options, DecisionIds& taken)
    : options_(options), taken_(taken) {
  Random random(mix(options.seed ^ 0x736c6f77U));
  constexpr std::array<double, 5> choices{1, 1, 1, 20, 200};
  for (double& factor : slowness_) factor = choices[random.below(5)];
}

std::uint64_t Decisions::next(std::uint64_t subject) {
  return mix(options_.seed ^ mix(subject + n_of_[subject]++));
}

bool Decisions::take(std::uint64_t draw) {
  const auto id = static_cast<DecisionId>(draw);
  if (options_.keep != nullptr &&
      !std::binary_search(options_.keep->begin(), options_.keep->end(), id))
    return false;
  taken_.push_back(id);
  return true;
}

Time Decisions::delay(const Sending& sending) {
  const Label label = label_of(sending);
  const auto hop = static_cast<std::uint64_t>(sending.from.value) << 32U |
                   static_cast<std::uint32_t>(label.target.value);
  const std::uint64_t draw = next(hash_of(label.action) ^ mix(hop));
  Random random(draw);
  Time late{};
  if (random.chance(options_.reordering) && take(draw)) {
    const double u = random.unit();
    const double spread = u < 0.8 ? 4 : u < 0.95 ? 50 : 500;
    late = Time(1 + static_cast<std::int64_t>(
                        static_cast<double>(options_.latency.count()) * random.unit() * spread *
                        slowness_[static_cast<std::size_t>(label.action.traffic)]));
  }
  if (options_.in_words)
    events_.push_back({late.count() != 0,
                       label.carried == nullptr && label.action.traffic != Traffic::user,
                       label.carried == nullptr ? plain_name(label.action.name())
                                                : "broadcast " + plain_name(label.carried->name()),
                       label.source, label.target, sending.due, sending.due + late});
  return late;
}

bool Decisions::interrupts(PeId pe) {
  leave_if_late();
  const std::uint64_t draw = next(mix(0x636f756eU + static_cast<std::uint64_t>(pe.value)));
  if (!Random(draw).chance(0.2 * options_.reordering) || !take(draw)) return false;
  if (options_.in_words)
    events_.push_back({true,
                       true,
                       text(pe, " was asked for its counters in the middle of its work"),
                       {},
                       PeId{-1}});
  return true;
}

PeId Decisions::move(const AfterMessage& after) {
  const std::uint64_t draw = next(after.key);
  Random random(draw);
  if (!random.chance(options_.migration)) return after.pe;
  const PeId to{
      static_cast<std::int32_t>(random.below(static_cast<std::uint64_t>(options_.n_pes)))};
  if (to == after.pe || !take(draw)) return after.pe;
  if (options_.in_words)
    events_.push_back(
        {true,
         false,
         text(element_text(after.element), " was moved from ", after.pe, " to ", to,
              after.action == nullptr ? "" : " after " + plain_name(after.action->name())),
         {},
         PeId{-1}});
  return to;
}

std::vector<std::string> Decisions::in_words() const {
  std::vector<std::string> sentences;
  for (const Event& event : events_)
    if (event.decided) sentences.push_back(event.to.value < 0 ? event.what : delay_in_words(event));
  return sentences;
}

std::string Decisions::delay_in_words(const Event& delayed) const {
  std::vector<const Event*> earlier;  // the messages that passed it
  for (const Event& other : events_) {
    if (other.to != delayed.to || &other == &delayed) continue;
    const bool was_behind =
        other.due > delayed.due || (other.due == delayed.due && &other > &delayed);
    const bool is_before =
        other.arrives < delayed.arrives || (other.arrives == delayed.arrives && &other < &delayed);
    if (was_behind && is_before) earlier.push_back(&other);
  }
  // Messages of the user are the likelier cause.
  if (std::any_of(earlier.begin(), earlier.end(), [](const Event* one) { return !one->system; }))
    std::erase_if(earlier, [](const Event* one) { return one->system; });
  std::string words = text(delayed.system                           ? "the runtime's message "
                           : delayed.what.starts_with("broadcast ") ? "the "
                                                                    : "the message ",
                           delayed.what, " from ", delayed.from, " to ", delayed.to,
                           " was delayed by ", seconds(delayed.arrives - delayed.due) * 1e6, " us");
  if (earlier.empty()) return words;
  words += text(" behind ", earlier.front()->what, " from ", earlier.front()->from);
  if (earlier.size() > 1)
    words += text(" and ", earlier.size() - 1, earlier.size() == 2 ? " other" : " others");
  return words;
}

}  // namespace tess::test::detail
