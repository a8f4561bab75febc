// The manifest of a checkpoint, a file of JSON for programs and people, and the contents of the
// file "main": what all PEs have to know before elements are restored.
#pragma once

#include "runtime/arrays/membership.hpp"
#include "runtime/checkpoint/files.hpp"
#include "runtime/core/ids.hpp"
#include "runtime/core/index.hpp"
#include "runtime/pe/tables/ended_collections.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tess::detail {

struct SavedCollection {
  CollectionId id;
  Range range;
  std::string key;   ///< CollectionKind::key()
  std::string name;  ///< for people
  bool has_sections = false;
  std::uint64_t n_elements = 0;
  std::vector<std::byte> map;  ///< to_saved() of the map that it was created with
  template <class Ar>
  void serialize(Ar& ar) {
    ar(id, range, key, name, has_sections, n_elements, map);
  }
};

/// The contents of "main".
struct MainPart {
  std::vector<SavedCollection> collections;
  std::vector<CollectionNumbers::Made> numbers;  ///< by PE; behind them of PEs that restarts lost
  std::vector<SectionId> sections;
  std::uint32_t places_of_futures = 0;  ///< the greatest FutureTable::n_places()
  std::uint64_t timers = 0;             ///< the greatest Timers::n_made()
  std::string state_type;
  std::vector<std::byte> state;  ///< the main coroutine's
  template <class Ar>
  void serialize(Ar& ar) {
    ar(collections, numbers, sections, places_of_futures, timers, state_type, state);
  }
};

struct Manifest {
  std::uint64_t number = 0;
  std::int32_t n_pes = 0;
  std::int32_t n_processes = 0;
  std::uint64_t program = 0;           ///< Registry::fingerprint()
  std::vector<std::uint64_t> lineage;  ///< Runtime::lineage() of the run that wrote it
  std::string note;                    ///< of checkpoint()
  bool buddy_copies = false;           ///< CheckpointOptions::buddy_copies
  std::vector<FileSum> files;          ///< of PE 0, 1, …, and at last "main"
};

/// Throws Error for a note that a manifest cannot hold.
void check_note(const std::string& note);
/// The text of a manifest, with a list of the classes for people.
[[nodiscard]] std::string to_text(const Manifest& manifest, const MainPart& main);
void write_manifest(const std::string& folder, const std::string& text);
/// Throws Error for a manifest that is missing, damaged, or of another version.
[[nodiscard]] Manifest read_manifest(const std::string& folder);

}  // namespace tess::detail
