// The disorder of one run of a trial: the decisions, given to the machine and the options of the run.
#pragma once

#include "runtime/more/testing/decisions.hpp"
#include "runtime/more/testing/trial.hpp"
#include "runtime/pe/interfaces/runtime_options.hpp"
#include "runtime/wire/machine/simulated_options.hpp"

#include <string>
#include <vector>

namespace tess::test::detail {

class Disorder {
 public:
  /// `simulated` has a seed. All of them outlive this.
  Disorder(Trial& trial, SimulatedOptions& simulated, tess::detail::RuntimeOptions& options,
           double reordering);
  Disorder(const Disorder&) = delete;
  Disorder& operator=(const Disorder&) = delete;
  ~Disorder();

 private:
  Trial& trial_;
  const std::vector<std::string> words_before_;
  Decisions decisions_;
};

}  // namespace tess::test::detail
