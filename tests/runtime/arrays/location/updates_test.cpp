// A PE's knowledge of locations: only newer updates apply, and a message follows newer knowledge at
// each hop.
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

#include <vector>

namespace {

int run_on_three(std::function<void()> main) {
  // One process per PE and a slow network: an element needs a millisecond to migrate, a message two
  // microseconds.
  return tests::run("pes=3,per-process=1,latency=2us,bandwidth=1GB/s,cost=100ns", std::move(main))
      .exit_code;
}

class Heavy : public tess::Chare<Heavy, tess::Index1> {
 public:
  void leave(tess::PeId to) { migrate_to(to); }
  void touch() { ++n_touches_; }
  void count(tess::Callback<std::int64_t> done) { done(n_touches_); }
  void serialize(auto& ar) { ar(n_touches_, state_); }

 private:
  std::int64_t n_touches_ = 0;
  std::vector<double> state_ =
      std::vector<double>(125'000);  // 1 MB; the runtime has such a name, too
};

class Sender : public tess::Group<Sender> {
 public:
  /// The element is here: it leaves, and the PE that it goes to sends it a message meanwhile.
  void send_away(tess::ArrayProxy<Heavy> array, tess::PeId to) {
    array[{0}].send<&Heavy::leave>(to);
    group()[to].send<&Sender::touch>(array);
  }
  void touch(tess::ArrayProxy<Heavy> array) { array[{0}].send<&Heavy::touch>(); }
  void count_forwards(tess::Callback<std::int64_t> done) {
    contribute(tess::sum, static_cast<std::int64_t>(tess::statistics().forwards), std::move(done));
  }
};

tess::Task chase(std::int64_t& n_forwards, std::int64_t& n_touches) {
  const auto array = tess::create<Heavy>(tess::range(1));  // its home is PE 0
  const auto senders = tess::create<Sender>(tess::each_pe);
  co_await tess::epoch([&] { array[{0}].migrate_to(tess::PeId{1}); });
  co_await tess::epoch([&] { array[{0}].migrate_to(tess::PeId{2}); });
  tess::Future<std::int64_t> before, after, touches;
  senders.broadcast<&Sender::count_forwards>(before.callback());
  n_forwards = -co_await before;
  co_await tess::epoch(
      [&] { senders[tess::PeId{2}].send<&Sender::send_away>(array, tess::PeId{1}); });
  senders.broadcast<&Sender::count_forwards>(after.callback());
  n_forwards += co_await after;
  array[{0}].send<&Heavy::count>(touches.callback());
  n_touches = co_await touches;
}

}  // namespace

TEST_CASE("old news of where an element is does not displace newer news", "[runtime][location]") {
  const int code = run_on_three([] {
    const auto array = tess::create<Heavy>(tess::sparse);
    tess::Index1 index{0};
    while (array.here().home(index) == tess::my_pe()) ++index.x;
    using Elements = tess::detail::ArrayOf<tess::Index1>;
    const auto news = [&](std::int32_t pe, tess::detail::Version version) {
      Elements::hint_arrives(array.here(), {index, {tess::PeId{pe}, version}});
      return array.here().next_pe(index).value;
    };
    CHECK(news(1, {1, 3}) == 1);
    CHECK(news(2, {1, 2}) == 1);  // arrived late
    CHECK(news(2, {1, 4}) == 2);
    CHECK(news(1, {1, 4}) == 2);
    CHECK(news(1, {2, 1}) == 1);  // a later life
  });
  CHECK(code == 0);
}

TEST_CASE("a message to an element that moves back and forth goes to no PE twice",
          "[runtime][location]") {
  std::int64_t n_forwards = 0, n_touches = 0;
  CHECK(run_on_three([&] { return chase(n_forwards, n_touches); }) == 0);
  CHECK(n_touches == 1);
  // From PE 1 the message follows the element to PE 2, and from there to PE 1. The element is not
  // there yet, and the home keeps the message until the element has arrived.
  CHECK(n_forwards == 2);
}
