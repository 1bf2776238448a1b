// Notation: r conductor radius; P drone power at the converter's input; R loop resistance; I tether
// current; y total power. From y = P + R·(y/U)² follows y'·(1 − 2RI/U) = P' + I²R' =: s, so s has
// the sign of the total power's slope. Where the line cannot deliver P, s with I² = P/R has the
// sign of (R·P)' and points back to where it can.

#include "solve/valley_search.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "tethercalc/model/power_line.hpp"
#include "tethercalc/model/tether_heat.hpp"

namespace tethercalc {
namespace {

/// ln(a/b) for a, b ≥ 0 near each other, with an error of the third order; within ±2 everywhere.
double near_log(double a, double b) { return 2 * (a - b) / (a + b); }

/// exp(x) for |x| < 1, with an error of the third order.
double near_exp(double x) { return (2 + x) / (2 - x); }

class ValleySearch {
 public:
  ValleySearch(const SteadyFlight& flight, const WarmTether& tether, const MotorCurve& motor,
               Pieces pieces, Interval radii)
      : flight_(flight),
        tether_(tether),
        motor_(motor),
        vertices_(motor.vertices()),
        pieces_(pieces),
        per_voltage_(1 / flight.design().supply.voltage),
        idle_(flight.input_power(0)),
        input_slope_(flight.input_power(1) - idle_),
        constant_efficiency_(is_proportional(flight.design().supply.converter)),
        efficiency_(constant_efficiency_
                        ? EfficiencyPiece{}
                        : efficiency_piece(flight.design().supply.converter,
                                           flight.output_power(motor.power(pieces.within)))),
        heated_(is_heated(flight.design().tether)),
        left_{radii.lo, false},
        right_{radii.hi, false} {}

  ThrustAt bottom(ThrustAt start) {
    const ThrustAt found = descend(start);
    // Where a cable begins to run away the power ends, and may be least just before.
    const bool ends = heated_ && right_.known && runs_away(found);
    return ends ? thrust_at(flight_, right_.radius, found.tan_pitch) : found;
  }

 private:
  [[nodiscard]] bool runs_away(const ThrustAt& at) const {
    const double power = flight_.input_power(motor_.power(at.thrust.value));
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
      const double excess = near_log(trade.saved, trade.spent);
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
      next = inside_bracket(next, step);
      if (std::abs(next - at.radius) <= last_step * at.radius) return nearby(at, next);
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
  };

  /// The trade, were the motor curve to follow `piece` everywhere.
  [[nodiscard]] Trade trade_at(const ThrustAt& at, std::size_t piece) const {
    const MotorPoint& start = vertices_[piece];
    double slope = input_slope_ * motor_.slope(piece);  // W/N at the converter's input
    double power = idle_ + input_slope_ * start.power + slope * (at.thrust.value - start.thrust);
    if (!constant_efficiency_) {
      const double per_newton = flight_.output_power(motor_.slope(piece));
      const double output =
          flight_.output_power(start.power) + per_newton * (at.thrust.value - start.thrust);
      power = flight_.design().drone.auxiliary_power + efficiency_.input_power(output);
      slope = per_newton * efficiency_.input_slope(output);
    }
    const double resistance = flight_.tether().resistance(at.radius);
    if (heated_) {
      // To 1e-7: at the bottom the power is flat.
      const TetherHeatState state = tether_.state(power, at.radius, at.radius, 3e-4);
      const double spent = slope * at.thrust.slope;
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
    return {-current_squared * flight_.tether().resistance_slope(at.radius),
            slope * at.thrust.slope * share * share};
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
    const StraightTether& tether = flight_.tether();
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
    return (step % 8 == 0 || (step > 30 && step % 2 == 0)) && left_.known && right_.known ? middle
                                                                                          : next;
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

}  // namespace

ThrustAt valley_bottom(const SteadyFlight& flight, const WarmTether& tether,
                       const MotorCurve& motor, Pieces pieces, Interval radii,
                       const ThrustAt& start) {
  return ValleySearch(flight, tether, motor, pieces, radii).bottom(start);
}

}  // namespace tethercalc
