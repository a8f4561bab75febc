#include "runtime/balance/rounds/exchange.hpp"

#include "runtime/balance/strategies/diffusion.hpp"
#include "runtime/balance/strategy.hpp"
#include "runtime/future.hpp"

#include <bit>

namespace tess::balance {
namespace {

constexpr std::uint64_t most_sweeps = 8;
constexpr int most_iterations = 8;
constexpr std::size_t fanout = 4;

/// Greetings and offers of one stage have different keys, since they may overtake one another.
constexpr std::uint64_t greeting_key(std::uint64_t stage) {
  return 2 * stage;
}
constexpr std::uint64_t offer_key(std::uint64_t stage) {
  return 2 * stage + 1;
}

/// This PE's half of trade(): the giver's, then the taker's.
void give(LocalPe& self, const Item& item, const std::vector<Item>& change) {
  self.give(item);
  for (const Item& back : change) self.receive(back);
}
void take(LocalPe& self, const Item& item, const std::vector<Item>& change) {
  for (const Item& back : change) self.give(back);
  self.receive(item);
}

}  // namespace

DistributedStrategy distributed_strategy(std::string_view name) {
  return !is_distributed(name) ? DistributedStrategy::none
         : name == "gossip"    ? DistributedStrategy::gossip
                               : DistributedStrategy::diffusion;
}

void Exchange::hold(const PeReport& report, double speed, std::uint64_t memory_limit_bytes) {
  gossip_.reset();
  local_ = std::make_unique<LocalPe>(
      PeSummary{0, report.background, speed, room_of(memory_limit_bytes)});
  n_unknown_ = 0;
  for (std::size_t i = 0; i < report.keys.size(); ++i) {
    const Load load = report.loads[i];
    n_unknown_ += load.is_known() ? 0U : 1U;
    local_->hold(
        {load.seconds_or(0), item_name(pe(), i), static_cast<std::int64_t>(report.size_bytes[i])},
        load.is_known() && report.migratable[i] != 0);
  }
}

void Exchange::weigh_unknown(double mean_load) {
  local_->hold({mean_load * static_cast<double>(n_unknown_), item_name(pe(), 0), 0}, false);
}

std::vector<Item> Exchange::arrived() const {
  std::vector<Item> items;
  for (const Item& item : local().items())
    if (origin_of(item.element) != pe()) items.push_back(item);
  return items;
}

Task Exchange::run(Order order, Callback<void> done) {
  if (order.strategy == DistributedStrategy::diffusion) {
    co_await run_diffusion(order);
  } else {
    co_await run_gossip(order);
  }
  done();
}

Task Exchange::run_diffusion(Order order) {
  for (std::uint64_t number = 0; number < most_sweeps; ++number) {
    const Sweep next{number, order.mean_load};
    const std::uint64_t n = co_await group().reduce<&Exchange::sweep>(next);
    if (n == 0) break;
  }
}

Task Exchange::sweep(Sweep sweep, Callback<std::uint64_t> n_trades) {
  if (sweep.number == 0) weigh_unknown(sweep.mean_load);
  const auto n_pes = static_cast<std::size_t>(current_pe().n_pes());
  const std::size_t stages = n_stages(n_pes);
  n_trades_ = 0;
  for (std::size_t stage = 0; stage < stages; ++stage) {
    const PeId other = pe_at(partner(slot(pe()), stage, n_pes));
    if (other != pe()) co_await diffuse_with(other, sweep.number * stages + stage);
  }
  contribute(sum, n_trades_, n_trades);
}

Task Exchange::diffuse_with(PeId other, std::uint64_t stage) {
  Talk greeting{greeting_key(stage), local_->summary(), {}, 0, {}, 0};
  group()[other].send<&Exchange::hear>(std::move(greeting));
  Talk theirs = co_await talks_.take(greeting_key(stage));
  PeSummary known = theirs.summary;
  const double mine = local_->summary().time();
  const bool gives = mine > known.time() || (mine == known.time() && pe() < other);
  for (;;) {
    if (gives) {
      const auto gift = diffuse(*local_, known);
      Talk offer{offer_key(stage), local_->summary(), {}, 0, {}, 1};
      if (gift) {
        offer.item = gift->item;
        offer.wanted = gift->wanted;
        offer.ends = 0;
      }
      group()[other].send<&Exchange::hear>(std::move(offer));
      if (!gift) co_return;
      Talk answer = co_await talks_.take(offer_key(stage));
      if (answer.ends != 0) co_return;
      give(*local_, gift->item, answer.change);
      known = answer.summary;
      ++n_trades_;
    } else {
      Talk offer = co_await talks_.take(offer_key(stage));
      if (offer.ends != 0) co_return;
      auto change = local_->change_for(offer.item, offer.wanted, offer.summary);
      const bool refuses = !change;
      if (!refuses) take(*local_, offer.item, *change);
      Talk answer{offer_key(stage),
                  local_->summary(),
                  {},
                  0,
                  {},
                  refuses ? std::uint8_t{1} : std::uint8_t{0}};
      if (!refuses) answer.change = std::move(*change);
      group()[other].send<&Exchange::hear>(std::move(answer));
      if (refuses) co_return;
    }
  }
}

void Exchange::hear(Talk talk) {
  talks_.put(std::move(talk));
}

Task Exchange::run_gossip(Order order) {
  const auto n_pes = static_cast<std::size_t>(current_pe().n_pes());
  const auto n_rounds = static_cast<int>((std::bit_width(n_pes) + 1) / 2);
  co_await group().reduce<&Exchange::begin_gossip>(order);
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    co_await group().reduce<&Exchange::begin_iteration>();
    for (int round = 0; round < n_rounds; ++round) co_await group().reduce<&Exchange::spread>();
    const std::uint64_t n = co_await group().reduce<&Exchange::offer_all>();
    if (n == 0) break;
  }
}

