// The pairs of boxes and triangles in one thread, without the runtime, beside other libraries on
// the same scenes in the same run: CSV on standard output. Methods run in turns, and a row is
// printed after the sets of pairs were compared. Times are processor times of the process, which
// stays on one core: on an idle machine they equal wall-clock times, and other programs disturb
// them only through the caches. Some cases are run on chares, too; times on two PEs are elapsed
// times.
//
//     bench_collide;  bench_collide planes wave_self_embree;  bench_collide --growth;  bench_collide --list
//
// The limit of our rows is the fastest other library of this run, if one has a row; of a collider
// on one PE the serial face, and on two PEs half the time of one.
#include "apps/bench/collide/case.hpp"
#include "apps/bench/collide/one_core.hpp"
#include "apps/bench/collide/rows.hpp"
#include "apps/kit/driver.hpp"
#include "apps/kit/output/write_file.hpp"

#include <algorithm>
#include <fmt/core.h>

namespace bench {
namespace {

/// Every name that --list shows.
void list() {
  for (const Case& of : box_cases()) {
    fmt::print("{}: {}, {}\n", of.name, of.scene, of.meaning);
    for (const auto& [row, meaning] : box_row_texts(of.name))
      fmt::print("  {:<26} {}\n", row, meaning);
  }
  fmt::print("conversion: a coordinate to the index of its voxel\n");
  for (const auto& [row, meaning] : conversion_row_texts())
    fmt::print("  {:<26} {}\n", row, meaning);
  fmt::print("colliders on chares: rows of the cases above\n");
  for (const Case& of : box_cases())
    for (const auto& [row, meaning] : chare_row_texts(of.name))
      fmt::print("  {:<26} {}\n", row, meaning);
  fmt::print("growth: our ns per object from 2^10 to 2^22 objects; with --growth or by its name\n");
}

void require_known(const std::string& name) {
  if (name == "growth" || name == "conversion") return;
  for (const auto& [row, meaning] : conversion_row_texts())
    if (name == row) return;
  for (const Case& of : box_cases()) {
    if (name == of.name) return;
    if (!name.starts_with(of.name + "_")) continue;
    for (const auto& rows : {box_row_texts(of.name), chare_row_texts(of.name)})
      for (const auto& [row, meaning] : rows)
        if (name == row) return;
  }
  tess::fail(tess::ErrorCode::bad_argument, "no case and no row is named ", name, " (see --list)");
}

}  // namespace
}  // namespace bench

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] {
    bench::CollideOptions options;
    std::string json;
    bool lists = false;
    tess::CommandLine line("The pairs of boxes in one thread, beside other libraries.");
    line.option("NAME", options.names, "cases or rows (all by default)");
    const tess::Option repeat =
        line.option("--repeat", options.repeat, "samples of each figure, after one that warms up")
            .between(1, 1000);
    line.flag("--growth", options.growth, "also the growth from 2^10 to 2^22 objects");
    line.flag("--list", lists, "names and meanings of what can be measured by this build");
    line.flag("--quick", options.quick, "small sizes: to try out, not to measure");
    line.option("--json FILE", json, "a file for the rows as JSON");
    if (!line.parse(argc, argv, {})) return 0;
    if (lists) {
      bench::list();
      return 0;
    }
    if (options.quick && !repeat.is_given()) options.repeat = 1;
    for (const std::string& name : options.names) bench::require_known(name);
    kit::require_writable("--json", json);

    bench::Output output(options, "one core");
    output.report().header();
    {
      const bench::OneCore one_core;
      bench::box_rows(output);
      if (output.wants_any("conversion")) bench::conversion_rows(output);
      if (options.growth || (!options.names.empty() && output.wants("growth", "growth")))
        bench::growth_rows(output);
    }
    bench::chare_rows(output);
    if (!json.empty())
      kit::write_file(json, kit::json_text(kit::document("bench_collide", "one core",
                                                         {{"names", options.names},
                                                          {"repeat", options.repeat},
                                                          {"growth", options.growth},
                                                          {"quick", options.quick}},
                                                         output.report().json())));
    return 0;
  });
}
