// Notation: r conductor radius; T necessary thrust per motor; P drone power at the converter's
// input; R loop resistance; I tether current; y total power. From y = P + R·(y/U)² follows y'·(1 −
// 2RI/U) = P' + I²R' =: s, so s has the sign of the total power's slope. Where the line cannot
// deliver P, s with I² = P/R has the sign of (R·P)' and points back to where it can.

#include "tethercalc/solve/minimum_power.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <span>

#include "model/constants.hpp"
#include "model/tether_heat.hpp"
#include "solve/thrust_at.hpp"
#include "tethercalc/model/power_line.hpp"

namespace tethercalc {
namespace {

/// ln(a/b) for a, b ≥ 0 near each other, with an error of the third order; within ±2 everywhere.
double near_log(double a, double b) { return 2 * (a - b) / (a + b); }

/// exp(x) for |x| < 1, with an error of the third order.
double near_exp(double x) { return (2 + x) / (2 - x); }

struct ValleyBottom {
  ThrustAt at;
  bool is_reached = true;  ///< else it is a place where the power rises, and less runs away
};

class ValleySearch {
 public:
  ValleySearch(const SteadyFlight& flight, const WarmTether& tether, const MotorCurve& motor,
               Pieces pieces, Interval radii, double share)
      : flight_(flight),
        tether_(tether),
        motor_(motor),
        vertices_(motor.vertices()),
        pieces_(pieces),
        per_voltage_(1 / flight.design().supply.voltage),
        idle_(flight.input_power(0, 1)),
        input_slope_(flight.input_power(1, 1) - idle_),
        constant_efficiency_(is_proportional(flight.design().supply.converter)),
        efficiency_(constant_efficiency_
                        ? EfficiencyPiece{}
                        : efficiency_piece(flight.design().supply.converter,
                                           flight.output_power(motor.power(pieces.within), share))),
        heated_(is_heated(flight.design().tether)),
        left_{radii.lo, false},
        right_{radii.hi, false} {}

  ValleyBottom bottom(ThrustAt start) {
    const ThrustAt found = descend(start);
    // Where a cable begins to run away the power ends, and may be least just before.
    const bool ends = heated_ && right_.known && runs_away(found);
    if (!ends) return {found};
    return {thrust_at(flight_, right_.radius, found.tan_pitch), false};
  }

 private:
  [[nodiscard]] bool runs_away(const ThrustAt& at) const {
    const double power = flight_.input_power(motor_.power(at.thrust.value), at.share);
    return !tether_.state(power, at.radius, at.radius).steady;
  }

  ThrustAt descend(ThrustAt at) {
    // Relative to the radius. The end of such a step is a hundred times closer to the bottom, where
    // the power is flat to the square of that; and the thrust is straight to the square of the
    // step.
    constexpr double last_step = 1e-7;
    stay_within_motors(at);
    std::size_t piece = piece_at(at);
    for (int step = 1; step < 200; ++step) {
      const Trade trade = trade_at(at, piece);
      const double excess = trade.excess();
      const bool falls = excess > 0;
      if (falls ? at.radius >= right_.radius : at.radius <= left_.radius) return at;
      (falls ? left_ : right_) = {at.radius, true};

      const double growth = growth_at(at, piece, excess);
      double next = at.radius * near_exp(excess * growth);
      const std::size_t vertex = falls ? piece + 1 : piece;
      if (passes(at, next, vertex, falls)) {
        next = at.radius * near_exp((excess + jump_at(vertex, falls)) * growth);
        const bool tiny = std::abs(next - at.radius) <= 1e-3 * at.radius;
        if (tiny || !passes(at, next, vertex, falls)) {
          const ThrustAt kink =
              at_thrust(flight_, vertices_[vertex].thrust, left_.radius, right_.radius, at);
          if (left_.radius < kink.radius && kink.radius < right_.radius) {
            const bool falls_up_to = trade_at(kink, vertex - 1).pays();
            const bool rises_from = vertex > pieces_.last || !trade_at(kink, vertex).pays();
            if (falls_up_to && rises_from) return kink;
            at = kink;
            piece = falls_up_to ? vertex : vertex - 1;
            continue;
          }
        }
      }
      const double bottom = std::clamp(next, left_.radius, right_.radius);
      if (std::abs(next - at.radius) <= last_step * at.radius) return nearby(at, bottom);
      next = inside_bracket(next, step);
      // Where every step leads out of the bracket, however small that is, the bottom is a kink and
      // steep on its sides: a drone of no frontal area is upright from some weight on.
      if (std::abs(next - at.radius) <= 1e-14 * at.radius) return nearby(at, next);
      at = thrust_at(flight_, next, at.tan_guess(next));
      stay_within_motors(at);
      piece = piece_at(at);
    }
    return at;
  }

