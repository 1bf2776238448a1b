// One cross-section: the optimum, and what given cables do.
#include <pybind11/stl.h>

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "bindings/answer.hpp"
#include "bindings/design_object.hpp"
#include "tethercalc/model/units.hpp"
#include "tethercalc/report/design_report.hpp"
#include "tethercalc/report/result_figures.hpp"
#include "tethercalc/study/results.hpp"

namespace tethercalc::python {
namespace {

std::optional<double> existing(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// The optimum alone at once, all that is told beside it when somebody asks.
class Optimum {
 public:
  explicit Optimum(const std::shared_ptr<DesignObject>& object)
      : object_(*object), found_(found(object->design())) {}

  [[nodiscard]] const Optimization& result() const { return found_; }
  [[nodiscard]] std::optional<double> area_mm2() const {
    return found_.feasible ? existing(found_.area / unit::square_millimetre) : std::nullopt;
  }
  [[nodiscard]] std::optional<OperatingPoint> point(Condition condition) const {
    return found_.feasible ? std::optional(found_.in(condition)) : std::nullopt;
  }

  [[nodiscard]] const Answer& answer() const {
    if (!answer_) {
      const auto file = object_.file();
      const auto study = std::make_shared<const OptimumStudy>([&] {
        const py::gil_scoped_release released;
        return study_optimum(file->design, wire_sizes());
      }());
      answer_ = std::make_shared<const Answer>(Answer{
          [=] { return optimize_text(*file, *study, {}); },
          [=] { return optimize_json(*file, *study); },
          [=] { return optimize_csv(*study); },
          {{"optimum", [=] { return optimum_figure(file->name, *study, area_curve(*study)); }}}});
    }
    return *answer_;
  }

 private:
  static Optimization found(const Design& design) {
    const py::gil_scoped_release released;
    return optimize(design);
  }

  DesignObject object_;  // as it was, whatever the caller does to its own
  Optimization found_;
  mutable std::shared_ptr<const Answer> answer_;
};

void bind_operating_point(py::module_& module) {
  py::class_<OperatingPoint> point(
      module, "OperatingPoint",
      "What a design does in steady hover or forward flight, thrusts per motor. None stands for "
      "what does not exist.");
  for (const OperatingPointField& field : operating_point_fields()) {
    point.def_property_readonly(std::string(field.key).c_str(), [&field](const OperatingPoint& at) {
      return existing(practical_value(at, field));
    });
  }
  point.def(
      "to_dict",
      [](const OperatingPoint& at) {
        py::dict out;
        for (const OperatingPointField& field : operating_point_fields()) {
          out[py::str(std::string(field.key))] = existing(practical_value(at, field));
        }
        return out;
      },
      "All of it by name.");
}

}  // namespace

void bind_optima(py::module_& module) {
  bind_operating_point(module);
  py::class_<Optimum> optimum(module, "Optimum",
                              "The conductor cross-section to fly, or why there is none.");
  optimum
      .def_property_readonly(
          "feasible", [](const Optimum& o) { return o.result().feasible; },
          "Whether any cross-section meets all demands.")
      .def_property_readonly(
          "status", [](const Optimum& o) { return std::string(status_name(o.result().feasible)); },
          "\"optimal\" or \"infeasible\".")
      .def_property_readonly("cross_section_mm2", &Optimum::area_mm2,
                             "The optimum; None where there is none.")
      .def_property_readonly(
          "limited_by",
          [](const Optimum& o) { return std::string(limit_name(o.result().limited_by)); },
          "What binds at the optimum, or where there is none: \"minimum_power\", "
          "\"available_power\" and so on.")
      .def_property_readonly(
          "limiting_condition",
          [](const Optimum& o) {
            return std::string(condition_name(o.result().limiting_condition));
          },
          "\"hover\" or \"forward\": where it binds.")
      .def_property_readonly(
          "hover", [](const Optimum& o) { return o.point(Condition::hover); },
          "The optimum in hover; None where there is none.")
      .def_property_readonly(
          "forward", [](const Optimum& o) { return o.point(Condition::forward); },
          "The optimum in forward flight; None where there is none.")
      .def("__repr__", [](const Optimum& o) {
        const auto area = o.area_mm2();
        return area ? fmt::format("<tethercalc.Optimum {:.4f} mm2>", *area)
                    : std::string("<tethercalc.Optimum infeasible>");
      });
  add_answer_methods(optimum);
  module.def(
      "optimize", [](const py::object& spec) { return Optimum(design_of(spec)); }, py::arg("spec"),
      "The optimal cross-section of a design, a dictionary or a file. Raises InputError for a bad "
      "spec.");
}

}  // namespace tethercalc::python
