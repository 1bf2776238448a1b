#include "tethercalc/model/motor_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace tethercalc {
namespace {

std::vector<double> slopes_of(std::span<const MotorPoint> vertices) {
  std::vector<double> slopes;
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    slopes.push_back((vertices[i].power - vertices[i - 1].power) /
                     (vertices[i].thrust - vertices[i - 1].thrust));
  }
  return slopes;
}

/// Lower convex hull of vertices that are sorted by thrust (Andrew's monotone chain, lower half).
std::vector<MotorPoint> lower_hull(std::span<const MotorPoint> vertices) {
  std::vector<MotorPoint> hull;
  for (const MotorPoint& next : vertices) {
    while (hull.size() >= 2) {
      const MotorPoint& a = hull[hull.size() - 2];
      const MotorPoint& b = hull.back();
      const double turn = (b.thrust - a.thrust) * (next.power - a.power) -
                          (b.power - a.power) * (next.thrust - a.thrust);
      if (turn > 0) break;
      hull.pop_back();
    }
    hull.push_back(next);
  }
  return hull;
}

void check(std::span<const MotorPoint> points) {
  if (points.size() < 2) {
    throw std::invalid_argument("a motor curve needs at least two points");
  }
  MotorPoint previous;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const MotorPoint& p = points[i];
    if (!std::isfinite(p.thrust) || !std::isfinite(p.power)) {
      throw std::invalid_argument("motor point " + std::to_string(i + 1) + " is not finite");
    }
    if (!(p.thrust > previous.thrust) || !(p.power > previous.power)) {
      throw std::invalid_argument("motor point " + std::to_string(i + 1) +
                                  " does not rise in both thrust and power");
    }
    previous = p;
  }
}

using Pool = PooledMotorPoints;

Pool merged(Pool low, const Pool& high) {
  const auto n = static_cast<double>(low.members.size());
  const auto m = static_cast<double>(high.members.size());
  // A weighted step from one mean to the other: unlike a sum it cannot overflow.
  const double share = m / (n + m);
  low.mean.thrust += share * (high.mean.thrust - low.mean.thrust);
  low.mean.power += share * (high.mean.power - low.mean.power);
  low.members.insert(low.members.end(), high.members.begin(), high.members.end());
  return low;
}

bool rises(const MotorPoint& low, const MotorPoint& high) {
  return low.thrust < high.thrust && low.power < high.power;
}

}  // namespace

MotorCurve::MotorCurve() {
  static const auto empty = std::make_shared<const Polyline>(Polyline{{MotorPoint{}}, {}, nullptr});
  line_ = empty;
}

MotorCurve::MotorCurve(std::vector<MotorPoint> points) {
  check(points);
  points.insert(points.begin(), MotorPoint{});
  std::vector<MotorPoint> hull = lower_hull(points);
  std::vector<double> slopes = slopes_of(points);
  std::shared_ptr<const MotorCurve> hull_curve;
  if (hull.size() < points.size()) {
    std::vector<double> hull_slopes = slopes_of(hull);
    hull_curve.reset(new MotorCurve(std::make_shared<const Polyline>(
        Polyline{std::move(hull), std::move(hull_slopes), nullptr})));
  }
  line_ = std::make_shared<const Polyline>(
      Polyline{std::move(points), std::move(slopes), std::move(hull_curve)});
}

MotorCurve::MotorCurve(std::shared_ptr<const Polyline> line) : line_(std::move(line)) {}

double MotorCurve::thrust(double power) const {
  if (power <= 0 || line_->slopes.empty()) return 0;
  if (power >= line_->vertices.back().power) return line_->vertices.back().thrust;
  const std::size_t i = piece_at(line_->vertices, &MotorPoint::power, power);
  return line_->vertices[i].thrust + (power - line_->vertices[i].power) / line_->slopes[i];
}

