#include "solve/thrust_at.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "model/constants.hpp"

namespace tethercalc {

ThrustAt thrust_at(const SteadyFlight& flight, double radius, double tan_guess) {
  const SteadyFlight::Balance balance = flight.balance(radius, tan_guess);
  ThrustAt at{.radius = radius,
              .tan_pitch = balance.tan_pitch,
              .thrust = balance.thrust,
              .landing_thrust = balance.landing_thrust};
  if (flight.share_changes() && balance.tan_pitch < infinity) {
    const PowerShare share = flight.power_share(balance.tan_pitch);
    at.share = share.value;
    at.share_slope = share.slope * balance.thrust.tan_slope;
  }
  return at;
}

ThrustAt at_thrust(const SteadyFlight& flight, double thrust, double lo, double hi, ThrustAt from) {
  // Newton's method takes 2 to 5 steps; halving alone would take 60 for a factor of two and 10 more
  // for the decades between the ends.
  for (int step = 0; step < 200; ++step) {
    (from.thrust.value > thrust ? hi : lo) = from.radius;
    if (from.thrust.value == thrust) break;
    const double newton = from.radius + (thrust - from.thrust.value) / from.thrust.slope;
    const double middle = lo > 0 && hi > 4 * lo ? std::sqrt(lo * hi) : 0.5 * (lo + hi);
    const bool inside = newton > lo && newton < hi && step % 8 != 7;
    const double radius = inside ? newton : middle;
    if (!(lo < radius && radius < hi)) break;  // no number is left between them
    // Quadratic convergence: the thrust is then within 1e-16 of the one asked for.
    const bool last = inside && std::abs(radius - from.radius) <= 1e-8 * radius;
    from = thrust_at(flight, radius, from.tan_guess(radius));
    if (last) return from;
  }
  return from.thrust.value > thrust && lo > 0 ? thrust_at(flight, lo, from.tan_pitch) : from;
}

namespace {

/// The part that is left of a solved tether's load from a radius `thin` on, at `thick`, at least.
double left_of_load(double thin, double thick) { return thin / thick; }

/// `at` with `share` of the tether's load more.
ThrustAt with_more_load(const SteadyFlight& flight, ThrustAt at, double share) {
  const TetherLoad load = flight.tether().load(at.radius);
  at.thrust.value += share * (load.down + load.along) / flight.design().drone.motor_count;
  at.thrust.value = std::max(at.thrust.value, 0.0);
  return at;
}

}  // namespace

ThrustAt least_up_to(const SteadyFlight& flight, const ThrustAt& at, double radius) {
  const bool solved = flight.tether().is_solved();
  const double left = solved ? left_of_load(at.radius, radius) : 1;
  ThrustAt least = solved ? with_more_load(flight, at, left - 1) : at;
  if (flight.share_changes()) {
    // The load at any radius in between is at most that at the upper end over what is left of it.
    const double heavier = solved ? (1 / left - 1) * flight.tether().load(radius).down : 0;
    least.share =
        flight.power_share(flight.least_tan_pitch({at.radius, radius}, heavier, left)).value;
  }
  return least;
}

ThrustAt most_down_to(const SteadyFlight& flight, const ThrustAt& at, double radius) {
  const bool solved = flight.tether().is_solved();
  const double left = solved ? left_of_load(radius, at.radius) : 1;
  ThrustAt most = solved ? with_more_load(flight, at, 1 / left - 1) : at;
  if (flight.share_changes()) {
    const double lighter = solved ? (1 - left) * flight.tether().load(radius).down : 0;
    const double tangent = flight.most_tan_pitch({radius, at.radius}, lighter, 1 / left);
    most.share = tangent < infinity ? flight.power_share(tangent).value : infinity;
  }
  return most;
}

namespace {

/// What was solved for to lie on a kink may miss it by this much, relative.
constexpr double kink_rounding = 1e-12;

/// What decides the tilt with conductors of one radius.
struct TiltLoads {
  double radius = 0;
  double weight = 0;  ///< N, all that is lifted; +infinity where a tether does not hang
  double down = 0;    ///< N of the tether's load
  double drag = 0;    ///< N of the tether's

