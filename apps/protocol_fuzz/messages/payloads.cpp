// Elements pass on values of every kind of container, between processes and while they migrate; a
// vector of numbers may travel separately from its message (serialize.hpp). The oracle: a value
// arrives as it was sent, checked member by member against its seed, and every chain ends.
#include "apps/protocol_fuzz/scenarios.hpp"

#include <atomic>
#include <map>
#include <numeric>
#include <optional>
#include <variant>

namespace tess::fuzz {
namespace {

struct Relay {
  Trial& trial;
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
  template <class Ar>
  void serialize(Ar& ar) {
    std::vector<double> doubled(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) doubled[i] = 2 * values[i];
    ar(doubled);
    values = std::move(doubled);
    for (double& one : values) one /= 2;
  }
};

struct Cargo {
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
  friend bool operator==(const Cargo&, const Cargo&) = default;

  static Cargo of(std::uint64_t seed) {
    Random random(mix(seed));
    Cargo cargo;
    cargo.seed = seed;
    cargo.plain = numbers(random());
    cargo.text.assign(random.below(60), 'x');
    cargo.nested.resize(random.below(4));
    for (auto& inner : cargo.nested) inner.assign(random.below(30), static_cast<int>(seed & 255U));
    for (int i = 0; i < 2; ++i) cargo.by_key[i] = numbers(random());
    if (random.chance(0.5)) cargo.perhaps.emplace(random.below(50), 1.5F);
    if (random.chance(0.5)) cargo.either = std::vector<std::byte>(random.below(99), std::byte{7});
    cargo.folded.values = numbers(random());
    cargo.shared = SharedArray<double>(numbers(random()));
    cargo.shared_by_key[1] = SharedArray<std::int32_t>(std::vector<std::int32_t>(9, 4));
    cargo.named.resize(random.below(3), {"a name", numbers(random())});
    return cargo;
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
    relay->trial.expect(shared.size() == 100 && shared[99] == 99, "a broadcast was garbled");
    ++relay->n_seen;
  }
  void hand_on(Cargo cargo, int left) {
    relay->trial.expect(cargo == Cargo::of(cargo.seed), "a value was garbled on its way");
    relay->trial.expect(seed_ == 0 || values_ == numbers(seed_), "a state was garbled on its way");
    Random random(mix(cargo.seed ^ static_cast<std::uint64_t>(left)));
    if (random.chance(0.2)) load(random() | 1U);
    if (random.chance(0.3)) migrate_to(any_pe(random));
    if (left == 0) {
      ++relay->n_ended;
      return;
    }
    const Index to{static_cast<int>(random.below(static_cast<std::uint64_t>(relay->n_elements)))};
    array()[to].send<&Carrier::hand_on>(random.chance(0.5) ? std::move(cargo) : Cargo::of(random()),
                                        left - 1);
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(seed_, values_);
  }

 private:
  std::uint64_t seed_ = 0;
  std::vector<double> values_;
};

}  // namespace

void payloads(Trial& trial) {
  Relay here{trial, trial.draw(1, 12), trial.draw(0, 12), trial.draw(1, 200)};
  relay = &here;
  const int n_chains = trial.draw(1, 6);
  const std::uint64_t seed = trial.random()();
  trial.run_clean([&] {
    const auto carriers = tess::create<Carrier>(range(here.n_elements));
    std::vector<double> counted(100);
    std::iota(counted.begin(), counted.end(), 0.0);
    carriers.broadcast<&Carrier::see>(SharedArray<double>(std::move(counted)));
    for (int i = 0; i < n_chains; ++i)
      carriers[{i % here.n_elements}].send<&Carrier::hand_on>(
          Cargo::of(mix(seed + static_cast<unsigned>(i))), here.n_hops);
  });
  trial.expect(here.n_ended == n_chains, here.n_ended.load(), " of ", n_chains, " chains ended");
  trial.expect(here.n_seen == here.n_elements, here.n_seen.load(), " elements saw the broadcast");
}

}  // namespace tess::fuzz
