#include "identify/flight_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "identify/statistics.hpp"

namespace tethercalc {
namespace {

/// Of nine tenths of the values.
double spread(const std::vector<double>& values) {
  return values.empty() ? 0 : quantile(values, 0.95) - quantile(values, 0.05);
}

}  // namespace

std::vector<double> yaw_rate(const Observations& flight) {
  std::vector<double> rate(flight.size(), 0.0);
  for (std::size_t i = 1; i + 1 < flight.size(); ++i) {
    rate[i] = (flight.yaw[i + 1] - flight.yaw[i - 1]) / (flight.time[i + 1] - flight.time[i - 1]);
  }
  return rate;
}

std::optional<Leaning> leaning_over_a_second(const Observations& flight, double gravity,
                                             Axis axis) {
  if (flight.size() < 3) return std::nullopt;
  const double step = median_step(flight.time);
  const auto lag = static_cast<std::size_t>(std::max(1.0, std::round(1 / step)));
  if (flight.size() < 10 * lag) return std::nullopt;
  const std::vector<double> turning = yaw_rate(flight);
  const bool forward = axis == Axis::forward;
  if (!forward && flight.right_acceleration.size() != flight.size()) return std::nullopt;
  const auto by_force = [&](std::size_t i) {
    return forward ? flight.forward_acceleration[i] - turning[i] * flight.right_speed[i]
                   : flight.right_acceleration[i] + turning[i] * flight.forward_speed[i];
  };
  const auto by_leaning = [&](std::size_t i) {
    return gravity * (forward ? std::tan(flight.tilt[i])
                              : std::tan(flight.roll[i]) / std::cos(flight.tilt[i]));
  };
  double both = 0, leaning = 0, measured = 0;
  for (std::size_t i = lag; i < flight.size(); ++i) {
    const double expected = by_leaning(i) - by_leaning(i - lag);
    const double seen = by_force(i) - by_force(i - lag);
    both += expected * seen;
    leaning += expected * expected;
    measured += seen * seen;
  }
  if (!(leaning > 0 && measured > 0)) return std::nullopt;
  return Leaning{both / std::sqrt(leaning * measured), both / leaning,
                 std::sqrt(leaning / measured)};
}

double mean_heading(const Observations& flight) {
  double north = 0;
  double east = 0;
  for (const double yaw : flight.yaw) {
    north += std::cos(yaw);
    east += std::sin(yaw);
  }
  return std::atan2(east, north);
}

bool turns(const Observations& flight) {
  constexpr double apart = 0.35;  // rad: a third of a force across the one is along the other
  return spread(flight.yaw) > apart;
}

bool shows_both_axes(const Observations& flight, double gravity) {
  // m/s: as of the forward speed, below which a fit takes drag and wind for each other.
  constexpr double flown_to_the_side = 3;
  const std::optional<Leaning> aside = leaning_over_a_second(flight, gravity, Axis::right);
  return aside && aside->correlation > leans_to_speed_up &&
         (turns(flight) || spread(flight.right_speed) > flown_to_the_side);
}

void check_flight_units(const Observations& flight, double gravity) {
  const auto stuck = [&flight](double tilt) { return tilt == flight.tilt.front(); };
  if (std::all_of(flight.tilt.begin(), flight.tilt.end(), stuck)) {
    throw UnsuitableFlight(
        "the pitch never moves, as if its sensor were stuck: nothing can be predicted from it");
  }
  const std::optional<Leaning> found = leaning_over_a_second(flight, gravity);
  if (!found) return;  // too short to judge, which is told elsewhere
  const auto [correlation, slope, size] = *found;
  constexpr double level = 0.1;
  if (size < level) {
    throw UnsuitableFlight(
        "the pitch is far too level for the logged accelerations; are the angles in radians?");
  }
  constexpr double clear = 0.5;  // real flights have correlations of 0.8 to 0.95
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

}  // namespace tethercalc
