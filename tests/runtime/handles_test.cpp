// Handles as values: each kind is a key of unordered containers, also after a journey as bytes.
#include "runtime/interface.hpp"
#include "runtime/machine/threads.hpp"
#include "runtime/process_group.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"

#include <string>
#include <unordered_map>
#include <unordered_set>

namespace {

class Speaker {
 public:
  Speaker() = default;
  Speaker(const Speaker&) = delete;
  Speaker& operator=(const Speaker&) = delete;
  virtual ~Speaker() = default;
  virtual void speak() = 0;
};
class Actor : public tess::Chare<Actor>, public Speaker {
 public:
  void speak() override {}
};
class Page : public tess::Chare<Page, std::string> {};
class Usher : public tess::Group<Usher> {};
struct Stage {
  int width = 0;
};

/// Two handles differ, and each is found again by what its bytes give.
template <class Handle>
void check_keys(const Handle& a, const Handle& b) {
  const auto copy_of = [](const Handle& handle) {
    return tess::from_bytes<Handle>(tess::to_bytes(handle));
  };
  CHECK(a != b);
  CHECK(copy_of(a) == a);
  CHECK(copy_of(b) == b);
  const std::unordered_set<Handle> both{a, b, copy_of(a), copy_of(b)};
  CHECK(both.size() == 2);
  CHECK(both.contains(copy_of(b)));
  CHECK_FALSE(both.contains(Handle()));
  CHECK(copy_of(Handle()) == Handle());
  std::unordered_map<Handle, int> numbers{{a, 1}, {b, 2}};
  CHECK(numbers[copy_of(a)] + 10 * numbers[copy_of(b)] == 21);
}

void use_as_keys() {
  const auto actors = tess::create<Actor>(tess::range(4)),
             others = tess::create<Actor>(tess::range(4));
  check_keys(actors, others);
  check_keys(actors[{1}], actors[{2}]);
  check_keys(actors[{1}], others[{1}]);
  const auto pages = tess::create<Page>(tess::sparse);
  check_keys(pages["left"], pages["right"]);
  check_keys(tess::create_section(actors, {{0}, {1}}), tess::create_section(actors, {{0}, {1}}));
  const auto ushers = tess::create_group<Usher>();
  check_keys(ushers, tess::create_group<Usher>());
  check_keys(ushers[tess::PeId{1}], ushers[tess::PeId{2}]);
  check_keys(tess::create_one<Actor>(), tess::create_one<Actor>());
  using Speakers = tess::InterfaceArray<Speaker>;
  check_keys(Speakers(actors), Speakers(others));
  check_keys(Speakers(actors)[{1}], Speakers(actors)[{2}]);
  check_keys(tess::create_process_group<Stage>(), tess::create_process_group<Stage>());
  check_keys(tess::create_read_only(Stage{3}), tess::create_read_only(Stage{3}));
}

TEST_CASE("handles of each kind are keys of unordered containers, also as copies from bytes",
          "[runtime][handles]") {
  tess::Setup setup{tess::make_threads_machine(3), {}};
  CHECK(tess::run(setup, &use_as_keys) == 0);
}

}  // namespace
