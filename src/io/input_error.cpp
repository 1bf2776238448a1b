#include "tethercalc/io/input_error.hpp"

namespace tethercalc {
namespace {

std::string joined(const std::vector<InputProblem>& problems) {
  std::string text;
  for (const InputProblem& problem : problems) {
    if (!text.empty()) text += '\n';
    text += problem.where + ": " + problem.message;
  }
  return text;
}

}  // namespace

InputError::InputError(std::vector<InputProblem> problems)
    : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}

}  // namespace tethercalc
