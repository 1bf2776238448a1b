#include "tethercalc/report/limit_sentences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "tethercalc/model/conductor_heat.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc {
namespace {

std::string headroom_words(double headroom) {
  return headroom > 1 ? fmt::format("a thrust headroom of {}", significant(headroom, 3))
                      : std::string("level flight");
}

/// What is said of a limit. In place of the names in braces stands what `filled_in` puts there.
struct LimitWords {
  Limit limit;
  const char* of_optimum;   ///< why the optimum is where it is
  const char* of_refusal;   ///< why there is none, where neither power nor weight says it
  const char* of_demand;    ///< what binds
  const char* beyond = "";  ///< what happens further on, where it is not the headroom that ends
  std::string_view in_short = "";  ///< why there is no optimum, where it is not the headroom
};

constexpr LimitWords all_limits[] = {
    {Limit::available_power,
     "Limited by the power that reaches the drone: any thinner, and it does not suffice for "
     "{demand}.",
     "", "The thrust headroom of {headroom} in {where}"},
    {Limit::takeoff_mass,
     "Limited by weight: any thicker, and the tether is too heavy for {demand}.", "",
     "The take-off mass"},
    {Limit::motor_thrust, "Limited by the motors: they make no more thrust for {demand}.", "",
     "The motors' greatest thrust"},
    {Limit::max_pitch, "Limited by the tilt: {tilt} degrees in {where} is the most allowed.", "",
     "The largest tilt of {tilt}°", "the tilt passes its limit in {where}"},
    {Limit::conductor_temperature,
     "Limited by heat: any thinner, and the conductor is hotter in {where} than the {rated_C} °C "
     "for which its insulation is rated.",
     "No cross-section that meets the other demands stays below the insulation's rated {rated_C} "
     "°C in {where}, or none has a steady temperature at all.",
     "The insulation's rated {rated_C} °C",
     "the conductor gets hotter than its insulation is rated for in {where}", "conductor too hot"},
    {Limit::tether_strength,
     "Limited by strength: the tether would not hold {factor} times its tension in {where}.",
     "No cross-section that meets the other demands holds {factor} times the tension in {where}; a "
     "strength member would.",
     "The tether's strength of {factor} times its tension",
     "the tether no longer holds its tension with the factor asked for in {where}",
     "tether too weak"},
    {Limit::converter_rating,
     "Limited by the converter: any thicker, and lifting the tether in {where} takes more than its "
     "rated {rated_W} W.",
     "No cross-section that meets the other demands leaves the converter within its rated "
     "{rated_W} W in {where}.",
     "The converter's rated {rated_W} W", "the converter's rating is passed in {where}",
     "converter too small"},
    {Limit::input_voltage, "",  // the same at every cross-section: nothing that an optimum lies on
     "No cross-section works: a supply of {voltage} V is outside the converter's range.",
     "The converter's highest input of {highest_input} V",
     "the supply is outside the converter's range", "supply outside the converter's range"}};

const LimitWords& limit_words(Limit limit) {
  return *std::find_if(std::begin(all_limits), std::end(all_limits) - 1,
                       [limit](const LimitWords& words) { return words.limit == limit; });
}

/// `words` with the design's numbers in place of their names.
std::string filled_in(const char* words, const Design& design, Condition condition) {
  const Requirements& need = design.requirements;
  const Converter& converter = design.supply.converter;
  const double demanded = demanded_headroom(need, condition);
  const std::string where = condition_words(condition);
  return fmt::format(
      fmt::runtime(words), fmt::arg("where", where),
      fmt::arg("demand", headroom_words(demanded) + " in " + where),
      fmt::arg("headroom", fixed(demanded, 2)),
      fmt::arg("tilt", significant(need.max_pitch / unit::degree, 3)),
      fmt::arg("rated_C", significant(design.tether.insulation.rated_temperature_C.value_or(
                                          highest_conductor_temperature_C),
                                      3)),
      fmt::arg("factor", significant(need.strength_safety_factor, 3)),
      fmt::arg("rated_W", significant(converter.rated_output_power.value_or(0), 4)),
      fmt::arg("voltage", significant(design.supply.voltage, 4)),
      fmt::arg("highest_input", significant(converter.max_input_voltage.value_or(0), 4)));
}

}  // namespace

std::string condition_words(Condition condition) {
  return condition == Condition::hover ? "hover" : "forward flight";
}

std::string limit_sentence(const Design& design, const Optimization& result) {
  const Condition where = result.limiting_condition;
  if (result.limited_by == Limit::minimum_power) {
    return fmt::format("Nothing limits it: this cross-section draws the least power in {}.",
                       condition_words(where));
  }
  std::string sentence = filled_in(limit_words(result.limited_by).of_optimum, design, where);
  const MinimumPower& least = result.minimum_power;
  if (least.power > 0) {
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
    return filled_in(words, design, where);
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
  const char* reason = refusal.converter_caps
                           ? "where the converter gives its rated {rated_W} W: a thicker conductor "
                             "would only weigh more"
                       : refusal.limit == Limit::motor_thrust
                           ? "where the motors are at the end of their data sheet: a thicker "
                             "conductor would only weigh more"
                       : refusal.limit == Limit::max_pitch
                           ? "where the tilt is at its limit"
                           : "where thinner conductors deliver less power and thicker ones weigh "
                             "more than they deliver";
  return fmt::format("No cross-section gives {}. The most is a headroom of {} at {} mm², {}.",
                     demand, significant(best.value, 3),
                     significant(best.area / unit::square_millimetre, 4),
                     filled_in(reason, design, where));
}

}  // namespace tethercalc
