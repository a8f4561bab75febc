// Step 8: epochs. How many moves does a knight need to each field of a board? Each field passes its
// number on to those that a knight reaches from it, whenever it finds a smaller one. No field can
// see when all are done; the epoch can.
#include "runtime/runtime.hpp"

constexpr std::array<tess::Index2, 8> jumps{
    {{1, 2}, {2, 1}, {2, -1}, {1, -2}, {-1, -2}, {-2, -1}, {-2, 1}, {-1, 2}}};

class Field : public tess::Chare<Field, tess::Index2> {
 public:
  void reach(int moves) {
    if (moves >= moves_) return;
    moves_ = moves;
    for (const tess::Index2 jump : jumps) {
      const tess::Index2 to{index().x + jump.x, index().y + jump.y};
      if (to.x >= 0 && to.y >= 0 && to.x < 8 && to.y < 8)
        array()[to].send<&Field::reach>(moves + 1);
    }
  }
  void report(tess::Callback<int> most) { contribute(tess::max, moves_, most); }

 private:
  int moves_ = 1000;
};

tess::Task play() {
  const auto board = tess::create<Field>(tess::range(8, 8));
  for (const tess::Index2 start : {tess::Index2{0, 0}, tess::Index2{3, 3}}) {
    // Ends when the message, all that it caused, and all that those caused, are done.
    co_await tess::epoch([&] { board[start].send<&Field::reach>(0); });
    tess::print("at most ", co_await board.reduce<&Field::report>(), " moves\n");
  }
}

int main(int argc, char** argv) {
  return tess::run(argc, argv, play);
}
