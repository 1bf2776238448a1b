// What every study's answer offers: attributes, dictionary, text, CSV and pictures, as the command
// prints them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings/binding.hpp"

namespace tethercalc::python {

/// A picture that an answer has, and how it is made.
struct AnswerFigure {
  std::string name;
  std::function<Figure()> draw;
};

/// An answer and how it is told; each way is taken when it is asked for. The functions own what
/// they tell.
struct Answer {
  std::function<std::string()> text;
  std::function<nlohmann::ordered_json()> json;
  std::function<std::string()> csv;
  std::vector<AnswerFigure> figures{};
  mutable py::object kept{};  ///< see `dictionary`

  /// The JSON answer, kept as Python's own values once it was made.
  [[nodiscard]] py::object dictionary() const;

  /// The figure of that name, or the first. Throws KeyError with the names that there are.
  [[nodiscard]] Figure figure(const std::optional<std::string>& name) const;
};

[[nodiscard]] inline const Answer& answer_of(const Answer& answer) { return answer; }

template <class Object>
[[nodiscard]] decltype(auto) answer_of(const Object& object) {
  return object.answer();
}

/// Gives an answer, or a class that has `answer()`, the methods of one.
template <class Class>
void add_answer_methods(Class& bound) {
  using Object = typename Class::type;
  bound
      .def(
          "to_dict",
          [](const Object& object) {
            return py::module_::import("copy").attr("deepcopy")(answer_of(object).dictionary());
          },
          "The answer under the keys of the command's --format json.")
      .def(
          "to_csv", [](const Object& object) { return answer_of(object).csv(); },
          "The answer as the command's --format csv.")
      .def(
          "figure",
          [](const Object& object, const std::optional<std::string>& name) {
            return answer_of(object).figure(name);
          },
          py::arg("name") = py::none(), "The picture of that name, or the first of `figures`.")
      .def_property_readonly(
          "figures",
          [](const Object& object) {
            py::list names;
            for (const AnswerFigure& figure : answer_of(object).figures) names.append(figure.name);
            return names;
          },
          "Names of the pictures that there are.")
      .def("__str__", [](const Object& object) { return answer_of(object).text(); })
      .def(
          "_repr_html_",
          [](const Object& object) {
            const Answer& answer = answer_of(object);
            py::list svgs;
            for (const AnswerFigure& figure : answer.figures) {
              svgs.append(py::cast(figure.draw()).attr("svg"));
            }
            return py::module_::import("tethercalc._views").attr("html")(answer.text(), svgs);
          },
          "The text and the pictures, for notebooks.");
}

}  // namespace tethercalc::python
