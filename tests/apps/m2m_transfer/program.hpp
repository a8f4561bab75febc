// m2m_transfer with words as a user gives them, on a machine of a test.
#pragma once

#include "apps/m2m_transfer/driver.hpp"
#include "runtime/wire/machine/simulated.hpp"
#include "runtime/wire/machine/threads.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tests {

using Words = std::vector<std::string>;

inline tess::Setup threads(int n_pes) {
  return {tess::make_threads_machine(n_pes), {}};
}
inline tess::Setup simulated(const char* keys) {
  return {tess::make_simulated_machine(tess::parse_simulated(keys)), {}};
}

/// The exit code; it prints its errors.
inline int exit_code(tess::Setup&& setup, Words words) {
  words.insert(words.begin(), "m2m_transfer");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  return tess::guarded("m2m_transfer", [&] {
    return m2m_transfer::start(setup, static_cast<int>(words.size()), argv.data());
  });
}

/// The JSON of a run that ends well.
inline nlohmann::json json_of(tess::Setup&& setup, Words words) {
  const tess::test::Scratch scratch;
  const std::string path = scratch.path("report.json");
  words.insert(words.end(), {"--json", path});
  REQUIRE(exit_code(std::move(setup), words) == 0);
  return nlohmann::json::parse(tess::test::slurp(path));
}
inline nlohmann::json results_of(tess::Setup&& setup, const Words& words) {
  return json_of(std::move(setup), words)["results"];
}

}  // namespace tests
