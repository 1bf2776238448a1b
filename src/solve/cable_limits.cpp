#include "solve/cable_limits.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "tethercalc/solve/headroom.hpp"

namespace tethercalc {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Half of the digits: at a smooth optimum the value is then exact to all of them.
constexpr int half_the_bits = std::numeric_limits<double>::digits / 2;

/// Areas a grid has; what a range of areas narrower than its ratio hides is found by climbing from
/// the best of them.
constexpr int grid_size = 48;

struct Points {
  OperatingPoint hover;
  OperatingPoint forward;
};

/// A design in both conditions, as functions of the logarithm of the area.
class BothFlights {
 public:
  explicit BothFlights(const Design& design)
      : design_(design), hover_(design, Condition::hover), forward_(design, Condition::forward) {}

  [[nodiscard]] Points at(double log_area) const {
    const double area = std::exp(log_area);
    return {evaluate(hover_, area), evaluate(forward_, area)};
  }

  [[nodiscard]] DemandMargin worst(double log_area) const {
    const Points points = at(log_area);
    return demand_margins(design_, points.hover, points.forward).worst();
  }

  /// Of the demand for headroom.
  [[nodiscard]] bool headroom_met(double log_area) const {
    const Points points = at(log_area);
    const Requirements& need = design_.requirements;
    const OperatingPoint& p = need.headroom_at == Condition::hover ? points.hover : points.forward;
    return p.headroom >= need.thrust_headroom;
  }

  /// Power where it is priced; infinite where it does not exist.
  [[nodiscard]] double power(double log_area) const {
    const bool hover = design_.requirements.power_at == Condition::hover;
    const double power = evaluate(hover ? hover_ : forward_, std::exp(log_area)).total_power;
    return power > 0 ? power : infinity;
  }

 private:
  const Design& design_;
  SteadyFlight hover_;
  SteadyFlight forward_;
};

std::vector<double> grid(double lo, double hi) {
  std::vector<double> points;
  for (int i = 0; i <= grid_size; ++i) points.push_back(lo + (hi - lo) * i / grid_size);
  return points;
}

/// Where `value` is largest between neighbours of its largest grid point.
template <typename Function>
double argmax(const Function& value, const std::vector<double>& points) {
  std::size_t best = 0;
  double most = -infinity;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double here = value(points[i]);
    if (here > most) {
      most = here;
      best = i;
    }
  }
  const double lo = points[best > 0 ? best - 1 : 0];
  const double hi = points[std::min(best + 1, points.size() - 1)];
  const auto minus = [&](double x) { return -std::max(value(x), -1e300); };
  const double refined = boost::math::tools::brent_find_minima(minus, lo, hi, half_the_bits).first;
  return value(refined) > most ? refined : points[best];
}

/// The ranges within [lo, hi] in which `met` holds. Seen are those that hold a grid point or
/// `inside`.
template <typename Predicate>
IntervalSet ranges_of(const Predicate& met, double lo, double hi, double inside) {
  std::vector<double> points = grid(lo, hi);
  points.insert(std::upper_bound(points.begin(), points.end(), inside), inside);
  const auto edge = [&](double good, double bad) {
    // To the last digit of the area, from the good side.
    while (std::abs(good - bad) > 1e-14) {
      const double middle = 0.5 * (good + bad);
      if (middle == good || middle == bad) break;
      (met(middle) ? good : bad) = middle;
    }
    return good;
  };
  IntervalSet ranges;
  bool before = false;
  double start = lo;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool now = met(points[i]);
    if (now && !before) start = i == 0 ? points[i] : edge(points[i], points[i - 1]);
    if (!now && before) append(ranges, {start, edge(points[i - 1], points[i])});
    before = now;
  }
  if (before) append(ranges, {start, hi});
  return ranges;
}

IntervalSet in_square_metres(IntervalSet logarithms) {
  for (Interval& range : logarithms) range = {std::exp(range.lo), std::exp(range.hi)};
  return logarithms;
}

/// The design as cold and as light as it can be, without limits: whatever is feasible with them is
/// feasible here, since resistance only rises with temperature and thrust with mass. (Tilt falls
/// with mass, so that its limit is not the light design's to judge.)
Design without_limits(Design design) {
  design.tether = without_heat(design.tether);
  design.requirements.strength_safety_factor = 0;
  if (design.drone.reserve_battery.specific_energy > 0) {
    design.drone.reserve_battery.specific_energy = 0;
    design.requirements.max_pitch = std::max(design.requirements.max_pitch, 85 * unit::degree);
  }
  return design;
}

/// The areas at which `cold`, the design without limits, meets the demands on the thrust.
IntervalSet areas_without_limits(const Design& design, const Design& cold) {
  const Requirements& need = design.requirements;
  IntervalSet possible = headroom_areas(SteadyFlight(cold, Condition::hover), 1);
  possible = intersection(possible, headroom_areas(SteadyFlight(cold, Condition::forward), 1));
  if (!need.buffer_battery) {
    const SteadyFlight judged(cold, need.headroom_at);
    possible = intersection(possible, headroom_areas(judged, need.thrust_headroom));
  }
  std::erase_if(possible, [](const Interval& i) { return !(i.lo > 0 && i.hi < infinity); });
  return possible;
}

}  // namespace