  [[nodiscard]] bool hangs() const { return weight < infinity; }
};

/// Whether the tilt is within its limit with the weight at one radius and the tether's drag at
/// another, of which `lighter` N of weight and the share `of_drag` count.
bool within_tilt(const SteadyFlight& flight, const TiltLoads& light, const TiltLoads& wide,
                 double lighter = 0, double of_drag = 1) {
  return (light.weight - lighter) * flight.tan_pitch_limit() >=
         flight.airframe_drag_at_pitch_limit() + of_drag * wide.drag;
}

TiltLoads tilt_loads(const SteadyFlight& flight, double radius) {
  const TetherInFlight& tether = flight.tether();
  return {radius, flight.weight(radius), tether.is_solved() ? tether.load(radius).down : 0,
          tether.drag(radius)};
}

/// Collects where the tilt is within its limit with a reserve battery, whose mass is no closed form
/// of the radius. Weight and drag both rise with it, which bounds the tilt between two radii.
void collect_within_tilt(const SteadyFlight& flight, const TiltLoads& a, const TiltLoads& b,
                         IntervalSet& radii) {
  if (!within_tilt(flight, b, a)) return;
  if (within_tilt(flight, a, b)) return append(radii, {a.radius, b.radius});
  const TiltLoads middle = tilt_loads(flight, std::sqrt(a.radius * b.radius));
  if (!(middle.radius > a.radius * (1 + kink_rounding))) return;
  collect_within_tilt(flight, a, middle, radii);
  collect_within_tilt(flight, middle, b, radii);
}

/// The same with a solved tether, whose load may fall from a to b by as much as `left_of_load` says
/// before it rises. Closer radii are told apart by their ends.
void collect_solved_within_tilt(const SteadyFlight& flight, const TiltLoads& a, const TiltLoads& b,
                                IntervalSet& radii) {
  constexpr double close = 1.05;
  const double next = flight.tether().hangs_alike(b.radius) ? infinity : hanging_step;
  const double ratio = b.radius / a.radius;
  if (!a.hangs() && !b.hangs() && ratio < next) return;
  if (a.hangs() && b.hangs() && ratio < next) {
    const double left = left_of_load(a.radius, b.radius);
    if (within_tilt(flight, a, b, (1 - left) * a.down, 1 / left)) {
      return append(radii, {a.radius, b.radius});
    }
    if (!within_tilt(flight, b, a, (1 - 1 / left) * b.down, left)) return;
  }
  if (ratio > close) {
    const TiltLoads middle = tilt_loads(flight, std::sqrt(a.radius * b.radius));
    collect_solved_within_tilt(flight, a, middle, radii);
    collect_solved_within_tilt(flight, middle, b, radii);
    return;
  }
  const auto is_within = [&](const TiltLoads& at) {
    return at.hangs() && within_tilt(flight, at, at);
  };
  // The last radius at which the tether hangs, or the tilt is within its limit too, from `inside`
  // towards `outside`, where that is not so.
  const auto last = [&](bool within, double inside, double outside) {
    while (std::abs(outside - inside) > kink_rounding * b.radius) {
      const TiltLoads middle = tilt_loads(flight, 0.5 * (inside + outside));
      const bool holds = within ? is_within(middle) : middle.hangs();
      (holds ? inside : outside) = middle.radius;
    }
    return inside;
  };
  if (is_within(a)) {
    return append(radii, {a.radius, is_within(b) ? b.radius : last(true, a.radius, b.radius)});
  }
  if (is_within(b)) return append(radii, {last(true, b.radius, a.radius), b.radius});
  if (a.hangs() == b.hangs()) return;
  // The tilt may come within its limit just before the tether hangs no more.
  const double hanging = a.hangs() ? a.radius : b.radius;
  const double brink = last(false, hanging, a.hangs() ? b.radius : a.radius);
  if (!is_within(tilt_loads(flight, brink))) return;
  const double edge = last(true, brink, hanging);
  append(radii, {std::min(edge, brink), std::max(edge, brink)});
}

/// The first piece of the motor curve, of those that the reserve battery passes to strictly between
/// two radii, at whose start its mass bends; 0 where there is none.
std::size_t bent_battery_piece(const SteadyFlight& flight, const ThrustAt& a, const ThrustAt& b,
                               bool either_way) {
  const MotorCurve& motor = flight.motor();
  const Pieces landed = pieces_between(motor, a.landing_thrust, b.landing_thrust);
  for (std::size_t i = landed.first + 1; i <= landed.last; ++i) {
    if (either_way || motor.slope(i) < motor.slope(i - 1)) return i;
  }
  return 0;
}

}  // namespace

std::pair<double, double> shares_between(const SteadyFlight& flight, const ThrustAt& a,
                                         const ThrustAt& b) {
  if (!flight.share_changes()) return {a.share, b.share};
  return {least_up_to(flight, a, b.radius).share, most_down_to(flight, b, a.radius).share};
}

Pieces pieces_between(const MotorCurve& motor, double lo, double hi) {
  const std::size_t first = motor.piece(lo * (1 + kink_rounding));
  return {first, std::max(first, motor.piece(hi * (1 - kink_rounding))), 0.5 * (lo + hi)};
}

double converter_kink(const Converter& converter, double lo, double hi, bool of_any_kind) {
  double before = 0;  // slope of the efficiency
  const auto& points = converter.efficiency;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double output = points[i].output_power;
    const double after = i + 1 < points.size() ? (points[i + 1].efficiency - points[i].efficiency) /
                                                     (points[i + 1].output_power - output)
                                               : 0;
    const bool counts = of_any_kind || after > before;
    before = after;
    if (counts && lo * (1 + kink_rounding) < output && output < hi * (1 - kink_rounding)) {
      return output;
    }
  }
  return nan;
}

