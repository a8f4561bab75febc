#include "runtime/balance/datafile/lb_datafile.hpp"

#include "apps/bench/balance_scenes.hpp"
#include "runtime/core/error.hpp"
#include "tests/runtime/balance/memory_scenes.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

using namespace tess;
using namespace tess::balance;
using nlohmann::json;

namespace {

std::optional<SharedBlock> block_of(const Snapshot& s, std::size_t i) {
  const std::size_t block = s.elements.block_of(i);
  return block == no_block ? std::nullopt : std::optional(s.blocks[block]);
}

void require_same(const Snapshot& a, const Snapshot& b) {
  REQUIRE(a.elements.key == b.elements.key);
  REQUIRE(a.elements.pe == b.elements.pe);
  REQUIRE(a.elements.load == b.elements.load);
  REQUIRE(a.elements.migratable == b.elements.migratable);
  REQUIRE(a.elements.size_bytes == b.elements.size_bytes);
  REQUIRE(a.elements.memory_bytes == b.elements.memory_bytes);
  REQUIRE(a.elements.position == b.elements.position);
  for (std::size_t i = 0; i < a.elements.size(); ++i) {
    REQUIRE(a.elements.working_bytes_of(i) == b.elements.working_bytes_of(i));
    REQUIRE(block_of(a, i) == block_of(b, i));
  }
  REQUIRE(a.pes.speed == b.pes.speed);
  REQUIRE(a.pes.background == b.pes.background);
  REQUIRE(a.pes.memory_limit_bytes == b.pes.memory_limit_bytes);
  for (std::size_t p = 0; p < a.pes.size(); ++p)
    REQUIRE(a.pes.working_bytes_of(p) == b.pes.working_bytes_of(p));
  std::vector<Edge> edges_a = a.edges, edges_b = b.edges;  // files of ranks bring them by rank
  std::ranges::sort(edges_a);
  std::ranges::sort(edges_b);
  REQUIRE(edges_a == edges_b);
}

/// A file as vt writes it for rank 0 of two: an element that rank 1 has as well as its messages.
const char* const rank_0 = R"({"type":"LBDatafile","metadata":{"type":"LBDatafile","rank":0},
  "phases":[{"id":0,"tasks":[
    {"entity":{"collection_id":7,"home":0,"id":524291,"index":[3],"migratable":true,
               "type":"object"},"node":0,"resource":"cpu","time":0.25,
     "subphases":[{"id":0,"time":0.25}]},
    {"entity":{"home":0,"id":1,"migratable":false,"type":"object"},"node":0,"resource":"cpu",
     "time":0.0}],
   "communications":[
    {"type":"SendRecv","bytes":100.0,"messages":2,
     "from":{"home":0,"id":524291,"migratable":true,"type":"object"},
     "to":{"home":1,"id":524295,"migratable":true,"type":"object"}},
    {"type":"NodeToCollection","bytes":9.0,"messages":1,"from":{"type":"node","id":0},
     "to":{"home":0,"id":524291,"migratable":true,"type":"object"}}]}]})";
const char* const rank_1 = R"({"type":"LBDatafile","phases":[{"id":0,"tasks":[
    {"entity":{"collection_id":7,"home":1,"id":524295,"index":[4,2],"migratable":true,
               "type":"object"},"node":1,"resource":"cpu","time":0.5},
    {"entity":{"home":0,"id":1,"migratable":false,"type":"object"},"node":1,"resource":"cpu",
     "time":0.0}]}]})";