  struct Side {
    double radius = 0;
    bool known = false;  ///< else the end of the range, not looked at yet
  };

  /// Loss saved and power spent by a little more radius, −I²R' and P', both times the same factor.
  struct Trade {
    double saved = 0;
    double spent = 0;
    [[nodiscard]] bool pays() const { return saved > spent; }
    /// About ln(saved/spent), within ±2; at its end where a cable that grows longer, on a winch
    /// that hardly holds it, loses more with more conductor, or pulls less.
    [[nodiscard]] double excess() const {
      if (saved >= 0 && spent >= 0) return near_log(saved, spent);
      return pays() ? 2 : -2;
    }
  };

  /// The trade, were the motor curve to follow `piece` everywhere.
  [[nodiscard]] Trade trade_at(const ThrustAt& at, std::size_t piece) const {
    const MotorPoint& start = vertices_[piece];
    const double beyond = at.thrust.value - start.thrust;
    const double of_motor = start.power + motor_.slope(piece) * beyond;  // W of its sheet
    double slope = input_slope_ * at.share * motor_.slope(piece);  // W/N at the converter's input
    double power = idle_ + input_slope_ * at.share * start.power + slope * beyond;
    double by_share = input_slope_ * of_motor;
    if (!constant_efficiency_) {
      const double per_newton = flight_.output_power(motor_.slope(piece), at.share);
      const double output = flight_.output_power(start.power, at.share) + per_newton * beyond;
      power = flight_.design().drone.auxiliary_power + efficiency_.input_power(output);
      slope = per_newton * efficiency_.input_slope(output);
      by_share = flight_.output_power(of_motor, 1) * efficiency_.input_slope(output);
    }
    double spent = slope * at.thrust.slope;
    if (at.share_slope != 0 && at.thrust.slope < infinity) {
      // Where a heavier drone leans less the power may fall: then any more radius pays.
      spent = std::max(0.0, spent + by_share * at.share_slope);
    }
    const double resistance = flight_.tether().resistance(at.radius);
    if (heated_) {
      // To 1e-7: at the bottom the power is flat.
      const TetherHeatState state = tether_.state(power, at.radius, at.radius, 3e-4);
      if (state.steady) {
        return {-state.current * state.current * state.resistance_slope, spent};
      }
      // Where it runs away, a thicker cable is cooler as long as P²/r² falls.
      if (supplied_power(flight_.design().supply.voltage, resistance, power) > 0) {
        return {power / at.radius, spent};
      }
    }
    const double least_current = power * per_voltage_;
    const double discriminant = 1 - 4 * resistance * least_current * per_voltage_;
    // I = 2·least_current/share, and times share² both sides are without a division.
    const double share = 1 + std::sqrt(std::max(0.0, discriminant));
    const double current_squared =
        discriminant >= 0 ? 4 * least_current * least_current : power / resistance;
    return {-current_squared * flight_.tether().resistance_slope(at.radius), spent * share * share};
  }

  /// About −d ln r/d ln(saved/spent) on `piece`: through the place before, where that was on the
  /// same piece, else as a third from the savings, less what the tether's growing mass adds.
  double growth_at(const ThrustAt& at, std::size_t piece, double excess) {
    const Side before = before_;
    const double change = excess - before_excess_;
    const bool same_piece = before.known && before_piece_ == piece;
    before_ = {at.radius, true};
    before_excess_ = excess;
    before_piece_ = piece;
    const double secant = near_log(at.radius, before.radius) / -change;
    if (same_piece && secant > 0.05 && secant < 1) return secant;
    const StraightTether& tether = flight_.tether().straight();
    const double mass_slope = tether.mass_slope(at.radius);
    return mass_slope / (3 * mass_slope + tether.mass_curvature() * at.radius);
  }

