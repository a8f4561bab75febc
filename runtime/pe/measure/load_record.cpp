#include "runtime/pe/measure/load_record.hpp"

#include <boost/unordered/unordered_flat_map.hpp>

namespace tess::detail {

struct SentTable::Table {
  boost::unordered_flat_map<ElementKey, SentTo, ElementKeyHash> by_receiver;
};

SentTable::SentTable() = default;
SentTable::~SentTable() = default;

void SentTable::add(const ElementKey& to, const SentTo& more) {
  if (!table_) table_ = std::make_unique<Table>();
  SentTo& sum = table_->by_receiver[to];
  sum.bytes += more.bytes;
  sum.messages += more.messages;
}

void SentTable::clear() {
  if (table_) table_->by_receiver.clear();
}

std::vector<std::pair<ElementKey, SentTo>> SentTable::entries() const {
  std::vector<std::pair<ElementKey, SentTo>> all;
  if (table_) all.assign(table_->by_receiver.begin(), table_->by_receiver.end());
  return all;
}

void LoadRecord::continue_at(double new_speed) {
  if (new_speed == speed) return;
  const auto scaled = [factor = speed / new_speed](std::uint64_t measured) {
    return static_cast<std::uint64_t>(static_cast<double>(measured) * factor);
  };
  ticks = scaled(ticks);
  for (MethodCost& entry : entries) entry.ticks = scaled(entry.ticks);
  speed = new_speed;
}

}  // namespace tess::detail
