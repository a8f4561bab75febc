// Messages to random elements: 1 000 elements of a dense array; each starts a chain of 5 000 hops.
// The run is ended by a message of the last hop of each chain to a group's member, or by an epoch.
// The same with priorities, with calls that run at once where the element is local, and with
// awaited replies.
#include "apps/bench/shapes/shapes.hpp"
#include "runtime/runtime.hpp"

#include <array>

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

enum class Sent : std::uint8_t {
  plain,
  prioritised,  ///< each chain has one of eight priorities
  mixed,        ///< each hop has one of eight priorities
  distinct,     ///< a priority that no other message has
  expedited,
  inlined,
};

/// Sends each chain on to a random element.
template <Sent sent>
class Hopper : public tess::Chare<Hopper<sent>, tess::Index1> {
 public:
  Hopper(std::int32_t n, tess::GroupProxy<Referee> referee)
      : n_(static_cast<std::uint64_t>(n)), referee_(referee) {}

  void hop(Chain chain) {
    ++n_hops_;
    --chain.hops_left;
    if ((sent == Sent::prioritised ? chain.hops_left & most_hops : chain.hops_left) == 0) {
      if (start_.ended_by == EndedBy::message)
        referee_[tess::PeId{0}].send<&Referee::chain_ended>(start_.n_hops);
      return;
    }
    send_on(chain);
  }
  void begin(ChainStart start) {
    start_ = start;
    std::int64_t level = 0;
    if constexpr (sent == Sent::prioritised) level = 1 + this->index().x % 8;
    send_on({static_cast<std::uint64_t>(this->index().x), start.n_hops + level * (most_hops + 1)});
  }
  void count(tess::Callback<std::int64_t> total) {
    this->contribute(tess::sum, std::exchange(n_hops_, 0), std::move(total));
  }
  using EntryAttributes =
      std::conditional_t<sent == Sent::inlined,
                         tess::Attributes<tess::EntryMethod<&Hopper::hop, tess::inline_when_local>>,
                         tess::Attributes<>>;

 private:
  void send_on(Chain chain) {
    chain.state = chain.state * 6364136223846793005U + 1442695040888963407U;
    const auto next = static_cast<std::int32_t>((chain.state >> 32U) * n_ >> 32U);
    const auto to = this->array()[{next}];
    if constexpr (sent == Sent::prioritised) {
      to.with(tess::Priority{chain.hops_left / (most_hops + 1)}).template send<&Hopper::hop>(chain);
    } else if constexpr (sent == Sent::mixed) {
      to.with(tess::Priority{1 + static_cast<std::int64_t>(chain.state >> 61U)})
          .template send<&Hopper::hop>(chain);
    } else if constexpr (sent == Sent::distinct) {
      to.with(tess::Priority{static_cast<std::int64_t>(chain.state)})
          .template send<&Hopper::hop>(chain);
    } else if constexpr (sent == Sent::expedited) {
      to.with(tess::expedited).template send<&Hopper::hop>(chain);
    } else {
      to.template send<&Hopper::hop>(chain);
    }
  }

  /// The bits above are the priority of a chain that has one.
  static constexpr std::int64_t most_hops = (std::int64_t{1} << 40U) - 1;

  std::uint64_t n_;
  tess::GroupProxy<Referee> referee_;
  ChainStart start_;
  std::int64_t n_hops_ = 0;
};

template <Sent sent>
struct MessageRun {
  std::int32_t n_chains;
  tess::GroupProxy<Referee> referee;
  tess::ArrayProxy<Hopper<sent>> hoppers;

  MessageRun(std::int32_t n, tess::GroupProxy<Referee> by)
      : n_chains(n), referee(by), hoppers(tess::create<Hopper<sent>>(tess::range(n), n, by)) {}
};

/// Gives the nanoseconds of a message.
template <Sent sent>
tess::Task hop_about(MessageRun<sent> run, ChainStart start, double& result) {
  const double n_messages = static_cast<double>(run.n_chains) * static_cast<double>(start.n_hops);
  const auto begin = [&] { run.hoppers.template broadcast<&Hopper<sent>::begin>(start); };
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
  const std::int64_t n = co_await run.hoppers.template reduce<&Hopper<sent>::count>();
  TESS_CHECK(n == run.n_chains * start.n_hops, n, " hops were made, not ",
             run.n_chains * start.n_hops);
}

