// Resizes a vector without filling it with zeros, for numbers that are overwritten at once by a
// copy from a message or by MPI. For a megabyte, writing the zeros costs as much as the copy.
#pragma once

#include <cstddef>
#include <type_traits>
#include <vector>

namespace tess {

#if defined(__GLIBCXX__) && !defined(_GLIBCXX_SANITIZE_VECTOR)
namespace detail {
/// libstdc++ keeps the begin, the end and the end of the storage in _M_impl, which a derived class
/// can access.
template <class T>
struct VectorEnd : std::vector<T> {
  static void set(std::vector<T>& vector, std::size_t n) {
    auto& impl = vector.*(&VectorEnd::_M_impl);
    impl._M_finish = impl._M_start + n;
  }
};
}  // namespace detail

/// Gives `vector` `n` elements of unspecified value; its former contents are lost.
template <class T>
void resize_uninitialised(std::vector<T>& vector, std::size_t n) {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
  vector.clear();
  vector.reserve(n);
  detail::VectorEnd<T>::set(vector, n);
}
#else
template <class T>
void resize_uninitialised(std::vector<T>& vector, std::size_t n) {
  vector.resize(n);
}
#endif

}  // namespace tess
