// Interfaces: elements of different classes, called through a base class that they share. Not part
// of runtime.hpp.
//
// Sample: tests/samples/interface.cpp
//
//     class Shape {
//      public:
//       virtual ~Shape() = default;
//       virtual void grow(double by) = 0;
//       [[nodiscard]] virtual double area() const = 0;
//     };
//     class Circle : public tess::Chare<Circle>, public Shape {
//     // …
//     const std::vector<tess::InterfaceProxy<Shape>> shapes{circles[{0}], squares[{0}], circles[{1}]};
//     // …
//       for (const auto& shape : shapes) shape.send<&Shape::grow>(2.0);
//
// The elements are in arrays of their own classes, whose type of index is the same. A proxy of an
// element becomes one of its interface, which can be stored, sent and used on every PE. A message
// carries the way from the element's class to the interface, so it needs no search by type; it
// finds the element wherever that has migrated, and calls the function that its class overrides. An
// array has an interface as well: InterfaceArray<Shape> broadcasts to all of its elements, and
// array[index] is one of them.
#pragma once

#include "runtime/array.hpp"
#include "runtime/core/registered_pointer.hpp"
#include "runtime/more/singleton.hpp"

#include <concepts>
#include <functional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

namespace tess {

namespace detail {
/// For messages: elements with this type of index that implement I.
template <class I, class IndexType>
struct Implements {
  using Index = IndexType;
};
}  // namespace detail
/// Reports name the interface.
template <class I, class IndexType>
inline constexpr std::string_view name_of_type<detail::Implements<I, IndexType>> = name_of_type<I>;

namespace detail {

/// How an element is seen as an interface; one static object for each pair of interface and class.
template <class I>
struct Face : Registered {
  using Cast = I& (*)(Element&);
  Face(naming::Name name, Cast cast_) : Registered(name), cast(cast_) {}
  Cast cast;
};
template <class I, class C>
struct FaceOf {
  static I& cast(Element& element) { return static_cast<C&>(element); }
  static inline const Face<I> face{naming::name_of<FaceOf>(), &cast};
};

/// The same as a value in messages.
template <class I>
using FacePointer = RegisteredPointer<Face<I>>;

/// Checks that elements of C can be called through I.
template <class C, class I, class IndexType>
consteval bool check_interface() {
  static_assert(std::is_base_of_v<I, C>,
                "the class of these elements does not implement the interface");
  static_assert(std::convertible_to<C*, I*>,
                "a class derives from its interface publicly, and once");
  static_assert(std::is_same_v<typename C::Index, IndexType>,
                "the elements have another type of index: name it, InterfaceProxy<I, Index2>");
  return true;
}

/// The head of a call through an interface: how the element is seen, and the priority.
template <class I>
struct Through {
  FacePointer<I> face;
  Priority priority;
};

}  // namespace detail

template <class I, class IndexType>
class InterfaceArray;

/// The proxy of an element by an interface of its class: a value that can be stored and sent. I may
/// be any class with virtual functions; a priority in its EntryAttributes holds for its messages,
/// create_here and create_home do not compile.
template <class I, class IndexType = Index1>
class InterfaceProxy : public Sends<InterfaceProxy<I, IndexType>> {
  using Class = detail::Implements<I, IndexType>;
  using Head = detail::Through<I>;

 public:
  using Index = IndexType;
  using Receiver = I;
  template <class Self>
  using Verbs = Sends<Self>;

  /// It refers to no element: it can only be assigned to.
  InterfaceProxy() = default;
  /// The element as it is seen by its interface.
  template <class C>
  InterfaceProxy(const ElementProxy<C, IndexType>& element)
      : collection_(element.array().id()), index_(element.index()) {
    if constexpr (detail::check_interface<C, I, IndexType>())
      face_ = detail::FacePointer<I>(detail::FaceOf<I, C>::face);
  }
  template <class C>
  InterfaceProxy(const ChareProxy<C>& chare) : InterfaceProxy(chare.element()) {}

  [[nodiscard]] const Index& index() const { return index_; }

  friend bool operator==(const InterfaceProxy&, const InterfaceProxy&) = default;
  [[nodiscard]] std::size_t hash() const {
    return static_cast<std::size_t>(mix(collection_.value ^ IndexHash<Index>()(index_)));
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(collection_, index_, face_);
  }

 private:
  friend class InterfaceArray<I, IndexType>;
  friend detail::ProxyAccess;

