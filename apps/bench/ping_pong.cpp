#include "apps/bench/measures.hpp"
#include "runtime/runtime.hpp"

namespace bench {
namespace {

struct Ball {
  std::int64_t left = 0;
};

class Player : public tess::Chare<Player, tess::Index1> {
 public:
  void play(Ball ball) {
    ++n_played_;
    if (--ball.left == 0) {
      done_(n_played_);
      n_played_ = 0;
    } else {
      array()[{other_}].send<&Player::play>(ball);
    }
  }
  void begin(tess::Callback<std::int64_t> done, Ball ball) {
    done_ = std::move(done);
    other_ = static_cast<std::int32_t>(array().size()) - 1 - index().x;
    if (index().x == 0) array()[{other_}].send<&Player::play>(ball);
  }

 private:
  tess::Callback<std::int64_t> done_;
  std::int32_t other_ = 0;
  std::int64_t n_played_ = 0;
};

}  // namespace

tess::Task ping_pong(const Report& report, Options options) {
  const std::int32_t n_pes = tess::current_pe().n_pes();
  const auto players = tess::create<Player>(tess::range(n_pes));  // one a PE
  const std::int64_t rounds = 100'000;
  Samples samples;
  for (std::int32_t k = 0; k < options.repeat; ++k) {
    tess::Future<std::int64_t> done;
    const Stopwatch watch;
    players.broadcast<&Player::begin>(done.callback(), Ball{2 * rounds});
    const std::int64_t n = co_await done;
    samples.add(watch.nanoseconds() / (2.0 * static_cast<double>(rounds)));
    TESS_CHECK(n == rounds, "player 0 met the ball ", n, " times, not ", rounds);
  }
  report.row(reach() == Reach::processes ? "one way 8 bytes between processes"
                                         : "one way 8 bytes between PEs",
             samples,
             "ns",
             reach() == Reach::processes ? 0 : 260);
}

}  // namespace bench
