// Notation: r conductor radius; TN necessary thrust per motor; k headroom asked for; V²/R the power
// that a loop of resistance R makes available.
// What is asked for rises with r: mass, drag, tension, TN, the power for k·TN. (Of a solved tether
// it falls no faster than `least_up_to` and `most_down_to` allow, which stand for a and b then.)
// What there is rises with r too: V²/R and the breaking load. So between two radii a < b no margin
// is more than what there is at b over what is asked for at a, and none is less than what there is
// at a over what is asked for at b. Where these bounds decide nothing, the stretch is split.

#include "tethercalc/solve/headroom.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <utility>

#include "model/constants.hpp"
#include "model/tether_heat.hpp"
#include "solve/thrust_at.hpp"
#include "tethercalc/model/drum_package.hpp"
#include "tethercalc/model/operating_point.hpp"
#include "tethercalc/model/power_line.hpp"

namespace tethercalc {
namespace {

struct Range {
  double least = infinity;
  double most = 0;
};

/// What is demanded of one flight.
class FlightDemands {
 public:
  FlightDemands(const SteadyFlight& flight, double headroom, bool of_cable)
      : flight_(flight), tether_(flight), headroom_(headroom), of_cable_(of_cable) {
    const Design& design = flight.design();
    heated_ = is_heated(design.tether);
    convex_weight_ =
        design.drone.reserve_battery.specific_energy == 0 ||
        (flight.motor().is_convex() &&
         !(flight.lands_in_wind() && design.drone.translational_lift.induced_share > 0));
  }

  [[nodiscard]] const SteadyFlight& flight() const { return flight_; }
  [[nodiscard]] double headroom() const { return headroom_; }
  [[nodiscard]] bool heated() const { return heated_; }

  /// N, the most that may be necessary, whatever the cable.
  [[nodiscard]] double most_thrust() const {
    return flight_.most_thrust(flight_.power_share(0).value) / headroom_;
  }

  struct Margin {
    double value = 0;      ///< relative; −1 where there is no steady state
    double warming = 1;    ///< the loop's resistance over that of a cold one
    double hottest_C = 0;  ///< °C, of a warm one
  };

  /// The least margin at a radius at which there is what there is at `supply` while what is asked
  /// for is that at `need`.
  [[nodiscard]] Margin margin(const ThrustAt& need, const ThrustAt& supply) const {
    const double asked = power_for_headroom(need);
    const double cold = flight_.tether().resistance(supply.radius);
    const double rating = rating_margin(need);
    const double over_cold = std::min(flight_.available_power(cold) / asked - 1, rating);
    if (!heated_ || over_cold < 0) return {over_cold};
    const TetherHeatState state = tether_.state(flight_.drone_power(need.thrust.value, need.share),
                                                supply.radius, need.radius);
    if (!state.steady) return {-1, infinity, infinity};
    const double least = std::min(flight_.available_power(state.resistance) / asked - 1, rating);
    const auto rated = flight_.design().tether.insulation.rated_temperature_C;
    const double cooler = of_cable_ && rated ? (*rated - state.hottest()) / 100 : infinity;
    return {std::min(least, cooler), state.resistance / cold, state.hottest()};
  }

  /// The radius that would make the power asked for at `need` available over a cold cable.
  [[nodiscard]] double needed_radius(const ThrustAt& need) const {
    return flight_.radius_of_available_power(power_for_headroom(need));
  }

  /// −1 or 1 where the margin of a cold cable is certain to fall or to rise all the way from a to
  /// b, else 0.
  [[nodiscard]] int trend(const ThrustAt& a, const ThrustAt& b) const {
    // Nothing is known of how the load of a solved tether bends, nor a share of the power.
    if (flight_.tether().is_solved() || flight_.share_changes()) return 0;
    const MotorCurve& motor = flight_.motor();
    if (!convex_weight_ && motor.piece(a.landing_thrust) != motor.piece(b.landing_thrust)) return 0;
    const Range price = price_of_thrust(a, b);
    const StraightTether& tether = flight_.tether().straight();
    // V²/R = V²/(c + k/r²) rises with V²·2k·r/(c·r² + k)².
    const double per_square = 2 * flight_.available_power(1) * tether.resistance_area();
    const auto bend = [&](double r) {
      const double root = tether.contact_resistance() * r * r + tether.resistance_area();
      return root * root;
    };
    const double least = per_square * a.radius / bend(b.radius);
    const double most = per_square * b.radius / bend(a.radius);
    if (least > headroom_ * price.most * b.thrust.slope) return 1;
    return most < headroom_ * price.least * a.thrust.slope ? -1 : 0;
  }

