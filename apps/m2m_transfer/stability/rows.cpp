#include "apps/m2m_transfer/stability/rows.hpp"

#include "apps/m2m_transfer/run/meshes.hpp"
#include "m2m/transfer.hpp"
#include "runtime/core/error.hpp"
#include "runtime/wire/machine/simulated.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace m2m_transfer::stability {
namespace {

using Answers = std::vector<std::vector<Answer>>;  // per case

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// `order`: where the points of `b` are in `a`; empty: in the same place.
bool same(const Answer& a, const Answer& b, const std::vector<std::size_t>& order) {
  for (std::size_t v = 0; v < b.values.size(); ++v) {
    const std::size_t at = order.empty() ? v : order[v];
    if (!same_bits(a.values[at], b.values[v]) || a.status[at] != b.status[v]) return false;
  }
  return true;
}

/// A point well inside a tetrahedron is lost if it is found nowhere.
bool is_held(const TetMesh& mesh, const Point& point) {
  for (std::size_t t = 0; t < mesh.n_tets(); ++t) {
    bool near = true;
    for (std::size_t axis = 0; axis < 3 && near; ++axis) {
      const auto x = [&](std::size_t k) {
        return mesh.points[static_cast<std::size_t>(mesh.tets[t][k])][axis];
      };
      near = point[axis] >= std::min({x(0), x(1), x(2), x(3)}) &&
             point[axis] <= std::max({x(0), x(1), x(2), x(3)});
    }
    if (near && holds(mesh, t, point, 1e-9)) return true;
  }
  return false;
}

/// The value is the number of a tetrahedron that holds the point.
bool names_a_donor(const Case& c, std::size_t v, double value) {
  if (!(value > -0.5) || !(value < static_cast<double>(c.source.n_tets()) - 0.5)) return false;
  return std::abs(value - std::round(value)) < 1e-6 &&
         holds(c.source, static_cast<std::size_t>(std::llround(value)), c.target.points[v], -1e-9);
}

/// Of a target that started with zeros.
bool has_wrong_value_outside(const OutsidePolicy& policy, double value) {
  if (std::holds_alternative<Nearest>(policy)) return false;
  const auto* const given = std::get_if<UseValue>(&policy);
  return !same_bits(value, given != nullptr ? given->value : 0.0);
}

/// A run of all cases for each number of parts. Cases that are refused have no answer.
Task run_parts(const std::vector<Case>& cases, const std::vector<std::int32_t>& parts,
               const Ways& ways, kit::Progress& progress, Answers& answers) {
  for (const std::int32_t n_parts : parts) {
    progress.phase(n_parts == 1 ? "one part" : "several parts");
    for (std::size_t k = 0; k < cases.size(); ++k) {
      progress.part(k + 1, cases.size());
      if (refusal(cases[k]).empty())
        answers[k].push_back(co_await answer_of(cases[k], n_parts, ways));
    }
  }
}

}  // namespace

TaskOf<Answer> answer_of(const Case& c, std::int32_t n_parts, const Ways& ways) {
  const std::vector<Field> source_fields{{"f", 1, c.values}};
  const std::vector<Field> target_fields{{"f", 1, std::vector<double>(c.target.n_points(), 0.0)}};
  std::vector<DistributedMesh> meshes;
  co_await epoch([&] {
    meshes.push_back(scatter(c.source, source_fields, n_parts, ways.partition));
    meshes.push_back(scatter(c.target, target_fields, n_parts, ways.partition));
  });
  const TransferOptions options{.policy = ways.policy};
  Transfer transfer(meshes[0], meshes[1], options);
  co_await transfer.search();
  co_await transfer.apply();
  Gathered result = co_await gather(meshes[1], c.target.n_points());
  Answer answer;
  answer.status = std::move(result.status);
  answer.values = std::move(result.values.front());
  co_await epoch([&] { transfer.destroy(); });
  co_await destroy(meshes);
  co_return answer;
}

std::string refusal(const Case& c) {
  try {
    (void)validate(c.source);
    if (c.target.name != "points") (void)validate(c.target);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

Row judge(const Case& c, const std::vector<Answer>& answers, const Answer* before,
          const OutsidePolicy& policy) {
  Row row;
  row.name = c.name;
  row.parameter = c.parameter;
  row.value = c.value;
  row.tolerance = c.tolerance;
  row.n_points = c.target.n_points();
  row.n_runs = answers.size();
  row.note = refusal(c);
  if (!row.note.empty()) {
    row.ok = c.may_be_refused;
    return row;
  }
  const Answer& first = answers.front();
  double error = 0;
  for (std::size_t v = 0; v < row.n_points; ++v) {
    row.snapped += first.status[v] == Status::snapped ? 1U : 0U;
    if (first.status[v] == Status::outside) {
      ++row.outside;
      if (has_wrong_value_outside(policy, first.values[v]))
        error = std::numeric_limits<double>::infinity();
      row.lost += is_held(c.source, c.target.points[v]) ? 1U : 0U;
    } else if (c.truth.empty()) {
      row.lost += names_a_donor(c, v, first.values[v]) ? 0U : 1U;
    } else if (!std::isnan(c.truth[v])) {
      const double now = std::abs(first.values[v] - c.truth[v]);
      error = std::isnan(now) ? std::numeric_limits<double>::infinity() : std::max(error, now);
    }
  }
  if (c.outside && row.outside > *c.outside)
    row.lost = std::max(row.lost, row.outside - *c.outside);
  for (const Answer& answer : answers) row.same_bits = row.same_bits && same(first, answer, {});
  if (before != nullptr && !c.order.empty())
    row.same_bits = row.same_bits && same(*before, first, c.order);
  row.met = error;
  row.ok = row.lost == 0 && row.same_bits && error <= c.tolerance &&
           (!c.outside || row.outside == *c.outside);
  return row;
}

std::vector<Row> run_cases(Setup& setup, const std::vector<Case>& cases, const Ways& ways,
                           kit::Progress& progress) {
  Answers answers(cases.size());
  // Named: the coroutines refer to them.
  const std::vector<std::int32_t> parts{1, 6, 16}, several{6, 16};
  int code = tess::run(setup, [&] { return run_parts(cases, parts, ways, progress, answers); });
  if (setup.machine->n_processes() == 1)
    for (const char* keys : {"pes=6,seed=2", "pes=16,per-process=1,seed=3"}) {
      Setup other{make_simulated_machine(parse_simulated(keys)), {}};
      code += tess::run(other, [&] { return run_parts(cases, several, ways, progress, answers); });
    }
  if (code != 0) fail(ErrorCode::environment, "--stability: a run ended with an error");
  std::vector<Row> rows;
  if (setup.machine->process().value != 0) return rows;
  progress.phase("judging");
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const bool has_before = k > 0 && !answers[k - 1].empty();
    rows.push_back(
        judge(cases[k], answers[k], has_before ? &answers[k - 1].front() : nullptr, ways.policy));
  }
  return rows;
}

}  // namespace m2m_transfer::stability
