// Awaited replies between elements that migrate and end: values, coroutines that ask others in
// turn, errors, deadlines, asks that are given up, several at once, and delayed sends, some
// cancelled. The oracle is what each function would return, and a record of the calls: each one
// that was sent to a living element runs once, also if its reply is no longer wanted.
#include "runtime/more/when.hpp"
#include "tests/fuzz/protocols/scenarios.hpp"

#include <atomic>

namespace tess::fuzz {
namespace {

struct AskRecord {
  int n_elements = 0, n_destroyables = 0, n_asks = 0;
  std::uint64_t longest = 0;  // ns of a deadline or delay
  double move_chance = 0;
  std::atomic<std::uint64_t> n_asked{0}, n_served{0}, asked{0}, served{0};
  std::atomic<int> n_delayed{0}, n_cancelled{0}, n_arrived{0}, n_done{0};
};
AskRecord* ask_record = nullptr;

std::uint64_t answer_of(std::uint64_t question, int index) {
  return mix(question ^ static_cast<std::uint64_t>(index) << 40U);
}
bool refuses(std::uint64_t question) {
  return question % 7 == 0;
}

class Destroyable : public Chare<Destroyable, Index1> {
 public:
  [[nodiscard]] std::uint64_t age(std::uint64_t question) { return answer_of(question, index().x); }
  void end() { destroy(); }
  void serialize(auto& /*ar*/) {}
};

class Replier : public Chare<Replier, Index1> {
 public:
  [[nodiscard]] std::uint64_t value(std::uint64_t question) {
    serve(question);
    if (refuses(question)) fail(ErrorCode::bad_value, "refused ", question);
    return answer_of(question, index().x);
  }
  /// A coroutine that asks its neighbour before it replies.
  Task passes_on(std::uint64_t question, int depth) {
    serve(question);
    const auto next = array()[{(index().x + 1) % ask_record->n_elements}];
    if (depth > 0) {
      const std::uint64_t other = note(mix(question));
      co_await next.ask<&Replier::passes_on>(other, depth - 1);
    } else if (refuses(question)) {
      fail(ErrorCode::bad_value, "refused ", question);
    }
  }
  void arrive(std::uint64_t /*id*/) { ++ask_record->n_arrived; }

  Task work(std::uint64_t seed, ArrayProxy<Destroyable> destroyables) {
    Random random(mix(seed ^ static_cast<std::uint64_t>(index().x)));
    for (int n = 0; n < ask_record->n_asks; ++n) {
      switch (random.below(8)) {
        case 0:
        case 1:
          co_await ask_value(random);
          break;
        case 2:
          co_await ask_coroutine(random);
          break;
        case 3:
          co_await ask_within(random);
          break;
        case 4:
          co_await ask_two(random);
          break;
        case 5:
          co_await ask_or_sleep(random);
          break;
        case 6:
          send_later(random, n);
          break;
        default:
          co_await ask_destroyable(random, destroyables);
      }
      if (random.chance(ask_record->move_chance)) migrate_to(any_pe(random));
    }
    ++ask_record->n_done;
  }

  void serialize(auto& /*ar*/) {}

