// The parts of the runtime that need no run: serialisation, indices, names, reduction operations.
#include "runtime/core/round_trip.hpp"
#include "runtime/more/shared_array.hpp"
#include "runtime/pe/queues/ready_queue.hpp"
#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"

#include <boost/container/small_vector.hpp>

#include <bitset>
#include <complex>
#include <deque>
#include <limits>
#include <list>
#include <map>
#include <memory>
#include <set>
#include <unordered_map>
#include <variant>

namespace {

struct Plain {
  int a = 0;
  double b = 0;
  friend bool operator==(const Plain&, const Plain&) = default;
};
struct Nested {
  Plain plain;
  std::string name;
  std::vector<Plain> plains;
  std::map<std::string, std::vector<int>> map;
  friend bool operator==(const Nested&, const Nested&) = default;
};
class Symmetric {
 public:
  Symmetric() = default;
  explicit Symmetric(int value) : value_(value), text_("value") {}
  void serialize(auto& ar) { ar(value_, text_); }
  friend bool operator==(const Symmetric&, const Symmetric&) = default;

 private:
  int value_ = 0;
  std::string text_;
};

/// Its default values are lists of what is no number; g++ 12 fails on their count by Boost.PFR.
struct Listed {
  int first = 1;
  std::vector<std::string> names{"a", "b"};
  std::map<std::string, std::vector<int>> map{{"x", {1, 2}}};
  friend bool operator==(const Listed&, const Listed&) = default;
};
/// A container by another name: an aggregate with nothing beside it.
struct Path : std::vector<Plain> {};
/// Writes nothing.
struct Bare {
  int cache = 0;
  void serialize(auto& /*ar*/) {}
  friend auto operator<=>(const Bare&, const Bare&) = default;
};
/// Members that are arrays of C.
struct Arrays {
  double at[3] = {1, 2, 3};
  std::string name = "name";
  int table[2][2] = {{1, 2}, {3, 4}};
  std::string names[2] = {"x", "y"};
  friend bool operator==(const Arrays&, const Arrays&) = default;
};
struct Numbers {
  double at[3] = {};
  std::int64_t n[1] = {};
};
struct Padded {
  double at[3] = {};
  std::int32_t n = 0;
};
/// A class of another library: it is no aggregate, and cannot be changed.
class Foreign {
 public:
  explicit Foreign(int value = 0) : value_(value) {}
  [[nodiscard]] int value() const { return value_; }
  friend bool operator==(const Foreign&, const Foreign&) = default;

 private:
  int value_;
};
template <class Ar>
void serialize(Ar& ar, Foreign& foreign) {
  int value = foreign.value();
  ar(value);
  if (Ar::is_reading) foreign = Foreign(value);
}

/// Serialises what derives from it.
template <class Derived>
struct ByItsFields {
  void serialize(auto& ar) { static_cast<Derived&>(*this).fields(ar); }
};
class Fielded : public ByItsFields<Fielded> {
 public:
  explicit Fielded(int value = 0) : value_(value) {}
  template <class Ar>
  void fields(Ar& ar) {
    ar(value_);
  }
  friend bool operator==(const Fielded& a, const Fielded& b) { return a.value_ == b.value_; }

 private:
  int value_;
};
/// Adds no members.
class NamedFielded : public Fielded {
 public:
  static constexpr int limit = 3;
  using Fielded::Fielded;
};

struct Shape {
  int n = 0;
  Shape() = default;
  Shape(const Shape&) = default;
  virtual ~Shape() = default;
  void serialize(auto& ar) { ar(n); }
};

template <class T>
void check_round_trip(const T& value) {
  const auto bytes = tess::to_bytes(value);
  const T back = tess::from_bytes<T>(bytes);
  CHECK(back == value);
  CHECK(tess::to_bytes(back) == bytes);
  // Every truncation is found.
  for (std::size_t n = 0; n < bytes.size(); ++n)
    CHECK_THROWS_AS(tess::from_bytes<T>(std::span(bytes).first(n)), tess::Error);
}

}  // namespace

