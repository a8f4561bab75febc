#include "runtime/machine/mpi_transport.hpp"

#include <algorithm>
#include <cstring>
#include <mutex>
#include <thread>

namespace tess {
namespace {

/// Testing many requests is slow, and MPI gains nothing from more.
constexpr std::size_t most_sends = 128;

/// What the runtime flushes fits in one piece: 32 KiB and the message that went over.
constexpr std::size_t usual_bytes = std::size_t{36} << 10U;

}  // namespace

Transport::Transport(MPI_Comm comm, std::int32_t n_processes, std::size_t chunk_bytes)
    : comm_(comm),
      chunk_bytes_(chunk_bytes),
      whole_bytes_(std::min(chunk_bytes, usual_bytes)),
      slot_bytes_(std::max(whole_bytes_, sizeof(std::uint64_t))),
      n_sent_(static_cast<std::size_t>(n_processes)) {
  must(MPI_Comm_dup(comm_, &chunk_comm_), "MPI_Comm_dup");
  for (Slot& slot : slots_) {
    slot.bytes = std::make_unique_for_overwrite<std::byte[]>(slot_bytes_);
    post(slot);
  }
}

Transport::~Transport() {
  for (Slot& slot : slots_) {
    MPI_Cancel(&slot.request);
    MPI_Wait(&slot.request, MPI_STATUS_IGNORE);
  }
  MPI_Comm_free(&chunk_comm_);
}

void Transport::send(ProcessId to, Buffer& bytes) {
  MPI_Request request = MPI_REQUEST_NULL;
  const std::unique_lock held(lock, std::try_to_lock);
  const bool starts = held && bytes.size() <= whole_bytes_ && sends_.size() < most_sends;
  // Most small sends are complete at once.
  if (starts && send_now(to.value, bytes, request)) {
    bytes.clear();
    return;
  }
  auto* const out = new Outgoing;
  out->to = to.value;
  out->bytes = std::move(bytes);
  bytes.clear();
  out->n_bytes = out->bytes.size();
  if (starts) {
    sends_.add(request, out);
  } else {
    outbox_.push(out);
    if (held) push_out();
  }
}

/// True if MPI is done with the bytes already; else the request says when.
bool Transport::send_now(int to, const Buffer& bytes, MPI_Request& request) {
  ++n_sent_[static_cast<std::size_t>(to)];
  must(
      MPI_Isend(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, to, whole, comm_, &request),
      "MPI_Isend");
  int complete = 0;
  must(MPI_Test(&request, &complete, MPI_STATUS_IGNORE), "MPI_Test");
  return complete != 0;
}

void Transport::push_out() {
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

void Transport::start(Outgoing& out) {
  MPI_Request request = MPI_REQUEST_NULL;
  if (out.n_bytes <= whole_bytes_) {
    if (send_now(out.to, out.bytes, request))
      delete &out;
    else
      sends_.add(request, &out);
    return;
  }
  ++n_sent_[static_cast<std::size_t>(out.to)];
  must(
      MPI_Isend(&out.n_bytes, sizeof(out.n_bytes), MPI_BYTE, out.to, announcement, comm_, &request),
      "MPI_Isend");
  sends_.add(request, &out);
  for (std::size_t at = 0; at < out.n_bytes; at += chunk_bytes_) {
    const auto n = static_cast<int>(std::min(chunk_bytes_, out.n_bytes - at));
    must(MPI_Isend(out.bytes.data() + at, n, MPI_BYTE, out.to, 0, chunk_comm_, &request),
         "MPI_Isend");
    sends_.add(request, &out);
  }
}

void Transport::take_in(Mail& mail) {
  chunks_.poll([&](Incoming* done) {
    mail.add(std::move(done->bytes), done->n_bytes);
    ++n_received_;
    delete done;
  });
  // The test that finds nothing costs as much as one that finds something: a message by itself is
  // handed over without it. In a flood all that has come is taken, so that its answers leave
  // together.
  const std::size_t most = n_finds_ < 2 ? 1 : Mail::most_items;
  while (mail.size() < most) {
    Slot& slot = slots_[oldest_];
    int complete = 0;
    MPI_Status status{};
    must(MPI_Test(&slot.request, &complete, &status), "MPI_Test");
    if (complete == 0) break;
    int count = 0;
    must(MPI_Get_count(&status, MPI_BYTE, &count), "MPI_Get_count");
    if (status.MPI_TAG == announcement) {
      std::uint64_t n_bytes = 0;
      std::memcpy(&n_bytes, slot.bytes.get(), sizeof n_bytes);
      expect(n_bytes, status.MPI_SOURCE);
    } else {
      mail.exchange(slot.bytes, static_cast<std::size_t>(count));
      ++n_received_;
    }
    post(slot);
    oldest_ = (oldest_ + 1) % slots_.size();
  }
  n_finds_ = mail.size() == 0 ? 0 : n_finds_ + 1;
}

void Transport::post(Slot& slot) {
  must(MPI_Irecv(slot.bytes.get(),
                 static_cast<int>(slot_bytes_),
                 MPI_BYTE,
                 MPI_ANY_SOURCE,
                 MPI_ANY_TAG,
                 comm_,
                 &slot.request),
       "MPI_Irecv");
}

/// Posts the receives of all chunks of an announced buffer. MPI keeps the order of messages of one
/// source, and announcements are met in that order: each chunk meets its receive.
void Transport::expect(std::uint64_t n_bytes, int source) {
  auto* const in = new Incoming;
  in->n_bytes = n_bytes;
  in->bytes = std::make_unique_for_overwrite<std::byte[]>(in->n_bytes);
  for (std::size_t at = 0; at < in->n_bytes; at += chunk_bytes_) {
    MPI_Request request = MPI_REQUEST_NULL;
    const auto n = static_cast<int>(std::min(chunk_bytes_, in->n_bytes - at));
    must(MPI_Irecv(in->bytes.get() + at, n, MPI_BYTE, source, 0, chunk_comm_, &request),
         "MPI_Irecv");
    chunks_.add(request, in);
  }
}

void Transport::drain() {
  Mail mail = new_mail();
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

}  // namespace tess
