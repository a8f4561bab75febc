// Names of what travels: entry methods, system actions, reduction types. Each is one static object
// that enters itself here before main(); at start-up the names are sorted and numbered, so that a
// number means the same in every process. A hash of all names is compared across processes:
// binaries that differ are found before the first message.
#pragma once

#include "runtime/core/type_name.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace tess {

/// A thing with a name and, once the registry is sealed, a number. Static storage only.
class Registered {
 public:
  explicit Registered(std::string_view name);
  Registered(const Registered&) = delete;
  Registered& operator=(const Registered&) = delete;

  [[nodiscard]] std::string_view name() const { return name_; }
  [[nodiscard]] std::uint32_t id() const { return id_; }

 protected:
  ~Registered() = default;

 private:
  friend class Registry;
  std::string_view name_;
  std::uint32_t id_ = 0;
};

class Registry {
 public:
  /// Numbers everything that is registered, in the order of names. Idempotent; called before the
  /// first PE starts.
  static void seal();
  /// Equal in two processes exactly when they know the same names (64-bit hash).
  [[nodiscard]] static std::uint64_t fingerprint();
  /// The thing of that number; throws tess::Error for a number that is none.
  [[nodiscard]] static const Registered& at(std::uint32_t id);

 private:
  friend class Registered;
  static std::vector<Registered*>& all();
};

}  // namespace tess
