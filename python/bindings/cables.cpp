// A whole design, the reach of a given cable, how it hangs, and what published rules ask.
#include <pybind11/stl.h>

#include <memory>

#include "bindings/answer.hpp"
#include "bindings/design_object.hpp"
#include "io/design_options.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/io/rule_books.hpp"
#include "tethercalc/report/cable_report.hpp"
#include "tethercalc/report/design_report.hpp"
#include "tethercalc/report/explanation.hpp"
#include "tethercalc/report/result_figures.hpp"
#include "tethercalc/report/rules_report.hpp"
#include "tethercalc/study/optimum.hpp"

namespace tethercalc::python {
namespace {

using Texts = std::vector<std::string>;

/// An answer whose attributes are the keys of its JSON.
Answer evaluation(const py::object& spec, const Texts& areas_mm2) {
  const auto file = design_of(spec)->file();
  const auto areas = chosen_areas(parsed_areas(areas_mm2), file->design);
  const EvaluationStudy study =
      interruptible([=](const StopFlag&) { return study_evaluation(file->design, areas); });
  return {[=] { return evaluate_text(*file, study, {}); },
          [=] { return evaluate_json(*file, study); },
          [=] { return evaluate_csv(file->design, study.table); }};
}

Answer comparison(const py::object& spec, const Texts& motors) {
  const auto file = design_of(spec)->file();
  const auto chosen = chosen_motors(motors, *file, files_in(""));
  const auto ranking =
      interruptible([=](const StopFlag&) { return compare_motors(file->design, chosen); });
  return {[=] { return compare_text(*file, ranking, {}); },
          [=] { return compare_json(*file, ranking); },
          [=] { return compare_csv(ranking); },
          {{"motors", [=] { return motors_figure(*file, ranking); }}}};
}

Answer whole_design(const py::object& spec, Texts free, const std::string& minimize,
                    Texts subject_to, const std::string& standard, Texts pareto,
                    std::uint64_t seed) {
  const auto file = design_of(spec)->file();
  const DesignRequest request{std::move(free), minimize,          std::move(subject_to),
                              standard,        std::move(pareto), seed};
  const DesignQuestion question = read_design_request(*file, request);
  const auto study = std::make_shared<const DesignStudy>(
      interruptible([=](const StopFlag&) { return study_design(question); }));
  return {[=] { return design_text(*file, request, *study, {}); },
          [=] { return design_json(*file, request, *study); },
          [=] { return design_csv(request, *study); }};
}

Answer envelope(const py::object& spec, const Texts& area_mm2) {
  const auto file = std::make_shared<DesignFile>(*design_of(spec)->file());
  file->design.tether.cross_section = one_area(area_mm2, file->design, "an envelope");
  const auto study = std::make_shared<const EnvelopeStudy>(
      interruptible([=](const StopFlag&) { return study_envelope(file->design); }));
  return {[=] { return envelope_text(*file, *study, {}); },
          [=] { return envelope_json(*file, *study); }, [=] { return envelope_csv(*study); }};
}

Answer shape(const py::object& spec, const CableOptions& options) {
  const auto asked =
      std::make_shared<const AskedShapes>(asked_shapes(options, *design_of(spec)->file()));
  if (asked->requests.size() != 1) throw py::value_error("a shape is that of one wind and slack");
  const auto study = std::make_shared<const ShapeStudy>(interruptible([=](const StopFlag&) {
    return study_cable_shape(asked->file.design, asked->area, asked->requests.front());
  }));
  Answer answer{[=] {
                  return cable_shape_text(asked->file, asked->area, asked->requests.front(), *study,
                                          {});
                },
                [=] { return cable_shape_json(asked->file, asked->area, *study); },
                [=] { return cable_shape_csv(*study); }};
  if (study->outcome == CableOutcome::hangs) {
    answer.figures.push_back(
        {"shape",
         [=] { return shape_figure(asked->file.name, asked->requests, std::vector{*study}); }});
  }
  return answer;
}

Answer shape_of(const py::object& spec, Texts area_mm2, std::optional<double> height_m,
                std::optional<double> offset_m, Texts wind_m_s, double wind_from_deg,
                Texts slack_percent, std::optional<double> length_m,
                std::optional<double> winch_tension_N, std::optional<double> stiffness_N,
                std::optional<double> station_height_m, std::optional<std::string> profile,
                std::optional<double> reference_height_m, std::optional<double> exponent,
                std::optional<double> roughness_m) {
  CableOptions options;
  options.areas_mm2 = std::move(area_mm2);
  options.height = height_m;
  options.offset = offset_m;
  options.winds = std::move(wind_m_s);
  options.wind_from = wind_from_deg;
  options.slacks_percent = std::move(slack_percent);
  options.length = length_m;
  options.winch_tension = winch_tension_N;
  options.axial_stiffness = stiffness_N;
  options.station_height = station_height_m;
  options.profile = std::move(profile);
  options.reference_height = reference_height_m;
  options.exponent = exponent;
  options.roughness_length = roughness_m;
  return shape(spec, options);
}

Answer ruled(const py::object& spec, const std::string& book) {
  const auto file = design_of(spec)->file();
  const RuleBook asked = rule_book(book, "book");
  const auto study = std::make_shared<const RuleStudy>(interruptible([=](const StopFlag&) {
    return study_rules({file->design, ruled_area(optimum_of(file->design))}, asked);
  }));
  return {[=] { return rules_text(file->name, *study, {}); },
          [=] { return rules_json(file->name, *study); }, [=] { return rules_csv(*study); }};
}

std::string explain(const std::optional<std::string>& code) {
  return code ? explanation_text(explanation_of(*code), {}) : explanation_list_text({});
}

}  // namespace

void bind_cables(py::module_& module) {
  py::class_<Answer> bound(
      module, "Answer",
      "What a study answered. Its attributes are the keys of the command's --format json.");
  add_answer_methods(bound);
  bound.def("__getattr__", [](const Answer& answer, const std::string& name) {
    return py::module_::import("tethercalc._views").attr("member")(answer.dictionary(), name);
  });
  bound.def("__repr__", [](const Answer& answer) {
    const py::list keys(answer.dictionary());
    return "<tethercalc.Answer with " + py::str(", ").attr("join")(keys).cast<std::string>() + ">";
  });
  bound.def("__dir__", [](const py::object& self) {
    const py::object names = py::module_::import("builtins").attr("object").attr("__dir__")(self);
    return names + py::list(self.cast<const Answer&>().dictionary());
  });

  module.def("_evaluate", evaluation, py::arg("spec"), py::arg("areas_mm2"));
  module.def("_compare", comparison, py::arg("spec"), py::arg("motors"));
  module.def("_design", whole_design, py::arg("spec"), py::arg("free"), py::arg("minimize"),
             py::arg("subject_to"), py::arg("standard"), py::arg("pareto"), py::arg("seed"));
  module.def("_rules", ruled, py::arg("spec"), py::arg("book"));
  module.def(
      "explain", explain, py::arg("code") = py::none(),
      "The page of a code of an answer, such as \"available_power\" or \"propwash\": what it "
      "means, why it comes about and what to do, with formula and source. Without a code, all "
      "there are.");
  module.def("_envelope", envelope, py::arg("spec"), py::arg("area_mm2"));
  module.def("_shape", shape_of, py::arg("spec"), py::arg("area_mm2"), py::arg("height_m"),
             py::arg("offset_m"), py::arg("wind_m_s"), py::arg("wind_from_deg"),
             py::arg("slack_percent"), py::arg("length_m"), py::arg("winch_tension_N"),
             py::arg("stiffness_N"), py::arg("station_height_m"), py::arg("profile"),
             py::arg("reference_height_m"), py::arg("exponent"), py::arg("roughness_m"));
}

}  // namespace tethercalc::python
