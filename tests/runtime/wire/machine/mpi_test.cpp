#include "runtime/wire/machine/mpi.hpp"

#include "runtime/core/error.hpp"
#include "tests/runtime/wire/machine/mock_program.hpp"
#include "tests/support/catch.hpp"

#include <mpi.h>

namespace tess::detail {
namespace {

std::unique_ptr<Machine> make(MpiOptions options) {
  int argc = 0;
  char** argv = nullptr;
  return make_mpi_machine(argc, argv, options);
}

/// Over all processes.
std::int64_t sum(std::int64_t mine) {
  std::int64_t all = 0;
  MPI_Allreduce(&mine, &all, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
  return all;
}

TEST_CASE("mpirun is known by its environment", "[runtime][machine][mpi]") {
  CHECK(under_mpirun());  // ctest starts one rank by mpirun, too
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  CHECK(speaks_for_job() == (rank == 0));
}

TEST_CASE("every token makes its tour over processes", "[runtime][machine][mpi]") {
  const std::int32_t pes = GENERATE(1, 2);
  const auto machine = make({.pes_per_process = pes});
  CAPTURE(machine->describe());
  test::Tour tour(*machine, {.n_tokens = 20, .n_hops = 200});
  machine->run(tour);
  if (machine->process().value == 0) CHECK(tour.n_ended == 20 * machine->n_pes());
  CHECK(sum(tour.n_hops_made()) == std::int64_t{20} * 200 * machine->n_pes());
  CHECK(tour.n_misplaced == 0);
}

TEST_CASE("buffers at the edges of the protocols arrive intact", "[runtime][machine][mpi]") {
  // Open MPI sends eagerly up to 4096 bytes with header in shared memory; the chunk here is small.
  constexpr std::size_t limit = 10'000;
  constexpr std::size_t stamp = sizeof(test::Stamp);
  const auto machine = make({.pes_per_process = 1, .chunk_bytes = limit});
  test::Tour tour(*machine, {.n_tokens = 10,
                             .n_hops = 100,
                             .filling_bytes = {0, 1, 4095 - stamp, 4096 - stamp, 4097 - stamp,
                                               limit - stamp - 1, limit - stamp, limit - stamp + 1,
                                               2 * limit - stamp, 5 * limit + 17}});
  machine->run(tour);
  CHECK(sum(tour.n_hops_made()) == std::int64_t{10} * 100 * machine->n_pes());
  CHECK(tour.n_broken == 0);
  CHECK(tour.n_misplaced == 0);
}

TEST_CASE("large buffers from several PEs at once do not mix", "[runtime][machine][mpi]") {
  const auto machine = make({.pes_per_process = 2, .chunk_bytes = 4096});
  test::Tour tour(*machine, {.n_tokens = 8, .n_hops = 20, .filling_bytes = {100'000, 50, 300'000}});
  machine->run(tour);
  CHECK(sum(tour.n_hops_made()) == std::int64_t{8} * 20 * machine->n_pes());
  CHECK(tour.n_broken == 0);
}

TEST_CASE("processes stop in the middle of a flood", "[runtime][machine][mpi]") {
  const std::int32_t pes = GENERATE(1, 2);
  const auto machine = make({.pes_per_process = pes, .chunk_bytes = 4096});
  test::Tour tour(
      *machine,
      {.n_tokens = 50, .n_hops = 1000, .filling_bytes = {0, 100, 20'000}, .stop_early = true});
  machine->run(tour);
  CHECK(tour.n_broken == 0);
  CHECK(sum(tour.n_hops_made()) < std::int64_t{50} * 1000 * machine->n_pes());
}

/// Sends one buffer of no bytes from each process to each other, then ends.
class Nothing final : public Program {
 public:
  explicit Nothing(Machine& machine) : machine_(machine) {}
  void start(PeId pe) override {
    for (std::int32_t p = 0; p < machine_.n_processes(); ++p)
      if (p != machine_.process().value) machine_.send(pe, ProcessId{p}, Buffer());
  }
  void accept(PeId, Link*) override {}
  std::size_t step(PeId, std::size_t) override {
    if (n_received + 1 == machine_.n_processes()) machine_.stop();
    return 0;
  }
  bool idle(PeId) override { return false; }
  void receive(PeId, std::span<const std::byte> bytes) override {
    if (bytes.empty()) ++n_received;
  }
  void finish(PeId) override {}

  std::int32_t n_received = 0;

 private:
  Machine& machine_;
};

TEST_CASE("a buffer of no bytes arrives", "[runtime][machine][mpi]") {
  const auto machine = make({});
  Nothing nothing(*machine);
  machine->run(nothing);
  CHECK(nothing.n_received + 1 == machine->n_processes());
}

/// Process 0 sends one buffer of more than MPI can count to the last process, which checks each
/// byte and ends the run.
class Giant final : public Program {
 public:
  static constexpr std::size_t n_bytes = (std::size_t{1} << 31) + 12'345;

  explicit Giant(Machine& machine) : machine_(machine) {}
  void start(PeId pe) override {
    if (machine_.process().value != 0) return;
    Buffer bytes(n_bytes);
    for (std::size_t i = 0; i < n_bytes; ++i) bytes[i] = fill(i);
    machine_.send(pe, ProcessId{machine_.n_processes() - 1}, std::move(bytes));
  }
  void accept(PeId, Link*) override {}
  std::size_t step(PeId, std::size_t) override { return 0; }
  bool idle(PeId) override { return false; }
  void receive(PeId pe, std::span<const std::byte> bytes) override {
    if (bytes.size() == n_bytes) {
      for (std::size_t i = 0; i < n_bytes; ++i) n_wrong += bytes[i] != fill(i) ? 1 : 0;
      for (std::int32_t p = 0; p + 1 < machine_.n_processes(); ++p)
        machine_.send(pe, ProcessId{p}, Buffer());
      n_received = 1;
    }
    machine_.stop();
  }
  void finish(PeId) override {}

  std::int64_t n_wrong = 0;
  std::int64_t n_received = 0;

 private:
  static std::byte fill(std::size_t i) {
    return static_cast<std::byte>(mix_of(i / 4096) >> (i % 56));
  }
  static std::uint64_t mix_of(std::uint64_t x) { return (x + 1) * 0x9e3779b97f4a7c15U; }
  Machine& machine_;
};

// By hand, on two processes: it takes 4 GiB, and seconds.
TEST_CASE("a buffer above 2 GiB arrives whole in chunks of 1 GiB", "[.][soak]") {
  const auto machine = make({});
  REQUIRE(machine->n_processes() > 1);
  Giant giant(*machine);
  machine->run(giant);
  CHECK(sum(giant.n_received) == 1);
  CHECK(sum(giant.n_wrong) == 0);
}

TEST_CASE("processes agree on what is the same everywhere", "[runtime][machine][mpi]") {
  const auto machine = make({});
  CHECK(machine->agree(0x123456789abcdefU));
  CHECK(machine->agree(0));
  CHECK(machine->agree(~std::uint64_t{0}));
  if (machine->n_processes() > 1)
    CHECK_FALSE(machine->agree(static_cast<std::uint64_t>(machine->process().value)));
}

TEST_CASE("processes must have the same number of PEs, and one process may have any",
          "[runtime][machine][mpi]") {
  int rank = 0;
  int n = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &n);
  if (n > 1)
    CHECK_THROWS_AS(make({.pes_per_process = 1 + rank % 2}), Error);
  else
    CHECK(make({.pes_per_process = 3})->n_pes() == 3);
}

/// Never stops by itself; the last process aborts the job.
class Aborts final : public Program {
 public:
  explicit Aborts(Machine& machine) : machine_(machine) {}
  void start(PeId) override {}
  void accept(PeId, Link*) override {}
  std::size_t step(PeId, std::size_t) override {
    if (machine_.process().value + 1 == machine_.n_processes()) machine_.abort(7);
    return 0;
  }
  bool idle(PeId) override { return false; }
  void receive(PeId, std::span<const std::byte>) override {}
  void finish(PeId) override {}

 private:
  Machine& machine_;
};

// Hidden: it ends the job. ctest runs it alone and expects exit code 7.
TEST_CASE("one process ends the job with its exit code", "[.][abort]") {
  const auto machine = make({.pes_per_process = 2});
  Aborts aborts(*machine);
  machine->run(aborts);
}

TEST_CASE("a chunk that MPI cannot count is refused", "[runtime][machine][mpi]") {
  CHECK_THROWS_AS(make({.chunk_bytes = std::size_t{1} << 31}), Error);
  CHECK_THROWS_AS(make({.chunk_bytes = 0}), Error);
  CHECK_THROWS_AS(make({.pes_per_process = -2}), Error);
}

}  // namespace
}  // namespace tess::detail
