// expect: indices are compared: give the type of the index a defaulted operator==
#include "runtime/runtime.hpp"

struct Day {
  std::string month;
  int day = 0;
};
class Appointment : public tess::Chare<Appointment, Day> {};

void misuse() {
  tess::create<Appointment>(tess::sparse);
}
