#include "tethercalc/report/cable_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "model/constants.hpp"
#include "report/result_values.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc {
namespace {

ordered_json temperatures_json(const OperatingPoint& point) {
  return {{"conductor_temperature_C", number_or_null(point.conductor_temperature)},
          {"drum_temperature_C", number_or_null(point.drum_temperature)},
          {"runaway", point.thermal_runaway}};
}

double breakdown_voltage(const Design& design) {
  const Insulation& insulation = design.tether.insulation;
  return insulation.breakdown_strength * insulation_wall(insulation, design.supply.voltage);
}

std::string temperature_words(const char* condition, const OperatingPoint& point) {
  if (point.thermal_runaway) return fmt::format("runs away in {}", condition);
  if (std::isnan(point.conductor_temperature)) return fmt::format("has none in {}", condition);
  std::string words = fmt::format("{} °C in {}", fixed(point.conductor_temperature, 1), condition);
  if (!std::isnan(point.drum_temperature)) {
    words += fmt::format(" ({} °C on the drum)", fixed(point.drum_temperature, 1));
  }
  return words;
}

double output_voltage(const Design& design, const OperatingPoint& point) {
  return converter_output_voltage(design.supply.converter, point.received_voltage);
}

std::string battery_sentence(const Design& design, const OperatingPoint& point) {
  const ReserveBattery& battery = design.drone.reserve_battery;
  const double seconds = landing_time(battery, design.tether.length);
  if (!std::isfinite(point.battery_mass)) {
    return fmt::format(
        "No reserve battery could land the drone from {} m: it could not carry itself.",
        significant(design.tether.length, 3));
  }
  const double power = landing_power(design.drone, point.takeoff_mass, design.flight.gravity);
  const bool by_energy = seconds / battery.usable_share >= 1 / battery.discharge_rate;
  constexpr double joules_per_Wh = 3600;
  return fmt::format(
      "A reserve battery of {} g ({} Wh) lands it from {} m within {} s at {} W; {} makes it so "
      "large.",
      significant(point.battery_mass / unit::gram, 3),
      significant(point.battery_mass * battery.specific_energy / joules_per_Wh, 3),
      significant(design.tether.length, 3), significant(seconds, 3), significant(power, 3),
      by_energy ? "its energy" : "its discharge rate");
}

std::string converter_sentence(const Design& design, const AreaPoints& points) {
  const Converter& converter = design.supply.converter;
  const auto volts = [&](const OperatingPoint& point) {
    const double voltage = output_voltage(design, point);
    return std::isfinite(voltage) ? significant(voltage, 3) + " V" : std::string("no voltage");
  };
  return fmt::format(
      "The motors get {} in hover and {} in forward flight behind the fixed ratio of {}{}; "
      "without load {} V.",
      volts(points.hover), volts(points.forward), significant(*converter.fixed_ratio, 4),
      converter.min_output_voltage > 0
          ? fmt::format(", and need {} V", significant(converter.min_output_voltage, 3))
          : "",
      significant(converter_output_voltage(converter, design.supply.voltage), 3));
}

ordered_json battery_json(const Design& design, const OperatingPoint& point) {
  const ReserveBattery& battery = design.drone.reserve_battery;
  if (battery.specific_energy == 0) return nullptr;
  return {{"mass_g", number_or_null(point.battery_mass / unit::gram)},
          {"landing_time_s", landing_time(battery, design.tether.length)},
          {"landing_power_W",
           number_or_null(landing_power(design.drone, point.takeoff_mass, design.flight.gravity))}};
}

ordered_json converter_json(const Design& design, const AreaPoints& points) {
  const Converter& converter = design.supply.converter;
  const double mass = converter_mass(converter);
  return {{"mass_g", mass / unit::gram},
          {"hover_output_voltage_V", number_or_null(output_voltage(design, points.hover))},
          {"forward_output_voltage_V", number_or_null(output_voltage(design, points.forward))}};
}

/// A range of direct voltages by what protects people from it.
struct VoltageClass {
  std::string_view name;
  double up_to = 0;  ///< V, the highest of the class
  std::string_view sentence;
};

VoltageClass voltage_class(double voltage) {
  static constexpr std::array classes{
      VoltageClass{"touchable_elv", 60,
                   "extra-low voltage at or below 60 V DC, which in dry places needs no protection "
                   "against touch"},
      VoltageClass{
          "elv", 120,
          "extra-low voltage at or below 120 V DC: live parts must be insulated or covered"},
      VoltageClass{
          "low_voltage", 1500,
          "low voltage above the extra-low limit of 120 V DC: insulation, fault protection "
          "and disconnection are mandatory"},
      VoltageClass{"high_voltage", infinity, "high voltage above 1500 V DC"}};
  return *std::find_if(classes.begin(), classes.end(),
                       [voltage](const VoltageClass& c) { return voltage <= c.up_to; });
}

}  // namespace

