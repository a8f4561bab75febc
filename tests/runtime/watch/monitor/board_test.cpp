// What process 0 makes of samples: frames, pictures, heat maps; and the options of --monitor.
#include "runtime/watch/monitor/board.hpp"

#include "runtime/run.hpp"
#include "runtime/wire/machine/simulated.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <nlohmann/json.hpp>
#include <string>

using nlohmann::json;
using tess::detail::Board;
using tess::detail::Event;
using tess::detail::HeatBy;
using tess::detail::HeatMapId;
using tess::detail::HeatQuery;
using tess::detail::PeSample;

namespace {

std::unique_ptr<tess::Machine> machine_of(int n_pes) {
  tess::SimulatedOptions options;
  options.n_pes = n_pes;
  return tess::make_simulated_machine(options);
}
PeSample sample(int pe, int at_ms, int idle_ms, std::uint64_t messages, std::uint64_t n_local = 0) {
  PeSample out;
  out.pe = tess::PeId{pe};
  out.at_ns = at_ms * 1'000'000LL;
  out.idle_ns = idle_ms * 1'000'000LL;
  out.counts.messages = messages;
  if (n_local != 0) out.collections.push_back({tess::CollectionId{7}, "Block", n_local});
  return out;
}
std::string nothing(tess::PeId /*pe*/) {
  return {};
}
/// The new events of heat maps.
std::vector<Event> heat_events(Board& board) {
  std::vector<Event> events = board.take_events(1, &nothing);
  std::erase_if(events, [](const Event& event) { return event.kind != "heat"; });
  return events;
}
json last_frame(Board& board, double seconds) {
  const std::vector<Event> events = board.take_events(seconds, &nothing);
  for (const Event& event : events)
    if (event.kind == "frame") return json::parse(event.json);
  return {};
}

tess::Setup with_options(std::vector<std::string> given) {
  given.insert(given.begin(), "program");
  std::vector<char*> argv;
  for (std::string& one : given) argv.push_back(one.data());
  argv.push_back(nullptr);
  int argc = static_cast<int>(given.size());
  return tess::take_options(argc, argv.data());
}

}  // namespace

TEST_CASE("a frame shows what the PEs did since the last one", "[runtime][monitor]") {
  const auto machine = machine_of(2);
  Board board(*machine);
  PeSample first = sample(0, 1000, 500, 100, 3);
  first.load = {.seconds = 4, .busy = 2};
  board.arrived(first);
  first = sample(1, 1000, 0, 50, 5);
  first.load = {.seconds = 4, .busy = 4};
  board.arrived(first);
  json frame = last_frame(board, 1);
  CHECK(frame["busy"] == json({50, 100}));
  CHECK(frame["rate"] == json({100, 50}));
  CHECK(frame["limits"] == "PEs wait 25 % of the time; perfect balance would save 25 %");
  REQUIRE(frame["collections"].size() == 1);
  CHECK(frame["collections"][0] ==
        json({{"id", "7"}, {"name", "Block"}, {"n", 8}, {"least", 3}, {"most", 5}}));

  board.arrived(sample(0, 1500, 500, 400, 3));  // two samples in one period
  board.arrived(sample(0, 2000, 900, 500, 3));
  frame = last_frame(board, 2);
  CHECK(frame["busy"] == json({60, 100}));  // PE 1 has not answered: its last values stay
  CHECK(frame["rate"] == json({400, 50}));

  const std::vector<Event> events =
      board.take_events(3, [](tess::PeId pe) { return pe.value == 1 ? "Cell::\"step\"" : ""; });
  frame = json::parse(events.back().json);
  CHECK(frame["late"] == json::array({json::array({1, "Cell::\"step\""})}));
  CHECK(frame["busy"][1] == 100);
}

