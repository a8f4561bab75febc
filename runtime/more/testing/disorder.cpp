#include "runtime/more/testing/disorder.hpp"

#include "runtime/core/hash.hpp"

#include <utility>

namespace tess::test::detail {

Disorder::Disorder(Trial& trial, SimulatedOptions& simulated, tess::detail::RuntimeOptions& options,
                   double reordering)
    : trial_(trial),
      words_before_(trial.words),
      // A program may run several machines with one seed.
      decisions_({.seed = mix(*simulated.seed ^ mix(trial.n_runs++)),
                  .n_pes = simulated.n_pes,
                  .latency = simulated.latency,
                  .reordering = reordering,
                  .migration = migration_chance(simulated),
                  .keep = trial.keep ? &*trial.keep : nullptr,
                  .in_words = trial.in_words},
                 trial.taken) {
  simulated.adversary = &decisions_;
  options.seed = *simulated.seed;
  options.mover = &decisions_;
  options.signals = false;  // a thread per run
  trial.update_words = [this] {
    trial_.words = words_before_;
    for (std::string& sentence : decisions_.in_words()) trial_.words.push_back(std::move(sentence));
  };
}

Disorder::~Disorder() {
  std::exchange(trial_.update_words, nullptr)();
}

}  // namespace tess::test::detail
