#include "diagnose/unnamed_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <tuple>
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
  std::string formula{};  ///< of the values, over `formula_channels`
};

bool varies(const Series& x) { return (x != x[0]).any(); }

/// `x` is the channel that formulas call `variable`.
void add_powers(std::vector<Shape>& shapes, const std::string& channel, const std::string& name,
                const Series& x, const std::string& variable) {
  if (!varies(x)) return;
  shapes.push_back({channel, name, x, 1, variable});
  shapes.push_back({channel, "the magnitude of the " + name, x.abs(), 1, "abs(" + variable + ")"});
  shapes.push_back({channel, "the square of the " + name, x.square(), 1, variable + "^2"});
}

/// Steps are so near to each other that one between two of them explains no less than an effect
/// with a name whose moment is fitted. They are zero before they happen: half of one on either side
/// would need a constant effect to cancel the first.
constexpr int step_places = 128;
/// As for effects whose moment is looked for: some moment always shows a little.
constexpr double gain_of_steps = 5;

void add_time(std::vector<Shape>& shapes, const Series& time, const Series& tilt) {
  const double begin = time[0];
  const double duration = time[time.size() - 1] - begin;
  const Series elapsed = (time - begin) / duration - 0.5;
  const std::string part =
      fmt::format("((time - {:.3f}) / {:.3f})", begin + duration / 2, duration);
  shapes.push_back({"time_s", "time, steadily", elapsed, 1, part});
  // As where what the attitude reads of an angle changes.
  shapes.push_back({"time_s", "pitch times time", tilt * elapsed, 1, "tilt * " + part});
  shapes.push_back({"time_s", "the square of the time from the middle of the flight",
                    elapsed.square(), 1, part + "^2"});
  for (int k = 1; k < step_places; ++k) {
    const double at = begin + duration * k / step_places;
    shapes.push_back({"time_s", fmt::format("a step at about {:.0f} s", at),
                      (time >= at).cast<double>(), gain_of_steps,
                      fmt::format("(time >= {:.3f})", at)});
  }
}

/// Steps that are tried throughout the log.
constexpr int coarse_steps = 40;

constexpr double fastest_wave = 30;  // s, of which the motors' rows of 8 s see the half

Shape step_at(const PowerLog& log, double share) {
  const double at = log.time.front() + share * (log.time.back() - log.time.front());
  return {"time_s", fmt::format("a step at {:.0f} s", at),
          (as_series(log.time) >= at).cast<double>(), 1, fmt::format("(time >= {:.3f})", at)};
}

std::vector<Shape> shapes_of(const PowerLog& log) {
  const double duration = log.time.back() - log.time.front();
  const Series share = (as_series(log.time) - log.time.front()) / duration;
  std::vector<Shape> shapes;
  for (int k = 1; k < coarse_steps; ++k) {
    shapes.push_back(step_at(log, static_cast<double>(k) / coarse_steps));
  }
  const std::string part = fmt::format("(time - {:.3f}) / {:.3f}", log.time.front(), duration);
  shapes.push_back({"time_s", "a steady drift", share, 1, part});
  const int half_turns =
      static_cast<int>(std::min<double>(most_half_turns, 2 * duration / fastest_wave));
  for (int k = 2; k <= half_turns; ++k) {
    const std::string words = fmt::format("a wave of {:.0f} s", 2 * duration / k);
    const Series phase = std::numbers::pi * k * share;
    const std::string turns = fmt::format("({} * _pi * {})", k, part);
    shapes.push_back({"time_s", words, phase.cos(), 1, "cos" + turns});
    shapes.push_back({"time_s", words, phase.sin(), 1, "sin" + turns});
  }

  const auto powers = [&shapes](const char* channel, const char* word, const char* variable,
                                const std::vector<double>& values, bool bends) {
    if (values.empty()) return;
    const Series x = as_series(values);
    const double middle = 0.5 * (x.maxCoeff() + x.minCoeff());
    const double half = 0.5 * (x.maxCoeff() - x.minCoeff());
    if (!(half > 0)) return;
    const Series z = (x - middle) / half;
    const std::string scaled = fmt::format("(({} - {:.6g}) / {:.6g})", variable, middle, half);
    shapes.push_back({channel, fmt::format("in proportion to the {}", word), z, 1, scaled});
    if (!bends) return;
    shapes.push_back({channel, fmt::format("with the square of the {}", word),
                      (x / x.maxCoeff()).square(), 1,
                      fmt::format("({} / {:.6g})^2", variable, x.maxCoeff())});
    shapes.push_back(
        {channel, fmt::format("bent over the {}", word), z.square(), 1, scaled + "^2"});
    shapes.push_back(
        {channel, fmt::format("with the cube of the {}", word), z.cube(), 1, scaled + "^3"});
  };
  powers("height_m", "height", "height", log.height, true);
  powers("airspeed_m_s", "airspeed", "airspeed", log.airspeed, true);
  // A temperature hardly varies: its powers would be constants, which effects with a name are.
  powers("ambient_temperature_C", "ambient temperature", "ambient_temperature",
         log.ambient_temperature_C, false);
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
  if (stage.stage == Stage::motors) {
    result.formula = "power * c * " + shape.formula;
    result.formula_unit = stage.noise;
  }
  return result;
}

}  // namespace

