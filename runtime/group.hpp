// Groups: one member on each PE, until destroy() or the end of the run. class Manager : public
// tess::Group<Manager> { … }; Messages go to the member on a PE; the member on this PE is an
// ordinary object to its neighbours: proxy.local().
#pragma once

#include "runtime/collections/collection_action.hpp"
#include "runtime/collections/contribution.hpp"
#include "runtime/collections/ending.hpp"
#include "runtime/collections/make_chare.hpp"
#include "runtime/messages/entry_traits.hpp"
#include "runtime/scheduler/pe_action.hpp"
#include "runtime/task.hpp"

namespace tess {

template <class G>
class GroupProxy;

/// The base of a group's members.
template <class Derived>
class Group : public Element {
 public:
  virtual ~Group() = default;

  [[nodiscard]] PeId pe() const { return pe_; }
  /// The group this is a member of.
  [[nodiscard]] GroupProxy<Derived> group() const { return GroupProxy<Derived>(id_); }

  /// Gives this member's value to the next reduction of the group; every member gives one.
  /// in_order(op) combines in the order of PEs.
  template <class Op, class T>
  void contribute(Op op, T value, Callback<T> target) {
    if (this->collection_ == nullptr) [[unlikely]] {
      const auto held = std::make_shared<std::pair<T, Callback<T>>>(std::move(value), target);
      Element::after_construction("contribute()", [this, op, held] {
        contribute(op, std::move(held->first), std::move(held->second));
      });
      return;
    }
    contribute_as(pe_, *this, *this->collection_, op, std::move(value), std::move(target));
  }

 protected:
  Group() : pe_(current_pe().id()), id_(constructing_collection(current_pe())->id()) {}

 private:
  const PeId pe_;
  const CollectionId id_;
};

/// A group on one PE: its one member.
template <class G>
class GroupOf final : public Collection {
 public:
  template <class... Args>
  GroupOf(Pe& pe, CollectionId id, const Args&... args)
      : Collection(pe, id, plain_name(name_of_type<G>)) {
    {
      const Pe::Construction construction(pe, this, this);
      member_.reset(make_chare<G>(args...));
    }
    born(*member_);
    list(*member_);
    run_after_construction();
  }

  [[nodiscard]] G& member() { return *member_; }
  void end() override {
    if constexpr (requires { member_->group_ends(); }) member_->group_ends();
    Collection::end();
    if (const Element& own = *member_; !own.doomed_) end_member();
  }
  void settle(Element& element) override {
    if (ended()) {
      end_member();
      free_later(*this);
      return;
    }
    TESS_CHECK(element.migrate_to_.value < 0 && !element.doomed_, "members of ", name(),
               " neither migrate nor end");
  }
  [[nodiscard]] bool migratable() const override { return false; }
  [[nodiscard]] std::string constructed_text(const void* /*index*/) const override {
    return text(name(), "[", pe_.id(), "]");
  }
  [[nodiscard]] std::string index_text_of(const Element& /*element*/) const override {
    return text("[", pe_.id(), "]");
  }

 private:
  void end_member() {
    unlist(*member_);
    member_.reset();
  }

  std::unique_ptr<G> member_;
};

/// A call of entry method F of the member of G on a PE.
template <class G, auto F>
struct GroupCall final : Envelope {
  using Arguments = typename EntryTraits<F>::Arguments;
  CollectionId collection{};
  Arguments arguments;

  template <class... A>
  explicit GroupCall(A&&... a) : arguments(std::forward<A>(a)...) {}

  static void run(Pe& pe, Envelope* envelope) {
    auto* call = static_cast<GroupCall*>(envelope);
    Collection* collection = find_collection(pe, call->collection);
    if (collection == nullptr) {
      pe.keep_early(call->collection, envelope, &drop);
      return;
    }
    G& member = static_cast<GroupOf<G>*>(collection)->member();
    const EpochId epoch = call->epoch;
    {
      const ElementScope scope(pe, member, call->action, epoch);
      try {
        std::apply([&member](auto&... argument) { (void)(member.*F)(std::move(argument)...); },
                   call->arguments);
      } catch (...) {
        pe.note_place();
        destroy(envelope);
        throw;
      }
      destroy(envelope);
    }
    pe.completion().processed(epoch);
  }
  static std::uint64_t drop(Pe& pe, Envelope& envelope) {
    pe.completion().processed(envelope.epoch);
    return 1;
  }
  static void destroy(Envelope* envelope) {
    auto* call = static_cast<GroupCall*>(envelope);
    call->~GroupCall();
    release_block(call, sizeof(GroupCall));
  }
  static void pack(Envelope& envelope, Writer& ar) {
    auto& call = static_cast<GroupCall&>(envelope);
    ar(call.collection, call.arguments);
  }
  static Envelope* unpack(Pe& pe, Reader& ar) {
    auto* call = new (allocate_block(pe, sizeof(GroupCall))) GroupCall();
    ar(call->collection, call->arguments);
    return call;
  }
  static inline const Action entry{
      name_of_type<GroupCall>, &run, &destroy, &pack, &unpack, Traffic::user};
};

/// A call of entry method F of all members.
template <class G, auto F>
class CallOfMembers final : public BroadcastCall {
 public:
  using Arguments = typename EntryTraits<F>::Arguments;
  explicit CallOfMembers(Arguments arguments) : arguments_(std::move(arguments)) {}

