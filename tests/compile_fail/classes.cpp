// Classes of chares, arrays and indices that do not compile.
#include "runtime/more/index_map.hpp"
#include "runtime/more/interface.hpp"
#include "runtime/runtime.hpp"

#include <string>
#include <vector>

struct Plain : tess::Chare<Plain> {
  Plain() = default;
  explicit Plain(std::string /*name*/) {}
  void step() {}
};
struct Counter : tess::Group<Counter> {};
struct Flat : tess::Chare<Flat, tess::Index2> {};
struct Named : tess::Chare<Named, std::string> {};

// expect: create<C>() needs a class C that derives from tess::Chare<C, Index>
struct NoChare {};
void array_of_no_chare() {
  tess::create<NoChare>(tess::range(8));
}

// expect: a group has one member per PE
void array_of_group() {
  tess::create<Counter>(tess::range(8));
}

// expect: a group's class derives from tess::Group; create<C>(range) makes an array
void group_of_chare() {
  tess::create<Plain>(tess::each_pe);
}

// expect: derive publicly from tess::Chare
class DerivesPrivately : tess::Chare<DerivesPrivately> {};
void chare_derives_privately() {
  tess::create<DerivesPrivately>(tess::range(8));
}

// expect: the chare has no constructor that takes these arguments
void wrong_constructor() {
  tess::create<Plain>(tess::range(8), std::vector<int>(3));
}

// expect: a chare that is created on demand needs a default constructor
struct OfASize : tess::Chare<OfASize> {
  explicit OfASize(int /*size*/) {}
  void go() { self().send_or_create_here<&OfASize::go>(); }
};

// expect: describe_state() of a chare is `std::string describe_state() const` and public
struct DescribesItself : tess::Chare<DescribesItself> {
  std::string describe_state() { return "at step 3"; }
};
void describe_state_not_const() {
  tess::create<DescribesItself>(tess::range(8));
}

// expect: dead_letters of a chare is `static constexpr auto dead_letters = tess::DeadLetters::…` and public
class WaitsInPrivate : public tess::Chare<WaitsInPrivate> {
  static constexpr auto dead_letters = tess::DeadLetters::wait;
};
void private_dead_letters() {
  tess::create<WaitsInPrivate>(tess::range(8));
}

// expect: place() of a chare is `static tess::PeId place(const Index&, std::int32_t n_pes)`
struct OnANumber : tess::Chare<OnANumber> {
  static int place(tess::Index1 index, std::int32_t n_pes) { return index.x % n_pes; }
};
void place_gives_a_number() {
  tess::create<OnANumber>(tess::range(8));
}

// expect: place() of a chare is `static tess::PeId place(const Index&, std::int32_t n_pes)`
struct OnAnyNumber : tess::Chare<OnAnyNumber> {
  static tess::PeId place(tess::Index1 index) { return tess::PeId{index.x % tess::n_pes()}; }
};
void place_without_the_number_of_pes() {
  tess::create<OnAnyNumber>(tess::range(8));
}

// expect: a map takes an index of the array and the number of PEs, and returns a tess::PeId
struct ByNumber {
  tess::PeId operator()(const tess::Index1& index, std::int32_t n_pes) const {
    return tess::PeId{index.x % n_pes};
  }
};
void map_of_another_index() {
  (void)tess::create<Flat>(tess::mapped(tess::range(4, 4), ByNumber{}));
}

// expect: indices are compared: give the type of the index a defaulted operator==
struct Day {
  std::string month;
};
struct Appointment : tess::Chare<Appointment, Day> {};
void index_without_equality() {
  tess::create<Appointment>(tess::sparse);
}

// expect: an array with this type of index starts sparse: create<C>(tess::sparse)
void range_of_names() {
  tess::create<Named>(tess::range(8));
}

// expect: no matching function for call to
void range_of_numbers() {
  tess::create<Flat>({2, 2});
}

// expect: an index has a number for each axis: array[{x, y}]
void too_few_coordinates(tess::ArrayProxy<Flat> all) {
  (void)all[{1}];
}

// expect: an index has one number for each axis, and no more
void too_many_coordinates(tess::ArrayProxy<Plain> all) {
  (void)all[{0, 1}];
}

// expect: EntryAttributes names a function that is no member of its class
struct AttributeOfAnother : tess::Chare<AttributeOfAnother> {
  void step() { self().send<&AttributeOfAnother::step>(); }
  using EntryAttributes = tess::Attributes<tess::EntryMethod<&Plain::step, tess::expedited>>;
};

// expect: the EntryAttributes of a chare are tess::Attributes<…>
struct AttributesOfAnotherKind : tess::Chare<AttributesOfAnotherKind> {
  void step() { self().send<&AttributesOfAnotherKind::step>(); }
  using EntryAttributes = int;
};

// expect: an attribute of an entry method is tess::inline_when_local
struct UnknownAttribute : tess::Chare<UnknownAttribute> {
  void step() { self().send<&UnknownAttribute::step>(); }
  using EntryAttributes = tess::Attributes<tess::EntryMethod<&UnknownAttribute::step, 5>>;
};

// expect: an entry method has one priority
struct TwoPriorities : tess::Chare<TwoPriorities> {
  void step() { self().send<&TwoPriorities::step>(); }
  using EntryAttributes =
      tess::Attributes<tess::EntryMethod<&TwoPriorities::step, tess::Priority{1},
                                         tess::inline_when_local, tess::expedited>>;
};

// expect: EntryAttributes is a public type of its class
class PrivateAttributes : public tess::Chare<PrivateAttributes> {
  void step() { self().send<&PrivateAttributes::step>(); }
  using EntryAttributes = tess::Attributes<tess::EntryMethod<&PrivateAttributes::step, 5>>;
};

// expect: a group has all its members: none is created on demand
struct OnDemand : tess::Group<OnDemand> {
  void step() { group()[tess::PeId{0}].send<&OnDemand::step>(); }
  using EntryAttributes = tess::Attributes<tess::EntryMethod<&OnDemand::step, tess::create_home>>;
};

// expect: a member of a group is created, moved and destroyed with its group
void destroys_a_member(tess::GroupProxy<OnDemand> group) {
  group[tess::PeId{0}].destroy();
}

// expect: an interface creates no element: its class is not known
struct Measured {
  virtual ~Measured() = default;
  virtual double area() = 0;
  using EntryAttributes = tess::Attributes<tess::EntryMethod<&Measured::area, tess::create_home>>;
};
void interface_creates_by_ask(tess::InterfaceProxy<Measured> shape) {
  (void)shape.ask<&Measured::area>();
}

// expect: an interface creates no element: its class is not known
struct Growing {
  virtual ~Growing() = default;
  virtual void grow() = 0;
  using EntryAttributes = tess::Attributes<tess::EntryMethod<&Growing::grow, tess::create_here>>;
};
void interface_creates_by_send(tess::InterfaceProxy<Growing> shape) {
  shape.send<&Growing::grow>();
}
