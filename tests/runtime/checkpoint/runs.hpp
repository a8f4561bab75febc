// Runs of the tests of checkpoints: how they end, and what they report.
#pragma once

#include "runtime/runtime.hpp"
#include "tests/support/adversarial.hpp"
#include "tests/support/catch.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

namespace tess::test {

using Main = std::function<Task()>;

[[nodiscard]] inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// How a run ended, and the lines that it reported. Lines on messages to what was destroyed, which
/// are not delivered, are counted only.
struct Ended {
  int exit_code = 0;
  std::string report;
  int n_undelivered = 0;
};

inline Ended run_on(Setup setup, const Main& main) {
  Ended ended;
  setup.options.report = [&ended](const std::string& line) {
    if (has(line, "not delivered")) {
      ++ended.n_undelivered;
    } else {
      ended.report += line + "\n";
    }
  };
  ended.exit_code = run(setup, main);
  return ended;
}

/// A run that must end well; returns what it reported.
inline std::string completes_on(Setup setup, const Main& main) {
  const Ended ended = run_on(std::move(setup), main);
  INFO(ended.report);
  REQUIRE(ended.exit_code == 0);
  return ended.report;
}
inline std::string completes(int n_pes, std::uint64_t seed, const Main& main) {
  CAPTURE(n_pes, seed);
  return completes_on(adversarial(n_pes, seed), main);
}

}  // namespace tess::test
