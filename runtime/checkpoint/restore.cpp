#include "runtime/checkpoint/restore.hpp"

#include "runtime/arrays/collection.hpp"
#include "runtime/arrays/elements/index_map.hpp"
#include "runtime/checkpoint/ask_all.hpp"
#include "runtime/checkpoint/hosts.hpp"
#include "runtime/checkpoint/manifest.hpp"
#include "runtime/checkpoint/quiet.hpp"
#include "runtime/checkpoint/save.hpp"
#include "runtime/core/error.hpp"
#include "runtime/pe/runtime.hpp"

#include <algorithm>
#include <optional>
#include <set>

namespace tess::detail {
namespace {

struct Nothing {
  std::uint8_t none = 0;
};
/// The collections of a run that is to be restored, or that it has had: there should be none.
std::vector<std::string> existing(Pe& pe, const Nothing& /*nothing*/) {
  std::vector<std::string> names;
  for (const HostedCollection* hosted : pe.collections().all())
    if (static_cast<const Collection*>(hosted)->kind().saving != Saving::skipped)
      names.push_back(hosted->name());
  if (names.empty() && pe.collections().numbers().made() != CollectionNumbers::Made{})
    names.emplace_back("an array, group or section that has ended");
  return names;
}

/// What all PEs have to know of a checkpoint, as one host has it.
struct Opened {
  std::string error;  // empty: the rest is good
  Manifest manifest;
  MainPart main;
};
struct OpenQuestion {
  std::string folder;
};
Opened open_here(Pe& /*pe*/, const OpenQuestion& question) {
  Opened opened;
  opened.error = error_of([&] {
    opened.manifest = read_manifest(question.folder);
    const Buffer bytes = read_file(question.folder, opened.manifest.files.back());
    opened.main = from_bytes<MainPart>({bytes.data(), bytes.size()});
    opened.manifest.files.pop_back();
  });
  return opened;
}

struct VerifyQuestion {
  std::string folder;
  std::vector<FileSum> files;
  Hosts hosts;
  bool buddy_copies = false;
};
/// A file of a checkpoint, or its copy, as a PE found it.
struct Found {
  std::uint64_t file = 0;  // position in the manifest
  std::string name;
  std::string error;  // empty: it is as the manifest says
};
/// The PEs of a host share the files between them. A copy is read if the file itself is missing or
/// damaged there.
std::vector<Found> verify_here(Pe& pe, const VerifyQuestion& question) {
  const auto self = static_cast<std::size_t>(pe.id().value);
  const std::vector<std::uint32_t>& of_pe = question.hosts.of_pe;
  const auto n_on_host = static_cast<std::size_t>(std::ranges::count(of_pe, of_pe[self]));
  const auto mine = static_cast<std::size_t>(
      std::count(of_pe.begin(), of_pe.begin() + pe.id().value, of_pe[self]));
  std::vector<Found> all;
  const auto is_good = [&](std::size_t file, const std::string& name) {
    FileSum sum = question.files[file];
    sum.name = name;
    all.push_back({file, name, error_of([&] { (void)read_file(question.folder, sum); })});
    return all.back().error.empty();
  };
  for (std::size_t i = mine; i < question.files.size(); i += n_on_host) {
    const std::string& name = question.files[i].name;
    const std::string copy = name_of_copy(name);
    if (!question.buddy_copies) {
      (void)is_good(i, name);
    } else if (!(has_file(question.folder, name) && is_good(i, name)) &&
               has_file(question.folder, copy)) {
      (void)is_good(i, copy);
    }
  }
  return all;
}

/// A file that a PE reads.
struct Reading {
  PeId reader;
  FileSum sum;
};
struct ReadQuestion {
  std::string folder;
  std::vector<Reading> files;
};

/// Which PE reads each file. `damaged` are those in whose place others are read. Throws Error for a
/// file that no host has as it was written.
std::vector<Reading> plan_reading(const VerifyQuestion& checkpoint,
                                  const std::vector<std::vector<Found>>& found,
                                  std::vector<std::string>& damaged) {
  const std::vector<FileSum>& files = checkpoint.files;
  std::vector<Reading> readings;
  readings.reserve(files.size());
  for (const FileSum& file : files) readings.push_back({PeId{-1}, file});
  std::vector<std::string> errors(files.size());
  for (std::size_t pe = 0; pe < found.size(); ++pe) {
    for (const Found& one : found[pe]) {
      Reading& reading = readings.at(one.file);
      if (!one.error.empty()) {
        damaged.push_back(one.error);
        errors[one.file] = one.error;
      } else if (reading.reader.value < 0 || one.name == files[one.file].name) {
        reading.reader = PeId{static_cast<std::int32_t>(pe)};
        reading.sum.name = one.name;
      }
    }
  }
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (readings[i].reader.value >= 0) continue;
    if (!errors[i].empty()) fail(ErrorCode::bad_file, errors[i]);
    fail(ErrorCode::bad_file, checkpoint.folder, "/", files[i].name, " is on no host of this run, ",
         "nor is its copy ", name_of_copy(files[i].name));
  }
  return readings;
}

struct CreateQuestion {
  std::vector<SavedCollection> collections;
  std::vector<CollectionNumbers::Made> numbers;
  std::uint32_t places_of_futures = 0;
  std::uint64_t timers = 0;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(collections, numbers, places_of_futures, timers);
  }
};
Nothing create_here(Pe& pe, const CreateQuestion& question) {
  // What constructors of restored elements make has no number of the saved run.
  pe.futures().begin_behind(question.places_of_futures);
  pe.timers().begin_behind(question.timers);
  if (const auto here = static_cast<std::size_t>(pe.id().value); here < question.numbers.size())
    pe.collections().numbers().continue_after(question.numbers[here]);
  for (const SavedCollection& saved : question.collections) {
    const CollectionKind& kind = *CollectionKind::find(saved.key);
    const bool group = kind.members != CollectionKind::Members::of_array;
    auto made = kind.make(pe, saved.id, group ? range(pe.n_pes()) : saved.range);
    made->set_index_map(from_saved(saved.map));
    pe.collections().add(std::move(made));
  }
  return {};
}

