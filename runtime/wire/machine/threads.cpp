#include "runtime/wire/machine/threads.hpp"

#include "runtime/core/check.hpp"

#include <cstdio>
#include <cstdlib>

namespace tess::detail {
namespace {

class ThreadsMachine final : public Machine {
 public:
  ThreadsMachine(std::int32_t n_pes, Pinning pinning)
      : placement_{.pinned = pinning == Pinning::automatic && pes(n_pes) <= topology_.n_cores(),
                   .first_core = 0,
                   .oversubscribed = pes(n_pes) > topology_.n_cores()},
        team_(PeId{0}, pes(n_pes), placement_, nullptr) {
    pes_per_process_ = pes(n_pes);
  }

  void post(PeId, PeId to, Link* message, std::size_t, Traffic) override {
    team_.post(to, message);
  }
  void hand_in(PeId to, Link* message) override { team_.post(to, message); }
  [[nodiscard]] bool takes_bundles() const override { return pes_per_process_ > 1; }
  void post_bundle(PeId to, Bundle* bundle) override { team_.post(to, bundle); }
  void send(PeId from, ProcessId to, Buffer&&) override {
    TESS_CHECK(false, from, " sends bytes to ", to, ", but there is one process");
  }
  void send(PeId from, ProcessId to, Parcel&&) override {
    TESS_CHECK(false, from, " sends a parcel to ", to, ", but there is one process");
  }
  void run(Program& program) override { team_.run(program, topology_); }
  void stop() override { team_.stop(); }
  [[noreturn]] void abort(int exit_code) override {
    std::fflush(nullptr);
    std::_Exit(exit_code);
  }
  Time now(PeId) const override { return std::chrono::steady_clock::now() - start_; }
  std::string describe() const override {
    return text("threads: ", pes_per_process_, pes_per_process_ == 1 ? " PE" : " PEs",
                placement_.describe(topology_));
  }

 private:
  std::int32_t pes(std::int32_t asked) const { return asked == 0 ? topology_.n_cores() : asked; }

  Topology topology_;
  Placement placement_;
  Team team_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

std::unique_ptr<Machine> make_threads_machine(std::int32_t n_pes, Pinning pinning) {
  if (n_pes < 0)
    fail(ErrorCode::bad_argument, "cannot run on ", n_pes, " PEs: give a positive number");
  return std::make_unique<ThreadsMachine>(n_pes, pinning);
}

}  // namespace tess::detail
