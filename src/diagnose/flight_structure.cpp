#include "diagnose/flight_structure.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "diagnose/unnamed_structure.hpp"

namespace tethercalc {
namespace {

bool varies(const Series& x) { return (x != x[0]).any(); }

Series height_gained(const Observations& o) {
  Series height = Series::Zero(static_cast<Eigen::Index>(o.size()));
  for (std::size_t i = 1; i < o.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    height[k] =
        height[k - 1] - (o.down_speed[i - 1] + o.down_speed[i]) / 2 * (o.time[i] - o.time[i - 1]);
  }
  return height;
}

void add_powers(std::vector<Shape>& shapes, const std::string& channel, const std::string& name,
                const Series& x) {
  if (!varies(x)) return;
  shapes.push_back({channel, name, x});
  shapes.push_back({channel, "the magnitude of the " + name, x.abs()});
  shapes.push_back({channel, "the square of the " + name, x.square()});
}

/// Every thirty-second of the flight: a step elsewhere is at most a sixty-fourth away. It is zero
/// before it happens: half of it on either side would need a constant effect to cancel the first.
constexpr int step_places = 32;

void add_time(std::vector<Shape>& shapes, const Series& time) {
  const double begin = time[0];
  const double duration = time[time.size() - 1] - begin;
  const Series elapsed = (time - begin) / duration - 0.5;
  shapes.push_back({"time_s", "time, steadily", elapsed});
  shapes.push_back(
      {"time_s", "the square of the time from the middle of the flight", elapsed.square()});
  for (int k = 1; k < step_places; ++k) {
    const double at = begin + duration * k / step_places;
    shapes.push_back(
        {"time_s", fmt::format("a step at about {:.0f} s", at), (time >= at).cast<double>()});
  }
}

}  // namespace

std::vector<UnnamedRegressor> flight_structure(const Observations& o, double wind) {
  std::vector<Shape> shapes;
  add_powers(shapes, "roll_deg", "roll", as_series(o.roll));
  add_powers(shapes, "pitch_deg", "pitch", as_series(o.tilt));
  add_powers(shapes, "lateral_speed_m_s", "lateral speed", as_series(o.right_speed));
  add_powers(shapes, "vd_m_s", "vertical speed", as_series(o.down_speed));
  if (varies(as_series(o.down_speed))) {
    Series height = height_gained(o);
    height -= height.mean();
    shapes.push_back({"height_m", "height", height});
    shapes.push_back({"height_m", "the square of the height from its mean", height.square()});
  }
  if (const Series yaw = as_series(o.yaw); varies(yaw)) {
    shapes.push_back({"yaw_deg", "the cosine of the yaw", yaw.cos()});
    shapes.push_back({"yaw_deg", "the sine of the yaw", yaw.sin()});
  }
  add_time(shapes, as_series(o.time));

  const Series u = as_series(o.forward_speed) - wind;
  const std::pair<const char*, Series> carriers[] = {
      {"", Series::Ones(u.size())},
      {", times the airspeed", u},
      {", times the magnitude of the airspeed", u.abs()},
      {", times the airspeed and its magnitude", u * u.abs()}};
  std::vector<UnnamedRegressor> regressors;
  const auto add = [&regressors](const std::string& channel, const std::string& words,
                                 const Series& column) {
    regressors.push_back({channel, words, {column.begin(), column.end()}});
  };
  for (const Shape& shape : shapes) {
    for (const auto& [words, carrier] : carriers) {
      add(shape.channel, shape.words + words, shape.values * carrier);
    }
  }
  add("airspeed_m_s", "the magnitude of the airspeed", u.abs());
  add("airspeed_m_s", "the square of the airspeed", u.square());
  add("airspeed_m_s", "the cube of the airspeed", u.cube());
  add("airspeed_m_s", "the direction of the airspeed",
      (u < 0).select(-Series::Ones(u.size()), 1.0));
  return regressors;
}

}  // namespace tethercalc
