// A ball between two elements, on the first and on the last PE: a number, a vector of bytes that is
// copied into each message, or one that is moved along. In turns with it, the limits without a
// runtime: raw MPI between processes, a cache line and a copy between cores.
#include "apps/bench/limits.hpp"
#include "apps/bench/shapes/shapes.hpp"
#include "runtime/runtime.hpp"

#include <array>
#include <memory>

namespace bench {
namespace {

using Bytes = std::vector<std::uint8_t>;
enum class Ball : std::uint8_t { number, copied, moved };

struct Match {
  Ball ball = Ball::number;
  std::int64_t n_round_trips = 0;
  std::uint64_t n_bytes = 8;
};

class Player : public tess::Chare<Player, tess::Index1> {
 public:
  explicit Player(std::int32_t n) : other_(n - 1 - index().x) {}

  /// To the first element: it serves, and in the end contributes the number of hits of both.
  void serve(Match match, tess::Callback<std::int64_t> done) {
    left_ = match.n_round_trips;
    done_ = std::move(done);
    if (match.ball == Ball::number) {
      other().send<&Player::hit_number>(1);
      return;
    }
    Bytes bytes(match.n_bytes, 7);
    bytes.back() = 9;
    if (match.ball == Ball::copied)
      other().send<&Player::hit_copied>(bytes);
    else
      other().send<&Player::hit_moved>(std::move(bytes));
  }

  void hit_number(std::int64_t n_hits) {
    if (!over(n_hits)) other().send<&Player::hit_number>(n_hits + 1);
  }
  void hit_copied(const Bytes& bytes) {
    check(bytes);
    if (!over(-1)) other().send<&Player::hit_copied>(bytes);
  }
  void hit_moved(Bytes bytes) {
    check(bytes);
    if (!over(-1)) other().send<&Player::hit_moved>(std::move(bytes));
  }

  void count(tess::Callback<std::int64_t> total) {
    contribute(tess::sum, std::exchange(n_met_, 0), std::move(total));
  }

 private:
  [[nodiscard]] tess::ElementProxy<Player> other() const { return array()[{other_}]; }
  void check(const Bytes& bytes) const {
    TESS_CHECK(bytes.front() == 7 && bytes.back() == 9, "a vector of ", bytes.size(),
               " is damaged");
  }
  /// The ball has arrived; returns true if that was the last time.
  bool over(std::int64_t n_hits) {
    ++n_met_;
    if (index().x != 0 || --left_ > 0) return false;
    done_(n_hits);
    return true;
  }

  std::int32_t other_;
  std::int64_t left_ = 0, n_met_ = 0;
  tess::Callback<std::int64_t> done_;
};

/// Lets the first and the last PE play a CorePing.
class CorePlayer : public tess::Group<CorePlayer> {
 public:
  /// `address` is that of a CorePing: both PEs are threads of this process.
  void play(std::uint64_t address, std::int64_t n_round_trips) {
    auto* ping = reinterpret_cast<CorePing*>(address);  // NOLINT
    const std::size_t side = pe().value == 0 ? 0 : 1;
    if (side == 0 && !ping->other_plays()) {
      group()[pe()].send<&CorePlayer::play>(address, n_round_trips);
      return;
    }
    const double nanoseconds = ping->play(side, n_round_trips);
    if (side == 0) done_(nanoseconds);
  }
  void expect(tess::Callback<double> done) { done_ = std::move(done); }

