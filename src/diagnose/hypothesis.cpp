#include "tethercalc/diagnose/hypothesis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "diagnose/flight_prediction.hpp"
#include "diagnose/power_chain.hpp"

namespace tethercalc {
namespace {

constexpr std::array<FormulaChannel, 14> flight_formula_channels{{
    {"time", "s", "of the log's clock"},
    {"tilt", "rad", "positive leaning forward, as the thrust had it"},
    {"roll", "rad", "positive to the right"},
    {"yaw", "rad", "clockwise from north"},
    {"forward_speed", "m/s", "over ground"},
    {"right_speed", "m/s", "over ground, to the right"},
    {"down_speed", "m/s", "downward"},
    {"height", "m", "above the first sample that is judged"},
    {"airspeed", "m/s", "ahead: forward speed less the headwind found so far"},
    {"airspeed_right", "m/s", "to the right: speed over ground less a measured wind"},
    {"mass", "kg", "of the drone"},
    {"air_density", "kg/m³", "of the air"},
    {"gravity", "m/s²", "of the place"},
    {"yaw_rate", "rad/s", "clockwise"},
}};

constexpr std::array<FormulaChannel, 8> power_formula_channels{{
    {"time", "s", "of the log's clock"},
    {"height", "m", "above the ground station"},
    {"airspeed", "m/s", "as flown"},
    {"power", "W", "predicted at the bus without this effect"},
    {"ambient_temperature", "°C", "measured, else the design's, else 20"},
    {"mass", "kg", "of the drone"},
    {"air_density", "kg/m³", "of the air"},
    {"gravity", "m/s²", "of the place"},
}};

/// Samples of a flight, or of a power log, at which a formula is tried: of all kinds, since one may
/// act only high up, fast or late.
std::vector<std::vector<double>> probes(LogKind kind) {
  if (kind == LogKind::flight) {
    return {{12, 0.15, 0.03, 1.1, 6, 0.4, -0.3, 8, 7, 0.5, 1.6, 1.2, 9.8, 0.1},
            {95, -0.21, -0.05, 4.2, 9, -0.7, 0.6, 23, 8, -0.6, 1.6, 1.2, 9.8, -0.3},
            {240, 0.32, 0.08, 2.7, -11, 1.2, 0.1, 2.5, -10, 1.3, 1.6, 1.2, 9.8, 0.7},
            {410, -0.08, -0.02, 5.9, -3, -0.2, -1.1, 61, -4, -0.1, 1.6, 1.2, 9.8, -0.05},
            {2000, 0.6, -0.5, 0.2, 25, 6, 4, 400, 28, 7, 1.6, 1.2, 9.8, 2},
            {50000, -0.6, 0.5, 3.5, -25, -6, -5, 0, -22, -5, 1.6, 1.2, 9.8, -1.5}};
  }
  return {{12, 8, 2, 310, 21, 1.6, 1.2, 9.8},
          {240, 31, 9, 420, 15, 1.6, 1.2, 9.8},
          {900, 62, 0.5, 380, -4, 1.6, 1.2, 9.8},
          {2000, 300, 25, 1500, 40, 1.6, 1.2, 9.8},
          {50000, 0, 0, 150, -20, 1.6, 1.2, 9.8}};
}

[[noreturn]] void refuse(const Hypothesis& h, const std::string& why) {
  throw std::invalid_argument(fmt::format("the effect \"{}\" {}", h.id, why));
}

std::vector<double> neutral_values(const Hypothesis& h) {
  std::vector<double> values;
  for (const EffectParameter& p : h.parameters) values.push_back(p.neutral);
  return values;
}

void check_parameters(const Hypothesis& h) {
  if (find_effect(h.id) != nullptr) refuse(h, "is one of the catalogue; give it a name of its own");
  if (h.parameters.empty()) refuse(h, "has no parameter");
  for (const EffectParameter& p : h.parameters) {
    if (!(p.lower <= p.neutral && p.neutral <= p.upper && p.lower < p.upper)) {
      refuse(h, fmt::format("must have the neutral value of {} within its bounds: {:g} is not from "
                            "{:g} to {:g}",
                            p.name, p.neutral, p.lower, p.upper));
    }
    if (!(p.scale > 0)) refuse(h, fmt::format("needs a positive scale of {}", p.name));
  }
}

void check_neutral(const Hypothesis& h) {
  const std::vector<double> neutral = neutral_values(h);
  for (const std::vector<double>& probe : probes(h.log)) {
    const double value = h.formula(probe, neutral);
    if (std::abs(value) < 1e-12) continue;
    refuse(h, fmt::format("must change nothing at neutral values, and its formula is {} there",
                          std::isfinite(value) ? fmt::format("{:g}", value) : "no number"));
  }
}

/// Whether the parameter changes the formula while all others are neutral.
bool is_size(const Hypothesis& h, std::size_t k) {
  const double neutral = h.parameters[k].neutral;
  for (const double bound : {h.parameters[k].lower, h.parameters[k].upper}) {
    std::vector<double> values = neutral_values(h);
    values[k] = neutral + 0.5 * (bound - neutral);
    for (const std::vector<double>& probe : probes(h.log)) {
      if (std::abs(h.formula(probe, values)) > 1e-12) return true;
    }
  }
  return false;
}

/// Whether the parameter changes the formula anywhere.
bool acts(const Hypothesis& h, std::size_t k) {
  constexpr double apart = 0.3;  // of the way from neutral to a bound
  std::vector<double> values = neutral_values(h);
  for (std::size_t p = 0; p < values.size(); ++p) {
    const bool above = h.parameters[p].upper > values[p];
    values[p] += apart * ((above ? h.parameters[p].upper : h.parameters[p].lower) - values[p]);
  }
  std::vector<double> others = values;
  others[k] = h.parameters[k].neutral;
  return std::ranges::any_of(probes(h.log), [&](const std::vector<double>& probe) {
    return h.formula(probe, values) != h.formula(probe, others);
  });
}

/// The formula, with parameters in the order of an effect: sizes first.
struct Ordered {
  Hypothesis hypothesis;
  std::vector<std::size_t> place;  ///< in the effect, of each parameter of the formula