  [[nodiscard]] std::size_t piece_at(const ThrustAt& at) const {
    return std::clamp(motor_.piece(at.thrust.value), pieces_.first, pieces_.last);
  }

  [[nodiscard]] static ThrustAt nearby(const ThrustAt& at, double radius) {
    ThrustAt there = at;
    there.radius = radius;
    there.tan_pitch = at.tan_guess(radius);
    there.thrust.value += at.thrust.slope * (radius - at.radius);
    there.share += at.share_slope * (radius - at.radius);
    return there;
  }

  /// Whether the thrust at `next` is about beyond the vertex, one of those between the pieces or
  /// the last of the motors.
  [[nodiscard]] bool passes(const ThrustAt& at, double next, std::size_t vertex, bool up) const {
    if (up ? vertex > pieces_.last && vertex + 1 < vertices_.size() : vertex <= pieces_.first) {
      return false;
    }
    const double thrust = at.thrust.value + at.thrust.slope * (next - at.radius);
    const double limit = vertices_[vertex].thrust;
    return up ? thrust > limit : thrust < limit;
  }

  /// What crossing the vertex adds to the logarithm of saved over spent.
  [[nodiscard]] double jump_at(std::size_t vertex, bool up) const {
    if (vertex > pieces_.last) return -2;  // more thrust is not to be had
    const double jump = near_log(motor_.slope(vertex - 1), motor_.slope(vertex));
    return up ? jump : -jump;
  }

  void stay_within_motors(ThrustAt& at) {
    if (at.thrust.value <= motor_.max_thrust()) return;
    at = at_thrust(flight_, motor_.max_thrust(), left_.radius, at.radius, at);
    right_.radius = std::min(right_.radius, at.radius);
  }

  /// `next`, or where it is not between the sides, the end of the range if that has not been looked
  /// at yet, else the middle; the middle every eighth step, so that the search cannot crawl.
  [[nodiscard]] double inside_bracket(double next, int step) const {
    const double middle = 0.5 * (left_.radius + right_.radius);
    if (std::isnan(next)) return middle;  // where the tilt has no slope
    if (next <= left_.radius) return left_.known ? middle : left_.radius;
    if (next >= right_.radius) return right_.known ? middle : right_.radius;
    return step % 8 == 0 || (step > 30 && step % 2 == 0) ? middle : next;
  }

  const SteadyFlight& flight_;
  const WarmTether& tether_;
  const MotorCurve& motor_;
  std::span<const MotorPoint> vertices_;
  Pieces pieces_;
  double per_voltage_;
  double idle_;         ///< W at the converter's input without thrust
  double input_slope_;  ///< W at the converter's input per W of one motor
  bool constant_efficiency_;
  EfficiencyPiece efficiency_;
  bool heated_;
  Side left_;   ///< the power falls here
  Side right_;  ///< and rises here
  Side before_;
  double before_excess_ = 0;
  std::size_t before_piece_ = 0;
};

/// The radius in `radii` with the least total power, where the motor follows `pieces` of `motor`,
/// whose slopes rise, and the power is one valley. `start` lies in `radii` and on those pieces, or
/// above the motor's last point if that ends them.
///
/// The bottom lies where the loss saved by a little more radius equals the power spent on carrying
/// it, where a warm cable also saves by cooling down. Saved over spent falls all the way: savings
/// with 1/r³, spending rises about with r, and jumps up at each vertex. So the bottom is within a
/// piece, where the ratio passes 1, or at a vertex, where it jumps across. A step to where the
/// ratio would be 1 if it fell with a power of r lands close; what is known is kept as a bracket;
/// and a vertex is visited where a step would leave its piece but a step with the next piece's
/// slope would not reach it.
ValleyBottom valley_bottom(const SteadyFlight& flight, const WarmTether& tether,
                           const MotorCurve& motor, Pieces pieces, Interval radii,
                           const ThrustAt& start) {
  return ValleySearch(flight, tether, motor, pieces, radii, start.share).bottom(start);
}

/// +infinity where the motors cannot make the thrust or the line cannot deliver the power.
double total_power(const SteadyFlight& flight, const WarmTether& tether, const ThrustAt& at,
                   double last_step = TetherHeat::finest_step) {
  const double voltage = flight.design().supply.voltage;
  const double power = flight.drone_power(at.thrust.value, at.share);
  if (is_heated(flight.design().tether)) {
    const TetherHeatState state = tether.state(power, at.radius, at.radius, last_step);
    return state.steady ? state.current * voltage : infinity;
  }
  const double total = supplied_power(voltage, flight.tether().resistance(at.radius), power);
  return total > 0 ? total : infinity;
}

/// The least power between two radii, by the bound that it is no less than that of the drone at the
/// lower over the cold resistance at the upper. Stretches on which that may be less than the best
/// known are split until they are one valley.
class LeastPowerSearch {
 public:
  /// From `first`, or where it is known, the `bottom` of the valley over the convex hull of the
  /// motor curve.
  LeastPowerSearch(const SteadyFlight& flight, const WarmTether& tether, const ThrustAt& first,
                   bool bottom)
      : flight_(flight), tether_(tether), heated_(is_heated(flight.design().tether)) {
    const MotorCurve& motor = flight.motor();
    const double thrust = first.thrust.value;
    if (bottom && motor.power(thrust) <= motor.convex_hull().power(thrust)) bottom_ = first.radius;
    (void)consider(first);
  }

