// Misuses, each of which must end the job with one clear line and an exit code other than 0; run by
// misuse.sh.
//
//     test_misuse NAME_OF_THE_MISUSE
#include "runtime/balance.hpp"
#include "runtime/more/index_map.hpp"
#include "runtime/more/section.hpp"
#include "runtime/more/when.hpp"
#include "runtime/runtime.hpp"

#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using tess::PeId;

class Member : public tess::Group<Member> {
 public:
  void nothing() {}
};

/// What a value is packed to and read from: reads a number less than it writes, or more.
template <int read_too_many>
struct Uneven {
  std::vector<int> values{1, 2, 3};
  template <class Ar>
  void serialize(Ar& ar) {
    int extra = 7;
    ar(values);
    if (Ar::is_reading == (read_too_many > 0)) ar(extra);
  }
  friend Uneven operator+(Uneven a, const Uneven& /*b*/) { return a; }
};
using Short = Uneven<0>;
using Long = Uneven<1>;

/// Throws what is no tess::Error where it is read.
struct Refused {
  int value = 3;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(value);
    if (Ar::is_reading) throw std::runtime_error("the value is refused");
  }
  friend Refused operator+(Refused a, const Refused& /*b*/) { return a; }
};

/// The same, of no std::exception.
struct Unclear {
  template <class Ar>
  void serialize(Ar& /*ar*/) {
    if (Ar::is_reading) throw 7;
  }
};

/// Throws where it is written.
struct Unwritten {
  template <class Ar>
  void serialize(Ar& /*ar*/) {
    if (!Ar::is_reading) throw std::runtime_error("the value stays here");
  }
};

/// A base class with a serialize() of its own, which knows nothing of what derives from it.
struct Shape {
  int n = 0;
  Shape() = default;
  Shape(const Shape&) = delete;
  Shape& operator=(const Shape&) = delete;
  virtual ~Shape() = default;
  void serialize(auto& ar) { ar(n); }
};
struct Circle : Shape {
  double radius = 1;
};

struct Scaled {
  int by = 1;
  int operator()(int a, int b) const { return by * (a + b); }
  friend bool operator==(const Scaled&, const Scaled&) = default;
};

class Block : public tess::Chare<Block, tess::Index1> {
 public:
  Block() = default;
  explicit Block(int order) {
    if (order == 1) throw std::runtime_error("the mould is broken");
    if (order == 2) TESS_CHECK(order == 0, "the mould is wrong");
  }
  void nothing() {}
  void end() { destroy(); }
  void answer(tess::Callback<int> target) { target(7); }
  void give(tess::Callback<int> target) { contribute(tess::sum, 1, target); }
  void give_to_some() { contribute(tess::sum, 1, array()[{index().x % 2}].target<&Block::take>()); }
  void give_different(tess::Callback<int> target) {
    if (index().x == 0) {
      contribute(tess::sum, 1, target);
    } else {
      contribute(tess::max, 1, target);
    }
  }
  void give_scaled(tess::Callback<int> target) { contribute(Scaled{index().x}, 1, target); }
  void take(int /*sum*/) {}
  void count(std::uint64_t /*n*/) {}
  void tell(tess::Callback<std::string> target) { target("the news"); }
  [[nodiscard]] std::string news() const { return "the news"; }
  void give_twice(tess::Callback<int> target) {
    target(1);
    target(2);
  }
  void report(tess::Callback<void> target) { contribute(target); }
  void draw(std::unique_ptr<Shape> /*shape*/) {}
  void move(PeId pe) { migrate_to(pe); }
  void serialize(auto& /*ar*/) {}
};

/// Moves before the result of its future is there.
class Hasty : public tess::Chare<Hasty> {
 public:
  void leave() {
    (void)result_.callback();
    migrate_to(PeId{1});
  }
  void use() { (void)result_.callback(); }
  void serialize(auto& /*ar*/) {}

 private:
  tess::Future<int> result_;
};
tess::Task future_after_move() {
  const auto all = tess::create<Hasty>(tess::range(1));
  co_await tess::epoch([&] { all[{0}].send<&Hasty::leave>(); });
  all[{0}].send<&Hasty::use>();
}

/// Keeps a future for its next entry method, and moves in between.
class Keeper : public tess::Chare<Keeper> {
 public:
  void begin(tess::ElementProxy<Block> block, std::chrono::nanoseconds delay) {
    block.send_after<&Block::answer>(delay, result_.callback());
  }
  void move() { migrate_to(PeId{tess::n_pes() - 1}); }
  tess::Task use() {
    const int result = co_await result_;
    tess::print("the result is ", result, "\n");
  }
  void serialize(auto& /*ar*/) {}

