// What the PEs of a process, and the processes of a job, answer of what waits, each once.
#include "runtime/watch/service/wait_round.hpp"
#include "tests/support/catch.hpp"

using tess::PeId;
using tess::detail::WaitAnswer;
using tess::detail::WaitRound;

namespace {

WaitAnswer answer_of(bool active = false) {
  WaitAnswer answer;
  answer.active = active;
  return answer;
}
WaitAnswer sum_of(WaitRound& round) {
  return round.end(
      [](std::size_t i, WaitAnswer& sum) { sum.silent.push_back(PeId{static_cast<int>(i)}); });
}

}  // namespace

TEST_CASE("the report of a job is complete once each process has reported, twice or not",
          "[runtime][service]") {
  WaitRound job(7, 3);
  CHECK(job.number() == 7);
  for (const std::size_t process : {2U, 0U, 2U, 0U, 2U}) {
    CHECK_FALSE(job.complete());
    CHECK_FALSE(job.take(process, answer_of()));
  }
  CHECK_FALSE(job.complete());
  CHECK(job.take(1, answer_of()));
  CHECK(job.complete());
}

TEST_CASE("a job is active if any of its processes is", "[runtime][service]") {
  for (const int active : {-1, 0, 1, 2}) {
    WaitRound job(1, 3);
    for (const int process : {0, 1, 2})
      (void)job.take(static_cast<std::size_t>(process), answer_of(process == active));
    CHECK(sum_of(job).active == (active >= 0));
  }
}

TEST_CASE("the census of a process is complete at the last answer of a PE, once",
          "[runtime][service]") {
  WaitRound census(1, 3);
  CHECK_FALSE(census.take(2, answer_of()));
  CHECK_FALSE(census.take(0, answer_of()));
  CHECK_FALSE(census.take(2, answer_of()));
  CHECK(census.take(1, answer_of()));
  CHECK_FALSE(census.take(1, answer_of()));
  CHECK(sum_of(census).silent.empty());
}

TEST_CASE("a round that ends early names those that have not answered", "[runtime][service]") {
  WaitRound round(1, 3);
  for (const std::size_t i : {1U, 1U}) {
    WaitAnswer answer;
    answer.waits.add(tess::detail::WaitRank::queue, "a queue");
    (void)round.take(i, std::move(answer));
  }
  CHECK_FALSE(round.ended());
  const WaitAnswer sum = sum_of(round);
  CHECK(round.ended());
  CHECK(sum.waits.size() == 1);
  CHECK(sum.silent == std::vector<PeId>{PeId{0}, PeId{2}});
}
