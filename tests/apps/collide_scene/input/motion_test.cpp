// Scenes from the command line, and how they move.
#include "apps/collide_scene/input/motion.hpp"

#include "apps/collide_scene/input/load.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

using namespace collide_scene;
using tess::test::message_of;

namespace {

Scene loaded(const std::vector<std::string>& inputs) {
  return load(inputs, 1);
}

}  // namespace

TEST_CASE("each file is a model, in the order of the arguments", "[apps][collide_scene]") {
  const tess::test::Scratch scratch;
  const std::string one = scratch.write("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
                    two = scratch.write("two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n");
  CHECK(loaded({one}).models == std::vector<std::uint32_t>{0});
  const Scene both = loaded({two, one, two});
  CHECK(both.models == std::vector<std::uint32_t>{0, 0, 1, 2, 2});
  CHECK(both.triangles.size() == 5);
  CHECK(n_models(both) == 3);
  CHECK(n_models(loaded({"boxes:10"})) == 0);
  CHECK(loaded({"planes:64", one}).models.back() == 2);
  CHECK(message_of([&] { (void)loaded({one, "boxes:10"}); }).starts_with("boxes:10: "));
  CHECK(message_of([&] { (void)loaded({"boxs:10"}); }).starts_with("boxs:10: is neither"));
}

TEST_CASE("a place depends on the step alone, and step 0 is how the scene was made",
          "[apps][collide_scene]") {
  for (const char* name : {"planes:128", "boxes:50", "crowd:512"})
    for (const char* move : {"", "still", "drift", "drift:0.5", "turn:10"}) {
      Scene scene = make_scene(name);
      if (scene.triangles.empty() && std::string(move).starts_with("turn")) continue;
      INFO(name << " " << move);
      const Motion motion(move, scene);
      const Scene first = scene;
      motion.place(3, scene);
      const Scene third = scene;
      CHECK((third.triangles != first.triangles || third.boxes != first.boxes) == motion.moves());
      motion.place(1, scene);
      motion.place(3, scene);
      CHECK(scene.triangles == third.triangles);
      CHECK(scene.boxes == third.boxes);
      motion.place(0, scene);
      CHECK(scene.triangles == first.triangles);
      CHECK(scene.boxes == first.boxes);
    }
}

TEST_CASE("a motion that does not fit the scene is refused", "[apps][collide_scene]") {
  const Scene planes = make_scene("planes:64"), boxes = make_scene("boxes:10");
  const auto message = [](const char* text, const Scene& scene) {
    return message_of([&] { (void)Motion(text, scene); });
  };
  CHECK(message("own", planes).starts_with("--move own: "));
  CHECK(message("turn", boxes).starts_with("--move turn: boxes"));
  for (const char* text : {"sideways", "drift:", "drift:fast", "drift:nan", "still:1", "turn:1x"})
    CHECK(message(text, planes).starts_with(std::string("--move ") + text + ": "));
}
