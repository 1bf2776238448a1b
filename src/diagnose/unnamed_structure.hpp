// The search for structure that no effect of the catalogue explains.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "diagnose/block_fit.hpp"

namespace tethercalc {

using Series = Eigen::ArrayXd;

/// For arithmetic.
[[nodiscard]] inline Series as_series(const std::vector<double>& x) {
  return Series::Map(x.data(), static_cast<Eigen::Index>(x.size()));
}

/// A course that a log may take without any effect of the catalogue.
struct Shape {
  std::string channel;  ///< as in `UnnamedRegressor`
  std::string words;    ///< likewise
  Series values;        ///< one a sample
};

struct UnnamedTrial {
  std::size_t regressor = 0;    ///< index into SelectionProblem::unnamed
  Eigen::VectorXd block_error;  ///< held out, with the regressor added and all else refitted
};

/// The regressor that, added to `fit`, leaves the least held-out error, among those whose
/// coefficient beats chance: Student's test with the jackknife's standard error, at
/// `false_alarm_probability` over all regressors (Bonferroni). Those in `taken` and those that the
/// fit already contains are passed over.
[[nodiscard]] std::optional<UnnamedTrial> best_unnamed(const Record& record, const BlockFit& fit,
                                                       const std::vector<std::size_t>& taken,
                                                       double false_alarm_probability);

}  // namespace tethercalc
