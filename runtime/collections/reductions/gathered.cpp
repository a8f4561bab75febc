#include "runtime/collections/reductions/gathered.hpp"

#include "runtime/completion/completion.hpp"
#include "runtime/core/check.hpp"
#include "runtime/core/type_name.hpp"

#include <utility>

namespace tess::detail {

void settle(Completion& completion, const std::vector<EpochShare>& shares) {
  for (const EpochShare& share : shares)
    for (std::uint64_t k = 0; k < share.n; ++k) completion.processed(share.epoch);
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

void Gathered::merge_shares(const std::vector<EpochShare>& more) {
  for (const EpochShare& share : more) {
    bool found = false;
    for (EpochShare& mine : shares) {
      if (mine.epoch != share.epoch) continue;
      mine.n += share.n;
      found = true;
      break;
    }
    if (!found) shares.push_back(share);
  }
}

void Gathered::merge(Gathered&& more) {
  n += more.n;
  merge_value(std::move(more.value.held));
  merge_shares(more.shares);
}

}  // namespace tess::detail
