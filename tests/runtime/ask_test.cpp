// Awaited replies and what is waited for with them: late replies, mailboxes and futures that come
// second, delayed sends, the report of a deadlock.
#include "runtime/more/when.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

#include <string>

using namespace std::chrono_literals;

namespace {

struct Note {
  int key = 0;
  std::string text;
};

class Scribe : public tess::Chare<Scribe> {
 public:
  [[nodiscard]] int twice(int x) { return 2 * x; }
  void write(Note note) { box_.put(std::move(note)); }
  tess::Task read(tess::Callback<std::string> target) { target((co_await box_.take(1)).text); }
  /// The deadline comes first; the note is taken later.
  tess::Task read_late(tess::Callback<std::string> target) {
    const auto first = co_await tess::when_any(box_.take(1), tess::sleep(1ms));
    std::string seen = first.index() == 0 ? "at once " : "late ";
    seen += (co_await box_.take(1)).text;
    target(std::move(seen));
  }
  /// Both are there: the note that is not taken stays.
  tess::Task read_both(tess::Callback<std::string> target) {
    write_both();
    const auto first = co_await tess::when_any(box_.take(2), box_.take(3));
    std::string seen = std::get<0>(first).text;
    seen += (co_await box_.take(3)).text;
    target(std::move(seen));
  }
  void write_both() {
    write({2, "b"});
    write({3, "c"});
  }
  /// Both come in one message, while it waits for either.
  tess::Task wait_for_both(tess::Callback<std::string> target) {
    const auto first = co_await tess::when_any(box_.take(2), box_.take(3));
    std::string seen = std::get<0>(first).text;
    seen += (co_await box_.take(3)).text;
    target(std::move(seen));
  }
  tess::Task waits_for_ever(tess::ArrayProxy<Scribe> others) {
    co_await others[{1}].ask<&Scribe::asks_back>(others);
  }
  tess::Task asks_back(tess::ArrayProxy<Scribe> /*others*/) { co_await box_.take(99); }

 private:
  tess::Mailbox<&Note::key> box_;
};

int run_on(bool threads, std::function<tess::Task()> main, std::string* report = nullptr) {
  const tests::Ending ending =
      threads ? tests::run_threads(2, main) : tests::run("pes=2,cost=100ns", main);
  if (report != nullptr) *report += ending.report;
  return ending.exit_code;
}

}  // namespace

TEST_CASE("a reply that nothing waits for is dropped and counted", "[runtime][ask]") {
  std::uint64_t n_late = 0;
  REQUIRE(run_on(false, [&]() -> tess::Task {
            const auto scribes = tess::create<Scribe>(tess::range(4));
            co_await tess::epoch([&] {
              for (int x = 0; x < 4; ++x) (void)scribes[{x}].ask<&Scribe::twice>(x);
            });
            n_late = tess::current_pe().statistics().late_replies;
          }) == 0);
  CHECK(n_late == 4);
}

TEST_CASE("an epoch does not wait for the deadline of a reply that is there", "[runtime][ask]") {
  tess::Time waited{0};
  REQUIRE(run_on(false, [&]() -> tess::Task {
            const auto scribes = tess::create<Scribe>(tess::range(2));
            const tess::Time began = tess::now();
            int twice = 0;
            co_await tess::epoch([&]() -> tess::Task {
              twice = co_await scribes[{1}].ask<&Scribe::twice>(21).within(1h);
            });
            CHECK(twice == 42);
            waited = tess::now() - began;
          }) == 0);
  CHECK(waited > 0ns);
  CHECK(waited < 1s);
}

TEST_CASE("what comes second in when_any is not lost", "[runtime][ask]") {
  std::string late, both, met;
  int value = 0;
  bool was_there = true;
  REQUIRE(run_on(false, [&]() -> tess::Task {
            const auto scribes = tess::create<Scribe>(tess::range(2));
            tess::Future<std::string> seen, pair;
            scribes[{1}].send<&Scribe::read_late>(seen.callback());
            scribes[{1}].send_after<&Scribe::write>(5ms, Note{1, "news"});
            late = co_await seen;
            scribes[{0}].send<&Scribe::read_both>(pair.callback());
            both = co_await pair;
            tess::Future<std::string> other;
            scribes[{0}].send<&Scribe::wait_for_both>(other.callback());
            scribes[{0}].send_after<&Scribe::write_both>(1ms);
            met = co_await other;
            tess::Future<int> future;
            tess::after(2ms, future.callback(), 7);
            const auto first = co_await tess::when_any(future, tess::sleep(1ms));
            was_there = first.index() == 0;
            value = co_await future;
          }) == 0);
  CHECK(late == "late news");
  CHECK(both == "bc");
  CHECK(met == "bc");
  CHECK_FALSE(was_there);
  CHECK(value == 7);
}

TEST_CASE("a delayed message is sent once its time has come, unless it is cancelled",
          "[runtime][ask][timers][threads]") {
  for (const bool threads : {false, true}) {
    std::string seen;
    tess::Time waited{0};
    REQUIRE(run_on(threads, [&]() -> tess::Task {
              const auto scribes = tess::create<Scribe>(tess::range(2));
              tess::Future<std::string> first;
              const tess::Time began = tess::now();
              scribes[{1}].send<&Scribe::read>(first.callback());
              scribes[{1}].send_after<&Scribe::write>(3ms, Note{1, "cancelled"}).cancel();
              scribes[{1}].send_after<&Scribe::write>(4ms, Note{1, "kept"});
              scribes[{1}].send_after<&Scribe::write>(1h, Note{1, "never"}).cancel();
              seen = co_await first;
              waited = tess::now() - began;
            }) == 0);
    CHECK(seen == "kept");
    CHECK(waited >= 4ms);
  }
}

TEST_CASE("a deadlock names the reply that is missing", "[runtime][ask]") {
  std::string report;
  const int code = run_on(
      false,
      []() -> tess::Task {
        const auto scribes = tess::create<Scribe>(tess::range(2));
        co_await scribes[{0}].ask<&Scribe::waits_for_ever>(scribes);
      },
      &report);
  CHECK(code == 1);
  CHECK(report.find("the reply of Scribe[1].asks_back") != std::string::npos);
  CHECK(report.find("the reply of Scribe[0].waits_for_ever") != std::string::npos);
}
