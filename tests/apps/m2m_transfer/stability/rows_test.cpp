#include "apps/m2m_transfer/stability/rows.hpp"

#include "m2m/kuhn.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"

#include <limits>

using namespace tess;
using namespace m2m_transfer;
using namespace m2m_transfer::stability;

namespace {

std::vector<Row> rows_of(const std::vector<Case>& cases, const Ways& ways = {}) {
  Setup setup{make_threads_machine(2), {}};
  kit::Progress progress(nullptr);
  return run_cases(setup, cases, ways, progress);
}

}  // namespace

TEST_CASE("no extreme mesh loses a point, and all machines give the same bits",
          "[apps][stability]") {
  for (const Row& row : rows_of(generated_cases(2000))) {
    INFO(row.name << ": " << row.note);
    CHECK(row.ok);
    CHECK(row.n_runs == (row.note.empty() ? 7 : 0));
  }
}

TEST_CASE("the stability report of a user's mesh has rows for it", "[apps][stability]") {
  const TetMesh mesh = kuhn_mesh({4, 0.2});
  const std::vector<Row> rows = rows_of(cases_of(mesh, 400));
  CHECK(rows.size() == 11);
  for (const Row& row : rows) {
    INFO(row.name << ": " << row.note);
    CHECK(row.ok);
    CHECK(row.note.empty());
    CHECK(row.name.starts_with("kuhn:4@0.2 "));
  }
}

TEST_CASE("the policy and the partition hold for every case", "[apps][stability]") {
  const std::vector<Case> cases = cases_of(kuhn_mesh({3, 0.2}), 100);
  for (const Row& row : rows_of(cases, {PartitionMethod::curve, UseValue{7}})) {
    INFO(row.name << ": " << row.note);
    CHECK(row.ok);
  }
  Case apart = case_between(kuhn_mesh({2}), kuhn_mesh({3}));
  for (Point& p : apart.target.points) p[0] += 9;
  CHECK(rows_of({apart}, {PartitionMethod::rcb, UseValue{7}}).front().ok);
  CHECK(rows_of({apart}, {PartitionMethod::hsfc, Nearest{}}).front().ok);
  CHECK(rows_of({apart}).front().ok);
}

TEST_CASE("a user's mesh may have unused vertices, and several at one place", "[apps][stability]") {
  TetMesh unused = kuhn_mesh({3});
  unused.points.insert(unused.points.end(), {{9, 9, 9}, {0.5, 0.5, 0.5}});
  const TetMesh apart = exploded(kuhn_mesh({2}));
  for (const TetMesh& mesh : {unused, apart})
    for (const Row& row : rows_of(cases_of(mesh, 100))) {
      INFO(row.name << ": " << row.note);
      CHECK(row.ok);
    }
}

TEST_CASE("a row fails if a point is lost, an error is large, or bits differ",
          "[apps][stability]") {
  Case c = cases_of(kuhn_mesh({2}), 40).front();
  const std::vector<Status> inside(c.target.n_points(), Status::boundary);
  const std::vector<Answer> right(2, Answer{inside, c.values});
  CHECK(judge(c, right, nullptr).ok);
  std::vector<Answer> lost = right;
  for (Answer& answer : lost) answer.status[3] = Status::outside;
  CHECK(judge(c, lost, nullptr).lost == 1);
  CHECK_FALSE(judge(c, lost, nullptr).ok);
  std::vector<Answer> wrong = right;
  for (Answer& answer : wrong) answer.values[3] += 1e-15;
  CHECK_FALSE(judge(c, wrong, nullptr).ok);
  std::vector<Answer> nothing = right;
  for (Answer& answer : nothing) answer.values[3] = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(judge(c, nothing, nullptr).ok);
  std::vector<Answer> other = right;
  other[1].status[0] = Status::inside;
  CHECK_FALSE(judge(c, other, nullptr).same_bits);
  c.truth.clear();  // the values name donors
  CHECK(judge(c, right, nullptr).lost > 0);
  // A value outside is that of the policy.
  Case apart = c;
  apart.outside = apart.target.n_points();
  for (Point& p : apart.target.points) p[0] += 9;
  const Answer outside{std::vector(inside.size(), Status::outside),
                       std::vector<double>(inside.size(), 7)};
  CHECK_FALSE(judge(apart, {outside}, nullptr).ok);
  CHECK(judge(apart, {outside}, nullptr, UseValue{7}).ok);
  // A mesh that is refused fails, unless that is expected.
  c.source.points[0][0] = 1e200;
  CHECK_FALSE(judge(c, {}, nullptr).ok);
  c.may_be_refused = true;
  CHECK(judge(c, {}, nullptr).ok);
}
