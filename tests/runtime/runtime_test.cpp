// A program may open namespace tess and still use the names of the runtime's internals.
#include "runtime/runtime.hpp"

#include "runtime/balance.hpp"
#include "runtime/more/shared_array.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/run.hpp"

#include <tuple>
#include <type_traits>
#include <vector>

namespace tess {

// These would be redefinitions if the runtime's own were in this namespace.
struct Link {};
struct Pool {};
struct Bundle {};
struct Buffer {};
struct Version {};
struct Envelope {};
struct Action {};
struct Parcel {};
struct Program {};
struct Counters {};
struct Tally {};
struct Report {};
struct Trace {};
struct Meter {};
struct Outbox {};
struct Message {};
struct Context {};
struct Suspended {};
struct Collection {};
struct Element {};
struct Array {};
struct Place {};
struct Call {};
struct Construction {};
struct Arrival {};
struct Partial {};
struct Cause {};
struct Track {};

}  // namespace tess

namespace {

using namespace tess;

struct Topology {
  int n_links = 0;
};
// As the names of the classes between Chare or Group and the runtime's own.
struct IndexedElement {};
struct Contributor {};
struct Member {};
struct Counter {
  Topology topology;
  std::vector<Link> links;
};

class Station : public Chare<Station> {
 public:
  void count(Callback<int> target) {
    const Counter counter{{index().x}, {}};
    contribute(sum, counter.topology.n_links, target);
  }
};

/// True if the names mean the program's types, in the scope where this is instantiated.
template <class... Named>
constexpr bool are_mine =
    std::is_same_v<std::tuple<Named...>, std::tuple<tess::Element, IndexedElement, Contributor,
                                                    Member, tess::Collection, tess::Array>>;

class Atom : public Chare<Atom, Index3> {
 public:
  static constexpr bool sees_mine =
      are_mine<Element, IndexedElement, Contributor, Member, Collection, Array>;
  void be(Element element) { element_ = element; }

 private:
  Element element_;
};
class Chemist : public Group<Chemist> {
 public:
  static constexpr bool sees_mine =
      are_mine<Element, IndexedElement, Contributor, Member, Collection, Array>;
};

TEST_CASE(
    "in a chare and in a member of a group, names of the program are not hidden by base classes",
    "[runtime]") {
  CHECK(Atom::sees_mine);
  CHECK(Chemist::sees_mine);
}

TEST_CASE("a program in namespace tess may use the names of internals", "[runtime]") {
  int total = 0;
  const auto main = [&total]() -> Task {
    const auto stations = create<Station>(range(4));
    total = co_await stations.reduce<&Station::count>();
  };
  CHECK(tests::run("pes=2,seed=1", main).exit_code == 0);
  CHECK(total == 6);
}

}  // namespace
