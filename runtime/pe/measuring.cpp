#include "runtime/pe/measuring.hpp"

#include "runtime/pe/measure/idle_time.hpp"
#include "runtime/pe/message_audit.hpp"
#include "runtime/pe/pe.hpp"
#include "runtime/pe/report/pe_watch.hpp"
#include "runtime/pe/runtime.hpp"

#include <algorithm>
#include <utility>

namespace tess::detail {

Measuring::Measuring(Pe& pe) : pe_(pe) {}
Measuring::~Measuring() = default;

Meter& Measuring::make_meter() {
  if (!meter_)
    meter_ =
        idle_meter_ ? std::move(idle_meter_) : std::make_unique<Meter>(pe_.machine(), pe_.id());
  return *meter_;
}
Meter& Measuring::start_meter() {
  measures_for_good_ = true;
  return make_meter();
}
Meter& Measuring::start_brief_meter() {
  ++n_brief_;
  return make_meter();
}
void Measuring::stop_brief_meter() {
  if (--n_brief_ == 0 && !measures_for_good_) idle_meter_ = std::move(meter_);
}
void Measuring::forget(const LoadRecord& record) {
  for (Meter* meter : {meter_.get(), idle_meter_.get()})
    if (meter != nullptr) meter->forget(&record);
}

void Measuring::start_elements() {
  const Meter& meter = measures_elements_ ? *meter_ : start_brief_meter();
  measures_elements_ = true;
  began_ = meter.now();
  busy_before_ = current_pe_or_null() == &pe_ ? meter.busy_until_now() : meter.busy();
  in_records_before_ = meter.in_records();
  messages_before_ = pe_.statistics().messages;
  largest_ended_ = {};
  main_record_.in_run = 0;
  const ElementWords& words = pe_.runtime().element_words();
  for (const HostedCollection* collection : pe_.collections().all())
    for (Element* element : collection->elements())
      if (element != nullptr)
        if (LoadRecord* const record = words.load(*element)) record->in_run = 0;
}

void Measuring::stop_elements() {
  if (std::exchange(measures_elements_, false)) stop_brief_meter();
}

PeLoad Measuring::load() const {
  PeLoad load;
  if (!measures_elements_) {
    if (idle_time_ == nullptr) return load;
    load.seconds = seconds(pe_.now());
    load.busy = load.seconds - seconds(idle_time_->total());
    return load;
  }
  const std::uint64_t n_messages = pe_.statistics().messages - messages_before_;
  load.seconds = meter_->seconds(meter_->now() - began_);
  // Stolen time is taken back from both, possibly after the beginning.
  const auto since = [this](std::uint64_t now, std::uint64_t then) {
    return meter_->seconds(now - std::min(now, then));
  };
  load.busy = since(meter_->busy_until_now(), busy_before_) +
              seconds(pe_.machine().message_cost()) * static_cast<double>(n_messages);
  load.in_elements = since(meter_->in_records(), in_records_before_);
  const ElementWords& words = pe_.runtime().element_words();
  std::uint64_t most = main_record_.in_run;
  load.element = "the main program";
  if (largest_ended_.ticks > most) {
    most = largest_ended_.ticks;
    load.element = largest_ended_.element;
  }
  const Element* largest = nullptr;
  for (const HostedCollection* collection : pe_.collections().all())
    for (Element* element : collection->elements()) {
      const LoadRecord* const record = element != nullptr ? words.load(*element) : nullptr;
      if (record == nullptr || record->in_run <= most) continue;
      most = record->in_run;
      largest = element;
    }
  if (largest != nullptr) load.element = words.text(*largest);
  load.largest = meter_->seconds(most);
  return load;
}

MainScope::MainScope(Pe& pe) : meter_(pe.meter()) {
  if (meter_ != nullptr) outer_ = meter_->enter({&pe.measuring().main_record(), pe.running()});
}

void Measuring::start_trace(std::size_t most_records) {
  start_meter();
  trace_ = std::make_unique<Trace>(most_records);
}

void Measuring::start_watch() {
  watch_ = std::make_unique<PeWatch>();
  start_meter().show_to(pe_);
}

void Measuring::start_idle_time() {
  idle_time_ = std::make_unique<IdleTime>();
}

void Measuring::start_audit(const MessageFault& fault) {
  audit_ = std::make_unique<MessageAudit>(pe_, fault);
}
std::vector<AuditRow> Measuring::audit_rows() const {
  return audit_ ? audit_->rows() : std::vector<AuditRow>();
}

}  // namespace tess::detail
