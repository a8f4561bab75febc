#include "apps/m2m_transfer/driver.hpp"

#include "apps/m2m_transfer/report.hpp"
#include "m2m/io/exodus_writer.hpp"
#include "m2m/io/read_mesh.hpp"
#include "m2m/transfer.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sys/resource.h>

namespace tess::m2m {
namespace {

/// Everything the run needs, checked. Lives on process 0; other processes hold it, too, but do not
/// use it.
struct Problem {
  const DriverOptions& options;
  TetMesh source, target;
  std::vector<Field> source_fields, target_fields;
  std::vector<Field> truth;
  OutsidePolicy policy;
  PartitionMethod partition{};
  Point voxel{};
  TransferReport report;
};

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

double seconds_since(Time start) {
  return std::chrono::duration<double>(current_pe().now() - start).count();
}

/// The values of all vertices, in global order, from the pieces the Workers gave.
void take(const Outcome& outcome, Problem& problem) {
  std::size_t n_components = 0;
  for (const Field& field : problem.target_fields) n_components += field.n_components;
  std::vector<double> status(problem.target.n_points());
  for (std::size_t i = 0; i < outcome.points.size(); ++i) {
    const auto vertex = static_cast<std::size_t>(outcome.points[i]);
    ++problem.report.counts[static_cast<std::size_t>(outcome.status[i])];
    status[vertex] = static_cast<double>(outcome.status[i]);
    for (std::size_t f = 0; f < problem.target_fields.size(); ++f)
      problem.target_fields[f].values[vertex] = outcome.values[i * n_components + f];
  }
  problem.target_fields.push_back({"status", 1, std::move(status)});
  problem.report.n_candidates = outcome.n_candidates;
}

void judge(Problem& problem) {
  TransferReport& report = problem.report;
  std::uint64_t hash = result_hash({});
  for (std::size_t f = 0; f < problem.truth.size(); ++f) {
    const Field& truth = problem.truth[f];
    const std::vector<double>& values = problem.target_fields[f].values;
    report.fields.push_back({truth.name, error_norms(problem.target, values, truth.values)});
    hash = result_hash(values, hash);
  }
  report.result_hash = hash;
  report.worst_at =
      problem.target.points[static_cast<std::size_t>(report.fields.front().norms.worst)];
}

void write_file(const std::string& path, const std::string& content) {
  std::ofstream file(path);
  file << content;
  file.close();
  if (!file) fail(ErrorCode::environment, "--json ", path, ": cannot be written");
}

Task transfer_all(Problem& problem) {
  Pe& pe = current_pe();
  const Time start = pe.now();
  TransferReport& report = problem.report;
  DistributedMesh source, target;
  co_await epoch([&] {
    source = scatter(problem.source, problem.source_fields, report.chares, problem.partition);
    target = scatter(problem.target, problem.target_fields, report.chares, problem.partition);
  });
  report.seconds.setup = seconds_since(start);
  for (std::int32_t round = 0; round < problem.options.repeat; ++round) {
    TransferTimes times;
    const TransferOptions options{{0, 0, 0}, problem.voxel, problem.policy};
    co_await transfer(source, target, options, &times);
    PhaseSeconds& best = report.seconds;
    if (round == 0 || times.broad + times.narrow + times.report < best.transfer()) {
      best.broad = times.broad;
      best.narrow = times.narrow;
      best.report = times.report;
    }
  }
  Future<Outcome> outcome;
  target.workers.broadcast<&Worker::gather>(outcome.callback());
  take(co_await outcome, problem);
  judge(problem);
  report.bytes_sent = pe.statistics().bytes_sent;
  report.peak_memory_bytes = peak_memory_bytes();
  print(table(report));
  if (!problem.options.json.empty()) write_file(problem.options.json, json(report));
  if (!problem.options.out.empty())
    write_exodus(problem.options.out, problem.target, problem.target_fields);
}

void explain(const Problem& problem) {
  std::string out = "this transfer uses\n";
  out += text(
      "  ", problem.source_fields.size(), " field(s) of one component, side by side in one pass\n");
  out += "  voxels that a source tetrahedron or a target vertex touches, none for empty space\n";
  out += "it leaves out\n";
  out += "  the serial step in voxels that hold objects of one mesh alone\n";
  out += "  pairs within a mesh, and telling the source of candidates\n";
  if (!std::holds_alternative<Nearest>(problem.policy))
    out += "  the search for nearest vertices (--policy nearest)\n";
  if (problem.options.out.empty()) out += "  writing a mesh (--out)\n";
  print(out);
}

}  // namespace

int drive(Setup& setup, const DriverOptions& options) {
  Problem problem{options,
                  {},
                  {},
                  {},
                  {},
                  {},
                  parse_policy(options.policy),
                  parse_partition_method(options.partition),
                  {},
                  {}};
  problem.source = read_mesh(options.source);
  problem.target = read_mesh(options.target);
  validate(problem.source);
  validate(problem.target);
  const Box domain = bounds(problem.source);
  for (const std::string& name : options.fields) {
    const Formula formula = make_formula(name, domain);
    problem.source_fields.push_back(sample(problem.source, name, formula));
    problem.truth.push_back(sample(problem.target, name, formula));
    problem.target_fields.push_back({name, 1, std::vector<double>(problem.target.n_points(), 0.0)});
  }
  problem.voxel = suggest_voxel_size(problem.source, problem.target);
  if (options.voxel > 0) problem.voxel = {options.voxel, options.voxel, options.voxel};

  const Machine& machine = *setup.machine;
  TransferReport& report = problem.report;
  report.source = options.source;
  report.target = options.target;
  report.machine = machine.describe();
  report.pes = machine.n_pes();
  report.processes = machine.n_processes();
  report.chares = options.n_chares != 0 ? options.n_chares : options.per_pe * machine.n_pes();
  report.voxel = problem.voxel[0];
  report.source_tets = problem.source.n_tets();
  report.targets = problem.target.n_points();
  if (options.explain && machine.process().value == 0) explain(problem);
  return tess::run(setup, [&problem]() -> Task { return transfer_all(problem); });
}

}  // namespace tess::m2m
