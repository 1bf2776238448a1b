// A picture of a result.
#include <pybind11/pybind11.h>

#include "bindings/binding.hpp"
#include "tethercalc/files/gnuplot.hpp"

namespace tethercalc::python {
namespace {

/// The content of a file of that format.
std::string drawn(const Figure& figure, FigureFormat format, double width_mm) {
  if (!(width_mm >= 85 && width_mm <= 400)) {
    throw py::value_error("width_mm is 85 to 400");
  }
  return render(figure, format, run_gnuplot, {.width_mm = width_mm});
}

py::str svg_of(const Figure& figure) { return drawn(figure, FigureFormat::svg, 170); }

}  // namespace

void bind_figures(py::module_& module) {
  py::class_<Figure>(module, "Figure", "A picture of a result, drawn when it is asked for.")
      .def_readonly("title", &Figure::title, "One line.")
      .def_readonly("description", &Figure::description,
                    "What it shows with its main numbers, for those who cannot see it.")
      .def_property_readonly("svg", svg_of, "The picture as SVG, 170 mm wide.")
      .def(
          "render",
          [](const Figure& figure, const std::string& suffix, double width_mm) {
            return py::bytes(drawn(figure, figure_format(suffix, "suffix"), width_mm));
          },
          py::arg("suffix"), py::arg("width_mm") = 170.0,
          "The content of a file of that suffix: .svg, .png, .pdf (both by the program gnuplot), "
          ".gp or .txt.")
      .def("_repr_svg_", svg_of, "For notebooks.")
      .def("__repr__", [](const Figure& figure) {
        return "<tethercalc.Figure " + py::repr(py::str(figure.title)).cast<std::string>() + ">";
      });
}

}  // namespace tethercalc::python
