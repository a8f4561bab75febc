#include "apps/m2m_transfer/driver.hpp"

#include "apps/m2m_transfer/drive_files.hpp"
#include "apps/m2m_transfer/explain.hpp"
#include "apps/m2m_transfer/measure.hpp"
#include "apps/m2m_transfer/picture.hpp"
#include "apps/m2m_transfer/study.hpp"
#include "apps/plot/write_file.hpp"
#include "m2m/write_exodus.hpp"

#include <cstdio>

namespace m2m_transfer {
namespace {

Problem read(const Request& request, apps::Progress& progress) {
  progress.phase("reading");
  const Time start = now();
  Problem problem = load(request, machine());
  problem.report.seconds.read = tess::seconds(now() - start);
  return problem;
}

Task transfer_once(const DriverOptions& options, apps::Progress& progress) {
  if (options.policies.size() > 1)
    fail(ErrorCode::bad_argument, "--policy is given more than once; give it once, or add --study");
  plot::require_writable("--json", options.json);
  plot::require_writable("--out", options.out);
  plot::require_writable("--picture", options.picture);
  if (options.request.target.empty())
    fail(ErrorCode::bad_argument,
         "TARGET is missing; give a source and a target mesh (--help lists the arguments)");
  Request request = options.request;
  request.policy = options.policies.front();
  request.repeat = options.repeat.value_or(1);
  Problem problem = read(request, progress);
  if (options.explain) {
    progress.clear();
    print(explain(problem, options.out.empty() ? Output::report : Output::mesh));
  }
  const auto gauge = create_group<Gauge>();
  co_await measure(problem, gauge, progress);
  progress.phase("writing");
  if (!options.json.empty()) plot::write_file(options.json, json({problem.report}));
  if (!options.picture.empty()) plot::write_file(options.picture, picture(problem));
  if (!options.out.empty()) write_exodus(options.out, problem.target, problem.target_fields);
  progress.clear();
  print(table(problem.report));
}

Task run_study(const DriverOptions& options, apps::Progress& progress) {
  if (!options.out.empty() || !options.picture.empty())
    fail(ErrorCode::bad_argument,
         "--out and --picture do not work with --study; give them for one transfer");
  plot::require_writable("--json", options.json);
  std::vector<Request> requests = plan_study(options.request, options.policies);
  prepare_folder(*options.study);
  const auto gauge = create_group<Gauge>();
  std::vector<TransferReport> reports;
  for (Request& request : requests) {
    progress.part(static_cast<std::uint32_t>(reports.size() + 1),
                  static_cast<std::uint32_t>(requests.size()));
    request.repeat = options.repeat.value_or(3);
    Problem problem = read(request, progress);
    if (options.explain) {
      progress.clear();
      print(explain(problem, Output::report));
    }
    co_await measure(problem, gauge, progress);
    reports.push_back(problem.report);
  }
  progress.clear();
  const Study study{std::move(reports), options.repeat.value_or(3)};
  print(table(study));
  print(write(study, *options.study));
  if (!options.json.empty()) plot::write_file(options.json, json(study));
}

}  // namespace

int drive(Setup& setup, const DriverOptions& options) {
  apps::Progress progress(setup.machine->process().value == 0 ? stderr : nullptr);
  return tess::run(setup, [&]() -> Task {
    if (moves_file_fields(options)) return move_file_fields(options, progress);
    return options.study ? run_study(options, progress) : transfer_once(options, progress);
  });
}

}  // namespace m2m_transfer
