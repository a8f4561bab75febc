#include "runtime/watch/service/wait_round.hpp"

#include "runtime/core/text.hpp"
#include "runtime/pe/census.hpp"
#include "runtime/pe/report/pe_watch.hpp"
#include "runtime/pe/runtime.hpp"

#include <algorithm>

namespace tess::detail {

std::string text_of(const Runtime& runtime, WaitAnswer&& answer) {
  const std::string audit = runtime.audit_text(answer.waits.audit, [&](PeId pe) {
    return std::find(answer.silent.begin(), answer.silent.end(), pe) == answer.silent.end();
  });
  return list_of_waiting(std::move(answer.waits)) + audit;
}

WaitAnswer answer_of_all(Runtime& runtime, Time now) {
  WaitAnswer all;
  for (std::int32_t i = 0; i < runtime.machine().n_pes(); ++i) {
    Pe& pe = runtime.pe(PeId{i});
    all.waits.merge(census_of_running(pe));
    if (const Time more = pe.now() - now;
        more > Time(0) && pe.measuring().watch()->last() != nullptr)
      all.waits.add(WaitRank::handler,
                    text(pe.id(), " runs ", plain_name(pe.measuring().watch()->last()->name()),
                         " for another ", seconds_text(seconds(more))));
  }
  return all;
}

}  // namespace tess::detail