TEST_CASE("a frame has the greatest parts of entry methods in the time of all PEs",
          "[runtime][monitor]") {
  const auto machine = machine_of(4);
  Board board(*machine);
  CHECK(last_frame(board, 1)["entries"] == json::array());
  for (const int pe : {0, 1}) {
    PeSample one = sample(pe, 1000, 0, 1);
    one.entries = {{"Cell::a", 0.3}, {"Cell::\"b\"", 0.5 * pe}};
    one.measured = true;
    board.arrived(one);
  }
  json frame = last_frame(board, 2);
  CHECK(frame["entries"] ==
        json::array({json::array({"Cell::a", 0.15}), json::array({"Cell::\"b\"", 0.125})}));
  CHECK(frame["measured"] == 0.5);
  // A PE that has not answered since is in one entry method.
  for (const Event& event :
       board.take_events(3, [](tess::PeId pe) { return pe.value == 0 ? "Cell::c" : ""; }))
    frame = json::parse(event.json);
  CHECK(frame["entries"] ==
        json::array({json::array({"Cell::c", 0.25}), json::array({"Cell::\"b\"", 0.125}),
                     json::array({"Cell::a", 0.075})}));
  PeSample many = sample(3, 1000, 0, 1);
  for (int i = 0; i < 40; ++i) many.entries.push_back({std::to_string(i), 0.001 * i});
  board.arrived(many);
  frame = last_frame(board, 4);
  CHECK(frame["entries"].size() == 16);
  CHECK(frame["entries"][2] == json::array({"39", 0.00975}));
}

TEST_CASE("an array that only some PEs have has no elements on another", "[runtime][monitor]") {
  const auto machine = machine_of(3);
  Board board(*machine);
  for (const int pe : {0, 2}) board.arrived(sample(pe, 1000, 0, 0, 3));
  board.arrived(sample(1, 1000, 0, 0));
  CHECK(last_frame(board, 1)["collections"][0] ==
        json({{"id", "7"}, {"name", "Block"}, {"n", 6}, {"least", 0}, {"most", 3}}));
}

TEST_CASE("a late browser sees the last minutes, and they are bounded", "[runtime][monitor]") {
  const auto machine = machine_of(1);
  Board board(*machine);
  for (int i = 0; i < 2000; ++i) {
    board.note({"round \"" + std::to_string(i) + "\"\n", 1.5, 1.1});
    (void)board.take_events(i, &nothing);
  }
  const std::vector<Event> past = board.past(std::nullopt);
  CHECK(past.size() == 600);
  CHECK(json::parse(past.back().json)["t"] == 1999);
  CHECK(json::parse(past[past.size() - 2].json)["text"] == "round \"1999\"\n");
}

TEST_CASE("parts of a picture meet, whatever their order", "[runtime][monitor]") {
  const auto machine = machine_of(1);
  Board board(*machine);
  board.draw({"heat", 4, 2, 2, 0, 2, {3, 4, 7, 8}});
  board.draw({"heat", 4, 2, 0, 0, 2, {1, 2, 5, 6}});
  const std::vector<Event> events = board.take_events(1, &nothing);
  REQUIRE(events.back().kind == "picture");
  const json picture = json::parse(events.back().json);
  CHECK(picture["width"] == 4);
  CHECK(picture["least"] == 1);
  CHECK(picture["most"] == 8);
  CHECK(picture["values"] == "0024496d92b6dbff");                // 0, 1/7, … 1 of 255
  CHECK(board.take_events(2, &nothing).back().kind == "frame");  // unchanged: not sent again
  CHECK(board.past(std::nullopt).back().kind == "picture");
  for (int i = 0; i < 100; ++i)
    CHECK(board.draw({"p" + std::to_string(i), 1, 1, 0, 0, 1, {1}}) == (i < 15));
  CHECK(board.take_events(3, &nothing).size() == 16);  // a frame and fifteen new names
}

TEST_CASE("pictures of very small and very large numbers have all levels", "[runtime][monitor]") {
  const auto machine = machine_of(1);
  for (const float scale : {1e-38F, 1.0F, 1e38F}) {
    Board board(*machine);
    board.draw({"p", 4, 1, 0, 0, 4, {-3 * scale, -scale, scale, 3 * scale}});
    CHECK(json::parse(board.take_events(1, &nothing).back().json)["values"] == "0055aaff");
  }
}