bool has_cable_limits(const Design& design) {
  return is_heated(design.tether) || design.requirements.strength_safety_factor > 0 ||
         design.drone.reserve_battery.specific_energy > 0 ||
         design.supply.converter.rated_output_power.has_value();
}

BestHeadroom best_headroom(const Design& design, Condition condition) {
  const SteadyFlight flight(design, condition);
  const BestHeadroom bare = best_headroom(flight);
  const bool depends_on_area =
      is_heated(design.tether) || design.drone.reserve_battery.specific_energy > 0;
  if (!depends_on_area || !(bare.value > 0)) return bare;
  const auto headroom = [&](double log_area) {
    const double value = evaluate(flight, std::exp(log_area)).headroom;
    return value > 0 ? value : 0;  // none where it does not exist
  };
  // Warmer and heavier conductors are better thicker and thinner; by a factor of 20 suffices.
  const double middle = std::log(bare.area);
  const double best = argmax(headroom, grid(middle - 3, middle + 3));
  return headroom(best) > 0 ? BestHeadroom{headroom(best), std::exp(best)} : BestHeadroom{0, nan};
}

bool feasible_within_cable_limits(const Design& design) {
  const Design cold = without_limits(design);
  const BothFlights flights(design);
  const auto worst_margin = [&](double x) { return flights.worst(x).value; };
  for (const Interval& range : areas_without_limits(design, cold)) {
    const std::vector<double> points = grid(std::log(range.lo), std::log(range.hi));
    if (std::any_of(points.begin(), points.end(),
                    [&](double x) { return worst_margin(x) >= -margin_rounding; }) ||
        worst_margin(argmax(worst_margin, points)) >= -margin_rounding) {
      return true;
    }
  }
  return false;
}

Optimization optimize_within_cable_limits(const Design& design) {
  const Design cold = without_limits(design);
  Optimization result = optimize_without_cable_limits(cold);
  const IntervalSet possible = areas_without_limits(design, cold);
  const bool possible_at_all = result.feasible;
  const BothFlights flights(design);
  const auto met = [&](double x) { return flights.worst(x).met(); };
  const auto headroom_met = [&](double x) { return flights.headroom_met(x); };
  const auto worst_margin = [&](double x) { return flights.worst(x).value; };
  const auto minus_power = [&](double x) { return -flights.power(x); };

  result.feasible = false;
  result.area = nan;
  result.headroom_areas.clear();
  result.feasible_areas.clear();
  double best_power = infinity;
  double best_x = nan;
  std::optional<DemandMargin> least_violated;
  for (const Interval& range : possible) {
    const double lo = std::log(range.lo);
    const double hi = std::log(range.hi);
    const double most_met = argmax(worst_margin, grid(lo, hi));
    const DemandMargin margin = flights.worst(most_met);
    if (!least_violated || margin.value > least_violated->value) least_violated = margin;
    for (const Interval& part : ranges_of(headroom_met, lo, hi, most_met)) {
      append(result.headroom_areas, in_square_metres({part}).front());
    }
    for (const Interval& part : ranges_of(met, lo, hi, most_met)) {
      append(result.feasible_areas, in_square_metres({part}).front());
      const double x = argmax(minus_power, grid(part.lo, part.hi));
      if (flights.power(x) < best_power) {
        best_power = flights.power(x);
        best_x = x;
      }
    }
  }
  if (std::isfinite(result.minimum_power.area)) {
    // The least power of the warm cable, around that of the cold one.
    const double cold_x = std::log(result.minimum_power.area);
    const double x = argmax(minus_power, grid(cold_x - 2, cold_x + 2));
    const double power = flights.power(x);
    result.minimum_power =
        power < infinity ? MinimumPower{std::exp(x), power} : MinimumPower{nan, nan};
    if (power <= best_power * (1 + 1e-9) && std::isfinite(best_x) && met(x)) best_x = x;
  }
  if (!std::isfinite(best_x)) {
    if (possible_at_all && least_violated) {
      result.limited_by = limit_of(least_violated->demand);
      result.limiting_condition = least_violated->condition;
    }
    return result;
  }
  const Points points = flights.at(best_x);
  result.feasible = true;
  result.area = std::exp(best_x);
  result.hover = points.hover;
  result.forward = points.forward;
  result.limited_by = Limit::minimum_power;
  result.limiting_condition = design.requirements.power_at;
  const bool on_edge = std::any_of(result.feasible_areas.begin(), result.feasible_areas.end(),
                                   [&](const Interval& range) {
                                     return std::abs(result.area / range.lo - 1) < 1e-6 ||
                                            std::abs(result.area / range.hi - 1) < 1e-6;
                                   });
  if (on_edge) {
    const Margins all = demand_margins(design, points.hover, points.forward);
    const DemandMargin& tightest = all.worst();
    result.limited_by = limit_of(tightest.demand);
    result.limiting_condition = tightest.condition;
    if (result.limited_by == Limit::available_power && !(result.area > result.minimum_power.area)) {
      result.limited_by = Limit::takeoff_mass;
    }
  }
  return result;
}

}  // namespace tethercalc
