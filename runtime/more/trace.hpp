// The program's own events in the file of --trace.
//
//     const tess::Span span("assembly");   // from here to the end of the scope: a slice of its own
//     tess::mark("converged");             // a moment
//
// Without --trace each costs a test of a pointer.
#pragma once

#include "runtime/pe/pe.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace tess {

/// Marks this moment on this PE.
inline void mark(std::string_view name) {
  Pe& pe = current_pe();
  if (detail::Trace* trace = pe.measuring().trace()) {
    const std::uint64_t now = pe.meter()->now();
    trace->event(std::string(name), now, now);
  }
}

/// A part of the running entry method, from its beginning to the end of its scope. It must not live
/// across a co_await: what runs meanwhile on the PE would lie in it.
class Span {
 public:
  explicit Span(std::string_view name) : pe_(current_pe()) {
    if (pe_.measuring().trace() == nullptr) return;
    traced_ = true;
    name_ = name;
    began_ = pe_.meter()->now();
  }
  Span(const Span&) = delete;
  Span& operator=(const Span&) = delete;
  ~Span() {
    if (traced_) pe_.measuring().trace()->event(std::move(name_), began_, pe_.meter()->now());
  }

 private:
  Pe& pe_;
  std::string name_;
  bool traced_ = false;
  std::uint64_t began_ = 0;
};

}  // namespace tess