/// The elements of the files go to their homes.
std::string restore_here(Pe& pe, const ReadQuestion& question) {
  return error_of([&] {
    for (const Reading& file : question.files) {
      if (file.reader != pe.id()) continue;
      const Buffer bytes = read_file(question.folder, file.sum);
      Reader ar(std::span<const std::byte>(bytes.data(), bytes.size()));
      for (auto n = ar.take<std::uint64_t>(); n > 0; --n) {
        const auto id = ar.take<CollectionId>();
        Collection* const collection = find_collection(pe, id);
        if (collection == nullptr)
          fail(ErrorCode::bad_file, question.folder, "/", file.sum.name,
               " has elements of a collection ", id.value,
               ", which the file main does not list: restart from another checkpoint");
        collection->restore(ar);
        Reader sections = ar.part(ar.take<std::uint64_t>());
        if (sections.remaining() > sizeof(std::uint64_t)) collection->restore_sections(sections);
      }
    }
  });
}

struct FinishQuestion {
  std::vector<SavedCollection> collections;
  std::vector<CollectionNumbers::Made> numbers;
  std::vector<SectionId> sections;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(collections, numbers, sections);
  }
};
Nothing finish_here(Pe& pe, const FinishQuestion& question) {
  std::set<std::uint64_t> alive;
  for (const SavedCollection& saved : question.collections) alive.insert(saved.id.value);
  for (const SectionId id : question.sections) alive.insert(id.value);
  std::vector<CollectionId> ended;
  for (std::size_t creator = 0; creator < question.numbers.size(); ++creator) {
    const PeId id{static_cast<std::int32_t>(creator)};
    CollectionNumbers again;
    for (const LateMessages late : {LateMessages::counted, LateMessages::ignored})
      for (auto n = question.numbers[creator][late == LateMessages::ignored ? 1 : 0]; n > 0; --n)
        if (const CollectionId one = again.next(id, late); !alive.contains(one.value))
          ended.push_back(one);
  }
  for (const CollectionId id : ended) pe.collections().had_ended(id);
  for (const SavedCollection& saved : question.collections) {
    Collection& collection = *find_collection(pe, saved.id);
    collection.restored();
    if (!saved.has_sections) continue;
    for (const CollectionId id : ended)
      if (CollectionNumbers::late_messages(id) == LateMessages::ignored)
        collection.section_had_ended(SectionId{id.value});
  }
  return {};
}

