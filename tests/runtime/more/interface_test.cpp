// Elements of different classes that are called through an interface, while they migrate.
#include "runtime/more/interface.hpp"

#include "runtime/more/singleton.hpp"
#include "runtime/more/testing.hpp"
#include "runtime/more/when.hpp"
#include "runtime/runtime.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"

#include <string>

namespace {

class Account {
 public:
  Account() = default;
  Account(const Account&) = delete;
  Account& operator=(const Account&) = delete;
  virtual ~Account() = default;

  virtual void pay(std::int64_t amount) = 0;
  virtual tess::Task close(tess::Callback<std::string> target) = 0;
  [[nodiscard]] virtual std::int64_t balance() const = 0;
  virtual std::int64_t withdraw(std::int64_t amount) = 0;
  virtual void add_up(const tess::Callback<std::int64_t>& target) = 0;
  /// Not virtual: it is a member of the interface itself.
  void pay_twice(std::int64_t amount) {
    pay(amount);
    pay(amount);
  }
  using EntryAttributes =
      tess::Attributes<tess::EntryMethod<&Account::pay_twice, tess::Priority{-3}>>;
};

struct Key {
  int key = 0;
};

/// The interface is the second base: it is not where the element begins.
class Savings : public tess::Chare<Savings>, public Account {
 public:
  void pay(std::int64_t amount) override { sum_ += 2 * amount; }
  tess::Task close(tess::Callback<std::string> target) override {
    (void)co_await keys_.take(1);
    target("savings");
  }
  void unlock() { keys_.put({1}); }
  [[nodiscard]] std::int64_t balance() const override { return sum_; }
  std::int64_t withdraw(std::int64_t amount) override {
    if (amount > sum_)
      tess::fail(tess::ErrorCode::bad_value, "savings ", index().x, " have ", sum_);
    sum_ -= amount;
    return amount;
  }
  void add_up(const tess::Callback<std::int64_t>& target) override {
    contribute(tess::sum, balance(), target);
  }
  void serialize(auto& ar) { ar(sum_, keys_); }

 private:
  std::int64_t sum_ = 0;
  tess::Mailbox<&Key::key> keys_;
};

/// The interface is the first base, and the state is larger.
class Debt : public Account, public tess::Chare<Debt> {
 public:
  explicit Debt(std::int64_t sum = 0) : parts_{0, -sum} {}
  void pay(std::int64_t amount) override { parts_.push_back(amount); }
  tess::Task close(tess::Callback<std::string> target) override {
    target("debt");
    co_return;
  }
  [[nodiscard]] std::int64_t balance() const override {
    std::int64_t sum = 0;
    for (const std::int64_t part : parts_) sum += part;
    return sum;
  }
  std::int64_t withdraw(std::int64_t amount) override {
    parts_.push_back(-amount);
    return amount;
  }
  void add_up(const tess::Callback<std::int64_t>& target) override {
    contribute(tess::sum, balance(), target);
  }
  void serialize(auto& ar) { ar(parts_); }

 private:
  std::vector<std::int64_t> parts_;
};

using Any = tess::InterfaceProxy<Account>;

/// Has proxies of the others, which migrate with it, and pays to all.
class Bank : public tess::Chare<Bank> {
 public:
  void open(std::vector<Any> accounts) { accounts_ = std::move(accounts); }
  tess::Task pay_all(std::int64_t amount) {
    for (const Any& account : accounts_) account.send<&Account::pay>(amount);
    std::int64_t all = 0;
    for (const Any& account : accounts_) all += co_await account.ask<&Account::withdraw>(0);
    tess::test::expect(all == 0, "withdrawn ", all);
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(accounts_);
  }

