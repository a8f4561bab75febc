// expect: gather and in_order are in the order of indices: give the type of index an operator<=>
#include "runtime/runtime.hpp"

struct Day {
  std::string month;
  int day = 0;
  friend bool operator==(const Day&, const Day&) = default;
};

class Page : public tess::Chare<Page, Day> {
 public:
  void tell(tess::Callback<std::vector<std::pair<Day, int>>> target) {
    contribute(tess::gather, 1, target);
  }
};

void misuse(tess::ArrayProxy<Page> pages, tess::Callback<std::vector<std::pair<Day, int>>> target) {
  pages.broadcast<&Page::tell>(target);
}
