// Step 5: elements that come to life when the first message reaches them. A cave is explored from
// its entrance; each passage is a message, and only rooms that can be reached become elements.
#include "runtime/runtime.hpp"

#include <map>

const std::map<std::string, std::vector<std::string>> passages{
    {"entrance", {"hall", "well"}}, {"hall", {"entrance", "gallery", "well"}},
    {"well", {"hall", "entrance"}}, {"gallery", {"hall", "crystal room"}},
    {"crystal room", {"gallery"}},  {"sealed room", {"vault"}},
    {"vault", {"sealed room"}},
};

class Room : public tess::Chare<Room, std::string> {
 public:
  void enter() {
    if (explored_) return;
    explored_ = true;
    tess::print("found the ", index(), "\n");
    for (const std::string& next : passages.at(index()))
      array()[next].send_or_create_home<&Room::enter>();
  }

 private:
  bool explored_ = false;
};

int main(int argc, char** argv) {
  return tess::run(argc, argv, [] {
    tess::create<Room>(tess::sparse)["entrance"].send_or_create_home<&Room::enter>();
  });
}
