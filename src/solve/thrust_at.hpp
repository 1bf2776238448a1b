// The necessary thrust along the conductor's radius, with what makes the next one cheap.
#pragma once

#include <array>
#include <cstddef>
#include <utility>

#include "model/tether_heat.hpp"
#include "tethercalc/model/steady_flight.hpp"
#include "tethercalc/solve/interval.hpp"

namespace tethercalc {

/// Necessary thrust at a radius.
struct ThrustAt {
  double radius = 0;
  double tan_pitch = 0;
  SteadyFlight::Thrust thrust;
  double share = 1;           ///< `SteadyFlight::power_share` there
  double share_slope = 0;     ///< its derivative by the radius
  double landing_thrust = 0;  ///< as in a `SteadyFlight::Balance`

  /// Where to look for the tangent of the tilt at a radius nearby.
  [[nodiscard]] double tan_guess(double at_radius) const {
    return tan_pitch + thrust.tan_slope * (at_radius - radius);
  }
};

[[nodiscard]] ThrustAt thrust_at(const SteadyFlight& flight, double radius, double tan_guess);

/// The largest radius between `lo` and `hi` at which `thrust`, which lies between those necessary
/// there, suffices. The necessary thrust never falls with the radius, and mostly rises ever more
/// steeply, so that Newton's method, which `from` starts, is quick; where it is flat or, with the
/// reserve battery, jumps, the bracket is halved.
[[nodiscard]] ThrustAt at_thrust(const SteadyFlight& flight, double thrust, double lo, double hi,
                                 ThrustAt from);

/// No more than what is necessary at any radius from `at`'s up to `radius`, and no less at any from
/// `at`'s down to `radius`: the thrust at `at`, which never falls with the radius, of a solved
/// tether less or plus what its load may fall by (`HangingLoad`). Its share of the motors' power is
/// that of the least tilt in between, or of the greatest.
[[nodiscard]] ThrustAt least_up_to(const SteadyFlight& flight, const ThrustAt& at, double radius);
[[nodiscard]] ThrustAt most_down_to(const SteadyFlight& flight, const ThrustAt& at, double radius);

/// Pieces of a motor curve, both included, and N somewhere on them.
struct Pieces {
  std::size_t first = 0;
  std::size_t last = 0;
  double within = 0;
};

/// The pieces that hold the thrusts strictly between `lo` and `hi`.
[[nodiscard]] Pieces pieces_between(const MotorCurve& motor, double lo, double hi);

/// Whether the power for `headroom` times the thrust is smooth between two radii: motors and
/// converter follow one piece of their curves, and the reserve battery's bends up.
[[nodiscard]] bool on_one_piece(const SteadyFlight& flight, const ThrustAt& a, const ThrustAt& b,
                                double headroom = 1);

/// The converter's output in W at which its efficiency has a kink, strictly between two outputs;
/// NaN where there is none. Those at which the slope of the input rises only where they are asked
/// for.
[[nodiscard]] double converter_kink(const Converter& converter, double lo, double hi,
                                    bool of_any_kind = true);

/// A thrust strictly between two where the power for it has a kink, by the motors or, with that
/// share of their power, by the converter; NaN where there is none.
[[nodiscard]] double thrust_kink(const SteadyFlight& flight, double lo, double hi, double share);

/// No more and no less than the share of the motors' power at any radius between two.
[[nodiscard]] std::pair<double, double> shares_between(const SteadyFlight& flight,
                                                       const ThrustAt& a, const ThrustAt& b);

/// Whether the reserve battery's mass bends down strictly between two radii, or bends either way.
[[nodiscard]] bool battery_bends(const SteadyFlight& flight, const ThrustAt& a, const ThrustAt& b,
                                 bool either_way = false);

/// A radius strictly between two where it does; NaN where there is none.
[[nodiscard]] double battery_kink(const SteadyFlight& flight, const ThrustAt& a, const ThrustAt& b,
                                  bool either_way = false);

/// The heat of the tether of one flight, asked for at one place after another nearby.
class WarmTether {
 public:
  explicit WarmTether(const SteadyFlight& flight) : flight_(flight) {}

  /// The state with `power` W at the drone and conductors of `radius`, in the sun as broad as those
  /// of `sunlit_radius`; see `TetherHeat::carrying` for `last_step`.
  [[nodiscard]] TetherHeatState state(double power, double radius, double sunlit_radius,
                                      double last_step = TetherHeat::finest_step) const;

 private:
  struct Known {
    double power = 0;
    double radius = 0;
    double sunlit_radius = 0;
    double last_step = 0;
    TetherHeatState state{};
  };

  const SteadyFlight& flight_;
  mutable std::array<Known, 4> known_{};  ///< the last that were asked for
  mutable std::size_t asked_ = 0;
};

/// No more than the loop's resistance without current, Ω, at any radius between these: a winch pays
/// out ever more of a cable that it hardly holds up, so that the thinner one may be shorter.
[[nodiscard]] double least_cold_resistance(const SteadyFlight& flight, double thinner,
                                           double thicker);

/// No more than the loop's resistance, Ω, at any radius from that of `least`, which is no more than
/// is necessary at any of them, up to a `thicker` one; +infinity where the current heats the cable
/// without end at all of them.
[[nodiscard]] double least_resistance(const WarmTether& tether, const SteadyFlight& flight,
                                      const ThrustAt& least, double thicker);

/// m, thinner conductors than which are not looked at: 3e-10 mm².
constexpr double thinnest_radius = 1e-8;

/// The radii up to `hi` at which the tilt is within its limit. Thinner solved tethers than
/// `least_asked` may be left out, which saves their loads.
[[nodiscard]] IntervalSet radii_within_tilt(const SteadyFlight& flight, double hi,
                                            double least_asked = 0);

}  // namespace tethercalc
