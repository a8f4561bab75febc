#include "runtime/checkpoint/restore.hpp"

#include "runtime/checkpoint/ask_all.hpp"
#include "runtime/checkpoint/manifest.hpp"
#include "runtime/checkpoint/quiet.hpp"
#include "runtime/checkpoint/save.hpp"
#include "runtime/collections/collection.hpp"
#include "runtime/collections/index_map.hpp"
#include "runtime/core/error.hpp"
#include "runtime/scheduler/runtime.hpp"

#include <algorithm>
#include <optional>
#include <set>

namespace tess::detail {
namespace {

struct Nothing {
  std::uint8_t none = 0;
};
/// The collections of a run that is to be restored; there should be none.
std::vector<std::string> existing(Pe& pe, const Nothing& /*nothing*/) {
  std::vector<std::string> names;
  for (const HostedCollection* hosted : pe.collections())
    if (static_cast<const Collection*>(hosted)->kind().saving != Saving::skipped)
      names.push_back(hosted->name());
  return names;
}

/// The files of the PEs that a checkpoint was made on.
struct ReadQuestion {
  std::string folder;
  std::vector<FileSum> files;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(folder, files);
  }
};

/// Calls read(PE of the checkpoint, bytes) for each file that this PE reads. Returns what is wrong.
template <class Read>
std::string for_files_of(const Pe& pe, const ReadQuestion& question, const Read& read) {
  try {
    for (std::size_t i = static_cast<std::size_t>(pe.id().value); i < question.files.size();
         i += static_cast<std::size_t>(pe.n_pes()))
      read(read_file(question.folder, question.files[i]));
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

std::string verify_here(Pe& pe, const ReadQuestion& question) {
  return for_files_of(pe, question, [](const Buffer& /*bytes*/) {});
}

struct CreateQuestion {
  std::vector<SavedCollection> collections;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(collections);
  }
};
Nothing create_here(Pe& pe, const CreateQuestion& question) {
  for (const SavedCollection& saved : question.collections) {
    const CollectionKind& kind = *CollectionKind::find(saved.key);
    const bool group = kind.members != CollectionKind::Members::of_array;
    auto made = kind.make(pe, saved.id, group ? range(pe.n_pes()) : saved.range);
    made->set_index_map(from_saved(saved.map));
    pe.add(std::move(made));
  }
  return {};
}

/// The elements of the files go to their homes.
std::string restore_here(Pe& pe, const ReadQuestion& question) {
  return for_files_of(pe, question, [&pe](const Buffer& bytes) {
    Reader ar(std::span<const std::byte>(bytes.data(), bytes.size()));
    for (auto n = ar.take<std::uint64_t>(); n > 0; --n) {
      Collection& collection = *find_collection(pe, ar.take<CollectionId>());
      collection.restore(ar);
      Reader sections = ar.part(ar.take<std::uint64_t>());
      if (sections.remaining() > sizeof(std::uint64_t)) collection.restore_sections(sections);
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
    if (id == pe.id()) pe.collection_numbers().continue_after(question.numbers[creator]);
    CollectionNumbers again;
    for (const LateMessages late : {LateMessages::counted, LateMessages::ignored})
      for (auto n = question.numbers[creator][late == LateMessages::ignored ? 1 : 0]; n > 0; --n)
        if (const CollectionId one = again.next(id, late); !alive.contains(one.value))
          ended.push_back(one);
  }
  for (const CollectionId id : ended) pe.had_ended(id);
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
};

/// Throws Error if this program cannot restore the checkpoint on this many PEs.
void check_plan(const Chosen& chosen, const std::string& state_type, std::int32_t n_pes) {
  const std::int32_t n_saved = chosen.manifest.n_pes;
  for (const SavedCollection& saved : chosen.main.collections) {
    const CollectionKind* const kind = CollectionKind::find(saved.key);
    if (kind == nullptr)
      fail(ErrorCode::bad_file, chosen.folder, " has elements of the class ", saved.name,
           ", which this program has not: restart with the program that wrote it");
    if (kind->saving != Saving::elements)
      fail(ErrorCode::bad_file, chosen.folder, " has elements of the class ", saved.name,
           ", which cannot be restored any more: it needs a default constructor and serialize()");
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

}  // namespace

std::string latest_checkpoint(const std::string& folder) {
  for (const std::uint64_t number : numbers_in(folder))
    if (is_complete(folder, number)) return folder_of(folder, number);
  return {};
}

Task read_checkpoint(std::string folder, std::string state_type, std::vector<std::byte>& state) {
  require_main("restart()");
  Pe& pe = current_pe();
  AskAll<&existing> present(Nothing{});
  for (const std::vector<std::string>& names : co_await present)
    if (!names.empty())
      fail(ErrorCode::bad_argument, "restart() comes first, but this run has already made ",
           names.front());

  const std::vector<std::uint64_t> numbers = numbers_in(folder);
  if (numbers.empty())
    fail(ErrorCode::bad_file, folder, ": no checkpoint is in this folder; start without a restart");
  Runtime::OwnCheckpoints own{.last = numbers.front()};
  std::optional<Chosen> chosen;
  for (std::size_t i = 0; i < numbers.size() && !chosen; ++i) {
    Chosen candidate;
    candidate.folder = folder_of(folder, numbers[i]);
    std::string error;
    try {
      candidate.manifest = read_manifest(candidate.folder);
      const Buffer bytes = read_file(candidate.folder, candidate.manifest.files.back());
      candidate.main = from_bytes<MainPart>({bytes.data(), bytes.size()});
      candidate.manifest.files.pop_back();
    } catch (const Error& wrong) {
      error = wrong.what();
    }
    if (error.empty()) {
      AskAll<&verify_here> verified(ReadQuestion{candidate.folder, candidate.manifest.files});
      for (std::string& wrong : co_await verified)
        if (error.empty()) error = std::move(wrong);
    }
    if (error.empty()) {
      chosen = std::move(candidate);
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

  AskAll<&create_here> created(CreateQuestion{chosen->main.collections});
  (void)co_await created;
  AskAll<&restore_here> restored(ReadQuestion{chosen->folder, chosen->manifest.files});
  for (const std::string& error : co_await restored)
    if (!error.empty()) fail(ErrorCode::environment, "the restart failed: ", error);
  Quiet arrived;
  (void)co_await arrived;
  AskAll<&finish_here> finished(
      FinishQuestion{chosen->main.collections, chosen->main.numbers, chosen->main.sections});
  (void)co_await finished;
  Quiet settled;
  (void)co_await settled;
  state = std::move(chosen->main.state);
  pe.runtime().own_checkpoints(canonical(folder)) = std::move(own);
}

}  // namespace tess::detail
