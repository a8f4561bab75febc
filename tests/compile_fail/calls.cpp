// Calls of entry methods that do not compile: their arguments, results, targets and sections.
#include "runtime/more/interface.hpp"
#include "runtime/more/process_group.hpp"
#include "runtime/more/scan.hpp"
#include "runtime/more/section.hpp"
#include "runtime/runtime.hpp"

#include <memory>
#include <string>
#include <utility>
#include <vector>

struct Cell : tess::Chare<Cell, tess::Index2> {
  void grow() {}
};
struct Counter : tess::Group<Counter> {
  void step() {}
};
class Shape {
 public:
  virtual ~Shape() = default;
};

class Block : public tess::Chare<Block> {
 public:
  void go(int /*steps*/) {}
  void step() {}
  void own(std::unique_ptr<int> /*x*/) {}

  // expect: an argument would lose digits
  void digits() { self().send<&Block::go>(3.7); }

  // control: an argument would lose its sign
  void other_digits() { self().send<&Block::go>(3.7F); }

  // control: an argument would lose digits
  void all_digits() { self().send<&Block::go>(3); }

  // expect: an entry method takes its arguments by value or const reference
  void fill(std::vector<double>& /*values*/) {}
  void by_reference() { self().send<&Block::fill>(std::vector<double>(3)); }

  // expect: these arguments are not what the entry method takes
  void name(std::string /*name*/) {}
  void wrong_arguments() { self().send<&Block::name>(std::vector<int>(3)); }

  // expect: unable to deduce
  // expect of clang: no matching member function for call to 'send'
  void set(int /*x*/) {}
  void set(std::string /*name*/) {}
  // It is send<tess::overload<int>(&Block::set)>(3).
  void overloaded() { self().send<&Block::set>(3); }

  // expect: an entry method returns void or tess::Task; ask<&C::f>() calls a function that returns a value
  int size() { return 1; }
  void returns_a_value() { self().send<&Block::size>(); }

  // expect: an entry method returns void or tess::Task
  tess::TaskOf<int> count() { co_return 1; }
  void returns_a_task_of() { self().send<&Block::count>(); }

  // expect: this entry method belongs to another class than the elements of this collection
  void method_of_another_class() { self().send<&Cell::grow>(); }

  // expect: each element gets a copy of a broadcast
  void broadcast_of_no_copy() { array().broadcast<&Block::own>(std::make_unique<int>(3)); }

  // expect: a reply is a value: a function that is asked returns no reference
  const std::vector<int>& values() { return values_; }
  void reply_by_reference() { (void)self().ask<&Block::values>(); }

  // expect: its last parameter is a tess::Callback<T>
  void sum(tess::Callback<int> done, int n) { done(n); }
  tess::Task reduce_without_target() { co_await array().reduce<&Block::sum>(3); }

  // expect: the value has another type than the target
  void add(tess::Callback<double> target) { contribute(tess::sum, 1, target); }

  // expect: a target is an entry method of one argument, or of none
  void put(int /*x*/, int /*y*/) {}
  void target_of_two_arguments() { (void)self().target<&Block::put>(); }

  // expect: each element gets a copy of a broadcast's arguments, so they can be copied
  void no_copy(tess::SectionProxy<Block> row) { row.broadcast<&Block::own>(nullptr); }

  // expect: this entry method belongs to another class than the elements of this collection
  void another_class(tess::SectionProxy<Block> row) { row.broadcast<&Counter::step>(); }

  // expect: the section is of an array with another type of index
  void give(tess::SectionProxy<Cell> cells, tess::Callback<int> sum) {
    contribute(cells, tess::sum, 1, sum);
  }

  // expect: a scan is over the elements of a whole array, not of a section
  void scan(tess::SectionProxy<Block> section) {
    contribute(section, tess::inclusive_scan(tess::sum), 1, self().target<&Block::go>());
  }

  // expect: the class of these elements does not implement the interface
  tess::InterfaceProxy<Shape> another_interface() { return self(); }

 private:
  std::vector<int> values_;
};

// expect: the indices of a section are of the array's type of index
void section_of(const tess::ArrayProxy<Cell>& cells, const std::vector<tess::Index1>& indices) {
  (void)tess::create_section(cells, indices);
}

// expect: the condition of a section is a function of an index that returns bool
void section_if(const tess::ArrayProxy<Cell>& cells) {
  (void)tess::create_section_if(cells, [](tess::Index1 index) { return index.x == 0; });
}

// expect: gather and in_order are in the order of indices: give the type of index an operator<=>
struct Day {
  std::string month;
  friend bool operator==(const Day&, const Day&) = default;
};
struct Page : tess::Chare<Page, Day> {
  using All = std::vector<std::pair<Day, int>>;
  void hear(tess::Callback<All> target) { contribute(tess::gather, 1, target); }
};

struct Cache {
  tess::Task load() { co_await tess::Future<int>(); }
  void put() {}
};

// expect: an entry method of a process group is no coroutine
void process_group_waits(tess::ProcessGroupProxy<Cache> caches) {
  caches.broadcast<&Cache::load>();
}

// expect: read() takes a function of (const G&)
void process_group_writes_in_read(tess::ProcessGroupProxy<Cache> caches) {
  caches.read([](Cache& cache) { cache.put(); });
}
