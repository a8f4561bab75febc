#include "apps/m2m_transfer/input/graph.hpp"

#include "tests/support/catch.hpp"

using namespace m2m_transfer;

namespace {

const std::vector<std::string> four_meshes{"kuhn:2", "kuhn:3", "fine.exo", "D.exo"};

std::vector<std::size_t> levels(const std::string& pairs) {
  std::vector<std::size_t> out;
  for (const Pair& pair : parse_pairs(pairs, four_meshes)) out.push_back(pair.level);
  return out;
}

}  // namespace

TEST_CASE("pairs name four_meshes by letter or by file", "[apps][graph]") {
  CHECK(parse_pairs("", four_meshes) == std::vector{Pair{0, 1, 0}});
  const std::vector wanted{Pair{0, 1, 0}, Pair{1, 2, 1}};
  CHECK(parse_pairs("A:B,B:C", four_meshes) == wanted);
  CHECK(parse_pairs("kuhn:2:kuhn:3,kuhn:3:fine.exo", four_meshes) == wanted);
  CHECK(parse_pairs("A:kuhn:3,B:fine.exo", four_meshes) == wanted);
}

TEST_CASE("pairs that share a mesh that is written run in the order given, all others at once",
          "[apps][graph]") {
  CHECK(levels("A:B,A:C,A:D") == std::vector<std::size_t>{0, 0, 0});
  CHECK(levels("A:B,C:D") == std::vector<std::size_t>{0, 0});
  CHECK(levels("A:B,B:C,C:D") == std::vector<std::size_t>{0, 1, 2});
  CHECK(levels("B:C,A:B") == std::vector<std::size_t>{0, 1});  // B is read, then written
  CHECK(levels("A:C,B:C") == std::vector<std::size_t>{0, 1});
  CHECK(levels("A:B,A:C,B:D,C:D") == std::vector<std::size_t>{0, 0, 1, 2});
}

TEST_CASE("a mesh that is read before it is written needs values", "[apps][graph]") {
  const std::vector<Pair> pairs = parse_pairs("A:B,B:A,C:B", four_meshes);
  CHECK(needs_values(0, pairs));
  CHECK_FALSE(needs_values(1, pairs));
  CHECK(needs_values(2, pairs));
  CHECK_FALSE(needs_values(3, pairs));
  CHECK(is_written(0, pairs));
  CHECK_FALSE(is_written(2, pairs));
}

TEST_CASE("a pair with a mistake is refused with the letters of the meshes", "[apps][graph]") {
  for (const char* text : {"A", "A:E", "A:B,", "A;B", "fine:A"})
    CHECK_THROWS_WITH(parse_pairs(text, four_meshes),
                      Contains("is no pair") && Contains("C is fine.exo"));
  CHECK_THROWS_WITH(parse_pairs("A:A", four_meshes), Contains("same mesh twice"));
  CHECK_THROWS_WITH(parse_pairs("A:B,A:B", four_meshes), Contains("stands twice"));
  CHECK_THROWS_WITH(parse_pairs("x:B", {"x", "x"}), Contains("more than one mesh"));
}
