#include "tethercalc/study/cable_shape.hpp"

#include <cmath>
#include <utility>

#include "model/constants.hpp"
#include "tethercalc/model/airframe.hpp"
#include "tethercalc/model/power_line.hpp"
#include "tethercalc/model/steady_flight.hpp"

namespace tethercalc {
namespace {

constexpr int pieces = 400;

/// Tangent of the tilt into the wind; negative where the cable pulls harder against the wind than
/// the airframe drags with it, which leaves a small tilt to step towards.
double forward_tan_pitch(const ForceBalance& balance, const AirframeDrag& drag) {
  if (balance.tether_drag >= 0) return equilibrium_tan_pitch(balance, infinity);
  double tangent = 0;
  for (int i = 0; i < 50; ++i) {
    const double push = balance.area_force_factor * effective_area(drag, std::abs(tangent));
    tangent = (push + balance.tether_drag) / balance.weight;
  }
  return tangent;
}

/// The hover in which the cable pulls like this; what it weighs is in `down`.
LoadedHover hover_under(const SteadyFlight& flight, double radius, double paid_out, double down,
                        double against, double across) {
  const Design& design = flight.design();
  LoadedHover out{down, against, across};
  const double bare = flight.takeoff_mass(radius) - flight.tether().mass(radius);
  const double weight = bare * design.flight.gravity + down;
  const AirframeDrag& drag = design.drone.drag;
  const double drag_factor =
      area_force_factor(drag, design.flight.air_density, flight.state().airspeed);
  const double forward =
      forward_tan_pitch({weight, drag_factor, against, drag.front_area, drag.top_area}, drag);
  const double tangent = std::hypot(forward, across / weight);
  out.pitch = std::atan(tangent);
  out.thrust = flight.necessary_thrust(weight, tangent);
  out.drone_power = flight.drone_power(out.thrust, flight.power_share(tangent).value);
  FlightState laid_out = flight.state();
  laid_out.deployed = paid_out;
  const double resistance = SteadyFlight(design, laid_out).tether().resistance(radius);
  out.total_power = out.drone_power < infinity
                        ? supplied_power(design.supply.voltage, resistance, out.drone_power)
                        : infinity;
  return out;
}

}  // namespace

Cable cable_of(const Design& design, double area) {
  const double radius = conductor_radius(area);
  const double wall = insulation_wall(design.tether.insulation, design.supply.voltage);
  const StraightTether tether(design.tether, wall, {.deployed = 1}, design.flight.air_density,
                              design.flight.gravity);
  Cable cable{.weight = tether.mass(radius) * design.flight.gravity,
              .diameter = tether.width(radius),
              .drag_coefficient = vibrating_drag_coefficient(design.tether)};
  if (design.tether.drag_by_reynolds_number) {
    cable.cylinder_diameter = insulated_width(radius, wall);
  }
  return cable;
}

ShapeStudy study_cable_shape(const Design& original, double area, const ShapeRequest& request) {
  // The cable is solved here; what it does to the drone is set beside a straight one.
  Design design = original;
  design.tether.model = TetherModel::straight;
  ShapeStudy out;
  out.cable = cable_of(design, area);
  out.cable.axial_stiffness = request.axial_stiffness;
  out.drone = {request.offset, 0, request.height};
  out.air.density = design.flight.air_density;
  out.air.profile = request.profile;
  out.air.wind = {-request.wind * std::cos(request.wind_from),
                  request.wind * std::sin(request.wind_from), 0};
  out.air.station_height = request.station_height;
  out.air.reference_height = request.reference_height;
  out.air.exponent = request.exponent;
  out.air.roughness_length = request.roughness_length;
  out.breaking_load = breaking_load(design.tether, area);

  CableSolver solver;
  out.outcome = solver.solve(out.cable, out.air, request.paid_out, out.drone);
  if (out.outcome != CableOutcome::hangs) return out;
  out.loads = solver.result();
  out.shape = solver.shape(pieces);
  out.hangs_free = out.shape.lowest.position.z >= -request.station_height - 1e-9;

  const double wind = request.wind * wind_share(out.air, request.height);
  const double radius = conductor_radius(area);
  const Vector3& pull = out.loads.on_drone;
  const Vector3 with =
      request.wind > 0 ? Vector3{out.air.wind.x / request.wind, out.air.wind.y / request.wind, 0}
                       : Vector3{-1, 0, 0};
  FlightState state = flight_state(design, Condition::hover);
  state.airspeed = wind;
  state.deployed = request.height;
  const SteadyFlight flight(design, state);
  out.solved = hover_under(flight, radius, out.loads.length, -pull.z,
                           pull.x * with.x + pull.y * with.y, pull.x * with.y - pull.y * with.x);
  const TetherLoad straight = flight.tether().load(radius);
  out.straight = hover_under(flight, radius, request.height, straight.down, straight.along, 0);
  return out;
}

std::vector<FlownShape> shapes_in_flight(const Design& design, double area) {
  std::vector<FlownShape> shapes;
  if (design.tether.model == TetherModel::straight || !(area > 0)) return shapes;
  const Flight& flight = design.flight;
  for (const Condition condition : {Condition::hover, Condition::forward}) {
    const FlightState state = flight_state(design, condition);
    const ShapeRequest request{
        .height = state.deployed,
        .offset = flight.horizontal_offset,
        .paid_out = paid_out_to(design.tether, state.deployed, flight.horizontal_offset),
        .wind = std::abs(state.airspeed),
        .station_height = flight.station_height,
        .profile = flight.wind_profile,
        .reference_height = flight.station_height + state.deployed,
        .exponent = flight.wind_exponent,
        .roughness_length = flight.roughness_length,
        .axial_stiffness = design.tether.axial_stiffness};
    shapes.push_back({condition, request, study_cable_shape(design, area, request)});
  }
  return shapes;
}

std::optional<GroundContact> ground_contact(double area, std::span<const FlownShape> shapes) {
  std::optional<GroundContact> lowest;
  for (const FlownShape& flown : shapes) {
    if (flown.study.outcome != CableOutcome::hangs || flown.study.hangs_free) continue;
    const double below_station = -flown.study.shape.lowest.position.z;
    if (!lowest || below_station > lowest->below_station) {
      lowest = GroundContact{area, flown.condition, below_station};
    }
  }
  return lowest;
}

SolvedCase solve_cable_case(CableCase asked) {
  SolvedCase out;
  out.asked = std::move(asked);
  const auto& [id, cable, air, length, drone, in_plane] = out.asked;
  if (in_plane) {
    const auto found = catenary(drone.x, drone.z, length, cable.weight, cable.axial_stiffness);
    out.outcome = found ? CableOutcome::hangs : CableOutcome::too_short;
    out.catenary = found.value_or(Catenary{});
    return out;
  }
  CableSolver solver;
  out.outcome = solver.solve(cable, air, PaidOut{.length = length}, drone);
  if (out.outcome != CableOutcome::hangs) return out;
  out.loads = solver.result();
  out.shape = solver.shape(4000);
  return out;
}

}  // namespace tethercalc
