// Step 9: a test. The simulated machine delivers messages in another order with each seed, so a
// program that relies on an order is found out. Two registers are written twice by one sender; the
// first keeps what arrived last, the second keeps the greatest version.
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

/// The seeds of 1 … 100 with which the register ends with another value than 20.
template <auto write>
std::vector<int> failing_seeds() {
  std::vector<int> failing;
  for (int seed = 1; seed <= 100; ++seed) {
    std::string program = "test", option = "--sim",
                machine = "pes=4,cost=100ns,seed=" + std::to_string(seed);
    std::array<char*, 3> line{program.data(), option.data(), machine.data()};
    int argc = 3;
    tess::Setup setup = tess::take_options(argc, line.data());
    int found = 0;
    const int code =
        tess::run(setup, [&found]() -> tess::Task { return write_twice<write>(found); });
    if (code != 0 || found != 20) failing.push_back(seed);
  }
  return failing;
}

int main() {
  const std::vector<int> latest = failing_seeds<&Register::write_latest>();
  const std::vector<int> newest = failing_seeds<&Register::write_newest>();
  tess::print("write_latest fails with ", latest.size(), " seeds of 100, the first is ",
              latest.empty() ? 0 : latest.front(), "\n");
  tess::print("write_newest fails with ", newest.size(), " seeds of 100\n");
  return newest.empty() ? 0 : 1;
}