double thrust_kink(const SteadyFlight& flight, double lo, double hi, double share) {
  const MotorCurve& motor = flight.motor();
  const Pieces pieces = pieces_between(motor, lo, hi);
  if (pieces.first != pieces.last) {
    return motor.vertices()[pieces.first + (pieces.last - pieces.first + 1) / 2].thrust;
  }
  if (std::isnan(share)) return nan;
  return motor.thrust(converter_kink(flight.design().supply.converter,
                                     flight.output_power(motor.power(lo), share),
                                     flight.output_power(motor.power(hi), share)) /
                      flight.output_power(1, share));
}

bool battery_bends(const SteadyFlight& flight, const ThrustAt& a, const ThrustAt& b,
                   bool either_way) {
  return bent_battery_piece(flight, a, b, either_way) > 0;
}

double battery_kink(const SteadyFlight& flight, const ThrustAt& a, const ThrustAt& b,
                    bool either_way) {
  const std::size_t piece = bent_battery_piece(flight, a, b, either_way);
  if (piece == 0) return nan;
  const double lo = a.radius;
  const double hi = b.radius;
  if (flight.tether().is_solved() || flight.lands_in_wind()) {
    double before = lo;
    double after = hi;
    for (double middle = 0.5 * (lo + hi); before < middle && middle < after;
         middle = 0.5 * (before + after)) {
      (flight.battery_piece(middle) < piece ? before : after) = middle;
    }
    return before > lo ? before : std::sqrt(lo * hi);
  }
  const Drone& drone = flight.drone();
  const double landed = drone.motor.vertices()[piece].thrust * drone.motor_count;
  double kink = flight.radius_of_weight(landed + flight.tether().straight().winch_pull());
  // Rounding may take it to where the battery has leapt already.
  for (double share = 1e-16; share < kink_rounding / 2 && flight.battery_piece(kink) >= piece;
       share *= 2) {
    kink *= 1 - share;
  }
  return lo < kink && kink < hi ? kink : std::sqrt(lo * hi);
}

