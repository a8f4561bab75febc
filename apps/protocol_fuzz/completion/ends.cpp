// Runs that end with an error and must report the reason: deadlocks and exceptions of each kind,
// and messages to destroyed elements.
#include "apps/protocol_fuzz/scenarios.hpp"

#include <stdexcept>

namespace tess::fuzz {
namespace {

struct Page {
  int key = 0;
};

/// An element that can get stuck, fail and end in every way.
class Patient : public Chare<Patient, Index1> {
 public:
  Patient() = default;
  explicit Patient(int ailment) {
    if (ailment == 1) throw std::runtime_error("the fever of a constructor");
  }

  void nothing() {}
  void end() { destroy(); }
  Task read() { (void)co_await pages_.take(7); }
  Task read_inside() {
    co_await epoch([this] { array()[index()].send<&Patient::read>(); });
  }
  void give(int n) {
    if (index().x != 0) contribute(sum, n, array()[{0}].target<&Patient::given>());
  }
  void given(int /*n*/) {}

  void fail() { throw std::runtime_error("the fever of an entry method"); }
  void fail_in(int which) {
    if (index().x == which) fail();
  }
  Task fail_later() {
    pages_.put(Page{index().x});
    array()[index()].send<&Patient::put_later>();
    (void)co_await pages_.take(index().x);
    (void)co_await pages_.take(7);
    throw std::runtime_error("the fever of a coroutine");
  }
  void put_later() { pages_.put(Page{7}); }
  Task fail_deep() {
    try {
      co_await deep();
    } catch (const std::runtime_error&) {
      ++n_caught_;
    }
    co_await deep();
  }
  Task fail_in_epoch() {
    co_await epoch([this] {
      array()[index()].send<&Patient::nothing>();
      throw std::runtime_error("the fever of an epoch's body");
    });
  }
  void bad_input() { tess::fail(ErrorCode::bad_value, "the dose is -1; give a positive one"); }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(n_caught_, pages_);
  }

 private:
  Task deep() {
    array()[index()].send<&Patient::put_later>();
    (void)co_await pages_.take(7);
    throw std::runtime_error("the fever of a task");
  }

  int n_caught_ = 0;
  Mailbox<&Page::key> pages_;
};

/// A run is to end with this code and name these things.
void expect_end(Trial& trial, const Ending& ending, int code,
                std::initializer_list<std::string> names) {
  trial.expect(ending.exit_code == code, "exit code ", ending.exit_code, " not ", code, ": ",
               ending.report);
  for (const std::string& name : names)
    trial.expect(ending.report.find(name) != std::string::npos, "the report does not name ", name,
                 ": ", ending.report);
}

}  // namespace

void deadlocks(Trial& trial) {
  const int n = trial.draw(2, 9), i = trial.draw(0, n - 1);
  const auto patients = [n] { return tess::create<Patient>(range(n)); };
  const std::string element = text("Patient[", i, "]");
  switch (trial.draw(0, 4)) {
    case 0: {
      const Ending ending = trial.run([&] { patients()[{i}].send<&Patient::read>(); });
      expect_end(trial, ending, 1, {"deadlock", element, "Patient::read", "key 7"});
      break;
    }
    case 1: {
      const Ending ending = trial.run([&] { patients()[{n + i}].send<&Patient::nothing>(); });
      expect_end(trial, ending, 1,
                 {"deadlock", text("Patient[", n + i, "]"), "Patient::nothing", "not exist"});
      break;
    }
    case 2: {
      const Ending ending = trial.run([&] { patients().broadcast<&Patient::give>(1); });
      expect_end(trial, ending, 1, {"deadlock", "reduction 0", "contribution", "Patient[0]"});
      break;
    }
    case 3: {
      const Ending ending = trial.run([&] { patients()[{i}].send<&Patient::read_inside>(); });
      expect_end(trial, ending, 1,
                 {"deadlock", element, "Patient::read_inside", "epoch", "Patient::read"});
      break;
    }
    default: {
      const Ending ending = trial.run([&] {
        const ArrayProxy<Patient> nowhere(CollectionId{0x5000000});
        nowhere[{i}].send<&Patient::nothing>();
      });
      expect_end(trial, ending, 1, {"deadlock", "is not known there"});
    }
  }
}

