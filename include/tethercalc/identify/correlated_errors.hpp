// Standard errors for residuals that resemble their neighbours in time.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tethercalc {

/// Correlation of `series` with itself `lag` samples later, about its mean: in [−1, 1]; 0 where the
/// series is constant or not longer than the lag.
[[nodiscard]] double autocorrelation(std::span<const double> series, std::size_t lag);

/// How many independent samples would average out as well as this correlated series does:
/// N/(1 + 2·Σρ_k), with the sum cut where neighbouring pairs ρ_2m + ρ_2m+1 stop being positive,
/// since beyond that it adds only noise (Geyer, Practical Markov Chain Monte Carlo, Statistical
/// Science 7, 1992, 473–483, section 3.3). At least 1 for a series that is not empty, and at most
/// N: an alternating series averages out even faster, but that is not claimed.
[[nodiscard]] double effective_sample_size(std::span<const double> series);

/// Number of cosines ν ≥ 1 for `long_run_covariance` of `samples` samples that are worth
/// `effective_samples` independent ones: 0.4·T^(2/3) (Lazarus, Lewis, Stock and Watson, HAR
/// Inference: Recommendations for Practice, Journal of Business & Economic Statistics 36, 2018,
/// 541–559).
///
/// That rule was tuned for a first-order autoregression with coefficient 0.7, worth (1 − 0.7)/(1 +
/// 0.7) of its samples. A log taken faster has more samples but no more information, and a fixed
/// rule in samples would let its bandwidth grow past the noise's own corner frequency. T is
/// therefore the number of samples the flight would have if it were taken just fast enough to be so
/// correlated, effective_samples·1.7/0.3, and never more than `samples`.
[[nodiscard]] std::size_t cosine_terms(double samples, double effective_samples);

/// Long-run covariance Ω = Σ_k E[z_t z_{t+k}ᵀ] of a vector series, so that Var(Σ z_t) ≈ N·Ω: the
/// average of the outer products of its first `terms` cosine coefficients
/// Λ_j = √(2/N)·Σ z_t·cos(πj(t − ½)/N) (the equal-weighted cosine estimator they recommend). It is
/// positive semidefinite, ignores the mean, and a statistic studentised with it has Student's t
/// distribution with `terms` degrees of freedom, which is why it is used here rather than
/// Newey–West's estimator: the uncertainty of Ω itself reaches the interval.
///
/// `rows` holds N rows of `columns` values, row after row; the result is columns × columns, row
/// after row. `terms` ≥ 1.
[[nodiscard]] std::vector<double> long_run_covariance(std::span<const double> rows,
                                                      std::size_t columns, std::size_t terms);

}  // namespace tethercalc