void Exchange::begin_gossip(Order order, const Callback<void>& done) {
  weigh_unknown(order.mean_load);
  gossip_ = std::make_unique<GossipPe>(*local_, slot(pe()), order.average_time, order.seed);
  contribute(done);
}

void Exchange::begin_iteration(const Callback<void>& done) {
  gossip_->begin_iteration();
  contribute(done);
}

void Exchange::spread(const Callback<void>& done) {
  const auto n_pes = static_cast<std::size_t>(current_pe().n_pes());
  for (std::size_t k = 0; k < fanout && !gossip_->tell().empty(); ++k)
    group()[pe_at(gossip_->random_peer(n_pes))].send<&Exchange::rumour>(gossip_->tell());
  contribute(done);
}

void Exchange::rumour(const std::vector<Rumour>& rumours) {
  if (gossip_) gossip_->hear(rumours);  // otherwise they belong to a round that is over
}

Task Exchange::offer_all(Callback<std::uint64_t> n_trades) {
  n_trades_ = 0;
  while (const auto offer = gossip_->propose()) {
    const std::uint64_t key = n_offers_++;
    const Proposal proposal{pe(), key, *offer};
    group()[pe_at(offer->to)].send<&Exchange::propose>(proposal);
    Reply answer = co_await replies_.take(key);
    if (answer.taken != 0) {
      give(gossip_->local(), offer->item, answer.change);
      ++n_trades_;
    }
    gossip_->learn(*offer, answer.taken != 0, answer.receiver);
  }
  contribute(sum, n_trades_, n_trades);
}

void Exchange::propose(const Proposal& proposal) {
  auto change = gossip_->answer(proposal.offer);
  Reply answer{proposal.key, change ? std::uint8_t{1} : std::uint8_t{0}, {}, {}};
  if (change) {
    take(gossip_->local(), proposal.offer.item, *change);
    answer.change = std::move(*change);
  }
  answer.receiver = gossip_->local().summary();
  group()[proposal.from].send<&Exchange::reply>(std::move(answer));
}

void Exchange::reply(Reply reply) {
  replies_.put(std::move(reply));
}

}  // namespace tess::balance
