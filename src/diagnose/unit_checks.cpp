#include "diagnose/unit_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "identify/series.hpp"

namespace tethercalc {

void check_flight_units(const FlightRecord& flight, const std::vector<double>& forward_acceleration,
                        double step) {
  const auto stuck = [&flight](double tilt) { return tilt == flight.tilt.front(); };
  if (std::all_of(flight.tilt.begin(), flight.tilt.end(), stuck)) {
    throw UnsuitableFlight(
        "the pitch never moves, as if its sensor were stuck: nothing can be predicted from it");
  }
  const auto lag = static_cast<std::size_t>(std::max(1.0, std::round(1 / step)));
  if (flight.size() < 10 * lag) return;  // too short to judge, which is told elsewhere
  const auto by_force = [&](std::size_t i) {
    return forward_acceleration[i] - flight.turn_acceleration[i];
  };
  double both = 0, leaning = 0, measured = 0;
  for (std::size_t i = lag; i < flight.size(); ++i) {
    const double expected = flight.gravity * (flight.tan_tilt[i] - flight.tan_tilt[i - lag]);
    const double seen = by_force(i) - by_force(i - lag);
    both += expected * seen;
    leaning += expected * expected;
    measured += seen * seen;
  }
  if (!(leaning > 0 && measured > 0)) return;
  constexpr double level = 0.1;
  if (std::sqrt(leaning / measured) < level) {
    throw UnsuitableFlight(
        "the pitch is far too level for the logged accelerations; are the angles in radians?");
  }
  constexpr double clear = 0.5;  // real flights have correlations of 0.8 to 0.95
  const double correlation = both / std::sqrt(leaning * measured);
  const double slope = both / leaning;
  if (correlation < -clear) {
    throw UnsuitableFlight(
        "the drone speeds up when its pitch rises: pitch must be positive nose-up");
  }
  if (correlation > clear && (slope > 1.6 || slope < 0.1)) {
    const char* hint = slope < 0.1  ? "is the time in milliseconds?"
                       : slope < 10 ? "are the velocities in km/h, or knots?"
                                    : "are the angles in radians?";
    throw UnsuitableFlight(fmt::format(
        "the forward acceleration is {:.2g} times what the pitch makes expect; {}", slope, hint));
  }
}

void check_power_units(const Design& design, const PowerLog& log) {
  std::string problems;
  const auto report = [&problems](const std::string& problem) {
    problems += (problems.empty() ? "" : "; ") + problem;
  };
  const double voltage = median(log.supply_voltage);
  const double current = median(log.supply_current);
  if (!(voltage > 0)) report(fmt::format("supply_voltage_V is {:.3g} V in the median", voltage));
  if (!(current > 0)) report(fmt::format("supply_current_A is {:.3g} A in the median", current));
  if (voltage > 0 && (voltage > 5 * design.supply.voltage || 5 * voltage < design.supply.voltage)) {
    report(fmt::format("supply_voltage_V is {:.3g} V in the median, the spec has {:.3g} V", voltage,
                       design.supply.voltage));
  }
  if (!log.drone_voltage.empty()) {
    const double received = median(log.drone_voltage);
    if (!(received > 0) || received > 1.02 * voltage) {
      report(
          fmt::format("drone_voltage_V is {:.3g} V in the median and supply_voltage_V {:.3g} V: "
                      "the tether cannot raise it",
                      received, voltage));
    }
  }
  if (!log.bus_voltage.empty() && !log.bus_current.empty() && voltage > 0 && current > 0) {
    const double bus = median(product(log.bus_voltage, log.bus_current));
    const double supply = median(product(log.supply_voltage, log.supply_current));
    if (!(bus > 0.1 * supply && bus < 3 * supply)) {
      report(
          fmt::format("the bus takes {:.3g} W in the median where the supply gives {:.3g} W; a "
                      "current or voltage has another unit",
                      bus, supply));
    }
  }
  const double highest = quantile(log.height, 0.99);
  if (highest > 1.5 * design.tether.length) {
    report(fmt::format(
        "height_m reaches {:.3g} m, the tether of the spec {:.3g} m; is the height in feet?",
        highest, design.tether.length));
  }
  if (!log.ambient_temperature_C.empty()) {
    const double ambient = median(log.ambient_temperature_C);
    if (!(ambient > -80 && ambient < 80)) {
      report(fmt::format("ambient_temperature_C is {:.3g} °C in the median; is it in kelvin?",
                         ambient));
    }
  }
  if (!problems.empty()) throw std::invalid_argument(problems);
}

}  // namespace tethercalc
