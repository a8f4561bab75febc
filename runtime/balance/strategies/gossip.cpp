#include "runtime/balance/strategies/gossip.hpp"

#include "runtime/balance/metrics.hpp"

#include <algorithm>
#include <bit>

namespace tess::balance {
namespace {

constexpr double tolerance = 1.02;  // of the average: above it a PE is overloaded
constexpr std::size_t fanout = 4;
constexpr std::size_t n_iterations = 8;

/// The work that would bring a PE to the average.
double gap(const PeSummary& pe, double average) {
  return (average - pe.time()) * pe.speed;
}

/// Word spreads by `fanout` a round until it can have reached every PE.
void spread_word(std::vector<GossipPe>& pes) {
  const auto n_rounds = static_cast<std::size_t>(std::bit_width(pes.size()) + 1) / 2;
  for (GossipPe& pe : pes) pe.begin_iteration();
  for (std::size_t round = 0; round < n_rounds; ++round) {
    std::vector<std::vector<Rumour>> said;
    for (const GossipPe& pe : pes) said.push_back(pe.tell());
    for (std::size_t p = 0; p < pes.size(); ++p)
      for (std::size_t k = 0; k < fanout && !said[p].empty(); ++k)
        pes[pes[p].random_peer(pes.size())].hear(said[p]);
  }
}

/// One offer of every PE after the other, until no PE makes any. Returns whether any was taken.
bool transfer(std::vector<GossipPe>& pes) {
  bool any_taken = false;
  for (bool offered = true; offered;) {
    offered = false;
    for (GossipPe& giver : pes) {
      const auto offer = giver.propose();
      if (!offer) continue;
      offered = true;
      GossipPe& receiver = pes[offer->to];
      const bool taken = receiver.answer(*offer);
      giver.learn(*offer, taken, receiver.local().summary());
      any_taken = any_taken || taken;
    }
  }
  return any_taken;
}

}  // namespace

void GossipPe::begin_iteration() {
  known_.clear();
  if (local_.summary().time() < average_) known_.push_back({self_, local_.summary()});
}

void GossipPe::hear(const std::vector<Rumour>& rumours) {
  for (const Rumour& rumour : rumours) {
    if (rumour.pe == self_) continue;
    if (std::ranges::find(known_, rumour.pe, &Rumour::pe) != known_.end()) continue;
    if (known_.size() < most_known)
      known_.push_back(rumour);
    else
      known_[next_.below(most_known)] = rumour;
  }
}

std::optional<Offer> GossipPe::propose() {
  const double excess = -gap(local_.summary(), average_);
  if (local_.summary().time() <= tolerance * average_) return std::nullopt;
  while (!known_.empty()) {
    double total = 0;
    for (const Rumour& rumour : known_) total += std::max(0.0, gap(rumour.summary, average_));
    double left = next_.unit() * total;
    auto chosen = known_.begin();
    while (chosen + 1 != known_.end() &&
           (left -= std::max(0.0, gap(chosen->summary, average_))) >= 0)
      ++chosen;
    const double wanted = std::min(excess, gap(chosen->summary, average_));
    if (chosen->pe != self_)
      if (const auto item = local_.item_for(chosen->summary, wanted))
        return Offer{chosen->pe, *item, local_.summary().time()};
    known_.erase(chosen);
  }
  return std::nullopt;
}

bool GossipPe::answer(const Offer& offer) {
  return local_.summary().time(offer.item.load) < offer.giver_time && local_.receive(offer.item);
}

void GossipPe::learn(const Offer& offer, bool taken, const PeSummary& receiver) {
  if (taken) local_.give(offer.item);
  const auto it = std::ranges::find(known_, offer.to, &Rumour::pe);
  if (it == known_.end()) return;
  it->summary = receiver;
  if (!taken || receiver.time() >= average_) known_.erase(it);
}

Assignment gossip(const Snapshot& s, std::uint64_t seed) {
  const double average = average_time(s);
  std::vector<GossipPe> pes;
  for (LocalPe& local : local_pes(s)) pes.emplace_back(std::move(local), pes.size(), average, seed);
  for (std::size_t iteration = 0; iteration < n_iterations; ++iteration) {
    spread_word(pes);
    if (!transfer(pes)) break;
  }
  std::vector<LocalPe> local;
  for (const GossipPe& pe : pes) local.push_back(pe.local());
  return collect(s, local);
}

}  // namespace tess::balance