namespace tess {
template <class Ar>
void serialize(Ar& ar, std::bitset<70>& bits) {
  std::string text = bits.to_string();
  ar(text);
  if (Ar::is_reading) bits = std::bitset<70>(text);
}
}  // namespace tess

TEST_CASE("text in one line shows control characters as escapes and leaves the rest", "[runtime]") {
  CHECK(tess::one_line("a\nb\r\tc\x1b[1m\x7f") == "a\\nb\\r\\tc\\x1b[1m\\x7f");
  CHECK(tess::one_line("größer … \xff") == "größer … \xff");
  CHECK(tess::one_line(std::string_view("\0", 1)) == "\\x00");
}

TEST_CASE("values come back from their bytes, and truncated bytes are refused", "[runtime]") {
  check_round_trip(42);
  check_round_trip(Plain{1, 2.5});
  check_round_trip(std::chrono::milliseconds(-7));
  check_round_trip(std::vector<std::chrono::duration<double>>{{}, std::chrono::hours(2)});
  check_round_trip(Nested{{1, 2}, "name", {{3, 4}, {5, 6}}, {{"k", {1, 2, 3}}, {"", {}}}});
  check_round_trip(Symmetric(7));
  check_round_trip(std::vector<Symmetric>{Symmetric(1), Symmetric(2)});
  check_round_trip(std::vector<bool>{true, false, true});
  check_round_trip(Path{{{1, 2}, {3, 4}}});
  check_round_trip(std::deque<std::string>{"a", "", "ccc"});
  check_round_trip(std::set<int>{3, 1, 2});
  check_round_trip(std::unordered_map<int, std::string>{{1, "one"}});
  check_round_trip(std::optional<int>{});
  check_round_trip(std::optional<std::string>{"given"});
  check_round_trip(std::variant<int, std::string>{"second"});
  check_round_trip(std::tuple<int, std::string, Plain>{1, "2", {3, 4}});
  check_round_trip(tess::SharedArray<int>(std::vector<int>{1, 2, 3}));
  check_round_trip(tess::SharedArray<double>());
  check_round_trip(std::pair<std::string, int>{"first", 2});
  check_round_trip(std::array<std::string, 2>{"a", "b"});
  check_round_trip(boost::container::small_vector<int, 4>{1, 2, 3, 4, 5, 6});
}

TEST_CASE("aggregates come back with arrays of C and with default values that are lists",
          "[runtime][serialize]") {
  check_round_trip(Listed{});
  check_round_trip(Listed{3, {"other"}, {}});
  Arrays arrays;
  arrays.at[2] = 7;
  arrays.table[1][0] = 8;
  arrays.names[1] = "z";
  check_round_trip(arrays);
  STATIC_REQUIRE(tess::Bitwise<Numbers>);
  STATIC_REQUIRE(!tess::Bitwise<Padded>);
  CHECK(tess::to_bytes(Padded{}).size() == 28);
}

TEST_CASE("complex numbers are copied as bytes", "[runtime][serialize]") {
  STATIC_REQUIRE(tess::Bitwise<std::complex<float>>);
  check_round_trip(std::complex<double>(1, 2));
  check_round_trip(std::vector<std::complex<float>>{{1, 2}, {3, 4}});
}

TEST_CASE("a function beside the type serialises a class of another library",
          "[runtime][serialize]") {
  check_round_trip(Foreign(3));
  check_round_trip(std::vector<Foreign>{Foreign(4), Foreign(5)});
  check_round_trip(std::map<std::string, Foreign>{{"a", Foreign(6)}});
  check_round_trip(std::bitset<70>(123456789));
  CHECK(tess::round_trip_difference(Foreign(3)).empty());
}

TEST_CASE("a serialize() that is inherited serves a class without members of its own",
          "[runtime][serialize]") {
  check_round_trip(Fielded(3));
  check_round_trip(std::vector<NamedFielded>{NamedFielded(4), NamedFielded(5)});
}

TEST_CASE("a unique_ptr to a class with virtual functions comes back", "[runtime][serialize]") {
  auto shape = std::make_unique<Shape>();
  shape->n = 4;
  const auto back = tess::from_bytes<std::unique_ptr<Shape>>(tess::to_bytes(shape));
  REQUIRE(back != nullptr);
  CHECK(back->n == 4);
  CHECK(tess::from_bytes<std::unique_ptr<Shape>>(tess::to_bytes(std::unique_ptr<Shape>())) ==
        nullptr);
}

