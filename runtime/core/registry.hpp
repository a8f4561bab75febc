// The names of entry methods, system actions and reduction types. Each is one static object that
// registers itself before main(). At start-up the names are sorted and numbered, so a number means
// the same in every process. Processes compare a hash of all names, so that different binaries are
// found before the first message.
#pragma once

#include "runtime/core/type_name.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace tess::detail {

/// An object with a name and, once the registry is sealed, a number. It must have static storage.
class Registered {
 public:
  explicit Registered(naming::Name name) : Registered(name.text, name.tag) {}
  Registered(const Registered&) = delete;
  Registered& operator=(const Registered&) = delete;

  [[nodiscard]] std::string_view name() const { return name_.text; }
  [[nodiscard]] std::uint32_t id() const { return id_; }

 protected:
  ~Registered() = default;

 private:
  friend class Registry;
  /// The members of the name, which are passed in registers.
  Registered(std::string_view text, const std::type_info* tag);
  naming::Name name_;
  std::uint32_t id_ = 0;
};

class Registry {
 public:
  /// Numbers everything that is registered, in the order of names. Idempotent; called before the
  /// first PE starts.
  static void seal();
  /// Equal in two processes if and only if both have registered the same names (a 64-bit hash).
  [[nodiscard]] static std::uint64_t fingerprint();
  /// The object of that number. Throws tess::Error for an unknown number.
  [[nodiscard]] static const Registered& at(std::uint32_t id);

 private:
  friend class Registered;
  static std::vector<Registered*>& all();
};

}  // namespace tess::detail
