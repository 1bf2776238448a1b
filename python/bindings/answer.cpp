#include "bindings/answer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace tethercalc::python {

py::object Answer::dictionary() const {
  if (!kept) kept = to_python(json());
  return kept;
}

Figure Answer::figure(const std::optional<std::string>& name) const {
  const auto found =
      name ? std::ranges::find(figures, *name, &AnswerFigure::name) : figures.begin();
  if (found != figures.end()) return found->draw();
  std::vector<std::string> names;
  for (const AnswerFigure& figure : figures) names.push_back(figure.name);
  throw py::key_error(fmt::format("this answer has the figures [{}]", fmt::join(names, ", ")));
}

}  // namespace tethercalc::python
