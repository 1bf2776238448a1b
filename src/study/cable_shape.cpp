#include "tethercalc/study/cable_shape.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "model/constants.hpp"
#include "tethercalc/model/operating_point.hpp"
#include "tethercalc/model/steady_flight.hpp"
#include "tethercalc/study/envelope.hpp"

namespace tethercalc {
namespace {

constexpr int pieces = 400;

/// The design with what is asked of its cable.
Design asked_of(const Design& original, const ShapeRequest& request) {
  Design design = at_reach(original, Reach::height, request.height);
  Flight& flight = design.flight;
  flight.horizontal_offset = request.offset;
  flight.headwind = request.wind;
  flight.station_height = request.station_height;
  flight.wind_profile = request.profile;
  flight.wind_reference_height = request.reference_height;
  flight.wind_exponent = request.exponent;
  flight.roughness_length = request.roughness_length;
  Tether& tether = design.tether;
  tether.axial_stiffness = request.axial_stiffness;
  tether.winch_pull = request.paid_out.winch_tension.value_or(0);
  if (request.paid_out.length) {
    tether.slack = *request.paid_out.length / std::hypot(request.height, request.offset) - 1;
  }
  return design;
}

LoadedHover hover_by(TetherModel model, Design design, double area, const FlightState& state) {
  design.tether.model = model;
  // How far it tilts is the answer, whatever is allowed.
  design.requirements.max_pitch = std::numbers::pi / 2;
  const SteadyFlight flight(design, state, ConductorsAsked::one);
  const TetherLoad load = flight.tether().load(conductor_radius(area));
  const OperatingPoint point = evaluate(flight, area);
  return {load.down,
          load.along,
          load.across,
          std::abs(point.pitch),
          point.necessary_thrust,
          point.drone_power,
          point.total_power};
}

/// The shape of the design's own cable in a state of its flight.
ShapeStudy shape_in(const Design& design, double area, const FlightState& state) {
  ShapeStudy out;
  out.drone = {design.flight.horizontal_offset, 0, state.deployed};
  out.breaking_load = breaking_load(design.tether, area);
  const HangingSituation situation = hanging_situation(design, state);
  out.cable = cable_of(situation, conductor_radius(area));
  out.air = situation.air;
  out.cable_there_is = situation.cable_there_is;
  CableSolver solver;
  const HangingOutcome hanging = solve_hanging(situation, solver, conductor_radius(area));
  out.outcome = hanging.outcome;
  out.loads = hanging.cable;
  if (out.outcome != CableOutcome::hangs) return out;
  out.shape = solver.shape(pieces);
  out.hangs_free = out.shape.lowest.position.z >= -design.flight.station_height - 1e-9;
  out.solved = hover_by(TetherModel::solved, design, area, state);
  out.straight = hover_by(TetherModel::straight, design, area, state);
  return out;
}

}  // namespace

ShapeStudy study_cable_shape(const Design& original, double area, const ShapeRequest& request) {
  const Design design = asked_of(original, request);
  FlightState state = flight_state(design, Condition::hover);
  state.wind_from = request.wind_from;
  ShapeStudy out = shape_in(design, area, state);
  out.air.wind = level_wind(request.wind, request.wind_from);
  out.air.profile = request.profile;
  out.air.reference_height = request.reference_height.value_or(out.air.reference_height);
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
        .exponent = flight.wind_exponent,
        .roughness_length = flight.roughness_length,
        .axial_stiffness = design.tether.axial_stiffness};
    shapes.push_back({condition, request, shape_in(design, area, state)});
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

std::optional<WorstSide> worst_side(const Design& design, double area) {
  std::optional<WorstSide> worst;
  if (design.flight.horizontal_offset == 0 || !(area > 0)) return worst;
  double most = 1;  // of what it takes over what it takes upwind
  for (const Condition condition : {Condition::hover, Condition::forward}) {
    FlightState state = flight_state(design, condition);
    if (state.airspeed == 0) continue;
    const auto flown = [&] {
      return evaluate(SteadyFlight(design, state, ConductorsAsked::one), area);
    };
    const OperatingPoint upwind = flown();
    if (std::isnan(upwind.total_power)) continue;
    for (int degrees = 30; degrees <= 180; degrees += 30) {  // left and right are alike
      state.wind_from = degrees * unit::degree;
      const OperatingPoint here = flown();
      const double ratio = here.total_power / upwind.total_power;
      if (ratio <= most || std::isinf(most)) continue;
      most = std::isnan(ratio) ? infinity : ratio;
      worst = {design.flight.horizontal_offset,
               condition,
               state.wind_from,
               upwind.total_power,
               here.total_power,
               upwind.headroom,
               here.headroom};
    }
  }
  return worst;
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
