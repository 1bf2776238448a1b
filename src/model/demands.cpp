#include "tethercalc/model/demands.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tethercalc/model/drum_package.hpp"

namespace tethercalc {
namespace {

using OptionalMargin = std::optional<double>;  ///< nothing: not asked for

/// How much more of something there is than is needed; −1 where either does not exist.
double excess(double have, double need) {
  const double ratio = have / need;
  return std::isfinite(ratio) ? ratio - 1 : -1;
}

OptionalMargin tether_shape(const Design& design, const OperatingPoint& point, Condition) {
  if (design.tether.model == TetherModel::straight) return std::nullopt;
  return std::isnan(point.tether_tension) ? -1.0 : 1.0;
}

OptionalMargin takeoff_mass(const Design& design, const OperatingPoint& point, Condition) {
  if (design.drone.reserve_battery.specific_energy == 0) return std::nullopt;
  return std::isfinite(point.battery_mass) ? 1.0 : -1.0;
}

OptionalMargin max_pitch(const Design& design, const OperatingPoint& point, Condition) {
  if (std::isinf(point.battery_mass)) return std::nullopt;
  if (std::isnan(point.pitch)) return -1.0;
  return 1 - std::abs(point.pitch) / design.requirements.max_pitch;
}

OptionalMargin input_voltage(const Design& design, const OperatingPoint&, Condition) {
  const Converter& converter = design.supply.converter;
  const double voltage = design.supply.voltage;
  const double lowest = lowest_input_voltage(converter);
  const double above = lowest > 0 ? excess(voltage, lowest) : 1;
  return converter.max_input_voltage
             ? std::min(above, excess(*converter.max_input_voltage, voltage))
             : above;
}

OptionalMargin drum_width(const Design& design, const OperatingPoint& point, Condition) {
  const Tether& tether = design.tether;
  if (tether.drum.width == 0) return std::nullopt;
  const double wall = insulation_wall(tether.insulation, design.supply.voltage);
  return excess(tether.drum.width, wound_side(tether, conductor_radius(point.cross_section), wall));
}

OptionalMargin thrust_headroom(const Design& design, const OperatingPoint& point,
                               Condition condition) {
  return excess(point.headroom, demanded_headroom(design.requirements, condition));
}

/// On a scale like that of the other margins: a hundred kelvin are 1.
OptionalMargin heat(const Design& design, const OperatingPoint& point, double temperature) {
  if (!is_heated(design.tether)) return std::nullopt;
  if (point.thermal_runaway) return -1.0;
  // Where the power cannot be delivered at all, heat is not to blame.
  const std::optional<double> rated = design.tether.insulation.rated_temperature_C;
  if (!rated || std::isnan(temperature)) return std::nullopt;
  return (*rated - temperature) / 100;
}

OptionalMargin conductor_temperature(const Design& design, const OperatingPoint& point, Condition) {
  return heat(design, point, point.conductor_temperature);
}

OptionalMargin drum_temperature(const Design& design, const OperatingPoint& point, Condition) {
  return point.thermal_runaway ? std::nullopt : heat(design, point, point.drum_temperature);
}

OptionalMargin tether_strength(const Design& design, const OperatingPoint& point, Condition) {
  const double factor = design.requirements.strength_safety_factor;
  if (factor == 0) return std::nullopt;
  return excess(breaking_load(design.tether, point.cross_section), factor * point.tether_tension);
}

OptionalMargin converter_rating(const Design& design, const OperatingPoint& point, Condition) {
  const Converter& converter = design.supply.converter;
  if (!converter.rated_output_power) return std::nullopt;
  return excess(*converter.rated_output_power, power_behind_converter(design, point));
}

struct DemandEntry {
  Demand demand;
  std::string_view name;
  OptionalMargin (*margin)(const Design&, const OperatingPoint&, Condition);
};

/// In the order of `Demand`.
constexpr std::array<DemandEntry, demand_count> demands{
    {{Demand::tether_shape, "tether_shape", tether_shape},
     {Demand::takeoff_mass, "takeoff_mass", takeoff_mass},
     {Demand::max_pitch, "max_pitch", max_pitch},
     {Demand::input_voltage, "input_voltage", input_voltage},
     {Demand::drum_width, "drum_width", drum_width},
     {Demand::thrust_headroom, "thrust_headroom", thrust_headroom},
     {Demand::conductor_temperature, "conductor_temperature", conductor_temperature},
     {Demand::drum_temperature, "drum_temperature", drum_temperature},
     {Demand::tether_strength, "tether_strength", tether_strength},
     {Demand::converter_rating, "converter_rating", converter_rating}}};

void add_margins(const Design& design, const OperatingPoint& point, Condition condition,
                 Margins& margins) {
  for (const DemandEntry& entry : demands) {
    if (const auto value = entry.margin(design, point, condition)) {
      margins.add({entry.demand, condition, *value});
    }
  }
}

}  // namespace

std::string_view demand_name(Demand demand) {
  return demands[static_cast<std::size_t>(demand)].name;
}

const DemandMargin& Margins::worst() const {
  // What a converter's rating caps misses its headroom by the same, and the rating is the cause.
  const auto rank = [](const DemandMargin& margin) {
    const bool caps = margin.demand == Demand::converter_rating && margin.value > -1;
    return caps ? 2 * static_cast<int>(Demand::thrust_headroom) - 1
                : 2 * static_cast<int>(margin.demand);
  };
  constexpr double same = 1e-12;
  const DemandMargin* worst = begin();
  for (const DemandMargin& margin : *this) {
    const double more = margin.value - worst->value;
    if (more < -same || (more <= same && rank(margin) < rank(*worst))) worst = &margin;
  }
  return *worst;
}

bool is_headroom_demanded(const Requirements& requirements, Condition condition) {
  return condition == requirements.headroom_at && !requirements.buffer_battery;
}

double demanded_headroom(const Requirements& requirements, Condition condition) {
  return is_headroom_demanded(requirements, condition) ? requirements.thrust_headroom : 1;
}

Margins demand_margins(const Design& design, const OperatingPoint& hover,
                       const OperatingPoint& forward) {
  Margins margins;
  add_margins(design, hover, Condition::hover, margins);
  add_margins(design, forward, Condition::forward, margins);
  return margins;
}

Margins demand_margins(const Design& design, const OperatingPoint& point, Condition condition) {
  Margins margins;
  add_margins(design, point, condition, margins);
  return margins;
}

}  // namespace tethercalc
