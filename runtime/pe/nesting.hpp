// User code that runs inside other user code on a PE: the constructor that runs, with the index and
// the collection of its element, and entry methods that another one calls inside its send().
#pragma once

#include "runtime/pe/interfaces/hosted_collection.hpp"

namespace tess::detail {

class Nesting {
 public:
  Nesting() = default;
  Nesting(const Nesting&) = delete;
  Nesting& operator=(const Nesting&) = delete;
  ~Nesting() = default;

  /// The index of the element under construction; null if there is none.
  [[nodiscard]] const void* constructed_index() const { return constructed_index_; }
  /// Its collection; null if there is none.
  [[nodiscard]] HostedCollection* constructing_collection() const { return collection_; }
  /// True inside a call of an entry method that another has made, or of code that must not call any.
  [[nodiscard]] bool nests() const { return n_calls_ != 0; }
  /// True if another call fits inside the present one.
  [[nodiscard]] bool has_room() const {
    return n_calls_ < most_calls && constructed_index_ == nullptr;
  }

  /// Marks the run of a constructor. Marks nest if a constructor creates a collection.
  class Construction {
   public:
    Construction(Nesting& of, const void* index, HostedCollection* collection)
        : of_(of), index_(of.constructed_index_), collection_(of.collection_) {
      of.constructed_index_ = index;
      of.collection_ = collection;
    }
    Construction(const Construction&) = delete;
    Construction& operator=(const Construction&) = delete;
    ~Construction() {
      of_.constructed_index_ = index_;
      of_.collection_ = collection_;
    }

   private:
    Nesting& of_;
    const void* index_;
    HostedCollection* collection_;
  };

  static constexpr unsigned most_calls = 16;
  /// Marks a call of an entry method inside another, or, with most_calls, code that must not call
  /// any.
  class Call {
   public:
    explicit Call(Nesting& of, unsigned n = 1) : of_(of), n_(n) { of_.n_calls_ += n_; }
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;
    ~Call() { of_.n_calls_ -= n_; }

   private:
    Nesting& of_;
    const unsigned n_;
  };

 private:
  const void* constructed_index_ = nullptr;
  HostedCollection* collection_ = nullptr;
  unsigned n_calls_ = 0;
};

}  // namespace tess::detail
