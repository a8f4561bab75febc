#include "m2m/write_pvtu.hpp"

#include "m2m/kuhn.hpp"
#include "runtime/more/testing.hpp"
#include "tests/apps/xml.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

using namespace tess;
using namespace tess::m2m;

namespace {

/// Writes a mesh of two components; the message of the Error is empty if there is none.
Task write_with(std::string path, std::vector<std::string> names, std::string* message) {
  const TetMesh cube = kuhn_mesh({2});
  const std::vector<double> zeros(cube.n_points());
  DistributedMesh mesh;
  co_await epoch([&] {
    mesh = scatter(cube, {{"a", 1, zeros}, {"b", 1, zeros}}, 2, PartitionMethod::curve);
  });
  try {
    co_await write_pvtu(path, mesh, names);
  } catch (const Error& error) {
    *message = error.what();
  }
}

}  // namespace

TEST_CASE("names that parts cannot write are refused before a part writes", "[m2m][io]") {
  const test::Scratch scratch;
  std::string path = scratch.path("r.pvtu");
  const auto refusal = [&](std::vector<std::string> names) {
    std::string message;
    const test::Machine machine{.pes = 2, .seed = 1};
    machine.run([&] { return write_with(path, names, &message); }).require_success();
    return message;
  };
  CHECK_THAT(refusal({"p", "p"}), Catch::StartsWith(path + ": two fields have the name 'p'"));
  CHECK_THAT(refusal({"status", "p"}), Contains("two fields have the name 'status'"));
  CHECK_THAT(refusal({"p", ""}), Contains("a field has no name"));
  CHECK_THAT(refusal({"p\x01", "p\x02"}), Contains("two fields have the name 'p\ufffd'"));
  path = scratch.path("r\xff.pvtu");
  CHECK_THAT(refusal({"p", "q"}), Contains("XML, which names the parts, cannot hold"));
  path = scratch.path("r.pvtu");
  CHECK(scratch.n_files() == 0);
  CHECK(refusal({"p", "q"}).empty());
  CHECK(scratch.n_files() == 3);
}

TEST_CASE("the index of parts names fields and files with any characters of XML", "[m2m][io]") {
  const test::Scratch scratch;
  std::string message;
  const test::Machine machine{.pes = 2, .seed = 1};
  machine
      .run([&] {
        return write_with(scratch.path("a & \"b\".pvtu"), {"<p>\n", "caf\xe9"}, &message);
      })
      .require_success();
  CHECK(message.empty());
  std::string read;
  for (const auto& element : test::read_xml(test::slurp(scratch.path("a & \"b\".pvtu"))))
    read += element.attributes;
  for (const char* written : {"Name=\"<p>\n\"", "Name=\"caf\ufffd\"", "Source=\"a & \"b\".1.vtu\""})
    CHECK_THAT(read, Contains(written));
}
