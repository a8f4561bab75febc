// Step 11: a race. A membrane of 4 x 4 tiles swings: in each step every tile is told to begin, sends
// its rims to its four neighbours, and moves when it has theirs. That is right on most machines and
// wrong in some orders of messages, which `--sim seeds=1..200` finds.
#include "runtime/command_line.hpp"
#include "runtime/runtime.hpp"

#include <cmath>

constexpr int n_tiles = 4, width = 8, n_steps = 60;

struct Rim {
  tess::Index2 from;  // the side that it belongs to: (1, 0) is that of the greater x
  std::vector<double> values;

  template <class Ar>
  void serialize(Ar& ar) {
    ar(from, values);
  }
};

class Tile : public tess::Chare<Tile, tess::Index2> {
 public:
  Tile() = default;
  Tile(bool mended, tess::Callback<double> done) : mended_(mended), done_(done) {
    for (int y = 1; y <= width; ++y)
      for (int x = 1; x <= width; ++x)
        now_[at(x, y)] = std::exp(-0.1 * (std::pow(index().x * width + x - 16, 2) +
                                          std::pow(index().y * width + y - 16, 2)));
    before_ = now_;
  }

  /// `sum`: of the squares of all heights after the last step.
  void begin(double sum) {
    if (n_begun_++ == n_steps) {
      if (index() == tess::Index2{0, 0}) done_(sum);
      return;
    }
    for (const tess::Index2 side : {tess::Index2{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      std::vector<double> rim;
      for (int k = 1; k <= width; ++k) rim.push_back(now_[place(side, k, width, 1)]);
      const tess::Index2 to{(index().x + side.x + n_tiles) % n_tiles,
                            (index().y + side.y + n_tiles) % n_tiles};
      array()[to].send<&Tile::receive>(Rim{{-side.x, -side.y}, rim});
    }
    if (mended_) arrive();
  }
  void receive(const Rim& rim) {
    for (int k = 1; k <= width; ++k)
      now_[place(rim.from, k, width + 1, 0)] = rim.values[static_cast<std::size_t>(k - 1)];
    arrive();
  }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(mended_, done_, n_begun_, n_arrived_, now_, before_);
  }

 private:
  static std::size_t at(int x, int y) { return static_cast<std::size_t>(y * (width + 2) + x); }
  /// The k-th cell of a side, whose greater coordinate is `most` and whose smaller one is `least`.
  static std::size_t place(tess::Index2 side, int k, int most, int least) {
    const int end = side.x + side.y > 0 ? most : least;
    return side.x != 0 ? at(end, k) : at(k, end);
  }
  void arrive() {
    if (++n_arrived_ < (mended_ ? 5 : 4)) return;
    n_arrived_ = 0;
    std::vector<double> next = now_;
    double sum = 0;
    for (int y = 1; y <= width; ++y)
      for (int x = 1; x <= width; ++x) {
        const double around =
            now_[at(x - 1, y)] + now_[at(x + 1, y)] + now_[at(x, y - 1)] + now_[at(x, y + 1)];
        double& height = next[at(x, y)];
        height = now_[at(x, y)] - before_[at(x, y)] + 0.25 * around;
        sum += height * height;
      }
    before_ = now_;
    now_ = next;
    contribute(tess::sum, sum, array().target<&Tile::begin>());
  }

  bool mended_ = false;
  tess::Callback<double> done_;
  int n_begun_ = 0, n_arrived_ = 0;
  std::vector<double> now_ = std::vector<double>((width + 2) * (width + 2)), before_;
};

tess::Task swing(bool mended) {
  tess::Future<double> sum;
  const auto tiles = tess::create<Tile>(tess::range(n_tiles, n_tiles), mended, sum.callback());
  tiles.broadcast<&Tile::begin>(0.0);
  tess::print("sum of squares: ", co_await sum, "\n");
}

int main(int argc, char** argv) {
  return tess::guarded(argc, argv, [&](tess::Setup& setup) {
    bool mended = false;
    tess::CommandLine line("Swings a membrane of 4 x 4 tiles for 60 steps.");
    line.flag("--mended", mended, "begin counts as a message, too");
    if (!line.parse(argc, argv)) return 0;
    return tess::run(setup, [=] { return swing(mended); });
  });
}
