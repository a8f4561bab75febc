// One object per process, shared by its PEs:
//
// Sample: tests/samples/process_group.cpp
//
//     class Cache {
//      public:
//       void put(int key, double value) { values_[key] = value; }
//       double get(int key) const { return values_.at(key); }
//       // …
//     };
//     // …
//     caches = tess::create<Cache>(tess::each_process);
//     // …
//     caches.write([](Cache& cache) { cache.put(3, 0.5); });  // this process, at once
//     caches[process].send<&Cache::put>(4, 1.5);              // any process, by a message
//     // …
//     const double value = caches.read([](const Cache& cache) { return cache.get(3); });
//
// The class needs no base and no lock: the group holds one. read() and const entry methods run
// while others read, on any PE of the process; write() and other entry methods exclude all others.
// So none of them may wait, and none may call read() or write() of the same group: that ends the
// job.
//
// Data that is never written needs no lock. It is sent once to each process:
//
//     table = tess::create_read_only(Table{…});
//     table->look_up(3)                                             // on any PE
//
// Both are groups: a PE that a message reaches before the group does not know it yet (create them
// inside an awaited epoch, or check known()), and destroy() ends them. On the simulated machine a
// process is what --sim per-process says.
#pragma once

#include "runtime/group.hpp"

#include <functional>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <tuple>
#include <type_traits>
#include <utility>

namespace tess {

namespace detail {

/// A pointer in a message that does not leave its process.
template <class T>
struct SameProcess {
  std::shared_ptr<T> object;
  using GivesMembers = void;
  template <class Ar>
  void serialize(Ar& /*ar*/) {
    TESS_CHECK(false, "an object that PEs share is sent to another process");
  }
};

/// The object of a process group, and the lock that guards it.
template <class G>
struct Guarded {
  G object;
  std::shared_mutex mutex{};
  template <class... Args>
  explicit Guarded(std::in_place_t /*tag*/, Args&&... args) : object(std::forward<Args>(args)...) {}
};

/// The part of a process group on one PE.
template <class G>
class ProcessPart : public Group<ProcessPart<G>> {
 public:
  static constexpr bool shared_in_process = true;
  using Shared = Guarded<G>;
  explicit ProcessPart(SameProcess<Shared> shared) : shared_(std::move(shared.object)) {}

  template <class F>
  auto read(const F& f) {
    const Inside inside(*this);
    const std::shared_lock lock(shared_->mutex);
    return f(std::as_const(shared_->object));
  }
  template <class F>
  auto write(const F& f) {
    const Inside inside(*this);
    const std::unique_lock lock(shared_->mutex);
    return f(shared_->object);
  }

  /// Calls entry method F of the object; returns what that returns.
  template <auto F>
  typename EntryTraits<F>::Result run(typename EntryTraits<F>::Arguments arguments) {
    // It uses std::invoke(): g++ 12 warns of (object.*F) where F of a base class gives a value.
    const auto call = [&arguments](auto& object) {
      return std::apply(
          [&object](auto&... argument) { return std::invoke(F, object, std::move(argument)...); },
          arguments);
    };
    return run_as(call, F);
  }
  /// A broadcast does the same on one PE of each process.
  template <auto F>
  void run_once(typename EntryTraits<F>::Arguments arguments) {
    if (current_pe().machine().is_first_of_process(this->pe())) run<F>(std::move(arguments));
  }

 private:
  template <class Call, class R, class C, class... P>
  R run_as(const Call& call, R (C::*)(P...)) {
    return write(call);
  }
  template <class Call, class R, class C, class... P>
  R run_as(const Call& call, R (C::*)(P...) const) {
    return read(call);
  }
  template <class Call, class R, class C, class... P>
  R run_as(const Call& call, R (C::*)(P...) noexcept) {
    return write(call);
  }
  template <class Call, class R, class C, class... P>
  R run_as(const Call& call, R (C::*)(P...) const noexcept) {
    return read(call);
  }

  /// Refuses what would wait for itself.
  class Inside {
   public:
    explicit Inside(ProcessPart& part) : part_(part) {
      TESS_CHECK(
          !part.inside_, plain_name(name_of_type<G>),
          ": read() or write() of a process group is called inside another of the same group");
      part_.inside_ = true;
    }
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;
    ~Inside() { part_.inside_ = false; }

   private:
    ProcessPart& part_;
  };

  std::shared_ptr<Shared> shared_;
  bool inside_ = false;
};

/// The part of read-only data on one PE.
template <class T>
class ReadOnlyPart : public Group<ReadOnlyPart<T>> {
 public:
  static constexpr bool shared_in_process = true;
  struct Shared {
    const T object;
    template <class... Args>
    explicit Shared(std::in_place_t /*tag*/, Args&&... args)
        : object(std::forward<Args>(args)...) {}
  };
  explicit ReadOnlyPart(SameProcess<Shared> shared) : shared_(std::move(shared.object)) {}
  [[nodiscard]] const T& get() const { return shared_->object; }