ordered_json voltage_class_json(double voltage) {
  const VoltageClass found = voltage_class(voltage);
  return {{"name", found.name}, {"sentence", found.sentence}};
}

ordered_json thermal_json(const Design& design, const AreaPoints& points) {
  const Tether& tether = design.tether;
  if (!tether.ambient_temperature_C) return nullptr;
  return {{"ambient_temperature_C", *tether.ambient_temperature_C},
          {"rated_temperature_C", number_or_null(tether.insulation.rated_temperature_C)},
          {"hover", temperatures_json(points.hover)},
          {"forward", temperatures_json(points.forward)}};
}

ordered_json cable_json(const Design& design, const AreaPoints& points) {
  const double load = breaking_load(design.tether, points.area);
  const double breakdown = breakdown_voltage(design);
  return {{"tension_N",
           number_or_null(std::max(points.hover.tether_tension, points.forward.tether_tension))},
          {"breaking_load_N", number_or_null(load > 0 ? load : nan)},
          {"required_safety_factor", design.requirements.strength_safety_factor},
          {"wall_mm",
           insulation_wall(design.tether.insulation, design.supply.voltage) / unit::millimetre},
          {"breakdown_voltage_V", number_or_null(breakdown > 0 ? breakdown : nan)},
          {"converter", converter_json(design, points)},
          {"reserve_battery", battery_json(design, points.hover)}};
}

std::vector<std::string> cable_sentences(const Design& design, const AreaPoints& points) {
  std::vector<std::string> sentences;
  const Tether& tether = design.tether;
  if (tether.ambient_temperature_C) {
    const auto rated = tether.insulation.rated_temperature_C;
    sentences.push_back(fmt::format(
        "In air of {} °C the conductor's temperature is {} and {}; the insulation is {}.",
        significant(*tether.ambient_temperature_C, 3), temperature_words("hover", points.hover),
        temperature_words("forward flight", points.forward),
        rated ? fmt::format("rated for {} °C", significant(*rated, 3))
              : std::string("of no known rating")));
  }
  if (design.requirements.strength_safety_factor > 0) {
    const double tension = std::max(points.hover.tether_tension, points.forward.tether_tension);
    const double load = breaking_load(tether, points.area);
    sentences.push_back(
        fmt::format("The tether pulls at the drone with {} N and breaks at {} N, {} times that.",
                    significant(tension, 3), significant(load, 3), significant(load / tension, 3)));
  }
  if (tether.insulation.dielectric_safety_factor > 0) {
    sentences.push_back(fmt::format(
        "The wall of {} mm breaks down at {} V in a short test, {} times the supply.",
        significant(insulation_wall(tether.insulation, design.supply.voltage) / unit::millimetre,
                    3),
        significant(breakdown_voltage(design), 3),
        significant(breakdown_voltage(design) / design.supply.voltage, 3)));
  }
  if (const double mass = converter_mass(design.supply.converter); mass > 0) {
    sentences.push_back(fmt::format("The converter for {} W weighs {} g, beside the drone's mass.",
                                    significant(*design.supply.converter.rated_output_power, 4),
                                    significant(mass / unit::gram, 3)));
  }
  if (design.supply.converter.fixed_ratio) {
    sentences.push_back(converter_sentence(design, points));
  }
  if (design.drone.reserve_battery.specific_energy > 0) {
    sentences.push_back(battery_sentence(design, points.hover));
  }
  sentences.push_back(fmt::format("{} V is {}.", significant(design.supply.voltage, 3),
                                  voltage_class(design.supply.voltage).sentence));
  return sentences;
}

std::vector<std::string> cable_warnings(const Design& design) {
  std::vector<std::string> warnings;
  const Tether& tether = design.tether;
  if (!tether.ambient_temperature_C) return warnings;
  if (tether.spooled_length > 0 && !drum_derating(tether.drum)) {
    warnings.push_back(fmt::format(
        "{} m lie on a drum of which neither layers nor derating are stated: the wound part is the "
        "hot one, and its temperature is not known (tether.drum.layers or tether.drum.derating)",
        significant(tether.spooled_length, 3)));
  }
  if (!tether.insulation.rated_temperature_C) {
    warnings.push_back(
        "the rated temperature of the insulation is not known, so that heat limits nothing "
        "(rated_temperature_C of the material)");
  }
  return warnings;
}

std::vector<std::string> all_warnings(const DesignFile& file) {
  std::vector<std::string> warnings = file.warnings;
  for (std::string& warning : cable_warnings(file.design)) warnings.push_back(std::move(warning));
  return warnings;
}

}  // namespace tethercalc
