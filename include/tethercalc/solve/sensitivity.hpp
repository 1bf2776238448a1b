// How much of an output's variance each uncertain input is to blame for.
#pragma once

#include <cstdint>
#include <vector>

namespace tethercalc {

/// A Sobol index as estimated from a sample.
struct IndexEstimate {
  double value = 0;           ///< in [0, 1] but for the sample's chance
  double standard_error = 0;  ///< one standard deviation
};

/// Sobol indices of one input. NaN where the output does not vary or fewer than 30 points are
/// known.
struct Sensitivity {
  IndexEstimate first_order;  ///< share of the variance that knowing this input alone would remove
  IndexEstimate total;  ///< share that would remain if everything but this input were known; at
                        ///< least the first order, more where it interacts with other inputs
};

/// Outputs of a function at the points of two independent samples A and B and of their mixtures:
/// point j of mixture i is point j of A with input i taken from B. NaN marks an output that does
/// not exist.
struct SensitivitySample {
  std::vector<double> a;                   ///< outputs at the points of A
  std::vector<double> b;                   ///< outputs at the points of B
  std::vector<std::vector<double>> mixed;  ///< by input
};

/// First-order indices by Saltelli, Annoni, Azzini, Campolongo, Ratto and Tarantola (2010),
/// Computer Physics Communications 181, 259–270, table 2 (b), total ones by Jansen (1999), ibid.
/// (f); the mean is taken off first, without which a large mean drowns small indices. Standard
/// errors by bootstrap over the points (Archer, Saltelli and Sobol 1997), 200 resamples, which
/// makes them good to about 5 %. For Sobol points they are on the large side, since the bootstrap
/// cannot know that these are more evenly spread than chance.
///
/// Points at which an output of an input's three samples does not exist are left out for that
/// input; with many of them the indices describe something else than the whole space.
/// Throws std::invalid_argument where the samples differ in size.
[[nodiscard]] std::vector<Sensitivity> sobol_indices(const SensitivitySample& sample,
                                                     std::uint64_t seed = 0);

}  // namespace tethercalc
