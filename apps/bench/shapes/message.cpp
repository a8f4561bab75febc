// Messages to random elements: 1 000 elements of a dense array; each starts a chain of 5 000 hops.
// The run is ended by a message of the last hop of each chain to a group's member, or by an epoch.
#include "apps/bench/shapes/shapes.hpp"
#include "runtime/runtime.hpp"

namespace bench {
namespace {

enum class EndedBy : std::uint8_t { message, epoch };

struct Chain {
  std::uint64_t state = 0;
  std::int64_t hops_left = 0;
};
struct ChainStart {
  std::int64_t n_hops = 0;
  EndedBy ended_by = EndedBy::message;
};

/// Counts the chains that ended, on PE 0.
class Referee : public tess::Group<Referee> {
 public:
  void expect(std::int64_t n_chains, tess::Callback<std::int64_t> done) {
    n_left_ = n_chains;
    done_ = std::move(done);
  }
  void chain_ended(std::int64_t n_hops) {
    if (--n_left_ == 0) done_(n_hops);
  }

 private:
  std::int64_t n_left_ = 0;
  tess::Callback<std::int64_t> done_;
};

/// Sends each chain on to a random element.
class Hopper : public tess::Chare<Hopper, tess::Index1> {
 public:
  Hopper(std::int32_t n, tess::GroupProxy<Referee> referee)
      : n_(static_cast<std::uint64_t>(n)), referee_(referee) {}

  void hop(Chain chain) {
    ++n_hops_;
    if (--chain.hops_left == 0) {
      if (start_.ended_by == EndedBy::message)
        referee_[tess::PeId{0}].send<&Referee::chain_ended>(start_.n_hops);
      return;
    }
    send_on(chain);
  }
  void begin(ChainStart start) {
    start_ = start;
    send_on({static_cast<std::uint64_t>(index().x), start.n_hops});
  }
  void count(tess::Callback<std::int64_t> total) {
    contribute(tess::sum, std::exchange(n_hops_, 0), std::move(total));
  }

 private:
  void send_on(Chain chain) {
    chain.state = chain.state * 6364136223846793005U + 1442695040888963407U;
    const auto next = static_cast<std::int32_t>((chain.state >> 32U) * n_ >> 32U);
    array()[{next}].send<&Hopper::hop>(chain);
  }

  std::uint64_t n_;
  tess::GroupProxy<Referee> referee_;
  ChainStart start_;
  std::int64_t n_hops_ = 0;
};

struct MessageRun {
  std::int32_t n_chains;
  tess::GroupProxy<Referee> referee;
  tess::ArrayProxy<Hopper> hoppers;
};

/// Gives the nanoseconds of a message.
tess::Task hop_about(MessageRun run, ChainStart start, double& result) {
  const double n_messages = static_cast<double>(run.n_chains) * static_cast<double>(start.n_hops);
  const auto begin = [&] { run.hoppers.broadcast<&Hopper::begin>(start); };
  if (start.ended_by == EndedBy::message) {
    tess::Future<std::int64_t> ended;
    run.referee.local().expect(run.n_chains, ended.callback());
    const Stopwatch watch;
    begin();
    co_await ended;
    result = watch.nanoseconds() / n_messages;
  } else {
    const Stopwatch watch;
    co_await tess::epoch(begin);
    result = watch.nanoseconds() / n_messages;
  }
  tess::Future<std::int64_t> total;
  run.hoppers.broadcast<&Hopper::count>(total.callback());
  const std::int64_t n = co_await total;
  TESS_CHECK(n == run.n_chains * start.n_hops, n, " hops were made, not ",
             run.n_chains * start.n_hops);
}

tess::Task measure_message(const Bench& bench, Samples& by_message, Samples& by_epoch) {
  MessageRun run{bench.size(1000, 50), tess::create_group<Referee>(), {}};
  run.hoppers = tess::create<Hopper>(tess::range(run.n_chains), run.n_chains, run.referee);
  std::int64_t n_hops = bench.size(500, 20);
  for (std::int32_t turn = 0; turn <= bench.repeat(); ++turn) {
    double message = 0, epoch = 0;
    co_await hop_about(run, {n_hops, EndedBy::message}, message);
    co_await hop_about(run, {n_hops, EndedBy::epoch}, epoch);
    if (turn == 0) {
      n_hops = times_in_sample(message * run.n_chains, bench.size(5000, 20));
    } else {
      by_message.add(message);
      by_epoch.add(epoch);
    }
  }
}

int run_message(Bench& bench) {
  Samples by_message, by_epoch;
  const int code = bench.run([&] { return measure_message(bench, by_message, by_epoch); });
  if (code != 0) return code;
  bench.row("message", by_message, "ns");
  bench.row("message_in_epoch", by_epoch, "ns");
  return 0;
}

}  // namespace

Shape message_shape() {
  return {"message",
          "1 000 chains of 5 000 hops to random elements, elapsed time over hops",
          {{"message", "ended by a message of each chain to PE 0"},
           {"message_in_epoch", "ended by co_await epoch"}},
          &run_message};
}

}  // namespace bench
