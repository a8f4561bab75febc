// The parts of the extension module _tessera, one per subject. Python's face is tessera/*.py.
#pragma once

#include <pybind11/pybind11.h>

namespace tessera_python {

void add_transfer(pybind11::module_& module);
void add_mesh_files(pybind11::module_& module);
void add_collide(pybind11::module_& module);
void add_balance(pybind11::module_& module);
void add_sdf(pybind11::module_& module);

}  // namespace tessera_python
