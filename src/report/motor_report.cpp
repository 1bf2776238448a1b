#include "tethercalc/report/motor_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "report/result_values.hpp"
#include "tethercalc/model/units.hpp"
#include "tethercalc/study/motor.hpp"

namespace tethercalc {
namespace {

double grams(const MotorPoint& point) { return point.thrust / unit::gram_force; }

/// What is known of it, and what is missing for figures of merit.
std::string conditions_of(const MotorEntry& motor) {
  std::vector<std::string> known;
  if (motor.voltage_V) known.push_back(fmt::format("{:g} V", *motor.voltage_V));
  if (motor.propeller_in) known.push_back(fmt::format("propeller {:g} inch", *motor.propeller_in));
  const auto density = motor.curve.measured_in();
  if (density) known.push_back(fmt::format("air of {:g} kg/m³", *density));
  std::string out = known.empty() ? "" : fmt::format("{}. ", fmt::join(known, ", "));
  if (!motor.propeller_in)
    return out + "No figure of merit without the propeller (--propeller-in).";
  if (!density) {
    out += fmt::format(
        "The air of the bench is not known (--air-density): figures of merit as in "
        "{:g} kg/m³.",
        standard_air_density);
  }
  return out;
}

}  // namespace

std::string motor_text(const MotorEntry& motor, const TextStyle& style) {
  const std::vector<double> merits = figures_of_merit(motor);
  std::vector<TextTable::Column> columns{"thrust\ng", "power\nW", "efficiency\ng/W"};
  if (!merits.empty()) columns.emplace_back("figure\nof merit");
  TextTable table(columns);
  const auto points = motor.curve.vertices().subspan(1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<std::string> cells{fixed(grams(points[i]), 1), fixed(points[i].power, 2),
                                   fixed(grams(points[i]) / points[i].power, 2)};
    if (!merits.empty()) cells.push_back(fixed(merits[i], 3));
    table.add(cells);
  }
  std::string out = style.bold(motor.name.empty() ? motor.id : motor.name) + "\n";
  out += wrapped(conditions_of(motor)) + "\n" + table.text(style);
  if (!motor.source.empty()) out += "\n" + wrapped("Source: " + motor.source);
  if (!motor.warnings.empty()) out += "\n" + style.bold("Notes") + "\n";
  for (const Warning& warning : motor.warnings) out += wrapped(warning.sentence, 96, "  ");
  return out;
}

std::string motor_csv(const MotorEntry& motor) {
  const std::vector<double> merits = figures_of_merit(motor);
  std::string out = "thrust_g,power_W,efficiency_g_per_W,figure_of_merit\n";
  const auto points = motor.curve.vertices().subspan(1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    out += csv_number(grams(points[i])) + "," + csv_number(points[i].power) + "," +
           csv_number(grams(points[i]) / points[i].power) + ",";
    if (!merits.empty()) out += csv_number(merits[i]);
    out += "\n";
  }
  return out;
}

std::string thrust_expo_file(const MotorEntry& motor, const ThrustExpo& curve,
                             const SpinRange& range, const std::optional<PulseRange>& pulses) {
  const auto commented = [](const std::string& sentence) { return wrapped(sentence, 92, "# "); };
  std::string out = commented(
      fmt::format("Thrust curve of {} for ArduPilot, fitted by tethercalc to {} rows of a thrust "
                  "stand ({}).",
                  motor.name, curve.rows, motor.source));
  out += commented(fmt::format(
      "Of the thrust between its ends the rows scatter by {:.1f} % around the curve, by {:.1f} % "
      "around a straight line. At MOT_SPIN_MIN it has {} g, at MOT_SPIN_MAX {} g.",
      100 * curve.scatter, 100 * curve.left_unbent, fixed(curve.idle_thrust / unit::gram_force, 0),
      fixed(curve.full_thrust / unit::gram_force, 0)));
  out += commented(
      "It holds for this motor, propeller, speed controller and supply. Load with Mission Planner "
      "(Full Parameter List, Load from file) or MAVProxy (param load); tune the rate controllers "
      "after a change. https://ardupilot.org/copter/docs/motor-thrust-scaling.html tells more.");
  out +=
      commented(fmt::format("MOT_THST_EXPO, 95 % interval {} \u2026 {} if the rows are independent",
                            fixed(curve.expo.lower, 3), fixed(curve.expo.upper, 3)));
  out += fmt::format("MOT_THST_EXPO,{:.3f}\n", curve.expo.value);
  out += commented("It was fitted between these, and goes with them:");
  out += fmt::format("MOT_SPIN_MIN,{:g}\nMOT_SPIN_MAX,{:g}\n", range.least, range.most);
  if (pulses) {
    out += fmt::format("MOT_PWM_MIN,{:g}\nMOT_PWM_MAX,{:g}\n", pulses->least, pulses->most);
  }
  return out;
}

}  // namespace tethercalc