 private:
  [[nodiscard]] double power_for_headroom(const ThrustAt& need) const {
    return flight_.drone_power(headroom_ * need.thrust.value, need.share);
  }

  /// Where the share of the motors' power changes: else `most_thrust` keeps the rating.
  [[nodiscard]] double rating_margin(const ThrustAt& need) const {
    const auto rated_output = flight_.design().supply.converter.rated_output_power;
    if (!rated_output || !flight_.share_changes()) return infinity;
    const double power = flight_.motor().power(headroom_ * need.thrust.value);
    return *rated_output / flight_.output_power(power, need.share) - 1;
  }

  /// W at the converter's input for one more N of one motor, between a and b.
  [[nodiscard]] Range price_of_thrust(const ThrustAt& a, const ThrustAt& b) const {
    constexpr std::size_t most_pieces = 16;
    const MotorCurve& motor = flight_.motor();
    const Converter& converter = flight_.design().supply.converter;
    const std::size_t first = motor.piece(headroom_ * a.thrust.value);
    const std::size_t last = motor.piece(headroom_ * b.thrust.value);
    if (last - first > most_pieces) return {0, infinity};
    Range price;
    for (std::size_t i = first; i <= last; ++i) {
      price.least = std::min(price.least, motor.slope(i));
      price.most = std::max(price.most, motor.slope(i));
    }
    // On a piece of the efficiency curve the slope of the input power is monotone.
    const double from = flight_.output_power(motor.power(headroom_ * a.thrust.value), a.share);
    const double to = flight_.output_power(motor.power(headroom_ * b.thrust.value), b.share);
    if (!std::isnan(converter_kink(converter, from, to))) return {0, infinity};
    const EfficiencyPiece piece = efficiency_piece(converter, 0.5 * (from + to));
    const auto [least, most] = std::minmax({piece.input_slope(from), piece.input_slope(to)});
    return {price.least * flight_.output_power(least, a.share),
            price.most * flight_.output_power(most, b.share)};
  }

  const SteadyFlight& flight_;
  WarmTether tether_;
  double headroom_;
  bool of_cable_;  ///< rated temperatures as well
  bool heated_;
  bool convex_weight_;  ///< over the radius
};

/// The radii at which demands on one flight are met.
class RadiiSearch {
 public:
  explicit RadiiSearch(const FlightDemands& demands) : demands_(demands) {}

  /// Those from lo to hi.
  void search(double lo, double hi) {
    const SteadyFlight& flight = demands_.flight();
    if (!(lo < hi)) return;
    ThrustAt first = thrust_at(flight, lo, 0);
    const double most = demands_.most_thrust();
    // A hair's breadth more is what rounding makes of it.
    if (!(first.thrust.value <= most * (1 + 1e-12))) return;
    const bool may_fall = flight.tether().is_solved() || flight.share_changes();
    if (may_fall) {
      lo = std::max(lo, demands_.needed_radius(least_up_to(flight, first, hi)));
      if (!(lo < hi)) return;
      first = thrust_at(flight, lo, first.tan_pitch);
    }
    for (int step = 0; step < 8 && !may_fall;
         ++step) {  // nothing is met up to the radius that would suffice
      const double needed = demands_.needed_radius(first);
      if (!(needed < hi)) return;
      if (needed <= first.radius) break;
      const bool close = needed <= 1.1 * first.radius;
      first = thrust_at(flight, needed, first.tan_guess(needed));
      if (close) break;
    }
    ThrustAt last = thrust_at(flight, hi, first.tan_guess(hi));
    if (first.thrust.value > most) return;
    if (last.thrust.value > most) last = at_thrust(flight, most, first.radius, hi, last);
    if (first.radius < last.radius) collect(end_at(first), end_at(last));
  }