 private:
  tess::Future<int> result_;
};
/// It moves before the result is there, or after.
tess::Task keep_future(std::chrono::nanoseconds delay) {
  const auto block = tess::create<Block>(tess::range(1))[{0}];
  const auto keeper = tess::create<Keeper>(tess::range(1))[{0}];
  if (delay == std::chrono::nanoseconds(0)) {
    co_await tess::epoch([&] { keeper.send<&Keeper::begin>(block, delay); });
  } else {
    keeper.send<&Keeper::begin>(block, delay);
  }
  co_await tess::epoch([&] { keeper.send<&Keeper::move>(); });
  keeper.send<&Keeper::use>();
}

/// A map that does not ask how many PEs there are.
struct ToItsNumber {
  PeId operator()(const tess::Index1& index, std::int32_t /*n_pes*/) const { return {index.x}; }
};

/// Its place() is wrong.
template <int PeOfAll>
class Placed : public tess::Chare<Placed<PeOfAll>> {
 public:
  static PeId place(tess::Index1 /*index*/, std::int32_t /*n_pes*/) { return PeId{PeOfAll}; }
  void nothing() {}
};

/// A mean that refuses an empty list in its last step.
struct Mean {
  struct Part {
    double sum = 0;
    int n = 0;
  };
  [[nodiscard]] Part combine(Part a, const Part& b) const { return {a.sum + b.sum, a.n + b.n}; }
  [[nodiscard]] double finish(Part all) const {
    if (all.n == 0) throw std::runtime_error("the mean of no values");
    return all.sum / all.n;
  }
};

class Meter : public tess::Chare<Meter> {
 public:
  void give(tess::Callback<double> target) { contribute(Mean{}, Mean::Part{}, target); }
  void give_in_order(tess::Callback<double> target) {
    contribute(tess::in_order(Mean{}), Mean::Part{}, target);
  }
  void give_to(tess::SectionProxy<Meter> section, const tess::Callback<double>& target) {
    contribute(section, Mean{}, Mean::Part{}, target);
  }
};

/// Ends the run with an error before the result is there.
template <class T>
tess::Task await_result(tess::Future<T> result) {
  (void)co_await result;
}

auto meters() {
  return tess::create<Meter>(tess::range(3));
}
tess::Task mean_of_none_in_section() {
  const auto some = tess::create_section(meters(), {{0}, {2}});
  return await_result(some.reduce<&Meter::give_to>(some));
}

/// Sends from its destructor, which runs at the end of the run if the array is not destroyed.
class Parting : public tess::Chare<Parting> {
 public:
  Parting() = default;
  Parting(const Parting&) = delete;
  Parting& operator=(const Parting&) = delete;
  ~Parting() { tess::ArrayProxy<Block>(tess::CollectionId{77})[{0}].send<&Block::nothing>(); }
};

/// Contributes in its destructor.
class Leaver : public tess::Chare<Leaver> {
 public:
  Leaver() = default;
  explicit Leaver(tess::Callback<int> target) : target_(target) {}
  Leaver(const Leaver&) = delete;
  Leaver& operator=(const Leaver&) = delete;
  ~Leaver() { contribute(tess::sum, 1, target_); }

 private:
  tess::Callback<int> target_;
};

tess::Task contribute_at_the_end() {
  tess::Future<int> sum;
  const auto leavers = tess::create<Leaver>(tess::range(2), sum.callback());
  co_await tess::epoch([&] { leavers[{1}].destroy(); });
}

/// The operation of its reduction throws.
struct Torn {
  int operator()(int /*a*/, int /*b*/) const {
    tess::fail(tess::ErrorCode::bad_value, "the sum is torn");
  }
};
class Adder : public tess::Chare<Adder> {
 public:
  void add(tess::Callback<int> target) { contribute(Torn{}, 1, target); }
};
tess::Task add_and_catch() {
  tess::Future<int> sum;
  const auto adders = tess::create<Adder>(tess::range(2));
  for (int x = 0; x < 2; ++x) {
    try {
      co_await adders[{x}].ask<&Adder::add>(sum.callback());
    } catch (const tess::Error&) {
    }
  }
  (void)co_await sum;
}

