#include "tethercalc/report/design_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <utility>

#include "model/constants.hpp"
#include "report/result_values.hpp"
#include "tethercalc/model/conductor_heat.hpp"
#include "tethercalc/model/drum_package.hpp"
#include "tethercalc/model/tether_load.hpp"

namespace tethercalc {
namespace {

std::string headroom_words(double headroom) {
  return headroom > 1 ? fmt::format("a thrust headroom of {}", significant(headroom, 3))
                      : std::string("level flight");
}

/// A headroom that falls short, to as many digits as show it.
std::string headroom_below(double demanded, double headroom) {
  std::string words;
  for (int digits = 3; digits <= 10; ++digits) {
    words = significant(headroom, digits);
    if (std::strtod(words.c_str(), nullptr) < demanded) break;
  }
  return words;
}

/// What is said of a limit. In place of the names in braces stands what `filled_in` puts there.
struct LimitWords {
  const char* of_optimum;   ///< why the optimum is where it is
  const char* of_refusal;   ///< why there is none, where neither power nor weight says it
  const char* of_demand;    ///< what binds
  const char* beyond = "";  ///< what happens further on, where it is not the headroom that ends
  std::string_view in_short = "";  ///< why there is no optimum, where it is not the headroom
};

/// Of all but the least power, in the order of `Limit`.
constexpr LimitWords all_limits[] = {
    {"Limited by the power that reaches the drone: any thinner, and it does not suffice for "
     "{demand}.",
     "", "The thrust headroom of {headroom} in {where}"},
    {"Limited by weight: any thicker, and the tether is too heavy for {demand}.", "",
     "The take-off mass"},
    {"Limited by the motors: they make no more thrust for {demand}.", "",
     "The motors' greatest thrust"},
    {"Limited by the tilt: {tilt} degrees in {where} is the most allowed.", "",
     "The largest tilt of {tilt}°", "the tilt passes its limit in {where}"},
    {"Limited by heat: any thinner, and the conductor is hotter in {where} than the {rated_C} °C "
     "for which its insulation is rated.",
     "No cross-section that meets the other demands stays below the insulation's rated {rated_C} "
     "°C in {where}, or none has a steady temperature at all.",
     "The insulation's rated {rated_C} °C",
     "the conductor gets hotter than its insulation is rated for in {where}", "conductor too hot"},
    {"Limited by strength: the tether would not hold {factor} times its tension in {where}.",
     "No cross-section that meets the other demands holds {factor} times the tension in {where}; "
     "{member} would.",
     "The tether's strength of {factor} times its tension",
     "the tether no longer holds its tension with the factor asked for in {where}",
     "tether too weak"},
    {"Limited by the converter: any thicker, and lifting the tether in {where} takes more than its "
     "rated {rated_W} W.",
     "No cross-section that meets the other demands leaves the converter within its rated "
     "{rated_W} W in {where}.",
     "The converter's rated {rated_W} W", "the converter's rating is passed in {where}",
     "converter too small"},
    {"",  // the same at every cross-section: nothing that an optimum lies on
     "No cross-section works: a supply of {voltage} V is outside the converter's range.",
     "The converter's highest input of {highest_input} V",
     "the supply is outside the converter's range", "supply outside the converter's range"},
    {"Limited by the tether: any {further}, and {no_way}.",
     "No cross-section works: with {asked}, {no_way}.", "The tether's way up to the drone",
     "{no_way}", "no way up for the tether"},
    {"Limited by the drum: any thicker, and no turn of the tether fits into its {drum_mm} mm of "
     "width.",
     "No cross-section that meets the other demands has a turn that fits into the drum's {drum_mm} "
     "mm of width.",
     "The drum's width of {drum_mm} mm", "no turn of the tether fits between the drum's flanges",
     "drum too narrow"}};

static_assert(std::size(all_limits) + 1 == limit_count);

const LimitWords& limit_words(Limit limit) { return all_limits[static_cast<int>(limit) - 1]; }

/// How much cable there is, where a drum holds the rest, and what a winch pulls.
std::string cable_words(const Tether& tether) {
  std::string words;
  if (tether.spooled_length > 0) {
    words = fmt::format(" with the {} m of cable there are",
                        significant(tether.length + tether.spooled_length, 3));
  }
  if (hangs_on_winch(tether)) {
    words += fmt::format(" at the winch's {} N", significant(tether.winch_pull, 3));
  }
  return words;
}

/// Why a tether does not hang up to its drone.
std::string no_way_words(const Design& design, const std::optional<NoWayUp>& no_way,
                         Condition condition) {
  const Tether& tether = design.tether;
  const std::string up = "up to the drone in " + condition_words(condition);
  if (no_way && no_way->outcome == CableOutcome::tension_too_low) {
    return fmt::format("the winch's {} N cannot hold the tether {}",
                       significant(tether.winch_pull, 3), up);
  }
  if (no_way && no_way->needed > 0) {
    const double there_are = tether.length + tether.spooled_length;
    int digits = 4;
    while (digits < 9 && significant(no_way->needed, digits) == significant(there_are, digits)) {
      ++digits;
    }
    return fmt::format("{} m of cable are needed {}, and there are {} m",
                       significant(no_way->needed, digits), up, significant(there_are, digits));
  }
  return "no way is found for the tether to hang " + up + cable_words(tether);
}

std::string asked_words(double area) {
  return fmt::format("{:.3g} mm²", area / unit::square_millimetre) +
         (area == usual_area ? ", a usual size" : "");
}

/// `words` with the design's numbers, and what stands in the tether's way, in place of their names;
/// `area` in m² is that of the optimum which they are of.
std::string filled_in(const char* words, const Design& design, Condition condition,
                      const std::optional<NoWayUp>& no_way = {}, double area = 0) {
  const Requirements& need = design.requirements;
  const Converter& converter = design.supply.converter;
  const double demanded = demanded_headroom(need, condition);
  const std::string where = condition_words(condition);
  return fmt::format(
      fmt::runtime(words), fmt::arg("where", where),
      fmt::arg("no_way", no_way_words(design, no_way, condition)),
      fmt::arg("asked", no_way ? asked_words(no_way->area) : ""),
      fmt::arg("further", no_way && no_way->area < area ? "thinner" : "thicker"),
      fmt::arg("demand", headroom_words(demanded) + " in " + where),
      fmt::arg("headroom", fixed(demanded, 2)),
      fmt::arg("tilt", significant(need.max_pitch / unit::degree, 3)),
      fmt::arg("drum_mm", significant(design.tether.drum.width / unit::millimetre, 4)),
      fmt::arg("rated_C", significant(design.tether.insulation.rated_temperature_C.value_or(
                                          highest_conductor_temperature_C),
                                      3)),
      fmt::arg("member", strength_member_data(design.tether.strength_member).mass_per_metre > 0
                             ? "a thicker strength member"
                             : "a strength member"),
      fmt::arg("factor", significant(need.strength_safety_factor, 3)),
      fmt::arg("rated_W", significant(converter.rated_output_power.value_or(0), 4)),
      fmt::arg("voltage", significant(design.supply.voltage, 4)),
      fmt::arg("highest_input", significant(converter.max_input_voltage.value_or(0), 4)));
}

ordered_json temperatures_json(const OperatingPoint& point) {
  return {{"conductor_temperature_C", number_or_null(point.conductor_temperature)},
          {"drum_temperature_C", number_or_null(point.drum_temperature)},
          {"runaway", point.thermal_runaway}};
}

std::string temperature_words(const char* condition, const OperatingPoint& point) {
  if (point.thermal_runaway) return fmt::format("rising without end in {}", condition);
  if (std::isnan(point.conductor_temperature)) {
    return fmt::format("unknown in {}, which is not flown", condition);
  }
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
  if (!std::isfinite(point.battery_mass)) {
    return fmt::format(
        "No reserve battery could land the drone from {} m: it could not carry itself.",
        significant(design.tether.length, 3));
  }
  const double power = landing_power(battery, point.battery_mass, design.tether.length);
  constexpr double joules_per_Wh = 3600;
  // Sized for the cable's weight and its drag hanging straight.
  const double hover = design.drone.auxiliary_power + power_behind_converter(design, point);
  constexpr double clearly_more = 1.01;
  const std::string falls_short =
      hover > clearly_more * power
          ? fmt::format(" Where the cable pulls as in hover the drone takes {} W.",
                        significant(hover, 3))
          : "";
  return fmt::format(
      "A reserve battery of {} g ({} Wh) lands it from {} m within {} s at {} W; {} makes it so "
      "large.{}",
      significant(point.battery_mass / unit::gram, 3),
      significant(point.battery_mass * battery.specific_energy / joules_per_Wh, 3),
      significant(design.tether.length, 3),
      significant(landing_time(battery, design.tether.length), 3), significant(power, 3),
      is_sized_by_energy(battery, design.tether.length) ? "its energy" : "its discharge rate",
      falls_short);
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
           number_or_null(landing_power(battery, point.battery_mass, design.tether.length))}};
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

constexpr std::array voltage_classes{
    VoltageClass{"touchable_elv", 60,
                 "extra-low voltage at or below 60 V DC, which in dry places needs no protection "
                 "against touch"},
    VoltageClass{"elv", 120,
                 "extra-low voltage at or below 120 V DC: live parts must be insulated or covered"},
    VoltageClass{"low_voltage", 1500,
                 "low voltage above the extra-low limit of 120 V DC: insulation, fault protection "
                 "and disconnection are mandatory"},
    VoltageClass{"high_voltage", infinity, "high voltage above 1500 V DC"}};

VoltageClass voltage_class(double voltage) {
  return *std::ranges::lower_bound(voltage_classes, voltage, {}, &VoltageClass::up_to);
}

}  // namespace