bool on_one_piece(const SteadyFlight& flight, const ThrustAt& a, const ThrustAt& b,
                  double headroom) {
  const MotorCurve& motor = flight.motor();
  const double lo = headroom * a.thrust.value;
  const double hi = headroom * b.thrust.value;
  const Pieces pieces = pieces_between(motor, lo, hi);
  const auto [less, more] = shares_between(flight, a, b);
  return pieces.first == pieces.last &&
         std::isnan(converter_kink(flight.design().supply.converter,
                                   flight.output_power(motor.power(lo), less),
                                   flight.output_power(motor.power(hi), more))) &&
         !battery_bends(flight, a, b);
}

TetherHeatState WarmTether::state(double power, double radius, double sunlit_radius,
                                  double last_step) const {
  const auto asked = std::span(known_).first(std::min(asked_, known_.size()));
  const Known* nearest = nullptr;
  double distance = infinity;
  for (const Known& known : asked) {
    if (known.power == power && known.radius == radius && known.sunlit_radius == sunlit_radius &&
        known.last_step <= last_step) {
      return known.state;
    }
    if (!known.state.steady) continue;
    const double ratio = std::max(known.radius / radius, radius / known.radius);
    if (ratio < distance) nearest = &known;
    distance = std::min(distance, ratio);
  }
  const TetherHeatState state =
      TetherHeat(flight_, radius, sunlit_radius)
          .carrying(power, nearest ? nearest->state : TetherHeatState{}, last_step);
  known_[asked_++ % known_.size()] = {power, radius, sunlit_radius, last_step, state};
  return state;
}

double least_cold_resistance(const SteadyFlight& flight, double thinner, double thicker) {
  const TetherInFlight& tether = flight.tether();
  const double shorter = std::min(tether.resistance_area(thicker), tether.resistance_area(thinner));
  return tether.contact_resistance() + shorter / (thicker * thicker);
}

double least_resistance(const WarmTether& tether, const SteadyFlight& flight, const ThrustAt& least,
                        double thicker) {
  const double thinner = least.radius;
  const double cold = least_cold_resistance(flight, thinner, thicker);
  const double power = flight.drone_power(least.thrust.value, least.share);
  if (!is_heated(flight.design().tether) || !(power < infinity)) return cold;
  const double of_shorter = cold / flight.tether().resistance(thicker);
  const TetherHeatState state = tether.state(power, thicker, thinner);
  if (state.steady) return of_shorter < 1 ? of_shorter * state.resistance : state.resistance;
  return of_shorter < 1 ? cold : infinity;
}

IntervalSet radii_within_tilt(const SteadyFlight& flight, double hi, double least_asked) {
  if (!(hi > 0)) return {};
  if (!flight.tether().is_solved()) {
    const SteadyFlight::Radii beyond = flight.beyond_pitch_limit();
    if (!(beyond.lo < beyond.hi)) return {{0, hi}};
    if (flight.design().drone.reserve_battery.specific_energy == 0) {
      return intersection({{0, beyond.lo}, {beyond.hi, std::max(hi, beyond.hi)}}, {{0, hi}});
    }
  }
  IntervalSet radii;
  if (!(hi > thinnest_radius)) return radii;
  const TiltLoads heaviest = tilt_loads(flight, hi);
  if (flight.tether().is_solved()) {
    const double from = std::clamp(least_asked, thinnest_radius, hi);
    collect_solved_within_tilt(flight, tilt_loads(flight, from), heaviest, radii);
  } else {
    collect_within_tilt(flight, tilt_loads(flight, thinnest_radius), heaviest, radii);
  }
  return radii;
}

}  // namespace tethercalc
