#include "collide/dn_field/field_file.hpp"

#include "collide/dn_field/build_field.hpp"
#include "collide/dn_field/shapes.hpp"
#include "collide/dn_field/stepper.hpp"
#include "tests/collide/dn_field/field_samples.hpp"
#include "tests/support/catch.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <unistd.h>

namespace {

using namespace tess::dn;
using namespace tess::dn::test;

/// A name in the folder for temporary files, gone at the end.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name)
      : path_((std::filesystem::temp_directory_path() /
               (name + "." + std::to_string(::getpid()) + ".dnf"))
                  .string()) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() { std::filesystem::remove(path_); }
  [[nodiscard]] const std::string& path() const { return path_; }

  [[nodiscard]] std::string bytes() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void write(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }

 private:
  std::string path_;
};

Field small_field(Content content) {
  const Surface sphere = make_sphere(1, 8);
  return build_field(sphere, grid_around(bounds(sphere), 7, 1),
                     {Sides::one, content, HUGE_VAL, {}});
}

bool same(const Grid& a, const Grid& b) {
  return a.origin == b.origin && a.cell == b.cell && a.n == b.n;
}

TEST_CASE("a field comes back from its file bit for bit", "[dn_field]") {
  const TemporaryFile file("flat");
  for (const Content content : {Content::distance, Content::distance_and_normal}) {
    const Field field = small_field(content);
    save_field(field, file.path());
    const Field back = load_field(file.path());
    CHECK(same(back.grid, field.grid));
    CHECK(back.method == field.method);
    CHECK(back.sides == field.sides);
    CHECK(back.thickness == field.thickness);
    CHECK(back.jump == field.jump);
    CHECK((back.surface == field.surface && field.surface != 0));
    CHECK(back.distance == field.distance);
    CHECK(back.normal == field.normal);
    const std::string first = file.bytes();
    save_field(back, file.path());
    CHECK(file.bytes() == first);
  }
}

TEST_CASE("particles move among loaded fields as among those that were saved, bit for bit",
          "[dn_field]") {
  const TemporaryFile file("moved");
  const Field flat = small_field(Content::distance_and_normal);
  save_field(flat, file.path());
  const Field flat_back = load_field(file.path());
  Rules rules;
  rules.impact = Impact{0.7, 0, Sweep::on};
  rules.gravity = Gravity{{0, 0, -1}};
  const Stepper stepper = make_stepper(rules, 0.01);
  const auto moved = [&](const Object& object) {
    Particles particles;
    for (int i = 0; i < 500; ++i)
      particles.push_back({1.9 * std::sin(i), 1.9 * std::sin(2.3 * i), 1.9 * std::sin(3.7 * i)},
                          {std::sin(5.1 * i), std::sin(7.7 * i), std::sin(9.1 * i)});
    stepper.run(particles.span(), {&object, 1}, 0, 100);
    return std::array{particles.x,  particles.y,  particles.z,
                      particles.vx, particles.vy, particles.vz};
  };
  CHECK(moved({&flat_back, {}}) == moved({&flat, {}}));
}

TEST_CASE("a file that is whole but holds no field that can be is refused", "[dn_field]") {
  const TemporaryFile file("unsound");
  const auto told = [&](const auto& damage) {
    Field field = small_field(Content::distance);
    damage(field);
    save_field(field, file.path());
    return message_of([&] { (void)load_field(file.path()); });
  };
  CHECK(told([](Field&) {}).empty());
  CHECK_THAT(told([](Field& field) {
               field.grid.n = {1 << 30, 1 << 30, 16};  // their product is 0 in 64 bits
               field.distance.clear();
             }),
             Contains("or of too many"));
  CHECK_THAT(told([](Field& field) { field.grid.n[1] = 0; }), Contains("without voxels"));
  CHECK_THAT(told([](Field& field) { field.grid.cell = HUGE_VAL; }), Contains("not finite"));
  CHECK_THAT(told([](Field& field) { field.grid.origin.y = std::nan(""); }),
             Contains("not finite"));
  CHECK_THAT(told([](Field& field) { field.thickness = std::nan(""); }), Contains("a thickness"));
  CHECK_THAT(told([](Field& field) { field.distance.pop_back(); }),
             Contains("another number of voxels"));
}

TEST_CASE("damage at any byte of a file is refused, and so is every truncation", "[dn_field]") {
  const TemporaryFile file("damaged");
  const Field flat = small_field(Content::distance);
  save_field(flat, file.path());
  const std::string whole = file.bytes();
  const auto read = [&](const std::string& bytes) {
    std::istringstream stream(bytes);
    return message_of([&] { (void)read_field(stream, "a file"); });
  };
  REQUIRE(read(whole).empty());
  int accepted = 0;
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (const int flip : {0x01, 0x80, 0xFF}) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ flip);
      accepted += read(bytes).find("a file: ") == std::string::npos;
    }
  CHECK(accepted == 0);
  for (std::size_t length = 0; length < whole.size(); ++length)
    accepted += read(whole.substr(0, length)).find("truncated") == std::string::npos;
  CHECK(accepted == 0);
  CHECK_THAT(read(whole + '\0'), Contains("longer than it says"));
}

TEST_CASE("what is wrong with a file is named", "[dn_field]") {
  const TemporaryFile file("wrong");
  const Field flat = small_field(Content::distance);
  save_field(flat, file.path());
  const std::string whole = file.bytes();
  const auto loaded = [&](const std::string& bytes) {
    file.write(bytes);
    return message_of([&] { (void)load_field(file.path()); });
  };
  std::string other = whole;
  other[8] = 1;
  CHECK_THAT(loaded(other), Contains("version 1, this program reads 4"));
  CHECK_THAT(loaded("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n# an OBJ\n"), Contains("no field file"));
  other = whole;
  other.back() = static_cast<char>(other.back() ^ 1);
  CHECK_THAT(loaded(other), Contains("damaged"));
  CHECK_THROWS_WITH(load_field("no/such.dnf"), Contains("no/such.dnf: cannot be opened"));
  CHECK_THROWS_WITH(save_field(flat, "no/such/folder.dnf"), Contains("cannot be written"));
  Field odd = flat;
  odd.distance.pop_back();
  save_field(odd, file.path());
  CHECK_THROWS_WITH(load_field(file.path()), Contains("number of voxels"));
  odd = flat;
  odd.jump = -1;
  save_field(odd, file.path());
  CHECK_THROWS_WITH(load_field(file.path()), Contains("jump"));
}

}  // namespace