  [[nodiscard]] IntervalSet found() { return std::move(radii_); }

 private:
  struct End {
    ThrustAt at;
    FlightDemands::Margin margin;

    [[nodiscard]] bool met() const { return margin.value >= 0; }
    /// About the logarithm of what there is over what is asked for, in (−2, 2).
    [[nodiscard]] double excess() const { return 2 * margin.value / (2 + margin.value); }
  };

  [[nodiscard]] End end_at(const ThrustAt& at) const { return {at, demands_.margin(at, at)}; }
  [[nodiscard]] End between(const End& a, double radius) const {
    return end_at(thrust_at(demands_.flight(), radius, a.at.tan_guess(radius)));
  }

  /// No margin between a and b is less, and none is more.
  [[nodiscard]] FlightDemands::Margin least_margin(const End& a, const End& b) const {
    return demands_.margin(most_down_to(demands_.flight(), b.at, a.at.radius), a.at);
  }
  [[nodiscard]] FlightDemands::Margin most_margin(const End& a, const End& b) const {
    return demands_.margin(least_up_to(demands_.flight(), a.at, b.at.radius), b.at);
  }

  /// Ratio of radii at which a smooth stretch is so narrow that its margin has one hump at most.
  static constexpr double narrow = 1.05;
  /// More than any design has been seen to take by a factor of 100; then only ends are compared.
  static constexpr int most_stretches = 5000;

  void collect(const End& a, const End& b) {
    if (monotone(a, b)) return collect_monotone(a, b);
    if (a.met() && b.met() && least_margin(a, b).value >= 0) {
      return append(radii_, {a.at.radius, b.at.radius});
    }
    if (!a.met() && !b.met() && most_margin(a, b).value < 0) return;
    const double ratio = b.at.radius / a.at.radius;
    if (++stretches_ > most_stretches || ratio < 1 + 1e-12) return collect_monotone(a, b);
    // Where the cable runs away there is no margin that could point to what lies between.
    const bool runs_away = !a.met() && !b.met() && std::min(a.margin.value, b.margin.value) == -1;
    if (ratio < narrow && !runs_away && smooth(a, b)) return collect_narrow(a, b);
    const End middle = between(a, std::sqrt(a.at.radius * b.at.radius));
    collect(a, middle);
    collect(middle, b);
  }

  /// Whether neither the power asked for nor the one that heats the cable has a kink from a to b.
  [[nodiscard]] bool smooth(const End& a, const End& b) const {
    return on_one_piece(demands_.flight(), a.at, b.at, demands_.headroom()) &&
           (!demands_.heated() || on_one_piece(demands_.flight(), a.at, b.at));
  }

  /// Whether the margin only rises or only falls from a to b, or passes 0 once. A cable that gets
  /// cooler from a to b, and not much thicker, is taken to do so all the way, where not even the
  /// load at b makes that at a run away.
  [[nodiscard]] bool monotone(const End& a, const End& b) const {
    constexpr double not_much = 1.5;
    const int trend = demands_.trend(a.at, b.at);
    if (a.margin.warming == 1 && b.margin.warming == 1) return trend != 0 && !demands_.heated();
    return trend == 1 && b.at.radius < not_much * a.at.radius && a.margin.warming < infinity &&
           b.margin.warming <= a.margin.warming && b.margin.hottest_C <= a.margin.hottest_C &&
           (smooth(a, b) || (a.met() != b.met() && demands_.flight().motor().is_convex())) &&
           (a.met() || b.met() || cools_up_to(b)) && demands_.margin(b.at, a.at).warming < infinity;
  }

  /// Whether a little more conductor still cools the cable there: the sun warms thick ones.
  [[nodiscard]] bool cools_up_to(const End& b) const {
    constexpr double little = 1 - 1e-3;
    return between(b, little * b.at.radius).margin.hottest_C >= b.margin.hottest_C;
  }

