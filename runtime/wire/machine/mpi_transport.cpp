#include "runtime/wire/machine/mpi_transport.hpp"

#include <algorithm>
#include <cstring>
#include <mutex>
#include <thread>

namespace tess::detail {
namespace {

/// Testing many requests is slow, and more of them give MPI no advantage.
constexpr std::size_t most_sends = 128;

/// A buffer that the runtime flushes fits into one message: 32 KiB and the message that exceeded
/// it.
constexpr std::size_t usual_bytes = std::size_t{36} << 10U;

/// Room for an announcement with the sizes of many parts.
constexpr std::size_t least_slot_bytes = 1024;

}  // namespace

Transport::Transport(MPI_Comm comm, MPI_Comm chunk_comm, std::int32_t n_processes,
                     std::size_t chunk_bytes)
    : comm_(comm),
      chunk_comm_(chunk_comm),
      chunk_bytes_(chunk_bytes),
      whole_bytes_(std::min(chunk_bytes, usual_bytes)),
      slot_bytes_(std::max(whole_bytes_, least_slot_bytes)),
      n_sent_(static_cast<std::size_t>(n_processes)) {
  int* bound = nullptr;
  int known = 0;
  must(MPI_Comm_get_attr(chunk_comm_, MPI_TAG_UB, static_cast<void*>(&bound), &known),
       "MPI_Comm_get_attr");
  if (known != 0) tag_bound_ = *bound;
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
}

void Transport::send(ProcessId to, Buffer& bytes) {
  MPI_Request request = MPI_REQUEST_NULL;
  const std::unique_lock held(lock, std::try_to_lock);
  const bool starts = held && bytes.size() <= whole_bytes_ && sends_.size() < most_sends;
  // Most small sends complete immediately.
  if (starts && send_now(to.value, bytes, request)) {
    bytes.clear();
    return;
  }
  auto out = std::make_unique<Outgoing>();
  out->to = to.value;
  if (bytes.size() > whole_bytes_)
    announce(*out, std::move(bytes));
  else
    out->first = std::move(bytes);
  if (starts)
    sends_.add(request, out.release());
  else if (held)
    hand_in(std::move(out));
  else
    outbox_.push(out.release());
}

void Transport::send(ProcessId to, Parcel&& parcel) {
  auto out = std::make_unique<Outgoing>();
  out->to = to.value;
  out->rest = std::move(parcel);
  announce(*out, std::move(out->rest.head));
  const std::unique_lock held(lock, std::try_to_lock);
  if (held)
    hand_in(std::move(out));
  else
    outbox_.push(out.release());
}

/// Keeps in rest.head the bytes that do not fit behind the announcement.
void Transport::announce(Outgoing& out, Buffer bytes) {
  out.announces = true;
  const Announcement begins{bytes.size(), 0, static_cast<std::uint32_t>(out.rest.parts.size())};
  out.first.reserve(sizeof begins + out.rest.parts.size() * sizeof(std::uint64_t) + 512);
  out.first.append(std::as_bytes(std::span(&begins, 1)));
  for (const auto part : out.rest.parts) {
    const std::uint64_t size = part.size();
    out.first.append(std::as_bytes(std::span(&size, 1)));
  }
  if (out.first.size() + bytes.size() <= slot_bytes_)
    out.first.append({bytes.data(), bytes.size()});
  else
    out.rest.head = std::move(bytes);
}

/// Called under the lock: starts the transfer now, or after those that were handed in before it.
void Transport::hand_in(std::unique_ptr<Outgoing> out) {
  if (waiting_.empty() && sends_.size() < most_sends)
    start(std::move(out));
  else
    waiting_.push_back(std::move(out));
}

/// True if MPI no longer needs the bytes; otherwise the request reports completion.
bool Transport::send_now(int to, const Buffer& bytes, MPI_Request& request) {
  ++n_sent_[static_cast<std::size_t>(to)];
  must(
      MPI_Isend(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, to, whole, comm_, &request),
      "MPI_Isend");
  int complete = 0;
  must(MPI_Test(&request, &complete, MPI_STATUS_IGNORE), "MPI_Test");
  return complete != 0;
}

void Transport::push_out(Mail& mail) {
  const auto done = [this](Outgoing* out) { sent_.emplace_back(out); };
  sends_.poll(done);
  for (Link* link = outbox_.take_all(); link != nullptr;) {
    auto* const out = static_cast<Outgoing*>(link);
    link = link->next;
    waiting_.emplace_back(out);
  }
  while (!waiting_.empty() && sends_.size() < most_sends) {
    auto out = std::move(waiting_.front());
    waiting_.pop_front();
    start(std::move(out));
  }
  for (Link* link = placed_.take_all(); link != nullptr;) {
    auto* const in = static_cast<Incoming*>(link);
    link = link->next;
    receive_parts(in);
  }
  if (!sent_.empty()) std::swap(sent_, mail.sent);
}

void Transport::start(std::unique_ptr<Outgoing> out) {
  if (out->announces) return start_large(std::move(out));
  MPI_Request request = MPI_REQUEST_NULL;
  if (!send_now(out->to, out->first, request)) sends_.add(request, out.release());
}

void Transport::start_large(std::unique_ptr<Outgoing> owned) {
  Outgoing* const out = owned.release();  // its requests own it
  ++n_sent_[static_cast<std::size_t>(out->to)];
  // In order, so that no two transfers under way have the same tag; 0 is never used.
  last_tag_ = last_tag_ == tag_bound_ ? 1 : last_tag_ + 1;
  out->tag = last_tag_;
  std::memcpy(out->first.data() + offsetof(Announcement, tag), &out->tag, sizeof out->tag);
  MPI_Request request = MPI_REQUEST_NULL;
  must(MPI_Isend(out->first.data(), static_cast<int>(out->first.size()), MPI_BYTE, out->to,
                 announcement, comm_, &request),
       "MPI_Isend");
  sends_.add(request, out);
  const auto send_chunks = [&](std::span<const std::byte> bytes) {
    for (std::size_t at = 0; at < bytes.size(); at += chunk_bytes_) {
      const auto n = static_cast<int>(std::min(chunk_bytes_, bytes.size() - at));
      must(MPI_Isend(bytes.data() + at, n, MPI_BYTE, out->to, out->tag, chunk_comm_, &request),
           "MPI_Isend");
      sends_.add(request, out);
    }
  };
  send_chunks({out->rest.head.data(), out->rest.head.size()});
  for (const auto part : out->rest.parts) send_chunks(part);
}

void Transport::take_in(Mail& mail) {
  chunks_.poll([&](Incoming* done) {
    done->has_bytes = true;
    if (!done->places.empty() || done->sizes.empty()) ++n_received_;
    mail.large.emplace_back(done);
  });
  // A test that finds nothing costs as much as one that finds something, so a single message is
  // handed over without another test. In a flood everything that has arrived is taken, so that the
  // answers leave together.
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
      read_announcement({slot.bytes.get(), static_cast<std::size_t>(count)}, status.MPI_SOURCE,
                        mail);
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
  must(MPI_Irecv(slot.bytes.get(), static_cast<int>(slot_bytes_), MPI_BYTE, MPI_ANY_SOURCE,
                 MPI_ANY_TAG, comm_, &slot.request),
       "MPI_Irecv");
}

void Transport::read_announcement(std::span<const std::byte> bytes, int source, Mail& mail) {
  Announcement begins;
  std::memcpy(&begins, bytes.data(), sizeof begins);
  auto in = std::make_unique<Incoming>();
  in->source = source;
  in->tag = begins.tag;
  in->sizes.resize(begins.n_parts);
  bytes = bytes.subspan(sizeof begins);
  const std::size_t n = in->sizes.size() * sizeof(std::uint64_t);
  if (n != 0) std::memcpy(in->sizes.data(), bytes.data(), n);
  bytes = bytes.subspan(n);
  if (bytes.size() == begins.n_bytes) {
    in->has_bytes = true;
    in->bytes.append(bytes);
    if (in->sizes.empty()) ++n_received_;
    mail.large.push_back(std::move(in));
  } else {
    in->bytes.resize(begins.n_bytes);
    Incoming* const under_way = in.release();
    receive({under_way->bytes.data(), under_way->bytes.size()}, under_way);
  }
}

void Transport::expect(std::unique_ptr<Incoming> in) {
  const std::unique_lock held(lock, std::try_to_lock);
  if (held)
    receive_parts(in.release());
  else
    placed_.push(in.release());
}

void Transport::receive_parts(Incoming* in) {
  for (const auto place : in->places) receive(place, in);
}

/// Receives in chunks. Each chunk meets the one that was sent for it, since MPI keeps their order.
void Transport::receive(std::span<std::byte> memory, Incoming* in) {
  for (std::size_t at = 0; at < memory.size(); at += chunk_bytes_) {
    MPI_Request request = MPI_REQUEST_NULL;
    const auto n = static_cast<int>(std::min(chunk_bytes_, memory.size() - at));
    must(MPI_Irecv(memory.data() + at, n, MPI_BYTE, in->source, in->tag, chunk_comm_, &request),
         "MPI_Irecv");
    chunks_.add(request, in);
  }
}

void Transport::drain(const std::function<void(Link*)>& drop) {
  Mail mail = new_mail();
  std::int64_t n_expected = 0;
  MPI_Request counted = MPI_REQUEST_NULL;
  bool counting = false;
  for (int all_counted = 0;;) {
    mail.clear();
    push_out(mail);
    take_in(mail);
    const bool idle = mail.size() == 0;
    for (auto& in : mail.large) {
      if (in->message != nullptr) {
        drop(in->message);
      } else if (!in->sizes.empty() && in->places.empty()) {
        std::size_t n_bytes = 0;
        for (const std::uint64_t size : in->sizes) n_bytes += size;
        in->bytes.resize(n_bytes);
        std::byte* at = in->bytes.data();
        for (const std::uint64_t size : in->sizes) {
          in->places.emplace_back(at, size);
          at += size;
        }
        receive_parts(in.release());
      }
    }
    if (!counting && waiting_.empty()) {
      must(MPI_Ireduce_scatter_block(n_sent_.data(), &n_expected, 1, MPI_INT64_T, MPI_SUM, comm_,
                                     &counted),
           "MPI_Ireduce_scatter_block");
      counting = true;
    }
    if (counting && all_counted == 0)
      must(MPI_Test(&counted, &all_counted, MPI_STATUS_IGNORE), "MPI_Test");
    if (all_counted != 0 && n_received_ == n_expected && sends_.size() == 0) return;
    if (idle) std::this_thread::yield();
  }
}

}  // namespace tess::detail
