#include "runtime/machine/mpi.hpp"

#include "runtime/check.hpp"

#include <mpi.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <thread>

namespace tess {
namespace {

/// Ends the job if a call of MPI failed: a process is lost, or memory.
void must(int result, const char* call) {
  if (result == MPI_SUCCESS) return;
  std::array<char, MPI_MAX_ERROR_STRING> reason{};
  int length = 0;
  int rank = -1;
  MPI_Error_string(result, reason.data(), &length);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  std::fprintf(stderr, "tessera: %s failed on process %d: %s\n", call, rank, reason.data());
  std::fflush(nullptr);
  MPI_Abort(MPI_COMM_WORLD, 1);
  std::_Exit(1);
}

/// Taken or not, never waited for: whoever fails leaves its work in the outbox.
class TryLock {
 public:
  bool try_lock() noexcept {
    return !taken_.load(std::memory_order_relaxed) &&
           !taken_.exchange(true, std::memory_order_acquire);  // partner: unlock()
  }
  void unlock() noexcept { taken_.store(false, std::memory_order_release); }

 private:
  std::atomic<bool> taken_{false};
};

enum Tag : int { whole, announcement, chunk };

/// A buffer on its way out. The size is a member so that the announcement outlives its send.
struct Outgoing : Link {
  int to = 0;
  Buffer bytes;
  std::uint64_t n_bytes = 0;
  std::size_t n_parts = 0;  // requests not yet complete
};

/// A buffer that comes in chunks.
struct Incoming {
  std::unique_ptr<std::byte[]> bytes;
  std::uint64_t n_bytes = 0;
  std::size_t n_parts = 0;
};

/// Requests under way, each with the transfer that it is a part of.
template <class Transfer>
class Requests {
 public:
  [[nodiscard]] std::size_t size() const { return requests_.size(); }

  void add(MPI_Request request, Transfer* transfer) {
    requests_.push_back(request);
    transfers_.push_back(transfer);
    ++transfer->n_parts;
  }

  /// Calls done(transfer) for each transfer whose last part has completed; forgets those parts.
  template <class Done>
  void poll(Done done) {
    if (requests_.empty()) return;
    int n_complete = 0;
    places_.resize(requests_.size());
    must(MPI_Testsome(static_cast<int>(requests_.size()),
                      requests_.data(),
                      &n_complete,
                      places_.data(),
                      MPI_STATUSES_IGNORE),
         "MPI_Testsome");
    if (n_complete <= 0) return;  // MPI_UNDEFINED is negative
    std::size_t kept = 0;
    for (std::size_t i = 0; i < requests_.size(); ++i) {
      if (requests_[i] != MPI_REQUEST_NULL) {
        requests_[kept] = requests_[i];
        transfers_[kept++] = transfers_[i];
      } else if (--transfers_[i]->n_parts == 0) {
        done(transfers_[i]);
      }
    }
    requests_.resize(kept);
    transfers_.resize(kept);
  }

 private:
  std::vector<MPI_Request> requests_;
  std::vector<Transfer*> transfers_;
  std::vector<int> places_;
};

/// What one call of progress() received, for the PE that made it: small buffers side by side in one
/// block that is used again, others on their own.
class Mail {
 public:
  void clear() {
    items_.clear();
    own_.clear();
    used_ = 0;
  }
  [[nodiscard]] bool full() const { return items_.size() >= most_items || used_ >= block_bytes; }
  [[nodiscard]] std::span<const std::span<const std::byte>> items() const { return items_; }

  std::byte* add(std::size_t n_bytes) {
    if (used_ + n_bytes > block_bytes)
      return add(std::make_unique_for_overwrite<std::byte[]>(n_bytes), n_bytes);
    std::byte* const place = block_.get() + used_;
    used_ += (n_bytes + 15) / 16 * 16;
    items_.emplace_back(place, n_bytes);
    return place;
  }
  std::byte* add(std::unique_ptr<std::byte[]> bytes, std::size_t n_bytes) {
    items_.emplace_back(bytes.get(), n_bytes);
    own_.push_back(std::move(bytes));
    return own_.back().get();
  }

 private:
  static constexpr std::size_t block_bytes = std::size_t{64} * 1024;
  static constexpr std::size_t most_items = 16;