MotorCurve MotorCurve::in_air(double density_ratio) const {
  const auto points = vertices().subspan(1);
  if (points.empty()) return *this;
  std::vector<MotorPoint> scaled;
  for (const MotorPoint& point : points) {
    scaled.push_back({density_ratio * point.thrust, density_ratio * point.power});
  }
  MotorCurve curve(std::move(scaled));
  if (measured_in_) curve.measured_in_ = density_ratio * *measured_in_;
  return curve;
}

double ideal_power_in_air(double density_ratio) {
  return density_ratio * std::pow(1 / density_ratio, 1.5);  // ratio·P(T/ratio) over P(T)
}

const MotorCurve& MotorCurve::convex_hull() const { return line_->hull ? *line_->hull : *this; }

bool MotorCurve::is_convex() const { return !line_->hull; }

double induced_velocity_ratio(double speed_ratio) {
  const double half_square = 0.5 * speed_ratio * speed_ratio;
  // √(1 + x²) − x = 1/(√(1 + x²) + x) keeps its digits at high speed.
  return 1 / std::sqrt(std::hypot(1, half_square) + half_square);
}

Inflow inflow_ratio(double speed_ratio, double tan_pitch) {
  const double mu = std::abs(speed_ratio);
  if (mu == 0) return {};
  const double cosine_squared = 1 / (1 + tan_pitch * tan_pitch);
  const double cosine = std::sqrt(cosine_squared);
  const double from_airspeed = mu * tan_pitch * cosine;
  const double along_squared = mu * mu * cosine_squared;
  // From the right of the root of a function that bends up there, in λ − μ·sinα.
  double induced = induced_velocity_ratio(mu * cosine);
  double ratio = induced + from_airspeed;
  for (int step = 0; step < 100 && from_airspeed > 0; ++step) {
    const double through = along_squared + ratio * ratio;
    const double excess = induced * induced * through - 1;
    const double change = excess / (2 * induced * (through + induced * ratio));
    induced -= change;
    ratio = induced + from_airspeed;
    if (std::abs(change) <= 1e-9 * induced) break;  // Newton squares the error in every step
  }
  const double through = along_squared + ratio * ratio;
  const double by_tilt = mu * cosine * cosine_squared;
  const double slope = (by_tilt * through + induced * along_squared * tan_pitch * cosine_squared) /
                       (through + induced * ratio);
  return {ratio, slope};
}

PowerShare translational_lift_share(const TranslationalLift& lift, double airspeed,
                                    double tan_pitch) {
  if (lift.induced_share == 0) return {};
  const Inflow inflow = inflow_ratio(airspeed / lift.hover_induced_speed, tan_pitch);
  return {1 - lift.induced_share * (1 - inflow.ratio), lift.induced_share * inflow.slope};
}

IsotonicMotorPoints isotonic_motor_points(std::span<const MotorPoint> measured) {
  for (const MotorPoint& point : measured) {
    const bool usable = std::isfinite(point.thrust) && point.thrust > 0 &&
                        std::isfinite(point.power) && point.power > 0;
    if (!usable) throw std::invalid_argument("thrust and power must be finite and positive");
  }
  std::vector<std::size_t> order(measured.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return measured[i].thrust; });

  std::vector<Pool> pools;
  for (std::size_t i = 0; i < order.size();) {
    Pool pool{{order[i]}, measured[order[i]]};
    for (++i; i < order.size() && measured[order[i]].thrust == pool.mean.thrust; ++i) {
      pool = merged(std::move(pool), {{order[i]}, measured[order[i]]});
    }
    while (!pools.empty() && !rises(pools.back().mean, pool.mean)) {
      pool = merged(std::move(pools.back()), pool);
      pools.pop_back();
    }
    pools.push_back(std::move(pool));
  }

  IsotonicMotorPoints result;
  for (Pool& pool : pools) {
    result.points.push_back(pool.mean);
    if (pool.members.size() > 1) result.pooled.push_back(std::move(pool));
  }
  return result;
}

}  // namespace tethercalc