TEST_CASE("a PE of another process that misses two frames is shown as busy", "[runtime][monitor]") {
  const auto machine = tess::make_simulated_machine(tess::parse_simulated("pes=2,per-process=1"));
  Board board(*machine);
  board.arrived(sample(1, 1000, 1000, 50, 5));
  for (int frames = 1; frames <= 4; ++frames) {
    board.arrived(sample(0, 1000 * frames, 500, 100, 3));
    CHECK(last_frame(board, frames)["busy"][1] == (frames < 3 ? 0 : 100));
  }
  Board late(*machine);  // PE 0 itself was busy, and has passed nothing on
  late.arrived(sample(1, 1000, 1000, 50, 5));
  for (int frames = 1; frames <= 4; ++frames) (void)last_frame(late, frames);
  late.arrived(sample(0, 4000, 500, 100, 3));
  CHECK(last_frame(late, 5)["busy"][1] == 0);
}

TEST_CASE("a heat map that is watched again begins anew", "[runtime][monitor]") {
  const auto machine = machine_of(2);
  Board board(*machine);
  board.arrived(sample(0, 1, 0, 0, 3));  // the array is named
  const HeatMapId asked{tess::CollectionId{7}, HeatBy::pe};
  board.watch_heat({asked});
  REQUIRE(board.heat_queries().size() == 1);
  const HeatQuery first = board.heat_queries().front();
  board.take({first, tess::PeId{1}, tess::range(4), {0, 1, 2, 3}, {1, 1, 1, 1}});
  board.take({{{tess::CollectionId{8}, HeatBy::pe}, 1}, tess::PeId{0}, tess::range(4), {0}, {9}});
  const auto events = heat_events(board);
  REQUIRE(events.size() == 1);
  CHECK(events[0].topic == asked);
  CHECK(json::parse(events[0].json)["name"] == "Block");
  CHECK(json::parse(events[0].json)["values"] == json({1, 1, 1, 1}));
  CHECK(heat_events(board).empty());  // unchanged: not sent again
  CHECK(board.past(asked).size() == 1);
  for (const Event& event : board.past(std::nullopt)) CHECK(event.kind == "frame");

  board.watch_heat({});
  CHECK(board.heat_queries().empty());
  board.watch_heat({asked});
  CHECK(board.heat_queries().front() != first);
  CHECK(board.past(asked).empty());
  board.take({first, tess::PeId{1}, tess::range(4), {0}, {1}});  // late, for the former watch
  CHECK(heat_events(board).empty());
}

TEST_CASE("--monitor takes a port, and wants a token where others can reach it",
          "[runtime][monitor]") {
  const tess::Setup plain = with_options({"--pes", "1", "--monitor", "8080"});
  REQUIRE(plain.options.monitor);
  CHECK(plain.options.monitor->address == "127.0.0.1");
  CHECK(plain.options.monitor->port == 8080);
  const tess::Setup open =
      with_options({"--pes", "1", "--monitor", "[::]:9", "--monitor-token", "x"});
  CHECK(open.options.monitor->address == "::");
  CHECK(open.options.monitor->token == "x");
  CHECK_FALSE(with_options({"--pes", "1"}).options.monitor);
  CHECK(with_options({"--pes", "1", "--monitor", "localhost:9"}).options.monitor->address ==
        "127.0.0.1");
  for (const char* wrong : {"", "x", "65536", "-1", "0.0.0.0:80", "localhost:80x", "8080 "}) {
    INFO(wrong);
    CHECK_THROWS_AS(with_options({"--pes", "1", "--monitor", wrong}), tess::Error);
  }
  // What browsers would write otherwise in an address.
  for (const char* token : {"a+b", "a/b", "a=", "a&b", "a b", "50%"})
    CHECK_THROWS_WITH(with_options({"--monitor", "80", "--monitor-token", token}),
                      Catch::Contains(token) && Catch::Contains("letters, digits"));
  CHECK_THROWS_WITH(with_options({"--monitor-token", "x"}), Catch::Contains("--monitor, which is"));
}
