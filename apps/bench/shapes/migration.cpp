// 20 000 elements of 1 KiB that go to the next PE at once: until an epoch ends, or until a message
// that follows each has been answered by all in a reduction.
#include "apps/bench/shapes/shapes.hpp"
#include "runtime/runtime.hpp"

#include <array>

namespace bench {
namespace {

/// Goes from PE to PE, and carries a pattern.
class Nomad : public tess::Chare<Nomad, tess::Index1> {
 public:
  Nomad() {
    for (std::size_t i = 0; i < load_.size(); ++i) load_[i] = pattern(i);
  }

  void go() {
    ++n_moves_;
    next_ = tess::PeId{(tess::my_pe().value + 1) % tess::n_pes()};
    migrate_to(next_);
  }
  void go_followed(tess::Callback<std::int64_t> arrived) {
    array()[index()].send<&Nomad::follow>(std::move(arrived));
    go();
  }
  void follow(tess::Callback<std::int64_t> arrived) {
    TESS_CHECK(tess::my_pe() == next_, "element ", index().x, " did not move");
    contribute(tess::sum, std::int64_t{1}, std::move(arrived));
  }
  void check(tess::Callback<std::int64_t> n_moves) {
    for (std::size_t i = 0; i < load_.size(); ++i)
      TESS_CHECK(load_[i] == pattern(i), "word ", i, " was lost on the way");
    contribute(tess::sum, std::exchange(n_moves_, 0), std::move(n_moves));
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(load_, next_, n_moves_);
  }

 private:
  [[nodiscard]] std::uint64_t pattern(std::size_t i) const {
    return i * 0x9e3779b97f4a7c15U + static_cast<std::uint64_t>(index().x);
  }
  std::array<std::uint64_t, 128> load_{};  // 1 KiB
  tess::PeId next_{};
  std::int64_t n_moves_ = 0;
};

tess::Task measure_migration(const Bench& bench, std::span<Figure> of_rows) {
  const std::int32_t n = bench.size(20'000, 200);
  const auto nomads = tess::create<Nomad>(tess::range(n));
  for (std::int32_t turn = 0; turn <= bench.repeat(); ++turn) {
    const auto go = [&] { nomads.broadcast<&Nomad::go>(); };
    const Stopwatch of_epoch;
    co_await tess::epoch(go);
    const double epoch = of_epoch.nanoseconds() / n;

    const Stopwatch of_message;
    const std::int64_t n_arrived = co_await nomads.reduce<&Nomad::go_followed>();
    const double message = of_message.nanoseconds() / n;
    TESS_CHECK(n_arrived == n, n_arrived, " of ", n, " elements arrived");

    const std::int64_t n_moves = co_await nomads.reduce<&Nomad::check>();
    TESS_CHECK(n_moves == 2 * n, n_moves, " migrations were made, not ", 2 * n);
    if (turn == 0) continue;
    of_rows[0].samples.add(epoch);
    of_rows[1].samples.add(message);
  }
}

}  // namespace

Shape migration_shape() {
  return {"migration",
          "20 000 elements of 1 KiB go to the next PE, elapsed time over elements",
          {{"migration_by_epoch", "ended by an epoch", Needs::two_pes},
           {"migration_by_message", "ended by a message that follows each and a reduction",
            Needs::two_pes}},
          &measure_migration};
}

}  // namespace bench
