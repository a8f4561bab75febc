// Serialisation of values, for messages between processes and for chares that migrate.
//
//     // an aggregate needs nothing
//     struct Edge { int step; std::vector<double> values; };
//     // any other class has one function for both directions
//     class Block {
//      public:
//       template <class Ar>
//       void serialize(Ar& ar) { ar(grid_, tile_, edges_); }
//     };
//     // a class of another library has it beside itself: in its own namespace, or in namespace tess
//     namespace tess {
//     template <class Ar>
//     void serialize(Ar& ar, std::bitset<64>& bits);
//     }
//
// Numbers, complex numbers, enums and durations are copied bit by bit: all processes of a job run
// the same binary on the same kind of machine. Standard and Boost containers, pair, tuple,
// optional, variant and unique_ptr work if their contents do. A raw or shared pointer does not
// compile, and a unique_ptr to a base class that holds a derived object ends the job. Reading
// compares every length with the bytes that are left and throws tess::Error.
//
// In a message to another process a large vector of numbers is not copied: its memory is attached
// and sent from where it is to where it is read. The stream holds only its length, with the highest
// bit set.
//
//     bytes:     | header | index | length of the vector, attached | next member … |
//     attached:  | the numbers of the vector |
#pragma once

#include "runtime/core/buffer.hpp"
#include "runtime/core/error.hpp"
#include "runtime/core/fields.hpp"
#include "runtime/core/serialize_kinds.hpp"
#include "runtime/core/uninitialised.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace tess {

class Reader;

namespace detail {

/// Memory that belongs to a message but is not copied into its bytes. The message or one of
/// `keepers` keeps it alive until it has been sent.
struct Attached {
  std::size_t least_bytes = 0;  ///< a smaller vector is copied
  std::size_t n_bytes = 0;      ///< sum over the parts
  std::vector<std::span<const std::byte>> parts;
  std::vector<std::shared_ptr<const void>> keepers;

  static constexpr std::size_t most_parts = 64;
  void clear() {
    n_bytes = 0;
    parts.clear();
    keepers.clear();
  }
};

/// The destinations of a message's attached parts, collected while its members are read in order.
struct Places {
  std::span<const std::uint64_t> sizes;      ///< of the parts, as announced by the sender
  std::vector<std::span<std::byte>>& taken;  ///< the destination of each part
};

}  // namespace detail

/// Writes values as bytes, either to the end of a buffer, which grows, or to memory of a fixed
/// size. Bytes that do not fit into fixed memory are counted and not written, so n_bytes() gives
/// the size that is needed.
class Writer {
 public:
  static constexpr bool is_reading = false;

  explicit Writer(detail::Buffer& out) : grows_(&out) {}
  explicit Writer(std::span<std::byte> out, detail::Attached* attached = nullptr)
      : begin_(out.data()),
        at_(out.data()),
        end_(out.data() + out.size()),
        attached_(attached),
        may_attach_(attached != nullptr) {}

  template <class... T>
  void operator()(const T&... values) {
    if constexpr (sizeof...(T) > 1 && (Bitwise<T> && ...)) {
      constexpr std::size_t n = (sizeof(T) + ...);
      if (n <= static_cast<std::size_t>(end_ - at_)) [[likely]] {
        n_bytes_ += n;
        ((std::memcpy(at_, &values, sizeof values), at_ += sizeof values), ...);
        return;
      }
    }
    (put(values), ...);
  }
  void bytes(const void* data, std::size_t n) {
    n_bytes_ += n;
    if (n <= static_cast<std::size_t>(end_ - at_)) [[likely]] {
      if (n != 0) std::memcpy(at_, data, n);
      at_ += n;
    } else if (grows_ != nullptr) {
      grows_->append({static_cast<const std::byte*>(data), n});
    } else {
      end_ = at_;  // nothing that follows is written either
    }
  }
  /// The bytes written, or needed.
  [[nodiscard]] std::size_t n_bytes() const { return n_bytes_; }

  /// Writes their number and the numbers, which may be attached if `keeper` keeps them; null: they
  /// are copied. Reader::numbers() reads them.
  template <class Each>
  void numbers(std::span<const Each> values, std::shared_ptr<const void> keeper);
  [[nodiscard]] std::size_t position() const { return n_bytes_; }
  /// Overwrites eight bytes that were written at this position.
  void patch(std::size_t position, std::uint64_t value) {
    if (grows_ != nullptr) {
      std::memcpy(grows_->data() + (grows_->size() - n_bytes_ + position), &value, sizeof value);
    } else if (begin_ != nullptr && begin_ + position + sizeof value <= end_) {
      std::memcpy(begin_ + position, &value, sizeof value);
    }
  }

