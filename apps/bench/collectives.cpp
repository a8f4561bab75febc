#include "apps/bench/measures.hpp"
#include "runtime/runtime.hpp"

namespace bench {
namespace {

class Voter : public tess::Chare<Voter, tess::Index1> {
 public:
  explicit Voter(tess::Callback<std::int64_t> done) : done_(std::move(done)) {}

  void hear(std::int32_t value) { sum_ += value; }
  void vote(std::int32_t rounds_left) {
    if (rounds_left == 0) {
      contribute(tess::sum, std::exchange(sum_, 0), done_);
    } else {
      ++sum_;
      contribute(tess::sum, rounds_left - 1, array().target<&Voter::next>());
    }
  }
  /// All voted the same number: its sum over the elements comes back.
  void next(std::int32_t sum) { vote(sum / static_cast<std::int32_t>(array().size())); }

 private:
  tess::Callback<std::int64_t> done_;
  std::int64_t sum_ = 0;
};

}  // namespace

tess::Task collectives(const Report& report, Options options) {
  const std::int32_t n = 10'000;
  const std::int32_t rounds = 100;
  Samples both, broadcast;
  for (std::int32_t k = 0; k < options.repeat; ++k) {
    tess::Future<std::int64_t> done;
    const auto voters = tess::create<Voter>(tess::range(n), done.callback());
    const double n_calls = double{n} * rounds;
    {
      const auto tell = [&] {
        for (std::int32_t i = 0; i < rounds; ++i) voters.broadcast<&Voter::hear>(1);
      };
      const Stopwatch watch;
      co_await tess::epoch(tell);
      broadcast.add(watch.nanoseconds() / n_calls);
    }
    const Stopwatch watch;
    voters.broadcast<&Voter::vote>(rounds);
    const std::int64_t sum = co_await done;
    both.add(watch.nanoseconds() / n_calls);
    TESS_CHECK(sum == std::int64_t{2} * n * rounds, "the votes add up to ", sum);
  }
  report.row("broadcast an element", broadcast, "ns");
  report.row("broadcast and reduction an element", both, "ns", 76);
}

}  // namespace bench