TEST_CASE("containers of items that take no bytes come back with all of them",
          "[runtime][serialize]") {
  const auto size_of_copy = [](const auto& items) {
    return tess::from_bytes<std::decay_t<decltype(items)>>(tess::to_bytes(items)).size();
  };
  CHECK(size_of_copy(std::vector<Bare>(3)) == 3);
  CHECK(size_of_copy(std::vector<std::pair<Bare, Bare>>(4)) == 4);
  CHECK(size_of_copy(std::deque<Bare>(5)) == 5);
  CHECK(size_of_copy(std::list<Bare>(6)) == 6);
  CHECK(size_of_copy(std::map<Bare, Bare>{{Bare{1}, Bare{}}}) == 1);
}

TEST_CASE("an announced length beyond the bytes is refused before memory is taken", "[runtime]") {
  const auto bytes = tess::to_bytes(std::numeric_limits<std::uint64_t>::max() / 2);
  CHECK_THROWS_AS(tess::from_bytes<std::vector<double>>(bytes), tess::Error);
  CHECK_THROWS_AS(tess::from_bytes<std::string>(bytes), tess::Error);
  CHECK_THROWS_AS((tess::from_bytes<std::map<int, int>>(bytes)), tess::Error);
}

TEST_CASE("bytes that are left over are refused", "[runtime]") {
  CHECK_THROWS_AS(tess::from_bytes<std::int32_t>(tess::to_bytes(std::int64_t{1})), tess::Error);
}

TEST_CASE("rank and index of a range are inverse in row-major order", "[runtime]") {
  const tess::Range range = tess::range(3, 4, 5);
  CHECK(range.size() == 60);
  std::int64_t rank = 0;
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 4; ++y)
      for (int z = 0; z < 5; ++z, ++rank) {
        CHECK(tess::rank_in(range, tess::Index3{x, y, z}) == rank);
        CHECK(tess::index_at<tess::Index3>(range, rank) == tess::Index3{x, y, z});
      }
  CHECK(tess::rank_in(range, tess::Index3{3, 0, 0}) == -1);
  CHECK(tess::rank_in(range, tess::Index3{0, -1, 0}) == -1);
  CHECK_THROWS_AS(tess::range(-1), tess::Error);
}

TEST_CASE("a range has at most 2^40 elements", "[runtime]") {
  CHECK(tess::range(1 << 20, 1 << 20).size() == std::uint64_t{1} << 40U);
  CHECK(tess::range(1 << 30, 1 << 30, 0).size() == 0);
  CHECK_THROWS_WITH(tess::range(1 << 22, 1 << 21, 1 << 21), Catch::Contains("at most 2^40"));
  CHECK_THROWS_WITH(tess::range(-3), Catch::Contains("extent -3 is not within"));
}

TEST_CASE("an index prints as a user writes it", "[runtime]") {
  CHECK(tess::index_text(tess::Index1{3}) == "[3]");
  CHECK(tess::index_text(tess::Index3{1, -2, 3}) == "[1,-2,3]");
  CHECK(tess::index_text(std::string("name")) == "[\"name\"]");
  CHECK(tess::index_text(tess::Index6{{1, 2, 3, 4, 5, 6}}) == "[1,2,3,4,5,6]");
  enum class Side { left, right };
  struct Edge {
    int x = 0;
    Side side{};
  };
  CHECK(tess::index_text(Edge{3, Side::right}) == "[3,1]");
  CHECK(tess::index_text(Side::right) == "[1]");
}

TEST_CASE("names are those of the source", "[runtime]") {
  CHECK(tess::plain_name("tess::detail::Call<Block, OfEntry, &Block::step>") == "Block::step");
  CHECK(tess::plain_name("tess::fuzz::Block") == "fuzz::Block");
  // The user did not write the names of these messages.
  CHECK(tess::plain_name("tess::detail::Awakening<Block>") == "Block::resume_from_sync");
  CHECK(tess::plain_name("tess::detail::Construction<mesh::Block<A<int, 2> >, int>") ==
        "mesh::Block<A<int, 2> >::constructor");
}

