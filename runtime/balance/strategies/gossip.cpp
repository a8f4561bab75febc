#include "runtime/balance/strategies/gossip.hpp"

#include "runtime/balance/metrics.hpp"

#include <algorithm>
#include <bit>

namespace tess::balance {
namespace {

constexpr double overloaded_above = 1.02;  // times the average load
constexpr std::size_t fanout = 4;
constexpr std::size_t n_iterations = 8;

/// Spreads rumours, `fanout` per round, until they can have reached every PE.
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

/// One offer per PE in turn, until no PE makes any. Returns true if any was accepted.
bool transfer(std::vector<GossipPe>& pes) {
  bool any_taken = false;
  for (bool offered = true; offered;) {
    offered = false;
    for (GossipPe& giver : pes) {
      const auto offer = giver.propose();
      if (!offer) continue;
      offered = true;
      GossipPe& receiver = pes[offer->to];
      const auto change = receiver.answer(*offer);
      const bool taken = change.has_value();
      if (taken) trade(giver.local(), receiver.local(), offer->item, *change);
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

double GossipPe::gap(const PeSummary& pe) const {
  return std::max(0.0, (overloaded_above * average_ - pe.time()) * pe.speed);
}

std::optional<Offer> GossipPe::propose() {
  const PeSummary& now = local_.summary();
  const double excess = (now.time() - average_) * now.speed;
  if (now.time() <= overloaded_above * average_) return std::nullopt;
  while (!known_.empty()) {
    double total = 0;
    for (const Rumour& rumour : known_) total += gap(rumour.summary);
    double left = next_.unit() * total;
    auto chosen = known_.begin();
    while (chosen + 1 != known_.end() && (left -= gap(chosen->summary)) >= 0) ++chosen;
    const double wanted = std::min(excess, gap(chosen->summary));
    if (chosen->pe != self_ && wanted > 0)
      if (const auto item = local_.offer(chosen->summary, wanted))
        return Offer{chosen->pe, *item, now};
    known_.erase(chosen);
  }
  return std::nullopt;
}

std::optional<std::vector<Item>> GossipPe::answer(const Offer& offer) const {
  const double excess = (offer.giver.time() - average_) * offer.giver.speed;
  const double wanted = std::min(excess, gap(local_.summary()));
  if (!(wanted > 0)) return std::nullopt;
  return local_.change_for(offer.item, wanted, offer.giver);
}

void GossipPe::learn(const Offer& offer, bool taken, const PeSummary& receiver) {
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
