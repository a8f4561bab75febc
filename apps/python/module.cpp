// The extension module _tessera, one source per subject. Python's face is tessera/*.py.
#include "runtime/core/error.hpp"

#include <pybind11/pybind11.h>

namespace tessera_python {
void add_transfer(pybind11::module_& module);
void add_mesh_files(pybind11::module_& module);
void add_collide(pybind11::module_& module);
void add_balance(pybind11::module_& module);
void add_sdf(pybind11::module_& module);
}  // namespace tessera_python

PYBIND11_MODULE(_tessera, module) {
  pybind11::register_exception<tess::Error>(module, "Error", PyExc_ValueError);
  tessera_python::add_transfer(module);
  tessera_python::add_mesh_files(module);
  tessera_python::add_collide(module);
  tessera_python::add_balance(module);
  tessera_python::add_sdf(module);
}