/// A checkpoint whose files are good.
struct Chosen {
  std::string folder;
  Manifest manifest;
  MainPart main;
  std::vector<Reading> readings;
  std::vector<std::string> damaged;  // what is wrong with files in whose place copies are read
};

/// Reads a checkpoint and compares it with its manifest. Throws Error that says what is wrong.
TaskOf<Chosen> choose(std::string folder, std::uint64_t number, const Listing& listing) {
  Pe& pe = current_pe();
  Chosen chosen;
  chosen.folder = folder_of(folder, number);
  std::string error;
  bool opened = false;
  for (std::size_t host = 0; host < listing.hosts.first.size() && !opened; ++host) {
    // If no host has a manifest, the first one reports that.
    const bool has = listing.complete_on[host].contains(number);
    if (!has && (host != 0 || listing.is_complete(number))) continue;
    const PeId first = listing.hosts.first[host];
    AskAll<&open_here> asked(OpenQuestion{chosen.folder}, {first});
    Opened answer = std::move((co_await asked)[static_cast<std::size_t>(first.value)]);
    opened = answer.error.empty();
    chosen.manifest = std::move(answer.manifest);
    chosen.main = std::move(answer.main);
    if (opened) continue;
    chosen.damaged.push_back(answer.error);
    if (error.empty()) error = std::move(answer.error);
  }
  if (!opened) fail(ErrorCode::bad_file, error);

  const bool copies = chosen.manifest.buddy_copies;
  const VerifyQuestion checkpoint{chosen.folder, chosen.manifest.files,
                                  copies ? listing.hosts : one_host(pe.n_pes()), copies};
  AskAll<&verify_here> verified(checkpoint);
  const auto found = co_await verified;
  chosen.readings = plan_reading(checkpoint, found, chosen.damaged);
  co_return chosen;
}

/// Throws Error if this program cannot restore the checkpoint on this many PEs.
void check_plan(const Chosen& chosen, const std::string& state_type, std::int32_t n_pes) {
  const std::int32_t n_saved = chosen.manifest.n_pes;
  std::set<std::uint64_t> listed;
  for (const SavedCollection& saved : chosen.main.collections) {
    if (!listed.insert(saved.id.value).second)
      fail(ErrorCode::bad_file, chosen.folder, "/main lists the collection ", saved.id.value,
           " twice: restart from another checkpoint");
    const CollectionKind* const kind = CollectionKind::find(saved.key);
    if (kind == nullptr)
      fail(ErrorCode::bad_file, chosen.folder, " has elements of the class ", saved.name,
           ", which this program has not: restart with the program that wrote it");
    if (kind->saving != Saving::elements)
      fail(ErrorCode::bad_file, chosen.folder, " has elements of the class ", saved.name,
           ", which cannot be restored any more: it needs a default constructor and a "
           "public serialize()");
    if (kind->members == CollectionKind::Members::of_array || n_pes == n_saved) continue;
    if (kind->members == CollectionKind::Members::fixed)
      fail(ErrorCode::bad_file, "the group ", saved.name, " of ", chosen.folder, " has ", n_saved,
           " members, but this run has ", n_pes, n_pes == 1 ? " PE" : " PEs", ": give the class ",
           saved.name, " a member function absorb(", saved.name, "&&), or restart on ", n_saved);
    if (saved.has_sections)
      fail(ErrorCode::bad_file, "the group ", saved.name, " of ", chosen.folder,
           " has sections of its members: restart it on ", n_saved, " PEs");
  }
  if (chosen.manifest.program != Registry::fingerprint())
    fail(ErrorCode::bad_file, chosen.folder,
         " was written by a program with other classes or entry methods: restart with that one");
  if (chosen.main.state_type != state_type)
    fail(ErrorCode::bad_file, chosen.folder, " has a state of type ", chosen.main.state_type,
         ", but restart<", state_type, ">() reads another");
}