  /// From a to b the margin only rises or only falls.
  void collect_monotone(const End& a, const End& b) {
    if (a.met() && b.met()) return append(radii_, {a.at.radius, b.at.radius});
    if (!a.met() && !b.met()) return;
    const double edge = crossing(a, b);
    append(radii_, a.met() ? Interval{a.at.radius, edge} : Interval{edge, b.at.radius});
  }

  /// A stretch on which the margin has one hump at most.
  void collect_narrow(const End& a, const End& b) {
    if (a.met() != b.met()) return collect_monotone(a, b);
    // Towards the other sign from both ends, or there is nothing between them.
    constexpr double nearby = 1e-6;
    const double sign = a.met() ? 1 : -1;
    const auto approaches = [&](const End& end, double radius) {
      return sign * between(a, radius).margin.value < sign * end.margin.value;
    };
    if (!approaches(a, a.at.radius * (1 + nearby)) || !approaches(b, b.at.radius * (1 - nearby))) {
      return collect_monotone(a, b);
    }
    // Half of the digits: at a smooth extreme the value is then exact to all of them.
    constexpr int bits = std::numeric_limits<double>::digits / 2;
    const double radius = boost::math::tools::brent_find_minima(
                              [&](double r) { return sign * between(a, r).margin.value; },
                              a.at.radius, b.at.radius, bits)
                              .first;
    const End extreme = between(a, radius);
    collect_monotone(a, extreme);
    collect_monotone(extreme, b);
  }

  /// The radius between two at which the margin passes 0, to 1e-12, by secants in a bracket.
  [[nodiscard]] double crossing(End a, End b) const {
    // The error of a secant through two radii is about the product of theirs: of the last step, and
    // of the distance between them, which is long where one was left behind at the bracket's end.
    constexpr double last_step = 1e-9;
    constexpr double last_error = 1e-15;
    double lo = a.at.radius;
    double hi = b.at.radius;
    const bool enters = b.met();
    End before = a;
    End now = b;
    if (std::abs(a.margin.value) < std::abs(b.margin.value)) std::swap(before, now);
    for (int step = 1; step < 200 && now.margin.value != 0; ++step) {
      const double apart = now.at.radius - before.at.radius;
      const double change = now.excess() * apart / (now.excess() - before.excess());
      double next = now.at.radius - change;
      const bool inside = next > lo && next < hi && step % 6 != 0;
      if (inside && step > 2 && std::abs(change) <= last_step * next &&
          std::abs(change * apart) <= last_error * next * next) {
        return next;
      }
      if (!inside) next = 0.5 * (lo + hi);
      if (!(lo < next && next < hi)) return enters ? hi : lo;
      before = now;
      now = between(a, next);
      (now.met() == enters ? hi : lo) = next;
    }
    return now.at.radius;
  }

