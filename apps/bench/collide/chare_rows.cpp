#include "apps/bench/collide/method.hpp"
#include "apps/bench/collide/one_core.hpp"
#include "apps/bench/collide/peak_memory.hpp"
#include "apps/bench/collide/rows.hpp"
#include "collide/collider.hpp"
#include "runtime/core/error.hpp"
#include "runtime/runtime.hpp"
#include "runtime/wire/machine/threads.hpp"

#include <algorithm>
#include <array>
#include <fmt/core.h>
#include <thread>

namespace bench {
namespace {

using namespace tess::collide;

/// What each client has of the scene: a client per PE a strip of all models, or a client per model.
enum class Division { strips, models };

/// A row: a case on a number of PEs.
struct Setting {
  const char* of_case;
  const char* row;
  const char* meaning;
  std::int32_t n_pes;
  Division division = Division::strips;
};
constexpr Setting settings[] = {
    {"one_model", "chares_1", "a collider on one PE", 1},
    {"one_model", "chares_2", "elapsed time on two PEs", 2},
    {"wave_self", "chares_1", "a collider on one PE", 1},
    {"wave_self", "chares_2", "elapsed time on two PEs", 2},
    {"planes", "chares_1", "a collider on one PE", 1},
    {"planes", "chares_1_models", "a collider on one PE; each of two clients has one plane", 1,
     Division::models},
    {"planes", "chares_2", "elapsed time on two PEs; each client has a strip of both planes", 2},
    {"planes", "chares_2_models", "elapsed time on two PEs; each has a client with one plane", 2,
     Division::models},
};

bool is_possible(const Setting& setting) {
  return static_cast<unsigned>(setting.n_pes) <= std::thread::hardware_concurrency();
}
std::int32_t n_clients_of(const Setting& setting) {
  return setting.division == Division::models ? 2 : setting.n_pes;
}
std::string name_of(const Setting& setting) {
  return fmt::format("{}_{}", setting.of_case, setting.row);
}

/// Submits boxes of the scene, and counts their pairs.
class Client : public tess::Chare<Client, tess::Index1> {
 public:
  void take(ModelId model, std::vector<Aabb> boxes) { mine_.push_back({model, std::move(boxes)}); }
  void submit(const Collider& collider) {
    for (const auto& [model, boxes] : mine_)
      collider.submit(Objects{owner_of(index()), model, boxes});
    mine_.clear();
  }
  void receive(const Hits& hits) {
    if (hits.owner <= hits.other) n_pairs_ += hits.pairs.size();  // otherwise the other one counts
  }
  void give_count(tess::Callback<std::uint64_t> target) {
    contribute(tess::sum, std::exchange(n_pairs_, 0), std::move(target));
  }

