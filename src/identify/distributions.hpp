// Quantiles and tails of the distributions that errors are held against.
#pragma once

namespace tethercalc {

/// The value that Student's t with `degrees` > 0 of freedom stays below with probability `p`, in
/// (0, 1).
[[nodiscard]] double student_quantile(double degrees, double p);

/// Probability of Student's t above `t`, infinity included; 1 for NaN.
[[nodiscard]] double student_tail(double t, double degrees);

/// Probability of Fisher's F above `f` (negative: 1; infinity and NaN: 0); both degrees > 0.
[[nodiscard]] double fisher_tail(double f, double numerator, double denominator);

/// Probability of chi-squared above `x` (negative: 1) with `degrees` > 0 of freedom.
[[nodiscard]] double chi_squared_tail(double x, double degrees);

}  // namespace tethercalc