  const FlightDemands& demands_;
  IntervalSet radii_;
  int stretches_ = 0;
};

IntervalSet areas_meeting(const FlightDemands& demands, const IntervalSet& radii) {
  RadiiSearch search(demands);
  for (const Interval& range : radii) search.search(range.lo, range.hi);
  IntervalSet areas = search.found();
  for (Interval& range : areas) range = {conductor_area(range.lo), conductor_area(range.hi)};
  return areas;
}

/// The radii up to which the necessary thrust, in still air, is what it may be at most.
double heaviest_radius(const FlightDemands& demands) {
  const SteadyFlight& flight = demands.flight();
  return flight.radius_of_weight(flight.design().drone.motor_count * demands.most_thrust());
}

/// The radius up to which the drum holds a turn.
double widest_wound(const Design& design) {
  const double wall = insulation_wall(design.tether.insulation, design.supply.voltage);
  return std::max(widest_wound_radius(design.tether, wall), 0.0);
}

/// Thinner solved tethers than this, of those up to `hi`, do not deliver what is demanded.
double least_delivering(const FlightDemands& demands, double hi) {
  const SteadyFlight& flight = demands.flight();
  if (!flight.tether().is_solved() || !(hi > thinnest_radius)) return 0;
  const ThrustAt first = thrust_at(flight, thinnest_radius, 0);
  if (!(first.thrust.value < infinity)) return 0;
  return demands.needed_radius(least_up_to(flight, first, hi));
}

/// The radii up to `hi` within the tilt limit, but for some that do not deliver what is demanded.
IntervalSet radii_asked(const FlightDemands& demands, double hi) {
  return radii_within_tilt(demands.flight(), hi, least_delivering(demands, hi));
}

/// The radii up to `hi` at which the tether is strong enough. Its tension grows with the square of
/// the radius at most: metal gets the better the thicker it is, a strength member the worse.
IntervalSet strong_radii(const SteadyFlight& flight, double hi) {
  const Design& design = flight.design();
  const double factor = design.requirements.strength_safety_factor;
  if (factor == 0 || !(hi > 0)) return {{0, hi}};
  const auto strong = [&](double radius) {
    return breaking_load(design.tether, conductor_area(radius)) >=
           factor * flight.tether().load(radius).greatest_tension();
  };
  const bool metal = strength_member_data(design.tether.strength_member).strength == 0;
  if (!strong(metal ? hi : 0)) return {};
  if (!metal && strong(hi)) return {{0, hi}};
  double weak_end = metal ? 0 : hi;
  double strong_end = metal ? hi : 0;
  for (double middle = 0.5 * hi; middle != weak_end && middle != strong_end;
       middle = 0.5 * (weak_end + strong_end)) {
    (strong(middle) ? strong_end : weak_end) = middle;
  }
  return metal ? IntervalSet{{strong_end, hi}} : IntervalSet{{0, strong_end}};
}

}  // namespace

IntervalSet headroom_areas(const SteadyFlight& flight, double required) {
  const FlightDemands demands(flight, required, false);
  return areas_meeting(demands, radii_asked(demands, heaviest_radius(demands)));
}

IntervalSet areas_meeting_demands(const SteadyFlight& flight, double required) {
  const FlightDemands demands(flight, required, true);
  const double heaviest = std::min(heaviest_radius(demands), widest_wound(flight.design()));
  return areas_meeting(
      demands, intersection(radii_asked(demands, heaviest), strong_radii(flight, heaviest)));
}

namespace {

/// The most headroom along the radius, by the bound that between two radii it is no more than what
/// is available at the upper over what is necessary at the lower.
class BestHeadroomSearch {
 public:
  explicit BestHeadroomSearch(const SteadyFlight& flight)
      : flight_(flight), tether_(flight), heated_(is_heated(flight.design().tether)) {}

  void search(double lo, double hi) {
    // Below, not even a millionth of what is necessary is available.
    const double necessary = flight_.necessary_thrust(flight_.weight(lo), 0);
    const double least_share = flight_.power_share(0).value;
    lo = std::max(
        lo, flight_.radius_of_available_power(flight_.drone_power(1e-6 * necessary, least_share)));
    if (lo < hi) improve(look(thrust_at(flight_, lo, 0)), look(thrust_at(flight_, hi, 0)));
  }

  [[nodiscard]] const BestHeadroom& best() const { return best_; }

 private:
  struct Look {
    ThrustAt at;           ///< whatever the tilt limit
    double arriving = 0;   ///< W available at the converter
    double available = 0;  ///< N
    double headroom = 0;
    bool steady = false;  ///< there is a steady state of a heated cable
  };

  Look look(const ThrustAt& at) {
    Look here{at};
    double resistance = flight_.tether().resistance(at.radius);
    if (heated_) {
      const double power = flight_.drone_power(at.thrust.value, at.share);
      if (supplied_power(flight_.design().supply.voltage, resistance, power) > 0) {
        const TetherHeatState state = tether_.state(power, at.radius, at.radius);
        if (!state.steady) return here;
        here.steady = true;
        resistance = state.resistance;
      }
    }
    here.arriving = flight_.available_power(resistance);
    here.available = flight_.available_thrust(here.arriving, at.share);
    here.headroom = here.available / at.thrust.value;
    if (here.headroom > best_.value) {
      const double area = conductor_area(at.radius);
      const double judged = evaluate(flight_, area).headroom;
      // On the brink of running away a state may be too close to it for the judge.
      if (!(judged > 0)) return {at};
      if (judged > best_.value) best_ = {judged, area};
    }
    return here;
  }
  Look between(const Look& a, double radius) {
    return look(thrust_at(flight_, radius, a.at.tan_guess(radius)));
  }

