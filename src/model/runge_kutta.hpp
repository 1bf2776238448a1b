// Steps along a system of differential equations.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace tethercalc::runge_kutta {

inline constexpr std::size_t stages = 12;
/// Order 8 (Fehlberg 1968, NASA TR R-287) without the stage that his estimate of the error alone
/// uses: it is zero for an integral, and places are integrals of the direction.
inline constexpr std::array<std::array<double, stages - 1>, stages> stage_weights{{
    {},
    {2. / 27},
    {1. / 36, 1. / 12},
    {1. / 24, 0, 1. / 8},
    {5. / 12, 0, -25. / 16, 25. / 16},
    {1. / 20, 0, 0, 1. / 4, 1. / 5},
    {-25. / 108, 0, 0, 125. / 108, -65. / 27, 125. / 54},
    {31. / 300, 0, 0, 0, 61. / 225, -2. / 9, 13. / 900},
    {2, 0, 0, -53. / 6, 704. / 45, -107. / 9, 67. / 90, 3},
    {-91. / 108, 0, 0, 23. / 108, -976. / 135, 311. / 54, -19. / 60, 17. / 6, -1. / 12},
    {3. / 205, 0, 0, 0, 0, -6. / 41, -3. / 205, -3. / 41, 3. / 41, 6. / 41},
    {-1777. / 4100, 0, 0, -341. / 164, 4496. / 1025, -289. / 82, 2193. / 4100, 51. / 82, 33. / 164,
     12. / 41, 1},
}};
inline constexpr std::size_t first_weighed = 5;
inline constexpr std::array<double, stages> step_weights{
    0, 0, 0, 0, 0, 34. / 105, 9. / 35, 9. / 35, 9. / 280, 9. / 280, 41. / 840, 41. / 840};

inline constexpr int most_steps = 4000;

/// One step of `h` of a state, an Eigen array. `change` writes how a state changes.
template <class StateType, class System>
void take_step(const System& change, StateType& state, double h) {
  constexpr Eigen::Index rows = StateType::RowsAtCompileTime;
  constexpr Eigen::Index columns = StateType::ColsAtCompileTime;
  std::array<StateType, stages> changes;
  // Number by number: a pair of numbers that was just written one by one is slow to load at once.
  const auto take_stage = [&]<std::size_t stage, std::size_t... before>(
      std::integral_constant<std::size_t, stage>, std::index_sequence<before...>) {
    StateType at = state;
    for (Eigen::Index column = 0; column < columns; ++column) {
      for (Eigen::Index row = 0; row < rows; ++row) {
        double sum = 0;
        [[maybe_unused]] const auto add =
            [&]<std::size_t j>(std::integral_constant<std::size_t, j>) {
              constexpr double weight = stage_weights[stage][j];
              if constexpr (weight != 0) sum += weight * changes[j](row, column);
            };
        (add(std::integral_constant<std::size_t, before>()), ...);
        at(row, column) += h * sum;
      }
    }
    change(at, changes[stage]);
  };
  [&]<std::size_t... stage>(std::index_sequence<stage...>) {
    (take_stage(std::integral_constant<std::size_t, stage>(), std::make_index_sequence<stage>()),
     ...);
  }
  (std::make_index_sequence<stages>());
  for (Eigen::Index column = 0; column < columns; ++column) {
    for (Eigen::Index row = 0; row < rows; ++row) {
      double sum = 0;
      for (std::size_t j = first_weighed; j < stages; ++j) {
        sum += step_weights[j] * changes[j](row, column);
      }
      state(row, column) += h * sum;
    }
  }
}

/// In steps of order 8 from 0 to `end`, each as long as `longest_step` says of the state.
template <class StateType, class System, class LongestStep>
bool integrate(const System& change, StateType& state, double end,
               const LongestStep& longest_step) {
  double at = 0;
  for (int i = 0; i < most_steps; ++i) {
    const double rest = end - at;
    const double step = longest_step(state);
    if (!std::isfinite(step)) return false;
    // Two halves rather than a whole and a scrap.
    const double taken = step >= rest ? rest : 2 * step > rest ? 0.5 * rest : step;
    take_step(change, state, taken);
    if (taken == rest) return state.allFinite();
    at += taken;
  }
  return false;
}

}  // namespace tethercalc::runge_kutta
