#include "tethercalc/model/motor_curve.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
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

const MotorCurve& MotorCurve::convex_hull() const { return line_->hull ? *line_->hull : *this; }

bool MotorCurve::is_convex() const { return !line_->hull; }

}  // namespace tethercalc
