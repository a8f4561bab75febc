// The costs of a machine without the runtime; each figure is checked and printed with median and
// spread over repetitions:
//
//     bench_machine               pool, one way between two PEs of a process, small posts
//     mpirun -n 2 bench_machine   one way between two ranks, and plain MPI in the same run
#include "apps/kit/median.hpp"
#include "runtime/base/pool.hpp"
#include "runtime/command_line.hpp"
#include "runtime/core/check.hpp"
#include "runtime/wire/machine/mpi.hpp"
#include "runtime/wire/machine/threads.hpp"

#include <mpi.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/core.h>
#include <vector>

namespace tess::detail {
namespace {

using Clock = std::chrono::steady_clock;

double nanoseconds(Clock::duration span) {
  return std::chrono::duration<double, std::nano>(span).count();
}

void report(const char* what, const std::vector<double>& ns) {
  const auto [least, greatest] = std::minmax_element(ns.begin(), ns.end());
  fmt::print("{:<48} {:9.1f} ns   ({:.1f} to {:.1f}, {} runs)\n", what, kit::median(ns), *least,
             *greatest, ns.size());
}

constexpr int n_runs = 9;

/// One message of 8 bytes goes to and fro between PE 0 and the first PE of the last process, or the
/// last PE if there is one process.
class PingPong final : public Program {
 public:
  PingPong(Machine& machine, std::uint64_t n_rounds)
      : machine_(machine),
        n_rounds_(n_rounds),
        far_(machine.n_processes() > 1 ? machine.first_pe(ProcessId{machine.n_processes() - 1})
                                       : PeId{machine.n_pes() - 1}) {}

  void start(PeId pe) override {
    if (pe.value != 0) return;
    start_ = Clock::now();
    hand_on(pe, far_, 1);
  }
  void accept(PeId pe, Link* first) override { arrived(pe, static_cast<Ball*>(first)->number); }
  std::size_t step(PeId, std::size_t) override { return 0; }
  bool idle(PeId) override { return false; }
  void receive(PeId pe, std::span<const std::byte> bytes) override {
    std::uint64_t number = 0;
    TESS_CHECK(bytes.size() == sizeof(number), "8 bytes were sent, ", bytes.size(), " came");
    std::memcpy(&number, bytes.data(), sizeof(number));
    if (number == 0)
      machine_.stop();
    else
      arrived(pe, number);
  }
  void finish(PeId) override {}

  /// A hop, one way; on process 0.
  [[nodiscard]] double hop_ns() const {
    return nanoseconds(end_ - start_) / static_cast<double>(2 * n_rounds_);
  }

 private:
  struct Ball : Link {
    std::uint64_t number = 0;
  };

  void arrived(PeId pe, std::uint64_t number) {
    TESS_CHECK(number == ++expected_[pe.value == 0 ? 0 : 1].n * 2 - (pe.value == 0 ? 0 : 1), "hop ",
               number, " came out of turn");
    if (number < 2 * n_rounds_) return hand_on(pe, pe.value == 0 ? far_ : PeId{0}, number + 1);
    end_ = Clock::now();
    if (machine_.n_processes() > 1) send(pe, far_, 0);
    machine_.stop();
  }
  void hand_on(PeId pe, PeId to, std::uint64_t number) {
    if (!machine_.same_process(pe, to)) return send(pe, to, number);
    ball_.number = number;
    machine_.post(pe, to, &ball_, sizeof(number), Traffic::user);
  }
  void send(PeId pe, PeId to, std::uint64_t number) {
    Buffer bytes(sizeof(number));
    std::memcpy(bytes.data(), &number, sizeof(number));
    machine_.send(pe, machine_.process_of(to), std::move(bytes));
  }

  Machine& machine_;
  std::uint64_t n_rounds_;
  PeId far_;
  alignas(64) Ball ball_;
  struct alignas(64) Counter {
    std::uint64_t n = 0;
  };
  std::array<Counter, 2> expected_{};
  Clock::time_point start_, end_;
};

/// PE 0 posts pooled blocks to PE 1 without waiting, PE 1 frees them; at most 4096 under way.
class Flood final : public Program {
 public:
  Flood(Machine& machine, std::int64_t n) : machine_(machine), n_(n) {}

  void start(PeId) override { start_ = Clock::now(); }
  void accept(PeId pe, Link* first) override {
    while (first != nullptr) {
      Link* const next = first->next;
      Pool::release(first, &pools_[static_cast<std::size_t>(pe.value)]);
      ++n_received_;
      first = next;
    }
    n_seen_.store(n_received_, std::memory_order_relaxed);  // a window, nothing is handed over
    if (n_received_ == n_) {
      end_ = Clock::now();
      machine_.stop();
    }
  }
  std::size_t step(PeId pe, std::size_t most) override {
    if (pe.value != 0) return 0;
    std::size_t n = 0;
    const std::int64_t window = n_seen_.load(std::memory_order_relaxed) + 4096;
    for (; n < most && n_posted_ < std::min(n_, window); ++n, ++n_posted_)
      machine_.post(pe, PeId{1}, ::new (pools_[0].allocate(32)) Link, 32, Traffic::user);
    return n;
  }
  // The window opens without a message, so PE 0 must not sleep.
  bool idle(PeId pe) override { return pe.value == 0 && n_posted_ < n_; }
  void receive(PeId, std::span<const std::byte>) override {}
  void finish(PeId) override {}