 private:
  struct Set {
    ModelId model;
    std::vector<Aabb> boxes;
  };
  std::vector<Set> mine_;
  std::uint64_t n_pairs_ = 0;
};

/// Sends each client its boxes.
void hand_out(const Problem& problem, const Setting& setting,
              const tess::ArrayProxy<Client>& clients) {
  const auto n_clients = static_cast<std::size_t>(n_clients_of(setting));
  const auto send = [&](std::size_t client, std::uint32_t model, std::size_t begin,
                        std::size_t end) {
    const auto at = [&](std::size_t i) {
      return problem.boxes.begin() + static_cast<std::ptrdiff_t>(i);
    };
    clients[{static_cast<std::int32_t>(client)}].send<&Client::take>(
        ModelId{model}, std::vector<Aabb>(at(begin), at(end)));
  };
  const std::size_t n = problem.boxes.size(), second = problem.second_set();
  for (std::uint32_t model = 0; model < (second == 0 ? 1U : 2U); ++model) {
    const std::size_t begin = model == 0 ? 0 : second, end = model == 0 && second != 0 ? second : n;
    if (setting.division == Division::models) {
      send(model % n_clients, model, begin, end);
      continue;
    }
    for (std::size_t c = 0; c < n_clients; ++c)
      send(c, model, begin + (end - begin) * c / n_clients,
           begin + (end - begin) * (c + 1) / n_clients);
  }
}

/// The second collision of a collider: the first one warms up.
tess::Task collide(const Problem& problem, const Setting& setting, double& nanoseconds,
                   std::uint64_t& n_pairs) {
  const WithinModel within =
      problem.pairing == Pairing::all ? WithinModel::test : WithinModel::skip;
  Collider collider;
  tess::ArrayProxy<Client> clients;
  co_await tess::epoch([&] {
    collider = make_collider({.rules = {problem.touching, within}});
    clients = tess::create<Client>(tess::range(n_clients_of(setting)));
  });
  const tess::collide::HitReceivers to{report_to<&Client::receive>(clients), {}};
  for (int i = 0; i < 2; ++i) {
    co_await tess::epoch([&] { hand_out(problem, setting, clients); });
    const ProcessWatch processor;
    const Stopwatch elapsed;
    co_await tess::epoch([&] { clients.broadcast<&Client::submit>(collider); });
    co_await collider.run(to);
    nanoseconds = setting.n_pes == 1 ? processor.nanoseconds() : elapsed.nanoseconds();
    n_pairs = co_await clients.reduce<&Client::give_count>();
  }
}

/// Throws tess::Error if the collider finds another number of pairs.
double nanoseconds_of(const Problem& problem, const Setting& setting, std::uint64_t expected) {
  double nanoseconds = 0;
  std::uint64_t n_pairs = 0;
  tess::Setup setup{tess::make_threads_machine(setting.n_pes), {}};
  const int code = tess::run(
      setup, [&]() -> tess::Task { return collide(problem, setting, nanoseconds, n_pairs); });
  if (code != 0 || n_pairs != expected)
    tess::fail(tess::ErrorCode::bad_value, "benchmark: wrong result: ", name_of(setting),
               ": exit code ", code, ", ", n_pairs, " pairs instead of ", expected);
  return nanoseconds;
}

/// The peak memory of two collisions, beside the boxes of the clients.
double bytes_of(const Problem& problem, const Setting& setting, std::uint64_t expected) {
  const std::size_t peak = peak_bytes([&] { (void)nanoseconds_of(problem, setting, expected); });
  const std::size_t input = problem.boxes.size() * sizeof(Aabb);
  return static_cast<double>(peak - std::min(input, peak));
}

void measure(Output& output, const Case& of, const std::vector<Setting>& chosen) {
  const Problem problem = make_problem(of);
  const auto n = static_cast<double>(problem.boxes.size());
  const auto serial = our_doubles(problem);
  const std::uint64_t expected = serial->count();
  std::vector<Setting> timed;
  for (const Setting& setting : chosen)
    if (output.wants(of.name, name_of(setting))) timed.push_back(setting);
  Samples on_serial;
  std::vector<Samples> samples(timed.size());
  for (int i = 0; i < output.options().repeat && !timed.empty(); ++i) {
    const ProcessWatch watch;
    static_cast<void>(serial->count());
    on_serial.add(watch.nanoseconds() / n);
    for (std::size_t k = 0; k < timed.size(); ++k)
      samples[k].add(nanoseconds_of(problem, timed[k], expected) / n);
  }
  std::array<double, 2> on_one_pe{};  // by division
  for (std::size_t k = 0; k < timed.size(); ++k) {
    double& on_one = on_one_pe[static_cast<std::size_t>(timed[k].division)];
    if (timed[k].n_pes == 1) on_one = samples[k].median();
    output.row(of.name, name_of(timed[k]), samples[k], "ns",
               timed[k].n_pes == 1 ? on_serial.median() : on_one / timed[k].n_pes,
               Origin{timed[k].n_pes == 1 ? "threads: 1 PE" : "threads: 2 PEs", timed[k].n_pes});
  }
  for (const Setting& setting : chosen) {
    const std::string bytes = name_of(setting) + "_bytes";
    if (setting.n_pes == 1 && output.wants(of.name, bytes))
      output.row(of.name, bytes, bytes_of(problem, setting, expected) / n, "bytes");
  }
}

}  // namespace

RowTexts chare_row_texts(const std::string& of_case) {
  RowTexts rows;
  for (const Setting& setting : settings)
    if (of_case == setting.of_case && is_possible(setting)) {
      rows.emplace_back(name_of(setting), fmt::format("ns per object: {}", setting.meaning));
      if (setting.n_pes == 1)
        rows.emplace_back(
            name_of(setting) + "_bytes",
            "bytes per object at the peak of two collisions, beside the clients' boxes");
    }
  return rows;
}

void chare_rows(Output& output) {
  for (const Case& each : box_cases()) {
    std::vector<Setting> chosen;
    for (const Setting& setting : settings)
      if (each.name == setting.of_case && is_possible(setting) &&
          (output.wants(each.name, name_of(setting)) ||
           output.wants(each.name, name_of(setting) + "_bytes")))
        chosen.push_back(setting);
    if (!chosen.empty()) measure(output, output.options().quick ? smaller(each, 64) : each, chosen);
  }
}

}  // namespace bench
