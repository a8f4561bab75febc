#include "apps/bench/measures.hpp"
#include "runtime/runtime.hpp"

#include <cstdio>
#include <unistd.h>

namespace bench {
namespace {

constexpr std::int32_t edge = 100;  // 10⁶ indices

class Cell : public tess::Chare<Cell, tess::Index3> {
 public:
  void touch(std::int32_t weight) { weight_ += weight; }
  void count(tess::Callback<std::int64_t> total) {
    contribute(tess::sum, std::int64_t{weight_}, std::move(total));
    destroy();
  }

 private:
  std::int32_t weight_ = 0;
};

using Cells = tess::ArrayProxy<Cell>;

/// Touches each cell of its share of the planes once; a row at a time, so that few messages wait.
class Toucher : public tess::Group<Toucher> {
 public:
  void touch_from(Cells cells, std::int32_t row) {
    for (std::int32_t x = 0; x < edge; ++x)
      cells[{x, row % edge, row / edge}].send_or_create_here<&Cell::touch>(1);
    const std::int32_t next = row + tess::current_pe().n_pes();
    if (next < edge * edge) group()[pe()].send<&Toucher::touch_from>(cells, next);
  }
  void begin(Cells cells) { touch_from(cells, pe().value); }
};

/// Resident bytes of this process.
double resident() {
  long pages = 0;
  std::FILE* const file = std::fopen("/proc/self/statm", "r");
  TESS_CHECK(file != nullptr && std::fscanf(file, "%*d %ld", &pages) == 1, "no /proc/self/statm");
  std::fclose(file);
  return static_cast<double>(pages) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace

tess::Task creation(const Report& report, Options options) {
  const auto touchers = tess::create_group<Toucher>();
  Samples time, bytes;
  const std::int64_t n = std::int64_t{edge} * edge * edge;
  for (std::int32_t k = 0; k < options.repeat; ++k) {
    const auto cells = tess::create<Cell>(tess::sparse);
    const double before = resident();
    const auto touch_all = [&] { touchers.broadcast<&Toucher::begin>(cells); };
    const Stopwatch watch;
    co_await tess::epoch(touch_all);
    time.add(watch.nanoseconds() / static_cast<double>(n));
    // Memory that is freed stays in the heap: only the first time does it grow by what is used.
    if (k == 0) bytes.add((resident() - before) / static_cast<double>(n));
    tess::Future<std::int64_t> total;
    cells.broadcast<&Cell::count>(total.callback());
    const std::int64_t weight = co_await total;
    TESS_CHECK(weight == n, weight, " cells were touched, not ", n);
  }
  report.row("creation on demand of a sparse 3D element", time, "ns", 2700);
  if (reach() != Reach::processes) report.row("memory of a sparse 3D element", bytes, "bytes", 844);
}

}  // namespace bench