 private:
  Task ask_value(Random& random) {
    const std::uint64_t question = note(random());
    const int to = draw(random, ask_record->n_elements);
    std::uint64_t answer = 0;
    std::string refusal;
    try {
      answer = co_await array()[{to}].ask<&Replier::value>(question);
    } catch (const Error& error) {
      refusal = error.what();
    }
    check(question, to, answer, refusal);
  }
  Task ask_coroutine(Random& random) {
    const std::uint64_t question = note(random());
    const int depth = draw(random, 3);
    std::uint64_t last = question;
    for (int i = 0; i < depth; ++i) last = mix(last);
    bool refused = false;
    try {
      co_await array()[{draw(random, ask_record->n_elements)}].ask<&Replier::passes_on>(question,
                                                                                        depth);
    } catch (const Error& error) {
      refused = error.code() == ErrorCode::bad_value;
    }
    expect(refused == refuses(last), "a coroutine's error is lost or invented");
  }
  /// With a deadline: the value in time, or an error.
  Task ask_within(Random& random) {
    const std::uint64_t question = note(random() / 7 * 7 + 1);
    const int to = draw(random, ask_record->n_elements);
    std::uint64_t answer = 0;
    bool late = false;
    try {
      answer = co_await array()[{to}].ask<&Replier::value>(question).within(delay(random));
    } catch (const Error& error) {
      late = std::string(error.what()).find("did not come within") != std::string::npos;
    }
    expect(late ? answer == 0 : answer == answer_of(question, to),
           "a reply with a deadline is wrong");
  }
  Task ask_two(Random& random) {
    const std::uint64_t first = note(random() / 7 * 7 + 1);
    const std::uint64_t second = note(random() / 7 * 7 + 2);
    const int to = draw(random, ask_record->n_elements),
              other = draw(random, ask_record->n_elements);
    const auto [a, b] = co_await when_all(array()[{to}].ask<&Replier::value>(first),
                                          array()[{other}].ask<&Replier::value>(second));
    expect(a == answer_of(first, to) && b == answer_of(second, other),
           "when_all gives the values of other asks");
  }
  Task ask_or_sleep(Random& random) {
    const std::uint64_t question = note(random() / 7 * 7 + 3);
    const int to = draw(random, ask_record->n_elements);
    const Time limit = delay(random);
    const Time began = now();
    const auto first =
        co_await when_any(array()[{to}].ask<&Replier::value>(question), sleep(limit));
    if (first.index() == 0) {
      expect(std::get<0>(first) == answer_of(question, to), "when_any gives another value");
    } else {
      expect(now() >= began + limit, "when_any's time is over too early");
    }
  }
  void send_later(Random& random, int n) {
    const auto timer = array()[{draw(random, ask_record->n_elements)}].send_after<&Replier::arrive>(
        delay(random), static_cast<std::uint64_t>(n));
    ++ask_record->n_delayed;
    if (random.chance(0.3)) {  // before it can have run, since this code has not waited
      timer.cancel();
      ++ask_record->n_cancelled;
    }
    if (random.chance(0.3)) {
      (void)array()[{draw(random, ask_record->n_elements)}].ask<&Replier::value>(
          note(random()));  // given up at once
    }
  }
  Task ask_destroyable(Random& random, ArrayProxy<Destroyable> destroyables) {
    const std::uint64_t question = random();
    const int to = draw(random, ask_record->n_destroyables);
    std::uint64_t answer = 0;
    bool was_dead = false, is_dead = false;
    try {
      if (random.chance(0.2)) co_await destroyables[{to}].ask<&Destroyable::end>();
    } catch (const Error&) {
      was_dead = true;  // another one has ended it
    }
    try {
      answer = co_await destroyables[{to}].ask<&Destroyable::age>(question);
    } catch (const Error& error) {
      is_dead = std::string(error.what()).find("was destroyed") != std::string::npos;
    }
    expect(is_dead != (answer == answer_of(question, to)) && (is_dead || !was_dead),
           "an element is neither asked nor destroyed, or is there again");
  }
  static std::uint64_t note(std::uint64_t question) {
    ++ask_record->n_asked;
    ask_record->asked += question >> 8U;
    return question;
  }
  static void serve(std::uint64_t question) {
    ++ask_record->n_served;
    ask_record->served += question >> 8U;
  }
  static Time delay(Random& random) { return any_time(random, ask_record->longest); }
  static void check(std::uint64_t question, int to, std::uint64_t answer,
                    const std::string& refusal) {
    if (refuses(question)) {
      expect(refusal == text("refused ", question), "another error: ", refusal);
    } else {
      expect(answer == answer_of(question, to), "another answer; ", refusal);
    }
  }
};

Task run_asks(std::uint64_t seed) {
  const auto repliers = tess::create<Replier>(range(ask_record->n_elements));
  const auto destroyables = tess::create<Destroyable>(range(ask_record->n_destroyables));
  // An epoch waits for all replies and delayed sends, and without one the run does.
  if (seed % 2 == 0) {
    co_await epoch([&] { repliers.broadcast<&Replier::work>(seed, destroyables); });
    expect(ask_record->n_done == ask_record->n_elements, "an epoch ends before the asks in it");
    expect(ask_record->n_delayed - ask_record->n_cancelled == ask_record->n_arrived,
           "an epoch ends before the delayed messages of it");
  } else {
    repliers.broadcast<&Replier::work>(seed, destroyables);
  }
  // The main coroutine asks, too.
  const std::uint64_t question = 7 * (seed % 1000) + 1;
  ++ask_record->n_asked;
  ask_record->asked += question >> 8U;
  const std::uint64_t answer = co_await repliers[{0}].ask<&Replier::value>(question);
  expect(answer == answer_of(question, 0), "the main coroutine has another answer");
  // An epoch waits for the replies and the delayed sends that it caused.
  bool has_arrived = false;
  const Time began = now();
  co_await epoch([&] {
    after(Time(1000), [&has_arrived] { has_arrived = true; });
    after(Time(3'600'000'000'000), [] { expect(false, "a cancelled timer runs"); }).cancel();
  });
  expect(has_arrived && now() >= began + Time(1000), "an epoch left a timer behind");
}

}  // namespace

void asks(Case& test) {
  AskRecord here{test.draw(1, 12), test.draw(1, 6), test.draw(1, 12), 100ULL << test.draw(0, 12),
                 0.3 * test.draw(0, 2)};
  ask_record = &here;
  const std::uint64_t seed = test.random();
  test.run_clean([&]() -> Task { return run_asks(seed); });
  expect(here.n_done == here.n_elements, here.n_done.load(), " of ", here.n_elements,
         " elements have all replies");
  expect(here.n_asked == here.n_served && here.asked == here.served, here.n_asked.load(),
         " calls were sent, ", here.n_served.load(), " have run, or others");
  expect(here.n_delayed - here.n_cancelled == here.n_arrived, here.n_delayed.load(),
         " delayed messages, of which ", here.n_cancelled.load(), " were cancelled, ",
         here.n_arrived.load(), " have arrived");
}

}  // namespace tess::fuzz