 private:
  /// During its lifetime memory is attached only by numbers().
  class CopiesAll {
   public:
    explicit CopiesAll(Writer& writer)
        : writer_(writer), before_(std::exchange(writer.may_attach_, false)) {}
    CopiesAll(const CopiesAll&) = delete;
    CopiesAll& operator=(const CopiesAll&) = delete;
    ~CopiesAll() { writer_.may_attach_ = before_; }

   private:
    Writer& writer_;
    bool before_;
  };

  template <class T>
  void put(const T& value);
  template <class T>
  void put_items(const T& container);
  template <class Each>
  void put_numbers(std::span<const Each> values, bool attach);
  [[nodiscard]] bool fits(std::size_t n_bytes) const {
    return n_bytes != 0 && n_bytes >= attached_->least_bytes &&
           attached_->parts.size() < detail::Attached::most_parts;
  }
  void add_part(std::span<const std::byte> memory) {
    attached_->parts.push_back(memory);
    attached_->n_bytes += memory.size();
  }

  std::byte* begin_ = nullptr;
  std::byte* at_ = nullptr;
  std::byte* end_ = nullptr;
  std::size_t n_bytes_ = 0;
  detail::Buffer* grows_ = nullptr;
  detail::Attached* attached_ = nullptr;
  bool may_attach_ = false;
};

/// The number of bytes that a value takes when written.
template <class T>
[[nodiscard]] std::size_t written_bytes(const T& value) {
  Writer count{std::span<std::byte>()};
  count(value);
  return count.n_bytes();
}

/// Reads values in the order in which they were written. Throws tess::Error if the bytes end too
/// early.
class Reader {
 public:
  static constexpr bool is_reading = true;

  explicit Reader(std::span<const std::byte> in, detail::Places* places = nullptr)
      : in_(in), places_(places) {}

  template <class... T>
  void operator()(T&... values) {
    if constexpr (sizeof...(T) > 1 && (Bitwise<T> && ...)) {
      need((sizeof(T) + ...));
      const std::byte* from = in_.data() + at_;
      ((std::memcpy(&values, from, sizeof values), from += sizeof values), ...);
      at_ += (sizeof(T) + ...);
    } else {
      (get(values), ...);
    }
  }
  template <class T>
  [[nodiscard]] T take() {
    T value{};
    get(value);
    return value;
  }
  void bytes(void* data, std::size_t n) {
    need(n);
    if (n != 0) std::memcpy(data, in_.data() + at_, n);
    at_ += n;
  }
  /// The next n bytes without a copy; valid as long as the memory that is read.
  [[nodiscard]] std::span<const std::byte> view(std::size_t n) {
    need(n);
    at_ += n;
    return in_.subspan(at_ - n, n);
  }
  [[nodiscard]] std::size_t remaining() const { return in_.size() - at_; }
  /// A reader of only the next n bytes; both readers take attached parts from the same list.
  [[nodiscard]] Reader part(std::size_t n) { return Reader(view(n), places_); }

  /// Sets the destination of the next attached part, which has this many bytes. The part arrives
  /// later: until the message runs, this memory may neither be read nor moved.
  void place(void* memory, std::size_t n_bytes) {
    if (places_ == nullptr || places_->taken.size() == places_->sizes.size() ||
        places_->sizes[places_->taken.size()] != n_bytes)
      refuse_part(n_bytes, " bytes here");
    places_->taken.emplace_back(static_cast<std::byte*>(memory), n_bytes);
  }
  /// Reads numbers that may be attached: make_room(n) gives their place, which must not move until
  /// the message runs.
  template <class Each, class MakeRoom>
  void numbers(const MakeRoom& make_room) {
    const auto [n, attached] = length_or_attached(sizeof(Each));
    Each* const to = make_room(n);
    if (attached)
      place(to, n * sizeof(Each));
    else
      bytes(to, n * sizeof(Each));
  }
  static constexpr std::uint64_t attached_bit = std::uint64_t{1} << 63U;

 private:
  template <class T>
  void get(T& value);
  template <class T>
  void get_items(T& container);
  /// The length of data that may be attached, in items of `bytes_each` bytes, and whether it is
  /// attached.
  [[nodiscard]] std::pair<std::size_t, bool> length_or_attached(std::size_t bytes_each) {
    const auto n = take<std::uint64_t>();
    if ((n & attached_bit) == 0) return {checked_length(n, bytes_each), false};
    // Checked before memory of that size is requested.
    const std::uint64_t length = n & ~attached_bit;
    if (places_ == nullptr || places_->taken.size() == places_->sizes.size() ||
        places_->sizes[places_->taken.size()] / bytes_each != length)
      refuse_part(length, " elements here");
    return {length, true};
  }
  void need(std::size_t n) const {
    if (n > remaining()) refuse_bytes(n);
  }
  std::size_t length(std::size_t least_bytes_each) {
    return checked_length(take<std::uint64_t>(), least_bytes_each);
  }
  /// The length of a container whose items each take a byte or more, unless one that is written
  /// takes none.
  template <class Each>
  std::size_t n_items() {
    const auto n = take<std::uint64_t>();
    if (n > remaining()) [[unlikely]] {
      if constexpr (serialization::always_takes_bytes<std::remove_const_t<Each>>())
        refuse_length(n);
      else if (written_bytes(std::remove_const_t<Each>{}) != 0)
        refuse_length(n);
    }
    return n;
  }
  std::size_t checked_length(std::uint64_t n, std::size_t least_bytes_each) const {
    if (least_bytes_each != 0 && n > remaining() / least_bytes_each) refuse_length(n);
    return n;
  }

