#include "runtime/wire/machine/mpi.hpp"

#include "runtime/base/program_name.hpp"
#include "runtime/core/error.hpp"
#include "runtime/wire/machine/mpi_transport.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#if defined(__GLIBC__)
#include <malloc.h>
#endif
#include <mutex>
#include <thread>

namespace tess::detail {
namespace {

/// Keeps the memory of freed large messages in the process, as glibc does by itself after the first
/// free of a block of 32 MiB. Otherwise each megabyte costs 256 page faults, which is more than the
/// transfer. Called before any thread is started.
void keep_freed_memory() {
#if defined(__GLIBC__)
  constexpr int largest_kept = 32 << 20;
  mallopt(M_MMAP_THRESHOLD, largest_kept);      // NOLINT(concurrency-mt-unsafe)
  mallopt(M_TRIM_THRESHOLD, 2 * largest_kept);  // NOLINT(concurrency-mt-unsafe)
#endif
}

constexpr std::int32_t most_pes = std::numeric_limits<std::int32_t>::max();

class MpiMachine final : public Machine, private Network {
 public:
  MpiMachine(int& argc, char**& argv, const MpiOptions& options) : session_(argc, argv) {
    keep_freed_memory();
    n_processes_ = session_.n_processes();
    process_ = ProcessId{session_.process()};
    const Session::Sharing shared = session_.sharing(topology_.cpuset());
    // All take part, whether they were given a number or not.
    const std::int32_t share = std::max(1, topology_.n_cores() / shared.n_processes),
                       given = options.pes_per_process,
                       least = session_.least(given != 0        ? given
                                              : options.refuses ? most_pes
                                                                : share);
    pes_per_process_ = given != 0 ? given : least;
    if (!agree(static_cast<std::uint64_t>(pes_per_process_)))
      fail(ErrorCode::bad_argument, "the processes were given different numbers of PEs, this one ",
           pes_per_process_, ": start them all with the same --pes");
    if (options.refuses) pes_per_process_ = 1;

    const bool enough = shared.n_processes * pes_per_process_ <= topology_.n_cores();
    placement_ = {.pinned = enough && options.pinning == Pinning::automatic,
                  .first_core = shared.place * pes_per_process_,
                  .oversubscribed = !enough};
    transport_ = std::make_unique<Transport>(session_.comm(), session_.chunk_comm(), n_processes_,
                                             options.chunk_bytes);
    for (std::int32_t i = 0; i < pes_per_process_; ++i) mail_.push_back(transport_->new_mail());
    team_ = std::make_unique<Team>(first_pe(process_), pes_per_process_, placement_,
                                   static_cast<Network*>(this));
    // The clocks start at the same time. And the communicators were used by an earlier run: no
    // process sends before all have ended the receives of that run.
    must(MPI_Barrier(session_.comm()), "MPI_Barrier");
    start_ = std::chrono::steady_clock::now();
  }

  void post(PeId, PeId to, Link* message, std::size_t, Traffic) override {
    team_->post(to, message);
  }
  void hand_in(PeId to, Link* message) override { team_->post(to, message); }
  [[nodiscard]] bool takes_bundles() const override { return pes_per_process_ > 1; }
  void post_bundle(PeId to, Bundle* bundle) override { team_->post(to, bundle); }
  void send(PeId, ProcessId to, Buffer&& bytes) override { transport_->send(to, bytes); }
  void send(PeId, ProcessId to, Parcel&& parcel) override {
    transport_->send(to, std::move(parcel));
  }
  void run(Program& program) override {
    try {
      team_->run(program, topology_);
    } catch (const Error& error) {
      if (n_processes_ == 1) throw;
      std::fprintf(stderr, "%s%s\n", error_heading().c_str(), error.what());
      abort(2);  // the other processes have begun, and would wait for this one
    }
    transport_->drain([&program](Link* message) { program.drop(message); });
  }
  void stop() override { team_->stop(); }

  [[noreturn]] void abort(int exit_code) override {
    // The lock is held for microseconds, unless its holder is the cause of the abort: then continue
    // without it.
    for (int i = 0; i < 1000 && !transport_->lock.try_lock(); ++i)
      std::this_thread::sleep_for(std::chrono::microseconds(10));
    MPI_Abort(MPI_COMM_WORLD, exit_code);
    std::_Exit(exit_code);
  }

  void hurry(int exit_code) override { session_.hurry(exit_code); }
  bool agree(std::uint64_t mine) override { return session_.agree(mine); }
  Time now(PeId) const override { return std::chrono::steady_clock::now() - start_; }

  std::string describe() const override {
    return text("mpi: ", n_processes_, n_processes_ == 1 ? " process, " : " processes, ",
                pes_per_process_, pes_per_process_ == 1 ? " PE each; " : " PEs each; ", process_,
                placement_.describe(topology_));
  }

 private:
  bool progress(Program& program, PeId pe) override {
    Mail& mail = mail_[static_cast<std::size_t>(pe.value % pes_per_process_)];
    {
      const std::unique_lock held(transport_->lock, std::try_to_lock);
      if (!held) return false;
      transport_->push_out(mail);
      transport_->take_in(mail);
    }  // before the program unpacks, so that others may continue
    const bool any = mail.size() != 0;
    for (const auto bytes : mail.items()) program.receive(pe, bytes);
    for (auto& in : mail.large) take(program, pe, std::move(in));
    mail.clear();
    return any;
  }
  void take(Program& program, PeId pe, std::unique_ptr<Incoming> in) {
    const std::span<const std::byte> bytes(in->bytes.data(), in->bytes.size());
    if (in->message != nullptr) {
      program.placed(pe, in->message);
    } else if (in->sizes.empty()) {
      program.receive(pe, bytes);
    } else {
      in->message = program.place(pe, bytes, in->sizes, in->places);
      transport_->expect(std::move(in));
    }
  }

  Topology topology_;  // before MPI, which starts threads of its own
  Session session_;
  Placement placement_;
  std::unique_ptr<Transport> transport_;
  std::vector<Mail> mail_;  // one per PE
  std::unique_ptr<Team> team_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace

std::unique_ptr<Machine> make_mpi_machine(int& argc, char**& argv, MpiOptions options) {
  if (options.pes_per_process < 0)
    fail(ErrorCode::bad_argument, "cannot run on ", options.pes_per_process,
         " PEs per process: give a positive number");
  if (options.chunk_bytes == 0 || options.chunk_bytes > std::size_t{1} << 30)
    fail(ErrorCode::bad_argument, "a chunk of ", options.chunk_bytes,
         " bytes cannot be sent: give 1 to 1073741824");
  return std::make_unique<MpiMachine>(argc, argv, options);
}

std::string mpi_version() {
  std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> text{};
  int n = 0;
  MPI_Get_library_version(text.data(), &n);  // it may be called before MPI_Init
  // "Open MPI v4.1.4, package: …".
  std::string version(text.data(), std::string_view(text.data()).find_first_of(",\n"));
  if (const std::size_t v = version.find(" v"); v != std::string::npos) version.erase(v + 1, 1);
  return version;
}

}  // namespace tess::detail
