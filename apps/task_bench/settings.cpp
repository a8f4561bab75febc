#include "apps/task_bench/settings.hpp"

#include "runtime/core/number.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>
#include <string_view>

namespace task_bench {
namespace {

[[noreturn]] void refuse(const std::string& why) {
  tess::fail(tess::ErrorCode::bad_argument, why, " (--help lists the options)");
}

std::string help() {
  return fmt::format(
      R"(Task Bench (Slaughter et al., SC20): grids of tasks, one chare per column, inputs checked.
Usage: task_bench [options of a graph] [-and options of the next graph]... [--options]

Options of a graph (-and begins the next; all graphs run at once):
  -steps N         steps (default 4; with -metg 1000)
  -width N         points of a step (default 4; with -metg 16 per PE)
  -type NAME       dependences (default trivial; with -metg stencil_1d): {}
                   with -metg also: all
  -radix N         dependences of a task: nearest, spread, random_nearest (default 3)
  -period N        steps after which they repeat: spread, random_nearest (default 3)
  -fraction X      share of the nearest that are dependences: random_nearest (default 0.25)
  -kernel NAME     work of a task (default empty; with -metg compute_bound): {}
  -iter N          iterations of the kernel (default 0); without -metg
  -output N        bytes that a task hands on, at least 16 (default 16)
  -scratch N       bytes that memory_bound works on, per point
  -sample N        parts of the scratch, one per iteration (default 16)
  -imbalance X     load_imbalance: iterations are drawn from (1 +- X/2) N, X within 0 ... 2
  -persistent      load_imbalance: a point draws once, not at every step

Measuring:
  -metg            find METG(50 %): the least grain at which half of the time is kernels
  --repeat N       runs of each grain, the median counts (default 1; with -metg 5)
  --fastest        the fastest run counts: for a machine that others use as well
  --json FILE      write the rows and METG as JSON
  --csv FILE       write the rows as CSV
  --plot FILE.svg  draw efficiency against the grain

Load balancing:
  --balance STRATEGY[,when=at_sync|automatic|periodic][,period=50ms][,report]
                   columns migrate (README, Load balancing)
  --balance-every N  steps between barriers (default 10)

  --spoil T,P      task (T, P) hands on a wrong output: shows that it is found (exit code 1)
  --explain        say what this run uses and what it left out
  -h, --help       this text

{})",
      fmt::join(type_names(), ", "), fmt::join(kernel_names(), ", "), tess::options_help());
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
  bool steps = false, width = false, type = false, kernel = false, period = false,
       iterations = false;
};

class Parser {
 public:
  Parser(int argc, char** argv) : argv_(argv + 1, argv + argc) {}

  [[nodiscard]] bool asks_for_help() const {
    for (const std::string_view one : argv_)
      if (one == "-h" || one == "--help") return true;
    return false;
  }

  Settings run(std::int32_t n_pes) {
    while (at_ < argv_.size()) {
      option_ = argv_[at_++];
      if (!of_graph() && !of_run()) refuse(fmt::format("there is no option {}", option_));
    }
    given_.push_back(next_);
    complete(n_pes);
    return std::move(settings_);
  }

 private:
  std::string_view value() {
    if (at_ == argv_.size()) refuse(fmt::format("{} needs a value", option_));
    return argv_[at_++];
  }
  template <class T>
  T value(T least, T most) {
    return number<T>(option_, value(), least, most);
  }

