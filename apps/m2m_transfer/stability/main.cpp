// m2m_stability [SOURCE [TARGET]]: transfers between extreme meshes and points, and the same of the
// meshes given; m2m_transfer --stability runs it. Exit code 1 if a row fails.
#include "apps/m2m_transfer/options.hpp"
#include "apps/m2m_transfer/stability/rows.hpp"
#include "m2m/read_mesh.hpp"
#include "runtime/runtime.hpp"

#include <utility>

namespace m2m_transfer::stability {
namespace {

constexpr std::size_t n_points = 40000;  // on faces and edges

/// The generated cases, and those of the meshes given.
std::vector<Case> cases_for(const Request& request) {
  std::vector<Case> cases = generated_cases(n_points);
  std::vector<TetMesh> meshes;
  for (const std::string& name : {request.source, request.target}) {
    if (name.empty()) continue;
    meshes.push_back(read_mesh(name));
    (void)validate(meshes.back());
    for (Case& one : cases_of(meshes.back(), n_points)) cases.push_back(std::move(one));
  }
  if (meshes.size() == 2) {
    cases.push_back(case_between(meshes[0], meshes[1]));
    cases.push_back(case_between(meshes[1], meshes[0]));
  }
  return cases;
}

constexpr kit::Column<Row> columns[] = {{"points", "points", "6", kit::of<&Row::n_points>},
                                        {"lost", "lost", "4", kit::of<&Row::lost>},
                                        {"snapped", "snapped", "7", kit::of<&Row::snapped>},
                                        {"outside", "outside", "7", kit::of<&Row::outside>},
                                        {"runs", "runs", "4", kit::of<&Row::n_runs>},
                                        {"same_bits", "same bits", "<9", kit::of<&Row::same_bits>}};

int run(Setup& setup, int argc, char** argv) {
  Options options;
  kit::Driver driver(
      setup,
      "Transfers between extreme meshes and points, and the same of SOURCE and TARGET where they "
      "are given: points lost, error, bits. It takes the options of m2m_transfer, and refuses "
      "those that it does not use.");
  if (!read_options(driver, options, argc, argv)) return 0;
  driver.enter(Mode::stability, "--stability");
  Ways ways{.policy = parse_policy(options.request.policy)};
  if (driver.is_given("--partition"))
    ways.partition = parse_partition_method(options.request.partition);
  kit::Cases<Row> report(columns);
  for (Row& row : run_cases(setup, cases_for(options.request), ways, driver.progress())) {
    driver.progress().clear();
    report.add(std::move(row));
  }
  if (!driver.speaks()) return 0;
  return report.finish(driver,
                       "met: largest |value - truth| over the points found; runs: with 1, 6 and 16 "
                       "parts, on this machine and simulated ones\n");
}

}  // namespace
}  // namespace m2m_transfer::stability

int main(int argc, char** argv) {
  return tess::guarded(argc, argv, [&](tess::Setup& setup) {
    return m2m_transfer::stability::run(setup, argc, argv);
  });
}
