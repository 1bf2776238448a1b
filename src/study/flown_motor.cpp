#include "tethercalc/study/flown_motor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "identify/statistics.hpp"
#include "tethercalc/identify/observations.hpp"
#include "tethercalc/model/airframe.hpp"
#include "tethercalc/model/units.hpp"
#include "tethercalc/study/motor.hpp"

namespace tethercalc {
namespace {

constexpr double fastest_hover = 2;    // m/s: drag then adds less than a percent to the thrust
constexpr double slowest_forward = 4;  // m/s
constexpr std::size_t fewest_rows = 50;
constexpr double shortest_hover = 20;  // s
constexpr std::size_t stretches = 10;

/// Relative 95 % half-width of the mean of `values`, from the means of stretches of them.
double relative_interval(std::span<const double> values) {
  std::vector<double> means;
  for (std::size_t k = 0; k < stretches; ++k) {
    const std::size_t from = k * values.size() / stretches;
    const std::size_t to = (k + 1) * values.size() / stretches;
    double sum = 0;
    for (std::size_t i = from; i < to; ++i) sum += values[i];
    means.push_back(sum / double(to - from));
  }
  const MeanOfStretches mean = mean_of_stretches(means);
  return student_quantile(double(stretches - 1), 0.975) * mean.error / mean.value;
}

/// By how much measured motors leave a curve k·T^1.5 through the point nearest to half their
/// greatest thrust, at 95 % of their points.
double shape_band(std::span<const MotorEntry> measured) {
  std::vector<double> deviations;
  for (const MotorEntry& motor : measured) {
    const auto points = motor.curve.vertices().subspan(1);
    const double half = motor.curve.max_thrust() / 2;
    const auto middle = std::ranges::min_element(
        points, {}, [&](const MotorPoint& point) { return std::abs(point.thrust - half); });
    for (const MotorPoint& point : points) {
      const double expected = middle->power * std::pow(point.thrust / middle->thrust, 1.5);
      if (&point != &*middle) deviations.push_back(std::abs(point.power / expected - 1));
    }
  }
  if (deviations.empty()) return 0;
  std::ranges::sort(deviations);
  return deviations[static_cast<std::size_t>(std::ceil(0.95 * double(deviations.size()))) - 1];
}

/// Thrust of one motor in steady level flight.
double thrust_at(const Drone& drone, const Flight& where, double airspeed) {
  const double weight = drone.mass * where.gravity;
  const double tilt =
      equilibrium_tan_pitch({weight, area_force_factor(drone.drag, where.air_density, airspeed), 0,
                             drone.drag.front_area, drone.drag.top_area},
                            std::numeric_limits<double>::infinity());
  return weight * std::sqrt(1 + tilt * tilt) / drone.motor_count;
}

/// Row i lasts until the next one.
double seconds_of(const PowerLog& flight, std::size_t i) {
  return i + 1 < flight.time.size() ? flight.time[i + 1] - flight.time[i] : 0;
}

/// The stretches in hover that last: a drone that brakes and turns round passes through the same
/// airspeeds with another power.
std::vector<SampleRange> hover_stretches(const PowerLog& flight) {
  constexpr double shortest = 5;  // s
  std::vector<SampleRange> found;
  const std::size_t count = flight.time.size();
  for (std::size_t first = 0; first < count; ++first) {
    std::size_t last = first;
    while (last < count && std::abs(flight.airspeed[last]) < fastest_hover) ++last;
    if (last == first) continue;
    if (flight.time[last - 1] - flight.time[first] >= shortest) found.push_back({first, last});
    first = last;
  }
  return found;
}

}  // namespace

FlownMotor flown_motor(const PowerLog& flight, const Design& design, double max_thrust,
                       std::span<const MotorEntry> measured) {
  const Drone& drone = design.drone;
  check_flies_free(flight);
  std::vector<double> motor_power = bus_power_of(flight);
  if (motor_power.empty()) {
    throw UnsuitablePowerFlight(
        "has no power at the motors: it needs bus_voltage_V and bus_current_A, or bus_power_W");
  }
  for (double& power : motor_power) power -= drone.auxiliary_power;
  FlownMotor out;
  std::vector<double> hover;
  for (const auto& [first, last] : hover_stretches(flight)) {
    for (std::size_t i = first; i < last; ++i) {
      hover.push_back(motor_power[i]);
      out.hover_seconds += seconds_of(flight, i);
    }
  }
  if (hover.size() < fewest_rows || out.hover_seconds < shortest_hover) {
    throw UnsuitablePowerFlight(fmt::format(
        "has {} rows and {:.1f} s of hover (below {:g} m/s); at least {} rows and {:g} s "
        "are needed",
        hover.size(), out.hover_seconds, fastest_hover, fewest_rows, shortest_hover));
  }
  double sum = 0;
  for (const double power : hover) sum += power;
  out.hover_power = sum / double(hover.size()) / drone.motor_count;
  if (!(out.hover_power > 0)) {
    throw UnsuitablePowerFlight(
        "leaves the motors a mean power of 0 or less in hover: is the current's sign "
        "reversed, or the auxiliary power too large?");
  }
  out.hover_thrust = drone.mass * design.flight.gravity / drone.motor_count;
  if (max_thrust <= out.hover_thrust) {
    throw UnsuitablePowerFlight(
        fmt::format("hovers with {:.0f} g a motor, which the greatest thrust has to exceed",
                    out.hover_thrust / unit::gram_force));
  }
  const double factor = out.hover_power / std::pow(out.hover_thrust, 1.5);
  out.curve = momentum_curve(factor, max_thrust);
  out.curve.set_measured_in(design.flight.air_density);
  out.hover_interval = relative_interval(hover);
  out.band = std::hypot(out.hover_interval, shape_band(measured));

  FlownForward forward;
  for (std::size_t i = 0; i < flight.time.size(); ++i) {
    const double airspeed = std::abs(flight.airspeed[i]);
    if (airspeed < slowest_forward) continue;
    const double expected = factor * std::pow(thrust_at(drone, design.flight, airspeed), 1.5);
    ++forward.rows;
    forward.airspeed += airspeed;
    forward.ratio += motor_power[i] / drone.motor_count / expected;
  }
  if (forward.rows >= fewest_rows) {
    forward.airspeed /= double(forward.rows);
    forward.ratio /= double(forward.rows);
    out.forward = forward;
  }
  return out;
}

}  // namespace tethercalc
