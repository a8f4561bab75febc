// Elements of two classes in arrays of their own, called through an interface by each other, while
// they migrate. Each keeps proxies of all, which migrate with it; between rounds elements are
// inserted and end. The oracle: each answer is that of the class that gives it, and what the
// elements hold after each round is what they hold in a serial program.
#include "apps/protocol_fuzz/scenarios.hpp"
#include "runtime/interface.hpp"

#include <utility>

namespace tess::fuzz {
namespace {

struct Market {
  Trial& trial;
  std::uint64_t seed = 0;
  double move_chance = 0;
};
const Market* market = nullptr;

class Trader {
 public:
  Trader() = default;
  Trader(const Trader&) = delete;
  Trader& operator=(const Trader&) = delete;
  virtual ~Trader() = default;

  virtual void pay(std::int64_t amount) = 0;
  virtual Task trade(std::int32_t round) = 0;
  [[nodiscard]] virtual std::int64_t quote(std::int64_t amount) const = 0;
  [[nodiscard]] virtual std::int64_t holds() const = 0;
  virtual void meet(std::vector<InterfaceProxy<Trader>> all) = 0;
};
using Any = InterfaceProxy<Trader>;

/// A trader as the serial program knows it: by its number and its rate.
struct Known {
  Any trader;
  std::int32_t number = 0;
  std::int64_t rate = 1;
  std::int64_t holds = 0;
};

/// What the trader of this number gives in a round, and the place of the one it gives to.
std::pair<std::size_t, std::int64_t> deal(std::int32_t round, std::int32_t number, std::size_t n) {
  Random random(mix(market->seed ^ mix(static_cast<std::uint64_t>(round * 1000 + number))));
  const std::size_t to = random.below(n);
  return {to, static_cast<std::int64_t>(random.below(1000))};
}

/// What both classes do alike; Derived has the index and the array.
template <class Derived, std::int64_t rate>
class TraderAt : public Chare<Derived>, public Trader {
 public:
  void pay(std::int64_t amount) final {
    holds_ += rate * amount;
    move();
  }
  [[nodiscard]] std::int64_t quote(std::int64_t amount) const final { return rate * amount; }
  [[nodiscard]] std::int64_t holds() const final { return holds_; }
  void meet(std::vector<Any> all) final { all_ = std::move(all); }
  Task trade(std::int32_t round) final {
    move();
    const auto [to, amount] = deal(round, this->index().x, all_.size());
    const Any partner = all_[to];
    const std::int64_t quoted = co_await partner.template ask<&Trader::quote>(amount);
    const bool doubles = partner.index().x % 2 != 0;
    market->trial.expect(quoted == (doubles ? 2 * amount : amount), partner.index().x, " quotes ",
                         quoted, " for ", amount);
    if (amount % 3 == 0) {
      partner.template target<&Trader::pay>()(std::int64_t{amount});
    } else {
      partner.template send<&Trader::pay>(amount);
    }
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(holds_, all_);
  }

 private:
  void move() {
    Random random(mix(market->seed + static_cast<std::uint64_t>(holds_ + this->index().x)));
    if (random.chance(market->move_chance)) this->migrate_to(any_pe(random));
  }

  std::int64_t holds_ = 0;
  std::vector<Any> all_;
};

/// Its numbers are even.
class Grocer : public TraderAt<Grocer, 1> {};
/// Its numbers are odd.
class Banker : public TraderAt<Banker, 2> {};

Task hold_market(std::int32_t n_first, std::int32_t n_rounds) {
  const auto grocers = tess::create<Grocer>(sparse);
  const auto bankers = tess::create<Banker>(sparse);
  const std::vector<InterfaceArray<Trader>> both{grocers, bankers};
  Random random(mix(market->seed + 1));
  std::vector<Known> all;
  std::int32_t n_made = 0;
  const auto add = [&] {
    const std::int32_t number = n_made++;
    if (number % 2 == 0) {
      grocers[{number}].insert_on(any_pe(random));
      all.push_back({grocers[{number}], number, 1});
    } else {
      bankers[{number}].insert_on(any_pe(random));
      all.push_back({bankers[{number}], number, 2});
    }
  };
  co_await epoch([&] {
    while (n_made < n_first) add();
  });
  for (std::int32_t round = 0; round < n_rounds; ++round) {
    std::vector<Any> proxies;
    for (const Known& one : all) proxies.push_back(one.trader);
    for (const Known& one : all) {
      const auto [to, amount] = deal(round, one.number, all.size());
      all[to].holds += all[to].rate * amount;
    }
    co_await epoch([&] {
      for (const auto& array : both) array.broadcast<&Trader::meet>(proxies);
    });
    co_await epoch([&] {
      for (const auto& array : both) array.broadcast<&Trader::trade>(round);
    });
    for (const Known& one : all) {
      const std::int64_t holds = co_await one.trader.ask<&Trader::holds>();
      market->trial.expect(holds == one.holds, "round ", round, ": trader ", one.number, " holds ",
                           holds, ", not ", one.holds);
    }
    co_await epoch([&] {
      for (std::uint64_t n = random.below(3); n > 0; --n) add();
    });
    if (all.size() > 1 && random.chance(0.5)) {
      const auto gone = all.begin() + static_cast<std::ptrdiff_t>(random.below(all.size()));
      const std::int32_t number = gone->number;
      all.erase(gone);
      co_await epoch([&] {
        if (number % 2 == 0)
          grocers[{number}].destroy();
        else
          bankers[{number}].destroy();
      });
    }
  }
}

}  // namespace

void interfaces(Trial& trial) {
  const std::uint64_t seed = trial.random()();
  const Market here{trial, seed, 0.3 * trial.draw(0, 2)};
  market = &here;
  const std::int32_t n_first = trial.draw(1, 16), n_rounds = trial.draw(1, 6);
  trial.run_clean([&] { return hold_market(n_first, n_rounds); });
}

}  // namespace tess::fuzz
