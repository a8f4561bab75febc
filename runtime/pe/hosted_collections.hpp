// The collections on a PE, from the message that makes one known to the one that frees it:
//
//     before    messages and joins that arrive early wait for it, in the order of their arrival
//     known     find() gives it
//     ended     take_out(): it is found no more, and later messages to it are dropped
//     ending    keep_ending(): it is kept until the coroutines of its elements are done
//
// The hash tables stand in the source, since they are costly to compile.
#pragma once

#include "runtime/core/ids.hpp"
#include "runtime/pe/completion/counted.hpp"
#include "runtime/pe/interfaces/hosted_collection.hpp"
#include "runtime/pe/tables/ended_collections.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace tess::detail {

class Pe;
struct Envelope;
struct Waits;

class HostedCollections {
 public:
  explicit HostedCollections(Pe& pe);
  HostedCollections(const HostedCollections&) = delete;
  HostedCollections& operator=(const HostedCollections&) = delete;
  ~HostedCollections();

  /// Null if it is not known here, or has ended.
  [[nodiscard]] HostedCollection* find(CollectionId id) {
    if (last_id_ == id) return last_;
    return find_slow(id);
  }
  [[nodiscard]] std::vector<HostedCollection*> all() const;
  /// The numbers that this PE has given.
  [[nodiscard]] CollectionNumbers& numbers() { return numbers_; }
  [[nodiscard]] CollectionId new_id(LateMessages late = LateMessages::counted);

  /// Adds a collection; messages that arrived before it are sent on.
  void add(std::unique_ptr<HostedCollection> collection);
  /// Keeps a message whose collection is not known here yet. If the collection has ended here, the
  /// message is dropped: `drop` settles its epochs and returns the number of user messages that are
  /// lost with it.
  void keep_early(CollectionId id, Envelope* message, std::uint64_t (*drop)(Pe&, Envelope&));
  /// Keeps a round at which an element joins that was inserted from this PE before its collection
  /// was known here.
  void keep_early_join(CollectionId id, std::uint32_t round);
  [[nodiscard]] std::vector<std::uint32_t> take_early_joins(CollectionId id);

  [[nodiscard]] bool ended(CollectionId id) const { return ended_.contains(id); }
  /// A restart says that it had ended before the checkpoint.
  void had_ended(CollectionId id) { ended_.add(id); }
  /// Removes a collection: it ends here, and later messages to it are dropped.
  [[nodiscard]] std::unique_ptr<HostedCollection> take_out(CollectionId id);
  /// Keeps a removed collection until the coroutines of its elements are done.
  void keep_ending(std::unique_ptr<HostedCollection> collection, Counted end);
  /// If it is kept, what counts waits for it, too.
  void await_ending(CollectionId id, Counted&& end);
  struct Ending {
    std::vector<Counted> ends;  ///< the epochs of the ends wait for it
    std::unique_ptr<HostedCollection> collection;
  };
  [[nodiscard]] Ending take_ending(CollectionId id);

  /// Adds what waits in collections here, and for them.
  void add_waiting(Waits& waits) const;
  /// Ends the messages that wait here: the run is over.
  void drop_all();

 private:
  HostedCollection* find_slow(CollectionId id);
  [[nodiscard]] std::vector<Ending>::iterator find_ending(CollectionId id);

  static constexpr CollectionId none{~std::uint64_t{0}};

  Pe& pe_;
  CollectionId last_id_ = none;  // the collection that was found last
  HostedCollection* last_ = nullptr;
  CollectionNumbers numbers_;
  EndedCollections ended_;
  std::vector<Ending> ending_;
  struct Tables;
  const std::unique_ptr<Tables> tables_;
};

}  // namespace tess::detail