  // These throw Error.
  [[noreturn]] void refuse_bytes(std::size_t n) const;
  [[noreturn]] void refuse_length(std::uint64_t n) const;
  [[noreturn]] static void refuse_part(std::uint64_t n, const char* unit);
  [[noreturn]] static void refuse_alternative(std::uint64_t which, std::size_t n);

  std::span<const std::byte> in_;
  std::size_t at_ = 0;
  detail::Places* places_;
};

template <class Each>
void Writer::numbers(std::span<const Each> values, std::shared_ptr<const void> keeper) {
  const bool attach = keeper != nullptr && attached_ != nullptr && fits(values.size_bytes());
  put_numbers(values, attach);
  if (attach) attached_->keepers.push_back(std::move(keeper));
}

template <class Each>
void Writer::put_numbers(std::span<const Each> values, bool attach) {
  const auto memory = std::as_bytes(values);
  put(std::uint64_t{attach ? values.size() | Reader::attached_bit : values.size()});
  if (attach)
    add_part(memory);
  else
    bytes(memory.data(), memory.size());
}

template <class T>
void Writer::put(const T& value) {
  using namespace serialization;
  static_assert(!std::is_pointer_v<T> && !std::is_reference_v<T>,
                "a pointer means nothing in another process: send the value, an index or a proxy");
  static_assert(!SharedPointer<T> || HasFreeSerialize<T>,
                "a shared_ptr is not shared between processes: hold a unique_ptr, or for numbers "
                "with many readers a tess::SharedArray");
  if constexpr (Bitwise<T>) {
    bytes(&value, sizeof value);
  } else if constexpr (HasSerialize<T>) {
    static_assert(serialises_all<T>(),
                  "serialize() is inherited from a base class and may leave out members of this "
                  "class: define it here, and call that of the base class in it");
    if constexpr (GivesMembers<T>) {
      const_cast<T&>(value).serialize(*this);
    } else {
      const CopiesAll scope(*this);
      const_cast<T&>(value).serialize(*this);
    }
  } else if constexpr (HasFreeSerialize<T>) {
    const CopiesAll scope(*this);
    serialize(*this, const_cast<T&>(value));
  } else if constexpr (std::is_same_v<T, std::vector<bool>>) {
    put(static_cast<std::uint64_t>(value.size()));
    for (const bool bit : value) put(static_cast<std::uint8_t>(bit));
  } else if constexpr (IsOptional<T>::value || IsUnique<T>::value) {
    put(static_cast<std::uint8_t>(value ? 1 : 0));
    if (!value) return;
    if constexpr (IsUnique<T>::value && std::is_polymorphic_v<std::decay_t<decltype(*value)>>)
      check_whole(typeid(*value), typeid(typename T::element_type));
    put(*value);
  } else if constexpr (IsVariant<T>::value) {
    put(static_cast<std::uint64_t>(value.index()));
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      using std::get;
      ((value.index() == I ? put(get<I>(value)) : void()), ...);
    }(std::make_index_sequence<IsVariant<T>::n_alternatives>());
  } else if constexpr (Resizable<T> || Growable<T>) {
    put_items(value);
  } else if constexpr (IsArray<T>::value || std::is_array_v<T>) {
    for (const auto& item : value) put(item);
  } else if constexpr (TupleLike<T>) {
    std::apply([this](const auto&... item) { (*this)(item...); }, value);
  } else if constexpr (std::is_empty_v<T>) {
    // Nothing to write.
  } else {
    static_assert(std::is_aggregate_v<T>,
                  "a type that is no aggregate and no known container needs `template <class Ar> "
                  "void serialize(Ar& ar)`");
    std::apply([this](const auto&... field) { (*this)(field...); }, detail::fields_of(value));
  }
}

