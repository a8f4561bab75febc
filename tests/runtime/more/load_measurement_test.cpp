// What limits a run: the numbers of given loads, those that --stats reports of runs with known
// costs, and those of a part of a run.
#include "runtime/more/load_measurement.hpp"

#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

namespace {

using std::chrono::milliseconds;

/// Works as it is told.
class Weight : public tess::Chare<Weight, tess::Index1> {
 public:
  void work(int ms) { tess::charge(milliseconds(ms)); }
  void work_often(int n, int ms) {
    tess::charge(milliseconds(ms));
    if (n > 1) array()[{index().x}].send<&Weight::work_often>(n - 1, ms);
  }
  void go_away(int ms) {
    tess::charge(milliseconds(ms));
    migrate_to(tess::PeId{1});
  }
  void end(int ms) {
    tess::charge(milliseconds(ms));
    destroy();
  }
  template <class Ar>
  void serialize(Ar& /*ar*/) {}
};

/// The sentence that --stats ends with.
template <class Main>
std::string sentence_of(const std::string& keys, Main main) {
  tess::RuntimeOptions options;
  options.statistics = true;
  const tests::Ending ending = tests::run(keys, main, options);
  REQUIRE(ending.exit_code == 0);
  const std::size_t at = ending.report.find("stats: PEs wait");
  REQUIRE(at != std::string::npos);
  CHECK(ending.report.find("stats: PE ", at) == std::string::npos);  // it is the last line
  return ending.report.substr(at + 7, ending.report.find('\n', at) - at - 7);
}

}  // namespace

TEST_CASE("what limits given loads", "[runtime][limits]") {
  std::vector<tess::PeLoad> pes(4, {.seconds = 5, .busy = 1, .in_elements = 0.75});
  pes[0].busy = 4;
  pes[1].busy = 2;
  const tess::LoadSummary known = tess::summarise(pes);
  CHECK(known.wait == Approx(1 - 8.0 / 20));
  CHECK(known.balance == Approx((4 - 2) / 5.0));
  CHECK(known.runtime == Approx((8 - 3) / 20.0));
  CHECK(known.element < 0);
  CHECK(describe(known) ==
        "PEs wait 60 % of the time; perfect balance would save 40 %; the runtime and its messages "
        "cost 25 %");
  pes[0].element = "Block[3,4]";
  pes[0].largest = 3.5;
  pes[2].element = "Block[0,0]";
  pes[2].largest = 1;
  pes[3].in_elements = -1;
  CHECK(describe(tess::summarise(pes)) ==
        "PEs wait 60 % of the time; perfect balance would save 40 %; the largest element, "
        "Block[3,4], allows 10 %");
  pes[0].largest = 4;
  CHECK(describe(tess::summarise(pes)) ==
        "PEs wait 60 % of the time; perfect balance would save 40 %; the largest element, "
        "Block[3,4], allows no balancer a gain");
  // PE 0 is twice as fast: the same element takes longer elsewhere.
  pes[0].speed = 2;
  const tess::LoadSummary fast = tess::summarise(pes);
  CHECK(fast.balance == Approx((4 - 12.0 / 5) / 5));
  CHECK(fast.element == 0);
  for (tess::PeLoad& pe : pes) pe.busy = 5 * pe.speed / 2;
  CHECK(describe(tess::summarise({pes[1], pes[2]})) ==
        "PEs wait 50 % of the time; nothing is to be gained by balance; the runtime and its "
        "messages cost 35 %");
  CHECK(describe(tess::summarise({})) == "the loads of PEs were not measured");
}