TEST_CASE("reduction operations combine numbers, and lists element by element", "[runtime]") {
  CHECK(tess::sum(2, 3) == 5);
  CHECK(tess::min(2, 3) == 2);
  CHECK(tess::max(2, 3) == 3);
  CHECK(tess::sum(std::vector<int>{1, 2}, {10, 20}) == std::vector<int>{11, 22});
  CHECK(tess::max(std::array<int, 2>{1, 9}, {5, 5}) == std::array<int, 2>{5, 9});
  CHECK(tess::concatenate(std::string("ab"), std::string("c")) == "abc");
  CHECK_FALSE(tess::logical_and(true, false));
  CHECK(tess::logical_or(true, false));
}

TEST_CASE("the ready queue gives messages in their order", "[runtime]") {
  tess::detail::ReadyQueue queue;
  std::array<tess::detail::Link, 4> links;
  CHECK(queue.empty());
  queue.push(&links[0]);
  // Over several turns of the ring and growths of it, in order.
  std::size_t n_pushed = 1, n_popped = 0;
  for (std::size_t turn = 0; turn < 100; ++turn) {
    for (std::size_t i = 0; i < 17 + turn; ++i) queue.push(&links[n_pushed++ % links.size()]);
    for (std::size_t i = 0; i < 15 + turn; ++i)
      REQUIRE(queue.pop() == &links[n_popped++ % links.size()]);
  }
  while (!queue.empty()) REQUIRE(queue.pop() == &links[n_popped++ % links.size()]);
  CHECK(n_popped == n_pushed);
}

namespace {

struct Forgets {
  std::int32_t kept = 1;
  double lost = 2;
  template <class Ar>
  void serialize(Ar& ar) {
    double other = Ar::is_reading ? 0 : lost;
    ar(kept, other);  // the value is read into a temporary and lost
  }
};

struct Remembers {
  std::int32_t kept = 1;
  std::vector<std::string> names;
  void serialize(auto& ar) { ar(kept, names); }
};

}  // namespace

TEST_CASE("a member that does not come back is named by its place and type",
          "[runtime][serialize]") {
  Forgets forgets;
  forgets.lost = 7;
  const std::string found = tess::round_trip_difference(forgets);
  INFO(found);
  REQUIRE(found.find("Forgets: member 2 of 2 (double)") != std::string::npos);
  REQUIRE(tess::round_trip_difference(Remembers{3, {"a", "b"}}).empty());
}

TEST_CASE("a copy is compared with the bytes it was read from", "[runtime][serialize]") {
  const Remembers original{3, {"a", "b"}};
  const auto sent = tess::to_bytes(original);
  CHECK(tess::difference_from_bytes(sent, original).empty());
  const std::string changed = tess::difference_from_bytes(sent, Remembers{3, {"a", "c"}});
  CHECK(changed.find("Remembers: member 2 of 2 (") != std::string::npos);
  const std::string shorter = tess::difference_from_bytes(sent, Remembers{3, {"a"}});
  CHECK(shorter.find("Remembers: member 2 of 2 (") != std::string::npos);
  CHECK(tess::difference_from_bytes(sent, Remembers{4, {}}).find("member 1 of 2 (int)") !=
        std::string::npos);
  std::vector<std::byte> more = sent;
  more.push_back(std::byte{0});
  CHECK(tess::difference_from_bytes(more, original).find("1 bytes less") != std::string::npos);
}