std::string condition_words(Condition condition) {
  return condition == Condition::hover ? "hover" : "forward flight";
}

std::string limit_in_short(Limit limit) {
  static constexpr std::array words{"least power",    "power that arrives",
                                    "take-off mass",  "motors",
                                    "tilt",           "heat",
                                    "strength",       "converter's rating",
                                    "supply voltage", "tether's way up",
                                    "drum's width"};
  return words.at(static_cast<std::size_t>(limit));
}

namespace {

/// The published method takes benches as they are, 5.6 % off the standard air: what that leaves out
/// is one word among what is not checked, not a warning at every published number.
bool is_in_published_air(const Design& design) {
  return design.flight.air_density == Flight{}.air_density;
}

}  // namespace

std::string unchecked_sentence(const Design& design) {
  const Tether& tether = design.tether;
  std::vector<std::string> unchecked;
  if (!is_heated(tether)) {
    unchecked.emplace_back("heat (tether.ambient_temperature_C)");
  } else if (!tether.insulation.rated_temperature_C) {
    unchecked.emplace_back("heat (an insulation material with rated_temperature_C)");
  }
  if (design.requirements.strength_safety_factor == 0) {
    unchecked.emplace_back("strength (requirements.strength_safety_factor)");
  }
  if (tether.insulation.dielectric_safety_factor == 0) {
    unchecked.emplace_back("the insulation's wall (tether.insulation.dielectric_safety_factor)");
  }
  if (unscaled_motors(design) && is_in_published_air(design)) {
    unchecked.emplace_back("the air of the motors' bench (drone.motor_air_density_kg_m3)");
  }
  return unchecked.empty()
             ? ""
             : fmt::format("Not checked, for want of the field: {}.", fmt::join(unchecked, ", "));
}

