// Arrays and groups that several PEs end at once, while they are being created: the ends cross each
// other and the creation. The oracle: all PEs have met each of them, all have ended, and nothing is
// left.
#include "tests/fuzz/protocols/scenarios.hpp"

#include <algorithm>
#include <atomic>

namespace tess::fuzz {
namespace {

std::atomic<std::int64_t> n_alive = 0;  // in this process

class Alive {
 public:
  Alive() { ++n_alive; }
  Alive(const Alive&) = delete;
  Alive& operator=(const Alive&) = delete;
  ~Alive() { --n_alive; }
};

class Transient : public Chare<Transient, Index1> {
 public:
  void serialize(auto&) {}

 private:
  Alive alive_;
};

class TransientMember : public Group<TransientMember> {
 private:
  Alive alive_;
};

struct Collections {
  ArrayProxy<Transient> array;
  GroupProxy<TransientMember> group;

  void end() const {
    array.destroy();
    group.destroy();
  }
  void serialize(auto& ar) { ar(array, group); }
};

/// Some three PEs do, of many: each of the others may end what they create.
bool creates(std::uint64_t seed, std::int32_t pe) {
  return Random(mix(seed) + static_cast<std::uint64_t>(pe)).chance(std::min(0.4, 3.0 / n_pes()));
}

class Ender : public Group<Ender> {
 public:
  void create_some(std::uint64_t seed) {
    if (!creates(seed, pe().value)) return;
    Random random(mix(seed ^ static_cast<std::uint64_t>(pe().value + 1)));
    const Collections made{
        random.chance(0.5)
            ? create<Transient>(range(1 + static_cast<std::int32_t>(random.below(50))))
            : create<Transient>(sparse),
        create<TransientMember>(each_pe)};
    group().broadcast<&Ender::end_some>(made, pe(), random());
    if (random.chance(0.3)) made.end();
  }
  /// Its creator, at least, ends it.
  void end_some(Collections made, PeId creator, std::uint64_t seed) {
    met_.push_back(made);
    Random random(mix(seed ^ static_cast<std::uint64_t>(pe().value)));
    if (pe() == creator || random.chance(0.3)) made.end();
  }
  void count(Callback<std::int64_t> n_met, Callback<std::int64_t> n_left) {
    contribute(sum, static_cast<std::int64_t>(met_.size()), std::move(n_met));
    const bool first = tess::machine().is_first_of_process(pe());
    std::int64_t left = first ? n_alive.load() : 0;
    for (const Collections& one : met_)
      left += (one.array.ended() ? 0 : 1) + (one.group.local_or_null() == nullptr ? 0 : 1);
    met_.clear();
    contribute(sum, left, std::move(n_left));
  }

 private:
  std::vector<Collections> met_;
};

Task create_and_end(std::uint64_t of_case, int n_rounds) {
  const auto enders = create<Ender>(each_pe);
  for (int round = 0; round < n_rounds; ++round) {
    const std::uint64_t seed = mix(of_case) + static_cast<std::uint64_t>(round);
    co_await epoch([&] { enders.broadcast<&Ender::create_some>(seed); });
    Future<std::int64_t> met, left;
    enders.broadcast<&Ender::count>(met.callback(), left.callback());
    std::int64_t n_made = 0;
    for (std::int32_t pe = 0; pe < tess::n_pes(); ++pe) n_made += creates(seed, pe) ? 1 : 0;
    const std::int64_t n_met = co_await met, n_left = co_await left;
    expect(n_met == n_made * tess::n_pes(), tess::n_pes(), " PEs have met ", n_met,
           " collections, of ", n_made);
    expect(n_left == 0, n_left, " members or collections are left");
  }
}

}  // namespace

void ends_at_once(Case& test) {
  const int n_rounds = test.draw(1, 10);
  test.run_clean([&] { return create_and_end(test.seed, n_rounds); });
}

}  // namespace tess::fuzz
