// Runs that end with an error and must report the reason: deadlocks and exceptions of each kind,
// and messages to destroyed elements.
#include "tests/fuzz/protocols/scenarios.hpp"

#include <stdexcept>

namespace tess::fuzz {
namespace {

struct Page {
  int key = 0;
};

/// An element that can get stuck, fail and end in every way.
class FailingElement : public Chare<FailingElement, Index1> {
 public:
  FailingElement() = default;
  explicit FailingElement(int kind) {
    if (kind == 1) throw std::runtime_error("the error of a constructor");
  }

  void nothing() {}
  void end() { destroy(); }
  Task read() { (void)co_await pages_.take(7); }
  Task read_inside() {
    co_await epoch([this] { array()[index()].send<&FailingElement::read>(); });
  }
  void give(int n) {
    if (index().x != 0) contribute(sum, n, array()[{0}].target<&FailingElement::given>());
  }
  void given(int /*n*/) {}

  void fail() { throw std::runtime_error("the error of an entry method"); }
  void fail_in(int which) {
    if (index().x == which) fail();
  }
  Task fail_later() {
    pages_.put(Page{index().x});
    array()[index()].send<&FailingElement::put_later>();
    (void)co_await pages_.take(index().x);
    (void)co_await pages_.take(7);
    throw std::runtime_error("the error of a coroutine");
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
      array()[index()].send<&FailingElement::nothing>();
      throw std::runtime_error("the error of an epoch's body");
    });
  }
  void bad_input() { tess::fail(ErrorCode::bad_value, "the size is -1; give a positive one"); }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(n_caught_, pages_);
  }

 private:
  Task deep() {
    array()[index()].send<&FailingElement::put_later>();
    (void)co_await pages_.take(7);
    throw std::runtime_error("the error of a task");
  }

  int n_caught_ = 0;
  Mailbox<&Page::key> pages_;
};

/// A run is to end with this code and name these things.
void expect_end(const Result& result, int code, std::initializer_list<std::string> names) {
  expect_exit(result, code);
  const std::string report = result.failure();
  for (const std::string& name : names)
    expect(report.find(name) != std::string::npos, "the report does not name ", name, ": ", report);
}

}  // namespace

void deadlocks(Case& test) {
  const int n = test.draw(2, 9), i = test.draw(0, n - 1);
  const auto elements = [n] { return tess::create<FailingElement>(range(n)); };
  const std::string element = text("FailingElement[", i, "]");
  switch (test.draw(0, 4)) {
    case 0: {
      const Result result = test.run([&] { elements()[{i}].send<&FailingElement::read>(); });
      expect_end(result, 1, {"deadlock", element, "FailingElement::read", "key 7"});
      break;
    }
    case 1: {
      const Result result = test.run([&] { elements()[{n + i}].send<&FailingElement::nothing>(); });
      expect_end(result, 1,
                 {"deadlock", text("FailingElement[", n + i, "]"), "FailingElement::nothing",
                  "not exist"});
      break;
    }
    case 2: {
      const Result result = test.run([&] { elements().broadcast<&FailingElement::give>(1); });
      expect_end(result, 1, {"deadlock", "reduction 0", "contribution", "FailingElement[0]"});
      break;
    }
    case 3: {
      const Result result = test.run([&] { elements()[{i}].send<&FailingElement::read_inside>(); });
      expect_end(
          result, 1,
          {"deadlock", element, "FailingElement::read_inside", "epoch", "FailingElement::read"});
      break;
    }
    default: {
      const Result result = test.run([&] {
        const ArrayProxy<FailingElement> nowhere(CollectionId{0x5000000});
        nowhere[{i}].send<&FailingElement::nothing>();
      });
      expect_end(result, 1, {"deadlock", "is not known there"});
    }
  }
}

void exceptions(Case& test) {
  const int n = test.draw(1, 9), i = test.draw(0, n - 1);
  const std::string element = text("FailingElement[", i, "]");
  const auto run = [&](auto&& send) {
    return test.run([&] {
      const auto elements = tess::create<FailingElement>(range(n));
      send(elements, elements[{i}]);
    });
  };
  switch (test.draw(0, 7)) {
    case 0:
      expect_end(run([](auto&, auto one) { one.template send<&FailingElement::fail>(); }), 1,
                 {"the error of an entry method", element, "FailingElement::fail", "on PE"});
      break;
    case 1:
      expect_end(run([i](auto& elements, auto) {
                   elements.template broadcast<&FailingElement::fail_in>(i);
                 }),
                 1, {"the error of an entry method", element, "FailingElement::fail_in", "on PE"});
      break;
    case 2:
      expect_end(run([](auto&, auto one) { one.template send<&FailingElement::fail_later>(); }), 1,
                 {"the error of a coroutine", element, "FailingElement::fail_later", "on PE"});
      break;
    case 3:
      expect_end(run([](auto&, auto one) { one.template send<&FailingElement::fail_deep>(); }), 1,
                 {"the error of a task", element, "FailingElement::fail_deep", "on PE"});
      break;
    case 4:
      expect_end(
          run([](auto&, auto one) { one.template send<&FailingElement::fail_in_epoch>(); }), 1,
          {"the error of an epoch's body", element, "FailingElement::fail_in_epoch", "on PE"});
      break;
    case 5:
      expect_end(run([](auto&, auto one) { one.template send<&FailingElement::bad_input>(); }), 2,
                 {"error: the size is -1; give a positive one"});
      break;
    case 6:
      expect_end(run([n](auto& elements, auto) { elements[{n}].insert(1); }), 1,
                 {"the error of a constructor", "on PE"});
      break;
    default: {
      const Result result =
          test.run([] { throw std::runtime_error("the error of the main program"); });
      expect_end(result, 1, {"the error of the main program", "on PE 0"});
    }
  }
}

namespace {
Task destroy_and_send(int n, int n_messages) {
  const auto elements = tess::create<FailingElement>(range(n));
  co_await epoch([&] { elements.broadcast<&FailingElement::end>(); });
  co_await epoch([&] {
    for (int k = 0; k < n_messages; ++k) elements[{k % n}].send<&FailingElement::nothing>();
  });
  for (int i = 0; i < n; ++i) elements[{i}].insert();
  co_await epoch([&] {
    for (int i = 0; i < n; ++i) elements[{i}].send<&FailingElement::nothing>();
  });
}
}  // namespace

void undelivered_messages(Case& test) {
  const int n = test.draw(1, 9), n_messages = test.draw(0, 20);
  const Result result = test.run([&]() -> Task { return destroy_and_send(n, n_messages); });
  expect_exit(result);
  // A message that overtakes the insertion is a dead letter, too: at least n_messages, at most n
  // more.
  const int n_undelivered = n_not_delivered(result);
  expect(n_undelivered >= n_messages && n_undelivered <= n_messages + n, n_undelivered,
         " are counted of ", n_messages);
}

}  // namespace tess::fuzz
