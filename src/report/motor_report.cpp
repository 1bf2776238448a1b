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

}  // namespace tethercalc