namespace {

/// Passes a temporary to the archive, which is destroyed when serialize() returns.
struct Doubles {
  std::vector<double> values;
  void serialize(auto& ar) {
    std::vector<double> copy = values;
    ar(copy);
    values = copy;
  }
};
struct Load {
  int number = 0;
  std::vector<double> large, small;
  std::string text;
  std::map<int, std::vector<double>> moved_when_read;
  Doubles temporary;
  std::vector<std::vector<int>> nested;
  tess::SharedArray<double> shared;
};

Load load_of(std::size_t n) {
  Load load;
  load.number = 7;
  load.large.assign(n, 1.5);
  load.small.assign(2, 2.5);
  load.text.assign(8 * n, 't');
  load.moved_when_read[1].assign(n, 3.5);
  load.temporary.values.assign(n, 4.5);
  load.nested.assign(2, std::vector<int>(2 * n, 5));
  load.shared = tess::SharedArray<double>(std::vector<double>(n, 6.5));
  return load;
}

/// A message of bytes and parts.
struct Packed {
  std::vector<std::byte> bytes;
  tess::detail::Attached attached;
  std::vector<std::uint64_t> sizes;

  explicit Packed(const Load& load) : bytes(10'000) {
    attached.least_bytes = 100;
    tess::Writer write(bytes, &attached);
    write(load);
    REQUIRE(write.n_bytes() <= bytes.size());
    bytes.resize(write.n_bytes());
    for (const auto part : attached.parts) sizes.push_back(part.size());
  }
};

}  // namespace

TEST_CASE("large vectors are attached from where they stand and read in place",
          "[runtime][serialize]") {
  const Load load = load_of(100);
  const Packed packed(load);
  REQUIRE(packed.attached.parts.size() == 4);
  CHECK(packed.attached.parts[0].data() == reinterpret_cast<const std::byte*>(load.large.data()));
  CHECK(packed.attached.parts[3].data() == reinterpret_cast<const std::byte*>(load.shared.data()));
  CHECK(packed.attached.n_bytes == 4 * 800);

  std::vector<std::span<std::byte>> taken;
  tess::detail::Places places{packed.sizes, taken};
  tess::Reader read(packed.bytes, &places);
  Load back;
  read(back);
  CHECK(read.remaining() == 0);
  REQUIRE(taken.size() == 4);
  CHECK(taken[0].data() == reinterpret_cast<const std::byte*>(back.large.data()));
  for (std::size_t i = 0; i < taken.size(); ++i)
    std::copy(packed.attached.parts[i].begin(), packed.attached.parts[i].end(), taken[i].begin());
  CHECK(tess::to_bytes(back) == tess::to_bytes(load));
}

TEST_CASE("an attached part that was not announced is refused before memory is asked for",
          "[runtime][serialize]") {
  const Packed packed(load_of(100));
  const auto refused = [&](std::vector<std::uint64_t> sizes) {
    std::vector<std::span<std::byte>> taken;
    tess::detail::Places places{sizes, taken};
    tess::Reader read(packed.bytes, &places);
    Load back;
    CHECK_THROWS_AS(read(back), tess::Error);
  };
  refused({});
  refused({800, 800, 800});
  refused({800, 800, 800, 808});
  refused({800, 800, 801, 800});
  // A buffer of packed messages has no parts.
  tess::Reader read(packed.bytes);
  Load back;
  CHECK_THROWS_AS(read(back), tess::Error);
}

TEST_CASE("a writer without room counts what is needed and writes nothing beyond",
          "[runtime][serialize]") {
  const Load load = load_of(20);
  const auto whole = tess::to_bytes(load);
  CHECK(tess::written_bytes(load) == whole.size());
  std::vector<std::byte> room(whole.size() + 8, std::byte{0x5a});
  for (std::size_t n = 0; n < whole.size(); n += 7) {
    tess::Writer write{std::span(room).first(n)};
    write(load);
    CHECK(write.n_bytes() == whole.size());
    CHECK(room[n] == std::byte{0x5a});
    std::fill(room.begin(), room.end(), std::byte{0x5a});
  }
}

TEST_CASE("copies of a shared array are owners of one memory", "[runtime][serialize]") {
  std::vector<double> values(1000, 1);
  const double* const memory = values.data();
  const tess::SharedArray<double> first(std::move(values));
  tess::SharedArray<double> second;
  CHECK(second.empty());
  second = first;
  CHECK(first.data() == memory);
  CHECK(second.data() == memory);
  CHECK(second == tess::SharedArray<double>(std::vector<double>(1000, 1)));
  CHECK_FALSE(second == tess::SharedArray<double>(std::vector<double>(1000, 2)));
}
