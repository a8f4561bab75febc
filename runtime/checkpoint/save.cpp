#include "runtime/checkpoint/save.hpp"

#include "runtime/arrays/collection.hpp"
#include "runtime/arrays/home_of_one.hpp"
#include "runtime/checkpoint/ask_all.hpp"
#include "runtime/checkpoint/hosts.hpp"
#include "runtime/checkpoint/manifest.hpp"
#include "runtime/checkpoint/quiet.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/text.hpp"
#include "runtime/pe/census.hpp"
#include "runtime/pe/report/waiting.hpp"
#include "runtime/pe/runtime.hpp"

#include <algorithm>
#include <bit>
#include <exception>
#include <random>

namespace tess::detail {
namespace {

/// The collections of a PE that a checkpoint saves or refuses, in the order of their ids.
std::vector<Collection*> saved_collections(Pe& pe) {
  std::vector<Collection*> all;
  for (HostedCollection* hosted : pe.collections().all()) {
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
  Waits waits = detail::census(pe, frames);
  for (WaitLine& line : waits.lines) lines.push_back(std::move(line.text));
  for (const Collection* collection : saved_collections(pe)) {
    collection->describe_unsaved(lines);
    if (pe.id() != question.main) continue;
    if (collection->kind().saving == Saving::impossible)
      lines.push_back(
          text(collection->name(),
               " cannot be saved: give it a default constructor and a public serialize(), or "
               "destroy() it before the checkpoint"));
    if (collection->kind().saving == Saving::shared)
      lines.push_back(text(collection->name(),
                           " cannot be saved, since the PEs of a process share it: destroy() it "
                           "before the checkpoint, and create it again after a restart"));
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
  std::vector<std::byte> map;  // of a single chare that is here
  template <class Ar>
  void serialize(Ar& ar) {
    ar(id, has_sections, n_elements, map);
  }
};
struct SaveAnswer {
  std::string error;  // empty: the file is written
  FileSum file;
  CollectionNumbers::Made numbers{};
  std::uint32_t places_of_futures = 0;
  std::uint64_t timers = 0;
  std::vector<SectionId> sections;  // whose root is this PE
  std::vector<HereSaved> collections;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(error, file, numbers, places_of_futures, timers, sections, collections);
  }
};

/// Writes the collections; returns the sections whose root is this PE. The bytes of one element
/// after the other leave the buffer, so a checkpoint needs little memory.
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
  answer.numbers = pe.collections().numbers().made();
  answer.places_of_futures = pe.futures().n_places();
  answer.timers = pe.timers().n_made();
  for (const Collection* collection : collections) {
    HereSaved here{collection->id(), collection->has_sections(), collection->n_local(), {}};
    if (here.n_elements != 0)
      here.map = HomeOfOne::saved_from(collection->index_map(), pe.id(), pe.n_pes());
    answer.collections.push_back(std::move(here));
  }
  answer.error = error_of([&] {
    FileWriter file(question.folder, text("pe-", pe.id().value));
    Buffer bytes;
    answer.sections = pack_all(collections, bytes, file);
    answer.file = file.finish({bytes.data(), bytes.size()});
  });
  return answer;
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

struct FolderQuestion {
  std::string folder;
};
SeenFolder look_here(Pe& /*pe*/, const FolderQuestion& question) {
  return look_at(question.folder);
}
std::string make_here(Pe& /*pe*/, const FolderQuestion& question) {
  return error_of([&] { make_folder(question.folder); });
}

/// The file of a PE for its buddy.
struct CopyQuestion {
  std::string folder;
  std::vector<FileSum> files;
  Hosts hosts;
};
struct FileToCopy {
  std::string folder;
  FileSum sum;
  std::string error;  // empty: these are the bytes
  Buffer bytes;
};
Onward<FileToCopy> read_own(Pe& pe, const CopyQuestion& question) {
  Onward<FileToCopy> onward;
  onward.to = buddy_of(pe.id(), question.hosts, pe.machine().pes_per_process());
  FileToCopy& file = onward.middle;
  file.folder = question.folder;
  file.sum = question.files.at(static_cast<std::size_t>(pe.id().value));
  file.error = error_of([&] { file.bytes = read_file(file.folder, file.sum); });
  return onward;
}
std::string write_copy(Pe& /*pe*/, const FileToCopy& file) {
  if (!file.error.empty()) return file.error;
  return error_of([&] {
    const FileSum sum = write_file(file.folder, name_of_copy(file.sum.name),
                                   {file.bytes.data(), file.bytes.size()});
    if (sum.n_bytes != file.sum.n_bytes || sum.hash != file.sum.hash)
      fail(ErrorCode::environment, file.folder, "/", sum.name, " differs from what was sent");
  });
}

struct MainQuestion {
  std::string folder;
  std::vector<std::byte> bytes;
};
std::string write_main(Pe& /*pe*/, const MainQuestion& question) {
  return error_of([&] { (void)write_file(question.folder, "main", question.bytes); });
}
struct ManifestQuestion {
  std::string folder, text;
};
std::string write_manifest_here(Pe& /*pe*/, const ManifestQuestion& question) {
  return error_of([&] { write_manifest(question.folder, question.text); });
}
struct RemoveQuestion {
  std::string folder;
  std::vector<std::uint64_t> numbers;
};
std::string remove_here(Pe& /*pe*/, const RemoveQuestion& question) {
  for (const std::uint64_t number : question.numbers) remove_checkpoint(question.folder, number);
  return {};
}

/// They look at a folder, each for its process.
std::vector<PeId> first_of_processes(Pe& pe) {
  std::vector<PeId> pes;
  pes.reserve(static_cast<std::size_t>(pe.machine().n_processes()));
  for (std::int32_t process = 0; process < pe.machine().n_processes(); ++process)
    pes.push_back(pe.machine().first_pe(ProcessId{process}));
  return pes;
}

void fail_for_first(const std::vector<std::string>& errors) {
  for (const std::string& error : errors)
    if (!error.empty()) fail(ErrorCode::environment, "the checkpoint failed: ", error);
}

using Lineage = std::vector<std::uint64_t>;

/// The lineage of the run that wrote a checkpoint; empty if its manifest here is damaged.
Lineage lineage_here(Pe& /*pe*/, const FolderQuestion& question) {
  try {
    return read_manifest(question.folder).lineage;
  } catch (const Error&) {
    return {};
  }
}

/// The same; empty if no host has a manifest that can be read.
TaskOf<Lineage> lineage_of(std::string folder, const Listing& listing, std::uint64_t number) {
  for (std::size_t host = 0; host < listing.complete_on.size(); ++host) {
    if (!listing.complete_on[host].contains(number)) continue;
    const PeId there = listing.hosts.first.at(host);
    AskAll<&lineage_here> asked(FolderQuestion{folder_of(folder, number)}, {there});
    std::vector<Lineage> lineages = co_await asked;
    Lineage& lineage = lineages[static_cast<std::size_t>(there.value)];
    if (!lineage.empty()) co_return std::move(lineage);
  }
  co_return Lineage();
}

/// After a restart from another folder: which checkpoints here a run of the lineage wrote before.
/// Those whose manifest cannot be read are passed over, as a restart does. So are those of other
/// restarts from a checkpoint of the lineage: such a run may have died before it wrote to the folder
/// that this one restarted from. A folder that has only those is theirs.
TaskOf<Runtime::OwnCheckpoints> find_own(std::string folder, const Listing& listing,
                                         const Lineage& lineage) {
  Runtime::OwnCheckpoints ours;
  std::vector<std::uint64_t> unreadable;
  for (const std::uint64_t number : listing.numbers) {
    if (!listing.is_complete(number)) continue;
    const Lineage found = co_await lineage_of(folder, listing, number);
    if (found.empty()) {
      unreadable.push_back(number);
    } else if (std::ranges::count(lineage, found.back()) != 0) {
      ours.last = listing.numbers.front();
      ours.refused = unreadable;
      break;
    } else if (found.front() != lineage.front()) {
      break;
    }
  }
  co_return ours;
}

/// Throws Error if the folder has a checkpoint that this run neither wrote nor found at its
/// restart: a later restart could take one run's checkpoint for the other's.
void require_own(const std::string& folder, const Listing& listing,
                 const Runtime::OwnCheckpoints& own) {
  for (const std::uint64_t number : listing.numbers)
    if (number > own.last && listing.is_complete(number))
      fail(ErrorCode::bad_argument, folder_of(folder, number),
           " is a checkpoint of another run: restart from ", folder, ", or give another folder");
}

Manifest next_manifest(Pe& pe, const Listing& before, bool buddy_copies, std::string note) {
  check_note(note);
  Manifest manifest;
  manifest.number = before.numbers.empty() ? 1 : before.numbers.front() + 1;
  manifest.n_pes = pe.n_pes();
  manifest.n_processes = pe.machine().n_processes();
  manifest.program = Registry::fingerprint();
  manifest.lineage = pe.runtime().lineage();
  manifest.note = std::move(note);
  manifest.buddy_copies = buddy_copies;
  return manifest;
}

std::vector<SavedCollection> collections_to_save(Pe& pe) {
  std::vector<SavedCollection> all;
  for (const Collection* collection : saved_collections(pe))
    all.push_back({collection->id(), collection->range(), std::string(collection->kind().key()),
                   collection->name(), false, 0, to_saved(collection->index_map())});
  return all;
}

/// Adds what one PE has saved.
void add_answer(SaveAnswer& answer, Manifest& manifest, MainPart& main) {
  fail_for_first({answer.error});
  manifest.files.push_back(std::move(answer.file));
  main.numbers.push_back(answer.numbers);
  main.places_of_futures = std::max(main.places_of_futures, answer.places_of_futures);
  main.timers = std::max(main.timers, answer.timers);
  main.sections.insert(main.sections.end(), answer.sections.begin(), answer.sections.end());
  for (std::size_t i = 0; i < answer.collections.size(); ++i) {
    SavedCollection& all = main.collections.at(i);
    HereSaved& one = answer.collections[i];
    TESS_CHECK(all.id == one.id, "the PEs have different collections at a checkpoint");
    all.has_sections = all.has_sections || one.has_sections;
    all.n_elements += one.n_elements;
    if (!one.map.empty()) all.map = std::move(one.map);
  }
}

/// The checkpoints to remove once another one is written: all that cannot be restarted from, and
/// those beyond `keep`, the new one counted.
std::vector<std::uint64_t> to_remove(const Listing& before,
                                     const std::vector<std::uint64_t>& refused, int keep) {
  std::vector<std::uint64_t> numbers;
  int n_kept = 1;
  for (const std::uint64_t number : before.numbers) {
    const bool is_good = before.is_complete(number) && std::ranges::count(refused, number) == 0;
    if (!is_good || n_kept++ >= keep) numbers.push_back(number);
  }
  return numbers;
}

/// A checkpoint waits until no message is under way, so two would wait for each other.
class OnlyOne {
 public:
  explicit OnlyOne(Runtime& runtime) : runs_(runtime.checkpoint_runs()) {
    if (runs_)
      fail(ErrorCode::bad_value,
           "no checkpoint can be made here: another checkpoint() is under way; await it first");
    runs_ = true;
  }
  OnlyOne(const OnlyOne&) = delete;
  OnlyOne& operator=(const OnlyOne&) = delete;
  ~OnlyOne() { runs_ = false; }

 private:
  bool& runs_;
};

/// A checkpoint that is being written.
struct Begun {
  std::vector<PeId> writers;  // the first PE of each host; none before the first file
  std::uint64_t number = 0;
};

Task save_all(std::string folder, MainPart main, std::function<std::vector<std::byte>()> pack,
              CheckpointOptions options, std::string note, Begun& begun) {
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
  main.state = pack();  // not before: other coroutines and timers may have changed it meanwhile

  Listing listing;
  if (options.buddy_copies) {
    // Hosts are told apart by their folders, so these must be there.
    AskAll<&make_here> made_all(FolderQuestion{folder}, first_of_processes(pe));
    fail_for_first(co_await made_all);
    listing = co_await list_all(folder);
  } else {
    listing = list_shared(folder, pe.n_pes());
  }
  Runtime::OwnCheckpoints& ours = pe.runtime().own_checkpoints(canonical(folder));
  Lineage& lineage = pe.runtime().lineage();
  if (lineage.empty()) lineage.push_back(new_run());
  if (ours.last == 0) ours = co_await find_own(folder, listing, lineage);
  require_own(folder, listing, ours);
  Manifest manifest = next_manifest(pe, listing, options.buddy_copies, std::move(note));
  const std::string here = folder_of(folder, manifest.number);
  begun = {listing.hosts.first, manifest.number};
  AskAll<&make_here> made(FolderQuestion{here}, begun.writers);
  fail_for_first(co_await made);
  main.collections = collections_to_save(pe);

  AskAll<&save_here> saved(SaveQuestion{here});
  for (SaveAnswer& answer : co_await saved) add_answer(answer, manifest, main);
  // A later restart on more PEs goes on where the former ones ended.
  const std::vector<CollectionNumbers::Made>& before = pe.runtime().made_before_restart();
  for (std::size_t lost = main.numbers.size(); lost < before.size(); ++lost)
    main.numbers.push_back(before[lost]);
  if (options.buddy_copies) {
    AskAll<&read_own, &write_copy> copied(CopyQuestion{here, manifest.files, listing.hosts});
    fail_for_first(co_await copied);
  }
  std::vector<std::byte> bytes = to_bytes(main);
  manifest.files.push_back(sum_of("main", bytes));
  AskAll<&write_main> wrote_main(MainQuestion{here, std::move(bytes)}, begun.writers);
  fail_for_first(co_await wrote_main);
  AskAll<&write_manifest_here> finished(ManifestQuestion{here, to_text(manifest, main)},
                                        begun.writers);
  fail_for_first(co_await finished);
  ours.last = manifest.number;

  AskAll<&remove_here> removed(
      RemoveQuestion{folder, to_remove(listing, ours.refused, options.keep)}, begun.writers);
  (void)co_await removed;
}

}  // namespace

std::uint64_t new_run() {
  std::random_device random;
  return std::uint64_t{random()} << 32U | random();
}

TaskOf<Listing> list_all(std::string folder) {
  Pe& pe = current_pe();
  const std::vector<PeId> leaders = first_of_processes(pe);
  AskAll<&look_here> looked(FolderQuestion{std::move(folder)}, leaders);
  const std::vector<SeenFolder> answers = co_await looked;
  std::vector<SeenFolder> seen;
  seen.reserve(leaders.size());
  for (const PeId leader : leaders) seen.push_back(answers[static_cast<std::size_t>(leader.value)]);
  co_return list_hosts(seen, pe.machine().pes_per_process());
}

void require_main(const std::string& what) {
  Pe& pe = current_pe();
  TESS_CHECK(pe.id().value == 0 && pe.context().element == nullptr, what,
             " belongs into the coroutine that was given to run(), not into a chare");
  TESS_CHECK(pe.context().epoch.value == 0, what, " is called inside an epoch");
}

Task write_checkpoint(std::string folder, std::string state_type,
                      std::function<std::vector<std::byte>()> pack, CheckpointOptions options,
                      std::string note) {
  require_main("checkpoint()");
  const OnlyOne only_one(current_pe().runtime());
  TESS_CHECK(!folder.empty(), "checkpoint() to a path without a name: give a folder");
  TESS_CHECK(options.keep >= 1, "keep: ", options.keep, " checkpoints");
  MainPart main;
  main.state_type = std::move(state_type);
  std::exception_ptr error;
  Begun begun;
  try {
    co_await save_all(folder, std::move(main), std::move(pack), options, std::move(note), begun);
  } catch (const Error&) {
    error = std::current_exception();
  } catch (const std::exception& other) {  // of the state's serialize(), the files, or the memory
    error =
        std::make_exception_ptr(Error(ErrorCode::environment, text(folder, ": ", other.what())));
  } catch (...) {
    error = std::make_exception_ptr(
        Error(ErrorCode::environment, text(folder, ": an exception that is not a std::exception")));
  }
  if (error && !begun.writers.empty()) {  // it may have filled the memory or the disk
    AskAll<&remove_here> removed(RemoveQuestion{folder, {begun.number}}, begun.writers);
    (void)co_await removed;
  }
  AskAll<&thaw_here> thawed(Thaw{});
  (void)co_await thawed;
  if (error) std::rethrow_exception(error);
}

}  // namespace tess::detail
