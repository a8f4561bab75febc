#include "apps/task_bench/settings.hpp"

#include "runtime/core/number.hpp"
#include "runtime/more/balance_offline.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <string_view>

namespace task_bench {
namespace {

[[noreturn]] void refuse(const std::string& why) {
  tess::fail(tess::ErrorCode::bad_argument, why, " (--help lists the options)");
}

/// True if a graph has this task, and another task reads its output.
bool is_read(const Graph& graph, std::int64_t step, std::int64_t point) {
  if (step + 1 >= graph.steps || point >= graph.width) return false;
  const auto task = static_cast<std::int32_t>(point);
  const auto readers = dependents(graph, set_at(graph, step + 1), task);
  return points_at(graph, step).contains(task) &&
         std::ranges::any_of(readers, [later = points_at(graph, step + 1)](std::int32_t reader) {
           return later.contains(reader);
         });
}

template <class T>
T number(std::string_view option, std::string_view value, T least, T most) {
  const auto result = tess::parse_number<T>(value);
  if (!result || !(*result >= least && *result <= most))
    refuse(fmt::format("{} {}: not a number within {} ... {}", option, value, least, most));
  return *result;
}

/// A graph as it is given, before defaults that depend on others.
struct Given {
  Graph graph;
  kit::Json words;  // an object: value by option