std::string limit_sentence(const Design& design, const Optimization& result) {
  const Condition where = result.limiting_condition;
  if (result.limited_by == Limit::minimum_power) {
    return fmt::format("Nothing {}limits it: this cross-section draws the least power in {}.",
                       unchecked_sentence(design).empty() ? "" : "that was checked ",
                       condition_words(where));
  }
  std::string sentence = filled_in(limit_words(result.limited_by).of_optimum, design, where,
                                   result.no_way, result.area);
  const MinimumPower& least = result.minimum_power;
  if (least.power > 0 && least.area != result.area) {
    sentence += fmt::format(" Power alone would ask for {} mm² ({} W in {}).",
                            significant(least.area / unit::square_millimetre, 4),
                            fixed(least.power, 1), condition_words(design.requirements.power_at));
  }
  return sentence;
}

std::string demand_words(const Design& design, Demand demand) {
  return filled_in(limit_words(limit_of(demand)).of_demand, design,
                   design.requirements.headroom_at);
}

std::string beyond_words(const Design& design, Limit limit, Condition where) {
  const char* const words = limit_words(limit).beyond;
  if (*words != '\0') return filled_in(words, design, where);
  return demanded_headroom(design.requirements, where) == 1
             ? "the motors no longer get what " + condition_words(where) + " takes"
             : filled_in("the thrust headroom in {where} falls below {headroom}", design, where);
}