/// The message of the Error that a file's text gives.
std::string complaint(const std::string& text) {
  try {
    (void)parse_lb_datafiles({{"data.0.json", text}});
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("phases come back from a file as they were", "[balance][lb_datafile]") {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    INFO("seed " << seed);
    const std::vector<Phase> phases = {{3, anything(seed)}, {9, any_memory(seed)}};
    const auto back = parse_lb_datafiles({{"f", write_lb_datafile(phases)}});
    REQUIRE(back.size() == 2);
    for (std::size_t k = 0; k < 2; ++k) {
      REQUIRE(back[k].id == phases[k].id);
      require_same(back[k].snapshot, phases[k].snapshot);
    }
  }
}

// An id has 16 bits for the home.
TEST_CASE("elements on very many PEs have ids of their own", "[balance][lb_datafile]") {
  Snapshot s = idle_pes(70000);
  for (const std::size_t pe : {0U, 65536U, 0U}) add_element(s, pe, 1);
  for (const double load : {1., 0.}) {
    s.elements.load[2] = load;
    require_same(parse_lb_datafiles({{"f", write_lb_datafile({{0, s}})}}).at(0).snapshot, s);
  }
}

TEST_CASE("a file has the indices of elements as arrays", "[balance][lb_datafile]") {
  Snapshot s = mod_seven(Start::blocks);
  s.elements.index.assign(64, "[1,2]");
  s.elements.index[1] = "[\"name\"]";
  s.elements.index[2] = "[-3]";
  s.elements.index[3] = "[?]";
  const std::string text = write_lb_datafile({{0, s}});
  const json root = json::parse(text);
  const json& tasks = root.at("phases").at(0).at("tasks");
  const auto index = [&](std::size_t i) { return tasks.at(i).at("entity").at("index"); };
  CHECK(index(0) == json::array({1, 2}));
  CHECK(index(1) == json::array({"name"}));
  CHECK(index(2) == json::array({-3}));
  CHECK(index(3) == json::array({"[?]"}));
  const Snapshot back = parse_lb_datafiles({{"data.0.json", text}}).at(0).snapshot;
  for (std::size_t i = 0; i < 3; ++i) CHECK(back.elements.index[i] == s.elements.index[i]);
  s.elements.index.pop_back();
  CHECK_THROWS_AS(validate(s), Error);
}

TEST_CASE("a file tells loads that are not known from others", "[balance][lb_datafile]") {
  Snapshot s = mod_seven(Start::blocks);
  s.elements.load[5] = Load::unknown();
  const std::string text = write_lb_datafile({{0, s}});
  const Snapshot back = parse_lb_datafiles({{"data.0.json", text}}).at(0).snapshot;
  for (std::size_t i = 0; i < 64; ++i) {
    INFO(i);
    CHECK(back.elements.load[i].is_known() == (back.elements.key[i].element != 5));
  }
}

TEST_CASE("files of single ranks together hold what one file holds", "[balance][lb_datafile]") {
  const std::vector<Phase> phases = {{0, stencil(6, 3, 1)}, {1, stencil(6, 3, 2)}};
  std::vector<LbDatafile> files;
  for (int rank = 0; rank < 3; ++rank)
    files.push_back({"rank", write_lb_datafile(phases, PeId{rank})});
  const auto back = parse_lb_datafiles(files);
  REQUIRE(back.size() == 2);
  for (std::size_t k = 0; k < 2; ++k) require_same(back[k].snapshot, phases[k].snapshot);
}

TEST_CASE("our files have what vt's schema requires, with its types", "[balance][lb_datafile]") {
  Snapshot s = stencil(3, 2, 1);
  s.elements.load[0] = 1;
  s.elements.migratable[4] = 0;
  const json file = json::parse(write_lb_datafile({{0, s}}));
  CHECK(file.at("type") == "LBDatafile");
  const json& phase = file.at("phases").at(0);
  CHECK(phase.at("id").is_number_integer());
  for (const json& task : phase.at("tasks")) {
    CHECK(task.at("node").is_number_integer());
    CHECK(task.at("resource") == "cpu");
    CHECK(task.at("time").is_number_float());
  }
  for (const json& one : phase.at("communications")) {
    CHECK(one.at("type") == "SendRecv");
    CHECK(one.at("messages").is_number_integer());
    CHECK(one.at("bytes").is_number_float());
    for (const char* end : {"from", "to"}) {
      const json& entity = one.at(end);
      CHECK(entity.at("type") == "object");
      CHECK(entity.at("migratable").is_boolean());
      CHECK(entity.at("home").is_number_integer());
      CHECK(entity.at("collection_id").is_number_integer());
      // vt reads home and whether it migrates from the id.
      const auto id = entity.at("id").get<std::uint64_t>();
      CHECK((id >> 2U & 0xffffU) == entity.at("home").get<std::uint64_t>());
      CHECK((id & 3U) == (entity.at("migratable").get<bool>() ? 3U : 2U));
    }
  }
}

TEST_CASE("files as vt writes them are read, one per rank", "[balance][lb_datafile]") {
  const auto phases = parse_lb_datafiles({{"data.0.json", rank_0}, {"data.1.json", rank_1}});
  REQUIRE(phases.size() == 1);
  const Snapshot& s = phases[0].snapshot;
  REQUIRE(s.pes.size() == 2);
  REQUIRE(s.elements.size() == 3);
  CHECK(s.elements.key[0] == ElementKey{CollectionId{7}, 3});
  CHECK(s.elements.key[2] == ElementKey{CollectionId{7}, 524295});
  CHECK(s.elements.load == std::vector<Load>{0.25, 0, 0.5});
  CHECK(s.elements.migratable == std::vector<std::uint8_t>{1, 0, 1});
  CHECK(s.elements.position.empty());
  CHECK(s.edges == std::vector<Edge>{{0, 2, 100, 2}});
}

TEST_CASE("a message that is not from a task to a task is left out and counted",
          "[balance][lb_datafile]") {
  const auto phases = parse_lb_datafiles({{"data.0.json", rank_0}});
  CHECK(phases.at(0).snapshot.edges.empty());
  CHECK(phases.at(0).n_left_out == 2);  // one is a broadcast
  CHECK(parse_lb_datafiles({{"0", rank_0}, {"1", rank_1}}).at(0).n_left_out == 1);
}

TEST_CASE("phases that a file does not write are refused", "[balance][lb_datafile]") {
  json file = json::parse(rank_0);
  file["metadata"]["phases"] = {{"count", 3}, {"identical_to_previous", {{"range", {{1, 2}}}}}};
  CHECK_THAT(complaint(file.dump()),
             Catch::Contains("identical_to_previous: these phases are not"));
  file["metadata"]["phases"]["identical_to_previous"]["range"] = json::array();
  CHECK(complaint(file.dump()).empty());
}

TEST_CASE("a sequence number names its task by its home, or by being unique",
          "[balance][lb_datafile]") {
  const auto entity = [](int number, std::optional<int> home) {
    json out = {{"seq_id", number}, {"migratable", true}, {"type", "object"}};
    if (home) out["home"] = *home;
    return out;
  };
  const auto file = [&](const json& to) {
    json phase = {{"id", 0}, {"tasks", json::array()}, {"communications", json::array()}};
    for (const auto& [number, home] :
         std::vector<std::pair<int, std::optional<int>>>{{5, 0}, {5, 1}, {6, 1}, {8, {}}})
      phase["tasks"].push_back({{"entity", entity(number, home)}, {"node", 0}, {"time", 1.0}});
    phase["communications"].push_back({{"type", "SendRecv"},
                                       {"bytes", 7.0},
                                       {"messages", 1},
                                       {"from", entity(5, 1)},
                                       {"to", to}});
    json whole;
    whole["phases"] = json::array({phase});
    return whole.dump();
  };
  const auto edges = [&](const json& to) {
    return parse_lb_datafiles({{"f", file(to)}}).at(0).snapshot.edges;
  };
  CHECK(edges(entity(5, 0)) == std::vector<Edge>{{1, 0, 7, 1}});
  CHECK(edges(entity(6, {})) == std::vector<Edge>{{1, 2, 7, 1}});
  CHECK(edges(entity(8, {})) == std::vector<Edge>{{1, 3, 7, 1}});
  CHECK(edges(entity(8, 0)) == std::vector<Edge>{{1, 3, 7, 1}});
  CHECK(edges(entity(6, 0)).empty());
  CHECK_THAT(complaint(file(entity(5, {}))),
             Catch::Contains("communications 0 to has a seq_id of several tasks, but no home"));
}

TEST_CASE("shared blocks and memory are read as vt writes them", "[balance][lb_datafile]") {
  const auto task = [](int id, int node, double shared_id, double shared_bytes) {
    return json{{"entity", {{"home", node}, {"id", id}, {"migratable", true}, {"type", "object"}}},
                {"node", node},
                {"resource", "cpu"},
                {"time", 0.5},
                {"user_defined",
                 {{"shared_id", shared_id},
                  {"shared_bytes", shared_bytes},
                  {"home_rank", 2.0},
                  {"task_working_bytes", 30.0},
                  {"task_footprint_bytes", 7.0},
                  {"task_serialized_bytes", 9.0},
                  {"rank_working_bytes", node == 0 ? 1000.0 : 2000.0}}}};
  };
  const auto file = [](const json& tasks) {
    json phase;
    phase["id"] = 0;
    phase["tasks"] = tasks;
    json whole;
    whole["phases"] = json::array({phase});
    return whole.dump();
  };
  const auto phases = parse_lb_datafiles(
      {{"data.0.json",
        file(json::array({task(3, 0, 44, 100), task(7, 0, 44, 100), task(11, 0, -1, 0)}))},
       {"data.1.json", file(json::array({task(15, 1, 44, 120), task(19, 1, 45, 10)}))}});
  const Snapshot& s = phases.at(0).snapshot;
  CHECK(s.pes.size() == 3);  // a block is at home on the third
  CHECK(s.blocks == std::vector<SharedBlock>{{44, 120, PeId{2}}, {45, 10, PeId{2}}});
  CHECK(s.elements.block == std::vector<std::size_t>{0, 0, no_block, 0, 1});
  CHECK(s.elements.working_bytes == std::vector<std::uint64_t>(5, 30));
  CHECK(s.elements.memory_bytes == std::vector<std::uint64_t>(5, 7));
  CHECK(s.elements.size_bytes == std::vector<std::uint64_t>(5, 9));
  CHECK(s.pes.working_bytes == std::vector<std::uint64_t>{1000, 2000, 0});

  const auto refused = [&](const char* key, const json& value) {
    json one = task(3, 0, 44, 100);
    one["user_defined"][key] = value;
    return complaint(file(json::array({one})));
  };
  CHECK_THAT(refused("shared_id", 4.5), Catch::Contains("shared_id is not a whole number"));
  CHECK_THAT(refused("shared_id", "four"), Catch::Contains("shared_id is not a number"));
  CHECK_THAT(refused("shared_bytes", -1.0), Catch::Contains("shared_bytes is below 0"));
  CHECK_THAT(refused("task_working_bytes", -1), Catch::Contains("task_working_bytes is below 0"));
  CHECK_THAT(refused("home_rank", 4e9), Catch::Contains("home_rank is 4000000000, not below"));
  CHECK_THAT(refused("rank_working_bytes", 0x1p61), Catch::Contains("adds up to"));
  json lacks = task(3, 0, 44, 100);
  lacks["user_defined"].erase("shared_bytes");
  CHECK_THAT(complaint(file(json::array({lacks}))), Catch::Contains("lacks 'shared_bytes'"));
}

TEST_CASE("our files give memory to vt's balancers, which accept floating point only",
          "[balance][lb_datafile]") {
  const json file = json::parse(write_lb_datafile({{0, any_memory(3)}}));
  std::size_t n_shared = 0;
  for (const json& task : file.at("phases").at(0).at("tasks")) {
    const json& user = task.at("user_defined");
    for (const char* key : {"task_footprint_bytes", "task_working_bytes", "task_serialized_bytes",
                            "rank_working_bytes"})
      CHECK(user.at(key).is_number_float());
    if (!user.contains("shared_id")) continue;
    ++n_shared;
    for (const char* key : {"shared_id", "shared_bytes", "home_rank"})
      CHECK(user.at(key).is_number_float());
  }
  CHECK(n_shared > 0);
}

TEST_CASE("files that give sizes under their former names are read", "[balance][lb_datafile]") {
  const auto phases = parse_lb_datafiles(
      {{"f", R"({"phases":[{"id":0,"tasks":[{"entity":{"home":0,"id":7,"migratable":true,
        "type":"object"},"node":0,"time":1.0,
        "user_defined":{"size_bytes":12,"memory_bytes":34}}]}]})"}});
  CHECK(phases.at(0).snapshot.elements.size_bytes.at(0) == 12);
  CHECK(phases.at(0).snapshot.elements.memory_bytes.at(0) == 34);
}