  [[nodiscard]] double at(std::span<const double> channels, std::span<const double> values) const {
    std::vector<double> own(place.size());
    for (std::size_t k = 0; k < place.size(); ++k) own[k] = values[place[k]];
    const double value = hypothesis.formula(channels, own);
    if (std::isfinite(value)) return value;
    std::string at;
    for (std::size_t k = 0; k < own.size(); ++k) {
      at += fmt::format(", {} = {:g}", hypothesis.parameters[k].name, own[k]);
    }
    refuse(hypothesis,
           fmt::format("has a formula that is no number at {:.3f} s{}", channels[0], at));
  }
};

void push(const Ordered& ordered, FlightPrediction& p, std::span<const double> values) {
  const FlightRecord& r = p.record;
  for (std::size_t i = 0; i < r.size(); ++i) {
    const std::array<double, flight_formula_channels.size()> channels{
        r.time[i],
        p.thrust.tilt[i],
        std::atan(r.sideward_thrust[i] * std::cos(r.tilt[i])),
        r.yaw[i],
        r.forward_speed[i],
        r.right_speed[i],
        r.down_speed[i],
        r.height[i],
        p.airspeed[i],
        p.aside[i],
        r.mass,
        r.air_density,
        r.gravity,
        r.yaw_rate[i]};
    p.drag[i] -= ordered.at(channels, values);
  }
}

void draw(const Ordered& ordered, PowerModel& m, std::span<const double> values) {
  m.added_power.push_back(
      [ordered, own = std::vector<double>(values.begin(), values.end())](
          const PowerModel& model, const PowerLog& log, std::size_t i, double power) {
        const Flight& flight = model.design.flight;
        const std::optional<double> ambient = model.design.tether.ambient_temperature_C;
        const std::array<double, power_formula_channels.size()> channels{
            log.time[i],
            log.height.empty() ? 0 : log.height[i],
            log.airspeed[i],
            power,
            log.ambient_temperature_C.empty() ? ambient.value_or(20) : log.ambient_temperature_C[i],
            model.design.drone.mass,
            flight.air_density,
            flight.gravity};
        return ordered.at(channels, own);
      });
}

}  // namespace

std::span<const FormulaChannel> formula_channels(LogKind kind) {
  if (kind == LogKind::flight) return flight_formula_channels;
  return power_formula_channels;
}

Effect effect_of(const Hypothesis& hypothesis) {
  check_parameters(hypothesis);
  check_neutral(hypothesis);
  Effect effect{.id = hypothesis.id,
                .title = hypothesis.title,
                .mechanism = hypothesis.mechanism,
                .log = hypothesis.log,
                .sizes = 0,
                .to_separate = hypothesis.to_separate,
                .change = hypothesis.words};
  Ordered ordered{hypothesis, std::vector<std::size_t>(hypothesis.parameters.size())};
  for (const bool sizes : {true, false}) {
    for (std::size_t k = 0; k < hypothesis.parameters.size(); ++k) {
      if (is_size(hypothesis, k) != sizes) continue;
      ordered.place[k] = effect.parameters.size();
      effect.parameters.push_back(hypothesis.parameters[k]);
      effect.sizes += sizes ? 1 : 0;
    }
  }
  if (effect.sizes == 0) {
    refuse(hypothesis,
           "has no parameter that changes its formula by itself: of a size times a "
           "shape, the shape needs a neutral value that lets the size act");
  }
  for (std::size_t k = 0; k < hypothesis.parameters.size(); ++k) {
    if (acts(hypothesis, k)) continue;
    refuse(hypothesis, fmt::format("has a formula that {} does not change: no log can tell its "
                                   "value",
                                   hypothesis.parameters[k].name));
  }
  if (hypothesis.log == LogKind::flight) {
    effect.channel = "forward_speed";
    effect.on_flight = [ordered](FlightPrediction& p, std::span<const double> values) {
      push(ordered, p, values);
    };
  } else {
    effect.stage = Stage::motors;
    effect.shows_in = {Stage::motors};
    effect.needs = {"bus_voltage_V", "bus_current_A"};
    effect.channel = "airspeed";
    effect.on_power = [ordered](PowerModel& m, std::span<const double> values) {
      draw(ordered, m, values);
    };
  }
  return effect;
}

std::vector<const Effect*> effects_for(LogKind kind, std::span<const Effect> hypotheses) {
  std::vector<const Effect*> effects;
  for (const Effect& effect : effect_catalogue(kind)) effects.push_back(&effect);
  for (const Effect& effect : hypotheses) {
    if (effect.log == kind) effects.push_back(&effect);
  }
  return effects;
}

}  // namespace tethercalc
