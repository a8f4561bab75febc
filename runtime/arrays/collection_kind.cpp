#include "runtime/arrays/collection_kind.hpp"

#include <vector>

namespace tess::detail {
namespace {

std::vector<const CollectionKind*>& all_kinds() {
  static std::vector<const CollectionKind*> kinds;
  return kinds;
}

}  // namespace

CollectionKind::CollectionKind(naming::Name name, Saving saving_, Members members_, Make make_)
    : saving(saving_), members(members_), make(make_), name_(name) {
  all_kinds().push_back(this);
}

const CollectionKind* CollectionKind::find(std::string_view key) {
  for (const CollectionKind* kind : all_kinds())
    if (kind->key() == key) return kind;
  return nullptr;
}

}  // namespace tess::detail
