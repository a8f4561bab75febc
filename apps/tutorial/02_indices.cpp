// Step 2: indices of one to six coordinates, strings and structs; dense and sparse arrays; homes.
#include "runtime/runtime.hpp"

/// A field of a chess board: two coordinates.
class Field : public tess::Chare<Field, tess::Index2> {
 public:
  void colour() {
    tess::print("field ", index().x, ",", index().y,
                (index().x + index().y) % 2 ? " white" : " black", "\n");
  }
};

/// Named by a string. Its constructor takes arguments.
class City : public tess::Chare<City, std::string> {
 public:
  explicit City(int inhabitants) : inhabitants_(inhabitants) {}
  void count() { tess::print(index(), " has ", inhabitants_, " inhabitants\n"); }

 private:
  int inhabitants_;
};

/// A user's own index: any type that can be compared and serialised.
struct Day {
  std::string month;
  int day = 0;
  friend bool operator==(const Day&, const Day&) = default;
};

class Appointment : public tess::Chare<Appointment, Day> {
 public:
  /// The home of an index, chosen by the program: all days of a month are on one PE.
  static tess::PeId place(const Day& index, std::int32_t n_pes) {
    return tess::PeId{index.month < "July" ? 0 : n_pes - 1};
  }
  void show() { tess::print(index().month, " ", index().day, " is on ", tess::my_pe(), "\n"); }
};

int main(int argc, char** argv) {
  return tess::run(argc, argv, [] {
    const auto board = tess::create<Field>(tess::range(8, 8));  // dense: 64 elements exist
    board[{0, 0}].send<&Field::colour>();
    board[{3, 4}].send<&Field::colour>();

    const auto cities = tess::create<City>(tess::sparse);  // no element exists yet
    cities["Ulm"].insert(126'000);
    cities["Ulm"].send<&City::count>();

    const auto days = tess::create<Appointment>(tess::sparse);
    days[{"April", 1}].send_or_create_home<&Appointment::show>();
    days[{"May", 17}].send_or_create_home<&Appointment::show>();
  });
}
