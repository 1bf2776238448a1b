// What is wrong with a file the user gave.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace tethercalc {

/// One thing wrong with an input: where, what was found, what is allowed.
struct InputProblem {
  std::string where;    ///< "file:line", "file:line /json/pointer", or an option's name
  std::string message;  ///< a sentence with the value, what is allowed, and the closest known name
};

/// Thrown by every reader; carries all problems of the input at once. `what()` joins them by line.
class InputError : public std::runtime_error {
 public:
  /// `problems` in the order of the input; at least one.
  explicit InputError(std::vector<InputProblem> problems);
  /// A single problem.
  InputError(std::string where, std::string message)
      : InputError(std::vector{InputProblem{std::move(where), std::move(message)}}) {}
  /// What was given to the constructor.
  [[nodiscard]] const std::vector<InputProblem>& problems() const { return problems_; }

 private:
  std::vector<InputProblem> problems_;
};

}  // namespace tethercalc
