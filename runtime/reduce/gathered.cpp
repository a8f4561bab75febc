#include "runtime/reduce/gathered.hpp"

#include "runtime/core/algorithm.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/type_name.hpp"
#include "runtime/pe/completion/counted.hpp"

#include <utility>

namespace tess::detail {

void settle(Completion& completion, const std::vector<EpochShare>& shares) {
  for (const EpochShare& share : shares)
    for (std::uint64_t k = 0; k < share.n; ++k) (void)Counted(completion, share.epoch);
}

void Gathered::merge_value(std::unique_ptr<Partial> more) {
  if (!more) return;
  if (!value.held) {
    kind = &more->kind();
    value.held = std::move(more);
    return;
  }
  TESS_CHECK(kind == &more->kind(),
             "contributions to one reduction have different values, operations or results: ",
             plain_name(kind->name()), " and ", plain_name(more->kind().name()));
  value.held->merge(std::move(*more));
}

void Gathered::merge_share(const EpochShare& more) {
  const auto mine = std::find_if(shares.begin(), shares.end(), [&more](const EpochShare& share) {
    return share.epoch == more.epoch;
  });
  if (mine == shares.end()) {
    shares.push_back(more);
  } else {
    mine->n += more.n;
  }
}

void Gathered::add(Completion& completion, EpochId epoch, std::unique_ptr<Partial> more) {
  Counted::departs(completion, epoch);
  ++n;
  merge_value(std::move(more));
  merge_share({epoch, 1});
}

void Gathered::merge(Gathered&& more) {
  n += more.n;
  merge_value(std::move(more.value.held));
  for (const EpochShare& share : more.shares) merge_share(share);
}

}  // namespace tess::detail
