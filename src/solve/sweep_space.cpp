#include "tethercalc/solve/sweep_space.hpp"

#include <algorithm>
#include <array>
#include <boost/math/distributions/normal.hpp>
#include <stdexcept>
#include <utility>

#include "model/constants.hpp"

namespace tethercalc {
namespace {

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
// Clang deduces the arguments of aggregates without a guide only since version 17.
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

double power_of_ten(int exponent) {
  constexpr std::array<double, 23> exact{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                         1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                         1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  return exact.at(static_cast<std::size_t>(exponent));
}

double number_of(const DecimalRange& range, std::uint64_t index) {
  const std::int64_t scaled = range.first + static_cast<std::int64_t>(index) * range.step;
  return static_cast<double>(scaled) / power_of_ten(range.decimals);
}

/// Which of `count` equally likely things `u` in (0, 1) picks.
std::uint64_t pick(double u, std::uint64_t count) {
  return std::min(static_cast<std::uint64_t>(u * static_cast<double>(count)), count - 1);
}

double normal_quantile(const Normal& normal, double u) {
  // Long double would cost five times the time for digits nobody sees.
  using Plain = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
  static const boost::math::normal_distribution<double, Plain> standard;
  return normal.mean + normal.standard_deviation * boost::math::quantile(standard, u);
}

/// Named choices first: a motor or material replaces all of its numbers, which other axes may vary.
std::vector<std::size_t> order_of_application(std::span<const SweepAxis> axes) {
  std::vector<std::size_t> order(axes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_partition(order.begin(), order.end(), [&](std::size_t i) {
    return std::holds_alternative<NamedChoices>(axes[i].values);
  });
  return order;
}

}  // namespace

std::optional<std::uint64_t> value_count(const SweepAxis& axis) {
  return std::visit(Overloaded{[](const DecimalRange& r) { return std::optional(r.count); },
                               [](const std::vector<double>& list) {
                                 return std::optional(static_cast<std::uint64_t>(list.size()));
                               },
                               [](const NamedChoices& c) {
                                 return std::optional(static_cast<std::uint64_t>(c.names.size()));
                               },
                               [](const UniformInteger& r) {
                                 return std::optional(static_cast<std::uint64_t>(r.hi - r.lo) + 1);
                               },
                               [](const auto&) { return std::optional<std::uint64_t>(); }},
                    axis.values);
}

double value_at(const SweepAxis& axis, std::uint64_t index) {
  return std::visit(
      Overloaded{[index](const DecimalRange& r) { return number_of(r, index); },
                 [index](const std::vector<double>& list) { return list[index]; },
                 [index](const NamedChoices&) { return static_cast<double>(index); },
                 [index](const UniformInteger& r) {
                   return static_cast<double>(r.lo + static_cast<std::int64_t>(index));
                 },
                 [](const auto&) { return nan; }},
      axis.values);
}

double quantile(const SweepAxis& axis, double u) {
  if (const auto* uniform = std::get_if<Uniform>(&axis.values)) {
    // Kept between the ends: rounding must not leave the range.
    return std::clamp(uniform->lo + u * (uniform->hi - uniform->lo), uniform->lo, uniform->hi);
  }
  if (const auto* normal = std::get_if<Normal>(&axis.values)) return normal_quantile(*normal, u);
  return value_at(axis, pick(u, *value_count(axis)));
}

Design with_values(Design design, std::span<const SweepAxis> axes, std::span<const double> values) {
  for (const std::size_t i : order_of_application(axes)) axes[i].apply(design, values[i]);
  return design;
}

RowRange shard_rows(std::uint64_t rows, std::uint64_t part, std::uint64_t parts) {
  if (part < 1 || part > parts) {
    throw std::invalid_argument("the part of a sweep must lie between 1 and the number of parts");
  }
  const std::uint64_t share = rows / parts;
  const std::uint64_t rest = rows % parts;  // the first `rest` parts have one more
  const auto begin_of = [&](std::uint64_t p) { return share * p + std::min(p, rest); };
  return {begin_of(part - 1), begin_of(part)};
}

std::vector<std::uint64_t> spread_rows(std::uint64_t rows, std::uint64_t most) {
  if (rows == 0) return {};
  std::vector<std::uint64_t> spread{0};
  const std::uint64_t last = rows - 1;
  const std::uint64_t steps = std::min(rows, most) - 1;
  for (std::uint64_t k = 1; k <= steps; ++k) {
    spread.push_back(last / steps * k + last % steps * k / steps);
  }
  return spread;
}

SweepSpace::SweepSpace(std::vector<SweepAxis> axes) : axes_(std::move(axes)) {
  constexpr std::uint64_t limit = std::uint64_t{1} << 63;
  for (const SweepAxis& axis : axes_) {
    const auto count = value_count(axis);
    if (!count) throw std::invalid_argument(axis.name + " can only be drawn, not enumerated");
    if (*count != 0 && rows_ >= limit / *count) {
      throw std::invalid_argument("the sweep has more than 2^63 combinations");
    }
    rows_ *= *count;
  }
}

SweepSpace::SweepSpace(std::vector<SweepAxis> axes, const SamplePlan& plan)
    : axes_(std::move(axes)), plan_(plan), rows_(plan.count) {}

SweepCursor::SweepCursor(const SweepSpace& space, const Design& base)
    : space_(&space),
      design_(base),
      order_(order_of_application(space.axes())),
      values_(space.axes().size(), nan),
      next_(space.axes().size()) {
  if (space.sample()) points_.emplace(*space.sample(), space.axes().size());
  move_to(0);
}

void SweepCursor::move_to(std::uint64_t row) {
  const auto axes = space_->axes();
  if (points_) {
    points_->at(row, next_);
    for (std::size_t i = 0; i < axes.size(); ++i) next_[i] = quantile(axes[i], next_[i]);
  } else {
    for (std::size_t i = axes.size(); i-- > 0;) {
      const std::uint64_t count = *value_count(axes[i]);
      next_[i] = value_at(axes[i], row % count);
      row /= count;
    }
  }
  set_values(next_);
}

void SweepCursor::set_values(std::span<const double> values) {
  // From the first change on, everything is set again: a later axis may vary a part of what an
  // earlier one replaces. What changes slowest is rarely touched.
  const auto first_change =
      std::ranges::find_if(order_, [&](std::size_t i) { return !(values[i] == values_[i]); });
  for (auto i = first_change; i != order_.end(); ++i) {
    values_[*i] = values[*i];
    space_->axes()[*i].apply(design_, values_[*i]);
  }
}

}  // namespace tethercalc
