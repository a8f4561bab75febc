// Elements of two classes in arrays of their own, called through an interface by each other, while
// they migrate. Each keeps proxies of all, which migrate with it; between rounds elements are
// inserted and end. The oracle: each answer is that of the class that gives it, and what the
// elements hold after each round is what they hold in a serial program.
#include "runtime/more/interface.hpp"
#include "tests/fuzz/protocols/scenarios.hpp"

#include <utility>

namespace tess::fuzz {
namespace {

struct InterfaceDraws {
  std::uint64_t seed = 0;
  double move_chance = 0;
};
const InterfaceDraws* interface_draws = nullptr;

class Account {
 public:
  Account() = default;
  Account(const Account&) = delete;
  Account& operator=(const Account&) = delete;
  virtual ~Account() = default;

  virtual void pay(std::int64_t amount) = 0;
  virtual Task transfer(std::int32_t round) = 0;
  [[nodiscard]] virtual std::int64_t quote(std::int64_t amount) const = 0;
  [[nodiscard]] virtual std::int64_t holds() const = 0;
  virtual void learn(std::vector<InterfaceProxy<Account>> all) = 0;
};
using Any = InterfaceProxy<Account>;

/// A account as the serial program knows it: by its number and its rate.
struct Known {
  Any account;
  std::int32_t number = 0;
  std::int64_t rate = 1;
  std::int64_t holds = 0;
};

/// What the account of this number gives in a round, and the place of the one it gives to.
std::pair<std::size_t, std::int64_t> deal(std::int32_t round, std::int32_t number, std::size_t n) {
  Random random(
      mix(interface_draws->seed ^ mix(static_cast<std::uint64_t>(round * 1000 + number))));
  const std::size_t to = random.below(n);
  return {to, static_cast<std::int64_t>(random.below(1000))};
}

/// What both classes do alike; Derived has the index and the array.
template <class Derived, std::int64_t rate>
class AccountAt : public Chare<Derived>, public Account {
 public:
  void pay(std::int64_t amount) final {
    holds_ += rate * amount;
    move();
  }
  [[nodiscard]] std::int64_t quote(std::int64_t amount) const final { return rate * amount; }
  [[nodiscard]] std::int64_t holds() const final { return holds_; }
  void learn(std::vector<Any> all) final { all_ = std::move(all); }
  Task transfer(std::int32_t round) final {
    move();
    const auto [to, amount] = deal(round, this->index().x, all_.size());
    const Any partner = all_[to];
    const std::int64_t quoted = co_await partner.template ask<&Account::quote>(amount);
    const bool doubles = partner.index().x % 2 != 0;
    expect(quoted == (doubles ? 2 * amount : amount), partner.index().x, " quotes ", quoted,
           " for ", amount);
    if (amount % 3 == 0) {
      partner.template target<&Account::pay>()(std::int64_t{amount});
    } else {
      partner.template send<&Account::pay>(amount);
    }
  }

  void serialize(auto& ar) { ar(holds_, all_); }

 private:
  void move() {
    Random random(
        mix(interface_draws->seed + static_cast<std::uint64_t>(holds_ + this->index().x)));
    if (random.chance(interface_draws->move_chance)) this->migrate_to(any_pe(random));
  }

  std::int64_t holds_ = 0;
  std::vector<Any> all_;
};

/// Its numbers are even.
class PlainAccount : public AccountAt<PlainAccount, 1> {};
/// Its numbers are odd.
class DoublingAccount : public AccountAt<DoublingAccount, 2> {};

Task run_rounds(std::int32_t n_first, std::int32_t n_rounds) {
  const auto plain = tess::create<PlainAccount>(sparse);
  const auto doubling = tess::create<DoublingAccount>(sparse);
  const std::vector<InterfaceArray<Account>> both{plain, doubling};
  Random random(mix(interface_draws->seed + 1));
  std::vector<Known> all;
  std::int32_t n_made = 0;
  const auto add = [&] {
    const std::int32_t number = n_made++;
    if (number % 2 == 0) {
      plain[{number}].insert_on(any_pe(random));
      all.push_back({plain[{number}], number, 1});
    } else {
      doubling[{number}].insert_on(any_pe(random));
      all.push_back({doubling[{number}], number, 2});
    }
  };
  co_await epoch([&] {
    while (n_made < n_first) add();
  });
  for (std::int32_t round = 0; round < n_rounds; ++round) {
    std::vector<Any> proxies;
    for (const Known& one : all) proxies.push_back(one.account);
    for (const Known& one : all) {
      const auto [to, amount] = deal(round, one.number, all.size());
      all[to].holds += all[to].rate * amount;
    }
    co_await epoch([&] {
      for (const auto& array : both) array.broadcast<&Account::learn>(proxies);
    });
    co_await epoch([&] {
      for (const auto& array : both) array.broadcast<&Account::transfer>(round);
    });
    for (const Known& one : all) {
      const std::int64_t holds = co_await one.account.ask<&Account::holds>();
      expect(holds == one.holds, "round ", round, ": account ", one.number, " holds ", holds,
             ", not ", one.holds);
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
          plain[{number}].destroy();
        else
          doubling[{number}].destroy();
      });
    }
  }
}

}  // namespace

void interfaces(Case& test) {
  const std::uint64_t seed = test.random();
  const InterfaceDraws here{seed, 0.3 * test.draw(0, 2)};
  interface_draws = &here;
  const std::int32_t n_first = test.draw(1, 16), n_rounds = test.draw(1, 6);
  test.run_clean([&] { return run_rounds(n_first, n_rounds); });
}

}  // namespace tess::fuzz
