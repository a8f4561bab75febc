// destroy() of a collider while a collision of it runs must end the job with one clear line; run by
// CMakeLists.txt with the place that calls it and the slack of the collider.
//
//     test_collider_misuse none|main|client SLACK
#include "collide/collider.hpp"
#include "runtime/core/error.hpp"
#include "runtime/runtime.hpp"

#include <string>
#include <vector>

namespace {

using namespace tess;
using namespace tess::collide;

/// On each PE; its boxes overlap those of the others.
class Client : public Group<Client> {
 public:
  void submit(const Collider& collider) {
    const std::vector<Aabb> boxes(20, Aabb{{0, 0, 0}, {1, 1, 1}});
    collider.submit(Objects{owner_of(pe()), static_cast<ModelId>(pe().value), boxes});
  }
  void receive(const Hits& /*hits*/) {}
  void destroy_collider(const Collider& collider) { collider.destroy(); }
};

Task misuse(const std::string& where, double slack) {
  Collider collider;
  co_await epoch([&] { collider = make_collider({.slack = slack}); });
  const auto clients = create<Client>(each_pe);
  co_await epoch([&] { clients.broadcast<&Client::submit>(collider); });
  const HitReceivers to{report_to<&Client::receive>(clients), {}};
  Task first = collider.run(to);
  if (where == "main") collider.destroy();
  if (where == "client") clients[my_pe()].send<&Client::destroy_collider>(collider);
  co_await first;
  co_await collider.run(to);  // of nothing
  co_await epoch([&] { collider.destroy(); });
  print("no misuse\n");
}

int run_misuse(int argc, char** argv) {
  Setup setup = take_options(argc, argv);
  if (argc != 3) fail(ErrorCode::bad_argument, "give a place and a slack");
  const std::string where = argv[1];
  const double slack = std::stod(argv[2]);
  return run(setup, [&] { return misuse(where, slack); });
}

}  // namespace

int main(int argc, char** argv) {
  return tess::guarded(argv[0], [&] { return run_misuse(argc, argv); });
}