 private:
  std::shared_ptr<Shared> shared_;
};

template <class Part, class... Args>
struct CreateShared {
  CollectionId id{};
  std::tuple<Args...> args;
  template <class Ar>
  void serialize(Ar& ar) {
    ar(id, args);
  }
};

/// Makes the object of this process and gives it to all PEs of the process.
template <class Part, class... Args>
void create_shared_arrives(Pe& pe, CreateShared<Part, Args...>&& m, Counted counted) {
  using Shared = typename Part::Shared;
  const SameProcess<Shared> shared{std::apply(
      [](auto&... arg) {
        return call_user(
            [&] { return std::make_shared<Shared>(std::in_place, std::move(arg)...); });
      },
      m.args)};
  using Create = CreateArray<Part, SameProcess<Shared>>;
  const Create create{m.id, range(pe.n_pes()), {shared}};
  constexpr auto handler = &create_arrives<Part, SameProcess<Shared>>;
  const Machine& machine = pe.machine();
  const PeId first = machine.first_pe(machine.process_of(pe.id()));
  for (std::int32_t i = 0; i < machine.pes_per_process(); ++i)
    if (const PeId to{first.value + i}; to != pe.id()) send_system<handler>(pe, to, create);
  handler(pe, Create(create), std::move(counted));
}

/// One message to each process, and from there pointers to its PEs.
template <class Part, class... Args>
CollectionId create_shared(Args&&... args) {
  Pe& pe = current_pe();
  const CollectionId id = pe.collections().new_id(LateMessages::counted);
  using Create = CreateShared<Part, std::decay_t<Args>...>;
  Create create{id, {std::forward<Args>(args)...}};
  constexpr auto handler = &create_shared_arrives<Part, std::decay_t<Args>...>;
  const Machine& machine = pe.machine();
  for (std::int32_t i = 0; i < machine.n_processes(); ++i) {
    const ProcessId process{i};
    if (process != machine.process_of(pe.id()))
      send_system<handler>(pe, machine.first_pe(process), create);
  }
  handler(pe, std::move(create), Counted::sent(pe.completion(), pe.context().epoch));
  return id;
}

/// Checks that F can be called on the object of a process.
template <class G, auto F, class... Args>
consteval bool check_shared_call() {
  static_assert(check_ask<G, F, Args...>());
  static_assert(!GivenBy<typename EntryTraits<F>::Result>::is_task,
                "an entry method of a process group is no coroutine, which would keep the lock "
                "while it waits");
  return true;
}

}  // namespace detail

/// The object of one process, for messages.
template <class G>
class ProcessProxy : public Sends<ProcessProxy<G>> {
  using Part = detail::ProcessPart<G>;

 public:
  using Receiver = G;
  template <class Self>
  using Verbs = Sends<Self>;

  /// It refers to no object: it can only be assigned to.
  ProcessProxy() = default;
  ProcessProxy(CollectionId id, ProcessId process) : id_(id), process_(process) {}

  friend auto operator<=>(const ProcessProxy&, const ProcessProxy&) = default;
  [[nodiscard]] std::size_t hash() const {
    return static_cast<std::size_t>(mix(id_.value ^ static_cast<std::uint64_t>(process_.value)));
  }
  template <class Ar>
  void serialize(Ar& ar) {
    ar(id_, process_);
  }

 private:
  friend detail::ProxyAccess;

  void check_receiver() const { (void)member(); }
  /// The part on this PE, or on the first of another process.
  [[nodiscard]] MemberProxy<Part> member() const {
    Pe& pe = current_pe();
    const Machine& machine = pe.machine();
    TESS_CHECK(process_.value >= 0 && process_.value < machine.n_processes(), "there is no ",
               process_, ": the run has ", machine.n_processes());
    return GroupProxy<Part>(
        id_)[process_ == machine.process_of(pe.id()) ? pe.id() : machine.first_pe(process_)];
  }
  template <auto F, class Of, class... Args>
  void post(detail::How<Of> how, Args&&... args) const {
    static_assert(detail::check_entry<G, F, Args...>() &&
                  detail::check_shared_call<G, F, Args...>());
    using Arguments = typename detail::EntryTraits<F>::Arguments;
    detail::ProxyAccess::post<&Part::template run<F>>(
        member(), how, detail::as_parameters<Arguments>(std::forward<Args>(args)...));
  }
  template <auto F, class Of, class... Args>
  [[nodiscard]] auto ask_as(detail::How<Of> how, Args&&... args) const {
    static_assert(detail::check_shared_call<G, F, Args...>());
    using Arguments = typename detail::EntryTraits<F>::Arguments;
    return detail::ProxyAccess::ask<&Part::template run<F>>(
        member(), how, detail::as_parameters<Arguments>(std::forward<Args>(args)...));
  }
  static consteval bool check_on_demand() {
    return detail::ProxyAccess::check_on_demand<MemberProxy<Part>>();
  }
  [[nodiscard]] std::tuple<CollectionId, ProcessId> fields() const { return {id_, process_}; }
  [[nodiscard]] std::string in_words() const {
    return text(plain_name(name_of_type<G>), " of ", process_);
  }

