// Creation on demand from all PEs at once, and messages that arrive before their elements.
#include "tests/fuzz/protocols/scenarios.hpp"

#include <algorithm>
#include <functional>

namespace tess::fuzz {
namespace {

/// Counts deliveries by token, and lives by index.
struct Deliveries {
  std::vector<int> delivered;  // by token
  std::vector<int> lives;      // by number of the index
  std::vector<int> alive;

  void count(std::vector<int>& of, int number) {
    locked([&] { ++of.at(static_cast<std::size_t>(number)); });
  }
  void check_each_once() {
    for (std::size_t i = 0; i < delivered.size(); ++i)
      expect(delivered[i] == 1, "message ", i, " was delivered ", delivered[i], " times");
    for (std::size_t i = 0; i < lives.size(); ++i) {
      expect(lives[i] == 1, "index ", i, " had ", lives[i], " lives");
      expect(alive[i] == 1, "index ", i, " has ", alive[i], " elements");
    }
  }
};
Deliveries* deliveries = nullptr;

struct Part {
  std::string name;
  std::vector<std::int16_t> numbers;
  friend auto operator<=>(const Part&, const Part&) = default;
};

/// The index of a number, of each type that is used as one.
template <class Index>
Index index_of(int number) {
  if constexpr (std::is_same_v<Index, std::string>) {
    return text("element number ", number);
  } else if constexpr (std::is_same_v<Index, Part>) {
    return Part{text("part ", number % 3), {static_cast<std::int16_t>(number), 7}};
  } else {
    return Index{{number, -number, 0, 1, 2, 3}};
  }
}

struct Token {
  int token = 0;
  int index = 0;
};

/// An element that may move to a drawn PE after any message.
template <class Index>
class Demanded : public Chare<Demanded<Index>, Index> {
 public:
  Demanded() = default;
  explicit Demanded(Token token) { begin(token); }

  void count(Token token) {
    begin(token);
    deliveries->count(deliveries->delivered, token.token);
    Random random(mix(static_cast<std::uint64_t>(token.token) ^ 0x1234));
    if (random.chance(0.2)) move(random);
  }
  void appear() { deliveries->count(deliveries->alive, number_); }

  void serialize(auto& ar) { ar(number_); }

 private:
  void begin(Token token) {
    if (number_ < 0) {
      number_ = token.index;
      deliveries->count(deliveries->lives, number_);
    }
    expect(number_ == token.index, "a message to ", token.index, " met ", number_);
  }
  void move(Random& random) { this->migrate_to(any_pe(random)); }

  int number_ = -1;  // until the first message
};

enum class Way { here, home, mixed, first };

/// How Crowd::bring() creates an element: by an insertion (0 to 2), or by a message.
std::uint64_t way_of(std::uint64_t seed, int index) {
  return Random(mix(seed ^ static_cast<std::uint64_t>(index))).below(5);
}

template <class Index>
struct Burst {
  ArrayProxy<Demanded<Index>> array;
  std::uint64_t seed = 0;
  int n_indices = 0;
  Way way = Way::mixed;
};

/// On each PE: sends to all indices at once, in an order of its own.
template <class Index>
class Crowd : public Group<Crowd<Index>> {
 public:
  using Element = Demanded<Index>;

  void burst(Burst<Index> burst) {
    Random random(mix(burst.seed ^ static_cast<std::uint64_t>(this->pe().value)));
    for (const int i : shuffled(burst.n_indices, random)) {
      const Token token{this->pe().value * burst.n_indices + i, i};
      const auto element = burst.array[index_of<Index>(i)];
      const bool here = burst.way == Way::mixed ? random.chance(0.5) : burst.way == Way::here;
      if (burst.way == Way::first) {
        element.template send<&Element::count>(token);
      } else if (here) {
        element.template send_or_create_here<&Element::count>(token);
      } else {
        element.template send_or_create_home<&Element::count>(token);
      }
    }
  }

