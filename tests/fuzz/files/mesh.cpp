// libFuzzer over the readers of meshes, fields and weights: any bytes are a file; its first bytes
// say which. A reader gives a mesh that passes validate() and fields of its length, or an Error of
// one line that names the file. libexodusII keeps what it read of files that it refuses.
//
//     mkdir -p build/corpus/mesh
//     build/fuzz/bin/fuzz_mesh -max_total_time=600 -detect_leaks=0 -dict=tests/fuzz/files/mesh.dict build/corpus/mesh
#include "m2m/field_file.hpp"
#include "m2m/read_mesh.hpp"
#include "m2m/weights_file.hpp"
#include "runtime/core/error.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <unistd.h>

namespace {

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "fuzz_mesh: %s\n", what.c_str());
  std::abort();
}

template <class Read>
void attempt(const std::string& path, const Read& read) {
  try {
    read();
  } catch (const tess::Error& error) {
    const std::string text = error.what();
    if (!text.starts_with(path) || text.find('\n') != std::string::npos) fail(text);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t n) {
  using namespace tess::m2m;
  const std::string path = "/dev/shm/fuzz_mesh_" + std::to_string(::getpid());
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  if (file == nullptr || std::fwrite(bytes, 1, n, file) != n) fail("cannot write " + path);
  std::fclose(file);
  attempt(path, [&] {
    const TetMesh mesh = read_mesh(path);
    const FieldFile fields(path);
    for (const FileField& field : fields.fields()) {
      const bool nodal = field.place == FieldPlace::vertices;
      for (std::size_t step = 0; step < fields.n_steps() && step < 3; ++step) {
        attempt(path, [&] {
          const Field read = nodal ? fields.vertex_field(mesh, field.name, step)
                                   : fields.tet_field(mesh, field.name, step);
          if (read.values.size() != (nodal ? mesh.n_points() : mesh.n_tets()) * read.n_components)
            fail("a field of another length was taken");
        });
      }
    }
  });
  attempt(path, [&] {
    const WeightMatrix matrix = read_weights(path);
    std::vector<double> out(matrix.rows.n_rows());
    apply(matrix, std::vector<double>(static_cast<std::size_t>(matrix.n_columns), 1.0), 1, out);
  });
  std::remove(path.c_str());
  return 0;
}
