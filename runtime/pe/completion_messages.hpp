// Sends the messages of a PE's Completion to other PEs.
#pragma once

#include "runtime/pe/completion/completion.hpp"

namespace tess::detail {

class Pe;

class CompletionMessagesOfPe final : public CompletionMessages {
 public:
  explicit CompletionMessagesOfPe(Pe& pe) : pe_(pe) {}

  void send(PeId to, const completion::Report& report) override;
  void send(PeId to, const completion::Answer& answer) override;
  void send(PeId to, const completion::Wave& wave) override;
  void send(PeId to, const completion::Echo& echo) override;
  void send(PeId to, const completion::End& end) override;
  void quiescent() override;

 private:
  Pe& pe_;
};

}  // namespace tess::detail
