#include "runtime/pe/report/audit.hpp"

#include "runtime/core/hash.hpp"
#include "runtime/core/text.hpp"

#include <map>
#include <tuple>

namespace tess::detail {
namespace {

/// Sent minus received. Unsigned sums wrap around, and their differences are right nevertheless.
struct Difference {
  std::uint64_t n = 0, numbers = 0, hashes = 0;
  [[nodiscard]] bool none() const { return n == 0 && numbers == 0 && hashes == 0; }
  void add(const AuditRow& row) {
    n += row.at_sender ? row.n : 0 - row.n;
    numbers += row.at_sender ? row.numbers : 0 - row.numbers;
    hashes += row.at_sender ? row.hashes : 0 - row.hashes;
  }
};

std::string describe(const Difference& of, const std::string& name, PeId from, PeId to) {
  const auto n = static_cast<std::int64_t>(of.n);
  const std::string path = text(" (", name, ") from ", from, " to ", to);
  if (n == 1 && of.hashes == mix(of.numbers))
    return text("message ", of.numbers, path, " was sent and has not arrived");
  if (n == -1 && 0 - of.hashes == mix(0 - of.numbers))
    return text("message ", 0 - of.numbers, path, " arrived twice");
  if (n > 0) return text(n, " messages", path, " were sent and have not arrived");
  if (n < 0) return text(-n, " messages", path, " arrived more often than they were sent");
  return text("of the messages", path,
              " as many arrived as were sent, but some twice and some not");
}

}  // namespace

void Audit::add(Sums& sums, std::uint32_t number) {
  ++sums.n;
  sums.numbers += number;
  sums.hashes += mix(number);
}

std::uint32_t Audit::sent(PeId to, std::uint32_t action) {
  Sums& sums = sent_[key(to, action)];
  const auto number = static_cast<std::uint32_t>(sums.n % ((std::uint64_t{1} << n_bits) - 1) + 1);
  add(sums, number);
  return number;
}

void Audit::received(PeId from, std::uint32_t action, std::uint32_t number) {
  add(received_[key(from, action)], number);
}

std::vector<AuditRow> Audit::rows() const {
  std::vector<AuditRow> all;
  all.reserve(sent_.size() + received_.size());
  const auto take = [&](const Table& table, bool at_sender) {
    for (const auto& [key, sums] : table) {
      const PeId other{static_cast<std::int32_t>(key >> 32U)};
      all.push_back({at_sender ? here_ : other, at_sender ? other : here_,
                     static_cast<std::uint32_t>(key), at_sender, sums.n, sums.numbers,
                     sums.hashes});
    }
  };
  take(sent_, true);
  take(received_, false);
  return all;
}

AuditResult compare(const std::vector<AuditRow>& rows,
                    const std::function<std::string(std::uint32_t)>& name,
                    const std::function<bool(PeId)>& answered) {
  AuditResult result;
  std::map<std::tuple<PeId, PeId, std::uint32_t>, Difference> differences;
  for (const AuditRow& row : rows) {
    if (row.at_sender) result.n_sent += row.n;
    if (answered(row.from) && answered(row.to))
      differences[{row.from, row.to, row.action}].add(row);
  }
  for (const auto& [of, difference] : differences) {
    const auto& [from, to, action] = of;
    if (!difference.none())
      result.differences.push_back(describe(difference, name(action), from, to));
  }
  return result;
}

}  // namespace tess::detail