  /// From `first` up to a conductor of `thickest`, or to what the motors can lift.
  void search(const ThrustAt& first, double thickest) {
    const Look a = consider(first);
    improve(a, consider(last_to_search(first, thickest)));
  }

  [[nodiscard]] const ThrustAt& best() const { return best_; }
  [[nodiscard]] double power() const { return power_; }

 private:
  struct Look {
    ThrustAt at;
    double power = nan;  ///< NaN where a cold cable shows that it is not less than the best
  };

  Look consider(const ThrustAt& candidate) {
    if (heated_ && !(power_over(candidate, candidate.radius) < power_)) return {candidate};
    double power = total_power(flight_, tether_, candidate, roughly);
    if (heated_ && power < power_ * (1 + roughly)) power = total_power(flight_, tether_, candidate);
    if (power < power_) {
      power_ = power;
      best_ = candidate;
    }
    return {candidate, power};
  }

  /// A little beyond the best place known, where that shows that no thicker conductor up to
  /// `thickest` is better, which saves the search for what the motors can lift.
  [[nodiscard]] ThrustAt last_to_search(const ThrustAt& first, double thickest) const {
    const double most = flight_.motor().max_thrust();
    const double beyond = beside_best * best_.radius;
    if (power_ < infinity && beyond < thickest) {
      const ThrustAt at = thrust_at(flight_, beyond, best_.tan_guess(beyond));
      if (at.thrust.value <= most && !(power_over(at, thickest) < power_)) return at;
    }
    const ThrustAt last = thrust_at(flight_, thickest, best_.tan_pitch);
    if (!(last.thrust.value > most)) return last;
    return at_thrust(flight_, most, first.radius, thickest, last);
  }

  /// Last step of a heat balance where the power is only compared: its error is about the square.
  static constexpr double roughly = 1e-3;

  /// Nothing is proved of warm cables, solved ones, of curved efficiencies and of a share of the
  /// motors' power that changes with the tilt, but between radii of this ratio their power bends no
  /// more sharply than its parts.
  static constexpr double narrow = 1.5;
  /// As far from the best place known a stretch about it ends, so that it is narrow.
  static constexpr double beside_best = 0.99 * narrow;
  /// Of a cable that its winch hardly holds up, the length grows sharply before its end.
  static constexpr double narrow_by_winch = 1.02;
  /// Where a heavier drone gains by leaning less about what it spends on thrust.
  static constexpr double narrow_by_leaning = 1.02;

  /// Whether a thicker conductor, up to one of `radius`, takes little more cable off its winch: the
  /// nearer it comes to what the winch cannot hold, the faster the length grows.
  [[nodiscard]] bool pays_out_evenly_up_to(double radius) const {
    constexpr double even = 0.1;  // relative, for as much of the radius
    return flight_.tether().length_growth(radius) <= even;
  }

