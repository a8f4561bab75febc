// The graph of a run: which mesh gives values to which, and in which order.
//
// A step applies all pairs. Pairs run in the order given if they share a mesh that one of them
// writes. All others run at once: a step has levels, and a level has the pairs whose predecessors
// are in earlier levels.
//
//     A:B,A:C,B:D      level 0: A:B and A:C;  level 1: B:D, which reads what A:B wrote
#pragma once

#include "apps/m2m_transfer/names.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace m2m_transfer {

struct Pair {
  std::size_t source = 0, target = 1;  ///< positions of the meshes
  std::size_t level = 0;
  friend bool operator==(const Pair&, const Pair&) = default;
};

/// The letter of a mesh by its position: A, B, C, ….
[[nodiscard]] char letter_of(std::size_t mesh);

/// The position of a mesh, given as a letter or as its name on the command line. Throws Error
/// (bad_argument) with the option if no mesh, or more than one, has this name.
[[nodiscard]] std::size_t find_mesh(const std::string& name, const std::vector<std::string>& meshes,
                                    const char* option);

/// The pairs of "A:B,B:C" or "coarse.exo:fine.exo"; of an empty text A:B. Throws Error
/// (bad_argument) for a pair that has a mistake or stands twice.
[[nodiscard]] std::vector<Pair> parse_pairs(const std::string& text,
                                            const std::vector<std::string>& meshes);

/// True if a pair writes the mesh.
[[nodiscard]] bool is_written(std::size_t mesh, const std::vector<Pair>& pairs);
/// Where the result of a mesh goes: "result.exo"; if pairs write several meshes "result.B.exo",
/// "result.C.exo", ….
[[nodiscard]] std::string path_of_result(const std::string& path, std::size_t mesh,
                                         std::size_t n_meshes, const std::vector<Pair>& pairs);
/// True if the first pair that uses the mesh reads it: it needs values before the first step.
[[nodiscard]] bool needs_values(std::size_t mesh, const std::vector<Pair>& pairs);
/// True if a pair writes a mesh that one before it reads: the next run of the pairs begins with
/// other values.
[[nodiscard]] bool is_written_after_read(const std::vector<Pair>& pairs);

// Lists on the command line.

/// "a,b" has two entries; commas within parentheses separate none: "max(x,y),z" has two.
[[nodiscard]] inline std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> parts(1);
  int depth = 0;
  for (const char c : text) {
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (c == ',' && depth == 0)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}
/// Splits the lists of an option that may be given several times.
[[nodiscard]] inline std::vector<std::string> split_names(const std::vector<std::string>& lists) {
  std::vector<std::string> names;
  for (const std::string& list : lists)
    for (std::string& name : split_at_commas(list)) names.push_back(std::move(name));
  return names;
}

}  // namespace m2m_transfer