  [[nodiscard]] double message_ns() const {
    return nanoseconds(end_ - start_) / static_cast<double>(n_);
  }

 private:
  Machine& machine_;
  std::int64_t n_;
  std::array<Pool, 2> pools_;
  std::int64_t n_posted_ = 0;
  alignas(64) std::int64_t n_received_ = 0;
  alignas(64) std::atomic<std::int64_t> n_seen_{0};
  Clock::time_point start_, end_;
};

void bench_pool() {
  constexpr std::size_t n = 1'000'000;
  std::vector<double> pairs, runs_of_100;
  Pool pool;
  std::array<void*, 100> blocks{};
  for (int run = 0; run < n_runs; ++run) {
    auto since = Clock::now();
    for (std::size_t i = 0; i < n; ++i) {
      void* volatile block = pool.allocate(40 + i % 128);
      Pool::release(block, &pool);
    }
    pairs.push_back(nanoseconds(Clock::now() - since) / n);
    since = Clock::now();
    for (std::size_t i = 0; i < n; i += blocks.size()) {
      for (void*& block : blocks) block = pool.allocate(64);
      for (void* block : blocks) Pool::release(block, &pool);
    }
    runs_of_100.push_back(nanoseconds(Clock::now() - since) / n);
  }
  report("pool: allocate and free, by turns", pairs);
  report("pool: allocate and free, 100 at a time", runs_of_100);
}

double plain_mpi_hop_ns(int rank, int far, int n_rounds) {
  std::uint64_t ball = 0;
  MPI_Barrier(MPI_COMM_WORLD);
  const auto start = Clock::now();
  for (int i = 0; i < n_rounds; ++i) {
    if (rank == 0) MPI_Send(&ball, 8, MPI_BYTE, far, 0, MPI_COMM_WORLD);
    if (rank == 0 || rank == far)
      MPI_Recv(&ball, 8, MPI_BYTE, rank == 0 ? far : 0, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    if (rank == far) MPI_Send(&ball, 8, MPI_BYTE, 0, 0, MPI_COMM_WORLD);
  }
  return nanoseconds(Clock::now() - start) / (2.0 * n_rounds);
}

void bench_processes(int argc, char** argv, int thread_level) {
  int provided = 0;
  MPI_Init_thread(&argc, &argv, thread_level, &provided);
  int rank = 0;
  int n = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &n);
  constexpr int n_rounds = 20'000;
  std::vector<double> plain, ours;
  std::string machine_line;
  for (int run = 0; n > 1 && run < n_runs; ++run) {
    plain.push_back(plain_mpi_hop_ns(rank, n - 1, n_rounds));
    const auto machine = make_mpi_machine(argc, argv, {});
    machine_line = machine->describe();
    PingPong game(*machine, n_rounds);
    machine->run(game);
    ours.push_back(game.hop_ns());
  }
  if (rank == 0 && n > 1) {
    fmt::print("{}, thread level {}\n", machine_line, provided);
    report("one way, 8 bytes, two ranks, plain MPI", plain);
    report("one way, 8 bytes, two ranks", ours);
  }
  MPI_Finalize();
}

void bench_threads() {
  bench_pool();
  std::vector<double> hops, posts;
  std::string machine_line;
  for (int run = 0; run < n_runs; ++run) {
    auto machine = make_threads_machine(2);
    machine_line = machine->describe();
    PingPong game(*machine, 100'000);
    machine->run(game);
    hops.push_back(game.hop_ns());
    machine = make_threads_machine(2);
    Flood flood(*machine, 1'000'000);
    machine->run(flood);
    posts.push_back(flood.message_ns());
  }
  fmt::print("{}\n", machine_line);
  report("one way, 8 bytes, two PEs", hops);
  report("post, pooled 32 bytes, PE 0 to PE 1", posts);
}

}  // namespace
}  // namespace tess::detail

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] {
    bool multiple = false;
    tess::CommandLine line(
        "The costs of a machine without the runtime; under mpirun of two ranks.");
    line.flag("--multiple", multiple, "ask MPI for all threads");
    if (!line.parse(argc, argv, {})) return 0;
    if (tess::under_mpirun())
      tess::detail::bench_processes(argc, argv,
                                    multiple ? MPI_THREAD_MULTIPLE : MPI_THREAD_SERIALIZED);
    else
      tess::detail::bench_threads();
    return 0;
  });
}
