// A vector's new elements without their zeros, for numbers that are overwritten at once: by a copy
// from a message, or by MPI. With a megabyte the zeros cost as much as the copy.
#pragma once

#include <cstddef>
#include <type_traits>
#include <vector>

namespace tess {

#if defined(__GLIBCXX__) && !defined(_GLIBCXX_SANITIZE_VECTOR)
namespace detail {
/// libstdc++ keeps first, last and end of a vector in _M_impl, which a derived class may reach.
template <class T>
struct VectorEnd : std::vector<T> {
  static void set(std::vector<T>& vector, std::size_t n) {
    auto& impl = vector.*(&VectorEnd::_M_impl);
    impl._M_finish = impl._M_start + n;
  }
};
}  // namespace detail

/// Makes `vector` have `n` elements of any value; what it held is lost.
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
