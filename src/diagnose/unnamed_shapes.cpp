#include "diagnose/unnamed_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>

#include "identify/linear_algebra.hpp"

namespace tethercalc {
namespace {

/// A course that a log may take without any effect of the catalogue.
struct Shape {
  std::string channel;  ///< as in `UnnamedRegressor`
  std::string words;    ///< likewise
  Series values;        ///< one a sample
  double least_gain_factor = 1;
};

bool varies(const Series& x) { return (x != x[0]).any(); }

Series height_gained(const Observations& o) {
  Series height = Series::Zero(static_cast<Index>(o.size()));
  for (std::size_t i = 1; i < o.size(); ++i) {
    const auto k = static_cast<Index>(i);
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

/// Steps are so near to each other that one between two of them explains no less than an effect
/// with a name whose moment is fitted. They are zero before they happen: half of one on either side
/// would need a constant effect to cancel the first.
constexpr int step_places = 128;
/// As for effects whose moment is looked for: some moment always shows a little.
constexpr double gain_of_steps = 5;

void add_time(std::vector<Shape>& shapes, const Series& time) {
  const double begin = time[0];
  const double duration = time[time.size() - 1] - begin;
  const Series elapsed = (time - begin) / duration - 0.5;
  shapes.push_back({"time_s", "time, steadily", elapsed});
  shapes.push_back(
      {"time_s", "the square of the time from the middle of the flight", elapsed.square()});
  for (int k = 1; k < step_places; ++k) {
    const double at = begin + duration * k / step_places;
    shapes.push_back({"time_s", fmt::format("a step at about {:.0f} s", at),
                      (time >= at).cast<double>(), gain_of_steps});
  }
}

/// Steps that are tried throughout the log.
constexpr int coarse_steps = 40;

Shape step_at(const PowerLog& log, double share) {
  const double at = log.time.front() + share * (log.time.back() - log.time.front());
  return {"time_s", fmt::format("a step at {:.0f} s", at),
          (as_series(log.time) >= at).cast<double>()};
}

std::vector<Shape> shapes_of(const PowerLog& log) {
  const double duration = log.time.back() - log.time.front();
  const Series share = (as_series(log.time) - log.time.front()) / duration;
  std::vector<Shape> shapes;
  for (int k = 1; k < coarse_steps; ++k) {
    shapes.push_back(step_at(log, static_cast<double>(k) / coarse_steps));
  }
  shapes.push_back({"time_s", "a steady drift", share});
  for (int k = 1; k <= 8; ++k) {
    const std::string words = fmt::format("a wave of {:.0f} s", duration / k);
    const Series phase = 2 * std::numbers::pi * k * share;
    shapes.push_back({"time_s", words, phase.cos()});
    shapes.push_back({"time_s", words, phase.sin()});
  }

  const auto powers = [&shapes](const char* channel, const char* word,
                                const std::vector<double>& values, bool bends) {
    if (values.empty()) return;
    const Series x = as_series(values);
    const double half = 0.5 * (x.maxCoeff() - x.minCoeff());
    if (!(half > 0)) return;
    const Series z = (x - 0.5 * (x.maxCoeff() + x.minCoeff())) / half;
    shapes.push_back({channel, fmt::format("in proportion to the {}", word), z});
    if (!bends) return;
    shapes.push_back(
        {channel, fmt::format("with the square of the {}", word), (x / x.maxCoeff()).square()});
    shapes.push_back({channel, fmt::format("bent over the {}", word), z.square()});
    shapes.push_back({channel, fmt::format("with the cube of the {}", word), z.cube()});
  };
  powers("height_m", "height", log.height, true);
  powers("airspeed_m_s", "airspeed", log.airspeed, true);
  // A temperature hardly varies: its powers would be constants, which effects with a name are.
  powers("ambient_temperature_C", "ambient temperature", log.ambient_temperature_C, false);
  return shapes;
}

/// `shape` in stage `k` as rows.
UnnamedRegressor regressor(const PowerResiduals& residuals, std::size_t k, const Shape& shape) {
  const PowerStage& stage = residuals.stages()[k];
  Series column = shape.values;
  if (stage.stage == Stage::tether) column *= as_series(residuals.log().supply_current);
  UnnamedRegressor result{shape.channel, fmt::format("{}: {}", stage.shaped, shape.words),
                          std::vector<double>(residuals.rows(), 0),
                          stage.noise * (stage.stage == Stage::motors ? 100 : 1),
                          stage.shaped_unit};
  residuals.whitened(k, {column.data(), residuals.samples()},
                     std::span(result.column).subspan(stage.first_row, stage.rows));
  return result;
}

}  // namespace

std::vector<UnnamedRegressor> flight_shapes(const Observations& o, double wind) {
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
                                 const Series& column) -> UnnamedRegressor& {
    return regressors.emplace_back(UnnamedRegressor{
        .channel = channel, .shape = words, .column = {column.begin(), column.end()}});
  };
  for (const Shape& shape : shapes) {
    for (const auto& [words, carrier] : carriers) {
      add(shape.channel, shape.words + words, shape.values * carrier).least_gain_factor =
          shape.least_gain_factor;
    }
  }
  add("airspeed_m_s", "the magnitude of the airspeed", u.abs());
  add("airspeed_m_s", "the square of the airspeed", u.square());
  add("airspeed_m_s", "the cube of the airspeed", u.cube());
  add("airspeed_m_s", "the direction of the airspeed",
      (u < 0).select(-Series::Ones(u.size()), 1.0));
  return regressors;
}

std::vector<UnnamedRegressor> power_shapes(const PowerResiduals& residuals) {
  std::vector<UnnamedRegressor> regressors;
  const std::vector<Shape> shapes = shapes_of(residuals.log());
  for (std::size_t k = 0; k < residuals.stages().size(); ++k) {
    for (const Shape& shape : shapes) regressors.push_back(regressor(residuals, k, shape));
  }
  return regressors;
}

bool add_finer_steps(const PowerResiduals& residuals, const std::vector<std::size_t>& found,
                     std::vector<UnnamedRegressor>& shapes) {
  // In every stage the coarse steps come first.
  const std::size_t per_stage = shapes_of(residuals.log()).size();
  bool added = false;
  for (const std::size_t u : found) {
    const std::size_t k = u / per_stage;
    const std::size_t step = u % per_stage;
    if (step + 1 >= coarse_steps) continue;
    const PowerStage& stage = residuals.stages()[k];
    // At most 64 between the neighbours on either side: one every few rows in a long log.
    const double finest = 1.0 / static_cast<double>(stage.rows);
    const double spacing = std::max(finest, 2.0 / coarse_steps / 64);
    const double middle = static_cast<double>(step + 1) / coarse_steps;
    for (double at = middle - 1.0 / coarse_steps + spacing; at < middle + 1.0 / coarse_steps;
         at += spacing) {
      shapes.push_back(regressor(residuals, k, step_at(residuals.log(), at)));
    }
    added = true;
  }
  return added;
}

}  // namespace tethercalc