  [[nodiscard]] const BroadcastKind& kind() const override { return kind_; }
  [[nodiscard]] const Action& action() const override { return GroupCall<G, F>::entry; }
  void invoke(Element& element) const override {
    std::apply(
        [&element](const auto&... argument) { (void)(static_cast<G&>(element).*F)(argument...); },
        arguments_);
  }
  void pack(Writer& ar) const override { ar(arguments_); }

 private:
  static SharedCall unpack(Reader& ar) {
    return SharedCall(new CallOfMembers(ar.take<Arguments>()));
  }
  static inline const BroadcastKind kind_{name_of_type<CallOfMembers>, &unpack};
  Arguments arguments_;
};

/// The member of a group on one PE.
template <class G>
class MemberProxy {
 public:
  MemberProxy(CollectionId id, PeId pe) : id_(id), pe_(pe) {}

  template <auto F, class... Args>
  void send(Args&&... args) const {
    static_assert(check_entry<G, F, Args...>());
    Pe& pe = current_pe();
    check_exists(pe, pe_);
    using Held = GroupCall<G, F>;
    auto* call = new (allocate_block(pe, sizeof(Held))) Held(std::forward<Args>(args)...);
    call->action = &Held::entry;
    call->collection = id_;
    pe.stamp(call);
    pe.completion().sent(call->epoch);
    pe.send(pe_, call);
  }

  [[nodiscard]] PeId next_pe() const { return pe_; }

  /// A target for results: entry method F of this member.
  template <auto F>
  [[nodiscard]] auto target() const {
    using T = std::tuple_element_t<0, typename EntryTraits<F>::Arguments>;
    return Callback<T>(target_kind<F, T>, to_bytes(std::tuple(id_, pe_)));
  }

 private:
  template <auto F, class T>
  static void call_target(const Callback<T>& callback, T&& value) {
    const auto [id, pe] = from_bytes<std::tuple<CollectionId, PeId>>(callback.where());
    MemberProxy(id, pe).template send<F>(std::forward<T>(value));
  }
  template <auto F, class T>
  static inline const typename Callback<T>::Kind target_kind{
      naming::value<&MemberProxy::call_target<F, T>>(), &MemberProxy::call_target<F, T>};
  CollectionId id_;
  PeId pe_;
};

/// A whole group.
template <class G>
class GroupProxy {
 public:
  GroupProxy() = default;
  explicit GroupProxy(CollectionId id) : id_(id) {}

  [[nodiscard]] CollectionId id() const { return id_; }
  [[nodiscard]] MemberProxy<G> operator[](PeId pe) const { return MemberProxy<G>(id_, pe); }

  /// The member on this PE, or null where the group is not known yet or was destroyed.
  [[nodiscard]] G* local_or_null() const {
    Collection* collection = find_collection(current_pe(), id_);
    return collection == nullptr ? nullptr : &static_cast<GroupOf<G>*>(collection)->member();
  }
  /// The member on this PE.
  [[nodiscard]] G& local() const {
    G* member = local_or_null();
    TESS_CHECK(member != nullptr, "this group ",
               current_pe().ended(id_) ? "was destroyed" : "is not known yet", " on ",
               current_pe().id());
    return *member;
  }

  /// Calls entry method F of every member.
  template <auto F, class... Args>
  void broadcast(Args&&... args) const {
    static_assert(check_entry<G, F, Args...>());
    using Arguments = typename EntryTraits<F>::Arguments;
    start_broadcast(id_,
                    SharedCall(new CallOfMembers<G, F>(Arguments(std::forward<Args>(args)...))));
  }

  /// Ends the group: on every PE its member is destroyed and all that it holds is freed. What is
  /// still under way to it is dropped where it arrives; messages and broadcasts count as dead
  /// letters. A member whose coroutine waits gets no more messages, and ends once the coroutine is
  /// done. The epoch that runs waits until all PEs have freed the group. The second end of a group
  /// does nothing.
  void destroy() const { end_collection(id_); }

  template <class Ar>
  void serialize(Ar& ar) {
    ar(id_);
  }

 private:
  CollectionId id_{};
};

namespace detail {

/// Messages to an ended group of G are dead letters, unless the class says otherwise.
template <class G>
constexpr LateMessages late_messages_of() {
  if constexpr (requires { G::late_messages; }) {
    return G::late_messages;
  } else {
    return LateMessages::counted;
  }
}

template <class G, class... Args>
struct CreateGroup {
  CollectionId id;
  EpochId epoch;
  std::tuple<Args...> args;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(id, epoch, args);
  }
};

template <class G, class... Args>
void create_group_arrives(Pe& pe, CreateGroup<G, Args...>&& m) {
  std::apply([&](const Args&... args) { pe.add(std::make_unique<GroupOf<G>>(pe, m.id, args...)); },
             m.args);
  pe.completion().processed(m.epoch);
}

}  // namespace detail

/// Creates a group: one G on each PE, made with these arguments. Returns at once.
template <class G, class... Args>
GroupProxy<G> create_group(Args&&... args) {
  Pe& pe = current_pe();
  using Create = detail::CreateGroup<G, std::decay_t<Args>...>;
  Create message{pe.new_collection_id(detail::late_messages_of<G>()),
                 pe.context().epoch,
                 {std::forward<Args>(args)...}};
  constexpr auto handler = &detail::create_group_arrives<G, std::decay_t<Args>...>;
  for (std::int32_t to = 0; to < pe.n_pes(); ++to) {
    pe.completion().sent(message.epoch);
    if (PeId{to} != pe.id()) send_system<handler>(pe, PeId{to}, message);
  }
  const CollectionId id = message.id;
  handler(pe, std::move(message));
  return GroupProxy<G>(id);
}

}  // namespace tess
