// m2m_stability [SOURCE [TARGET]]: transfers between extreme meshes and points, and the same of the
// meshes given; m2m_transfer --stability runs it. Exit code 1 if a row fails.
#include "apps/kit/write_file.hpp"
#include "apps/m2m_transfer/contradictions.hpp"
#include "apps/m2m_transfer/options.hpp"
#include "apps/m2m_transfer/stability/rows.hpp"
#include "m2m/read_mesh.hpp"
#include "runtime/command_line.hpp"
#include "runtime/runtime.hpp"

#include <algorithm>
#include <cstdio>

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

int run(Setup& setup, int argc, char** argv) {
  DriverOptions options;
  tess::CommandLine line(
      "Transfers between extreme meshes and points, and the same of SOURCE and TARGET where they "
      "are given: points lost, error, bits. It takes the options of m2m_transfer, and refuses "
      "those "
      "that it does not use.");
  if (!read_options(line, options, argc, argv)) return 0;
  (void)file_names(options, setup.options.trace);
  refuse_contradictions(options, Mode::stability);
  kit::require_writable("--json", options.json);
  Ways ways{.policy = parse_policy(options.policies.front())};
  if (options.partition_is_given)
    ways.partition = parse_partition_method(options.request.partition);
  kit::Progress progress(setup.machine->process().value == 0 ? stderr : nullptr);
  const std::vector<Row> rows = run_cases(setup, cases_for(options.request), ways, progress);
  progress.clear();
  if (setup.machine->process().value != 0) return 0;
  tess::print_text(table(rows));
  if (!options.json.empty()) kit::write_file(options.json, json(rows));
  return std::ranges::all_of(rows, &Row::ok) ? 0 : 1;
}

}  // namespace
}  // namespace m2m_transfer::stability

int main(int argc, char** argv) {
  return tess::guarded(argc, argv, [&](tess::Setup& setup) {
    return m2m_transfer::stability::run(setup, argc, argv);
  });
}
