#include "apps/bench/measures.hpp"
#include "runtime/runtime.hpp"

#include <array>

namespace bench {
namespace {

/// Goes from PE to PE, and carries a pattern that it checks on each.
class Nomad : public tess::Chare<Nomad, tess::Index1> {
 public:
  Nomad() {
    for (std::size_t i = 0; i < load_.size(); ++i) load_[i] = pattern(i);
  }

  void wander(std::int32_t moves_left) {
    if (moves_left == 0) {
      for (std::size_t i = 0; i < load_.size(); ++i)
        TESS_CHECK(load_[i] == pattern(i), "word ", i, " was lost on the way");
      return;
    }
    ++n_moves_;
    array()[index()].send<&Nomad::wander>(moves_left - 1);
    tess::Pe& pe = tess::current_pe();
    migrate_to(tess::PeId{(pe.id().value + 1) % pe.n_pes()});
  }
  void count(tess::Callback<std::int64_t> total) {
    contribute(tess::sum, std::exchange(n_moves_, 0), std::move(total));
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(load_, n_moves_);
  }

 private:
  [[nodiscard]] std::uint64_t pattern(std::size_t i) const {
    return i * 0x9e3779b97f4a7c15U + static_cast<std::uint64_t>(index().x);
  }
  std::array<std::uint64_t, 128> load_{};  // 1 KiB
  std::int64_t n_moves_ = 0;
};

}  // namespace

tess::Task migration(const Report& report, Options options) {
  const std::int32_t n = 1000, moves = 200;
  const auto nomads = tess::create<Nomad>(tess::range(n));
  Samples samples;
  for (std::int32_t k = 0; k < options.repeat; ++k) {
    const auto wander = [&] { nomads.broadcast<&Nomad::wander>(moves); };
    const Stopwatch watch;
    co_await tess::epoch(wander);
    samples.add(watch.nanoseconds() / (double{n} * moves));
    tess::Future<std::int64_t> total;
    nomads.broadcast<&Nomad::count>(total.callback());
    const std::int64_t n_moves = co_await total;
    TESS_CHECK(n_moves == std::int64_t{n} * moves, n_moves, " migrations were asked for");
  }
  report.row(reach() == Reach::processes ? "migration of 1 KiB between processes"
                                         : "migration of 1 KiB between PEs",
             samples,
             "ns",
             1800);
}

}  // namespace bench