 private:
  tess::Callback<double> done_;
};

struct Size {
  const char* name;
  std::size_t n_bytes;
  std::int64_t most_round_trips;
};
constexpr std::array<Size, 4> sizes{{{"8B", 8, 20'000},
                                     {"1KiB", std::size_t{1} << 10U, 20'000},
                                     {"64KiB", std::size_t{1} << 16U, 2000},
                                     {"1MiB", std::size_t{1} << 20U, 200}}};

/// One ball and size: its samples, and those without the runtime.
struct OneWayFigure {
  std::string name;
  Ball ball = Ball::number;
  Size size;
  std::int64_t n_round_trips = 10;  // adapted by the warm-up
  Samples samples{};
};

struct OneWay {
  std::vector<OneWayFigure> figures;
  std::array<Samples, sizes.size()> core, mpi;
};

/// Gives nanoseconds one way.
tess::Task play_match(tess::ArrayProxy<Player> players, Match match, double& result) {
  tess::Future<std::int64_t> done;
  const Stopwatch watch;
  players[{0}].send<&Player::serve>(match, done.callback());
  const std::int64_t n_hits = co_await done;
  result = watch.nanoseconds() / (2.0 * static_cast<double>(match.n_round_trips));
  const std::int64_t n_met = co_await players.reduce<&Player::count>();
  TESS_CHECK(n_met == 2 * match.n_round_trips && (n_hits < 0 || n_hits == n_met),
             "the ball was met ", n_met, " times, not ", 2 * match.n_round_trips);
}

tess::Task ping_cores(tess::GroupProxy<CorePlayer> group, std::size_t n_bytes,
                      std::int64_t n_round_trips, double& result) {
  // Not a local: it is aligned to 64 bytes, and the frame of a coroutine to 16.
  const auto ping = std::make_unique<CorePing>(n_bytes);
  tess::Future<double> done;
  group.local().expect(done.callback());
  const auto address = reinterpret_cast<std::uint64_t>(ping.get());  // NOLINT
  const auto play = [&] {
    group[tess::PeId{tess::n_pes() - 1}].send<&CorePlayer::play>(address, n_round_trips);
    group[tess::PeId{0}].send<&CorePlayer::play>(address, n_round_trips);
  };
  co_await tess::epoch(play);  // neither side uses `ping` any more
  result = co_await done;
}

/// One turn: every ball and size once, the cores' own beside them.
tess::Task one_way_turn(const Bench& bench, std::int32_t turn, OneWay& all) {
  const std::int32_t n_pes = tess::n_pes();
  const auto players = tess::create<Player>(tess::range(n_pes), n_pes);
  const auto cores = tess::create<CorePlayer>(tess::each_pe);
  double nanoseconds = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (bench.has(Needs::two_cores)) {
      const std::int64_t n = bench.size<std::int64_t>(sizes[i].most_round_trips, 10);
      co_await ping_cores(cores, sizes[i].n_bytes, n, nanoseconds);
      if (turn > 0) all.core[i].add(nanoseconds);
    }
    for (OneWayFigure& figure : all.figures) {
      if (figure.size.n_bytes != sizes[i].n_bytes) continue;
      const Match match{figure.ball, figure.n_round_trips, figure.size.n_bytes};
      Match warm = match;
      warm.n_round_trips = 1 + match.n_round_trips / 10;
      co_await play_match(players, warm, nanoseconds);
      co_await play_match(players, match, nanoseconds);
      if (turn == 0)
        figure.n_round_trips = times_in_sample(
            2 * nanoseconds, bench.size<std::int64_t>(figure.size.most_round_trips, 10));
      else
        figure.samples.add(nanoseconds);
    }
  }
}

int run_one_way(Bench& bench) {
  OneWay all;
  const auto add = [&](const std::string& name, Ball ball, const Size& size) {
    if (bench.wants(name)) all.figures.push_back({name, ball, size});
  };
  add("one_way_int64", Ball::number, sizes[0]);
  for (const Size& size : sizes) {
    add(std::string("one_way_copied_") + size.name, Ball::copied, size);
    add(std::string("one_way_moved_") + size.name, Ball::moved, size);
  }
  for (std::int32_t turn = 0; turn <= bench.repeat(); ++turn) {
    if (bench.has(Needs::two_processes)) {
      for (std::size_t i = 0; i < sizes.size(); ++i) {
        const double nanoseconds = raw_mpi_one_way(
            sizes[i].n_bytes, bench.size<std::int64_t>(sizes[i].most_round_trips, 10));
        if (turn > 0) all.mpi[i].add(nanoseconds);
      }
    }
    const int code = bench.run([&] { return one_way_turn(bench, turn, all); });
    if (code != 0) return code;
  }
  const bool cores = bench.has(Needs::two_cores), processes = bench.has(Needs::two_processes);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (processes) bench.row(std::string("raw_mpi_") + sizes[i].name, all.mpi[i], "ns");
    if (cores) bench.row(std::string("core_to_core_") + sizes[i].name, all.core[i], "ns");
  }
  for (const OneWayFigure& figure : all.figures) {
    double limit = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      if (sizes[i].n_bytes != figure.size.n_bytes) continue;
      if (processes) limit = all.mpi[i].median();
      // What is moved within a process is a pointer.
      if (cores) limit = all.core[figure.ball == Ball::moved ? 0 : i].median();
    }
    bench.row(figure.name, figure.samples, "ns", limit);
  }
  return 0;
}

}  // namespace

Shape one_way_shape() {
  std::vector<RowText> rows;
  for (const Size& size : sizes) {
    rows.push_back({std::string("raw_mpi_") + size.name,
                    "MPI_Isend and MPI_Irecv without the runtime", Needs::two_processes});
    rows.push_back({std::string("core_to_core_") + size.name,
                    size.n_bytes == 8 ? "an atomic between two threads, without the runtime"
                                      : "the same with a copy of so many bytes",
                    Needs::two_cores});
  }
  rows.push_back({"one_way_int64", "a number", Needs::two_pes});
  for (const Size& size : sizes) {
    rows.push_back({std::string("one_way_copied_") + size.name,
                    "a vector of bytes, copied into the message", Needs::two_pes});
    rows.push_back({std::string("one_way_moved_") + size.name,
                    "a vector of bytes, moved into the message", Needs::two_pes});
  }
  return {"one_way", "a ball between elements on the first and the last PE, elapsed time over hits",
          rows, nullptr, &run_one_way};
}

}  // namespace bench