  std::unique_ptr<std::byte[]> block_ = std::make_unique_for_overwrite<std::byte[]>(block_bytes);
  std::size_t used_ = 0;
  std::vector<std::span<const std::byte>> items_;
  std::vector<std::unique_ptr<std::byte[]>> own_;
};

/// Buffers between processes. All but send() is called under the lock, or by one thread.
class Transport {
 public:
  Transport(MPI_Comm comm, int n_processes, std::size_t chunk_bytes)
      : comm_(comm), chunk_bytes_(chunk_bytes), n_sent_(static_cast<std::size_t>(n_processes)) {}

  void send(ProcessId to, Buffer&& bytes) {
    auto* const out = new Outgoing;
    out->to = to.value;
    out->bytes = std::move(bytes);
    out->n_bytes = out->bytes.size();
    outbox_.push(out);
    if (lock.try_lock()) {
      push_out();
      lock.unlock();
    }
  }

  /// Starts the sends that wait, as many as may be under way, and frees those that are done.
  void push_out() {
    sends_.poll([](Outgoing* done) { delete done; });
    for (Link* link = outbox_.take_all(); link != nullptr;) {
      auto* const out = static_cast<Outgoing*>(link);
      link = link->next;
      waiting_.push_back(out);
    }
    while (!waiting_.empty() && sends_.size() < most_sends) {
      Outgoing* const out = waiting_.front();
      waiting_.pop_front();
      start(*out);
    }
  }

  void take_in(Mail& mail) {
    chunks_.poll([&](Incoming* done) {
      mail.add(std::move(done->bytes), done->n_bytes);
      ++n_received_;
      delete done;
    });
    while (!mail.full()) {
      int found = 0;
      MPI_Message message{};
      MPI_Status status{};
      must(MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, comm_, &found, &message, &status),
           "MPI_Improbe");
      if (found == 0) return;
      int count = 0;
      must(MPI_Get_count(&status, MPI_BYTE, &count), "MPI_Get_count");
      if (status.MPI_TAG == announcement) {
        expect(message, status.MPI_SOURCE);
        continue;
      }
      std::byte* const place = mail.add(static_cast<std::size_t>(count));
      must(MPI_Mrecv(place, count, MPI_BYTE, &message, MPI_STATUS_IGNORE), "MPI_Mrecv");
      ++n_received_;
    }
  }

  /// After the last send(): receives and drops until every buffer that any process sent has been
  /// received. Counts, since a small send completes long before it is received.
  void drain() {
    Mail mail;
    std::int64_t n_expected = 0;
    MPI_Request counted = MPI_REQUEST_NULL;
    bool counting = false;
    for (int all_counted = 0;;) {
      push_out();
      mail.clear();
      take_in(mail);
      if (!counting && waiting_.empty()) {
        must(MPI_Ireduce_scatter_block(
                 n_sent_.data(), &n_expected, 1, MPI_INT64_T, MPI_SUM, comm_, &counted),
             "MPI_Ireduce_scatter_block");
        counting = true;
      }
      if (counting && all_counted == 0)
        must(MPI_Test(&counted, &all_counted, MPI_STATUS_IGNORE), "MPI_Test");
      if (all_counted != 0 && n_received_ == n_expected && sends_.size() == 0) return;
      if (mail.items().empty()) std::this_thread::yield();
    }
  }

  TryLock lock;

 private:
  /// Testing many requests is slow, and MPI gains nothing from more.
  static constexpr std::size_t most_sends = 128;

  void start(Outgoing& out) {
    ++n_sent_[static_cast<std::size_t>(out.to)];
    if (out.n_bytes <= chunk_bytes_) {
      MPI_Request request = isend(out, out.bytes.data(), out.n_bytes, whole);
      // Most small sends are complete at once; those never enter the list.
      int complete = 0;
      must(MPI_Test(&request, &complete, MPI_STATUS_IGNORE), "MPI_Test");
      if (complete != 0)
        delete &out;
      else
        sends_.add(request, &out);
      return;
    }
    sends_.add(isend(out, &out.n_bytes, sizeof(out.n_bytes), announcement), &out);
    for (std::size_t at = 0; at < out.n_bytes; at += chunk_bytes_)
      sends_.add(isend(out, out.bytes.data() + at, std::min(chunk_bytes_, out.n_bytes - at), chunk),
                 &out);
  }

  MPI_Request isend(const Outgoing& out, const void* from, std::size_t n_bytes, Tag tag) {
    MPI_Request request = MPI_REQUEST_NULL;
    must(MPI_Isend(from, static_cast<int>(n_bytes), MPI_BYTE, out.to, tag, comm_, &request),
         "MPI_Isend");
    return request;
  }