  InterfaceProxy(CollectionId collection, const Index& index, detail::FacePointer<I> face)
      : collection_(collection), index_(index), face_(face) {}

  static consteval bool check_on_demand() {
    static_assert(sizeof(I) == 0, "an interface creates no element: its class is not known");
    return false;
  }
  template <auto F, class Of>
  [[nodiscard]] Head head(detail::How<Of> how) const {
    static_assert(detail::entry_rule<I, F>.demand == detail::Demand::none,
                  "an interface creates no element: its class is not known");
    return {face_, Priority{detail::priority_by<I, F>(how.of)}};
  }
  template <auto F, class Of, class... Args>
  void post(detail::How<Of> how, Args&&... args) const {
    static_assert(detail::check_entry<I, F, Args...>());
    Pe& pe = current_pe();
    post_message(pe, detail::Call<Class, Head, F>::make(pe, collection_, index_, head<F>(how),
                                                        std::forward<Args>(args)...));
  }
  template <auto F, class Of, class... Args>
  [[nodiscard]] Ask<Class, F> ask_as(detail::How<Of> how, Args&&... args) const {
    static_assert(detail::check_ask<I, F, Args...>());
    Pe& pe = current_pe();
    Ask<Class, F> reply(collection_, index_);
    post_message(pe,
                 detail::AskCall<Class, Head, F>::make(pe, collection_, index_, head<F>(how),
                                                       reply.place(), std::forward<Args>(args)...));
    return reply;
  }
  template <class Message>
  void post_message(Pe& pe, Message* message) const {
    detail::weigh(pe, collection_, index_, message->arguments);
    detail::post_new(pe, message, [this] {
      TESS_CHECK(!face_.empty(), "a message to an empty InterfaceProxy<", name_of_type<I>,
                 ">: assign array[index] to it first");
    });
  }
  [[nodiscard]] std::tuple<CollectionId, Index, detail::FacePointer<I>> fields() const {
    return {collection_, index_, face_};
  }
  [[nodiscard]] std::string in_words() const {
    return text(plain_name(name_of_type<I>), index_text(index_));
  }

  CollectionId collection_{};
  Index index_{};
  detail::FacePointer<I> face_;
};

/// The proxy of an array by an interface of its elements' class.
template <class I, class IndexType = Index1>
class InterfaceArray : public Broadcasts<InterfaceArray<I, IndexType>> {
 public:
  using Index = IndexType;
  using Receiver = I;
  template <class Self>
  using Verbs = Broadcasts<Self>;

  /// It refers to no array: it can only be assigned to.
  InterfaceArray() = default;
  template <class C>
  InterfaceArray(const ArrayProxy<C>& array) : id_(array.id()) {
    if constexpr (detail::check_interface<C, I, IndexType>())
      face_ = detail::FacePointer<I>(detail::FaceOf<I, C>::face);
  }

  [[nodiscard]] InterfaceProxy<I, IndexType> operator[](const Index& index) const {
    return {id_, index, face_};
  }
  [[nodiscard]] CollectionId id() const { return id_; }

  friend bool operator==(const InterfaceArray&, const InterfaceArray&) = default;
  [[nodiscard]] std::size_t hash() const { return std::hash<CollectionId>()(id_); }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(id_, face_);
  }

 private:
  friend detail::ProxyAccess;

  template <auto F, class Of, class... Args>
  void broadcast_as(Of of, Args&&... args) const {
    static_assert(detail::check_broadcast<I, F, Args...>());
    using Arguments = typename detail::EntryTraits<F>::Arguments;
    TESS_CHECK(!face_.empty(), "a broadcast to an empty InterfaceArray<", name_of_type<I>,
               ">: assign an array to it first");
    detail::start_broadcast(id_,
                            detail::SharedCall(new detail::CallOfAll<I, detail::Through<I>, F>(
                                {face_, Priority{detail::priority_by<I, F>(of)}},
                                detail::as_parameters<Arguments>(std::forward<Args>(args)...))));
  }
  [[nodiscard]] std::tuple<CollectionId, detail::FacePointer<I>> fields() const {
    return {id_, face_};
  }
  [[nodiscard]] std::string in_words() const {
    return "all elements of " + plain_name(name_of_type<I>);
  }

  CollectionId id_{};
  detail::FacePointer<I> face_;
};

}  // namespace tess