  /// How far apart two radii may be between which the power has one valley without a proof.
  [[nodiscard]] double narrow_between(const ThrustAt& a, const ThrustAt& b,
                                      const MotorCurve& motor) const {
    double ratio = pays_out_evenly_up_to(b.radius) ? narrow : narrow_by_winch;
    if (!flight_.share_changes()) return ratio;
    // The price of carrying, ln of which may fall by 3 over ln of the radius as the savings do, is
    // that of the thrust less that of leaning. Half of it may grow with the radius to the third.
    const auto minor = [&](const ThrustAt& at, std::size_t piece) {
      const double of_thrust = motor.slope(piece) * at.share * at.thrust.slope;
      return -at.share_slope * motor.power(at.thrust.value) <= 0.5 * of_thrust;
    };
    const Pieces pieces = pieces_between(motor, a.thrust.value, b.thrust.value);
    const bool minor_all_along = minor(a, pieces.first) && minor(b, pieces.last);
    return minor_all_along ? ratio : std::min(ratio, narrow_by_leaning);
  }

  /// With the thrust at `at` over a cold cable of `radius`.
  [[nodiscard]] double power_over(const ThrustAt& at, double radius) const {
    const ThrustAt least = least_up_to(flight_, at, radius);
    return supplied_power(flight_.design().supply.voltage,
                          least_cold_resistance(flight_, at.radius, radius),
                          flight_.drone_power(least.thrust.value, least.share));
  }

  void improve(const Look& a, const Look& b) {
    constexpr int most_stretches = 5000;  // a hundred times more than usual
    constexpr double same_radius = 1 + 1e-13;
    const MotorCurve& motor = flight_.motor();
    if (!(b.at.radius > a.at.radius * same_radius) || ++stretches_ > most_stretches) return;
    if (!(power_over(a.at, b.at.radius) < power_)) return;
    if (rises_from_bottom(a.at, b.at)) return;
    // Not worth a heat balance yet where a cold cable is worse at both ends.
    constexpr double little = 1.03;
    const bool worse = std::isnan(a.power) && std::isnan(b.power);
    if (!(worse && b.at.radius > little * a.at.radius) && one_valley(a, b)) {
      const ThrustAt lo = heated_ && runs_away(a) ? brink(b, a) : a.at;
      const ThrustAt hi = heated_ && runs_away(b) ? brink(a, b) : b.at;
      const Pieces pieces = pieces_between(motor, lo.thrust.value, hi.thrust.value);
      // At a kink of the battery's mass the slope is that of the lighter side, and where the
      // battery leaps there a drone that leans less may need less power.
      constexpr double beyond_kink = 1 + 4e-12;
      const ThrustAt beyond = thrust_at(flight_, lo.radius * beyond_kink, lo.tan_pitch);
      const ThrustAt start = best_.radius == hi.radius ? hi : beyond;
      if (flight_.share_changes()) (void)consider(beyond);
      (void)consider(lo);
      (void)consider(hi);
      (void)consider(
          valley_bottom(flight_, tether_, motor, pieces, {lo.radius, hi.radius}, start).at);
      return;
    }
    // Where a cable runs away, others nearby do mostly, too.
    if ((a.power == infinity || b.power == infinity) &&
        !(warm_power_over(a.at, b.at.radius) < power_)) {
      return;
    }
    const Look middle = consider(split(a.at, b.at));
    // The more promising side first.
    const bool right = best_.radius > middle.at.radius;
    if (right) improve(middle, b);
    improve(a, middle);
    if (!right) improve(middle, b);
  }

  /// The place next to where the cable begins to run away between a `steady` one and one where it
  /// does; that one where both do.
  [[nodiscard]] ThrustAt brink(const Look& steady, const Look& away) const {
    if (runs_away(steady)) return away.at;
    ThrustAt near = steady.at;
    double far = away.at.radius;
    for (int step = 0; step < 40; ++step) {  // halves a hundredth to 1e-14
      const double middle = 0.5 * (near.radius + far);
      const ThrustAt there = thrust_at(flight_, middle, near.tan_guess(middle));
      if (total_power(flight_, tether_, there) < infinity) {
        near = there;
      } else {
        far = middle;
      }
    }
    return near;
  }