  void improve(const Look& a, const Look& b) {
    constexpr int most_stretches = 5000;  // a hundred times more than usual
    // Warm cables may run away within rounding of where the load can still be delivered.
    const double rounding = heated_ ? 1e-9 : 1e-13;
    if (!(most_headroom(a, b) > best_.value * (1 + 0.1 * rounding))) return;
    if (b.at.radius < a.at.radius * (1 + rounding)) return;
    if (++stretches_ > most_stretches) return;
    const double kink = kink_between(a, b);
    if (b.at.radius < 1.02 * a.at.radius && std::isnan(kink) && a.headroom > 0 && b.headroom > 0 &&
        a.steady == b.steady) {
      // Half of the digits: at a smooth maximum the value is then exact to all of them.
      constexpr int bits = std::numeric_limits<double>::digits / 2;
      (void)boost::math::tools::brent_find_minima([&](double r) { return -between(a, r).headroom; },
                                                  a.at.radius, b.at.radius, bits);
      return;
    }
    const Look middle = between(a, std::isnan(kink) ? std::sqrt(a.at.radius * b.at.radius) : kink);
    // The more promising side first.
    if (a.headroom > b.headroom) improve(a, middle);
    improve(middle, b);
    if (a.headroom <= b.headroom) improve(a, middle);
  }

  /// No less than the headroom between a and b: that of the conductor at b with the load at a, or
  /// of a cold one, but less than 1, where the load cannot be delivered at all.
  [[nodiscard]] double most_headroom(const Look& a, const Look& b) const {
    const ThrustAt least = least_up_to(flight_, a.at, b.at.radius);
    const auto over = [&](double resistance) {
      return flight_.available_thrust(flight_.available_power(resistance), least.share) /
             least.thrust.value;
    };
    const double cold = over(least_cold_resistance(flight_, a.at.radius, b.at.radius));
    if (!heated_ || cold <= best_.value) return cold;
    const double warm = over(least_resistance(tether_, flight_, least, b.at.radius));
    const double most_share = shares_between(flight_, a.at, b.at).second;
    const bool delivered =
        supplied_power(flight_.design().supply.voltage, flight_.tether().resistance(a.at.radius),
                       flight_.drone_power(b.at.thrust.value, most_share)) > 0;
    return delivered ? warm : std::max(warm, std::min(1.0, cold));
  }

  /// A radius strictly between a and b at which motors or converter pass from one piece of their
  /// curves to another, at the thrust available or, where its power heats the cable, at the
  /// necessary one, or at which the motors give their most, or the battery's mass bends down; NaN
  /// where there is none.
  [[nodiscard]] double kink_between(const Look& a, const Look& b) {
    const double lo = a.at.radius;
    const double hi = b.at.radius;
    const auto inside = [&](double radius) {
      constexpr double rounding = 1e-12;
      return lo * (1 + rounding) < radius && radius < hi * (1 - rounding);
    };
    const bool bends = flight_.share_changes() && a.arriving > 0 && b.arriving > a.arriving;
    const double bend = bends ? converter_bend(a, b) : nan;
    if (inside(bend)) return bend;
    if (a.available > 0 && a.available < b.available) {
      const double most = flight_.most_thrust(b.at.share);
      const double end = b.available < most ? nan : radius_of_available(most, a, b);
      if (inside(end)) return end;
      const double share = flight_.share_changes() ? nan : a.at.share;
      const double kink =
          radius_of_available(thrust_kink(flight_, a.available, b.available, share), a, b);
      if (inside(kink)) return kink;
    }
    if (heated_) {
      const double thrust = thrust_kink(flight_, a.at.thrust.value, b.at.thrust.value,
                                        flight_.share_changes() ? nan : a.at.share);
      const double kink =
          std::isnan(thrust) ? nan : at_thrust(flight_, thrust, lo, hi, a.at).radius;
      if (inside(kink)) return kink;
    }
    return battery_kink(flight_, a.at, b.at);
  }

