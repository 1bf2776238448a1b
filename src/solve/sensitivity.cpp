#include "tethercalc/solve/sensitivity.hpp"

#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>

#include "model/constants.hpp"
#include "solve/random_bits.hpp"

namespace tethercalc {
namespace {

constexpr int resamples = 200;

/// One point's outputs, less the mean of all.
struct Triple {
  double a = 0;
  double b = 0;
  double mixed = 0;
};

std::vector<Triple> complete_triples(const SensitivitySample& sample, std::size_t input) {
  std::vector<Triple> triples;
  double sum = 0;
  for (std::size_t j = 0; j < sample.a.size(); ++j) {
    const Triple triple{sample.a[j], sample.b[j], sample.mixed[input][j]};
    if (std::isnan(triple.a) || std::isnan(triple.b) || std::isnan(triple.mixed)) continue;
    sum += triple.a + triple.b;
    triples.push_back(triple);
  }
  const double mean = sum / (2 * static_cast<double>(triples.size()));
  for (Triple& triple : triples) {
    triple.a -= mean;
    triple.b -= mean;
    triple.mixed -= mean;
  }
  return triples;
}

/// Sums from which both indices follow.
class Sums {
 public:
  void add(const Triple& t) {
    ++count_;
    sum_ += t.a + t.b;
    squares_ += t.a * t.a + t.b * t.b;
    first_ += t.b * (t.mixed - t.a);
    total_ += (t.a - t.mixed) * (t.a - t.mixed);
  }
  [[nodiscard]] double first_order() const { return first_ / count_ / variance(); }
  [[nodiscard]] double total() const { return total_ / (2 * count_) / variance(); }

 private:
  [[nodiscard]] double variance() const {
    const double mean = sum_ / (2 * count_);
    return squares_ / (2 * count_) - mean * mean;
  }
  double count_ = 0;
  double sum_ = 0;
  double squares_ = 0;
  double first_ = 0;
  double total_ = 0;
};

double standard_deviation(std::span<const double> values) {
  double mean = 0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

bool varies(std::span<const Triple> triples) {
  for (const Triple& t : triples) {
    if (t.a != triples.front().a || t.b != triples.front().a) return true;
  }
  return false;
}

Sensitivity sensitivity_of(std::span<const Triple> triples, std::uint64_t seed) {
  constexpr std::size_t fewest = 30;  // of fewer neither a share nor its error means anything
  if (triples.size() < fewest || !varies(triples)) return {{nan, nan}, {nan, nan}};
  Sums sums;
  for (const Triple& triple : triples) sums.add(triple);
  std::vector<double> first;
  std::vector<double> total;
  for (std::uint64_t r = 0; r < resamples; ++r) {
    Sums resampled;
    for (std::uint64_t j = 0; j < triples.size(); ++j) {
      const double u = unit_number(mixed_bits(seed + r, j));
      resampled.add(triples[static_cast<std::size_t>(u * static_cast<double>(triples.size()))]);
    }
    first.push_back(resampled.first_order());
    total.push_back(resampled.total());
  }
  return {{sums.first_order(), standard_deviation(first)},
          {sums.total(), standard_deviation(total)}};
}

}  // namespace

std::vector<Sensitivity> sobol_indices(const SensitivitySample& sample, std::uint64_t seed) {
  for (const auto& mixed : sample.mixed) {
    if (mixed.size() != sample.a.size() || sample.b.size() != sample.a.size()) {
      throw std::invalid_argument("the samples of a sensitivity analysis differ in size");
    }
  }
  std::vector<Sensitivity> indices;
  for (std::size_t input = 0; input < sample.mixed.size(); ++input) {
    indices.push_back(sensitivity_of(complete_triples(sample, input), mixed_bits(seed, input)));
  }
  return indices;
}

}  // namespace tethercalc
