#include "diagnose/flight_structure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>

namespace tethercalc {
namespace {

using Series = std::vector<double>;

struct Shape {
  std::string channel;
  std::string words;
  Series values;
};

Series map(const Series& x, const std::function<double(double)>& f) {
  Series out(x.size());
  std::transform(x.begin(), x.end(), out.begin(), f);
  return out;
}

Series centred(const Series& x) {
  const double mean = std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
  return map(x, [mean](double value) { return value - mean; });
}

bool varies(const Series& x) {
  return std::any_of(x.begin(), x.end(), [&x](double value) { return value != x.front(); });
}

Series height_gained(const Observations& o) {
  Series height(o.size(), 0.0);
  for (std::size_t i = 1; i < o.size(); ++i) {
    height[i] =
        height[i - 1] - (o.down_speed[i - 1] + o.down_speed[i]) / 2 * (o.time[i] - o.time[i - 1]);
  }
  return height;
}

void add_powers(std::vector<Shape>& shapes, const std::string& channel, const std::string& name,
                const Series& x) {
  if (!varies(x)) return;
  shapes.push_back({channel, name, x});
  shapes.push_back(
      {channel, "the magnitude of the " + name, map(x, [](double v) { return std::abs(v); })});
  shapes.push_back({channel, "the square of the " + name, map(x, [](double v) { return v * v; })});
}

/// Every thirty-second of the flight: a step elsewhere is at most a sixty-fourth away. It is zero
/// before it happens: half of it on either side would need a constant effect to cancel the first.
constexpr int step_places = 32;

void add_time(std::vector<Shape>& shapes, const Series& time) {
  const double begin = time.front();
  const double duration = time.back() - begin;
  const auto elapsed = [begin, duration](double t) { return (t - begin) / duration - 0.5; };
  shapes.push_back({"time_s", "time, steadily", map(time, elapsed)});
  shapes.push_back({"time_s", "the square of the time from the middle of the flight",
                    map(time, [elapsed](double t) { return elapsed(t) * elapsed(t); })});
  for (int k = 1; k < step_places; ++k) {
    const double at = begin + duration * k / step_places;
    shapes.push_back({"time_s", fmt::format("a step at about {:.0f} s", at),
                      map(time, [at](double t) { return t < at ? 0.0 : 1.0; })});
  }
}

}  // namespace

std::vector<UnnamedRegressor> flight_structure(const Observations& o, double wind) {
  std::vector<Shape> shapes;
  add_powers(shapes, "roll_deg", "roll", o.roll);
  add_powers(shapes, "pitch_deg", "pitch", o.tilt);
  add_powers(shapes, "lateral_speed_m_s", "lateral speed", o.right_speed);
  add_powers(shapes, "vd_m_s", "vertical speed", o.down_speed);
  if (varies(o.down_speed)) {
    const Series height = centred(height_gained(o));
    shapes.push_back({"height_m", "height", height});
    shapes.push_back({"height_m", "the square of the height from its mean",
                      map(height, [](double h) { return h * h; })});
  }
  if (varies(o.yaw)) {
    shapes.push_back(
        {"yaw_deg", "the cosine of the yaw", map(o.yaw, [](double y) { return std::cos(y); })});
    shapes.push_back(
        {"yaw_deg", "the sine of the yaw", map(o.yaw, [](double y) { return std::sin(y); })});
  }
  add_time(shapes, o.time);

  const Series airspeed = map(o.forward_speed, [wind](double v) { return v - wind; });
  struct Carrier {
    const char* words;
    double (*of)(double);
  };
  const Carrier carriers[] = {
      {"", [](double) { return 1.0; }},
      {", times the airspeed", [](double u) { return u; }},
      {", times the magnitude of the airspeed", [](double u) { return std::abs(u); }},
      {", times the airspeed and its magnitude", [](double u) { return u * std::abs(u); }}};

  std::vector<UnnamedRegressor> regressors;
  for (const Shape& shape : shapes) {
    for (const Carrier& carrier : carriers) {
      Series column(o.size());
      for (std::size_t i = 0; i < o.size(); ++i) {
        column[i] = shape.values[i] * carrier.of(airspeed[i]);
      }
      regressors.push_back({shape.channel, shape.words + carrier.words, std::move(column)});
    }
  }
  const auto add_speed = [&](const char* words, double (*of)(double)) {
    regressors.push_back({"airspeed_m_s", words, map(airspeed, of)});
  };
  add_speed("the magnitude of the airspeed", [](double u) { return std::abs(u); });
  add_speed("the square of the airspeed", [](double u) { return u * u; });
  add_speed("the cube of the airspeed", [](double u) { return u * u * u; });
  add_speed("the direction of the airspeed", [](double u) { return u < 0 ? -1.0 : 1.0; });
  return regressors;
}

}  // namespace tethercalc