  [[nodiscard]] double warm_power_over(const ThrustAt& at, double radius) const {
    const ThrustAt least = least_up_to(flight_, at, radius);
    return supplied_power(flight_.design().supply.voltage,
                          least_resistance(tether_, flight_, least, radius),
                          flight_.drone_power(least.thrust.value, least.share));
  }

  [[nodiscard]] bool runs_away(const Look& look) const {
    const double power =
        std::isnan(look.power) ? total_power(flight_, tether_, look.at, roughly) : look.power;
    return !(power < infinity);
  }

  /// At the best place known, or a little beyond, so that a narrow stretch lies about it; else at a
  /// kink between a and b, if there is one, else half-way.
  [[nodiscard]] ThrustAt split(const ThrustAt& a, const ThrustAt& b) const {
    const double best = best_.radius;
    if (power_ < infinity && a.radius <= best && best <= b.radius) {
      if (a.radius < best && best < b.radius) return best_;
      const double beyond = best == a.radius ? best * beside_best : best / beside_best;
      if (a.radius < beyond && beyond < b.radius) {
        return thrust_at(flight_, beyond, best_.tan_guess(beyond));
      }
    }
    const MotorCurve& motor = flight_.motor();
    const bool any_kink = !is_proportional(flight_.design().supply.converter);
    const double battery =
        motor.is_convex() && !any_kink ? nan : battery_kink(flight_, a, b, any_kink);
    if (!std::isnan(battery)) return thrust_at(flight_, battery, a.tan_guess(battery));
    const double thrust = motor.is_convex() && !any_kink
                              ? nan
                              : thrust_kink(flight_, a.thrust.value, b.thrust.value,
                                            flight_.share_changes() ? nan : a.share);
    if (a.thrust.value < thrust && thrust < b.thrust.value) {
      const ThrustAt kink = at_thrust(flight_, thrust, a.radius, b.radius, a);
      if (a.radius < kink.radius && kink.radius < b.radius) return kink;
    }
    const double radius = std::sqrt(a.radius * b.radius);
    return thrust_at(flight_, radius, a.tan_guess(radius));
  }

  /// Whether the power over the hull, which is nowhere more, rises from its least at one of the
  /// ends all the way to the other.
  [[nodiscard]] bool rises_from_bottom(const ThrustAt& a, const ThrustAt& b) const {
    if (best_.radius != bottom_ || !(a.radius == bottom_ || b.radius == bottom_)) return false;
    if (!flight_.motor().is_convex() && battery_bends(flight_, a, b)) return false;
    return bends_up(a, b, flight_.motor().convex_hull(), false);
  }

  [[nodiscard]] bool one_valley(const Look& from, const Look& to) const {
    const ThrustAt& a = from.at;
    const ThrustAt& b = to.at;
    constexpr double very_narrow = 1.01;
    const MotorCurve& motor = flight_.motor();
    if (!motor.is_convex() && !on_one_piece(flight_, a, b)) return false;
    if (!bends_up(a, b, motor, true)) return false;
    return !heated_ || b.radius < very_narrow * a.radius || !(runs_away(from) || runs_away(to));
  }

  /// Whether the power has one valley where that of the motors, which follow the convex or straight
  /// `motor`, has; on `one_piece` of the efficiency curve or over its kinks that bend up.
  [[nodiscard]] bool bends_up(const ThrustAt& a, const ThrustAt& b, const MotorCurve& motor,
                              bool one_piece) const {
    const Converter& converter = flight_.design().supply.converter;
    const bool unproved = heated_ || flight_.tether().is_solved() || flight_.share_changes();
    if (unproved && !(b.radius < narrow_between(a, b, motor) * a.radius)) return false;
    if (is_proportional(converter)) return true;
    const double lo = motor.power(a.thrust.value);
    const double hi = motor.power(b.thrust.value);
    const auto [less, more] = shares_between(flight_, a, b);
    if (!std::isnan(converter_kink(converter, flight_.output_power(lo, less),
                                   flight_.output_power(hi, more), one_piece))) {
      return false;
    }
    // A slope that an efficiency bends down may vanish again beyond a kink that bends it up.
    const Pieces pieces = pieces_between(motor, a.thrust.value, b.thrust.value);
    const bool kinked = pieces.first != pieces.last || battery_bends(flight_, a, b, true);
    if (b.radius < narrow * a.radius && !kinked) return true;
    // Where the slope vanishes, the power bends up by 3/r for the losses, and down by what the
    // efficiency gains twice over where it rises with the load.
    const double low = efficiency_at(converter, flight_.output_power(lo, a.share));
    const double high = efficiency_at(converter, flight_.output_power(hi, b.share));
    const double gain = std::max(0.0, (high - low) / (hi - lo));
    const double more_power = motor.slope(pieces.last) * b.thrust.slope;
    return !(3 * low < 2 * gain * more_power * b.radius);
  }

