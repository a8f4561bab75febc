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

  void serialize(auto& ar) { ar(n_caught_, pages_); }

 private:
  Task deep() {
    array()[index()].send<&FailingElement::put_later>();
    (void)co_await pages_.take(7);
    throw std::runtime_error("the error of a task");
  }

  int n_caught_ = 0;
  Mailbox<&Page::key> pages_;
};

using Elements = ArrayProxy<FailingElement>;

/// A program that ends with an error, and what its report names: of "element" and "absent" the
/// names of element i, and of element n + i, which does not exist.
struct Failing {
  void (*send)(const Elements&, int n, int i);
  int exit_code;
  std::vector<std::string> names;
};
template <auto F>
void to_one(const Elements& elements, int /*n*/, int i) {
  elements[{i}].send<F>();
}

void run_one_of(Case& test, const std::vector<Failing>& programs, int least) {
  const int n = test.draw(least, 9), i = test.draw(0, n - 1);
  const Failing& one = programs[test.random.below(programs.size())];
  const Result result = test.run([&] { one.send(tess::create<FailingElement>(range(n)), n, i); });
  expect_exit(result, one.exit_code);
  const std::string report = result.failure();
  for (std::string name : one.names) {
    if (name == "element") name = text("FailingElement[", i, "]");
    if (name == "absent") name = text("FailingElement[", n + i, "]");
    expect(report.find(name) != std::string::npos, "the report does not name ", name, ": ", report);
  }
}

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

void deadlocks(Case& test) {
  using E = FailingElement;
  run_one_of(
      test,
      {{to_one<&E::read>, 1, {"deadlock", "element", "FailingElement::read", "key 7"}},
       {[](const Elements& all, int n, int i) { all[{n + i}].send<&E::nothing>(); },
        1,
        {"deadlock", "absent", "FailingElement::nothing", "not exist"}},
       {[](const Elements& all, int, int) { all.broadcast<&E::give>(1); },
        1,
        {"deadlock", "reduction 0", "contribution", "FailingElement[0]"}},
       {to_one<&E::read_inside>,
        1,
        {"deadlock", "element", "FailingElement::read_inside", "epoch", "FailingElement::read"}},
       {[](const Elements&, int, int i) {
          Elements(CollectionId{0x5000000})[{i}].send<&E::nothing>();
        },
        1,
        {"deadlock", "is not known there"}}},
      2);
}

void exceptions(Case& test) {
  using E = FailingElement;
  const std::string entry = "the error of an entry method", pe = "on PE";
  run_one_of(test,
             {{to_one<&E::fail>, 1, {entry, "element", "FailingElement::fail", pe}},
              {[](const Elements& all, int, int i) { all.broadcast<&E::fail_in>(i); },
               1,
               {entry, "element", "FailingElement::fail_in", pe}},
              {to_one<&E::fail_later>,
               1,
               {"the error of a coroutine", "element", "FailingElement::fail_later", pe}},
              {to_one<&E::fail_deep>,
               1,
               {"the error of a task", "element", "FailingElement::fail_deep", pe}},
              {to_one<&E::fail_in_epoch>,
               1,
               {"the error of an epoch's body", "element", "FailingElement::fail_in_epoch", pe}},
              {to_one<&E::bad_input>, 2, {"error: the size is -1; give a positive one"}},
              {[](const Elements& all, int n, int) { all[{n}].insert(1); },
               1,
               {"the error of a constructor", pe}},
              {[](const Elements&, int, int) {
                 throw std::runtime_error("the error of the main program");
               },
               1,
               {"the error of the main program", "on PE 0"}}},
             1);
}

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
