#include "runtime/arrays/home_of_one.hpp"

#include "runtime/arrays/collection.hpp"

namespace tess::detail {

const IndexMapKind HomeOfOne::kind_{naming::name_of<HomeOfOne>(), &HomeOfOne::unpack};

HomeOfOne::HomeOfOne(CollectionId of, PeId given, std::int32_t n_pes)
    : HomeOfOne(of, given, given.value < 0 ? root_of(of, n_pes) : given, n_pes) {}

PeId HomeOfOne::home(const void* /*index*/, const Range& /*range*/, std::int32_t n_pes) const {
  if (n_pes == n_pes_) return pe_;
  return given_.value < 0 ? root_of(of_, n_pes) : PeId{given_.value % n_pes};
}

const IndexMapKind& HomeOfOne::kind() const {
  return kind_;
}

std::shared_ptr<const IndexMap> HomeOfOne::unpack(Reader& ar) {
  const auto of = ar.take<CollectionId>();
  const auto given = ar.take<PeId>(), pe = ar.take<PeId>();
  const auto n_pes = ar.take<std::int32_t>();
  return std::shared_ptr<const IndexMap>(new HomeOfOne(of, given, pe, n_pes));
}

std::vector<std::byte> HomeOfOne::saved_from(const IndexMap* map, PeId pe, std::int32_t n_pes) {
  const auto* const of_one = dynamic_cast<const HomeOfOne*>(map);
  if (of_one == nullptr) return {};
  const HomeOfOne now(of_one->of_, of_one->given_, pe, n_pes);
  return to_saved(&now);
}

}  // namespace tess::detail
