// Values that a message, a reply, a future or a mailbox cannot hold, and what print() cannot write.
#include "runtime/more/scoped.hpp"
#include "runtime/more/when.hpp"
#include "runtime/runtime.hpp"

#include <memory>
#include <string>
#include <vector>

struct Particle {
  double mass = 1;
};

struct Reader : tess::Chare<Reader> {
  template <class Value>
  void take(Value /*value*/) {}
  template <class Value>
  void take_const(const Value& /*value*/) {}
  template <class Value>
  Value give() {
    return Value(3);
  }
};
const tess::ElementProxy<Reader> reader;

/// It has no default constructor.
template <int which>
struct Sum {
  explicit Sum(int first) : value(first) {}
  int value;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(value);
  }
};

// expect: an aggregate with a base class needs `template <class Ar> void serialize(Ar& ar)`
struct Charged : Particle {
  double charge = 1;
};
void aggregate_with_a_base_class() {
  reader.send<&Reader::take<Charged>>(Charged());
}

// expect: an aggregate that is also a container has members of its own
struct Named : std::vector<double> {
  std::string name;
};
void container_with_a_member() {
  reader.send<&Reader::take<Named>>(Named());
}

// expect: serialize() is inherited from a base class and may leave out members of this class
struct Packed {
  template <class Ar>
  void serialize(Ar& ar) {
    ar(mass);
  }
  double mass = 1;
};
struct PackedAndCharged : Packed {
  double charge = 1;
};
void inherited_serialize_of_an_argument() {
  reader.send<&Reader::take<std::vector<PackedAndCharged>>>(std::vector<PackedAndCharged>(3));
}

// expect: serialize() is inherited from a base class and may leave out members of this class
struct Model {
  template <class Ar>
  void serialize(Ar& ar) {
    ar(temperature);
  }
  double temperature = 0;
};
struct Heat : tess::Chare<Heat>, Model {
  int n_warmings = 0;
};
void inherited_serialize_of_a_chare() {
  tess::create<Heat>(tess::range(8));
}

// expect: the arguments of an entry method need default constructors
void argument_without_default_constructor() {
  reader.send<&Reader::take_const<Sum<0>>>(Sum<0>(3));
}

// expect: a reply needs a default constructor
void reply_without_default_constructor() {
  (void)reader.ask<&Reader::give<Sum<1>>>();
}

// expect: the value of a future needs a default constructor
tess::Task future_without_default_constructor() {
  tess::Future<Sum<2>> sum;
  sum.callback()(Sum<2>(3));
  (void)co_await sum;
}

// expect: a pointer means nothing in another process
void pointer_in_a_message(const int* at) {
  reader.send<&Reader::take<const int*>>(at);
}

// expect: a unique_ptr to an abstract class cannot be read: hold a std::variant
struct Shape {
  virtual ~Shape() = default;
  virtual double area() const = 0;
  template <class Ar>
  void serialize(Ar& /*ar*/) {}
};
void pointer_to_an_abstract_class() {
  reader.send<&Reader::take<std::unique_ptr<Shape>>>(nullptr);
}

// expect: a shared_ptr is not shared between processes: hold a unique_ptr
void shared_pointer_in_a_message() {
  reader.send<&Reader::take<std::shared_ptr<int>>>(std::make_shared<int>(3));
}

// expect: a Scoped cannot be sent, since the copy would own the same thing
void scoped_in_a_message(tess::ArrayProxy<Reader> array) {
  using Scope = tess::Scoped<tess::ArrayProxy<Reader>>;
  reader.send<&Reader::take<Scope>>(Scope(array));
}

// expect: the key of a mailbox is compared with < and ==
struct Step {
  int phase = 0, round = 0;
};
struct Edge {
  Step step;
};
void mailbox_key_without_order() {
  tess::Mailbox<&Edge::step> edges;
  edges.put(Edge());
}

// expect: a task gives a value: TaskOf<T> of a T that is no reference and not const
tess::TaskOf<const int&> task_of_a_reference(const int& number) {
  co_return number;
}

// expect: the function given to run() returns void or tess::Task: nothing would take a value
int main_gives_a_value(tess::Setup& setup) {
  return tess::run(setup, []() -> tess::TaskOf<int> { co_return 1; });
}

// expect: a vector is moved in: when_all(std::move(vector))
tess::Task when_all_of_a_variable(std::vector<tess::Task> tasks) {
  co_await tess::when_all(tasks);
}

// expect: when_all and when_any take asks, futures, epochs, mailbox.take(…) and tess::sleep(…)
void when_any_of_a_value() {
  (void)tess::when_any(tess::sleep(std::chrono::milliseconds(1)), 5);
}

// expect: print() takes numbers, strings and what has an operator<< for std::ostream; it takes an index as index_text(index())
void print_of_an_index() {
  tess::print("element ", tess::Index2{1, 2}, "\n");
}
