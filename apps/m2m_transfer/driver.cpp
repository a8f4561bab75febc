#include "apps/m2m_transfer/driver.hpp"

#include "apps/kit/write_file.hpp"
#include "apps/m2m_transfer/contradictions.hpp"
#include "apps/m2m_transfer/drive_files.hpp"
#include "apps/m2m_transfer/output/drift.hpp"
#include "apps/m2m_transfer/output/explain.hpp"
#include "apps/m2m_transfer/output/kinds_table.hpp"
#include "apps/m2m_transfer/output/picture.hpp"
#include "apps/m2m_transfer/output/table.hpp"
#include "apps/m2m_transfer/result_format.hpp"
#include "apps/m2m_transfer/run/drift.hpp"
#include "apps/m2m_transfer/run/measure.hpp"
#include "apps/m2m_transfer/study/checks.hpp"
#include "apps/m2m_transfer/study/steps.hpp"
#include "apps/m2m_transfer/study/study.hpp"
#include "m2m/read_mesh.hpp"
#include "runtime/command_line.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>

namespace m2m_transfer {
namespace {

TaskOf<Problem> read(const Request& request, kit::Progress& progress) {
  progress.phase("reading");
  const Time start = now();
  Problem problem = co_await load(request);
  for (TransferReport& report : problem.reports) report.seconds.read = tess::seconds(now() - start);
  co_return problem;
}

void write_meshes(const std::string& path, const Problem& problem) {
  for (std::size_t m = 0; m < problem.meshes.size(); ++m)
    if (is_written(m, problem.pairs))
      write_result(path_of_result(path, m, problem.meshes.size(), problem.pairs),
                   *problem.meshes[m].mesh, problem.meshes[m].fields);
}

/// The request of a run without a study.
Request single_request(const DriverOptions& options) {
  if (options.policies.size() > 1)
    fail(ErrorCode::bad_argument, "--policy is given more than once; give it once, or add --study");
  if (options.request.target.empty())
    fail(ErrorCode::bad_argument,
         "TARGET is missing; give a source and a target mesh (--help lists the arguments)");
  Request request = options.request;
  request.policy = options.policies.front();
  request.repeat = options.repeat.value_or(1);
  return request;
}

bool wants_all_kinds(const DriverOptions& options) {
  return options.request.kind == "all";
}

/// The kinds of a table of kinds. Options that only some of them know are refused before the first
/// runs.
std::vector<TransferKind> kinds_of(const DriverOptions& options) {
  if (options.kind_is_given && !wants_all_kinds(options))
    return {parse_transfer_kind(options.request.kind)};
  for (const std::string& policy : options.policies) {
    Request request = options.request;
    request.policy = policy;
    for (const TransferKind kind : all_transfer_kinds) check_kind(kind, request);
  }
  return {all_transfer_kinds.begin(), all_transfer_kinds.end()};
}

Task drift_table(const DriverOptions& options, kit::Progress& progress) {
  Request request = single_request(options);
  const std::vector<std::int32_t> trips = parse_trips(options.round_trips);
  const std::vector<TransferKind> kinds = kinds_of(options);
  request.kind = name_of(kinds.front());
  kit::require_writable("--json", options.json);
  kit::make_folder("--plot", options.plot);
  Drift drift;
  co_await measure_drift(request, kinds, trips, progress, drift);
  progress.clear();
  print(table(drift));
  if (!options.plot.empty()) print(write(drift, options.plot));
  if (!options.json.empty()) kit::write_file(options.json, json(drift));
}

/// Throws Error (bad_argument) if a mesh of the result, or a part of one, would replace a file of
/// the run. Their names are known when the meshes are.
void refuse_to_overwrite(kit::FileNames names, const std::string& out, const Problem& problem) {
  for (std::size_t m = 0; m < problem.meshes.size() && !out.empty(); ++m) {
    if (!is_written(m, problem.pairs)) continue;
    const std::string path = path_of_result(out, m, problem.meshes.size(), problem.pairs);
    if (path != out) names.writes("--out " + out + ":", path);
    for (std::int32_t k = 0; k < problem.chares() && is_pvtu(out); ++k)
      names.writes("--out " + out + ":",
                   std::filesystem::path(path).replace_extension(fmt::format("{}.vtu", k)));
  }
}

Task transfer_once(const DriverOptions& options, const kit::FileNames& names,
                   kit::Progress& progress) {
  const Request request = single_request(options);
  kit::require_writable("--json", options.json);
  kit::require_writable("--out", options.out);
  require_result_format(options.out);
  kit::require_picture("--picture", options.picture);
  Problem problem = co_await read(request, progress);
  refuse_to_overwrite(names, options.out, problem);
  const bool in_parts = is_pvtu(options.out);
  if (in_parts) problem.parts_path = options.out;
  const bool writes_whole = !options.out.empty() && !in_parts;
  problem.collects = writes_whole || !options.picture.empty();
  if (options.explain) {
    progress.clear();
    print(explain(problem, options.out.empty() ? Output::report : Output::mesh));
  }
  const auto gauge = create_group<Gauge>();
  co_await measure(problem, gauge, progress);
  progress.phase("writing");
  if (problem.collects) bring_targets(problem);
  if (!options.json.empty()) kit::write_file(options.json, json(problem.reports));
  if (!options.picture.empty()) kit::write_file(options.picture, picture(problem));
  if (writes_whole) write_meshes(options.out, problem);
  progress.clear();
  std::string text;
  for (const TransferReport& report : problem.reports) text += table(report);
  print(text + legend());
}

/// Every kind, one after the other, from the same meshes and fields.
Task transfer_all_kinds(const DriverOptions& options, kit::Progress& progress) {
  Request request = single_request(options);
  const std::vector<TransferKind> kinds = kinds_of(options);
  kit::require_writable("--json", options.json);
  request.kind = name_of(kinds.front());
  const Problem read_once = co_await read(request, progress);
  const auto gauge = create_group<Gauge>();
  std::vector<TransferReport> reports;
  for (const TransferKind kind : kinds) {
    progress.part(reports.size() / read_once.pairs.size() + 1, kinds.size());
    Problem problem = read_once;
    problem.kind = kind;
    for (TransferReport& report : problem.reports) report.kind = name_of(kind);
    if (options.explain) {
      progress.clear();
      print(name_of(kind), ": ", explain(problem, Output::report));
    }
    co_await measure(problem, gauge, progress);
    for (TransferReport& report : problem.reports) reports.push_back(std::move(report));
  }
  if (!options.json.empty()) kit::write_file(options.json, json(reports));
  progress.clear();
  print(kinds_table(reports));
}

Task run_study(const DriverOptions& options, kit::Progress& progress, bool& failed) {
  kit::require_writable("--json", options.json);
  std::vector<std::string> kinds{options.request.kind};
  if (*options.study == "kind" || wants_all_kinds(options)) {
    kinds.clear();
    for (const TransferKind kind : kinds_of(options)) kinds.emplace_back(name_of(kind));
  }
  std::vector<Request> requests = plan_study(options.request, options.policies, kinds);
  const std::string folder = options.plot.empty() ? "study" : options.plot;
  kit::make_folder("--plot", folder);
  const auto gauge = create_group<Gauge>();
  std::vector<TransferReport> reports;
  for (Request& request : requests) {
    progress.part(reports.size() + 1, requests.size());
    request.repeat = options.repeat.value_or(3);
    Problem problem = co_await read(request, progress);
    if (options.explain) {
      progress.clear();
      print(explain(problem, Output::report));
    }
    co_await measure(problem, gauge, progress);
    reports.push_back(problem.reports.front());
  }
  progress.clear();
  // A point that snaps by the tolerance has the value of another place.
  const Study study{std::move(reports), options.repeat.value_or(3),
                    *options.study == "kind" && options.request.tolerance == 0};
  print(table(study));
  std::vector<Check> rows;
  if (study.is_checked) rows = checks(study);
  if (!rows.empty()) print(table(rows));
  print(write(study, folder));
  if (!options.json.empty()) kit::write_file(options.json, json(study));
  failed = !all_ok(rows);
  if (failed) print(failures(rows));
}

Task run_steps_study(const DriverOptions& options, kit::Progress& progress, bool& failed) {
  kit::require_writable("--json", options.json);
  Request request = options.request;
  request.policy = options.policies.front();
  const std::vector<Request> requests = plan_study(request, {request.policy}, {request.kind});
  const std::string folder = options.plot.empty() ? "study" : options.plot;
  kit::make_folder("--plot", folder);
  std::vector<StepsRow> rows;
  for (const Request& one : requests) {
    Problem problem = co_await read(one, progress);
    co_await measure_steps(problem, options.repeat.value_or(3), progress, rows);
  }
  progress.clear();
  print(table(rows));
  failed = !std::ranges::all_of(rows, &StepsRow::ok);
  print(write(rows, folder));
  if (!options.json.empty()) kit::write_file(options.json, json(rows));
}

Mode mode_of(const DriverOptions& options) {
  const bool trips = !options.round_trips.empty();
  if (moves_file_fields(options)) {
    if (trips) tess::refuse_together("--round-trips " + options.round_trips, "fields of files");
    return Mode::files;
  }
  if (trips) return Mode::round_trips;
  return options.study ? Mode::study : Mode::transfer;
}

}  // namespace

int drive(Setup& setup, const DriverOptions& options) {
  kit::Progress progress(setup.machine->process().value == 0 ? stderr : nullptr);
  const kit::FileNames names = file_names(options, setup.options.trace);
  bool failed = false;
  const int code = tess::run(setup, [&]() -> Task {
    const Mode mode = mode_of(options);
    refuse_contradictions(options, mode);
    switch (mode) {
      case Mode::round_trips:
        return drift_table(options, progress);
      case Mode::files:
        return move_file_fields(options, progress);
      case Mode::study:
        return options.study == "steps" ? run_steps_study(options, progress, failed)
                                        : run_study(options, progress, failed);
      default:
        return wants_all_kinds(options) ? transfer_all_kinds(options, progress)
                                        : transfer_once(options, names, progress);
    }
  });
  return code == 0 && failed ? 1 : code;
}

}  // namespace m2m_transfer
