// Elements pass on values of every kind of container, between processes and while they migrate; a
// vector of numbers may travel separately from its message (serialize.hpp). The oracle: a value
// arrives as it was sent, checked member by member against its seed, and every chain ends.
#include "runtime/more/shared_array.hpp"
#include "tests/fuzz/protocols/scenarios.hpp"

#include <atomic>
#include <map>
#include <numeric>
#include <optional>
#include <variant>

namespace tess::fuzz {
namespace {

struct Relay {
  int n_elements = 0, n_hops = 0, most_numbers = 0;
  std::atomic<int> n_ended{0};
  std::atomic<int> n_seen{0};
};
Relay* relay = nullptr;

std::vector<double> numbers(std::uint64_t seed) {
  Random random(seed);
  std::vector<double> all(random.below(static_cast<std::uint64_t>(relay->most_numbers)));
  for (double& one : all) one = random.unit();
  return all;
}

/// Writes a temporary: it may not be attached.
struct Folded {
  std::vector<double> values;
  friend bool operator==(const Folded&, const Folded&) = default;
  void serialize(auto& ar) {
    std::vector<double> doubled(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) doubled[i] = 2 * values[i];
    ar(doubled);
    values = std::move(doubled);
    for (double& one : values) one /= 2;
  }
};

struct Payload {
  std::uint64_t seed = 0;
  std::vector<double> plain;
  std::string text;
  std::vector<std::vector<std::int32_t>> nested;
  std::map<int, std::vector<double>> by_key;
  std::optional<std::vector<float>> perhaps;
  std::variant<int, std::vector<std::byte>> either;
  Folded folded;
  SharedArray<double> shared;
  std::map<int, SharedArray<std::int32_t>> shared_by_key;
  std::vector<std::pair<std::string, std::vector<double>>> named;
  friend bool operator==(const Payload&, const Payload&) = default;

  static Payload of(std::uint64_t seed) {
    Random random(mix(seed));
    Payload payload;
    payload.seed = seed;
    payload.plain = numbers(random());
    payload.text.assign(random.below(60), 'x');
    payload.nested.resize(random.below(4));
    for (auto& inner : payload.nested)
      inner.assign(random.below(30), static_cast<int>(seed & 255U));
    for (int i = 0; i < 2; ++i) payload.by_key[i] = numbers(random());
    if (random.chance(0.5)) payload.perhaps.emplace(random.below(50), 1.5F);
    if (random.chance(0.5)) payload.either = std::vector<std::byte>(random.below(99), std::byte{7});
    payload.folded.values = numbers(random());
    payload.shared = SharedArray<double>(numbers(random()));
    payload.shared_by_key[1] = SharedArray<std::int32_t>(std::vector<std::int32_t>(9, 4));
    payload.named.resize(random.below(3), {"a name", numbers(random())});
    return payload;
  }
};

class Carrier : public Chare<Carrier, Index1> {
 public:
  /// The state is also large, and migrates.
  void load(std::uint64_t seed) {
    seed_ = seed;
    values_ = numbers(seed);
  }
  /// A broadcast is copied down the tree; what it shares is not.
  void see(SharedArray<double> shared) {
    expect(shared.size() == 100 && shared[99] == 99, "a broadcast was garbled");
    ++relay->n_seen;
  }
  void hand_on(Payload payload, int left) {
    expect(payload == Payload::of(payload.seed), "a value was garbled on its way");
    expect(seed_ == 0 || values_ == numbers(seed_), "a state was garbled on its way");
    Random random(mix(payload.seed ^ static_cast<std::uint64_t>(left)));
    if (random.chance(0.2)) load(random() | 1U);
    if (random.chance(0.3)) migrate_to(any_pe(random));
    if (left == 0) {
      ++relay->n_ended;
      return;
    }
    const Index to{draw(random, relay->n_elements)};
    array()[to].send<&Carrier::hand_on>(
        random.chance(0.5) ? std::move(payload) : Payload::of(random()), left - 1);
  }
  void serialize(auto& ar) { ar(seed_, values_); }

 private:
  std::uint64_t seed_ = 0;
  std::vector<double> values_;
};

}  // namespace

void payloads(Case& test) {
  Relay here{test.draw(1, 12), test.draw(0, 12), test.draw(1, 200)};
  relay = &here;
  const int n_chains = test.draw(1, 6);
  const std::uint64_t seed = test.random();
  test.run_clean([&] {
    const auto carriers = tess::create<Carrier>(range(here.n_elements));
    std::vector<double> counted(100);
    std::iota(counted.begin(), counted.end(), 0.0);
    carriers.broadcast<&Carrier::see>(SharedArray<double>(std::move(counted)));
    for (int i = 0; i < n_chains; ++i)
      carriers[{i % here.n_elements}].send<&Carrier::hand_on>(
          Payload::of(mix(seed + static_cast<unsigned>(i))), here.n_hops);
  });
  expect(here.n_ended == n_chains, here.n_ended.load(), " of ", n_chains, " chains ended");
  expect(here.n_seen == here.n_elements, here.n_seen.load(), " elements saw the broadcast");
}

}  // namespace tess::fuzz