TEST_CASE("a damaged file is refused in one line with file, place and remedy",
          "[balance][lb_datafile]") {
  const json good = json::parse(write_lb_datafile({{0, stencil(3, 2, 1)}}));
  const auto broken = [&](const char* pointer, const json& value) {
    json file = good;
    file[json::json_pointer(pointer)] = value;
    return complaint(file.dump());
  };
  CHECK_THAT(complaint("{\"phases\": [{"), Catch::Contains("data.0.json: not JSON from byte"));
  CHECK_THAT(complaint("[1]"), Catch::Contains("data.0.json: is not an object"));
  CHECK_THAT(complaint("{}"), Catch::Contains("lacks 'phases'"));
  CHECK_THAT(broken("/phases/0/tasks/1/time", -1.0),
             Catch::Contains("data.0.json: phases 0 tasks 1 time is below 0"));
  CHECK_THAT(broken("/phases/0/tasks/1/time", "long"), Catch::Contains("time is not a number"));
  CHECK_THAT(broken("/phases/0/tasks/1/node", -4), Catch::Contains("node is not a whole number"));
  CHECK_THAT(broken("/phases/0/tasks/1/node", 4000000000), Catch::Contains("node is 4000000000"));
  CHECK_THAT(broken("/phases/0/tasks/1/node", 99),
             Catch::Contains("data.0.json: phases 0 tasks 1 node is PE 99 of 2 PEs"));
  CHECK_THAT(broken("/phases", json::array()), Catch::Contains("data.0.json: phases: none"));
  for (const char* place : {"/type", "/metadata/type"})
    CHECK_THAT(broken(place, "LBStats"), Catch::Contains(" type is not LBDatafile"));
  CHECK_THAT(broken("/phases/0/tasks/1/entity", json::object()), Catch::Contains("lacks 'type'"));
  CHECK_THAT(broken("/phases/0/tasks/1", good["phases"][0]["tasks"][0]),
             Catch::Contains("tasks 1 entity is there twice"));
  CHECK_THAT(broken("/phases/0/user_defined/pe_speed/0", 0.0), Catch::Contains("is not above 0"));

  const std::string text = write_lb_datafile({{0, mod_seven(Start::blocks)}});
  for (std::size_t cut = 1; cut + 2 < text.size(); cut += 97) {
    const std::string message = complaint(text.substr(0, cut));
    REQUIRE_FALSE(message.empty());
    REQUIRE(message.find('\n') == std::string::npos);
  }
}

TEST_CASE("a file that is not there is named", "[balance][lb_datafile]") {
  CHECK_THROWS_WITH(read_lb_datafiles({"no/such.json"}), Catch::Contains("no/such.json: cannot"));
}