  [[nodiscard]] bool has(std::string_view option) const {
    return std::ranges::find(words.members(), option, &kit::Json::Member::name) !=
           words.members().end();
  }
};

struct GraphOption {
  std::string_view name;
  std::string_view value;  // what the help calls it; empty: a flag
  std::string meaning;
  void (*take)(Graph&, std::string_view option, std::string_view value);
};

constexpr std::int64_t gigabyte = std::int64_t{1} << 30;
/// Takes a number into a member of the graph, or of its kernel.
template <auto member, auto least, auto most>
void take(Graph& graph, std::string_view option, std::string_view value) {
  const auto take_into = [&]<class Owner, class T>(Owner& owner, T Owner::*at) {
    owner.*at = number<T>(option, value, least, most);
  };
  if constexpr (std::is_invocable_v<decltype(member), Graph&>)
    take_into(graph, member);
  else
    take_into(graph.kernel, member);
}

using Text = std::string_view;
const std::vector<GraphOption>& graph_options() {
  static const std::vector<GraphOption> all{
      {"-steps", "N", "steps (default 4; with -metg 1000)", take<&Graph::steps, 1, 1'000'000'000>},
      {"-width", "N", "points of a step (default 4; with -metg 16 per PE)",
       take<&Graph::width, 1, 100'000'000>},
      {"-type", "NAME",
       fmt::format("dependences (default trivial; with -metg stencil_1d): {}; with -metg also all",
                   fmt::join(type_names(), ", ")),
       [](Graph& g, Text, Text name) {
         if (name != "all") g.type = parse_type(name);
       }},
      {"-radix", "N", "dependences of a task: nearest, spread, random_nearest (default 3)",
       take<&Graph::radix, 0, 1'000'000>},
      {"-period", "N", "steps after which they repeat: spread, random_nearest (default 3)",
       take<&Graph::period, 0, 1'000'000>},
      {"-fraction", "X", "share of the nearest that are dependences: random_nearest (default 0.25)",
       take<&Graph::fraction, 0, 1>},
      {"-kernel", "NAME",
       fmt::format("work of a task (default empty; with -metg compute_bound): {}",
                   fmt::join(kernel_names(), ", ")),
       [](Graph& g, Text, Text name) { g.kernel.type = parse_kernel(name); }},
      {"-iter", "N", "iterations of the kernel (default 0); without -metg",
       take<&Kernel::iterations, 0, std::int64_t{1} << 40>},
      {"-output", "N", "bytes that a task hands on, at least 16 (default 16)",
       take<&Graph::output_bytes, 16, gigabyte>},
      {"-scratch", "N", "bytes that memory_bound works on, per point",
       take<&Kernel::scratch_bytes, 0, 16 * gigabyte>},
      {"-sample", "N", "parts of the scratch, one per iteration (default 16)",
       take<&Kernel::samples, 1, gigabyte>},
      {"-imbalance", "X",
       "load_imbalance: iterations are drawn from (1 +- X/2) N, X within 0 ... 2",
       take<&Kernel::imbalance, 0, 2>},
      {"-persistent", "", "load_imbalance: a point draws once, not at every step",
       [](Graph& g, Text, Text) { g.kernel.persistent = true; }}};
  return all;
}

std::string graph_help() {
  std::string out = "Options of a graph (-and begins the next; all graphs run at once):\n";
  for (const GraphOption& one : graph_options())
    out += fmt::format("  {:<16} {}\n", fmt::format("{} {}", one.name, one.value), one.meaning);
  return out;
}

/// Takes the graphs out of the command line; returns the other words.
std::vector<char*> take_graphs(int argc, char** argv, std::vector<Given>& graphs) {
  std::vector<char*> rest;
  graphs.emplace_back();
  for (int i = 0; i < argc; ++i) {
    const std::string_view word = argv[i];
    const auto option = std::ranges::find(graph_options(), word, &GraphOption::name);
    if (word == "-and") {
      graphs.emplace_back();
    } else if (option == graph_options().end()) {
      rest.push_back(argv[i]);
    } else {
      if (!option->value.empty() && ++i == argc) refuse(fmt::format("{} needs a value", word));
      const std::string_view value = option->value.empty() ? "yes" : argv[i];
      option->take(graphs.back().graph, word, value);
      graphs.back().words[word.substr(1)] = value;
    }
  }
  return rest;
}

void complete(Settings& s, const std::vector<Given>& all_given, std::int32_t n_pes) {
  s.all_types = std::ranges::any_of(all_given, [](const Given& given) {
    return given.has("type") && given.words.at("type").text() == "all";
  });
  if (s.all_types && (!s.metg || all_given.size() > 1))
    refuse("-type all: only with -metg, and without -and");
  if (s.repeat == 0) s.repeat = s.metg ? 5 : 1;
  s.words = kit::Json::array();
  for (const Given& given : all_given) {
    Graph g = given.graph;
    g.number = static_cast<std::int32_t>(s.graphs.size());
    if (s.metg) {
      if (!given.has("steps")) g.steps = 1000;
      if (!given.has("width")) g.width = 16 * n_pes;
      if (!given.has("type")) g.type = Type::stencil_1d;
      if (!given.has("kernel")) g.kernel.type = KernelType::compute_bound;
      if (g.kernel.type == KernelType::empty) refuse("-metg: -kernel empty has no grain");
      if (given.has("iter")) refuse("-metg tries numbers of iterations: leave -iter out");
    }
    if (!given.has("period") && has_period(g.type)) g.period = 3;
    s.graphs.push_back(g);
    kit::Json words = given.words;
    words.update(kit::Json());  // an object, also without members
    s.words.push_back(std::move(words));
  }
  const std::vector<std::vector<Graph>> all = cases(s);
  if (!s.spoiled.empty() && std::ranges::none_of(all, [&](const std::vector<Graph>& graphs) {
        return std::ranges::any_of(
            graphs, [&](const Graph& g) { return is_read(g, s.spoiled[0], s.spoiled[1]); });
      }))
    refuse(
        fmt::format("--spoil {},{}: no graph has a task with this step and point whose output "
                    "another task reads; give those of one",
                    s.spoiled[0], s.spoiled[1]));
}

}  // namespace

bool parse(int argc, char** argv, std::int32_t n_pes, kit::Driver& driver, Settings& s) {
  driver.group("Measuring");
  driver.flag("-metg", s.metg,
              "find METG(50 %): the least grain at which half of the time is kernels");
  driver.repeat(s.repeat, "runs of each grain, the median counts (default 1; with -metg 5)");
  driver.flag("--fastest", s.fastest,
              "the fastest run counts: for a machine that others use as well");
  driver.json();
  driver.option("--csv FILE", s.csv, "write the measured grains as CSV");
  driver.picture("draw efficiency against the grain");
  driver.explain("say what this run uses and what it left out");
  driver
      .option("--spoil T,P", s.spoiled,
              "task (T, P) hands on a wrong output: shows that it is found (exit code 1)")
      .separated_by(',')
      .between(0, 1'000'000'000)
      .takes(2, 2);
  driver.group("Load balancing");
  driver.option("--balance STRATEGY", s.strategy,
                "columns migrate: "
                "STRATEGY[,when=at_sync|automatic|periodic][,period=50ms][,report] (README)");
  driver.option("--strategy-library FILE", s.library,
                "a shared library with strategies of your own, which --balance names");
  driver.option("--balance-every", s.sync_every, "steps between barriers")
      .between(1, 1'000'000'000);
  std::vector<Given> graphs;
  std::vector<char*> rest = take_graphs(argc, argv, graphs);
  driver.footer(graph_help());
  driver.examples({"-steps 100 -width 8 -type stencil_1d -kernel compute_bound -iter 1000",
                   "-steps 50 -width 8 -type fft -and -steps 20 -width 4 -type tree --pes 2",
                   "-metg -type nearest -steps 50 --pes 2 --plot metg.svg"});
  if (!driver.parse(static_cast<int>(rest.size()), rest.data())) return false;
  if (!s.library.empty()) tess::balance::load_strategy_library(s.library);
  if (driver.is_given("--balance")) s.balance = tess::parse_balance(s.strategy);
  complete(s, graphs, n_pes);
  if (s.balance && s.balance->when != tess::BalanceWhen::periodic) return true;
  if (driver.is_given("--balance-every"))
    refuse("--balance-every: only with --balance STRATEGY, and not periodic");
  s.sync_every = 0;
  return true;
}

std::vector<std::vector<Graph>> cases(const Settings& settings) {
  if (!settings.all_types) {
    for (const Graph& graph : settings.graphs) validate(graph);
    return {settings.graphs};
  }
  std::vector<std::vector<Graph>> result;
  for (const std::string& name : type_names()) {
    Graph graph = settings.graphs.front();
    graph.type = parse_type(name);
    if (!has_period(graph.type)) graph.period = 0;
    if (has_period(graph.type) && graph.period == 0) graph.period = 3;
    validate(graph);
    result.push_back({graph});
  }
  return result;
}

}  // namespace task_bench
