#include "runtime/core/ids.hpp"

#include <ostream>

namespace tess {

std::ostream& operator<<(std::ostream& out, PeId pe) {
  return out << "PE " << pe.value;
}
std::ostream& operator<<(std::ostream& out, ProcessId p) {
  return out << "process " << p.value;
}
std::ostream& operator<<(std::ostream& out, CollectionId id) {
  return out << "collection " << id.value;
}
std::ostream& operator<<(std::ostream& out, EpochId id) {
  return out << "epoch " << id.value;
}

}  // namespace tess