tess::Task sleep_twice() {
  tess::Sleep sleep = tess::sleep(std::chrono::milliseconds(1));
  struct Sleeper {
    static tess::Task wait(tess::Sleep& on) { co_await on; }
  };
  tess::Task first = Sleeper::wait(sleep), second = Sleeper::wait(sleep);
  co_await first;
  co_await second;
}

/// Reads, where it arrives, another number of bytes than it wrote.
template <class Value>
class Carrier : public tess::Chare<Carrier<Value>, tess::Index1> {
 public:
  void go() { this->migrate_to(PeId{tess::n_pes() - 1}); }
  void hear(Value /*value*/) {}
  void give(tess::Callback<Value> target) { this->contribute(tess::sum, Value{}, target); }
  void serialize(auto& ar) { ar(value_); }

 private:
  Value value_;
};

template <class Value>
void carry() {
  tess::create<Carrier<Value>>(tess::range(1))[{0}].template send<&Carrier<Value>::go>();
}
template <class Value>
void hear() {
  const std::int32_t n = tess::n_pes();
  const auto carriers = tess::create<Carrier<Value>>(tess::range(n));
  carriers[{n - 1}].template send<&Carrier<Value>::hear>(Value{});
}
template <class Value>
void hear_all() {
  const auto carriers = tess::create<Carrier<Value>>(tess::range(tess::n_pes()));
  carriers.template broadcast<&Carrier<Value>::hear>(Value{});
}
/// The message counts as sent in the epoch that keeps the exception.
template <class Value>
tess::Task hear_in_epoch() {
  co_await tess::epoch(&hear<Value>);
}
template <class Value>
void hear_and_catch() {
  try {
    hear<Value>();
  } catch (const std::exception&) {
    tess::print("caught\n");
  }
}
template <class Value>
tess::Task sum_all() {
  return await_result(tess::create<Carrier<Value>>(tess::range(tess::n_pes()))
                          .template reduce<&Carrier<Value>::give>());
}

/// Contributes to a section of which it may be no member.
class Stranger : public tess::Chare<Stranger> {
 public:
  void vote(tess::SectionProxy<Stranger> section, const tess::Callback<int>& target) {
    contribute(section, tess::sum, index().x, target);
  }
  void serialize(auto& /*ar*/) {}
};

/// Of a section with an element that never comes.
tess::Task sum_with_a_missing_member() {
  const auto all = tess::create<Stranger>(tess::range(3));
  const auto section = tess::create_section(all, {{0}, {6}});
  tess::Future<int> sum;
  all[{0}].send<&Stranger::vote>(section, sum.callback());
  return await_result(std::move(sum));
}

/// Of a section of another array of its class.
tess::Task vote_elsewhere() {
  const auto all = tess::create<Stranger>(tess::range(2)),
             others = tess::create<Stranger>(tess::range(2));
  tess::Future<int> sum;
  all[{1}].send<&Stranger::vote>(tess::create_section(others, {{0}, {1}}), sum.callback());
  return await_result(std::move(sum));
}

/// The epoch waits for the elements of the section that is created in it.
tess::Task section_in_an_epoch() {
  const auto all = tess::create<Stranger>(tess::range(3));
  co_await tess::epoch([all] { (void)tess::create_section(all, {{0}, {6}}); });
}

/// Of the section {0, 2, 4}. A result would end the run without an error.
tess::Task votes_of(std::vector<int> voters) {
  const auto all = tess::create<Stranger>(tess::range(12));
  const std::vector<tess::Index1> members{{0}, {2}, {4}};
  const auto section = tess::create_section(all, members);
  tess::Future<int> sum;
  for (const int voter : voters) all[{voter}].send<&Stranger::vote>(section, sum.callback());
  (void)co_await sum;
  tess::exit(0);
}

tess::Task await_every() {
  tess::Future<void> third;
  int n = 0;
  (void)tess::every(std::chrono::milliseconds(50), [&] {
    if (++n == 3) third.callback()();
  });
  co_await third;
}

tess::Task any_of_none() {
  (void)co_await tess::when_any(std::vector<tess::Future<int>>());
}

tess::Task use_after_end() {
  const auto blocks = tess::create<Block>(tess::range(3));
  co_await tess::epoch([&] { blocks.destroy(); });
  (void)blocks.size();
}

tess::Task use_member_after_end() {
  const auto members = tess::create<Member>(tess::each_pe);
  co_await tess::epoch([&] { members.destroy(); });
  members.local().nothing();
}

