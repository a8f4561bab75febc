#include "apps/bench/calibrate/wire_times.hpp"

#include "apps/bench/report.hpp"
#include "runtime/base/ticks.hpp"
#include "runtime/runtime.hpp"

#include <utility>
#include <vector>

namespace bench {
namespace {

/// The work between two messages of an exchange: so long that each message travels alone.
constexpr double grain_seconds = 8e-6;

using Bytes = std::vector<std::uint8_t>;

struct Exchange {
  std::int32_t n_messages = 0;
  bool sends = false;  ///< otherwise it works only
};

/// One on each of two PEs.
class WirePeer : public tess::Chare<WirePeer, tess::Index1> {
 public:
  WirePeer() : other_(1 - index().x) {}

  // To the first element: a ball goes to and fro.
  void serve(std::int32_t n_round_trips, tess::Callback<std::int32_t> done) {
    begin(n_round_trips, std::move(done));
    other().send<&WirePeer::hit>(0);
  }
  void serve_large(std::int32_t n_round_trips, tess::Callback<std::int32_t> done) {
    begin(n_round_trips, std::move(done));
    other().send<&WirePeer::hit_large>(Bytes(large_bytes, 7));
  }
  void hit(std::int32_t n_hits) {
    if (!over()) other().send<&WirePeer::hit>(n_hits + 1);
  }
  void hit_large(Bytes bytes) {
    if (!over()) other().send<&WirePeer::hit_large>(std::move(bytes));
  }

  // To both: each works, sends, and receives meanwhile.
  void exchange(Exchange exchange, tess::Callback<std::int32_t> done) {
    done_ = std::move(done);
    sends_ = exchange.sends;
    n_due_ += exchange.sends ? exchange.n_messages : 0;
    works_ = true;
    work(exchange.n_messages);
  }
  void work(std::int32_t left) {
    const auto grain =
        static_cast<std::uint64_t>(grain_seconds / tess::detail::seconds_per_tick());
    const std::uint64_t until = tess::detail::read_ticks() + grain;
    while (tess::detail::read_ticks() < until) {
    }
    if (sends_) other().send<&WirePeer::take>(left);
    if (left > 1) {
      array()[index()].send<&WirePeer::work>(left - 1);
    } else {
      works_ = false;
      finish();
    }
  }
  void take(std::int32_t /*left*/) {
    --n_due_;
    finish();
  }

 private:
  [[nodiscard]] tess::ElementProxy<WirePeer> other() const { return array()[{other_}]; }
  void begin(std::int32_t n_round_trips, tess::Callback<std::int32_t> done) {
    left_ = n_round_trips;
    done_ = std::move(done);
  }
  /// The ball has arrived; true if that was the last time.
  bool over() {
    if (index().x != 0 || --left_ > 0) return false;
    done_(0);
    return true;
  }
  /// A message may come before its exchange() does: then messages are due in advance.
  void finish() {
    if (!works_ && n_due_ == 0) contribute(tess::sum, std::int32_t{1}, done_);
  }

  std::int32_t other_;
  std::int32_t left_ = 0, n_due_ = 0;
  bool sends_ = false, works_ = true;
  tess::Callback<std::int32_t> done_;
};

using Peers = tess::ArrayProxy<WirePeer>;

enum class Size : std::uint8_t { number, large };

/// Gives nanoseconds one way.
tess::Task play(Peers peers, Size size, std::int32_t n_round_trips, double& result) {
  tess::Future<std::int32_t> done;
  const Stopwatch watch;
  if (size == Size::number)
    peers[{0}].send<&WirePeer::serve>(n_round_trips, done.callback());
  else
    peers[{0}].send<&WirePeer::serve_large>(n_round_trips, done.callback());
  co_await done;
  result = watch.nanoseconds() / (2.0 * n_round_trips);
}

/// Gives nanoseconds of one work, with its messages if there are any.
tess::Task work_both(Peers peers, Exchange exchange, double& result) {
  tess::Future<std::int32_t> done;
  const Stopwatch watch;
  peers.broadcast<&WirePeer::exchange>(exchange, done.callback());
  co_await done;
  result = watch.nanoseconds() / exchange.n_messages;
}

}  // namespace

tess::Task measure_wire(WireEffort effort, WireTimes& result) {
  TESS_CHECK(tess::n_pes() == 2, tess::n_pes(), " PEs, not two");
  const auto peers = tess::create<WirePeer>(tess::range(2));
  const bool travels = !tess::machine().same_process(tess::PeId{0}, tess::PeId{1});
  const Exchange alone_exchange{effort.n_messages / 4, false}, both{effort.n_messages / 4, true};
  Samples ping, large, alone, exchange;
  for (std::int32_t i = 0; i <= effort.n_samples; ++i) {
    double numbers = 0, vectors = 0, works = 0, exchanges = 0;
    co_await play(peers, Size::number, effort.n_messages / 2, numbers);
    if (travels) co_await play(peers, Size::large, 1 + effort.n_messages / 100, vectors);
    co_await work_both(peers, alone_exchange, works);
    co_await work_both(peers, both, exchanges);
    if (i == 0) continue;  // the first warms up
    ping.add(numbers);
    large.add(vectors);
    alone.add(works);
    exchange.add(exchanges);
  }
  result = {ping.least(), large.least(), exchange.least() - alone.least()};
}

}  // namespace bench
