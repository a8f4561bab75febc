// A program that owns MPI and uses Tessera for two of its phases. Its own messages and those of the
// runs do not meet: a run uses a communicator of its own. Each process draws some numbers; the
// program adds them up with MPI_Allreduce, and a run adds them up with a reduction of chares.
//
//     mpirun -n 2 embedded --pes 2
#include "runtime/runtime.hpp"
#include "runtime/version.hpp"

#include <mpi.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace {

/// One per PE: contributes the number of its process, once per process.
class Share : public tess::Group<Share> {
 public:
  void give(tess::Callback<std::int64_t> target);
};

std::int64_t my_number = 0;  // of this process

void Share::give(tess::Callback<std::int64_t> target) {
  contribute(tess::sum, tess::machine().is_first_of_process(pe()) ? my_number : 0,
             std::move(target));
}

std::int64_t total;  // on process 0: what the run has found

tess::Task add_up() {
  const auto shares = tess::create<Share>(tess::each_pe);
  total = co_await shares.reduce<&Share::give>();
}

/// The program's own messages: to the next process, from any.
struct Ring {
  int rank = 0, n = 1;
  int sent = 0, received = -1;
  std::array<MPI_Request, 2> requests{};

  void begin(int value) {
    sent = value + rank;
    received = -1;
    MPI_Irecv(&received, 1, MPI_INT, MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &requests[0]);
  }
  /// True if the neighbour's message has arrived, and nothing else.
  bool end(int value) {
    MPI_Isend(&sent, 1, MPI_INT, (rank + 1) % n, 7, MPI_COMM_WORLD, &requests[1]);
    MPI_Waitall(2, requests.data(), MPI_STATUSES_IGNORE);
    return received == value + (rank + n - 1) % n;
  }
};

int phases(int argc, char** argv, const Ring& of_all) {
  Ring ring = of_all;
  const std::array<const std::string_view, 2> names{"first", "second"};
  int n_wrong = 0;
  for (int phase = 0; phase < 2; ++phase) {
    my_number = 10 * (phase + 1) + ring.rank;
    std::int64_t expected = 0;
    MPI_Allreduce(&my_number, &expected, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
    ring.begin(phase);  // a receive is pending while the run communicates

    std::vector<char*> arguments(argv, argv + argc);
    arguments.push_back(nullptr);
    const int own = tess::run(argc, arguments.data(), [] { return add_up(); });

    const bool ring_is_right = ring.end(phase);
    int code = 0;  // of all processes: that standard output is lost is known to one
    MPI_Allreduce(&own, &code, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    if (code != 0) return code;  // the run has said why
    const bool is_right = ring_is_right && (ring.rank != 0 || total == expected);
    if (!is_right) ++n_wrong;
    if (ring.rank == 0)
      tess::print(names[static_cast<std::size_t>(phase)], " run: the numbers of ", ring.n,
                  " processes add up to ", total, ", as MPI_Allreduce says: ", expected, "\n");
  }
  int all_wrong = 0;
  MPI_Allreduce(&n_wrong, &all_wrong, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
  return all_wrong == 0 ? 0 : 1;
}

/// The thread level that `--level` names; -1 for another word.
int level_of(std::string_view word) {
  if (word == "single") return MPI_THREAD_SINGLE;
  return word == "funneled" ? MPI_THREAD_FUNNELED : -1;
}

bool is_question(std::string_view option) {
  return option == "--help" || option == "-h" || option == "--version";
}

}  // namespace

/// `--level single` and `--level funneled` show what a run says of a level that is too low.
int main(int argc, char** argv) {
  char** const question = std::find_if(argv + 1, argv + argc, is_question);
  const bool is_asked = question != argv + argc;
  const bool asks_for_version = is_asked && std::string_view(*question) == "--version";
  int level = MPI_THREAD_SERIALIZED;
  std::string word;
  char** const end = argv + argc;
  char** const option = std::find(argv + 1, end, std::string_view("--level"));
  if (option != end) {
    char** const value = option + 1;
    if (value != end) word = *value;
    level = level_of(word);
    char** const rest = value != end ? value + 1 : end;
    std::copy(rest, end + 1, option);  // with the null pointer behind them
    argc -= static_cast<int>(rest - option);
  }
  int provided = 0;
  MPI_Init_thread(&argc, &argv, std::max(level, int{MPI_THREAD_SINGLE}), &provided);
  Ring ring;
  MPI_Comm_rank(MPI_COMM_WORLD, &ring.rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ring.n);
  int code = 0;
  if (is_asked) {
    if (ring.rank == 0)
      tess::print(asks_for_version ? tess::version_text("embedded")
                                   : "usage: embedded [--level single|funneled] [options]\n" +
                                         tess::options_help());
  } else if (level < 0) {
    if (ring.rank == 0)
      std::fprintf(stderr, "embedded: error: --level '%s': give single or funneled\n",
                   word.c_str());
    code = 2;
  } else if (level < MPI_THREAD_SERIALIZED) {
    code = tess::run(argc, argv, [] { return add_up(); });
  } else {
    code = phases(argc, argv, ring);
  }
  MPI_Finalize();
  return code;
}
