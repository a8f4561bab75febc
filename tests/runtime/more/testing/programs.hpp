// Programs with a planted error for the tests of runtime/more/testing.hpp, and correct ones.
#pragma once

#include "runtime/more/testing.hpp"
#include "runtime/runtime.hpp"

#include <vector>

namespace tess::test::planted {

struct Versioned {
  int version = 0, value = 0;
};

/// Two writes of one sender, in any order.
class Register : public Chare<Register, Index1> {
 public:
  void write_latest(Versioned v) { kept_ = v; }  // planted: trusts the order
  void write_newest(Versioned v) {
    if (v.version > kept_.version) kept_ = v;
  }
  void read(Callback<int> target) { target(kept_.value); }
  void serialize(auto& ar) { ar(kept_.version, kept_.value); }

 private:
  Versioned kept_;
};

template <auto write>
Task write_twice(int& found) {
  const auto registers = create<Register>(range(4));
  co_await epoch([&] {
    registers[{3}].send<write>(Versioned{1, 10});
    registers[{3}].send<write>(Versioned{2, 20});
  });
  Future<int> value;
  registers[{3}].send<&Register::read>(value.callback());
  found = co_await value;
}

/// The program of a seed; throws if another value than 20 is found.
template <auto write>
void run_register(std::uint64_t seed) {
  int found = 0;
  const Machine machine{.pes = 4, .seed = seed};
  machine.run([&]() -> Task { return write_twice<write>(found); }).require_success();
  expect(found == 20, "the register holds ", found);
}

/// Elements that report to a root, which numbers them as they come.
class Reporter : public Chare<Reporter, Index1> {
 public:
  void report() {
    array()[{0}].send<&Reporter::collect>(index().x);
    ++n_calls_;
  }
  void collect(int x) { order_.push_back(x); }
  void give(Callback<std::vector<int>> target) { target(order_); }
  void count(Callback<int> target) { contribute(sum, n_calls_, std::move(target)); }
  void serialize(auto& ar) {
    ar(order_);  // planted: n_calls_ is forgotten
  }

 private:
  std::vector<int> order_;
  int n_calls_ = 0;
};

constexpr int n_reporters = 4, n_rounds = 3;

/// Planted: reports are taken to arrive in the order of the elements, one per PE.
inline Task collect_in_order(std::vector<int>& order) {
  const auto all = create<Reporter>(range(n_reporters));
  co_await epoch([&] {
    for (int x = 0; x < n_reporters; ++x) all[{x}].send<&Reporter::report>();
  });
  Future<std::vector<int>> given;
  all[{0}].send<&Reporter::give>(given.callback());
  order = co_await given;
}

inline Task count_calls(int& n) {
  const auto all = create<Reporter>(range(n_reporters));
  for (int round = 0; round < n_rounds; ++round)
    co_await epoch([&] { all.broadcast<&Reporter::report>(); });
  n = co_await all.reduce<&Reporter::count>();
}

/// Keeps the address of a neighbour that may migrate.
class Holder : public Chare<Holder, Index1> {
 public:
  void look() {
    for (int x = 0; x < array().size(); ++x)
      if (Holder* other = array().local({x}); other != nullptr && x != index().x) held_ = other;
  }
  void use() { TESS_CHECK(held_ == nullptr || is_here(held_), "a neighbour has left"); }
  void serialize(auto& /*ar*/) { held_ = nullptr; }

 private:
  [[nodiscard]] bool is_here(const Holder* one) const {
    for (int x = 0; x < array().size(); ++x)
      if (array().local({x}) == one) return true;
    return false;
  }
  Holder* held_ = nullptr;
};

/// Planted: an element is used after it has migrated.
inline Task hold(bool& done) {
  const auto all = create<Holder>(range(6));
  co_await epoch([&] { all.broadcast<&Holder::look>(); });
  co_await epoch([&] { all.broadcast<&Holder::use>(); });
  done = true;
}

/// Sends a message to itself for ever.
class Spinner : public Chare<Spinner, Index1> {
 public:
  void spin() { array()[index()].send<&Spinner::spin>(); }
  void serialize(auto& /*ar*/) {}
};

}  // namespace tess::test::planted