tess::Task count_down(int n) {
  if (n > 0) co_await count_down(n - 1);
}
tess::Task future_awaited_twice() {
  const auto all = tess::create<Block>(tess::range(3));
  tess::Future<std::string> news;
  all[{1}].send<&Block::tell>(news.callback());
  (void)co_await news;
  (void)co_await news;
}

tess::Task wait_for(tess::Future<int>& number) {
  (void)co_await number;
}
tess::Task wait_for(tess::Task& task) {
  co_await task;
}

tess::Task task_awaited_at_once() {
  tess::Future<int> number;
  tess::Task task = wait_for(number);
  const tess::Task first = wait_for(task);
  co_await wait_for(task);
}

tess::TaskOf<std::string> make_news() {
  co_return "news";
}
tess::Task value_awaited_twice() {
  auto news = make_news();
  (void)co_await news;
  (void)co_await news;
}

tess::Task ask_awaited_twice() {
  const auto all = tess::create<Block>(tess::range(3));
  auto news = all[{1}].ask<&Block::news>();
  (void)co_await news;
  (void)co_await news;
}

tess::Task future_given_two() {
  const auto all = tess::create<Block>(tess::range(3));
  tess::Future<int> number;
  co_await tess::epoch([&] { all[{1}].send<&Block::give_twice>(number.callback()); });
}

/// To the last element, which is in the last process.
void draw_circle() {
  const std::int32_t n = tess::n_pes();
  tess::create<Block>(tess::range(n))[{n - 1}].send<&Block::draw>(std::make_unique<Circle>());
}

tess::Task balance_after_end() {
  const auto blocks = tess::create<Block>(tess::range(3));
  co_await tess::epoch([&] { blocks.destroy(); });
  (void)tess::start_balancing(blocks);
}

void run_again() {
  std::string name = "inner", pes = "--pes=1";
  std::vector<char*> arguments{name.data(), pes.data(), nullptr};
  (void)tess::run(2, arguments.data(), [] {});
}

/// A proxy of an earlier run.
void send_to_the_past() {
  tess::ArrayProxy<Block>(tess::CollectionId{std::uint64_t{77} << 24U})[{0}]
      .send<&Block::nothing>();
}

/// Rounds of which the next begins before the result is known. Element 0 contributes after a
/// further message; element 1 is created meanwhile and contributes at once.
class Overlap : public tess::Chare<Overlap> {
 public:
  struct Round {
    int number = 0;
  };
  tess::Task begin(Round round) {
    ++n_begun_;
    if (index().x == 0) (void)co_await gates_.take(round.number);
    contribute(tess::max, round.number, array()[{0}].target<&Overlap::hear>());
  }
  void open(Round round) { gates_.put(round); }
  void hear(int round) { tess::print("the result is that of round ", round, "\n"); }
  [[nodiscard]] int n_begun() const { return n_begun_; }

 private:
  tess::Mailbox<&Round::number> gates_;
  int n_begun_ = 0;
};

tess::Task insert_between_rounds() {
  const auto all = tess::create<Overlap>(tess::sparse);
  for (int i = 0; i < 2; ++i) {
    co_await tess::epoch([&] { all[{i}].insert_on(PeId{0}); });
    all.broadcast<&Overlap::begin>(Overlap::Round{i});
    while (co_await all[{i}].ask<&Overlap::n_begun>() == 0) {
    }
  }
  for (int i = 0; i < 2; ++i) all[{0}].send<&Overlap::open>(Overlap::Round{i});
}

/// Elements that the main program calls to contribute, without waiting for a result.
class Driven : public tess::Chare<Driven> {
 public:
  void give(tess::Callback<int> target) { contribute(tess::sum, 1, target); }
  void give_to(tess::RoundId round) {
    contribute(round, tess::sum, 1, array()[{0}].target<&Driven::hear>());
  }
  void hear(int sum) { tess::print("the result is ", sum, "\n"); }
  void give_and_end() {
    give_to({1});
    destroy();
  }
};

void insert_unawaited() {
  const auto all = tess::create<Driven>(tess::range(2));
  const auto target = all[{0}].target<&Driven::hear>();
  for (int round = 0; round < 8; ++round)
    for (int i = 0; i < 2; ++i) all[{i}].send<&Driven::give>(target);
  all[{2}].insert();
  all[{2}].send<&Driven::give>(target);
}
tess::Task join_too_late() {
  const auto all = tess::create<Driven>(tess::range(1));
  co_await tess::epoch([&] { all[{0}].send<&Driven::give_to>(tess::RoundId{0}); });
  all[{1}].insert(tess::RoundId{0});
}