 private:
  std::vector<Any> accounts_;
};

struct Statement {
  std::vector<std::int64_t> balances;
  std::int64_t of_savings = 0, of_debts = 0;
  std::string error, closed, debt;
  bool equal = false;
};

tess::Task bank(Statement& found) {
  const auto savings = tess::create<Savings>(tess::range(3));
  const auto debts = tess::create<Debt>(tess::range(2), std::int64_t{100});
  const auto last = tess::create<Debt>(tess::one, std::int64_t{7});
  const auto banks = tess::create<Bank>(tess::range(2));
  const std::vector<Any> all{savings[{0}], debts[{0}], savings[{1}],
                             debts[{1}],   last,       savings[{2}]};
  found.equal = all[0] == Any(savings[{0}]) && !(all[0] == Any(savings[{1}])) &&
                !(all[0] == Any(debts[{0}])) &&
                all[0] == tess::InterfaceArray<Account>(savings)[{0}];
  co_await tess::epoch([&] { banks.broadcast<&Bank::open>(all); });
  co_await tess::epoch([&] { banks.broadcast<&Bank::pay_all>(5); });
  co_await tess::epoch([&] {
    for (int i = 0; i < 6; ++i) all[static_cast<std::size_t>(i)].send<&Account::pay_twice>(i);
    const tess::InterfaceArray<Account> both[] = {savings, debts};
    for (const auto& array : both) array.broadcast<&Account::pay>(1000);
    both[1][{1}].send<&Account::pay>(20000);
    const auto target = all[3].target<&Account::pay>();
    target(10000);
  });
  for (const Any& account : all) {
    const std::int64_t balance = co_await account.ask<&Account::balance>();
    found.balances.push_back(balance);
  }
  found.of_savings = co_await tess::InterfaceArray<Account>(savings).reduce<&Account::add_up>();
  found.of_debts = co_await tess::InterfaceArray<Account>(debts).reduce<&Account::add_up>();
  try {
    (void)co_await all[0].ask<&Account::withdraw>(1000000);
  } catch (const tess::Error& error) {
    found.error = error.what();
  }
  tess::Future<std::string> closed, debt;
  auto closing = all[2].ask<&Account::close>(closed.callback());
  savings[{1}].send<&Savings::unlock>();
  co_await closing;
  found.closed = co_await closed;
  all[1].send<&Account::close>(debt.callback());
  found.debt = co_await debt;
}

void check_statement(const Statement& found) {
  // Twice 5 from two banks, then twice i, and 1000 for the elements of the arrays; one gets more.
  const std::vector<std::int64_t> expected{2 * 10 + 0 + 2000, -100 + 10 + 2 + 1000,
                                           2 * 10 + 8 + 2000, -100 + 10 + 6 + 1000 + 20000 + 10000,
                                           -7 + 10 + 8,       2 * 10 + 20 + 2000};
  tess::test::expect(found.balances == expected, "balances");
  tess::test::expect(found.of_savings == expected[0] + expected[2] + expected[5], found.of_savings);
  tess::test::expect(found.of_debts == expected[1] + expected[3], found.of_debts);
  tess::test::expect(found.error == "savings 0 have 2020", found.error);
  tess::test::expect(found.closed == "savings" && found.debt == "debt", found.closed, found.debt);
  tess::test::expect(found.equal, "equal proxies");
}

/// Both calls are ready before one of them runs.
tess::Task send_with_priorities(std::vector<std::int64_t>& balances) {
  const auto debt = tess::create<Debt>(tess::one_on(tess::PeId{0}), std::int64_t{50});
  const Any account = debt;
  (void)co_await account.ask<&Account::balance>();
  auto after = account.ask<&Account::balance>();
  auto between = account.with(tess::Priority{-2}).ask<&Account::balance>();
  account.send<&Account::pay_twice>(5);  // its priority is -3
  account.with(tess::expedited).send<&Account::pay>(1000);
  auto before = account.with(tess::expedited).ask<&Account::balance>();
  account.send<&Account::pay>(100);
  account.send_after<&Account::pay>(std::chrono::milliseconds(1), 7);
  balances.push_back(co_await before);
  balances.push_back(co_await between);
  balances.push_back(co_await after);
  co_await tess::sleep(std::chrono::milliseconds(2));
  balances.push_back(co_await account.ask<&Account::balance>());
}

tess::Task wait_for_ever() {
  const auto savings = tess::create<Savings>(tess::range(2));
  tess::Future<std::string> closed;
  co_await Any(savings[{1}]).ask<&Account::close>(closed.callback());
}

tess::Task ask_the_dead(std::string& error) {
  const auto savings = tess::create<Savings>(tess::range(2));
  co_await tess::epoch([&] { savings[{1}].destroy(); });
  try {
    (void)co_await Any(savings[{1}]).ask<&Account::balance>();
  } catch (const tess::Error& thrown) {
    error = thrown.what();
  }
}

}  // namespace

TEST_CASE("an interface calls what the element's class overrides, wherever it has migrated",
          "[runtime][interface]") {
  tess::test::for_seeds(0, 150, [](std::uint64_t seed) {
    Statement found;
    const tess::test::Machine machine{.pes = 1 + static_cast<int>(seed % 5), .seed = seed};
    machine.run([&]() -> tess::Task { return bank(found); }).require_success();
    check_statement(found);
  });
}

TEST_CASE("an interface calls elements on the machine of threads",
          "[runtime][interface][threads]") {
  Statement found;
  tess::Setup setup{tess::make_threads_machine(3), {}};
  REQUIRE(tess::run(setup, [&]() -> tess::Task { return bank(found); }) == 0);
  check_statement(found);
}

TEST_CASE("messages through an interface have priorities", "[runtime][interface]") {
  std::vector<std::int64_t> balances;
  const tess::test::Machine machine{.pes = 2, .reordering = 0, .migration = 0.0};
  machine.run([&]() -> tess::Task { return send_with_priorities(balances); }).require_success();
  CHECK(balances == std::vector<std::int64_t>{950, 960, 960, 1067});
}

TEST_CASE("reports of an ask through an interface name the interface and the element",
          "[runtime][interface]") {
  const tess::test::Machine machine{.pes = 2};
  const auto result = machine.run(&wait_for_ever);
  CHECK(result.exit_code == 1);
  CHECK(result.failure().find("the reply of Account[1].close") != std::string::npos);
  std::string error;
  machine.run([&]() -> tess::Task { return ask_the_dead(error); }).require_success();
  CHECK(error.find("Account[1].balance is asked, but the element was destroyed") !=
        std::string::npos);
}
