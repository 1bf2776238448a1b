// Manoeuvres as an autopilot flies them in still air.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tethercalc/diagnose/next_flight.hpp"
#include "tethercalc/model/airframe.hpp"

namespace tethercalc {

/// The drone that flies them.
struct FlownBy {
  AirframeDrag drag;
  double mass = 0;         ///< kg, > 0
  double air_density = 0;  ///< kg/m³
  double gravity = 0;      ///< m/s²
};

/// The log that manoeuvres flown one after the other leave behind: without wind, gusts and noise,
/// ten samples a second. Speeds rise and fall evenly, rounded over a second as autopilots do; the
/// nose turns by 30° a second before each leg.
struct NominalFlight {
  FlightLog log;
  std::vector<std::size_t> manoeuvre;  ///< of each sample
};
[[nodiscard]] NominalFlight nominal_flight(std::span<const Manoeuvre> manoeuvres,
                                           const FlightLimits& limits, double heading,
                                           const FlownBy& drone);

/// s that the waypoints take from a hover above home with the nose at `heading`.
[[nodiscard]] double duration_of(const std::vector<Waypoint>& waypoints, const FlightLimits& limits,
                                 double heading);

}  // namespace tethercalc
