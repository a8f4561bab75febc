#include "collide/parallel/exchange.hpp"

#include "runtime/core/hash.hpp"
#include "tests/support/catch.hpp"

using tess::Random;
using namespace tess::collide;

namespace {

/// A message under way.
struct Mail {
  std::int32_t to = 0;
  Bundle<std::uint64_t> bundle;
};

/// The items of the parcel between two PEs: none for two thirds of them.
std::vector<std::uint64_t> parcel(std::int32_t from, std::int32_t to, std::uint64_t seed) {
  const std::uint64_t hash = tess::mix(
      seed ^ tess::mix(static_cast<std::uint64_t>(from) << 32 | static_cast<std::uint64_t>(to)));
  std::vector<std::uint64_t> items(hash % 3 == 0 ? 1 + hash % 5 : 0);
  for (std::size_t i = 0; i < items.size(); ++i) items[i] = tess::mix(hash + i);
  return items;
}

/// Runs an exchange with starts and deliveries in random order; returns the messages per PE.
std::vector<std::size_t> run(std::int32_t n_pes, std::uint64_t seed) {
  Random random(seed);
  std::vector<Exchange<std::uint64_t>> pes;
  std::vector<std::int32_t> waiting;  // to start
  for (std::int32_t me = 0; me < n_pes; ++me) {
    pes.emplace_back(me, n_pes);
    waiting.push_back(me);
  }
  std::vector<Mail> mail;
  std::vector<std::size_t> n_sent(static_cast<std::size_t>(n_pes));
  const auto at = [&](std::int32_t pe) -> Exchange<std::uint64_t>& {
    return pes[static_cast<std::size_t>(pe)];
  };
  const auto sender = [&](std::int32_t from) {
    return [&, from](std::int32_t to, Bundle<std::uint64_t> bundle) {
      REQUIRE(to != from);
      ++n_sent[static_cast<std::size_t>(from)];
      mail.push_back({to, std::move(bundle)});
    };
  };
  const auto take = [&](auto& from) {
    std::swap(from[random.below(from.size())], from.back());
    auto one = std::move(from.back());
    from.pop_back();
    return one;
  };
  while (!waiting.empty() || !mail.empty()) {
    if (mail.empty() || (!waiting.empty() && random.chance(0.3))) {
      const std::int32_t me = take(waiting);
      for (std::int32_t to = 0; to < n_pes; ++to)
        if (const auto items = parcel(me, to, seed); !items.empty()) at(me).put(to, items);
      REQUIRE_FALSE(at(me).is_done());
      at(me).start(sender(me));
    } else {
      const Mail one = take(mail);
      REQUIRE_FALSE(at(one.to).is_done());
      at(one.to).receive(one.bundle, sender(one.to));
    }
  }
  for (std::int32_t me = 0; me < n_pes; ++me) {
    REQUIRE(at(me).is_done());
    const auto received = at(me).received();
    std::size_t next = 0;
    for (std::int32_t from = 0; from < n_pes; ++from) {
      const auto expected = parcel(from, me, seed);
      if (expected.empty()) continue;
      REQUIRE(next < received.size());
      REQUIRE(received[next].from == from);
      REQUIRE((std::vector<std::uint64_t>(received[next].items.begin(),
                                          received[next].items.end()) == expected));
      ++next;
    }
    REQUIRE(next == received.size());
  }
  return n_sent;
}

}  // namespace

TEST_CASE("every parcel arrives once, for any number of PEs and any order of messages",
          "[collide][parallel]") {
  for (std::int32_t n_pes = 1; n_pes <= 40; ++n_pes)
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      CAPTURE(n_pes, seed);
      run(n_pes, seed);
    }
  for (const std::int32_t n_pes : {63, 64, 65, 127, 200}) {
    CAPTURE(n_pes);
    run(n_pes, 7);
  }
}

TEST_CASE("few PEs send directly; many send a few messages each", "[collide][parallel]") {
  for (const std::size_t n : run(16, 1)) REQUIRE(n == 15);
  for (const std::size_t n : run(512, 1)) REQUIRE(n == 3 * 7);
}
