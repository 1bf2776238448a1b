// The compiled half of the package: what stands where, and how errors become exceptions.
#include "bindings/binding.hpp"
#include "tethercalc/io/input_error.hpp"

namespace tethercalc::python {
namespace {

/// `tethercalc.InputError` with (where, message) of every problem.
void raise_input_error(const InputError& error) {
  py::list problems;
  for (const InputProblem& problem : error.problems()) {
    problems.append(py::make_tuple(problem.where, problem.message));
  }
  const py::object type = py::module_::import("tethercalc._errors").attr("InputError");
  const py::object exception = type.attr("_from_problems")(problems);
  PyErr_SetObject(type.ptr(), exception.ptr());
}

}  // namespace
}  // namespace tethercalc::python

PYBIND11_MODULE(_core, module) {
  using namespace tethercalc::python;
  module.doc() = "The compiled part of tethercalc; use the package itself.";
  module.attr("version") = TETHERCALC_VERSION;
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const tethercalc::InputError& error) {
      raise_input_error(error);
    }
  });
  py::module_::import("atexit").attr("register")(py::cpp_function(join_left_running));
  bind_figures(module);
  bind_designs(module);
  bind_optima(module);
  bind_sweeps(module);
  bind_cables(module);
  bind_logs(module);
}
