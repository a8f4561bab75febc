#include "runtime/balance/strategies/diffusion.hpp"

#include "runtime/check.hpp"

#include <bit>

namespace tess::balance {
namespace {

/// A difference below this share of a PE's time is left alone.
constexpr double worth_moving = 0.01;

/// Returns whether anything moved.
bool even_out(LocalPe& one, LocalPe& other) {
  LocalPe& giver = one.summary().time() < other.summary().time() ? other : one;
  LocalPe& taker = &giver == &one ? other : one;
  const std::vector<Item> gift = diffuse(giver, taker.summary());
  for (const Item& item : gift)
    TESS_CHECK(taker.receive(item), "element ", item.element, " was given without room for it");
  return !gift.empty();
}

}  // namespace

std::size_t n_stages(std::size_t n_pes) {
  return static_cast<std::size_t>(std::bit_width(n_pes - 1)) + 1;
}

std::size_t partner(std::size_t pe, std::size_t stage, std::size_t n_pes) {
  return ((std::size_t{1} << stage) - 1 + n_pes - pe) % n_pes;
}

std::vector<Item> diffuse(LocalPe& self, PeSummary other) {
  std::vector<Item> gift;
  const double per_second = 1 / (1 / self.summary().speed + 1 / other.speed);
  for (;;) {
    const double difference = self.summary().time() - other.time();
    if (difference <= worth_moving * self.summary().time()) return gift;
    const auto item = self.item_for(other, difference * per_second);
    if (!item) return gift;
    self.give(*item);
    other.work += item->load;
    other.room_bytes -= item->memory_bytes;
    gift.push_back(*item);
  }
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
