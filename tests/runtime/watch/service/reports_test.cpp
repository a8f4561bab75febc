// What the processes of a job report of what waits, each once.
#include "runtime/watch/service/job_report.hpp"
#include "runtime/watch/service/process_census.hpp"
#include "tests/support/catch.hpp"

using tess::PeId;
using tess::ProcessId;
using tess::detail::JobReport;
using tess::detail::ProcessCensus;
using tess::detail::ProcessReport;

namespace {

ProcessReport report_of(std::int32_t process, bool active = false) {
  ProcessReport report;
  report.process = ProcessId{process};
  report.active = active;
  return report;
}

}  // namespace

TEST_CASE("the report of a job is complete once each process has reported, twice or not",
          "[runtime][service]") {
  JobReport job(7, 3);
  CHECK(job.round() == 7);
  for (const std::int32_t process : {2, 0, 2, 0, 2}) {
    CHECK_FALSE(job.complete());
    job.take(report_of(process));
  }
  CHECK_FALSE(job.complete());
  job.take(report_of(1));
  CHECK(job.complete());
}

TEST_CASE("a job is active if any of its processes is", "[runtime][service]") {
  for (const std::int32_t active : {-1, 0, 1, 2}) {
    JobReport job(1, 3);
    for (const std::int32_t process : {0, 1, 2}) job.take(report_of(process, process == active));
    CHECK(job.active() == (active >= 0));
  }
}

TEST_CASE("the census of a process is complete at the last answer of a PE, once",
          "[runtime][service]") {
  ProcessCensus census(0, 1, 0, PeId{6}, 3);
  CHECK_FALSE(census.take(PeId{8}, {}, {}));
  CHECK_FALSE(census.take(PeId{6}, {}, {}));
  CHECK_FALSE(census.take(PeId{8}, {}, {}));
  CHECK(census.take(PeId{7}, {}, {}));
  CHECK_FALSE(census.take(PeId{7}, {}, {}));
}