std::string shortcoming(const Design& design, const AreaPoints& points) {
  const DemandMargin& missed = points.worst;
  if (missed.met()) return "";
  const OperatingPoint& point = points.in(missed.condition);
  const std::string where = condition_words(missed.condition);
  switch (missed.demand) {
    case Demand::takeoff_mass:
      return "no battery lands it";
    case Demand::max_pitch:
      return "tilts too far in " + where;
    case Demand::input_voltage:
      return "supply voltage outside the converter's range";
    case Demand::drum_width:
      return "too thick for the drum's width";
    case Demand::thrust_headroom: {
      if (point.thermal_runaway) return "overheats without end in " + where;
      const double demanded = demanded_headroom(design.requirements, missed.condition);
      if (demanded == 1) return "cannot hold " + where;
      return fmt::format("headroom {} < {}", headroom_below(demanded, point.headroom),
                         fixed(demanded, 2));
    }
    case Demand::conductor_temperature:
    case Demand::drum_temperature: {
      if (point.thermal_runaway) return "overheats without end in " + where;
      const bool on_drum = missed.demand == Demand::drum_temperature;
      return fmt::format("{} °C{} in {}, rated for {}",
                         fixed(on_drum ? point.drum_temperature : point.conductor_temperature, 0),
                         on_drum ? " on the drum" : "", where,
                         fixed(design.tether.insulation.rated_temperature_C.value_or(0), 0));
    }
    case Demand::tether_strength:
      return "too weak for its tension";
    case Demand::tether_shape:
      return no_way_words(design, points.no_way, missed.condition);
    case Demand::converter_rating:
      break;
  }
  return "more than the converter's rating in " + where;
}

std::string refusal_words(const Design& design, const Refusal& refusal) {
  const Condition where = refusal.condition;
  const BestHeadroom& best = refusal.best;
  const double demanded = demanded_headroom(design.requirements, where);
  if (refusal.limit == Limit::max_pitch) {
    return fmt::format("tilt above {}° in {}",
                       significant(design.requirements.max_pitch / unit::degree, 3),
                       condition_words(where));
  }
  const LimitWords& words = limit_words(refusal.limit);
  if (!words.in_short.empty()) return std::string(words.in_short);
  const bool weak = refusal.limit == Limit::motor_thrust;
  if (!weak && best.value >= demanded) return "no area meets all demands at once";
  return fmt::format("{}: headroom {} of {} in {}", weak ? "motors too weak" : "too little power",
                     fixed(best.value, 2), fixed(demanded, 2), condition_words(where));
}

