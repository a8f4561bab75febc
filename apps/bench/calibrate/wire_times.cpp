#include "apps/bench/calibrate/wire_times.hpp"

#include "apps/bench/report.hpp"
#include "runtime/base/ticks.hpp"
#include "runtime/runtime.hpp"

#include <cstdlib>
#include <utility>
#include <vector>

namespace bench {
namespace {

/// The work between two messages of an exchange: so long that each message travels alone.
constexpr double grain_seconds = 8e-6;

/// Rounds of a lap. A lap is so short that most have no disturbance by other programs: the
/// median lap of a sample counts, and the median sample.
constexpr std::int32_t lap_rounds = 10;

using Bytes = std::vector<std::uint8_t>;

enum class Game : std::uint8_t {
  ping,      ///< a number goes to and fro
  large,     ///< a vector does
  work,      ///< both work
  exchange,  ///< both work, send and receive
  packed,    ///< the same with vectors
};

struct Match {
  Game game = Game::ping;
  std::int32_t n_rounds = 0;
};

/// Laps of so many rounds, timed on one PE.
class Laps {
 public:
  void begin(std::int32_t rounds) {
    fair_ = {};
    others_ = {};
    rounds_ = rounds;
    n_ = 0;
    watch_ = Stopwatch();
  }
  /// A round is over; `fair` says whether its lap is one to count, if it is the last of a lap.
  void round(bool fair) {
    if (++n_ < rounds_) return;
    (fair ? fair_ : others_).add(watch_.nanoseconds() / rounds_);
    n_ = 0;
    watch_ = Stopwatch();
  }
  [[nodiscard]] bool at_begin() const { return n_ == 0; }
  /// Nanoseconds of a round, of the fair laps, or of all where none was fair.
  [[nodiscard]] double median() const { return (fair_.empty() ? others_ : fair_).median(); }

 private:
  Samples fair_, others_;
  std::int32_t rounds_ = 1, n_ = 0;
  Stopwatch watch_;
};

/// One on each of two PEs. The first takes the times.
class WirePeer : public tess::Chare<WirePeer, tess::Index1> {
 public:
  WirePeer() : other_(1 - index().x) {}

  /// To both; `done` gets the nanoseconds of a round.
  void play(Match match, tess::Callback<double> done) {
    done_ = std::move(done);
    left_ = match.n_rounds;
    game_ = match.game;
    sends_ = game_ == Game::exchange || game_ == Game::packed;
    n_due_ += sends_ ? match.n_rounds : 0;
    laps_.begin(game_ == Game::large ? 1 : lap_rounds);
    if (game_ == Game::work || sends_) {
      works_ = true;
      work();
    } else if (index().x != 0) {
      contribute(tess::max, 0.0, done_);
    } else if (game_ == Game::ping) {
      other().send<&WirePeer::hit>(0);
    } else {
      other().send<&WirePeer::hit_large>(Bytes(large_bytes, 7));
    }
  }

  void hit(std::int32_t n_hits) {
    if (!over()) other().send<&WirePeer::hit>(n_hits + 1);
  }
  void hit_large(Bytes bytes) {
    if (!over()) other().send<&WirePeer::hit_large>(std::move(bytes));
  }
  void work() {
    const auto grain = static_cast<std::uint64_t>(grain_seconds / tess::detail::seconds_per_tick());
    const std::uint64_t until = tess::detail::read_ticks() + grain;
    while (tess::detail::read_ticks() < until) {
    }
    if (game_ == Game::exchange) other().send<&WirePeer::take>();
    if (game_ == Game::packed) other().send<&WirePeer::take_packed>(Bytes(packed_bytes, 7));
    // Where the other PE was held up, the messages of a lap are too few or too many.
    laps_.round(!sends_ || std::abs(n_taken_ - lap_rounds) <= 1);
    if (laps_.at_begin()) n_taken_ = 0;
    if (--left_ > 0) {
      array()[index()].send<&WirePeer::work>();
    } else {
      works_ = false;
      finish();
    }
  }
  void take() {
    ++n_taken_;
    --n_due_;
    finish();
  }

  void take_packed(const Bytes& /*bytes*/) { take(); }

 private:
  [[nodiscard]] tess::ElementProxy<WirePeer> other() const { return array()[{other_}]; }
  /// The ball has arrived; true if that was the last time.
  bool over() {
    if (index().x != 0) return false;
    laps_.round(true);
    if (--left_ > 0) return false;
    contribute(tess::max, laps_.median(), done_);
    return true;
  }
  /// A message may come before play() does: then messages are due in advance.
  void finish() {
    if (!works_ && n_due_ == 0) contribute(tess::max, index().x == 0 ? laps_.median() : 0.0, done_);
  }

  std::int32_t other_;
  std::int32_t left_ = 0, n_due_ = 0, n_taken_ = 0;
  Game game_ = Game::ping;
  bool sends_ = false, works_ = true;
  Laps laps_;
  tess::Callback<double> done_;
};

/// Adds the nanoseconds of a round.
tess::Task sample(tess::ArrayProxy<WirePeer> peers, Match match, Samples& samples) {
  samples.add(co_await peers.reduce<&WirePeer::play>(match));
}

}  // namespace

tess::Task measure_wire(WireEffort effort, WireTimes& result) {
  TESS_CHECK(tess::n_pes() == 2, tess::n_pes(), " PEs, not two");
  const auto peers = tess::create<WirePeer>(tess::range(2));
  const bool travels = !tess::machine().same_process(tess::PeId{0}, tess::PeId{1});
  const std::int32_t n = effort.n_rounds;
  const Match ping{Game::ping, n}, large{Game::large, 1 + n / 20};
  const Match work{Game::work, n}, exchange{Game::exchange, n}, packed{Game::packed, n};
  Samples pings, larges, works, exchanges, packs, warm_up;
  co_await sample(peers, exchange, warm_up);
  for (std::int32_t i = 0; i < effort.n_samples; ++i) {
    co_await sample(peers, ping, pings);
    if (travels) co_await sample(peers, large, larges);
    co_await sample(peers, work, works);
    co_await sample(peers, exchange, exchanges);
    if (travels) co_await sample(peers, packed, packs);
  }
  result.ping = pings.median() / 2;
  result.exchange = exchanges.median() - works.median();
  if (!travels) co_return;
  result.large = larges.median() / 2;
  result.exchange_packed = packs.median() - works.median();
}

}  // namespace bench