  CollectionId id_{};
  ProcessId process_{};
};

/// The proxy of a process group; broadcast() calls the entry method once in each process.
template <class G>
class ProcessGroupProxy : public detail::WholeHandle<ProcessGroupProxy<G>>,
                          public Broadcasts<ProcessGroupProxy<G>> {
  using Part = detail::ProcessPart<G>;

 public:
  using Receiver = G;
  template <class Self>
  using Verbs = Broadcasts<Self>;
  using detail::WholeHandle<ProcessGroupProxy>::WholeHandle;

  /// Returns f(const G&) for the object of this process, while others may read it.
  template <class F>
  auto read(const F& f) const {
    static_assert(std::is_invocable_v<const F&, const G&>, "read() takes a function of (const G&)");
    static_assert(!std::is_reference_v<std::invoke_result_t<const F&, const G&>>,
                  "read() and write() return values: a reference would outlive the lock");
    return GroupProxy<Part>(id_).local().read(f);
  }
  /// Returns f(G&) for the object of this process, while no other call reads or writes it.
  template <class F>
  auto write(const F& f) const {
    static_assert(std::is_invocable_v<const F&, G&>, "write() takes a function of (G&)");
    static_assert(!std::is_reference_v<std::invoke_result_t<const F&, G&>>,
                  "read() and write() return values: a reference would outlive the lock");
    return GroupProxy<Part>(id_).local().write(f);
  }

  [[nodiscard]] ProcessProxy<G> operator[](ProcessId process) const { return {id_, process}; }

  /// True if the group is there on this PE.
  [[nodiscard]] bool known() const { return GroupProxy<Part>(id_).local_or_null() != nullptr; }

  friend auto operator<=>(const ProcessGroupProxy&, const ProcessGroupProxy&) = default;

 private:
  friend detail::ProxyAccess;
  using detail::WholeHandle<ProcessGroupProxy>::id_;

  template <auto F, class Of, class... Args>
  void broadcast_as(Of of, Args&&... args) const {
    static_assert(detail::check_broadcast<G, F, Args...>() &&
                  detail::check_shared_call<G, F, Args...>());
    using Arguments = typename detail::EntryTraits<F>::Arguments;
    detail::ProxyAccess::broadcast<&Part::template run_once<F>>(
        GroupProxy<Part>(id_), of, detail::as_parameters<Arguments>(std::forward<Args>(args)...));
  }
  [[nodiscard]] std::tuple<CollectionId> fields() const { return {id_}; }
  [[nodiscard]] std::string in_words() const {
    return plain_name(name_of_type<G>) + " of all processes";
  }
};

/// Says where the objects of create() are: one in each process.
struct EachProcess {};
inline constexpr EachProcess each_process{};

/// Creates one G in each process, constructed with these arguments.
template <class G, class... Args>
ProcessGroupProxy<G> create(EachProcess /*where*/, Args&&... args) {
  static_assert(std::is_constructible_v<G, std::decay_t<Args>...>,
                "the class has no constructor that takes these arguments");
  return ProcessGroupProxy<G>(
      detail::create_shared<detail::ProcessPart<G>>(std::forward<Args>(args)...));
}
template <class G, class... Args>
[[deprecated("create<G>(tess::each_process, …)")]] ProcessGroupProxy<G> create_process_group(
    Args&&... args) {
  return create<G>(each_process, std::forward<Args>(args)...);
}

/// Data that all PEs of a process read in the same memory.
template <class T>
class ReadOnly : public detail::WholeHandle<ReadOnly<T>> {
  using Part = detail::ReadOnlyPart<T>;

 public:
  using IsHandle = void;
  using detail::WholeHandle<ReadOnly>::WholeHandle;

  /// The data; valid until destroy().
  [[nodiscard]] const T& operator*() const { return GroupProxy<Part>(id_).local().get(); }
  [[nodiscard]] const T* operator->() const { return &**this; }
  /// True if the data is there on this PE.
  [[nodiscard]] bool known() const { return GroupProxy<Part>(id_).local_or_null() != nullptr; }

 private:
  using detail::WholeHandle<ReadOnly>::id_;
};

/// Sends the data to each process.
template <class T>
ReadOnly<std::decay_t<T>> create_read_only(T&& data) {
  return ReadOnly<std::decay_t<T>>(
      detail::create_shared<detail::ReadOnlyPart<std::decay_t<T>>>(std::forward<T>(data)));
}

}  // namespace tess
