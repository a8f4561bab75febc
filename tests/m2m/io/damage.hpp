// Reads damaged files: the result is a mesh, or an Error of one line that names the file.
#pragma once

#include "m2m/field_file.hpp"
#include "m2m/read_mesh.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/scratch.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <random>
#include <string>

namespace tess::test {

/// Reads the file at a path; throws an Error if it is refused.
using ReadFile = std::function<void(const std::string& path)>;

/// Reads the mesh and every field at every step.
inline void read_all(const std::string& path) {
  const m2m::TetMesh mesh = m2m::read_mesh(path);
  const m2m::FieldFile file(path);
  for (const m2m::FileField& field : file.fields()) {
    const bool nodal = field.place == m2m::FieldPlace::vertices;
    for (std::size_t step = 0; step < file.n_steps(); ++step) {
      const m2m::Field read = nodal ? file.vertex_field(mesh, field.name, step)
                                    : file.tet_field(mesh, field.name, step);
      const std::size_t n_rows = nodal ? mesh.n_points() : mesh.n_tets();
      if (read.values.size() != n_rows * read.n_components) FAIL("a field of another length");
    }
  }
}

inline void check_refusal(const std::string& path, const ReadFile& read) {
  const std::string message = message_of([&] { read(path); });
  if (message.find('\n') != std::string::npos) FAIL("more than one line: " << message);
  if (!message.empty() && message.find(path) == std::string::npos)
    FAIL("the file is not named: " << message);
}

/// Cuts the file at `n_cuts` places, which must be refused, and flips bits in `n_flips` copies.
inline void damage_everywhere(const std::string& name, const std::string& bytes, std::size_t n_cuts,
                              std::size_t n_flips, const ReadFile& read) {
  const Scratch scratch;
  for (std::size_t i = 0; i < n_cuts; ++i) {
    const std::string cut = bytes.substr(0, bytes.size() * i / n_cuts);
    const std::string path = scratch.write(name, cut);
    CAPTURE(name, cut.size());
    CHECK_FALSE(message_of([&] { read(path); }).empty());
  }
  std::mt19937_64 random(7);
  for (std::size_t i = 0; i < n_flips; ++i) {
    std::string flipped = bytes;
    // Half of the damage goes to the first bytes, which hold counts.
    const std::size_t range = i % 2 == 0 ? std::min<std::size_t>(bytes.size(), 3000) : bytes.size();
    for (std::size_t k = 0; k <= i % 3; ++k)
      flipped[random() % range] ^= static_cast<char>(1U << random() % 8);
    check_refusal(scratch.write(name, flipped), read);
  }
}

}  // namespace tess::test
