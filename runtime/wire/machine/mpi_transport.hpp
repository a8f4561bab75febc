// Transfers buffers between processes by MPI. Any PE sends: immediately if it gets the lock,
// otherwise through the outbox. The PE that holds the lock starts the transfers that wait in the
// outbox, and receives.
//
//     send() ─► (outbox ─► waiting) ─► MPI_Isend        MPI_Irecv, posted ahead ─► MPI_Test ─► Mail
//
// A few receives of the usual size are always posted, in a ring. MPI fills them in the order in
// which they were posted, so one test of the oldest finds whatever has arrived, and a small message
// travels from the sender's memory to its place without a probe. A larger buffer or a parcel is
// announced: by its tag, the sizes of its parts and, if they fit, its bytes. The rest follows in
// chunks through a separate communicator, from its memory at the sender to its destination.
//
//     announcement ─► take_in ─► Mail ─► Program::place ─► expect ─► MPI_Irecv … ─► Mail ─► placed
#pragma once

#include "runtime/base/mpi_turn.hpp"
#include "runtime/base/mpsc_queue.hpp"
#include "runtime/wire/machine/machine.hpp"
#include "runtime/wire/machine/mpi_mail.hpp"
#include "runtime/wire/machine/mpi_requests.hpp"

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <vector>

namespace tess::detail {

/// All functions except send(), expect() and new_mail() are called under the lock, or by one
/// thread.
class Transport {
 public:
  /// `chunk_bytes` is the largest size of one MPI message; it is the same on all processes. The
  /// communicators are used by nothing else meanwhile.
  Transport(MPI_Comm comm, MPI_Comm chunk_comm, std::int32_t n_processes, std::size_t chunk_bytes);
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  ~Transport();

  /// Any thread; does not block. Leaves `bytes` empty; it keeps its memory if MPI no longer needs
  /// it.
  void send(ProcessId to, Buffer& bytes);
  void send(ProcessId to, Parcel&& parcel);

  /// Any thread. The program has named the destinations of the parts.
  void expect(std::unique_ptr<Incoming> in);

  /// Starts the sends and receives that wait, up to the allowed number under way; the mail frees
  /// those that are done.
  void push_out(Mail& mail);

  /// Receives what has arrived, until the mail is full.
  void take_in(Mail& mail);

  /// Called after the last send(): receives and drops until everything that any process sent has
  /// been received. It counts, since a small send completes long before it is received. `drop`
  /// frees the message of a parcel whose parts arrived too late.
  void drain(const std::function<void(Link*)>& drop);

  /// Any thread.
  [[nodiscard]] Mail new_mail() const { return Mail(slot_bytes_); }

  TryLock& lock = mpi_lock();

 private:
  enum Tag : int { whole, announcement };

  /// The beginning of an announcement; the sizes of the parts follow, then the bytes if they fit.
  struct Announcement {
    std::uint64_t n_bytes = 0;
    std::int32_t tag = 0;
    std::uint32_t n_parts = 0;
  };

  /// A receive that is posted ahead.
  struct Slot {
    MPI_Request request = MPI_REQUEST_NULL;
    Mail::Block bytes;
  };

  [[nodiscard]] bool send_now(int to, const Buffer& bytes, MPI_Request& request);
  void announce(Outgoing& out, Buffer bytes);
  void start(std::unique_ptr<Outgoing> out);
  void start_large(std::unique_ptr<Outgoing> out);
  void hand_in(std::unique_ptr<Outgoing> out);
  void post(Slot& slot);
  void read_announcement(std::span<const std::byte> bytes, int source, Mail& mail);
  void receive_parts(Incoming* in);
  void receive(std::span<std::byte> memory, Incoming* in);

  const MPI_Comm comm_, chunk_comm_;
  const std::size_t chunk_bytes_;
  const std::size_t whole_bytes_;  // the largest size that is sent without announcement
  const std::size_t slot_bytes_;
  std::array<Slot, 8> slots_;
  std::size_t oldest_ = 0;  // the slot that is filled next
  unsigned n_finds_ = 0;    // consecutive calls of take_in() that found something
  std::int32_t tag_bound_ = 32767;
  std::int32_t last_tag_ = 0;
  MpscQueue outbox_;                               // any PE pushes
  MpscQueue placed_;                               // Incoming; any PE pushes
  std::deque<std::unique_ptr<Outgoing>> waiting_;  // taken from the outbox, not yet started
  Requests<Outgoing> sends_;
  Requests<Incoming> chunks_;
  std::vector<std::unique_ptr<Outgoing>> sent_;  // completed sends, for the next mail
  std::vector<std::int64_t> n_sent_;             // number of buffers and parcels per process
  std::int64_t n_received_ = 0;
};

}  // namespace tess::detail
