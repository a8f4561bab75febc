// What a checkpoint knows of a class of collections: a name that is the same in every run of a
// program, and how a part of such a collection is made. Each class of arrays and groups has one
// static object of this type, which registers itself before main().
#pragma once

#include "runtime/core/ids.hpp"
#include "runtime/core/index.hpp"
#include "runtime/core/type_name.hpp"

#include <cstdint>
#include <memory>
#include <string_view>

namespace tess::detail {

class Collection;
class Pe;

/// What a checkpoint does with the collections of a class.
enum class Saving : std::uint8_t {
  elements,    ///< saves their elements
  skipped,     ///< leaves them out: they belong to a library that makes them anew
  impossible,  ///< refuses to save: the class has no default constructor or no serialize()
  shared,      ///< refuses to save: the PEs of a process share an object
};

class CollectionKind {
 public:
  using Make = std::unique_ptr<Collection> (*)(Pe&, CollectionId, const Range&);
  /// What a class lets a restart do with the members of a group.
  enum class Members : std::uint8_t {
    of_array,  ///< no group: the elements go wherever their homes are
    fixed,     ///< as many as there were
    absorbed,  ///< any number: a member can absorb() another one
  };

  CollectionKind(naming::Name name, Saving saving, Members members, Make make);
  /// The kind with this key; null if the program has none.
  [[nodiscard]] static const CollectionKind* find(std::string_view key);

  /// The linker's name of the class: no other class has it.
  [[nodiscard]] std::string_view key() const { return name_.key(); }

  const Saving saving;
  const Members members;
  const Make make;

 private:
  const naming::Name name_;
};

}  // namespace tess::detail
