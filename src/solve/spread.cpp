#include "tethercalc/solve/spread.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/constants.hpp"

namespace tethercalc {
namespace {

/// Bin i holds (γ^(i−1), γ^i]; its answer 2γ^i/(γ + 1) is within (γ − 1)/(γ + 1) of all of it.
const double log_gamma = std::log((1 + Spread::relative_error) / (1 - Spread::relative_error));

std::int64_t bin_of(double value) {
  return static_cast<std::int64_t>(std::ceil(std::log(std::clamp(value, 1e-30, 1e30)) / log_gamma));
}

double middle_of(std::int64_t bin) {
  return std::exp(static_cast<double>(bin) * log_gamma) * (1 - Spread::relative_error);
}

}  // namespace

void Spread::add(double value) {
  if (!(value > 0) || !std::isfinite(value)) {
    throw std::invalid_argument("a quantile histogram takes positive numbers only");
  }
  const std::int64_t bin = bin_of(value);
  if (count_ == 0) {
    first_bin_ = bin;
    least_ = largest_ = value;
  }
  if (bin < first_bin_) {
    bins_.insert(bins_.begin(), static_cast<std::size_t>(first_bin_ - bin), 0);
    first_bin_ = bin;
  }
  const auto position = static_cast<std::size_t>(bin - first_bin_);
  if (position >= bins_.size()) bins_.resize(position + 1, 0);
  ++bins_[position];
  ++count_;
  least_ = std::min(least_, value);
  largest_ = std::max(largest_, value);
  const double deviation = value - mean_;
  mean_ += deviation / static_cast<double>(count_);
  squares_ += deviation * (value - mean_);
}

double Spread::mean() const { return count_ > 0 ? mean_ : nan; }

double Spread::standard_deviation() const {
  return count_ < 2 ? nan : std::sqrt(squares_ / static_cast<double>(count_ - 1));
}

double Spread::quantile(double p) const {
  if (count_ == 0) return nan;
  const double share = std::ceil(p * static_cast<double>(count_));
  const auto rank = std::clamp<std::uint64_t>(static_cast<std::uint64_t>(share), 1, count_);
  if (rank == 1) return least_;
  if (rank == count_) return largest_;
  std::uint64_t reached = 0;
  std::size_t position = 0;
  while ((reached += bins_[position]) < rank) ++position;
  const double middle = middle_of(first_bin_ + static_cast<std::int64_t>(position));
  return std::clamp(middle, least_, largest_);
}

}  // namespace tethercalc
