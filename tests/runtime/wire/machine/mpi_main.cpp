// One program, many ranks: every rank runs the same cases, and a failure on any rank fails the case
// on all of them. Ranks but the first write to rank-<n>.log beside the test.
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>
#include <mpi.h>

#include <iostream>
#include <string>
#include <vector>

namespace {

int rank_of_world() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

struct AgreeOnFailure : Catch::TestEventListenerBase {
  using TestEventListenerBase::TestEventListenerBase;

  void testCaseEnded(const Catch::TestCaseStats& stats) override {
    int n_ranks = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
    const int mine = stats.totals.assertions.failed > 0 ? 1 : 0;
    std::vector<int> failed(static_cast<std::size_t>(n_ranks));
    MPI_Allgather(&mine, 1, MPI_INT, failed.data(), 1, MPI_INT, MPI_COMM_WORLD);
    for (std::size_t r = 0; r < failed.size(); ++r) {
      if (failed[r] == 0) continue;
      ++n_failures;
      if (rank_of_world() == 0)
        std::cerr << "failed on rank " << r << " (rank-" << r << ".log): " << stats.testInfo.name
                  << '\n';
    }
  }

  static inline int n_failures = 0;
};
CATCH_REGISTER_LISTENER(AgreeOnFailure)

}  // namespace

int main(int argc, char** argv) {
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
  const std::string log = "rank-" + std::to_string(rank_of_world()) + ".log";
  std::vector<const char*> arguments(argv, argv + argc);
  if (rank_of_world() != 0) {
    arguments.push_back("-o");
    arguments.push_back(log.c_str());
  }
  const int result = Catch::Session().run(static_cast<int>(arguments.size()), arguments.data());
  MPI_Finalize();
  return result != 0 || AgreeOnFailure::n_failures != 0 ? 1 : 0;
}
