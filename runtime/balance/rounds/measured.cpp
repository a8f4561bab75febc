#include "runtime/balance/rounds/measured.hpp"

#include <algorithm>

namespace tess::balance {
namespace {

// Packing an element only to measure its size costs as much as a migration, so each is measured
// when it is new and then once per several rounds.
constexpr std::uint64_t rounds_between_weighings = 16;

}  // namespace

void Measured::attach(Collection& array) {
  array_ = &array;
  meter_.add_balanced(&in_elements_);
  begin_phase();
  for (Element* element : array.elements())
    if (element != nullptr) entered(*element);
}

void Measured::detach() {
  if (array_ == nullptr) return;
  for (Element* element : array_->elements())
    if (element != nullptr) left(*element);
  meter_.remove_balanced(&in_elements_);
  array_ = nullptr;
}

void Measured::entered(Element& element) {
  BalanceRecord& record = BalancedElements::make_record(element);
  if (BalancedElements::never_ran(element)) record.load.since = LoadRecord::Since::construction;
  record.load.of_pe = &in_elements_;
  record.load.continue_at(speed_);
  record.position = BalanceRecord::nowhere;
}

void Measured::left(Element& element) {
  BalanceRecord& record = *BalancedElements::record_of(element);
  record.load.of_pe = nullptr;
  if (record.position != BalanceRecord::nowhere) reported_[record.position] = nullptr;
  record.position = BalanceRecord::nowhere;
}

// Stolen time is subtracted from both counters, possibly after the phase that it belongs to.
double Measured::busy_outside(Others others) const {
  const auto since = [](std::uint64_t now, std::uint64_t then) {
    return now - std::min(now, then);
  };
  const std::uint64_t busy = since(meter_.busy(), busy_before_);
  const std::uint64_t left_out = others == Others::balanced
                                     ? since(meter_.in_balanced(), in_balanced_before_)
                                     : since(in_elements_, in_elements_before_);
  return meter_.seconds(since(busy, left_out));
}

void Measured::begin_phase() {
  busy_before_ = meter_.busy();
  in_elements_before_ = in_elements_;
  in_balanced_before_ = meter_.in_balanced();
}

Load Measured::load_of(const BalanceRecord& record) const {
  return record.load.known() ? meter_.seconds(record.load.ticks) * speed_ : Load::unknown();
}

void Measured::keep_as_past(BalanceRecord& record) const {
  record.past = {load_of(record).seconds_or(-1), -1};
}

void Measured::add(Element& element, std::uint64_t round, PeReport& report) {
  BalanceRecord& record = *BalancedElements::record_of(element);
  record.position = reported_.size();
  reported_.push_back(&element);
  const std::uint64_t key = array_->key_of(element);
  if (array_->migratable() &&
      (record.size_bytes == 0 || (round + key) % rounds_between_weighings == 0))
    record.size_bytes = array_->packed_bytes(element);
  report.keys.push_back({array_->id(), key});
  report.loads.push_back(load_of(record));
  keep_as_past(record);
  report.migratable.push_back(array_->migratable() ? 1 : 0);
  report.size_bytes.push_back(record.size_bytes);
  if (const auto position = array_->position_of(element)) report.positions.push_back(*position);
  if (indices_ == SnapshotIndices::text)
    report.indices.push_back(element_text(element).substr(array_->name().size()));
  for (const auto& [to, sent] : record.load.sent.entries())
    report.parcels.push_back({record.position, to, sent.bytes, sent.messages});
  for (const LoadRecord::MethodCost& entry : record.load.entries) {
    const std::uint32_t action = entry.action->id();
    auto at = std::find_if(report.seconds_by_action.begin(), report.seconds_by_action.end(),
                           [action](const auto& one) { return one.first == action; });
    if (at == report.seconds_by_action.end())
      at = report.seconds_by_action.insert(at, {action, 0.0});
    at->second += meter_.seconds(entry.ticks);
  }
  record.load.clear();
}

PeReport Measured::report(std::uint64_t round, Others others) {
  PeReport report;
  report.background = busy_outside(others);
  begin_phase();
  for (Element* element : reported_)
    if (element != nullptr)
      BalancedElements::record_of(*element)->position = BalanceRecord::nowhere;
  reported_.clear();
  if (array_ == nullptr) return report;
  for (Element* element : array_->elements())
    if (element != nullptr) add(*element, round, report);
  return report;
}

PhaseSums Measured::sums(Others others) const {
  double seconds = 0;
  std::uint64_t n_measured = 0, n_unknown = 0;
  if (array_ == nullptr) {
    seconds = busy_outside(others);
    return {seconds, seconds * speed_, speed_, 0, 0, 0};
  }
  for (const Element* element : array_->elements()) {
    if (element == nullptr) continue;
    const LoadRecord& load = BalancedElements::record_of(*element)->load;
    if (load.known()) {
      seconds += meter_.seconds(load.ticks);
      ++n_measured;
    } else {
      ++n_unknown;
    }
  }
  const double all = seconds + busy_outside(others);
  return {all, all * speed_, speed_, seconds * speed_, n_measured, n_unknown};
}

void Measured::clear() {
  begin_phase();
  if (array_ == nullptr) return;
  for (Element* element : array_->elements())
    if (element != nullptr) BalancedElements::record_of(*element)->load.clear();
}

void Measured::pass_phase() {
  if (array_ != nullptr)
    for (Element* element : array_->elements()) {
      if (element == nullptr) continue;
      keep_as_past(*BalancedElements::record_of(*element));
    }
  clear();
}

PastLoad Measured::past() const {
  PastLoad sum{0, 0};
  if (array_ == nullptr) return sum;
  for (const Element* element : array_->elements()) {
    if (element == nullptr) continue;
    const PastLoad& past = BalancedElements::record_of(*element)->past;
    sum.of_last_phase += std::max(past.of_last_phase, 0.0);
    sum.since_then += std::max(past.since_then, 0.0);
  }
  return sum;
}

std::uint64_t Measured::recall(bool interrupted) {
  clear();
  std::uint64_t n_known = 0;
  if (array_ == nullptr) return n_known;
  for (Element* element : array_->elements()) {
    if (element == nullptr) continue;
    BalanceRecord& record = *BalancedElements::record_of(*element);
    const double past = interrupted ? record.past.since_then : record.past.of_last_phase;
    record.load.ticks = meter_.ticks(std::max(past, 0.0) / speed_);
    if (past < 0)
      record.load.since = LoadRecord::Since::somewhere;
    else
      ++n_known;
  }
  return n_known;
}

Measured::Moved Measured::move(const std::vector<Move>& moves) {
  Moved moved;
  for (const Move& one : moves) {
    Element* element = reported_[one.element];
    if (element == nullptr) continue;
    ++moved.n_elements;
    moved.n_bytes += BalancedElements::record_of(*element)->size_bytes;
    array_->move(*element, one.to);
  }
  return moved;
}

}  // namespace tess::balance
