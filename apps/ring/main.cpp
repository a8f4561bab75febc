// Messages around a ring of chares that goes through every PE. Each message adds up the stations it
// meets; at its end it compares the sum with the closed form, and the stations' visits are counted
// and compared with the number of hops.
#include "runtime/command_line.hpp"
#include "runtime/runtime.hpp"

#include <fmt/core.h>

namespace {

struct Token {
  std::int64_t hops_left = 0;
  std::int64_t sum = 0;       // of the stations it has met
  std::int64_t expected = 0;  // that sum at the end
};

class Station : public tess::Chare<Station, tess::Index1> {
 public:
  void pass(Token token) {
    ++n_visits_;
    token.sum += index().x;
    if (--token.hops_left == 0) {
      TESS_CHECK(token.sum == token.expected, "a message met stations that add up to ", token.sum,
                 " instead of ", token.expected);
      return;
    }
    const auto next = static_cast<std::int32_t>((index().x + 1) % array().size());
    array()[{next}].send<&Station::pass>(token);
  }

  void count(tess::Callback<std::int64_t> target) {
    contribute(tess::sum, n_visits_, std::move(target));
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(n_visits_);
  }

 private:
  std::int64_t n_visits_ = 0;
};

struct Options {
  std::int32_t stations = 0;
  std::int32_t rounds = 1000;
  std::int32_t messages = 1;
};

tess::Task go_round(Options options) {
  const std::int64_t n = options.stations != 0 ? options.stations : tess::n_pes();
  const auto ring = tess::create<Station>(tess::range(n));
  const Token token{n * options.rounds, 0, options.rounds * (n * (n - 1) / 2)};
  const tess::Time begin = tess::now();
  const auto send_all = [&] {
    for (std::int32_t k = 0; k < options.messages; ++k) ring[{0}].send<&Station::pass>(token);
  };
  co_await tess::epoch(send_all);
  const double seconds = tess::seconds(tess::now() - begin);

  const std::int64_t n_visits = co_await ring.reduce<&Station::count>();
  const std::int64_t n_hops = token.hops_left * options.messages;
  TESS_CHECK(n_visits == n_hops, n_visits, " visits were counted, not ", n_hops);
  tess::print(fmt::format("{} hops over {} stations: {:.6f} s, {:.3f} us per hop; each met once\n",
                          n_hops, n, seconds, seconds * 1e6 / static_cast<double>(n_hops)));
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argc, argv, [&](tess::Setup& setup) {
    Options options;
    tess::CommandLine line("Messages around a ring of chares over all PEs.");
    line.option("--stations", options.stations, "chares in the ring; 0: one per PE")
        .between(0, 1'000'000);
    line.option("--rounds", options.rounds, "how often each message goes round")
        .between(1, 1'000'000);
    line.option("--messages", options.messages, "how many go round at once").between(1, 100'000);
    if (!line.parse(argc, argv)) return 0;
    return tess::run(setup, [&] { return go_round(options); });
  });
}
