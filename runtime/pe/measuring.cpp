#include "runtime/pe/measuring.hpp"

#include "runtime/pe/measure/idle_time.hpp"
#include "runtime/pe/message_audit.hpp"
#include "runtime/pe/pe.hpp"
#include "runtime/pe/report/pe_watch.hpp"

#include <utility>

namespace tess::detail {

Measuring::Measuring(Pe& pe) : pe_(pe) {}
Measuring::~Measuring() = default;

Meter& Measuring::start_meter() {
  measures_briefly_ = false;
  if (!meter_)
    meter_ =
        idle_meter_ ? std::move(idle_meter_) : std::make_unique<Meter>(pe_.machine(), pe_.id());
  return *meter_;
}
Meter& Measuring::start_brief_meter() {
  const bool briefly = measures_briefly_ || !meter_;
  Meter& meter = start_meter();
  measures_briefly_ = briefly;
  return meter;
}
void Measuring::stop_brief_meter() {
  if (measures_briefly_) idle_meter_ = std::move(meter_);
  measures_briefly_ = false;
}
void Measuring::forget(const LoadRecord& record) {
  for (Meter* meter : {meter_.get(), idle_meter_.get()})
    if (meter != nullptr) meter->forget(&record);
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