  /// Takes an announcement and posts the receives of all its chunks before anything else is probed:
  /// MPI keeps the order of messages with one source and tag, so each chunk meets its receive.
  void expect(MPI_Message message, int source) {
    auto* const in = new Incoming;
    must(MPI_Mrecv(&in->n_bytes, sizeof(in->n_bytes), MPI_BYTE, &message, MPI_STATUS_IGNORE),
         "MPI_Mrecv");
    in->bytes = std::make_unique_for_overwrite<std::byte[]>(in->n_bytes);
    for (std::size_t at = 0; at < in->n_bytes; at += chunk_bytes_) {
      MPI_Request request = MPI_REQUEST_NULL;
      must(MPI_Irecv(in->bytes.get() + at,
                     static_cast<int>(std::min(chunk_bytes_, in->n_bytes - at)),
                     MPI_BYTE,
                     source,
                     chunk,
                     comm_,
                     &request),
           "MPI_Irecv");
      chunks_.add(request, in);
    }
  }

  MPI_Comm comm_;
  std::size_t chunk_bytes_;
  MpscQueue outbox_;               // any PE pushes
  std::deque<Outgoing*> waiting_;  // taken from the outbox, not yet started
  Requests<Outgoing> sends_;
  Requests<Incoming> chunks_;
  std::vector<std::int64_t> n_sent_;  // buffers, to each process
  std::int64_t n_received_ = 0;
};

/// The processes of this host that share exactly our cores, and our place among them.
struct Sharing {
  std::int32_t n_processes = 1;
  std::int32_t place = 0;
};

Sharing sharing(MPI_Comm comm, const std::string& cpuset) {
  MPI_Comm host = MPI_COMM_NULL;
  must(MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &host),
       "MPI_Comm_split_type");
  int n = 0;
  int me = 0;
  must(MPI_Comm_size(host, &n), "MPI_Comm_size");
  must(MPI_Comm_rank(host, &me), "MPI_Comm_rank");
  const std::uint64_t mine = std::hash<std::string>()(cpuset);
  std::vector<std::uint64_t> all(static_cast<std::size_t>(n));
  must(MPI_Allgather(&mine, 1, MPI_UINT64_T, all.data(), 1, MPI_UINT64_T, host), "MPI_Allgather");
  must(MPI_Comm_free(&host), "MPI_Comm_free");
  return {static_cast<std::int32_t>(std::count(all.begin(), all.end(), mine)),
          static_cast<std::int32_t>(std::count(all.begin(), all.begin() + me, mine))};
}

/// MPI from first use to last; leaves it alone if the program had initialised it.
class Session {
 public:
  Session(int& argc, char**& argv) {
    int over = 0;
    MPI_Finalized(&over);
    if (over != 0) fail(ErrorCode::environment, "MPI has ended and cannot be started again");
    int initialised = 0;
    MPI_Initialized(&initialised);
    ours_ = initialised == 0;
    int provided = MPI_THREAD_SINGLE;
    if (ours_)
      must(MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided), "MPI_Init_thread");
    else
      must(MPI_Query_thread(&provided), "MPI_Query_thread");
    if (provided < MPI_THREAD_SERIALIZED)
      fail(ErrorCode::environment,
           "MPI gives thread level ",
           provided,
           ", but MPI_THREAD_SERIALIZED is needed: use an MPI built with threads");
    must(MPI_Comm_dup(MPI_COMM_WORLD, &comm), "MPI_Comm_dup");
    must(MPI_Comm_set_errhandler(comm, MPI_ERRORS_RETURN), "MPI_Comm_set_errhandler");
    set_check_abort([] { MPI_Abort(MPI_COMM_WORLD, 1); });
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session() {
    set_check_abort(nullptr);
    MPI_Comm_free(&comm);
    if (ours_) MPI_Finalize();
  }

  MPI_Comm comm = MPI_COMM_NULL;

 private:
  bool ours_ = false;
};

