// Coroutines that give values (TaskOf), asked over elements that migrate between two calls: chains
// over several elements, several at once, values of any size, errors that pass through all of them;
// asks to elements that are inserted later, or that the ask itself creates; and timers that an
// element cancels where it is then. The oracle: each value is what a serial function gives, each
// error comes where a function throws, and no cancelled timer runs. It needs no common memory.
#include "runtime/more/when.hpp"
#include "tests/fuzz/protocols/scenarios.hpp"

#include <chrono>
#include <memory>
#include <utility>

namespace tess::fuzz {
namespace {

/// What the seed says; the same on all processes.
struct ValueDraws {
  std::uint64_t seed = 0;
  int n_elements = 0, n_steps = 0;
  double move_chance = 0;
};
const ValueDraws* value_draws = nullptr;

// The functions, as a serial program has them.

std::uint64_t value_of(int index, std::uint64_t question) {
  return mix(question ^ static_cast<std::uint64_t>(index) << 40U);
}
bool throws_on(std::uint64_t question) {
  return question % 11 == 0;
}
/// Nothing if a function throws.
std::optional<std::uint64_t> chain_of(int index, std::uint64_t question, int depth) {
  if (depth == 0) {
    if (throws_on(question)) return {};
    return value_of(index, question);
  }
  const auto of_next = chain_of((index + 1) % value_draws->n_elements, mix(question), depth - 1);
  if (!of_next) return {};
  return mix(*of_next + value_of(index, question));
}
std::string words_of(int index, std::uint64_t question) {
  return std::string(question % 3000, static_cast<char>('a' + index % 26));
}

/// A value with memory of its own.
struct Reply {
  std::uint64_t value = 0;
  std::string words;
  std::vector<std::uint64_t> numbers;
};

/// Is inserted some time after it is asked, or before.
class InsertedLate : public Chare<InsertedLate, std::uint64_t> {
 public:
  TaskOf<std::uint64_t> value(std::uint64_t question) {
    if (question % 2 == 0) co_await sleep(Time(static_cast<std::int64_t>(question % 1000)));
    co_return value_of(7, question ^ index());
  }
  void serialize(auto& /*ar*/) {}
};
/// Is created by what asks it.
class MadeOnDemand : public Chare<MadeOnDemand, std::uint64_t> {
 public:
  TaskOf<std::uint64_t> at_home(std::uint64_t question) { return count(question); }
  TaskOf<std::uint64_t> here(std::uint64_t question) { return count(question); }
  void move_on(PeId pe) { migrate_to(pe); }
  using EntryAttributes = Attributes<EntryMethod<&MadeOnDemand::at_home, create_home>,
                                     EntryMethod<&MadeOnDemand::here, create_here, Priority{-3}>>;
  void serialize(auto& ar) { ar(n_asked_); }

 private:
  TaskOf<std::uint64_t> count(std::uint64_t question) {
    ++n_asked_;
    if (question % 2 == 0) co_await sleep(Time(static_cast<std::int64_t>(question % 1000)));
    co_return n_asked_ << 32U | (value_of(8, question) >> 32U);
  }
  std::uint64_t n_asked_ = 0;
};

struct ValueWork {
  std::int32_t n_left = 0;
  ArrayProxy<InsertedLate> late;
  ArrayProxy<MadeOnDemand> demanded;
};

class ValueElement : public Chare<ValueElement, Index1> {
 public:
  TaskOf<std::uint64_t> chain(std::uint64_t question, int depth) {
    Random random(mix(question + static_cast<std::uint64_t>(depth)));
    if (random.chance(value_draws->move_chance)) migrate_to(any_pe(random));  // once this is done
    if (random.chance(0.3)) co_await sleep(any_time(random, 3000));
    if (depth == 0) {
      if (throws_on(question)) fail(ErrorCode::bad_value, "refused ", question);
      co_return value_of(index().x, question);
    }
    const std::uint64_t of_next =
        co_await array()[{(index().x + 1) % value_draws->n_elements}].ask<&ValueElement::chain>(
            mix(question), depth - 1);
    co_return mix(of_next + value_of(index().x, question));
  }
  /// Asks all elements at once.
  TaskOf<Reply> collect(std::uint64_t question) {
    std::vector<TaskOf<std::uint64_t>> tasks;
    for (int x = 0; x < value_draws->n_elements; ++x) tasks.push_back(ask_for(x, question));
    Reply reply{0, words_of(index().x, question), {}};
    reply.numbers = co_await when_all(std::move(tasks));
    for (const std::uint64_t number : reply.numbers) reply.value += number;
    co_return reply;
  }
  [[nodiscard]] TaskOf<std::unique_ptr<Reply>> sealed(std::uint64_t question) {
    Reply reply = co_await collect(question);
    co_return std::make_unique<Reply>(std::move(reply));
  }
  void insert_late(ArrayProxy<InsertedLate> late, std::uint64_t name) { late[name].insert(); }
  void never() { expect(false, "a timer that was cancelled elsewhere runs"); }

