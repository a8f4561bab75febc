#include "runtime/balance/honour.hpp"

#include "runtime/balance/loads.hpp"
#include "runtime/core/error.hpp"

namespace tess::balance {
namespace {

void check(const Snapshot& s, const Assignment& wanted, std::string_view strategy) {
  if (wanted.size() != s.elements.size())
    fail(ErrorCode::bad_value, "balance strategy ", strategy, ": returned ", wanted.size(),
         " PEs for ", s.elements.size(), " elements; give one for each");
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (wanted[i].value < 0 || slot(wanted[i]) >= s.pes.size())
      fail(ErrorCode::out_of_range, "balance strategy ", strategy, ": element ", i,
           s.elements.index.empty() ? "" : " " + s.elements.index[i], " to ", wanted[i],
           "; choose one of PE 0 … ", s.pes.size() - 1);
}

}  // namespace

Assignment honour(const Snapshot& s, const Assignment& wanted, std::string_view strategy) {
  check(s, wanted, strategy);
  Assignment result = s.elements.pe;
  Loads loads(s);
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < result.size(); ++i)
    if (s.elements.migratable[i] && wanted[i] != result[i]) open.push_back(i);
  for (std::size_t before = open.size() + 1; open.size() < before;) {
    before = open.size();
    std::erase_if(open, [&](std::size_t i) {
      if (!loads.fits(i, slot(result[i]), slot(wanted[i]))) return false;
      loads.move_memory(i, slot(result[i]), slot(wanted[i]));
      result[i] = wanted[i];
      return true;
    });
  }
  return result;
}

}  // namespace tess::balance
