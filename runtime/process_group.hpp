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
//     caches = tess::create_process_group<Cache>();
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

  /// Calls entry method F of the object.
  template <auto F>
  void run(typename EntryTraits<F>::Arguments arguments) {
    const auto call = [&arguments](auto& object) {
      std::apply([&object](auto&... argument) { (object.*F)(std::move(argument)...); }, arguments);
    };
    run_as(call, F);
  }
  /// The same for a broadcast: on one PE of each process.
  template <auto F>
  void run_once(typename EntryTraits<F>::Arguments arguments) {
    if (current_pe().machine().is_first_of_process(this->pe())) run<F>(std::move(arguments));
  }

 private:
  template <class Call, class R, class C, class... P>
  void run_as(const Call& call, R (C::*)(P...)) {
    write(call);
  }
  template <class Call, class R, class C, class... P>
  void run_as(const Call& call, R (C::*)(P...) const) {
    read(call);
  }
  template <class Call, class R, class C, class... P>
  void run_as(const Call& call, R (C::*)(P...) noexcept) {
    write(call);
  }
  template <class Call, class R, class C, class... P>
  void run_as(const Call& call, R (C::*)(P...) const noexcept) {
    read(call);
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
  const CollectionId id = pe.new_collection_id(LateMessages::counted);
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

/// Checks that F is an entry method of a process group's class.
template <class G, auto F, class... Args>
consteval bool check_shared_entry() {
  static_assert(check_entry<G, F, Args...>());
  static_assert(std::is_void_v<typename EntryTraits<F>::Result>,
                "an entry method of a process group returns void: a coroutine would keep the lock "
                "while it waits");
  return true;
}

}  // namespace detail

/// The proxy of a process group.
template <class G>
class ProcessGroupProxy : public detail::WholeHandle<ProcessGroupProxy<G>> {
  using Part = detail::ProcessPart<G>;

 public:
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

  /// The object of a process, for messages.
  class OfProcess {
   public:
    OfProcess(CollectionId id, ProcessId process) : id_(id), process_(process) {}
    template <auto F, class... Args>
    void send(Args&&... args) const {
      static_assert(detail::check_shared_entry<G, F, Args...>());
      Pe& pe = current_pe();
      const Machine& machine = pe.machine();
      TESS_CHECK(process_.value >= 0 && process_.value < machine.n_processes(), "there is no ",
                 process_, ": the run has ", machine.n_processes());
      const PeId to =
          process_ == machine.process_of(pe.id()) ? pe.id() : machine.first_pe(process_);
      GroupProxy<Part>(id_)[to].template send<&Part::template run<F>>(
          detail::as_parameters<typename detail::EntryTraits<F>::Arguments>(
              std::forward<Args>(args)...));
    }

   private:
    CollectionId id_;
    ProcessId process_;
  };
  [[nodiscard]] OfProcess operator[](ProcessId process) const { return {id_, process}; }

  /// Calls entry method F once in each process.
  template <auto F, class... Args>
  void broadcast(Args&&... args) const {
    static_assert(detail::check_shared_entry<G, F, Args...>());
    GroupProxy<Part>(id_).template broadcast<&Part::template run_once<F>>(
        detail::as_parameters<typename detail::EntryTraits<F>::Arguments>(
            std::forward<Args>(args)...));
  }

  /// True if the group is there on this PE.
  [[nodiscard]] bool known() const { return GroupProxy<Part>(id_).local_or_null() != nullptr; }
  /// Ends the group on all PEs.
  void destroy() const { detail::end_collection(id_); }

 private:
  using detail::WholeHandle<ProcessGroupProxy>::id_;
};

/// Creates one G in each process, constructed with these arguments.
template <class G, class... Args>
ProcessGroupProxy<G> create_process_group(Args&&... args) {
  static_assert(std::is_constructible_v<G, std::decay_t<Args>...>,
                "the class has no constructor that takes these arguments");
  return ProcessGroupProxy<G>(
      detail::create_shared<detail::ProcessPart<G>>(std::forward<Args>(args)...));
}

/// Data that all PEs of a process read in the same memory.
template <class T>
class ReadOnly : public detail::WholeHandle<ReadOnly<T>> {
  using Part = detail::ReadOnlyPart<T>;

 public:
  using detail::WholeHandle<ReadOnly>::WholeHandle;

  /// The data; valid until destroy().
  [[nodiscard]] const T& operator*() const { return GroupProxy<Part>(id_).local().get(); }
  [[nodiscard]] const T* operator->() const { return &**this; }
  /// True if the data is there on this PE.
  [[nodiscard]] bool known() const { return GroupProxy<Part>(id_).local_or_null() != nullptr; }
  /// Frees the data in all processes.
  void destroy() const { detail::end_collection(id_); }

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

template <class G>
struct std::hash<tess::ProcessGroupProxy<G>> : tess::detail::HashOfHandle {};
template <class T>
struct std::hash<tess::ReadOnly<T>> : tess::detail::HashOfHandle {};