  /// One step, then a message to itself with the next: between them it may migrate.
  Task work(ValueWork work) {
    Random random(
        mix(value_draws->seed ^ mix(static_cast<std::uint64_t>(work.n_left * 1000 + index().x))));
    if (random.chance(0.5)) {
      alarm_.cancel();
      alarm_ = self().send_after<&ValueElement::never>(std::chrono::hours(1));
    }
    switch (work.n_left == 0 ? 5 : random.below(5)) {
      case 0:
        co_await ask_chains(random);
        break;
      case 1:
        co_await ask_replies(random);
        break;
      case 2:
        co_await ask_late(work, random);
        break;
      case 3:
        co_await ask_on_demand(work, random);
        break;
      case 4:
        co_await ask_in_time(random);
        break;
      default:
        alarm_.cancel();
        ++n_done_;
        co_return;
    }
    if (random.chance(value_draws->move_chance)) migrate_to(any_pe(random));
    --work.n_left;
    self().send<&ValueElement::work>(work);
  }
  void report(Callback<int> target) { contribute(sum, n_done_, std::move(target)); }

  void serialize(auto& ar) { ar(n_done_, alarm_); }

 private:
  TaskOf<std::uint64_t> ask_for(int x, std::uint64_t question) {
    const std::uint64_t value =
        co_await array()[{x}].ask<&ValueElement::chain>(question / 11 * 11 + 1, 0);
    co_return value;
  }
  /// Two at once, awaited in the other order; each may fail.
  Task ask_chains(Random& random) {
    const std::uint64_t first = random(), second = random();
    const int to = draw(random, value_draws->n_elements), depth = draw(random, 4);
    auto one = array()[{to}].ask<&ValueElement::chain>(first, depth);
    auto other = chain(second, depth);
    std::optional<std::uint64_t> of_one, of_other;
    try {
      const std::uint64_t value = co_await other;
      of_other = value;
    } catch (const Error& error) {
      check(error);
    }
    try {
      const std::uint64_t value = co_await one;
      of_one = value;
    } catch (const Error& error) {
      check(error);
    }
    expect(of_one == chain_of(to, first, depth), "another value of a chain");
    expect(of_other == chain_of(index().x, second, depth), "another value of an own chain");
  }
  Task ask_replies(Random& random) {
    const std::uint64_t question = random();
    const int to = draw(random, value_draws->n_elements),
              other = draw(random, value_draws->n_elements);
    const auto [reply, sealed] =
        co_await when_all(array()[{to}].ask<&ValueElement::collect>(question),
                          array()[{other}].ask<&ValueElement::sealed>(question));
    check_reply(reply, to, question);
    expect(sealed != nullptr, "a reply is lost");
    if (sealed) check_reply(*sealed, other, question);
  }
  Task ask_late(ValueWork work, Random& random) {
    const std::uint64_t name = random(), question = random();
    const auto insert_late = [&] {
      array()[{draw(random, value_draws->n_elements)}].send<&ValueElement::insert_late>(work.late,
                                                                                        name);
    };
    const bool first = random.chance(0.3);
    if (first) insert_late();
    auto reply = work.late[name].ask<&InsertedLate::value>(question);
    if (!first && random.chance(0.5)) co_await sleep(any_time(random, 5000));
    if (!first) insert_late();
    const std::uint64_t value = co_await reply;
    expect(value == value_of(7, question ^ name), "another value of a late_element");
    if (random.chance(0.5)) work.late[name].destroy();
  }
  Task ask_on_demand(ValueWork work, Random& random) {
    const std::uint64_t name = random();
    const auto element = work.demanded[name];
    const int n = 1 + draw(random, 4);
    for (int k = 1; k <= n; ++k) {
      const std::uint64_t question = random();
      std::uint64_t value = 0;
      if (random.chance(0.5)) {
        value = co_await element.ask<&MadeOnDemand::at_home>(question);
      } else {
        value = co_await element.ask<&MadeOnDemand::here>(question);
      }
      expect(value == (static_cast<std::uint64_t>(k) << 32U | value_of(8, question) >> 32U),
             "another value of an element on demand, or of another element");
      if (random.chance(0.3)) element.migrate_to(any_pe(random));
    }
  }
  /// The value in time, or an error; the call runs to its end.
  Task ask_in_time(Random& random) {
    const std::uint64_t question = random() / 11 * 11 + 1;
    const int to = draw(random, value_draws->n_elements);
    const Time limit = any_time(random, 20'000);
    std::optional<std::uint64_t> value;
    try {
      value = co_await array()[{to}].ask<&ValueElement::chain>(question, 0).within(limit);
    } catch (const Error& error) {
      expect(std::string(error.what()).find("did not come within") != std::string::npos,
             "another error: ", error.what());
    }
    expect(!value || *value == value_of(to, question), "another value before a deadline");
  }
  static void check(const Error& error) {
    expect(std::string(error.what()).starts_with("refused "), "another error: ", error.what());
  }
  static void check_reply(const Reply& reply, int from, std::uint64_t question) {
    std::uint64_t want = 0;
    for (int x = 0; x < value_draws->n_elements; ++x) want += value_of(x, question / 11 * 11 + 1);
    expect(reply.value == want && reply.words == words_of(from, question) &&
               std::ssize(reply.numbers) == value_draws->n_elements,
           "another reply of ", from);
  }

  int n_done_ = 0;
  Timer alarm_;
};

TaskOf<int> count_done(ArrayProxy<ValueElement> elements) {
  const int n = co_await elements.reduce<&ValueElement::report>();
  co_return n;
}

Task ask_everywhere(std::uint64_t seed) {
  const auto elements = tess::create<ValueElement>(range(value_draws->n_elements));
  const ValueWork work{value_draws->n_steps, tess::create<InsertedLate>(sparse),
                       tess::create<MadeOnDemand>(sparse)};
  const Time began = now();
  co_await epoch([&] { elements.broadcast<&ValueElement::work>(work); });
  expect(now() - began < std::chrono::hours(1), "an epoch waits for dead timers");
  const int n_done = co_await count_done(elements);
  expect(n_done == value_draws->n_elements, n_done, " elements of ", value_draws->n_elements,
         " have done their work");
  // The main coroutine asks, too.
  const Reply reply = co_await elements[{0}].ask<&ValueElement::collect>(seed);
  expect(reply.words == words_of(0, seed), "the main coroutine has another reply");
}

}  // namespace

void values(Case& test) {
  const std::uint64_t seed = test.random();
  const ValueDraws here{seed, test.draw(1, 10), test.draw(1, 12), 0.3 * test.draw(0, 2)};
  value_draws = &here;
  test.run_clean([&]() -> Task { return ask_everywhere(seed); });
}

}  // namespace tess::fuzz