std::string refusal_sentence(const Design& design, const Refusal& refusal) {
  const Condition where = refusal.condition;
  if (const char* words = limit_words(refusal.limit).of_refusal; *words != '\0') {
    return filled_in(words, design, where, refusal.no_way);
  }
  const BestHeadroom& best = refusal.best;
  const double demanded = demanded_headroom(design.requirements, where);
  const std::string demand = headroom_words(demanded) + " in " + condition_words(where);
  if (refusal.limit == Limit::max_pitch && !(best.value > 0)) {
    return fmt::format(
        "No cross-section works: holding {} m/s in {} takes more tilt than the {} degrees allowed.",
        significant(airspeed(design, where), 3), condition_words(where),
        significant(design.requirements.max_pitch / unit::degree, 3));
  }
  if (!(best.value > 0)) {
    return fmt::format(
        "No cross-section works: no power is left for the motors in {}, whatever the tether.",
        condition_words(where));
  }
  if (best.value >= demanded) {
    return "No cross-section works: each demand can be met by some, but none meets all of them.";
  }
  const char* reason =
      refusal.converter_caps
          ? "where the converter gives its rated {rated_W} W: a thicker conductor "
            "would only weigh more"
      : refusal.limit == Limit::motor_thrust
          ? "where the motors are at the end of their data sheet: a thicker "
            "conductor would only weigh more"
      : refusal.limit == Limit::max_pitch ? "where the tilt is at its limit"
      : refusal.thicker_overheat
          ? "where thinner conductors deliver less power and thicker ones overheat "
            "without end"
          : "where thinner conductors deliver less power and thicker ones weigh "
            "more than they deliver";
  return fmt::format("No cross-section gives {}. The most is a headroom of {} at {} mm², {}.",
                     demand, headroom_below(demanded, best.value),
                     significant(best.area / unit::square_millimetre, 4),
                     filled_in(reason, design, where));
}

std::vector<std::string_view> voltage_class_names() {
  std::vector<std::string_view> names;
  for (const VoltageClass& one : voltage_classes) names.push_back(one.name);
  return names;
}

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

ordered_json verdict_json(const Design& design, const AreaPoints& points) {
  const std::string fault = shortcoming(design, points);
  return {{"feasible", fault.empty()},
          {"shortcoming", fault.empty() ? ordered_json(nullptr) : ordered_json(fault)}};
}

ordered_json cable_json(const Design& design, const AreaPoints& points) {
  const double load = breaking_load(design.tether, points.area);
  const double breakdown = breakdown_voltage(design.tether.insulation, design.supply.voltage);
  ordered_json out{{"tension_N", number_or_null(std::max(points.hover.tether_tension,
                                                         points.forward.tether_tension))},
                   {"breaking_load_N", number_or_null(load > 0 ? load : nan)},
                   {"required_safety_factor", design.requirements.strength_safety_factor},
                   {"wall_mm", insulation_wall(design.tether.insulation, design.supply.voltage) /
                                   unit::millimetre},
                   {"breakdown_voltage_V", number_or_null(breakdown > 0 ? breakdown : nan)},
                   {"converter", converter_json(design, points)},
                   {"reserve_battery", battery_json(design, points.hover)}};
  if (design.tether.model == TetherModel::solved) {
    for (const auto& [name, point] :
         {std::pair{"hover", &points.hover}, std::pair{"forward", &points.forward}}) {
      out["hanging"][name] = {{"paid_out_m", number_or_null(point->tether_length)},
                              {"tension_N", number_or_null(point->tether_tension)}};
    }
  }
  return out;
}