/// Elements are under way until all is quiet, and a timer would hide that.
Task wait_until_quiet() {
  Quiet quiet;
  const std::vector<std::string> set = co_await quiet;
  if (set.empty()) co_return;
  AskAll<&thaw_here> thawed(Thaw{});
  (void)co_await thawed;
  fail(ErrorCode::bad_argument, "restart() waits for all messages, but ", set.front(),
       ": let no other coroutine sleep or set timers meanwhile");
}

}  // namespace

std::string latest_checkpoint(const std::string& folder) {
  for (const std::uint64_t number : numbers_in(folder))
    if (is_complete(folder, number)) return folder_of(folder, number);
  return {};
}

TaskOf<std::vector<std::byte>> read_checkpoint(std::string folder, std::string state_type) {
  require_main("restart()");
  Pe& pe = current_pe();
  if (!pe.futures().empty())
    fail(ErrorCode::bad_argument,
         "restart() comes first, but this run has already made a future, which a callback of the "
         "saved run could find: make it after the restart");
  if (pe.timers().n_waiting() + pe.timers().n_periodic() != 0)
    fail(ErrorCode::bad_argument,
         "restart() comes first, but this run has already set a timer, which a Timer of the saved "
         "run could name: set it after the restart");
  AskAll<&existing> present(Nothing{});
  for (const std::vector<std::string>& names : co_await present)
    if (!names.empty())
      fail(ErrorCode::bad_argument, "restart() comes first, but this run has already made ",
           names.front());

  const Listing listing = co_await list_all(folder);
  const std::vector<std::uint64_t>& numbers = listing.numbers;
  if (numbers.empty())
    fail(ErrorCode::bad_file, folder, ": no checkpoint is in this folder; start without a restart");
  Runtime::OwnCheckpoints own{.last = numbers.front()};
  std::optional<Chosen> chosen;
  for (std::size_t i = 0; i < numbers.size() && !chosen; ++i) {
    std::string error;
    try {
      chosen = co_await choose(folder, numbers[i], listing);
    } catch (const Error& wrong) {
      error = wrong.what();
    }
    if (chosen) {
      for (const std::string& one : chosen->damaged)
        pe.runtime().error_line(
            text("tessera: a file of a checkpoint is refused: ", one, "; its copy is used"));
      continue;
    }
    own.refused.push_back(numbers[i]);
    pe.runtime().error_line(text(
        "tessera: a checkpoint is refused: ", error,
        i + 1 < numbers.size() ? "; the one before is used: " + folder_of(folder, numbers[i + 1])
                               : std::string("; there is none before")));
  }
  if (!chosen) fail(ErrorCode::bad_file, folder, ": no checkpoint in this folder can be used");
  check_plan(*chosen, state_type, pe.n_pes());

  AskAll<&create_here> created(CreateQuestion{chosen->main.collections, chosen->main.numbers,
                                              chosen->main.places_of_futures, chosen->main.timers});
  (void)co_await created;
  AskAll<&restore_here> restored(ReadQuestion{chosen->folder, chosen->readings});
  for (const std::string& error : co_await restored)
    if (!error.empty()) fail(ErrorCode::environment, "the restart failed: ", error);
  co_await wait_until_quiet();
  AskAll<&finish_here> finished(
      FinishQuestion{chosen->main.collections, chosen->main.numbers, chosen->main.sections});
  (void)co_await finished;
  co_await wait_until_quiet();
  AskAll<&thaw_here> thawed(Thaw{});
  (void)co_await thawed;
  pe.runtime().made_before_restart() = std::move(chosen->main.numbers);
  pe.runtime().own_checkpoints(canonical(folder)) = std::move(own);
  // A number of its own: other runs may restart from the same checkpoint.
  pe.runtime().lineage() = std::move(chosen->manifest.lineage);
  pe.runtime().lineage().push_back(new_run());
  co_return std::move(chosen->main.state);
}

void refuse_state(std::string_view state_type, const Error& error) {
  fail(error.code(), "the checkpoint does not fit this program: its state ", state_type,
       " has other members (", error.what(), "); restart with the program that wrote it");
}

}  // namespace tess::detail