class MpiMachine final : public Machine, private Network {
 public:
  MpiMachine(int& argc, char**& argv, const MpiOptions& options) : session_(argc, argv) {
    int n = 0;
    int me = 0;
    must(MPI_Comm_size(session_.comm, &n), "MPI_Comm_size");
    must(MPI_Comm_rank(session_.comm, &me), "MPI_Comm_rank");
    n_processes_ = n;
    process_ = ProcessId{me};

    const Sharing shared = sharing(session_.comm, topology_.cpuset());
    const std::int32_t n_cores = topology_.n_cores();
    pes_per_process_ = options.pes_per_process;
    if (pes_per_process_ == 0) {
      const std::int32_t share = std::max(1, n_cores / shared.n_processes);
      must(MPI_Allreduce(&share, &pes_per_process_, 1, MPI_INT32_T, MPI_MIN, session_.comm),
           "MPI_Allreduce");
    }
    if (!agree(static_cast<std::uint64_t>(pes_per_process_)))
      fail(ErrorCode::bad_argument,
           "the processes were given different numbers of PEs, this one ",
           pes_per_process_,
           ": start them all with the same --pes");

    const bool enough = shared.n_processes * pes_per_process_ <= n_cores;
    placement_ = {.pinned = enough && options.pinning == Pinning::automatic,
                  .first_core = shared.place * pes_per_process_,
                  .oversubscribed = !enough};
    transport_ = std::make_unique<Transport>(session_.comm, n, options.chunk_bytes);
    mail_ = std::vector<Mail>(static_cast<std::size_t>(pes_per_process_));
    team_ = std::make_unique<Team>(
        PeId{me * pes_per_process_}, pes_per_process_, placement_, static_cast<Network*>(this));
    must(MPI_Barrier(session_.comm), "MPI_Barrier");  // the clocks start together
    start_ = std::chrono::steady_clock::now();
  }

  void post(PeId, PeId to, Link* message, std::size_t, Traffic) override {
    team_->post(to, message);
  }
  void send(PeId, ProcessId to, Buffer&& bytes) override { transport_->send(to, std::move(bytes)); }
  void run(Program& program) override {
    team_->run(program, topology_);
    transport_->drain();
  }
  void stop() override { team_->stop(); }

  [[noreturn]] void abort(int exit_code) override {
    // The lock is held for microseconds, unless its holder is what went wrong: then go on without.
    for (int i = 0; i < 1000 && !transport_->lock.try_lock(); ++i)
      std::this_thread::sleep_for(std::chrono::microseconds(10));
    MPI_Abort(MPI_COMM_WORLD, exit_code);
    std::_Exit(exit_code);
  }

  bool agree(std::uint64_t mine) override {
    const std::array<std::uint64_t, 2> both{mine, ~mine};
    std::array<std::uint64_t, 2> least{};
    must(MPI_Allreduce(both.data(), least.data(), 2, MPI_UINT64_T, MPI_MIN, session_.comm),
         "MPI_Allreduce");
    return least[0] == ~least[1];  // the smallest is the greatest, on every process alike
  }

  Time now(PeId) const override { return std::chrono::steady_clock::now() - start_; }

  std::string describe() const override {
    return text("mpi: ",
                n_processes_,
                n_processes_ == 1 ? " process, " : " processes, ",
                pes_per_process_,
                pes_per_process_ == 1 ? " PE each; " : " PEs each; ",
                process_,
                " on ",
                topology_.n_cores(),
                topology_.n_cores() == 1 ? " core (" : " cores (",
                topology_.cpuset(),
                ")",
                placement_.pinned           ? ", pinned"
                : placement_.oversubscribed ? ", more PEs than cores: not pinned"
                                            : ", not pinned");
  }

 private:
  bool progress(Program& program, PeId pe) override {
    if (!transport_->lock.try_lock()) return false;
    Mail& mail = mail_[static_cast<std::size_t>(pe.value % pes_per_process_)];
    mail.clear();
    transport_->push_out();
    transport_->take_in(mail);
    transport_->lock.unlock();  // before the program unpacks: others may go on
    for (const auto bytes : mail.items()) program.receive(pe, bytes);
    return !mail.items().empty();
  }

  Topology topology_;  // first: MPI starts threads of its own
  Session session_;
  Placement placement_;
  std::unique_ptr<Transport> transport_;
  std::vector<Mail> mail_;  // one a PE
  std::unique_ptr<Team> team_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace

bool under_mpirun() {
  return std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr || std::getenv("PMIX_RANK") != nullptr;
}

std::unique_ptr<Machine> make_mpi_machine(int& argc, char**& argv, MpiOptions options) {
  if (options.pes_per_process < 0)
    fail(ErrorCode::bad_argument,
         "cannot run on ",
         options.pes_per_process,
         " PEs a process: give a positive number");
  if (options.chunk_bytes == 0 || options.chunk_bytes > std::size_t{1} << 30)
    fail(ErrorCode::bad_argument,
         "a chunk of ",
         options.chunk_bytes,
         " bytes cannot be sent: give 1 to 1073741824");
  return std::make_unique<MpiMachine>(argc, argv, options);
}

}  // namespace tess
