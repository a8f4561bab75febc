#include "apps/python/module.hpp"

#include "apps/kit/output/canvas.hpp"
#include "runtime/core/error.hpp"

#include <pybind11/stl.h>

namespace tessera_python {

namespace py = pybind11;

/// For pictures (tessera/plot.py).
void add_canvas(py::module_& module) {
  using kit::Canvas;
  const auto look = [](const std::string& fill, const std::string& stroke, double width) {
    return kit::Look{.fill = fill.empty() ? "none" : fill, .stroke = stroke, .width = width};
  };
  const auto anchor = [](const std::string& name) {
    return name == "middle" ? kit::Anchor::middle
           : name == "end"  ? kit::Anchor::end
                            : kit::Anchor::start;
  };
  py::class_<Canvas>(module, "Canvas")
      .def(py::init([](double width, double height) {
        return Canvas({.width = width, .height = height, .font = 12});
      }))
      .def("text",
           [anchor](Canvas& canvas, double x, double y, const std::string& words,
                    const std::string& at, double font) {
             canvas.text({x, y}, words, anchor(at), font);
           })
      .def("rect",
           [look](Canvas& canvas, double x, double y, double width, double height,
                  const std::string& fill, const std::string& stroke) {
             canvas.rect({x, y}, width, height, look(fill, stroke, 1));
           })
      .def("line",
           [look](Canvas& canvas, const std::vector<std::pair<double, double>>& points,
                  const std::string& stroke, double width) {
             kit::Path path;
             for (const auto& [x, y] : points) path.empty() ? path.move({x, y}) : path.line({x, y});
             canvas.path(path, look("", stroke, width));
           })
      .def("svg", &Canvas::svg);
}

}  // namespace tessera_python

PYBIND11_MODULE(_tessera, module) {
  module.doc() = "The compiled part of tessera; import tessera instead.";
  pybind11::register_exception<tess::Error>(module, "Error", PyExc_ValueError);
  tessera_python::add_transfer(module);
  tessera_python::add_mesh_files(module);
  tessera_python::add_collide(module);
  tessera_python::add_balance(module);
  tessera_python::add_sdf(module);
  tessera_python::add_canvas(module);
}
