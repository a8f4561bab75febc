// libFuzzer over the readers of surfaces: any bytes are a file, the first of them its format. A
// reader gives triangles of vertices that exist and are finite, or an Error that names the file.
//
//     mkdir -p build/corpus/surface
//     build/fuzz/bin/fuzz_surface -max_total_time=600 -dict=tests/fuzz/files/surface.dict build/corpus/surface
#include "collide/read_surface.hpp"
#include "runtime/core/error.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <unistd.h>

namespace {

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "fuzz_surface: %s\n", what.c_str());
  std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t n) {
  if (n == 0) return 0;
  constexpr const char* endings[] = {".ply", ".obj", ".stl"};
  const std::string path =
      "/dev/shm/fuzz_surface_" + std::to_string(::getpid()) + endings[bytes[0] % 3];
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  if (file == nullptr || std::fwrite(bytes + 1, 1, n - 1, file) != n - 1)
    fail("cannot write " + path);
  std::fclose(file);
  try {
    const tess::dn::Surface surface = tess::dn::read_surface(path);
    if (surface.triangles.empty()) fail("a surface without triangles was taken");
    for (const auto& triangle : surface.triangles)
      for (const std::uint32_t v : triangle)
        if (v >= surface.vertices.size() || !std::isfinite(surface.vertices[v].x) ||
            !std::isfinite(surface.vertices[v].y) || !std::isfinite(surface.vertices[v].z))
          fail("a bad vertex was taken");
  } catch (const tess::Error& error) {
    if (!std::string(error.what()).starts_with(path)) fail(error.what());
  }
  std::remove(path.c_str());
  return 0;
}