  bool of_graph() {
    Graph& g = next_.graph;
    constexpr std::int64_t gigabyte = std::int64_t{1} << 30;
    if (option_ == "-steps") {
      g.steps = value<std::int64_t>(1, 1'000'000'000);
      next_.steps = true;
    } else if (option_ == "-width") {
      g.width = value<std::int32_t>(1, 100'000'000);
      next_.width = true;
    } else if (option_ == "-type") {
      const std::string_view name = value();
      settings_.all_types = settings_.all_types || name == "all";
      if (name != "all") g.type = parse_type(name);
      next_.type = true;
    } else if (option_ == "-radix") {
      g.radix = value<std::int32_t>(0, 1'000'000);
    } else if (option_ == "-period") {
      g.period = value<std::int32_t>(0, 1'000'000);
      next_.period = true;
    } else if (option_ == "-fraction") {
      g.fraction = value<double>(0, 1);
    } else if (option_ == "-kernel") {
      g.kernel.type = parse_kernel(value());
      next_.kernel = true;
    } else if (option_ == "-iter") {
      g.kernel.iterations = value<std::int64_t>(0, std::int64_t{1} << 40);
      next_.iterations = true;
    } else if (option_ == "-output") {
      g.output_bytes = value<std::int64_t>(16, gigabyte);
    } else if (option_ == "-scratch") {
      g.kernel.scratch_bytes = value<std::int64_t>(0, 16 * gigabyte);
    } else if (option_ == "-sample") {
      g.kernel.samples = value<std::int64_t>(1, gigabyte);
    } else if (option_ == "-imbalance") {
      g.kernel.imbalance = value<double>(0, 2);
    } else if (option_ == "-persistent") {
      g.kernel.persistent = true;
    } else if (option_ == "-and") {
      given_.push_back(next_);
      next_ = Given{};
    } else {
      return false;
    }
    return true;
  }

  bool of_run() {
    if (option_ == "-metg") {
      settings_.metg = true;
    } else if (option_ == "--repeat") {
      settings_.repeat = value<std::int32_t>(1, 1000);
    } else if (option_ == "--fastest") {
      settings_.fastest = true;
    } else if (option_ == "--json") {
      settings_.json = value();
    } else if (option_ == "--csv") {
      settings_.csv = value();
    } else if (option_ == "--plot") {
      settings_.plot = value();
    } else if (option_ == "--balance") {
      settings_.balance = tess::parse_balance(value());
    } else if (option_ == "--balance-every") {
      settings_.sync_every = value<std::int64_t>(1, 1'000'000'000);
      has_barriers_ = true;
    } else if (option_ == "--explain") {
      settings_.explain = true;
    } else if (option_ == "--spoil") {
      const std::string_view task = value();
      const std::size_t comma = std::min(task.find(','), task.size());
      constexpr auto most = std::numeric_limits<std::int64_t>::max();
      settings_.spoiled = {
          number<std::int64_t>(option_, task.substr(0, comma), 0, most),
          number<std::int64_t>(option_, task.substr(std::min(comma + 1, task.size())), 0, most)};
    } else {
      return false;
    }
    return true;
  }

  void complete(std::int32_t n_pes) {
    Settings& s = settings_;
    if (s.all_types && (!s.metg || given_.size() > 1))
      refuse("-type all: only with -metg, and without -and");
    if (s.repeat == 0) s.repeat = s.metg ? 5 : 1;
    for (Given& given : given_) {
      Graph& g = given.graph;
      g.number = static_cast<std::int32_t>(s.graphs.size());
      if (s.metg) {
        if (!given.steps) g.steps = 1000;
        if (!given.width) g.width = 16 * n_pes;
        if (!given.type) g.type = Type::stencil_1d;
        if (!given.kernel) g.kernel.type = KernelType::compute_bound;
        if (g.kernel.type == KernelType::empty) refuse("-metg: -kernel empty has no grain");
        if (given.iterations) refuse("-metg tries numbers of iterations: leave -iter out");
      }
      if (!given.period && has_period(g.type)) g.period = 3;
      s.graphs.push_back(g);
    }
    const std::vector<std::vector<Graph>> all = cases(s);
    if (s.spoiled && std::ranges::none_of(all, [&](const std::vector<Graph>& graphs) {
          return std::ranges::any_of(graphs, [&](const Graph& g) {
            return is_read(g, s.spoiled->first, s.spoiled->second);
          });
        }))
      refuse(
          fmt::format("--spoil {},{}: no graph has a task with this step and point whose output "
                      "another task reads; give those of one",
                      s.spoiled->first, s.spoiled->second));
    if (!s.balance || s.balance->when == tess::BalanceWhen::periodic) {
      if (has_barriers_) refuse("--balance-every: only with --balance STRATEGY, and not periodic");
      s.sync_every = 0;
    }
  }

  const std::vector<std::string_view> argv_;
  std::size_t at_ = 0;
  std::string_view option_;
  Settings settings_;
  bool has_barriers_ = false;  // --balance-every is given
  std::vector<Given> given_;
  Given next_;
};

}  // namespace

std::optional<Settings> parse(int argc, char** argv, const tess::Machine& machine) {
  Parser parser(argc, argv);
  if (parser.asks_for_help()) {
    if (machine.process() == tess::ProcessId{0}) tess::print_text(help());
    return std::nullopt;
  }
  return parser.run(machine.n_pes());
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