  /// The radius at which what arrives brings the converter to its rating or from one piece of its
  /// efficiency curve to another, which does not depend on what the motors make of it.
  [[nodiscard]] double converter_bend(const Look& a, const Look& b) {
    const Converter& converter = flight_.design().supply.converter;
    const double auxiliary = flight_.design().drone.auxiliary_power;
    const double lo = converter_output_power(converter, a.arriving - auxiliary);
    const double hi = converter_output_power(converter, b.arriving - auxiliary);
    const double rated = converter.rated_output_power.value_or(nan);
    const double output =
        lo < rated && rated < hi ? rated : converter_kink(converter, lo, hi, true);
    if (std::isnan(output)) return nan;
    const double power = converter_input_power(converter, output) + auxiliary;
    if (!heated_) return flight_.radius_of_available_power(power);
    return radius_of_arriving([power](const Look&) { return power; }, a, b);
  }

  /// The radius between a and b at which a thrust is just available: a hair more, or rounding
  /// would leave much less where a little power makes a leap of thrust.
  [[nodiscard]] double radius_of_available(double thrust, const Look& a, const Look& b) {
    if (std::isnan(thrust)) return nan;
    const auto power = [&](const Look& look) {
      return flight_.drone_power(thrust, look.at.share) * (1 + 1e-14);
    };
    if (!heated_ && !flight_.share_changes()) return flight_.radius_of_available_power(power(a));
    return radius_of_arriving(power, a, b);
  }

  /// The radius between a and b at which `power` W of it arrive.
  template <typename Power>
  [[nodiscard]] double radius_of_arriving(const Power& power, const Look& a, const Look& b) {
    // One over the power is a line over one over the radius squared, but for the heat and for what
    // the tilt adds to the power.
    Look lo = a;
    Look hi = b;
    double radius = nan;
    for (int step = 0; step < 8; ++step) {
      const double thinner = power(lo) / lo.arriving;
      const double thicker = power(hi) / hi.arriving;
      const double share = (1 - thicker) / (thinner - thicker);
      const double thin = 1 / (lo.at.radius * lo.at.radius);
      const double thick = 1 / (hi.at.radius * hi.at.radius);
      radius = 1 / std::sqrt(thick + share * (thin - thick));
      if (!(lo.at.radius < radius && radius < hi.at.radius)) break;
      const Look here = between(a, radius);
      if (!(std::abs(here.arriving / power(here) - 1) > 1e-13)) break;
      (here.arriving < power(here) ? lo : hi) = here;
    }
    return radius;
  }

  const SteadyFlight& flight_;
  WarmTether tether_;
  bool heated_;
  BestHeadroom best_{0, nan};
  int stretches_ = 0;
};

}  // namespace

BestHeadroom best_headroom(const SteadyFlight& flight) {
  BestHeadroomSearch search(flight);
  const double least_weight = flight.lifted_without_tether();
  const double asked = flight.radius_of_available_power(flight.drone_power(
      1e-6 * flight.necessary_thrust(least_weight, 0), flight.power_share(0).value));
  // Where motors with a share of their thrust could not lift the drone no more headroom is left
  // than that share. The search ends where it is less than a millionth.
  const auto search_from = [&](double radius, double share) {
    const double heaviest = flight.radius_of_weight(flight.full_thrust() / share);
    const IntervalSet tilted_little = radii_within_tilt(flight, heaviest, asked);
    for (const Interval& range : intersection({{radius, heaviest}}, tilted_little)) {
      search.search(range.lo, range.hi);
    }
    return std::max(radius, heaviest);
  };
  const double lifted = search_from(0, 1);
  if (search.best().value < 1) search_from(lifted, std::max(search.best().value, 1e-6));
  return search.best();
}

BestHeadroom best_headroom(const Design& design, Condition condition) {
  return best_headroom(SteadyFlight(design, condition));
}

}  // namespace tethercalc