  const SteadyFlight& flight_;
  const WarmTether& tether_;
  bool heated_;
  ThrustAt best_;
  double bottom_ = nan;  ///< radius of the least power over the hull, where the motors follow it
  double power_ = infinity;
  int stretches_ = 0;
};

/// About the radius at which the loss saved by more conductor, I²·2(R − R_contact)/r, equals the
/// power spent on carrying it. `thrust` and `power` are about those at the radius `lightest`.
double first_guess(const SteadyFlight& flight, double lightest, double thrust, double power) {
  const Design& design = flight.design();
  const MotorCurve& motor = flight.motor();
  const double voltage = design.supply.voltage;
  // With the current and the price of thrust of the lightest tether, and as if only the conductor
  // had mass: r⁴ = I²·saved/(price·curvature).
  const double current = power / voltage;
  const double price = (flight.input_power(1, 1) - flight.input_power(0, 1)) *
                       motor.slope(motor.piece(thrust)) * design.flight.gravity /
                       design.drone.motor_count;
  const double saved = -flight.tether().straight().resistance_slope(1);
  const double bare =
      std::sqrt(current * std::sqrt(saved / (price * flight.tether().straight().mass_curvature())));
  // Then with the insulation's mass, the loss in the line and the weight there; a propeller's power
  // grows with thrust to the 3/2.
  const double share = flight.tether().straight().mass_curvature() * bare /
                       flight.tether().straight().mass_slope(bare);
  const double growth = flight.weight(bare) / flight.weight(lightest);
  const double root_growth = std::sqrt(growth);
  const double supplied =
      supplied_power(voltage, flight.tether().resistance(bare), power * growth * root_growth);
  const double more_current = supplied > 0 ? supplied / power : 2;
  return bare * std::sqrt(more_current * std::sqrt(share / root_growth));
}

/// N that the motors lift at least, whatever the conductor. A solved tether's load may fall with
/// the radius, that of none does not.
double least_weight(const SteadyFlight& flight, double lightest) {
  return flight.tether().is_solved() ? flight.lifted_without_tether() : flight.weight(lightest);
}

/// What the motors need at least to carry `weight`: level.
double least_hover_power(const SteadyFlight& flight, double weight) {
  return flight.drone_power(flight.necessary_thrust(weight, 0), flight.power_share(0).value);
}

/// The radius from which on the line delivers that.
double delivering_radius(const SteadyFlight& flight, double weight) {
  const double power = least_hover_power(flight, weight);
  const double voltage = flight.design().supply.voltage;
  return flight.tether().radius_of_resistance(voltage * voltage / (4 * power));
}

MinimumPower minimum_within_tilt(const SteadyFlight& flight, Interval radii) {
  const MinimumPower none{nan, nan};
  const Design& design = flight.design();
  const MotorCurve& motor = flight.motor();
  // Thick enough to deliver what the lightest tether needs in still air.
  const double lightest = radii.lo;
  const double weight = least_weight(flight, lightest);
  if (!(least_hover_power(flight, weight) < infinity)) return none;
  radii.lo = std::max(lightest, delivering_radius(flight, weight));
  if (!(radii.lo <= radii.hi)) return none;

  const double thrust =
      std::min(motor.max_thrust(),
               flight.necessary_thrust(weight, flight.level_drag_tan_pitch(lightest, weight)));
  const double guess = first_guess(flight, lightest, thrust,
                                   flight.drone_power(thrust, flight.power_share(0).value));
  const double start = guess > radii.lo && guess < radii.hi ? guess : 0.5 * (radii.lo + radii.hi);
  const MotorCurve& convex = motor.convex_hull();
  const WarmTether tether(flight);
  ThrustAt best = thrust_at(flight, start, 0);
  const bool one_valley = hull_is_one_valley(design);
  // On the piece of the efficiency curve where the bottom turns out to be.
  bool is_bottom = false;
  double within = thrust;
  for (int attempt = 0; attempt < 3 && !is_bottom; ++attempt) {
    const double chosen = flight.output_power(convex.power(within), best.share);
    const Pieces pieces{0, convex.vertices().size() - 2, within};
    const ValleyBottom valley = valley_bottom(flight, tether, convex, pieces, radii, best);
    best = valley.at;
    within = best.thrust.value;
    const double reached = flight.output_power(convex.power(within), best.share);
    const auto [lo, hi] = std::minmax(chosen, reached);
    is_bottom = valley.is_reached && (is_proportional(design.supply.converter) ||
                                      std::isnan(converter_kink(design.supply.converter, lo, hi)));
    if (is_proportional(design.supply.converter)) break;
  }
  LeastPowerSearch search(flight, tether, best, is_bottom);
  if (!(search.power() < infinity) || !one_valley ||
      motor.power(best.thrust.value) > convex.power(best.thrust.value)) {
    const ThrustAt first = thrust_at(flight, radii.lo, 0);
    if (!(first.thrust.value <= motor.max_thrust() * (1 + 1e-12))) return none;
    search.search(first, radii.hi);
  }
  if (!(search.power() < infinity)) return none;
  // The root of a square may miss its end by rounding, beyond which a warm cable runs away or a
  // reserve battery grows by leaps.
  const double area = conductor_area(search.best().radius);
  if (one_valley) return {area, search.power()};
  for (const double inside : {area, std::nextafter(area, 0), std::nextafter(area, 1),
                              area * (1 - 1e-15), area * (1 + 1e-15)}) {
    const double radius = conductor_radius(inside);
    if (radius == search.best().radius) return {inside, search.power()};
    const ThrustAt there = thrust_at(flight, radius, search.best().tan_pitch);
    if (total_power(flight, tether, there) <= search.power() * (1 + 1e-9))
      return {inside, search.power()};
  }
  return {area, search.power()};
}

}  // namespace

bool hull_is_one_valley(const Design& design) {
  return design.tether.model == TetherModel::straight && is_proportional(design.supply.converter) &&
         !is_heated(design.tether) && design.drone.reserve_battery.specific_energy == 0 &&
         design.drone.translational_lift.induced_share == 0;
}

MinimumPower lesser(const MinimumPower& a, const MinimumPower& b) {
  return a.power <= b.power || std::isnan(b.power) ? a : b;
}

bool is_cheapest_beyond(const SteadyFlight& flight, double area) {
  if (!hull_is_one_valley(flight.design())) return false;
  const SteadyFlight::Radii beyond = flight.beyond_pitch_limit();
  if (beyond.lo < beyond.hi) return false;
  const MotorCurve& motor = flight.motor();
  if (motor.is_convex()) return true;
  const double radius = conductor_radius(area);
  const double weight = flight.weight(radius);
  const double thrust = flight.necessary_thrust(weight, flight.tan_pitch(radius, weight, infinity));
  constexpr double rounding = 1e-14;
  return motor.power(thrust) <= motor.convex_hull().power(thrust) * (1 + rounding);
}

MinimumPower minimum_power(const SteadyFlight& flight, Interval within) {
  const double heaviest = flight.radius_of_weight(flight.full_thrust());
  const Interval radii{conductor_radius(within.lo), conductor_radius(within.hi)};
  MinimumPower best{nan, nan};
  const double asked =
      flight.tether().is_solved() ? delivering_radius(flight, flight.lifted_without_tether()) : 0;
  for (const Interval& part : intersection({radii}, radii_within_tilt(flight, heaviest, asked))) {
    best = lesser(best, minimum_within_tilt(flight, part));
  }
  // Squaring the root of an end of the range may miss it by rounding.
  if (best.power > 0) best.area = std::clamp(best.area, within.lo, within.hi);
  return best;
}

}  // namespace tethercalc
