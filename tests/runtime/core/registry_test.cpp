// What registers itself before main(): each message type once, as an object that stays.
#include "runtime/core/registry.hpp"

#include "runtime/runtime.hpp"
#include "tests/support/catch.hpp"

#include <string>
#include <vector>

namespace {

/// Sends a message from a function that the program never calls and the compiler drops.
class Unused : public tess::Chare<Unused, tess::Index1> {
 public:
  void never_sent() {}
  void never_called() { array()[index()].send<&Unused::never_sent>(); }
};

std::vector<std::string> names() {
  tess::detail::Registry::seal();
  std::vector<std::string> result;
  for (std::uint32_t id = 0;; ++id) {
    try {
      result.emplace_back(tess::detail::Registry::at(id).name());
    } catch (const tess::Error&) {
      return result;
    }
  }
}

}  // namespace

TEST_CASE("a message type that no function needs is registered as an object that stays",
          "[registry]") {
  const std::vector<std::string> all = names();
  REQUIRE(all.size() > 10);
  for (const std::string& name : all) CHECK(name.find("tess::") != std::string::npos);
}
