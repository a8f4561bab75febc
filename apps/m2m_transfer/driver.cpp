#include "apps/m2m_transfer/driver.hpp"

#include "apps/kit/output/write_file.hpp"
#include "apps/m2m_transfer/options.hpp"
#include "apps/m2m_transfer/output/transfer.hpp"
#include "apps/m2m_transfer/result_format.hpp"
#include "apps/m2m_transfer/run/measure.hpp"
#include "apps/m2m_transfer/run/reference.hpp"
#include "apps/m2m_transfer/run/steps.hpp"
#include "apps/m2m_transfer/study/drift.hpp"
#include "apps/m2m_transfer/study/pes.hpp"
#include "apps/m2m_transfer/study/steps.hpp"
#include "apps/m2m_transfer/study/study.hpp"
#include "m2m/read_mesh.hpp"
#include "runtime/core/error.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>

namespace m2m_transfer {
namespace {

using Reports = std::vector<TransferReport>;

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

/// The kinds of a table of kinds.
std::vector<TransferKind> kinds_of(const kit::Driver& driver, const Options& options) {
  if (driver.is_given("--kind") && options.request.kind != "all")
    return {parse_transfer_kind(options.request.kind)};
  return {all_transfer_kinds.begin(), all_transfer_kinds.end()};
}

/// Options that only some kinds know are refused before the first of many runs.
void check_kinds(const std::vector<TransferKind>& kinds, const Options& options) {
  Request request = options.request;
  for (const std::string& policy : options.policies) {
    request.policy = policy;
    for (const TransferKind kind : kinds) check_kind(kind, request);
  }
}

/// Adds to `left_out`, once, why a run is not possible with its kind; true if it is.
bool has_kind(const Problem& problem, const Request& request, std::string& left_out) {
  try {
    check_kind(problem.kind, request);
    check(options_of(problem));
    for (const Pair& pair : problem.pairs)
      require_dimensions(problem.kind, problem.tolerance, problem.source_of(pair).survey.dimension,
                         problem.target_of(pair).survey.dimension);
    return true;
  } catch (const tess::Error& error) {
    const std::string line = text("left out: ", error.what(), "\n");
    if (left_out.find(line) == std::string::npos) left_out += line;
    return false;
  }
}

Task move_files(const Options& options, kit::Driver& driver) {
  const FileFieldsReport report = co_await move_file_fields(options.request, driver.progress());
  driver.write(std::vector{json_of(report)});
  driver.progress().clear();
  print(table(report));
}

Task drift_table(const Options& options, kit::Driver& driver) {
  Request request = options.request;
  const std::vector<std::int32_t> trips = parse_trips(options.round_trips);
  const std::vector<TransferKind> kinds = kinds_of(driver, options);
  check_kinds(kinds, options);
  request.kind = name_of(kinds.front());
  kit::make_folder("--plot", options.plot);
  Drift drift;
  co_await measure_drift(request, kinds, trips, driver.progress(), drift);
  driver.progress().clear();
  print(
      fmt::format("{0} -> {1} -> {0}, one pair of handles, on {2}\n", request.source,
                  request.target, machine().describe()),
      drift_rows().table(drift.rows),
      "L2, Linf: of the difference to the start (L2 relative); L2 kept: the norm as a part of "
      "that at the start;\nintegral: by the row sums of the mass matrix; change: as a part of the "
      "integral of |field|\n");
  write(driver, options.plot, {"drift", drift_rows().csv(drift.rows), pictures_of(drift.rows)},
        drift_rows().json(drift.rows), {{"trip_seconds", drift.trip_seconds}});
}

/// Throws Error (bad_argument) if a mesh of the result, or a part of one, would replace a file of
/// the run. Their names are known when the meshes are.
void refuse_to_overwrite(kit::FileNames& names, const std::string& out, const Problem& problem) {
  for (std::size_t m = 0; m < problem.meshes.size() && !out.empty(); ++m) {
    if (!is_written(m, problem.pairs)) continue;
    const std::string path = path_of_result(out, m, problem.meshes.size(), problem.pairs);
    if (path != out) names.writes("--out " + out + ":", path);
    if (is_pvd(path)) names.writes("--out " + out + ":", PvdSeries::path_of_step(path, 0));
    for (std::int32_t k = 0; k < problem.chares() && is_pvtu(out); ++k)
      names.writes("--out " + out + ":",
                   std::filesystem::path(path).replace_extension(fmt::format("{}.vtu", k)));
  }
}

void write_reports(const kit::Driver& driver, const Reports& reports) {
  driver.write(field_rows().json(rows_of(reports)), {{"definitions", definitions()}});
}

void explain_to_user(kit::Driver& driver, const std::string& text) {
  if (!driver.explains()) return;
  driver.progress().clear();
  print(text);
}

/// Appends a report of --reference, if it is given.
Task add_reference(const Options& options, const Problem& problem, kit::Progress& progress,
                   Reports& reports) {
  if (options.reference.empty()) co_return;
  progress.phase("reference");
  reports.push_back(co_await measure_reference(problem));
}

Task transfer_once(const Options& options, kit::Driver& driver) {
  Request request = options.request;
  request.repeat = options.repeat.value_or(1);
  const std::string& out = options.request.out;
  kit::require_writable("--out", out);
  require_result_format(out);
  kit::require_picture("--picture", options.picture);
  Problem problem = co_await read(request, driver.progress());
  refuse_to_overwrite(driver.files(), out, problem);
  const bool in_parts = is_pvtu(out);
  if (in_parts) problem.parts_path = out;
  const bool writes_whole = !out.empty() && !in_parts;
  problem.collects = writes_whole || !options.picture.empty();
  explain_to_user(driver, explain(problem, out.empty() ? Output::report : Output::mesh));
  co_await measure(problem, create<Gauge>(each_pe), driver.progress());
  Reports reports = problem.reports;
  co_await add_reference(options, problem, driver.progress(), reports);
  driver.progress().phase("writing");
  if (problem.collects) bring_targets(problem);
  write_reports(driver, reports);
  if (!options.picture.empty()) kit::write_file(options.picture, picture(problem));
  if (writes_whole) write_meshes(out, problem);
  driver.progress().clear();
  std::string text;
  for (const TransferReport& report : problem.reports) text += table(report);
  print(text + legend());
  if (!options.reference.empty()) print(field_rows().table(rows_of(reports)));
}

/// Every kind, one after the other, from the same meshes and fields.
Task transfer_all_kinds(const Options& options, kit::Driver& driver) {
  Request request = options.request;
  request.repeat = options.repeat.value_or(1);
  const std::vector<TransferKind> kinds = kinds_of(driver, options);
  request.kind = name_of(kinds.front());
  const Problem read_once = co_await read(request, driver.progress());
  const auto gauge = create<Gauge>(each_pe);
  Reports reports;
  std::string left_out;
  Problem measured;  // linear is possible with any meshes
  for (const TransferKind kind : kinds) {
    driver.progress().part(reports.size() / read_once.pairs.size() + 1, kinds.size());
    Problem problem = read_once;
    problem.kind = kind;
    if (!has_kind(problem, request, left_out)) continue;
    for (TransferReport& report : problem.reports) report.kind = name_of(kind);
    explain_to_user(driver, text(name_of(kind), ": ", explain(problem, Output::report)));
    co_await measure(problem, gauge, driver.progress());
    reports.insert(reports.end(), problem.reports.begin(), problem.reports.end());
    measured = std::move(problem);
  }
  co_await add_reference(options, measured, driver.progress(), reports);
  write_reports(driver, reports);
  driver.progress().clear();
  print(fmt::format("every kind on {}, {} chares per mesh\n", machine().describe(),
                    read_once.chares()),
        field_rows().table(rows_of(reports)),
        "errors over all vertices, and over those found; integral: that over the target without "
        "that over the source\n",
        left_out);
}

std::string folder_of(const Options& options) {
  std::string folder = options.plot.empty() ? "study" : options.plot;
  kit::make_folder("--plot", folder);
  return folder;
}

std::vector<std::string> kinds_of_study(const kit::Driver& driver, const Options& options) {
  if (options.study != "kind" && options.request.kind != "all") return {options.request.kind};
  const std::vector<TransferKind> kinds = kinds_of(driver, options);
  check_kinds(kinds, options);
  std::vector<std::string> names;
  for (const TransferKind kind : kinds) names.emplace_back(name_of(kind));
  return names;
}

Task run_study(const Options& options, kit::Driver& driver) {
  const std::vector<std::string> kinds = kinds_of_study(driver, options);
  std::vector<Request> requests = plan_study(options.request, options.policies, kinds);
  const std::string folder = folder_of(options);
  const std::int32_t repeat = options.repeat.value_or(3);
  const auto gauge = create<Gauge>(each_pe);
  Reports reports;
  std::string left_out;
  Problem measured;
  for (Request& request : requests) {
    driver.progress().part(reports.size() + 1, requests.size());
    request.repeat = repeat;
    Problem problem = co_await read(request, driver.progress());
    if (kinds.size() == 1 || has_kind(problem, request, left_out)) {
      explain_to_user(driver, explain(problem, Output::report));
      co_await measure(problem, gauge, driver.progress());
      reports.push_back(problem.reports.front());
      measured = std::move(problem);
    }
    if (request.kind == kinds.back() && request.policy == options.policies.back())
      co_await add_reference(options, measured, driver.progress(), reports);
  }
  driver.progress().clear();
  const std::vector<FieldRow> rows = rows_of(reports);
  const std::vector<Trend> orders = trends(reports);
  // A point that snaps by the tolerance has the value of another place.
  std::vector<Check> held;
  if (options.study == "kind" && options.request.tolerance == 0) held = checks(reports);
  print(fmt::format("study of {} transfers, each the fastest of {}, on {}\n", reports.size(),
                    repeat, machine().describe()),
        field_rows().table(rows),
        "L2: sqrt(sum m e^2), m the lumped mass; Linf: max |e|; over all vertices of the target, "
        "and over those found\n",
        held.empty() ? "" : check_rows().table(held),
        "fitted powers (over all): error ~ edge^p, error ~ seconds^q; exact: relative L2 below "
        "1e-12 everywhere\n",
        trend_rows().table(orders), left_out);
  write(driver, folder, {"study", field_rows().csv(rows), pictures_of(reports)},
        field_rows().json(rows),
        {{"definitions", definitions()},
         {"trends", trend_rows().json(orders)},
         {"checks", check_rows().json(held)}});
  const std::string failed = failures(held);
  print(failed);
  if (!failed.empty()) tess::exit(1);
}

Task run_steps_study(const Options& options, kit::Driver& driver) {
  const Request& request = options.request;
  const std::vector<Request> requests = plan_study(request, options.policies, {request.kind});
  const std::string folder = folder_of(options);
  std::vector<StepsRow> rows;
  for (const Request& one : requests) {
    Problem problem = co_await read(one, driver.progress());
    co_await measure_steps(problem, options.repeat.value_or(3), driver.progress(), rows);
  }
  driver.progress().clear();
  print(steps_rows().table(rows),
        "kept: one search, then the steps; again: a search in every step\n");
  write(driver, folder, {"steps", steps_rows().csv(rows), {picture_of(rows)}},
        steps_rows().json(rows));
  if (!std::ranges::all_of(rows, &StepsRow::ok)) tess::exit(1);
}

/// The machines are no part of a run, since each has a process. Returns the exit code.
int run_pes_study(const Options& options, const tess::Setup& setup, const char* program,
                  kit::Driver& driver) {
  if (setup.machine->n_processes() != 1 || setup.machine->virtual_time())
    fail(ErrorCode::bad_argument,
         "--study pes simulates its machines; leave out mpirun and --sim (--machines and "
         "--network describe them)");
  Request request = options.request;
  request.repeat = options.repeat.value_or(3);
  const std::vector<SimulatedOptions> machines = machines_of(options.pes, options.sim);
  kit::make_folder("--plot", options.plot);
  std::vector<PesRow> rows;
  print(request.source, " -> ", request.target, ", simulated, ", options.sim, "\n",
        pes_rows().head());
  for (const SimulatedOptions& machine : machines) {
    driver.progress().phase("measuring");
    driver.progress().part(rows.size() + 1, machines.size());
    PesRow row;
    if (const int code = measure(program, request, setup.options, machine, row); code != 0)
      return code;
    const PesRow& first = rows.empty() ? row : rows.front();
    row.speed_up = first.together() / row.together();
    row.efficiency = row.speed_up * first.pes / row.pes;
    rows.push_back(row);
    driver.progress().clear();
    print(pes_rows().line(row));
  }
  write(driver, options.plot,
        {"pes", pes_rows().csv(rows), {picture_of(rows, request.source + " to " + request.target)}},
        pes_rows().json(rows));
  for (const PesRow& row : rows)
    if (!row.has_values_of(rows.front())) {
      fmt::print(stderr, "m2m_transfer: {} PEs give other values than {}\n", row.pes,
                 rows.front().pes);
      return 1;
    }
  return 0;
}

/// The mode may follow from the fields of the source's file, and from values.
void choose_mode(const Options& options, kit::Driver& driver) {
  const FileFieldsRequest& request = options.request;
  if (is_for_files(request))
    request.from_weights.empty()
        ? driver.enter(Mode::files, "fields and weights of files")
        : driver.enter(Mode::from_weights,
                       "--from-weights, which applies a matrix without a search");
  if (request.kind != "all") return;
  if (driver.mode() == Mode::run)
    driver.enter(Mode::all_kinds, "--kind all, which has several results");
  if (driver.mode() == Mode::files)
    tess::refuse_together("--kind all", "fields and weights of files");
  if ((driver.mode() & (Mode::steps | Mode::pes)) != 0)
    tess::refuse_together("--kind all", "--study " + options.study);
}

Task run(const Options& options, kit::Driver& driver) {
  choose_mode(options, driver);
  switch (driver.mode()) {
    case Mode::all_kinds:
      return transfer_all_kinds(options, driver);
    case Mode::files:
    case Mode::from_weights:
      return move_files(options, driver);
    case Mode::round_trips:
      return drift_table(options, driver);
    case Mode::study:
      return run_study(options, driver);
    case Mode::steps:
      return run_steps_study(options, driver);
    default:
      return transfer_once(options, driver);
  }
}

}  // namespace

int start(tess::Setup& setup, int argc, char** argv) {
  Options options;
  kit::Driver driver(
      setup, "Moves fields between two tetrahedral meshes, and prints the error and the time.");
  if (!read_options(driver, options, argc, argv)) return 0;
  const auto refuse_missing = [](const char* mesh) {
    fail(ErrorCode::bad_argument, mesh,
         " is missing; give a source and a target mesh (--help lists the arguments)");
  };
  if (options.request.source.empty()) refuse_missing("SOURCE");
  if (options.request.target.empty() && (driver.mode() & (Mode::study | Mode::steps)) == 0)
    refuse_missing("TARGET");
  if (driver.mode() == Mode::pes) {
    choose_mode(options, driver);
    return run_pes_study(options, setup, argv[0], driver);
  }
  return tess::run(setup, [&] { return run(options, driver); });
}

}  // namespace m2m_transfer
