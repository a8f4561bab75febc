#include "runtime/machine/mpi_transport.hpp"

#include <algorithm>
#include <mutex>
#include <thread>

namespace tess {
namespace {

/// Testing many requests is slow, and MPI gains nothing from more.
constexpr std::size_t most_sends = 128;

}  // namespace

Transport::Transport(MPI_Comm comm, std::int32_t n_processes, std::size_t chunk_bytes)
    : comm_(comm), chunk_bytes_(chunk_bytes), n_sent_(static_cast<std::size_t>(n_processes)) {}

void Transport::send(ProcessId to, Buffer&& bytes) {
  auto* const out = new Outgoing;
  out->to = to.value;
  out->bytes = std::move(bytes);
  out->n_bytes = out->bytes.size();
  outbox_.push(out);
  if (const std::unique_lock held(lock, std::try_to_lock); held) push_out();
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

void Transport::take_in(Mail& mail) {
  chunks_.poll([&](Incoming* done) {
    mail.add(std::move(done->bytes), done->n_bytes);
    ++n_received_;
    delete done;
  });
  while (!mail.full()) {
    int found = 0;
    MPI_Message message{};
    MPI_Status status{};
    must(MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, comm_, &found, &message, &status), "MPI_Improbe");
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

void Transport::drain() {
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

void Transport::start(Outgoing& out) {
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

MPI_Request Transport::isend(const Outgoing& out, const void* from, std::size_t n_bytes, Tag tag) {
  MPI_Request request = MPI_REQUEST_NULL;
  must(MPI_Isend(from, static_cast<int>(n_bytes), MPI_BYTE, out.to, tag, comm_, &request),
       "MPI_Isend");
  return request;
}

/// Takes an announcement and posts the receives of all its chunks before anything else is probed:
/// MPI keeps the order of messages with one source and tag, so each chunk meets its receive.
void Transport::expect(MPI_Message message, int source) {
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

}  // namespace tess
