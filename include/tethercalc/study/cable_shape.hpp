// How a design's cable hangs between its station and the drone, and what that does to the drone.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tethercalc/model/catenary.hpp"
#include "tethercalc/model/design.hpp"
#include "tethercalc/model/hanging_cable.hpp"

namespace tethercalc {

/// Where the drone hovers and in which air: what of the design is asked for otherwise.
struct ShapeRequest {
  double height = 0;  ///< m of the drone over the station, > 0; unwinds the drum where there is one
  double offset = 0;  ///< m aside, ≥ 0: x points there
  PaidOut paid_out{};    ///< a length in m, or a winch's tension in N
  double wind = 0;       ///< m/s, ≥ 0, at the drone, or at the profile's reference height
  double wind_from = 0;  ///< rad, clockwise seen from above: 0 from where the drone stands aside,
                         ///< so that it blows from there over the station
  double station_height = 0;                   ///< m of the cable's lower end over ground, ≥ 0
  WindProfile profile = WindProfile::uniform;  ///< of the wind
  std::optional<double> reference_height{};    ///< m over ground, of `wind`; nothing: at the drone
  double exponent = 1.0 / 7;                   ///< of the power law
  double roughness_length = 0.03;              ///< m, of the logarithmic profile
  std::optional<double> axial_stiffness{};     ///< N, EA; nothing: the cable does not stretch
};

/// What a load of the cable makes of the drone's hover. NaN where motors or line have the power
/// not.
struct LoadedHover {
  double down = 0;         ///< N, pull of the cable downwards
  double against = 0;      ///< N, pull with the wind, which the drone leans against
  double across = 0;       ///< N, pull across the wind
  double pitch = 0;        ///< rad, tilt, which no limit holds
  double thrust = 0;       ///< N of one motor
  double drone_power = 0;  ///< W at the converter's input
  double total_power = 0;  ///< W of the ground supply
};

/// How a cable hangs. Of `loads`, `shape` and `hangs_free` only after `CableOutcome::hangs`.
struct ShapeStudy {
  Cable cable;                                     ///< weight and width of the design's tether
  MovingAir air;                                   ///< as asked for
  Vector3 drone;                                   ///< m
  CableOutcome outcome = CableOutcome::not_found;  ///< whether there is a shape
  HangingCable loads;                              ///< forces and tensions; of a cable of which
                                                   ///< there is not as much, its length
  double cable_there_is = 0;  ///< m in the air and on the drum; +infinity: as much as it takes
  CableShape shape;           ///< in 400 pieces
  bool hangs_free = true;     ///< no point lies below the ground
  double breaking_load = 0;   ///< N; 0: unknown
  LoadedHover solved;         ///< with this cable
  LoadedHover straight;       ///< with the same tether by the straight model
};

/// Solves the cable, and the drone that hovers on it in the wind of its own height: what `evaluate`
/// has of the design with what is asked, whatever its tilt. `area` in m².
/// @throws std::invalid_argument as `CableSolver::solve`.
[[nodiscard]] ShapeStudy study_cable_shape(const Design& design, double area,
                                           const ShapeRequest& request);

/// A cable as a design flies it.
struct FlownShape {
  Condition condition = Condition::hover;  ///< in which the drone flies
  ShapeRequest request;                    ///< what the design says of that
  ShapeStudy study;                        ///< its shape and loads
};

/// How the cable of a design with a solved tether hangs in hover and in forward flight, with a
/// conductor of `area` m². Nothing where the tether is straight or there is no such conductor, NaN.
[[nodiscard]] std::vector<FlownShape> shapes_in_flight(const Design& design, double area);

/// That a cable as it hangs lies on the ground.
struct GroundContact {
  double area = 0;                         ///< m² of its conductor
  Condition condition = Condition::hover;  ///< the one in which it would hang lowest
  double below_station = 0;                ///< m, how low that is where there is no ground
};

/// Whether a cable with a conductor of `area` m², of which `shapes_in_flight` are `shapes`, lies on
/// the ground in any of them.
[[nodiscard]] std::optional<GroundContact> ground_contact(double area,
                                                          std::span<const FlownShape> shapes);

/// What a drone aside of its station takes where the wind is hardest on it, beside what it takes
/// upwind of the station, where every design is judged. NaN: it is not flown there.
struct WorstSide {
  double offset = 0;                       ///< m from the station
  Condition condition = Condition::hover;  ///< the one that it is hardest on
  double wind_from = 0;                    ///< rad, as `FlightState` has it
  double upwind_power = 0;                 ///< W of the ground supply
  double power = 0;                        ///< the same on the worst side
  double upwind_headroom = 0;              ///< available over necessary thrust
  double headroom = 0;                     ///< the same on the worst side
};

/// That, of wind from every 30 degrees, with a conductor of `area` m². Nothing without a solved
/// tether, a drone aside and wind, where it is not flown upwind either, and where that is the
/// worst.
[[nodiscard]] std::optional<WorstSide> worst_side(const Design& design, double area);

/// A cable between (0, 0, 0) and its drone, by itself: solvers are held against each other by it.
struct CableCase {
  std::string id;         ///< of the case
  Cable cable;            ///< weight, width, stiffness
  MovingAir air;          ///< uniform
  double length = 0;      ///< m
  Vector3 drone;          ///< m
  bool in_plane = false;  ///< in still air, so that its shape is a catenary
};

/// How such a cable hangs. Of the others only after `CableOutcome::hangs`.
struct SolvedCase {
  CableCase asked;                                 ///< the cable
  CableOutcome outcome = CableOutcome::not_found;  ///< whether there is a shape
  Catenary catenary;                               ///< of one in still air
  HangingCable loads;                              ///< of one in wind: forces and tensions
  CableShape shape;                                ///< of one in wind, in 4000 pieces
};

/// Solves it.
[[nodiscard]] SolvedCase solve_cable_case(CableCase asked);

}  // namespace tethercalc