TEST_CASE("--stats names the element that is too large", "[runtime][limits]") {
  for (const char* keys :
       {"pes=4,cost=100ns,latency=1us", "pes=4,per-process=2,cost=100ns,latency=1us"})
    CHECK(sentence_of(keys,
                      []() -> tess::Task {
                        tess::ArrayProxy<Weight> weights;
                        co_await tess::epoch(
                            [&] { weights = tess::create<Weight>(tess::range(8)); });
                        for (int i = 0; i < 8; ++i)  // 4, 2, 1, 1 seconds per PE
                          weights[{i}].send<&Weight::work>(i == 0 ? 3000 : i < 4 ? 1000 : 500);
                      }) ==
          "PEs wait 50 % of the time; perfect balance would save 50 %; the largest element, "
          "Weight[0], allows 25 %; the runtime and its messages cost 0.0 %");
}

TEST_CASE("--stats says that balanced elements have nothing to gain, and what messages cost",
          "[runtime][limits]") {
  CHECK(sentence_of(
            "pes=4,cost=1ms,latency=1us",
            [] { tess::create<Weight>(tess::range(4)).broadcast<&Weight::work_often>(3000, 1); }) ==
        "PEs wait 0.1 % of the time; nothing is to be gained by balance; the runtime and its "
        "messages cost 50 %");
}

TEST_CASE("the load of an element goes with it, and counts after its end", "[runtime][limits]") {
  for (const char* keys :
       {"pes=2,cost=100ns,latency=1us", "pes=2,per-process=1,cost=100ns,latency=1us"})
    CHECK(sentence_of(
              keys,
              []() -> tess::Task {
                tess::ArrayProxy<Weight> weights;
                co_await tess::epoch([&] { weights = tess::create<Weight>(tess::range(4)); });
                co_await tess::epoch([&] {
                  weights[{0}].send<&Weight::go_away>(1000);  // the PEs work 2 s and 4 s of 6 s
                  weights[{1}].send<&Weight::work>(1000);
                });
                co_await tess::epoch([&] { weights[{0}].send<&Weight::end>(2500); });
                co_await tess::epoch([&] { weights[{2}].send<&Weight::work>(1500); });
                co_await tess::epoch([&] { weights.destroy(); });
              }) ==
          "PEs wait 50 % of the time; perfect balance would save 17 %; the largest element, "
          "Weight[0], allows 8.3 %; the runtime and its messages cost 0.0 %");
}

TEST_CASE("code of the main program is no message, and cannot be balanced", "[runtime][limits]") {
  CHECK(sentence_of("pes=2,cost=100ns,latency=1us",
                    []() -> tess::Task {
                      tess::charge(milliseconds(500));
                      co_await tess::epoch([] {});
                      tess::charge(milliseconds(500));
                    }) ==
        "PEs wait 50 % of the time; perfect balance would save 50 %; the largest element, the main "
        "program, allows no balancer a gain; the runtime and its messages cost 0.0 %");
}

TEST_CASE("a part of a run is measured by itself", "[runtime][limits]") {
  std::vector<tess::PeLoad> pes;
  REQUIRE(tests::run("pes=2,cost=100ns,latency=1us", [&pes]() -> tess::Task {
            tess::ArrayProxy<Weight> weights;
            co_await tess::epoch([&] { weights = tess::create<Weight>(tess::range(4)); });
            for (const int factor : {10, 1}) {
              tess::LoadMeasurement measurement;
              co_await measurement.begin();
              co_await tess::epoch([&] {  // 3 s and 1 s
                for (int i = 0; i < 4; ++i)
                  weights[{i}].send<&Weight::work>(factor * (i == 1 ? 2000 : i == 3 ? 0 : 1000));
              });
              co_await measurement.end(&pes);
              co_await tess::epoch([&] { weights[{3}].send<&Weight::work>(20'000); });
            }
          }).exit_code == 0);
  REQUIRE(pes.size() == 2);
  CHECK(pes[1].busy == Approx(1).epsilon(1e-3));
  CHECK(pes[0].element == "Weight[1]");
  CHECK(pes[0].largest == Approx(2));
  CHECK(describe(tess::summarise(pes)) ==
        "PEs wait 33 % of the time; perfect balance would save 33 %; the largest element, "
        "Weight[1], allows 33 %; the runtime and its messages cost 0.0 %");
}