/// Asks random elements, one after the other.
class Asker : public tess::Chare<Asker, tess::Index1> {
 public:
  explicit Asker(std::int32_t n) : n_(static_cast<std::uint64_t>(n)) {}

  [[nodiscard]] std::int64_t count() { return ++n_asked_; }
  tess::Task ask_others(std::int64_t n_asks) {
    auto state = static_cast<std::uint64_t>(index().x);
    for (; n_asks > 0; --n_asks) {
      state = state * 6364136223846793005U + 1442695040888963407U;
      const auto next = static_cast<std::int32_t>((state >> 32U) * n_ >> 32U);
      n_replies_ += co_await array()[{next}].ask<&Asker::count>() > 0;
    }
  }
  void replies(tess::Callback<std::int64_t> total) {
    contribute(tess::sum, std::exchange(n_replies_, 0), std::move(total));
  }

 private:
  std::uint64_t n_;
  std::int64_t n_asked_ = 0, n_replies_ = 0;
};

/// Gives the nanoseconds of a call and its reply.
tess::Task ask_about(tess::ArrayProxy<Asker> askers, std::int32_t n, std::int64_t n_asks,
                     double& result) {
  const Stopwatch watch;
  co_await tess::epoch([&] { askers.broadcast<&Asker::ask_others>(n_asks); });
  result = watch.nanoseconds() / (static_cast<double>(n) * static_cast<double>(n_asks));
  const std::int64_t n_replies = co_await askers.reduce<&Asker::replies>();
  TESS_CHECK(n_replies == n * n_asks, n_replies, " replies came, not ", n * n_asks);
}

tess::Task measure_message(const Bench& bench, std::span<Figure> of_rows) {
  const std::int32_t n = bench.size(1000, 50);
  const auto referee = tess::create<Referee>(tess::each_pe);
  const MessageRun<Sent::plain> plain(n, referee);
  const MessageRun<Sent::prioritised> prioritised(n, referee);
  const MessageRun<Sent::mixed> mixed(n, referee);
  const MessageRun<Sent::distinct> distinct(n, referee);
  const MessageRun<Sent::expedited> expedited(n, referee);
  const MessageRun<Sent::inlined> inlined(n, referee);
  const auto askers = tess::create<Asker>(tess::range(n), n);
  std::int64_t n_hops = bench.size(500, 20);
  for (std::int32_t turn = 0; turn <= bench.repeat(); ++turn) {
    const ChainStart start{n_hops, EndedBy::message};
    std::array<double, 8> took{};  // by row
    co_await hop_about(plain, start, took[0]);
    if (bench.wants("message_in_epoch"))
      co_await hop_about(plain, {n_hops, EndedBy::epoch}, took[1]);
    if (bench.wants("message_prioritised")) co_await hop_about(prioritised, start, took[2]);
    if (bench.wants("message_mixed")) co_await hop_about(mixed, start, took[3]);
    if (bench.wants("message_distinct")) co_await hop_about(distinct, start, took[4]);
    if (bench.wants("message_expedited")) co_await hop_about(expedited, start, took[5]);
    if (bench.wants("message_inline")) co_await hop_about(inlined, start, took[6]);
    if (bench.wants("message_ask")) co_await ask_about(askers, n, n_hops, took[7]);
    if (turn == 0) n_hops = times_in_sample(took[0] * n, bench.size(5000, 20));
    for (std::size_t i = 0; turn > 0 && i < took.size(); ++i) of_rows[i].samples.add(took[i]);
  }
}

}  // namespace

Shape message_shape() {
  return {"message",
          "1 000 chains of 5 000 hops to random elements, elapsed time over hops",
          {{"message", "ended by a message of each chain to PE 0"},
           {"message_in_epoch", "ended by co_await epoch"},
           {"message_prioritised", "each chain with one of eight priorities"},
           {"message_mixed", "each hop with one of eight priorities"},
           {"message_distinct", "each hop with a priority of its own"},
           {"message_expedited", "each hop expedited"},
           {"message_inline", "a hop to an element of the same PE runs inside send()"},
           {"message_ask",
            "each element asks random ones and awaits each reply: a call and its reply"}},
          &measure_message};
}

}  // namespace bench
