// Elements of a sparse three-dimensional array, created on demand by the first message to each:
// 10⁶ indices, of which each PE sends to its share inside an epoch, all from one entry method or
// paced. Then plain messages to all of them.
#include "apps/bench/shapes/shapes.hpp"
#include "runtime/base/usable_memory.hpp"
#include "runtime/runtime.hpp"

#include <malloc.h>

namespace bench {
namespace {

enum class Way : std::uint8_t { here, home, plain };

class Cell : public tess::Chare<Cell, tess::Index3> {
 public:
  void touch(std::int32_t weight) { weight_ += weight; }
  void count(tess::Callback<std::int64_t> total) {
    contribute(tess::sum, std::int64_t{weight_}, std::move(total));
  }

 private:
  std::int32_t weight_ = 0;
};

using Cells = tess::ArrayProxy<Cell>;

struct Share {
  Cells cells;
  Way way = Way::here;
  std::int64_t next = 0, last = 0;
  std::int64_t n_at_once = 0;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(cells, way, next, last, n_at_once);
  }
};

class Toucher : public tess::Group<Toucher> {
 public:
  /// `share` of the whole: this PE sends to its part of it.
  void begin(Share share) {
    const std::int64_t n = share.last;
    const std::int64_t me = pe().value, n_pes = tess::n_pes();
    share.next = n * me / n_pes;
    share.last = n * (me + 1) / n_pes;
    touch(share);
  }
  void touch(Share share) {
    const std::int64_t end = std::min(share.last, share.next + share.n_at_once);
    for (; share.next < end; ++share.next) {
      const auto i = static_cast<std::int32_t>(share.next);
      const auto cell = share.cells[{i % 100, i / 100 % 100, i / 10'000}];
      if (share.way == Way::here) cell.send_or_create_here<&Cell::touch>(1);
      if (share.way == Way::home) cell.send_or_create_home<&Cell::touch>(1);
      if (share.way == Way::plain) cell.send<&Cell::touch>(1);
    }
    if (share.next < share.last) group()[pe()].send<&Toucher::touch>(share);
  }
  /// The memory of all processes. What was freed goes back to the system first.
  void sum_memory(tess::Callback<double> sum) {
    const tess::Machine& machine = tess::machine();
    const bool speaks =
        pe().value == 0 || (!machine.virtual_time() && machine.is_first_of_process(pe()));
    if (speaks) malloc_trim(0);
    contribute(tess::sum, speaks ? static_cast<double>(tess::detail::resident_memory()) : 0.0,
               std::move(sum));
  }
};

struct CreationRun {
  std::int32_t n = 0;
  tess::GroupProxy<Toucher> touchers;
};

tess::Task memory(CreationRun run, double& bytes) {
  bytes = co_await run.touchers.reduce<&Toucher::sum_memory>();
}

/// All PEs touch their shares; gives the nanoseconds of a touch.
tess::Task touch_all(CreationRun run, Share share, double& result) {
  share.last = run.n;
  const auto touch = [&] { run.touchers.broadcast<&Toucher::begin>(share); };
  const Stopwatch watch;
  co_await tess::epoch(touch);
  result = watch.nanoseconds() / run.n;
}

struct CreationVariant {
  const char* name;
  const char* meaning;
  Way way;
  std::int64_t n_at_once;
  Samples time{}, bytes{};
};

tess::Task measure_creation(const Bench& bench, CreationVariant& variant, Samples& plain) {
  const CreationRun run{bench.size(1'000'000, 2000), tess::create<Toucher>(tess::each_pe)};
  for (std::int32_t turn = 0; turn <= bench.repeat(); ++turn) {
    const auto cells = tess::create<Cell>(tess::sparse);
    double before = 0, after = 0, creation = 0, message = 0;
    if (turn == 0) co_await memory(run, before);
    co_await touch_all(run, {cells, variant.way, 0, 0, variant.n_at_once}, creation);
    if (turn == 0) co_await memory(run, after);
    co_await touch_all(run, {cells, Way::plain, 0, 0, variant.n_at_once}, message);

    const std::int64_t weight = co_await cells.reduce<&Cell::count>();
    TESS_CHECK(weight == 2 * run.n, "cells were touched ", weight, " times, not ", 2 * run.n);
    const auto end = [&] { cells.destroy(); };
    co_await tess::epoch(end);

    // Memory that is freed stays with the process: only the first time does it grow by what is
    // used.
    if (turn == 0) {
      variant.bytes.add((after - before) / run.n);
    } else {
      variant.time.add(creation);
      plain.add(message);
    }
  }
}

std::vector<CreationVariant> creation_variants() {
  constexpr std::int64_t all = std::int64_t{1} << 40U;
  return {{"creation_here", "by here, all from one entry method per PE", Way::here, all},
          {"creation_home", "by home, all from one entry method per PE", Way::home, all},
          {"creation_here_paced", "by here, 100 sends per entry method", Way::here, 100},
          {"creation_home_paced", "by home, 100 sends per entry method", Way::home, 100}};
}

int run_creation(Bench& bench) {
  std::vector<CreationVariant> variants = creation_variants();
  for (CreationVariant& variant : variants) {
    const std::string name = variant.name;
    const bool with_plain = name == "creation_here" && bench.wants("ordinary_message");
    if (!with_plain && !bench.wants(name) && !bench.wants(name + "_bytes")) continue;
    Samples plain;
    const int code = bench.run([&] { return measure_creation(bench, variant, plain); });
    if (code != 0) return code;
    bench.row(name, variant.time, "ns");
    bench.row(name + "_bytes", variant.bytes, "bytes");
    if (with_plain) bench.row("ordinary_message", plain, "ns");
  }
  return 0;
}

}  // namespace

Shape creation_shape() {
  std::vector<RowText> rows;
  const std::vector<CreationVariant> variants = creation_variants();
  for (const CreationVariant& variant : variants) {
    rows.push_back({variant.name, variant.meaning});
    rows.push_back({std::string(variant.name) + "_bytes", "growth of resident memory per element"});
  }
  rows.push_back({"ordinary_message", "a message to each of the elements once they are there"});
  return {"creation",
          "10^6 elements of a sparse 3D array created on demand, elapsed time over elements", rows,
          nullptr, &run_creation};
}

}  // namespace bench
