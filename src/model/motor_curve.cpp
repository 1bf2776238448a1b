#include "tethercalc/model/motor_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace tethercalc {
namespace {

/// A rising piecewise-linear curve: vertices and the slope of each piece between them.
struct Polyline {
  std::vector<MotorPoint> vertices;
  std::vector<double> slopes;  ///< W/N, one fewer than vertices
};

Polyline with_slopes(std::vector<MotorPoint> vertices) {
  std::vector<double> slopes;
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    slopes.push_back((vertices[i].power - vertices[i - 1].power) /
                     (vertices[i].thrust - vertices[i - 1].thrust));
  }
  return {std::move(vertices), std::move(slopes)};
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

/// Index of the piece that holds `value` of the rising `member`, the first piece for smaller values
/// and the last for larger ones.
std::size_t piece_at(const Polyline& line, double MotorPoint::*member, double value) {
  const MotorPoint* base = line.vertices.data();
  std::size_t count = line.slopes.size();
  while (count > 1) {
    const std::size_t half = count / 2;
    base += base[half].*member <= value ? half : 0;  // branch-free: this is the hottest loop
    count -= half;
  }
  return static_cast<std::size_t>(base - line.vertices.data());
}

double power_on(const Polyline& line, double thrust) {
  if (thrust <= 0) return 0;
  if (line.slopes.empty() || thrust > line.vertices.back().thrust) {
    return std::numeric_limits<double>::infinity();
  }
  const std::size_t i = piece_at(line, &MotorPoint::thrust, thrust);
  return line.vertices[i].power + line.slopes[i] * (thrust - line.vertices[i].thrust);
}

double slope_on(const Polyline& line, double thrust) {
  return line.slopes.empty() ? std::numeric_limits<double>::infinity()
                             : line.slopes[piece_at(line, &MotorPoint::thrust, thrust)];
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

struct MotorCurve::Vertices {
  Polyline measured;
  Polyline hull;
};

MotorCurve::MotorCurve() {
  static const auto empty =
      std::make_shared<const Vertices>(Vertices{{{MotorPoint{}}, {}}, {{MotorPoint{}}, {}}});
  vertices_ = empty;
}

MotorCurve::MotorCurve(std::vector<MotorPoint> points) {
  check(points);
  points.insert(points.begin(), MotorPoint{});
  std::vector<MotorPoint> hull = lower_hull(points);
  vertices_ = std::make_shared<const Vertices>(
      Vertices{with_slopes(std::move(points)), with_slopes(std::move(hull))});
}

double MotorCurve::power(double thrust) const { return power_on(vertices_->measured, thrust); }

double MotorCurve::thrust(double power) const {
  const Polyline& line = vertices_->measured;
  if (!(power > 0) || line.slopes.empty()) return 0;
  if (power >= line.vertices.back().power) return line.vertices.back().thrust;
  const std::size_t i = piece_at(line, &MotorPoint::power, power);
  return line.vertices[i].thrust + (power - line.vertices[i].power) / line.slopes[i];
}

double MotorCurve::power_slope(double thrust) const {
  return slope_on(vertices_->measured, thrust);
}

double MotorCurve::convex_power(double thrust) const { return power_on(vertices_->hull, thrust); }

double MotorCurve::convex_power_slope(double thrust) const {
  return slope_on(vertices_->hull, thrust);
}

double MotorCurve::max_thrust() const { return vertices_->measured.vertices.back().thrust; }

double MotorCurve::max_power() const { return vertices_->measured.vertices.back().power; }

std::span<const MotorPoint> MotorCurve::vertices() const { return vertices_->measured.vertices; }

}  // namespace tethercalc
