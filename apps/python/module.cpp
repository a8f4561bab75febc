#include "apps/python/module.hpp"

#include "runtime/core/error.hpp"

PYBIND11_MODULE(_tessera, module) {
  module.doc() = "The compiled part of tessera; import tessera instead.";
  pybind11::register_exception<tess::Error>(module, "Error", PyExc_ValueError);
  tessera_python::add_transfer(module);
  tessera_python::add_mesh_files(module);
  tessera_python::add_collide(module);
  tessera_python::add_balance(module);
  tessera_python::add_sdf(module);
}