std::vector<UnnamedRegressor> flight_shapes(const Observations& o, const FlightRecord& record,
                                            double wind, Axis axis) {
  const bool forward = axis == Axis::forward;
  std::vector<Shape> shapes;
  // To the right the drone leans by its roll against the very gusts that are left.
  if (forward) add_powers(shapes, "roll_deg", "roll", as_series(o.roll), "roll");
  add_powers(shapes, "pitch_deg", "pitch", as_series(o.tilt), "tilt");
  add_powers(shapes, "lateral_speed_m_s", "lateral speed", as_series(o.right_speed), "right_speed");
  add_powers(shapes, "vd_m_s", "vertical speed", as_series(o.down_speed), "down_speed");
  if (varies(as_series(o.down_speed))) {
    const Series height = as_series(record.height) - record.mean_height;
    const std::string above = fmt::format("(height - {:.3f})", record.mean_height);
    shapes.push_back({"height_m", "height", height, 1, above});
    shapes.push_back(
        {"height_m", "the square of the height from its mean", height.square(), 1, above + "^2"});
  }
  if (const Series yaw = as_series(o.yaw); varies(yaw)) {
    shapes.push_back({"yaw_deg", "the cosine of the yaw", yaw.cos(), 1, "cos(yaw)"});
    shapes.push_back({"yaw_deg", "the sine of the yaw", yaw.sin(), 1, "sin(yaw)"});
    // As iron beside a compass bends what it reads twice a turn.
    shapes.push_back(
        {"yaw_deg", "the cosine of twice the yaw", (2 * yaw).cos(), 1, "cos(2 * yaw)"});
    shapes.push_back({"yaw_deg", "the sine of twice the yaw", (2 * yaw).sin(), 1, "sin(2 * yaw)"});
  }
  add_powers(shapes, "yaw_deg", "yaw rate", as_series(record.yaw_rate), "yaw_rate");
  if (forward) add_time(shapes, as_series(o.time), as_series(o.tilt));

  const Series u = as_series(o.forward_speed) - wind;
  const std::tuple<const char*, const char*, Series> carriers[] = {
      {"", "", Series::Ones(u.size())},
      {", times the airspeed", " * airspeed", u},
      {", times the magnitude of the airspeed", " * abs(airspeed)", u.abs()},
      {", times the airspeed and its magnitude", " * airspeed * abs(airspeed)", u * u.abs()}};
  const Series across = as_series(forward ? o.roll : o.tilt);
  std::vector<UnnamedRegressor> regressors;
  const auto add = [&regressors, forward](const std::string& channel, const std::string& words,
                                          const Series& column,
                                          const std::string& formula) -> UnnamedRegressor& {
    return regressors.emplace_back(UnnamedRegressor{
        .channel = channel,
        .shape = words,
        .column = {column.begin(), column.end()},
        .formula = forward ? "mass * c * " + formula : "",
        .quantity = forward ? "the forward acceleration" : "the acceleration to the right"});
  };
  for (const Shape& shape : shapes) {
    for (const auto& [words, factor, carrier] : carriers) {
      add(shape.channel, shape.words + words, shape.values * carrier, shape.formula + factor)
          .least_gain_factor = shape.least_gain_factor;
    }
    if (shape.channel != "yaw_deg") continue;
    // A heading that is off carries what the thrust does across into this axis.
    add(shape.channel, shape.words + ", times the lean across", shape.values * across,
        shape.formula + (forward ? " * roll" : " * tilt"));
  }
  add("airspeed_m_s", "the magnitude of the airspeed", u.abs(), "abs(airspeed)");
  add("airspeed_m_s", "the square of the airspeed", u.square(), "airspeed^2");
  add("airspeed_m_s", "the cube of the airspeed", u.cube(), "airspeed^3");
  add("airspeed_m_s", "the direction of the airspeed", (u < 0).select(-Series::Ones(u.size()), 1.0),
      "sign(airspeed)");
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
