#include "runtime/balance/strategies/diffusion.hpp"

#include <bit>

namespace tess::balance {
namespace {

/// Smaller differences, as a share of a PE's time, are ignored.
constexpr double worth_moving = 0.01;

/// Returns true if anything moved.
bool even_out(LocalPe& one, LocalPe& other) {
  bool moved = false;
  LocalPe& giver = one.summary().time() < other.summary().time() ? other : one;
  LocalPe& taker = &giver == &one ? other : one;
  while (const auto gift = diffuse(giver, taker.summary())) {
    const auto change = taker.change_for(gift->item, gift->wanted, giver.summary());
    if (!change) break;
    trade(giver, taker, gift->item, *change);
    moved = true;
  }
  return moved;
}

}  // namespace

std::size_t n_stages(std::size_t n_pes) {
  return static_cast<std::size_t>(std::bit_width(n_pes - 1)) + 1;
}

std::size_t partner(std::size_t pe, std::size_t stage, std::size_t n_pes) {
  return ((std::size_t{1} << stage) - 1 + n_pes - pe) % n_pes;
}

std::optional<Gift> diffuse(const LocalPe& self, const PeSummary& other) {
  const double time = self.summary().time();
  const double difference = time - other.time();
  if (difference <= worth_moving * time) return std::nullopt;
  const double wanted = difference / (1 / self.summary().speed + 1 / other.speed);
  const auto item = self.offer(other, wanted);
  if (!item) return std::nullopt;
  return Gift{*item, wanted};
}

Assignment diffusion(const Snapshot& s, std::size_t n_sweeps) {
  std::vector<LocalPe> pes = local_pes(s);
  bool moved = true;
  for (std::size_t sweep = 0; moved && sweep < n_sweeps; ++sweep) {
    moved = false;
    for (std::size_t stage = 0; stage < n_stages(pes.size()); ++stage)
      for (std::size_t p = 0; p < pes.size(); ++p) {
        const std::size_t other = partner(p, stage, pes.size());
        if (p < other) moved = even_out(pes[p], pes[other]) || moved;
      }
  }
  return collect(s, pes);
}

}  // namespace tess::balance