  /// One PE creates all elements, each in a random way, in a chain of messages.
  void bring(Burst<Index> burst, int next) {
    if (next == burst.n_indices) return;
    Random random(mix(burst.seed ^ static_cast<std::uint64_t>(next)));
    const Token token{this->group_size() * burst.n_indices + next, next};
    const auto element = burst.array[index_of<Index>(next)];
    switch (random.below(5)) {  // as way_of()
      case 0:
        element.insert(token);
        break;
      case 1:
        element.insert_on(any_pe(random), token);
        break;
      case 2:
        element.insert_if_absent(token);
        break;
      case 3:
        element.template send_or_create_here<&Element::count>(token);
        break;
      default:
        element.template send_or_create_home<&Element::count>(token);
    }
    if (const bool by_message = random.below(5) < 3; by_message) {
      this->group()[this->pe()].template send<&Crowd::bring>(burst, next + 1);
    } else {
      bring(burst, next + 1);
    }
  }

 private:
  [[nodiscard]] static int group_size() { return tess::n_pes(); }
  static std::vector<int> shuffled(int n, Random& random) {
    std::vector<int> order(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) order[static_cast<std::size_t>(i)] = i;
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    return order;
  }
};

// Outside of the templates: g++ 12 fails on a coroutine with an epoch in one.
using Code = std::function<void()>;
Task drive(Code begin, Code send, Code end) {
  begin();
  co_await epoch(send);
  end();
}

template <class Index>
class Scene {
 public:
  explicit Scene(Case& test) : test_(test) {
    deliveries = &deliveries_;
    const bool full = test.seed % 100 == 0 && test.on != On::threads;
    burst_.n_indices = full ? 1000 : test.draw(1, 60);
    burst_.seed = test.random();
    const auto n = static_cast<std::size_t>(burst_.n_indices);
    deliveries_.lives.assign(n, 0);
    deliveries_.alive.assign(n, 0);
  }

  void create() {
    burst_.way = static_cast<Way>(test_.draw(0, 2));
    deliveries_.delivered.assign(tokens(test_.machine.pes), 0);
    test_.run_clean(
        [this] { return drive([this] { begin(); }, [this] { send(); }, [this] { end(); }); });
    deliveries_.check_each_once();
  }

  void bring() {
    burst_.way = Way::first;
    deliveries_.delivered.assign(tokens(test_.machine.pes + 1), 0);
    from_ = PeId{test_.draw(0, test_.machine.pes - 1)};
    test_.run_clean(
        [this] { return drive([this] { begin(); }, [this] { send(); }, [this] { end(); }); });
    // An insertion carries a token, too, but delivers none.
    for (int i = 0; i < burst_.n_indices; ++i) {
      int& n = deliveries_.delivered[tokens(test_.machine.pes) + static_cast<std::size_t>(i)];
      const bool is_message = way_of(burst_.seed, i) >= 3;
      expect(n == (is_message ? 1 : 0), "message ", i, " of the creator was delivered ", n,
             " times");
      n = 1;
    }
    deliveries_.check_each_once();
  }

 private:
  [[nodiscard]] std::size_t tokens(int n_senders) const {
    return static_cast<std::size_t>(n_senders) * static_cast<std::size_t>(burst_.n_indices);
  }
  void send() {
    crowd_.template broadcast<&Crowd<Index>::burst>(burst_);
    if (burst_.way == Way::first) crowd_[from_].template send<&Crowd<Index>::bring>(burst_, 0);
  }
  void begin() {
    burst_.array = tess::create<Demanded<Index>>(sparse);
    crowd_ = tess::create<Crowd<Index>>(each_pe);
  }
  void end() { burst_.array.template broadcast<&Demanded<Index>::appear>(); }

  Case& test_;
  Deliveries deliveries_;
  Burst<Index> burst_;
  GroupProxy<Crowd<Index>> crowd_;
  PeId from_{};
};

}  // namespace

void create_at_once(Case& test) {
  switch (test.draw(0, 3)) {
    case 0:
      Scene<std::string>(test).create();
      break;
    case 1:
      Scene<Part>(test).create();
      break;
    default:
      Scene<Index6>(test).create();
  }
}

void message_first(Case& test) {
  if (test.draw(0, 2) == 0) {
    Scene<std::string>(test).bring();
  } else {
    Scene<Index6>(test).bring();
  }
}

}  // namespace tess::fuzz
