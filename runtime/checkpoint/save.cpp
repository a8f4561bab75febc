#include "runtime/checkpoint/save.hpp"

#include "runtime/checkpoint/ask_all.hpp"
#include "runtime/checkpoint/manifest.hpp"
#include "runtime/checkpoint/quiet.hpp"
#include "runtime/collections/collection.hpp"
#include "runtime/collections/index_map.hpp"
#include "runtime/core/error.hpp"
#include "runtime/report/waiting.hpp"
#include "runtime/scheduler/runtime.hpp"

#include <algorithm>
#include <bit>
#include <coroutine>
#include <exception>

namespace tess::detail {
namespace {

/// The collections of a PE that a checkpoint saves or refuses, in the order of their ids.
std::vector<Collection*> saved_collections(const Pe& pe) {
  std::vector<Collection*> all;
  for (HostedCollection* hosted : pe.collections()) {
    auto* const collection = static_cast<Collection*>(hosted);
    if (collection->kind().saving != Saving::skipped) all.push_back(collection);
  }
  std::sort(all.begin(), all.end(),
            [](const Collection* a, const Collection* b) { return a->id() < b->id(); });
  return all;
}

/// The frame of the coroutine that awaits it.
struct OwnFrame {
  void* frame = nullptr;
  [[nodiscard]] bool await_ready() const noexcept { return false; }
  bool await_suspend(Task::Handle task) noexcept {
    frame = task.address();
    return false;
  }
  [[nodiscard]] std::uint64_t await_resume() const noexcept {
    return std::bit_cast<std::uint64_t>(frame);
  }
};

struct CensusQuestion {
  PeId main;                // the PE of the main coroutine
  std::uint64_t frame = 0;  // its innermost task, on that PE
};

/// What prevents a checkpoint on this PE.
std::vector<std::string> take_census(Pe& pe, const CensusQuestion& question) {
  std::vector<void*> frames;
  if (pe.id() == question.main) {
    for (auto at = Task::Handle::from_address(std::bit_cast<void*>(question.frame)); at;
         at = at.promise().parent)
      frames.push_back(at.address());
  }
  std::vector<std::string> lines;
  Waits waits = pe.census(frames);
  for (WaitLine& line : waits.lines) lines.push_back(std::move(line.text));
  for (const Collection* collection : saved_collections(pe)) {
    collection->describe_unsaved(lines);
    if (collection->kind().saving == Saving::impossible && pe.id() == question.main)
      lines.push_back(text(collection->name(),
                           " cannot be saved: give it a default constructor and serialize(), or "
                           "destroy() it before the checkpoint"));
  }
  return lines;
}

struct SaveQuestion {
  std::string folder;
};
struct HereSaved {
  CollectionId id;
  bool has_sections = false;
  std::uint64_t n_elements = 0;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(id, has_sections, n_elements);
  }
};
struct SaveAnswer {
  std::string error;  // empty: the file is written
  FileSum file;
  CollectionNumbers::Made numbers{};
  std::vector<SectionId> sections;  // whose root is this PE
  std::vector<HereSaved> collections;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(error, file, numbers, sections, collections);
  }
};

/// Writes the collections; returns the sections whose root is this PE. The bytes of one element after
/// the other leave the buffer, so a checkpoint needs little memory.
std::vector<SectionId> pack_all(const std::vector<Collection*>& collections, Buffer& bytes,
                                FileWriter& file) {
  std::vector<SectionId> sections;
  Writer ar(bytes);
  ar(static_cast<std::uint64_t>(collections.size()));
  for (Collection* collection : collections) {
    ar(collection->id());
    collection->save(ar, [&] { file.write_some(bytes); });
    pack_framed(ar, [&](Writer& body) {
      const std::vector<SectionId> saved = collection->save_sections(body);
      sections.insert(sections.end(), saved.begin(), saved.end());
    });
  }
  return sections;
}

SaveAnswer save_here(Pe& pe, const SaveQuestion& question) {
  SaveAnswer answer;
  const std::vector<Collection*> collections = saved_collections(pe);
  answer.numbers = pe.collection_numbers().made();
  for (const Collection* collection : collections)
    answer.collections.push_back(
        {collection->id(), collection->has_sections(), collection->n_local()});
  try {
    FileWriter file(question.folder, text("pe-", pe.id().value));
    Buffer bytes;
    answer.sections = pack_all(collections, bytes, file);
    answer.file = file.finish({bytes.data(), bytes.size()});
  } catch (const Error& error) {
    answer.error = error.what();
  }
  return answer;
}

struct Thaw {
  std::uint8_t none = 0;
};
Thaw thaw_here(Pe& pe, const Thaw& done) {
  pe.timers().thaw();
  return done;
}