namespace {

/// A cable that nothing pulls at breaks at no multiple of that, and one of unknown strength, whose
/// `load` is 0, at no known load.
std::string strength_sentence(double tension, double load) {
  const std::string pull =
      tension > 0 ? fmt::format("pulls at the drone with {} N and ", significant(tension, 3)) : "";
  return "The tether " + pull + strength_words(load, tension, "that") + ".";
}

}  // namespace

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
  const bool hangs =
      std::isfinite(points.hover.tether_length) && std::isfinite(points.forward.tether_length);
  if (tether.model == TetherModel::solved && hangs) {
    sentences.push_back(fmt::format(
        "It hangs as weight and wind have it, {}: {} m are paid out in hover and {} m in forward "
        "flight, and at the drone its tension is {} N and {} N.",
        hangs_on_winch(tether)
            ? fmt::format("pulled by a winch with {} N", significant(tether.winch_pull, 3))
            : fmt::format("with {} % slack", significant(100 * tether.slack, 3)),
        significant(points.hover.tether_length, 4), significant(points.forward.tether_length, 4),
        significant(points.hover.tether_tension, 3),
        significant(points.forward.tether_tension, 3)));
  }
  if (design.requirements.strength_safety_factor > 0) {
    const double tension = std::max(points.hover.tether_tension, points.forward.tether_tension);
    sentences.push_back(strength_sentence(tension, breaking_load(tether, points.area)));
  }
  if (tether.insulation.dielectric_safety_factor > 0) {
    const double breakdown = breakdown_voltage(tether.insulation, design.supply.voltage);
    sentences.push_back(fmt::format(
        "The wall of {} mm breaks down at {} V in a short test, {} times the supply.",
        significant(insulation_wall(tether.insulation, design.supply.voltage) / unit::millimetre,
                    3),
        significant(breakdown, 3), significant(breakdown / design.supply.voltage, 3)));
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

std::optional<Warning> density_warning(const Design& design) {
  const std::optional<UnscaledMotors> unscaled = unscaled_motors(design);
  if (!unscaled || is_in_published_air(design)) return std::nullopt;
  const double power = unscaled->power_ratio - 1;
  const double thrust = unscaled->thrust_ratio - 1;
  return Warning{
      WarningKind::motor_air_density,
      fmt::format(
          "the motors' curve counts as it was measured, not in air of {} kg/m³: of a bench at {} "
          "kg/m³ an ideal rotor needs {} % {} power there for the same thrust and makes {} % {} at "
          "most; state the bench's density (drone.motor_air_density_kg_m3) to have it scaled",
          significant(design.flight.air_density, 4), significant(standard_air_density, 4),
          significant(100 * std::abs(power), 2), power > 0 ? "more" : "less",
          significant(100 * std::abs(thrust), 2), thrust < 0 ? "less" : "more")};
}

std::optional<Warning> drag_estimate_warning(const Design& design) {
  const AirframeDrag& drag = design.drone.drag;
  if (!drag.is_estimate) return std::nullopt;
  return Warning{
      WarningKind::drag_estimated,
      fmt::format(
          "the drag is an estimate, not measured: the spec has no drone.drag, and a drone of {} g "
          "is taken to have front_area_m2 {}, top_area_m2 {}, linear_m_s {}; the force may be off "
          "by a factor of {} either way (drag_uncertainty_factor), power in forward flight with "
          "it; tethercalc drag learns it from a flight",
          significant(design.drone.mass / unit::gram, 4), significant(drag.front_area, 3),
          significant(drag.top_area, 3), significant(drag.linear_speed, 3), drag_estimate_factor)};
}

std::optional<Warning> slack_warning(const Design& design) {
  const Tether& tether = design.tether;
  const bool straight = tether.model == TetherModel::straight;
  if (tether.slack == Tether{}.slack || !(straight || hangs_on_winch(tether))) return std::nullopt;
  return Warning{
      WarningKind::slack_unused,
      fmt::format("the slack (tether.slack_percent) counts for nothing: {}",
                  straight ? "a straight tether is as long as the drone is high (tether.model "
                             "solved hangs with slack)"
                           : "how much is out is what the winch's pull makes it "
                             "(tether.winch_pull_N 0 leaves the slack)")};
}

Warning motor_mass_warning() {
  return {WarningKind::motor_mass_not_counted,
          "the drone weighs what the spec says (drone.mass_g) with every motor: what a motor, its "
          "propeller or a larger frame weighs more is not counted, nor whether the propeller "
          "fits"};
}

std::vector<Warning> cable_warnings(const Design& design, std::span<const AreaPoints> flown) {
  std::vector<Warning> warnings;
  if (auto slack = slack_warning(design)) warnings.push_back(std::move(*slack));
  const Tether& tether = design.tether;
  double on_drum = flown.empty() ? tether.spooled_length : 0;
  for (const AreaPoints& row : flown) {
    for (const Condition condition : {Condition::hover, Condition::forward}) {
      on_drum = std::max(
          on_drum, left_on_drum(flight_state(design, condition), row.in(condition).tether_length));
    }
  }
  if (on_drum > 0 && tether.heating.rise_per_loss > 0 && is_package_known(tether.drum)) {
    warnings.push_back(
        {WarningKind::drum_package_unused,
         "the measured rise (tether.heating.rise_K_m_per_W) is taken on the drum too, so that what "
         "tether.drum says of the package counts for nothing"});
  }
  if (!tether.ambient_temperature_C) return warnings;
  if (on_drum > 0 && !is_cooling_known(tether.drum)) {
    warnings.push_back(
        {WarningKind::drum_cooling_unknown,
         fmt::format("{} m lie on a drum of which neither layers nor derating are stated: the "
                     "wound part is the hot one, and its temperature is not known "
                     "(tether.drum.core_diameter_mm and width_mm, tether.drum.layers or "
                     "tether.drum.derating)",
                     significant(on_drum, 3))});
  }
  const bool by_layers = tether.drum.layers > 0 && !tether.drum.derating;
  if (on_drum > 0 && by_layers && !is_package_known(tether.drum)) {
    warnings.push_back({WarningKind::drum_package_unknown,
                        "the drum's temperature is by its layers alone, with factors of thick "
                        "cables: of a thin one the wound part may get several times as much hotter "
                        "than the air (tether.drum.core_diameter_mm and width_mm)"});
  }
  if (!tether.insulation.rated_temperature_C) {
    warnings.push_back(
        {WarningKind::rated_temperature_unknown,
         "the rated temperature of the insulation is not known, so that heat limits nothing "
         "(rated_temperature_C of the material)"});
  }
  return warnings;
}

namespace {

/// What says something of a wind that grows with height, or in another way than it does, and of a
/// cable that stretches.
std::optional<Warning> unused_fields_warning(const Design& design) {
  const Flight& flight = design.flight;
  const Flight unset;
  const bool uniform = flight.wind_profile == WindProfile::uniform;
  const bool straight = design.tether.model == TetherModel::straight;
  std::string names;
  const auto name_if = [&names](bool unused, const char* name) {
    if (unused) names += (names.empty() ? "" : ", ") + std::string(name);
  };
  name_if(uniform && flight.wind_reference_height.has_value(), "flight.wind_reference_height_m");
  name_if(uniform && flight.station_height != unset.station_height, "flight.station_height_m");
  name_if(
      flight.wind_profile != WindProfile::power_law && flight.wind_exponent != unset.wind_exponent,
      "flight.wind_exponent");
  name_if(flight.wind_profile != WindProfile::logarithmic &&
              flight.roughness_length != unset.roughness_length,
          "flight.roughness_length_m");
  name_if(straight && design.tether.axial_stiffness.has_value(), "tether.axial_stiffness_N");
  if (names.empty()) return std::nullopt;
  return Warning{WarningKind::field_unused,
                 "of no effect with this flight.wind_profile and tether.model: " + names};
}

}  // namespace

std::vector<Warning> spec_warnings(const DesignFile& file) {
  std::vector<Warning> warnings = file.warnings;
  if (auto unused = unused_fields_warning(file.design)) warnings.push_back(std::move(*unused));
  if (auto drag = drag_estimate_warning(file.design)) warnings.push_back(std::move(*drag));
  if (auto density = density_warning(file.design)) warnings.push_back(std::move(*density));
  return warnings;
}

Warning ground_warning(const GroundContact& ground, const std::string& where) {
  return {WarningKind::tether_touches_ground,
          where + fmt::format(
                      "with {} mm² the tether lies on the ground in {}: without one it would hang "
                      "{} m below the station; the loads are those without a ground (tethercalc "
                      "shape shows them)",
                      significant(ground.area / unit::square_millimetre, 4),
                      condition_words(ground.condition), fixed(ground.below_station, 2))};
}

Warning side_warning(const WorstSide& side) {
  const std::string takes =
      std::isnan(side.power)
          ? " cannot be flown"
          : fmt::format(" takes {} W instead of {} W and has a headroom of {} instead of {}",
                        fixed(side.power, 1), fixed(side.upwind_power, 1), fixed(side.headroom, 2),
                        fixed(side.upwind_headroom, 2));
  return {
      WarningKind::offset_is_upwind,
      fmt::format("the drone is taken to stand upwind of its station, the favourable side: {} m "
                  "aside with the wind from {}° instead (tethercalc shape --wind-from) {}{}",
                  significant(side.offset, 4), fixed(side.wind_from / unit::degree, 0),
                  condition_words(side.condition), takes)};
}

std::optional<Warning> inclination_warning(const Design& design, const OperatingPoint& hover) {
  constexpr double greatest_ratio = 1.6;  // of the rises, vertical over across: docs/design.md
  const Tether& tether = design.tether;
  const double rated =
      tether.insulation.rated_temperature_C.value_or(highest_conductor_temperature_C);
  const double ambient = tether.ambient_temperature_C.value_or(rated);
  const double rise = hover.conductor_temperature - ambient;
  const bool matters = rise > 0 && hover.conductor_temperature <= rated &&
                       ambient + greatest_ratio * rise > rated &&
                       flight_state(design, Condition::hover).airspeed == 0;
  if (tether.inclination || !matters) return std::nullopt;
  return Warning{
      WarningKind::tether_inclination_unknown,
      fmt::format(
          "in still air a tether that hangs steeply gets up to {} times as much hotter than "
          "the air as one that lies across, which is what was computed: up to {} °C in hover, "
          "rated for {} °C (tether.inclination_deg, 90 for straight down)",
          greatest_ratio, fixed(ambient + greatest_ratio * rise, 0), significant(rated, 3))};
}

std::vector<Warning> all_warnings(const DesignFile& file, std::span<const AreaPoints> table,
                                  const std::optional<GroundContact>& ground,
                                  const std::optional<WorstSide>& side) {
  std::vector<Warning> warnings = spec_warnings(file);
  for (Warning& warning : cable_warnings(file.design, table)) {
    warnings.push_back(std::move(warning));
  }
  for (const AreaPoints& row : table) {
    if (auto steep = inclination_warning(file.design, row.hover)) {
      warnings.push_back(std::move(*steep));
      break;
    }
  }
  if (ground) warnings.push_back(ground_warning(*ground));
  if (side) warnings.push_back(side_warning(*side));
  return warnings;
}

std::vector<Warning> evaluation_warnings(const DesignFile& file, const EvaluationStudy& study) {
  std::vector<Warning> warnings = all_warnings(file, study.table, study.ground, study.side);
  for (const AreaPoints& points : study.table) {
    if (!points.no_way) continue;
    warnings.push_back(
        {WarningKind::tether_does_not_hang,
         fmt::format("with {} mm²: {}", significant(points.area / unit::square_millimetre, 4),
                     no_way_words(file.design, points.no_way, points.worst.condition))});
  }
  return warnings;
}

std::vector<Warning> optimum_warnings(const DesignFile& file, const OptimumStudy& study) {
  return all_warnings(file, only(study.result), ground_contact(study.result.area, study.cable),
                      study.side);
}

}  // namespace tethercalc
