// Step 9: a test. The simulated machine delivers messages in another order with each seed, so a
// program that relies on an order is found out. Two registers are written twice by one sender; the
// first keeps what arrived last, the second keeps the greatest version.
#include "runtime/more/testing.hpp"
#include "runtime/more/when.hpp"
#include "runtime/runtime.hpp"

struct Versioned {
  int version = 0, value = 0;
};

class Register : public tess::Chare<Register> {
 public:
  void write_latest(Versioned v) { kept_ = v; }
  void write_newest(Versioned v) {
    if (v.version > kept_.version) kept_ = v;
  }
  void read(tess::Callback<int> target) { target(kept_.value); }

 private:
  Versioned kept_;
};

template <auto write>
tess::Task write_twice(int& found) {
  const auto registers = tess::create<Register>(tess::range(4));
  co_await tess::epoch([&] {
    registers[{3}].send<write>(Versioned{1, 10});
    registers[{3}].send<write>(Versioned{2, 20});
  });
  tess::Future<int> value;
  registers[{3}].send<&Register::read>(value.callback());
  found = co_await value;
}

/// Runs the program with up to 1000 seeds; throws at the first with which the register ends wrong.
template <auto write>
void check_register() {
  tess::test::for_seeds(0, 1000, [](std::uint64_t seed) {
    int found = 0;
    const tess::test::Machine machine{.pes = 4, .seed = seed};
    machine.run([&]() -> tess::Task { return write_twice<write>(found); }).require_success();
    tess::test::expect(found == 20, "the register holds ", found);
  });
}

class Clerk : public tess::Chare<Clerk> {
 public:
  tess::TaskOf<int> answer() {  // after an hour of virtual time, which takes no real time
    co_await tess::sleep(std::chrono::hours(1));
    co_return 42;
  }
};

/// The clerk is in time for a limit of 61 minutes with every seed, and late for one of 59.
void check_deadline(std::chrono::minutes limit, bool is_in_time) {
  tess::test::for_seeds(0, 100, [=](std::uint64_t seed) {
    bool came = false;
    const tess::test::Machine machine{.pes = 4, .seed = seed};
    const auto ask = [&]() -> tess::Task {
      const auto clerks = tess::create<Clerk>(tess::range(4));
      try {
        came = co_await clerks[{2}].ask<&Clerk::answer>().within(limit) == 42;
      } catch (const tess::Error&) {  // no answer within the limit
      }
    };
    machine.run(ask).require_success();
    tess::test::expect(came == is_in_time, limit.count(), " minutes: ", came);
  });
}

int main() {
  check_deadline(std::chrono::minutes(61), true);
  check_deadline(std::chrono::minutes(59), false);
  tess::print("check_deadline passes\n");
  check_register<&Register::write_newest>();
  tess::print("write_newest passes\n");
  try {
    check_register<&Register::write_latest>();
  } catch (const tess::test::Failure& failure) {
    tess::print("write_latest: ", failure.what(), "\n");
  }
}