void refuse_unless_quiet(std::vector<std::string> lines) {
  if (lines.empty()) return;
  constexpr std::size_t most = 5;
  std::sort(lines.begin(), lines.end());
  std::string list;
  for (std::size_t i = 0; i < std::min(most, lines.size()); ++i)
    list += (i == 0 ? "" : "; ") + lines[i];
  if (lines.size() > most) list += text("; and ", lines.size() - most, " more");
  fail(ErrorCode::bad_value, "no checkpoint can be made here: ", list);
}

/// Throws Error if the folder has a checkpoint that this run neither wrote nor found at its restart: a
/// later restart could take one run's checkpoint for the other's.
void require_own(const std::string& folder, const std::vector<std::uint64_t>& numbers,
                 const Runtime::OwnCheckpoints& own) {
  for (const std::uint64_t number : numbers)
    if (number > own.last && is_complete(folder, number))
      fail(ErrorCode::bad_argument, folder_of(folder, number),
           " is a checkpoint of another run: restart from ", folder, ", or give another folder");
}

Task save_all(std::string folder, MainPart main, CheckpointOptions options) {
  Pe& pe = current_pe();
  OwnFrame own;
  const std::uint64_t frame = co_await own;
  Quiet quiet;
  refuse_unless_quiet(co_await quiet);

  AskAll<&take_census> census(CensusQuestion{pe.id(), frame});
  std::vector<std::string> waiting;
  for (std::vector<std::string>& lines : co_await census)
    waiting.insert(waiting.end(), lines.begin(), lines.end());
  refuse_unless_quiet(std::move(waiting));

  const std::vector<std::uint64_t> before = numbers_in(folder);
  Runtime::OwnCheckpoints& ours = pe.runtime().own_checkpoints(canonical(folder));
  require_own(folder, before, ours);
  Manifest manifest;
  manifest.number = before.empty() ? 1 : before.front() + 1;
  manifest.n_pes = pe.n_pes();
  manifest.n_processes = pe.machine().n_processes();
  manifest.program = Registry::fingerprint();
  manifest.note = options.note;
  const std::string here = folder_of(folder, manifest.number);
  make_folder(here);
  for (const Collection* collection : saved_collections(pe))
    main.collections.push_back({collection->id(), collection->range(),
                                std::string(collection->kind().key()), collection->name(), false, 0,
                                to_saved(collection->index_map())});

  AskAll<&save_here> saved(SaveQuestion{here});
  for (SaveAnswer& answer : co_await saved) {
    if (!answer.error.empty())
      fail(ErrorCode::environment, "the checkpoint failed: ", answer.error);
    manifest.files.push_back(std::move(answer.file));
    main.numbers.push_back(answer.numbers);
    main.sections.insert(main.sections.end(), answer.sections.begin(), answer.sections.end());
    for (std::size_t i = 0; i < answer.collections.size(); ++i) {
      SavedCollection& all = main.collections.at(i);
      const HereSaved& one = answer.collections[i];
      TESS_CHECK(all.id == one.id, "the PEs have different collections at a checkpoint");
      all.has_sections = all.has_sections || one.has_sections;
      all.n_elements += one.n_elements;
    }
  }
  const std::vector<std::byte> bytes = to_bytes(main);
  manifest.files.push_back(write_file(here, "main", bytes));
  write_manifest(here, manifest, main);
  ours.last = manifest.number;

  int n_kept = 1;
  for (const std::uint64_t number : before) {
    const bool is_good =
        is_complete(folder, number) && std::ranges::count(ours.refused, number) == 0;
    if (!is_good || n_kept++ >= options.keep) remove_checkpoint(folder, number);
  }
}

}  // namespace

void require_main(const std::string& what) {
  Pe& pe = current_pe();
  TESS_CHECK(pe.id().value == 0 && pe.context().element == nullptr, what,
             " belongs into the coroutine that was given to run(), not into a chare");
  TESS_CHECK(pe.context().epoch.value == 0, what, " is called inside an epoch");
}

Task write_checkpoint(std::string folder, std::string state_type, std::vector<std::byte> state,
                      CheckpointOptions options) {
  require_main("checkpoint()");
  TESS_CHECK(options.keep >= 1, "keep: ", options.keep, " checkpoints");
  MainPart main;
  main.state_type = std::move(state_type);
  main.state = std::move(state);
  std::exception_ptr error;
  try {
    co_await save_all(std::move(folder), std::move(main), std::move(options));
  } catch (const Error&) {
    error = std::current_exception();
  }
  AskAll<&thaw_here> thawed(Thaw{});
  (void)co_await thawed;
  if (error) std::rethrow_exception(error);
}

}  // namespace tess::detail
