#include "tethercalc/report/limit_sentences.hpp"

#include <fmt/format.h>

#include "tethercalc/model/conductor_heat.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc {
namespace {

std::string headroom_words(double headroom) {
  return headroom > 1 ? fmt::format("a thrust headroom of {}", significant(headroom, 3))
                      : std::string("level flight");
}

}  // namespace

std::string condition_words(Condition condition) {
  return condition == Condition::hover ? "hover" : "forward flight";
}

std::string limit_sentence(const Design& design, const Optimization& result) {
  const std::string where = condition_words(result.limiting_condition);
  const std::string demand =
      headroom_words(demanded_headroom(design.requirements, result.limiting_condition)) + " in " +
      where;
  std::string sentence;
  switch (result.limited_by) {
    case Limit::minimum_power:
      return fmt::format("Nothing limits it: this cross-section draws the least power in {}.",
                         where);
    case Limit::available_power:
      sentence = fmt::format(
          "Limited by the power that reaches the drone: any thinner, and it does not suffice for "
          "{}.",
          demand);
      break;
    case Limit::takeoff_mass:
      sentence = fmt::format("Limited by weight: any thicker, and the tether is too heavy for {}.",
                             demand);
      break;
    case Limit::max_pitch:
      sentence = fmt::format("Limited by the tilt: {} degrees in {} is the most allowed.",
                             significant(design.requirements.max_pitch / unit::degree, 3), where);
      break;
    case Limit::motor_thrust:
      sentence = fmt::format("Limited by the motors: they make no more thrust for {}.", demand);
      break;
    case Limit::conductor_temperature:
      sentence = fmt::format(
          "Limited by heat: any thinner, and the conductor is hotter in {} than the {} °C for "
          "which "
          "its insulation is rated.",
          where, significant(*design.tether.insulation.rated_temperature_C, 3));
      break;
    case Limit::tether_strength:
      sentence =
          fmt::format("Limited by strength: the tether would not hold {} times its tension in {}.",
                      significant(design.requirements.strength_safety_factor, 3), where);
      break;
    case Limit::input_voltage:
      break;  // the same at every cross-section: nothing that an optimum lies on
    case Limit::converter_rating:
      sentence = fmt::format(
          "Limited by the converter: any thicker, and lifting the tether in {} takes more than its "
          "rated {} W.",
          where, significant(*design.supply.converter.rated_output_power, 4));
      break;
  }
  const MinimumPower& least = result.minimum_power;
  if (least.power > 0) {
    sentence += fmt::format(" Power alone would ask for {} mm² ({} W in {}).",
                            significant(least.area / unit::square_millimetre, 4),
                            fixed(least.power, 1), condition_words(design.requirements.power_at));
  }
  return sentence;
}

/// Why no area keeps a limit of the cable or the converter; empty for the other limits.
std::string broken_limit_sentence(const Design& design, const Refusal& refusal) {
  const std::string where = condition_words(refusal.condition);
  switch (refusal.limit) {
    case Limit::conductor_temperature:
      return fmt::format(
          "No cross-section that meets the other demands stays below the insulation's rated {} °C "
          "in {}, or none has a steady temperature at all.",
          significant(design.tether.insulation.rated_temperature_C.value_or(
                          highest_conductor_temperature_C),
                      3),
          where);
    case Limit::tether_strength:
      return fmt::format(
          "No cross-section that meets the other demands holds {} times the tension in {}; a "
          "strength member would.",
          significant(design.requirements.strength_safety_factor, 3), where);
    case Limit::converter_rating:
      return fmt::format(
          "No cross-section that meets the other demands leaves the converter within its rated {} "
          "W in {}.",
          significant(design.supply.converter.rated_output_power.value_or(0), 4), where);
    case Limit::input_voltage:
      return fmt::format(
          "No cross-section works: a supply of {} V is outside the converter's range.",
          significant(design.supply.voltage, 4));
    default:
      return "";
  }
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
    case Demand::thrust_headroom: {
      if (point.thermal_runaway) return "overheats without end in " + where;
      const double demanded = demanded_headroom(design.requirements, missed.condition);
      if (demanded == 1) return "cannot hold " + where;
      return fmt::format("headroom {} < {}", fixed(point.headroom, 2), fixed(demanded, 2));
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
    case Demand::converter_rating:
      break;
  }
  return "more than the converter's rating in " + where;
}

std::string refusal_words(const Design& design, const Refusal& refusal) {
  const Condition where = refusal.condition;
  const BestHeadroom& best = refusal.best;
  const double demanded = demanded_headroom(design.requirements, where);
  switch (refusal.limit) {
    case Limit::conductor_temperature:
      return "conductor too hot";
    case Limit::tether_strength:
      return "tether too weak";
    case Limit::converter_rating:
      return "converter too small";
    case Limit::input_voltage:
      return "supply outside the converter's range";
    case Limit::max_pitch:
      return fmt::format("tilt above {}° in {}",
                         significant(design.requirements.max_pitch / unit::degree, 3),
                         condition_words(where));
    case Limit::motor_thrust:
      return fmt::format("motors too weak: headroom {} of {} in {}", fixed(best.value, 2),
                         fixed(demanded, 2), condition_words(where));
    default:
      return best.value >= demanded
                 ? std::string("no area meets all demands at once")
                 : fmt::format("too little power: headroom {} of {} in {}", fixed(best.value, 2),
                               fixed(demanded, 2), condition_words(where));
  }
}

std::string refusal_sentence(const Design& design, const Refusal& refusal) {
  if (const std::string broken = broken_limit_sentence(design, refusal); !broken.empty()) {
    return broken;
  }
  const Condition where = refusal.condition;
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
  if (refusal.converter_caps) {
    return fmt::format(
        "No cross-section gives {}. The most is a headroom of {} at {} mm², where the converter "
        "gives its rated {} W: a thicker conductor would only weigh more.",
        demand, significant(best.value, 3), significant(best.area / unit::square_millimetre, 4),
        significant(*design.supply.converter.rated_output_power, 4));
  }
  const char* reason = refusal.limit == Limit::motor_thrust
                           ? "where the motors are at the end of their data sheet: a thicker "
                             "conductor would only weigh more"
                       : refusal.limit == Limit::max_pitch
                           ? "where the tilt is at its limit"
                           : "where thinner conductors deliver less power and thicker ones weigh "
                             "more than they deliver";
  return fmt::format("No cross-section gives {}. The most is a headroom of {} at {} mm², {}.",
                     demand, significant(best.value, 3),
                     significant(best.area / unit::square_millimetre, 4), reason);
}

}  // namespace tethercalc
