#include "tethercalc/solve/optimize.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "model/constants.hpp"
#include "solve/thrust_at.hpp"

namespace tethercalc {
namespace {

/// Relative distance at which a tilt is at its limit: a thousand times the accuracy of edges.
constexpr double same_edge = 1e-9;

struct Flights {
  SteadyFlight hover;
  SteadyFlight forward;

  [[nodiscard]] const SteadyFlight& in(Condition condition) const {
    return condition == Condition::hover ? hover : forward;
  }
};

Condition other_than(Condition condition) {
  return condition == Condition::hover ? Condition::forward : Condition::hover;
}

/// The area of least power within any of `areas`, given the least power without them; NaN where
/// there is none.
double cheapest_area(const SteadyFlight& flight, const IntervalSet& areas,
                     const MinimumPower& unconstrained) {
  if (contains(areas, unconstrained.area)) return unconstrained.area;
  if (areas.size() == 1 && unconstrained.power > 0) {
    const double nearest = std::clamp(unconstrained.area, areas[0].lo, areas[0].hi);
    if (is_cheapest_beyond(flight, nearest)) return nearest;
  }
  MinimumPower best{nan, nan};
  for (const Interval& range : areas) best = lesser(best, minimum_power(flight, range));
  return best.area;
}

/// Evaluates `area`, the flight that asks for headroom first: the other only where that is met.
void take(Optimization& result, const Flights& flights, double area) {
  result.area = area;
  const Design& design = flights.hover.design();
  const Condition asked = design.requirements.headroom_at;
  const auto meets = [&](Condition condition) {
    OperatingPoint& point = condition == Condition::hover ? result.hover : result.forward;
    point = evaluate(flights.in(condition), area);
    return demand_margins(design, point, condition).met();
  };
  result.feasible = meets(asked) && meets(other_than(asked));
}

/// The same at `area`, or a hair's breadth inside where it is an edge beyond which a warm cable
/// runs away or a reserve battery leaps, so that rounding may take it out. Where a cable runs away
/// is known to about 1e-9, and differently by the search for the least power.
void take_within(Optimization& result, const Flights& flights, const IntervalSet& areas,
                 double area) {
  take(result, flights, area);
  for (const Interval& range : areas) {
    constexpr double rounding = 1e-8;
    const bool thinnest = area <= range.lo * (1 + rounding);
    if (!thinnest && area < range.hi * (1 - rounding)) continue;
    for (double share = 1e-15; share < 1e-5 && !result.feasible; share *= 10) {
      const double inside = area * (thinnest ? 1 + share : 1 - share);
      if (range.contains(inside)) take(result, flights, inside);
    }
  }
}

/// Where the optimum is the least power and that lies beside a leap of a reserve battery, rounding
/// may take it across: then as little to the side as brings the power back.
void step_back_from_leap(Optimization& result, const Flights& flights) {
  const MinimumPower& least = result.minimum_power;
  const bool at_hover = flights.hover.design().requirements.power_at == Condition::hover;
  const auto is_least = [&](const Optimization& tried) {
    const OperatingPoint& priced = at_hover ? tried.hover : tried.forward;
    return tried.feasible && priced.total_power <= least.power * (1 + same_edge);
  };
  if (result.area != least.area || is_least(result)) return;
  Optimization tried = result;
  for (double share = 1e-14; share < 1e-7; share *= 10) {  // leaps are found to about 1e-12
    for (const double beside : {least.area * (1 - share), least.area * (1 + share)}) {
      take(tried, flights, beside);
      if (!is_least(tried)) continue;
      tried.minimum_power.area = beside;
      result = tried;
      return;
    }
  }
}

bool at_tilt_limit(const OperatingPoint& point, const Design& design) {
  return std::abs(point.pitch) >= design.requirements.max_pitch * (1 - same_edge);
}

/// The edge between the optimum and the minimum-power area: almost always the optimum itself; away
/// from it only where the power has a second valley in the feasible set.
double edge_towards_minimum_power(const Optimization& result) {
  const double area = result.area;
  const auto range = std::ranges::find_if(result.feasible_areas,
                                          [area](const Interval& i) { return i.contains(area); });
  if (range == result.feasible_areas.end()) return area;
  return area > result.minimum_power.area ? range->lo : range->hi;
}

/// Whether the tilt is within its limit, and a tether hangs, at some of these areas.
bool is_within_tilt(const SteadyFlight& flight, const IntervalSet& areas) {
  return std::ranges::any_of(areas, [&flight](const Interval& range) {
    const Interval radii{conductor_radius(range.lo), conductor_radius(range.hi)};
    return !intersection({radii}, radii_within_tilt(flight, radii.hi, radii.lo)).empty();
  });
}

bool hangs(const TetherInFlight& tether, double radius) {
  return std::isfinite(tether.load(radius).down);
}

enum class Side { thinner, thicker };

/// Whether a solved tether hangs at `area` and no more with a conductor slightly to that side: a
/// thicker one may be too heavy for its winch, a thinner one be blown further than there is cable.
bool hangs_just(const SteadyFlight& flight, double area, Side side) {
  constexpr double more = 1 + 2e-3;  // edges are found to a sixth of a thousandth of the radius
  const double radius = conductor_radius(area);
  const TetherInFlight& tether = flight.tether();
  return tether.is_solved() && hangs(tether, radius) &&
         !hangs(tether, side == Side::thicker ? radius * more : radius / more);
}

/// Names the edge of the feasible set that keeps the optimum from the minimum-power area.
void name_limit(Optimization& result, const Flights& flights) {
  const Design& design = flights.hover.design();
  const bool at_minimum = result.area == result.minimum_power.area;
  const double edge = at_minimum ? result.area : edge_towards_minimum_power(result);
  const bool here = edge == result.area;
  const OperatingPoint hover = here ? result.hover : evaluate(flights.hover, edge);
  const OperatingPoint forward = here ? result.forward : evaluate(flights.forward, edge);
  // Before the least power, which is looked for within the tilt limit and may lie on it.
  for (const OperatingPoint* point : {&hover, &forward}) {
    if (at_tilt_limit(*point, design)) {
      result.limited_by = Limit::max_pitch;
      result.limiting_condition = point == &hover ? Condition::hover : Condition::forward;
      return;
    }
  }
  // The least power is looked for where the tether hangs, and may lie on an end of that.
  for (const Condition condition : {Condition::hover, Condition::forward}) {
    const SteadyFlight& flight = flights.in(condition);
    const auto ends = [&](Side side) { return hangs_just(flight, edge, side); };
    if ((edge <= result.minimum_power.area && ends(Side::thicker)) ||
        (edge >= result.minimum_power.area && ends(Side::thinner))) {
      result.limited_by = Limit::tether_shape;
      result.limiting_condition = condition;
      return;
    }
  }
  if (at_minimum) {
    result.limited_by = Limit::minimum_power;
    result.limiting_condition = design.requirements.power_at;
    return;
  }
  const Margins margins = demand_margins(design, hover, forward);
  result.limited_by = limit_of(margins.worst().demand);
  result.limiting_condition = margins.worst().condition;
  if (result.limited_by == Limit::available_power && !(result.area > result.minimum_power.area)) {
    result.limited_by = Limit::takeoff_mass;
  }
}

/// The radii from the thinnest on at which the tilt exceeds its limit.
SteadyFlight::Radii too_tilted_with_solved_tether(const SteadyFlight& flight) {
  constexpr double thinnest = 1e-7;  // m, 3e-8 mm²
  const double heaviest = flight.radius_of_weight(flight.full_thrust());
  const IntervalSet within = radii_within_tilt(flight, heaviest);
  if (within.empty()) return {0, heaviest};
  return {0, within.front().lo > thinnest ? within.front().lo : 0};
}

/// Whether a solved tether reaches its drone with conductors of some size.
bool hangs_somewhere(const TetherInFlight& tether) {
  return std::ranges::any_of(std::array{1e-4, 3e-4, 1e-3, 3e-3},
                             [&](double radius) { return hangs(tether, radius); });
}

/// What keeps the best reachable headroom of one condition below `demanded`.
Limit obstacle(const SteadyFlight& flight, const BestHeadroom& best, double demanded) {
  const bool solved = flight.tether().is_solved();
  if (solved && !(best.value > 0) && !hangs_somewhere(flight.tether())) return Limit::tether_shape;
  for (const Side side : {Side::thinner, Side::thicker}) {
    if (best.value > 0 && hangs_just(flight, best.area, side)) return Limit::tether_shape;
  }
  const SteadyFlight::Radii beyond =
      solved ? too_tilted_with_solved_tether(flight) : flight.beyond_pitch_limit();
  const bool tilts = beyond.lo < beyond.hi;
  if (!(best.value > 0)) return tilts ? Limit::max_pitch : Limit::available_power;
  if (at_tilt_limit(evaluate(flight, best.area), flight.design())) return Limit::max_pitch;
  const double lightest = tilts && !(beyond.lo > 0) ? beyond.hi : 0;
  const double least_thrust = flight.balance(lightest, 0).thrust.value;
  return flight.motor().max_thrust() < demanded * least_thrust ? Limit::motor_thrust
                                                               : Limit::available_power;
}

/// The demand that is missed by least, tried at the ends and in the middle of `areas`.
DemandMargin least_missed(const Flights& flights, const IntervalSet& areas) {
  DemandMargin least{Demand::thrust_headroom, Condition::hover, -infinity};
  for (const Interval& range : areas) {
    for (const double area : {range.lo, std::sqrt(range.lo * range.hi), range.hi}) {
      const Margins margins = demand_margins(flights.hover.design(), evaluate(flights.hover, area),
                                             evaluate(flights.forward, area));
      if (margins.worst().value > least.value) least = margins.worst();
    }
  }
  return least;
}

/// Whether the cable has demands of its own to meet, whatever it delivers.
bool is_cable_judged(const Design& design) {
  return design.requirements.strength_safety_factor > 0 || design.tether.drum.width > 0 ||
         (is_heated(design.tether) && design.tether.insulation.rated_temperature_C);
}

/// Names what an infeasible design lacks: the first demand that no area meets; where each is met by
/// some area but no area meets all, the demand on the cable that is missed by least, or the
/// headroom.
void name_obstacle(Optimization& result, const Flights& flights) {
  const Design& design = flights.hover.design();
  const Requirements& need = design.requirements;
  for (const DemandMargin& margin : demand_margins(design, OperatingPoint{}, Condition::hover)) {
    if (margin.demand != Demand::input_voltage || margin.met()) continue;
    result.limited_by = Limit::input_voltage;
    return;
  }
  const Condition asked = need.headroom_at;
  struct Wanted {
    Condition condition;
    double headroom;
  };
  Wanted missed{asked, demanded_headroom(need, asked)};
  result.best_headroom = best_headroom(flights.in(asked));
  const bool enough = result.best_headroom.value >= missed.headroom;
  if (enough && is_cable_judged(design)) {
    // Where each flight can be flown, whatever the cable stands.
    const auto flyable_in = [&](Condition condition) {
      return headroom_areas(flights.in(condition), demanded_headroom(need, condition));
    };
    const IntervalSet flyable =
        intersection(flyable_in(Condition::hover), flyable_in(Condition::forward));
    if (!flyable.empty()) {
      const DemandMargin margin = least_missed(flights, flyable);
      result.limited_by = limit_of(margin.demand);
      result.limiting_condition = margin.condition;
      result.best_headroom = best_headroom(flights.in(margin.condition));
      return;
    }
  }
  for (const Condition condition : {Condition::hover, Condition::forward}) {
    const SteadyFlight& flight = flights.in(condition);
    const bool flies = condition == asked
                           ? result.best_headroom.value >= 1
                           : evaluate(flight, result.best_headroom.area).headroom >= 1 ||
                                 !headroom_areas(flight, 1).empty();
    if (!flies) {
      missed = {condition, 1};
      break;
    }
  }
  if (missed.condition != asked) result.best_headroom = best_headroom(flights.in(missed.condition));
  result.limiting_condition = missed.condition;
  result.limited_by = obstacle(flights.in(missed.condition), result.best_headroom, missed.headroom);
}

/// Takes the cheapest of the areas that meet the demands of the flight in which headroom is asked
/// for, where it meets the others', too; else the cheapest that meet both.
void search_feasible_areas(Optimization& result, const Flights& flights) {
  const Requirements& need = flights.hover.design().requirements;
  const SteadyFlight& priced = flights.in(need.power_at);
  const Condition asked = need.headroom_at;
  const auto meeting = [&](Condition condition) {
    return areas_meeting_demands(flights.in(condition), demanded_headroom(need, condition));
  };
  result.feasible_areas = meeting(asked);
  if (!is_cable_judged(flights.hover.design()) && !need.buffer_battery) {
    result.headroom_areas = result.feasible_areas;
  }
  const double area = cheapest_area(priced, result.feasible_areas, result.minimum_power);
  if (area > 0) take(result, flights, area);
  if (result.feasible || result.feasible_areas.empty()) return;
  result.feasible_areas = intersection(result.feasible_areas, meeting(other_than(asked)));
  const double met = cheapest_area(priced, result.feasible_areas, result.minimum_power);
  if (met > 0) take_within(result, flights, result.feasible_areas, met);
}

/// The optimum where there is one, without a name for what limits it.
Optimization searched(const Flights& flights) {
  Optimization result;
  result.minimum_power = minimum_power(flights.in(flights.hover.design().requirements.power_at));
  // The cheapest of all areas is the optimum if it is feasible, which saves a search that takes
  // long where the power has no simple shape.
  if (!hull_is_one_valley(flights.hover.design()) && result.minimum_power.area > 0) {
    take(result, flights, result.minimum_power.area);
  }
  if (!result.feasible) search_feasible_areas(result, flights);
  return result;
}

Optimization optimum_of(const Flights& flights) {
  Optimization result = searched(flights);
  if (result.feasible) {
    step_back_from_leap(result, flights);
    name_limit(result, flights);
  } else {
    result.area = nan;
    name_obstacle(result, flights);
  }
  return result;
}

Flights flights_of(const Design& design) {
  const SteadyFlight hover(design, Condition::hover);
  return {hover, hover.in(Condition::forward)};
}

}  // namespace

Limit limit_of(Demand demand) {
  constexpr std::array<Limit, demand_count> limits{Limit::tether_shape,
                                                   Limit::takeoff_mass,
                                                   Limit::max_pitch,
                                                   Limit::input_voltage,
                                                   Limit::drum_width,
                                                   Limit::available_power,
                                                   Limit::conductor_temperature,
                                                   Limit::conductor_temperature,
                                                   Limit::tether_strength,
                                                   Limit::converter_rating};  // as in Demand
  return limits[static_cast<std::size_t>(demand)];
}

Limit missed_limit(const Design& design, const OperatingPoint& point, Demand demand) {
  if (demand != Demand::thrust_headroom) return limit_of(demand);
  if (point.thermal_runaway) return Limit::conductor_temperature;
  const bool saturated = point.available_thrust >= motor_in_flight(design).max_thrust();
  return saturated ? Limit::motor_thrust : limit_of(demand);
}

Optimization optimum_alone(const Design& design) { return optimum_of(flights_of(design)); }

bool is_feasible(const Design& design) {
  const Flights flights = flights_of(design);
  if (flights.hover.tether().is_solved() && design.tether.winch_pull > 0) {
    // In hover mostly soon known; that the winch is too weak in forward flight takes long.
    const double wanted = demanded_headroom(design.requirements, Condition::hover);
    const IntervalSet hovers = areas_meeting_demands(flights.hover, wanted);
    if (!is_within_tilt(flights.forward, hovers)) return false;
  }
  return searched(flights).feasible;
}

Optimization optimize(const Design& design) {
  const Flights flights = flights_of(design);
  Optimization result = optimum_of(flights);
  const Requirements& need = design.requirements;
  if (result.headroom_areas.empty()) {
    result.headroom_areas = headroom_areas(flights.in(need.headroom_at), need.thrust_headroom);
  }
  // Of an optimum that needed no search.
  if (result.feasible && result.feasible_areas.empty()) {
    result.feasible_areas =
        need.buffer_battery ? IntervalSet{{0, infinity}} : result.headroom_areas;
  }
  return result;
}

}  // namespace tethercalc