template <class T>
[[gnu::noinline]] void Writer::put_items(const T& container) {
  using namespace serialization;
  using Each = typename T::value_type;
  static_assert(!holds_more<T>(),
                "an aggregate that is also a container has members of its own: it needs "
                "`template <class Ar> void serialize(Ar& ar)`");
  if constexpr (Resizable<T> && Bitwise<Each>) {
    put_numbers(std::span(container.data(), container.size()),
                StaysInPlace<T> && may_attach_ && fits(container.size() * sizeof(Each)));
  } else if constexpr (Resizable<T>) {
    put(std::uint64_t{container.size()});
    for (const auto& item : container) put(item);
  } else {
    // The reader moves each element into the container, so nothing may be placed by address.
    const CopiesAll scope(*this);
    put(std::uint64_t{container.size()});
    for (const auto& item : container) put(item);
  }
}

template <class T>
void Reader::get(T& value) {
  using namespace serialization;
  if constexpr (Bitwise<T>) {
    bytes(&value, sizeof value);
  } else if constexpr (HasSerialize<T>) {
    value.serialize(*this);
  } else if constexpr (HasFreeSerialize<T>) {
    serialize(*this, value);
  } else if constexpr (std::is_same_v<T, std::vector<bool>>) {
    value.resize(length(1));
    for (auto&& bit : value) bit = take<std::uint8_t>() != 0;
  } else if constexpr (IsOptional<T>::value) {
    value.reset();
    if (take<std::uint8_t>() != 0) get(value.emplace());
  } else if constexpr (IsUnique<T>::value) {
    value.reset();
    if (take<std::uint8_t>() != 0) {
      static_assert(!std::is_abstract_v<typename T::element_type>,
                    "a unique_ptr to an abstract class cannot be read: hold a std::variant of the "
                    "classes that derive from it");
      value = std::make_unique<typename T::element_type>();
      get(*value);
    }
  } else if constexpr (IsVariant<T>::value) {
    const auto which = take<std::uint64_t>();
    constexpr std::size_t n_alternatives = IsVariant<T>::n_alternatives;
    if (which >= n_alternatives) refuse_alternative(which, n_alternatives);
    [&]<std::size_t... I>(std::index_sequence<I...>) {
      ((which == I ? get(value.template emplace<I>()) : void()), ...);
    }(std::make_index_sequence<n_alternatives>());
  } else if constexpr (Resizable<T> || Growable<T>) {
    get_items(value);
  } else if constexpr (IsArray<T>::value || std::is_array_v<T>) {
    for (auto& item : value) get(item);
  } else if constexpr (TupleLike<T>) {
    std::apply([this](auto&... item) { (*this)(item...); }, value);
  } else if constexpr (std::is_empty_v<T>) {
    // Nothing to read.
  } else if constexpr (!std::is_pointer_v<T>) {  // pointers are refused where they are written
    static_assert(std::is_aggregate_v<T>,
                  "a type that is no aggregate and no known container needs `template <class Ar> "
                  "void serialize(Ar& ar)`");
    std::apply([this](auto&... field) { (*this)(field...); }, detail::fields_of(value));
  }
}

template <class T>
[[gnu::noinline]] void Reader::get_items(T& container) {
  using namespace serialization;
  using Each = typename T::value_type;
  if constexpr (Resizable<T> && Bitwise<Each> && StaysInPlace<T>) {
    numbers<Each>([&container](std::size_t n) {
      if constexpr (IsVector<T>::value)
        resize_uninitialised(container, n);
      else
        container.resize(n);
      return container.data();
    });
  } else if constexpr (Resizable<T> && Bitwise<Each>) {
    container.resize(length(sizeof(Each)));
    bytes(container.data(), container.size() * sizeof(Each));
  } else if constexpr (Resizable<T>) {
    const std::size_t n = n_items<Each>();
    if constexpr (IsVector<T>::value)
      T(n).swap(container);  // less code than resize(), which may move elements
    else
      container.resize(n);
    for (auto& item : container) get(item);
  } else {
    container.clear();
    for (std::size_t n = n_items<Each>(); n > 0; --n) {
      if constexpr (requires { typename T::mapped_type; }) {
        auto key = take<typename T::key_type>();
        auto mapped = take<typename T::mapped_type>();
        container.insert(container.end(), Each(std::move(key), std::move(mapped)));
      } else {
        container.insert(container.end(), take<Each>());
      }
    }
  }
}

/// The bytes of one value.
template <class T>
[[nodiscard]] std::vector<std::byte> to_bytes(const T& value) {
  std::vector<std::byte> out;
  resize_uninitialised(out, written_bytes(value));
  Writer write{std::span<std::byte>(out)};
  write(value);
  return out;
}

/// The value that these bytes hold. Throws tess::Error if they end early or if bytes are left over.
template <class T>
[[nodiscard]] T from_bytes(std::span<const std::byte> bytes) {
  Reader read(bytes);
  T value = read.take<T>();
  if (read.remaining() != 0)
    fail(ErrorCode::bad_value, "message has ", read.remaining(), " bytes more than its type reads");
  return value;
}

}  // namespace tess
