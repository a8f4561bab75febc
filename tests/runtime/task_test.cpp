// Tasks that give values: of all types, several at once, errors, and what becomes of the value of a
// task that nothing awaits. Awaited in expressions, since g++ 12 has destroyed temporaries twice.
#include "runtime/more/testing.hpp"
#include "runtime/more/when.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"

#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

using namespace std::chrono_literals;

namespace {

/// Counts what lives: a second destruction makes it negative.
int n_alive = 0;  // one thread runs all simulated PEs
struct Alive {
  Alive() { ++n_alive; }
  Alive(const Alive& /*other*/) { ++n_alive; }
  Alive(Alive&& /*other*/) noexcept { ++n_alive; }
  Alive& operator=(const Alive&) = default;
  Alive& operator=(Alive&&) = default;
  ~Alive() { --n_alive; }
};

/// An aggregate, which needs a destructor.
struct Parcel {
  std::string text;
  std::vector<int> numbers;
  Alive alive{};
};

/// Neither a copy nor a default constructor.
class Sealed {
 public:
  explicit Sealed(int number) : number_(std::make_unique<int>(number)) {}
  [[nodiscard]] int number() const { return *number_; }

 private:
  std::unique_ptr<int> number_;
  Alive alive_;
};

class Depot : public tess::Chare<Depot> {
 public:
  [[nodiscard]] int weight(int n) const { return 10 * n + index().x; }
  /// Over another element, and not before a time.
  tess::TaskOf<Parcel> fetch(int n) {
    const int weight = co_await array()[{(index().x + 1) % 4}].ask<&Depot::weight>(n);
    co_return Parcel{"parcel " + std::to_string(weight), {weight, n}};
  }
  tess::TaskOf<std::unique_ptr<int>> refuse(bool late) {
    if (late) co_await tess::sleep(2us);
    tess::fail(tess::ErrorCode::bad_value, "depot ", index().x, " is shut");
    co_return nullptr;
  }
  /// Calls a task of its own, as an object.
  tess::TaskOf<std::string> twice(int n) {
    const std::string first = (co_await fetch(n)).text;
    co_return first + " and " + (co_await fetch(n + 1)).text;
  }
};
using Depots = tess::ArrayProxy<Depot>;

tess::TaskOf<std::string> text_of(Depots depots, int n, bool late) {
  if (late) co_await tess::sleep(1us);
  const int weight = co_await depots[{n}].ask<&Depot::weight>(n);
  co_return "a text that is too long for the string itself: " + std::to_string(weight);
}
tess::TaskOf<std::string> at_once() {
  co_return "at once";
}
tess::TaskOf<Sealed> seal(Depots depots, int n) {
  Sealed sealed(co_await depots[{0}].ask<&Depot::weight>(n));
  co_return sealed;
}
tess::TaskOf<std::vector<Parcel>> collect(Depots depots, int n) {
  std::vector<Parcel> parcels;
  for (int x = 0; x < n; ++x) parcels.push_back(co_await depots[{x}].ask<&Depot::fetch>(x));
  co_return parcels;
}
/// Passes the value of another task on.
tess::TaskOf<Parcel> pass(Depots depots, int depth) {
  if (depth == 0) co_return Parcel{"deep", {1, 2, 3}};
  if (depth % 3 == 0) co_await tess::sleep(1us);
  co_return co_await pass(depots, depth - 1);
}
/// Half of the tasks run into an error, a part of them before they wait.
tess::TaskOf<int> add(Depots depots, int x, std::string& log) {
  if (x == 1) tess::fail(tess::ErrorCode::bad_value, "no ", x);
  const int weight = co_await depots[{x}].ask<&Depot::weight>(x);
  log += std::to_string(weight) + " ";
  if (x == 2) tess::fail(tess::ErrorCode::bad_value, "no ", x);
  co_return weight;
}
tess::TaskOf<std::pair<int, int>> not_int() {
  co_await tess::sleep(1us);
  throw 7;
  co_return {1, 2};
}

struct Seen {
  std::vector<std::string> texts;
  std::vector<int> numbers;
  bool operator==(const Seen&) const = default;
};

tess::Task await_values(Seen& seen) {
  const auto depots = tess::create<Depot>(tess::range(4));
  const std::string plain = co_await text_of(depots, 2, true);
  seen.texts.push_back(plain);
  // In an expression, in conditions, in the middle of other temporaries.
  seen.texts.push_back(std::string("<") + co_await text_of(depots, 3, false) + "> " +
                       co_await at_once());
  if ((co_await at_once()).size() == 7) seen.numbers.push_back(7);
  seen.numbers.push_back(static_cast<int>((co_await text_of(depots, 1, true)).size()) * 2 +
                         (co_await seal(depots, 4)).number());
  seen.texts.push_back(co_await at_once() == "at once" ? "yes" : "no");
  for (const Parcel& parcel : co_await collect(depots, 4)) seen.texts.push_back(parcel.text);
  const auto [text, numbers, alive] = co_await pass(depots, 20);
  seen.texts.push_back(text);
  seen.numbers.push_back(static_cast<int>(numbers.size()));
  // A task that is kept, and one that is done before it is awaited.
  auto one = pass(depots, 3), other = pass(depots, 7), done = pass(depots, 0);
  co_await tess::sleep(1ms);
  Parcel parcel = co_await other;
  parcel = co_await one;
  std::optional<Parcel> kept;
  kept = co_await done;
  seen.texts.push_back(parcel.text + kept->text);
  // An entry method that gives a value, asked; its elements may be on any PE.
  seen.texts.push_back(co_await depots[{3}].ask<&Depot::twice>(5));
  const Sealed sealed = co_await seal(depots, 1);
  seen.numbers.push_back(sealed.number());
}

tess::Task await_errors(Seen& seen) {
  const auto depots = tess::create<Depot>(tess::range(4));
  for (const bool late : {false, true}) {
    try {
      const std::unique_ptr<int> none = co_await depots[{1}].ask<&Depot::refuse>(late);
      seen.numbers.push_back(none == nullptr ? 0 : 1);
    } catch (const tess::Error& error) {
      seen.texts.emplace_back(error.what());
    }
  }
  std::string log;
  try {
    (void)co_await add(depots, 1, log);
  } catch (const tess::Error& error) {
    seen.texts.emplace_back(error.what());
  }
  try {
    (void)co_await not_int();
  } catch (const int number) {
    seen.numbers.push_back(number);
  }
  // All tasks come to their end, also if one fails.
  std::vector<tess::TaskOf<int>> tasks;
  for (int x = 0; x < 4; ++x) tasks.push_back(add(depots, x, log));
  try {
    (void)co_await tess::when_all(std::move(tasks));
  } catch (const tess::Error& error) {
    seen.texts.emplace_back(error.what());
    seen.numbers.push_back(static_cast<int>(log.size()));
  }
  std::vector<tess::TaskOf<Parcel>> parcels;
  for (int depth = 5; depth > 0; --depth) parcels.push_back(pass(depots, depth));
  for (const Parcel& parcel : co_await tess::when_all(std::move(parcels)))
    seen.texts.push_back(parcel.text);
}

/// The epoch waits for them, and their values are dropped.
tess::Task await_none(Seen& seen) {
  const auto depots = tess::create<Depot>(tess::range(4));
  co_await tess::epoch([&] {
    (void)pass(depots, 9);
    (void)pass(depots, 0);
    const auto kept = collect(depots, 4);
  });
  seen.numbers.push_back(n_alive);
}

void on_schedules(tess::Task (*program)(Seen&), const Seen& want) {
  tess::test::for_seeds(0, 100, [&](std::uint64_t seed) {
    Seen seen;
    n_alive = 0;
    const tess::test::Machine machine{.pes = 1 + static_cast<int>(seed % 4), .seed = seed};
    machine.run([&]() -> tess::Task { return program(seen); }).require_success();
    tess::test::expect(seen == want, tess::text(seen.texts.size(), " texts, the last ",
                                                seen.texts.empty() ? "" : seen.texts.back()));
    tess::test::expect(n_alive == 0, n_alive, " values are left");
  });
}

}  // namespace

TEST_CASE("a task gives a value of any type that can be moved", "[runtime][task]") {
  const std::string text = "a text that is too long for the string itself: ";
  on_schedules(&await_values,
               {{text + "22", "<" + text + "33> at once", "yes", "parcel 1", "parcel 12",
                 "parcel 23", "parcel 30", "deep", "deepdeep", "parcel 50 and parcel 60"},
                {7, 2 * (static_cast<int>(text.size()) + 2) + 40, 3, 10}});
}

TEST_CASE("an error passes from a task that gives a value", "[runtime][task]") {
  on_schedules(&await_errors, {{"depot 1 is shut", "depot 1 is shut", "no 1", "no 1", "deep",
                                "deep", "deep", "deep", "deep"},
                               {7, 8}});
}

TEST_CASE("the value of a task that nothing awaits is dropped", "[runtime][task]") {
  on_schedules(&await_none, {{}, {0}});
}

TEST_CASE("an error of a task that nothing awaits ends the run", "[runtime][task]") {
  const tess::test::Machine machine{.pes = 2, .seed = 3};
  const auto result = machine.run([]() -> tess::Task {
    const auto lost = not_int();
    co_await tess::sleep(1ms);
  });
  CHECK_FALSE(result.ok());
}