void exceptions(Trial& trial) {
  const int n = trial.draw(1, 9), i = trial.draw(0, n - 1);
  const std::string element = text("Patient[", i, "]");
  const auto run = [&](auto&& send) {
    return trial.run([&] {
      const auto patients = tess::create<Patient>(range(n));
      send(patients, patients[{i}]);
    });
  };
  switch (trial.draw(0, 7)) {
    case 0:
      expect_end(trial, run([](auto&, auto patient) { patient.template send<&Patient::fail>(); }),
                 1, {"the fever of an entry method", element, "Patient::fail", "on PE"});
      break;
    case 1:
      expect_end(trial, run([i](auto& patients, auto) {
                   patients.template broadcast<&Patient::fail_in>(i);
                 }),
                 1, {"the fever of an entry method", element, "Patient::fail_in", "on PE"});
      break;
    case 2:
      expect_end(trial,
                 run([](auto&, auto patient) { patient.template send<&Patient::fail_later>(); }), 1,
                 {"the fever of a coroutine", element, "Patient::fail_later", "on PE"});
      break;
    case 3:
      expect_end(trial,
                 run([](auto&, auto patient) { patient.template send<&Patient::fail_deep>(); }), 1,
                 {"the fever of a task", element, "Patient::fail_deep", "on PE"});
      break;
    case 4:
      expect_end(trial,
                 run([](auto&, auto patient) { patient.template send<&Patient::fail_in_epoch>(); }),
                 1, {"the fever of an epoch's body", element, "Patient::fail_in_epoch", "on PE"});
      break;
    case 5:
      expect_end(trial,
                 run([](auto&, auto patient) { patient.template send<&Patient::bad_input>(); }), 2,
                 {"error: the dose is -1; give a positive one"});
      break;
    case 6:
      expect_end(trial, run([n](auto& patients, auto) { patients[{n}].insert(1); }), 1,
                 {"the fever of a constructor", "on PE"});
      break;
    default: {
      const Ending ending =
          trial.run([] { throw std::runtime_error("the fever of the main program"); });
      expect_end(trial, ending, 1, {"the fever of the main program", "on PE 0"});
    }
  }
}

namespace {
Task kill_and_send(int n, int n_messages) {
  const auto patients = tess::create<Patient>(range(n));
  co_await epoch([&] { patients.broadcast<&Patient::end>(); });
  co_await epoch([&] {
    for (int k = 0; k < n_messages; ++k) patients[{k % n}].send<&Patient::nothing>();
  });
  for (int i = 0; i < n; ++i) patients[{i}].insert();
  co_await epoch([&] {
    for (int i = 0; i < n; ++i) patients[{i}].send<&Patient::nothing>();
  });
}
}  // namespace

void dead_letters(Trial& trial) {
  const int n = trial.draw(1, 9), n_messages = trial.draw(0, 20);
  const Ending ending = trial.run([&]() -> Task { return kill_and_send(n, n_messages); });
  trial.expect(ending.exit_code == 0, "exit code ", ending.exit_code, ": ", ending.report);
  // A message that overtakes the insertion is a dead letter, too: at least n_messages, at most n
  // more.
  int n_dead = 0;
  if (const std::size_t at = ending.report.find("tessera: "); at != std::string::npos)
    n_dead = std::atoi(ending.report.c_str() + at + 9);
  trial.expect(n_dead >= n_messages && n_dead <= n_messages + n, n_dead, " dead of ", n_messages);
}

}  // namespace tess::fuzz