auto blocks() {
  return tess::create<Block>(tess::range(3));
}
tess::Task insert_in_epoch() {
  co_await tess::epoch([] { blocks()[{7}].insert(1); });
}
tess::Task create_in_epoch() {
  co_await tess::epoch([] {
    tess::create<Block>(tess::mapped(tess::range(3), [](tess::Index1, std::int32_t) -> tess::PeId {
      throw std::runtime_error("the map is torn");
    }));
  });
}

const std::map<std::string, std::function<void()>> misuses{
    {"member_99", [] { tess::create<Member>(tess::each_pe)[PeId{99}].send<&Member::nothing>(); }},
    {"member_-1", [] { tess::create<Member>(tess::each_pe)[PeId{-1}].send<&Member::nothing>(); }},
    {"insert_on_77", [] { blocks()[{3}].insert_on(PeId{77}); }},
    {"map_too_far", [] { tess::create<Block>(tess::mapped(tess::range(4), ToItsNumber{})); }},
    {"migrate_to_-3", [] { blocks()[{0}].migrate_to(PeId{-3}); }},
    {"move_to_55", [] { blocks()[{1}].send<&Block::move>(PeId{55}); }},
    {"empty_callback", [] { blocks()[{2}].send<&Block::answer>(tess::Callback<int>()); }},
    {"empty_target", [] { blocks().broadcast<&Block::give>(tess::Callback<int>()); }},
    {"different_targets", [] { blocks().broadcast<&Block::give_to_some>(); }},
    {"insert_between_rounds", &insert_between_rounds},
    {"insert_unawaited", &insert_unawaited},
    {"join_too_late", &join_too_late},
    {"join_before_all",
     [] { tess::create<Driven>(tess::range(1))[{1}].insert(tess::RoundId{-1}); }},
    {"round_twice",
     [] {
       const auto all = tess::create<Driven>(tess::range(2));
       for (int i = 0; i < 2; ++i) all[{1}].send<&Driven::give_to>(tess::RoundId{0});
     }},
    {"round_far_ahead",
     [] { tess::create<Driven>(tess::range(2))[{1}].send<&Driven::give_to>(tess::RoundId{64}); }},
    {"end_in_a_gap",
     [] { tess::create<Driven>(tess::range(2))[{1}].send<&Driven::give_and_end>(); }},
    {"different_operations", [] { return await_result(blocks().reduce<&Block::give_scaled>()); }},
    {"any_of_none", &any_of_none},
    {"await_every", &await_every},
    {"different_values", [] { return await_result(blocks().reduce<&Block::give_different>()); }},
    {"empty_proxy", [] { tess::ElementProxy<Block>().send<&Block::nothing>(); }},
    {"empty_array", [] { tess::ArrayProxy<Block>().broadcast<&Block::nothing>(); }},
    {"index_of_64_bits", [] { blocks()[std::int64_t{1} << 32U].send<&Block::nothing>(); }},
    {"empty_array_target",
     [] {
       blocks().broadcast<&Block::report>(tess::ArrayProxy<Block>().target<&Block::nothing>());
     }},
    {"empty_array_size", [] { (void)tess::ArrayProxy<Block>().size(); }},
    {"empty_array_ends", [] { tess::ArrayProxy<Block>().destroy(); }},
    {"empty_group", [] { tess::GroupProxy<Member>().broadcast<&Member::nothing>(); }},
    {"empty_group_local", [] { tess::GroupProxy<Member>().local().nothing(); }},
    {"future_awaited_twice", &future_awaited_twice},
    {"nested_tasks", [] { return count_down(1'000'000); }},
    {"task_awaited_at_once", &task_awaited_at_once},
    {"value_awaited_twice", &value_awaited_twice},
    {"ask_awaited_twice", &ask_awaited_twice},
    {"future_after_move", &future_after_move},
    {"future_left_early", [] { return keep_future(std::chrono::milliseconds(200)); }},
    {"future_left_late", [] { return keep_future(std::chrono::nanoseconds(0)); }},
    {"future_given_two", &future_given_two},
    {"derived_in_a_pointer", &draw_circle},
    {"negative_argument", [] { blocks()[{0}].send<&Block::count>(-1); }},
    {"negative_later",
     [] { (void)blocks()[{0}].send_after<&Block::count>(std::chrono::milliseconds(1), -1); }},
    {"negative_ask", [] { (void)blocks()[{0}].ask<&Block::count>(-1); }},
    {"exit_-1", [] { tess::exit(-1); }},
    {"exit_256", [] { tess::exit(256); }},
    {"throw_inserted", [] { blocks()[{7}].insert(1); }},
    {"throw_in_epoch", &insert_in_epoch},
    {"throw_caught",
     [] {
       try {
         blocks()[{7}].insert(1);
       } catch (const std::exception&) {
       }
     }},
    {"map_throws_in_epoch", &create_in_epoch},
    {"throw_initial", [] { tess::create<Block>(tess::range(1), 1); }},
    {"check_inserted", [] { blocks()[{7}].insert_on(PeId{0}, 2); }},
    {"place_77", [] { tess::create<Placed<77>>(tess::sparse)[{4}].insert(); }},
    {"place_-2", [] { tess::create<Placed<-2>>(tess::range(3)); }},
    {"section_twice",
     [] {
       (void)tess::create_section(blocks(), {{0}, {2}, {0}});
     }},
    {"section_empty", [] { tess::SectionProxy<Block>().broadcast<&Block::nothing>(); }},
    {"section_empty_ends", [] { tess::SectionProxy<Block>().destroy(); }},
    {"section_without_element", &sum_with_a_missing_member},
    {"section_in_an_epoch", &section_in_an_epoch},
    {"section_of_another", &vote_elsewhere},
    {"short_element", &carry<Short>},
    {"long_element", &carry<Long>},
    {"short_argument", &hear<Short>},
    {"long_argument", &hear<Long>},
    {"short_broadcast", &hear_all<Short>},
    {"long_broadcast", &hear_all<Long>},
    {"short_sum", &sum_all<Short>},
    {"refused_element", &carry<Refused>},
    {"refused_argument", &hear<Refused>},
    {"unclear_argument", &hear<Unclear>},
    {"unwritten_argument", &hear_in_epoch<Unwritten>},
    {"unwritten_element", &carry<Unwritten>},
    {"unwritten_broadcast", &hear_all<Unwritten>},
    {"unwritten_and_caught", &hear_and_catch<Unwritten>},
    {"refused_broadcast", &hear_all<Refused>},
    {"refused_sum", &sum_all<Refused>},
    {"long_sum", &sum_all<Long>},
    {"sum_of_none",
     [] { return await_result(tess::create<Block>(tess::sparse).reduce<&Block::give>()); }},
    {"sum_of_empty_section",
     [] { return await_result(tess::create_section(blocks(), {}).reduce<&Block::give>()); }},
    {"mean_of_none", [] { return await_result(meters().reduce<&Meter::give>()); }},
    {"ordered_mean_of_none", [] { return await_result(meters().reduce<&Meter::give_in_order>()); }},
    {"section_mean_of_none", &mean_of_none_in_section},
    {"stranger_votes",
     [] {
       return votes_of({0, 2, 7});
     }},
    {"strangers_vote",
     [] {
       return votes_of({7, 8, 9, 0, 2});
     }},
    {"destructor_contributes", &contribute_at_the_end},
    {"torn_sum", &add_and_catch},
    {"sleep_twice", &sleep_twice},
    {"work_of_the_past", [] { (void)tess::charge(std::chrono::nanoseconds(-1)); }},
    {"destructor_sends", [] { tess::create<Parting>(tess::range(3)); }},
    {"array_not_known",
     [] {
       const tess::ArrayProxy<Block> early(tess::CollectionId{99});
       (void)early.size();
     }},
    {"group_not_known",
     [] {
       const tess::GroupProxy<Member> early(tess::CollectionId{99});
       early.local().nothing();
     }},
    {"array_after_end", &use_after_end},
    {"proxy_of_the_past", &send_to_the_past},
    {"run_in_a_run", &run_again},
    {"setup_again", [] {}},
    {"balance_after_end", &balance_after_end},
    {"group_after_end", &use_member_after_end},
};

int misuse(int argc, char** argv) {
  tess::Setup setup = tess::take_options(argc, argv);
  const auto at = misuses.find(argc > 1 ? argv[1] : "");
  if (at == misuses.end()) {
    for (const auto& [name, function] : misuses) tess::print(name, "\n");
    return 0;
  }
  const int code = tess::run(setup, at->second);
  return at->first == "setup_again" ? tess::run(setup, [] {}) : code;
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] { return misuse(argc, argv); });
}
