// How far thrust is from rising in proportion to throttle, in ArduPilot's terms.
#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>

#include "tethercalc/identify/drag_fit.hpp"

namespace tethercalc {

/// One row of a thrust stand.
struct ThrottledThrust {
  double output = 0;  ///< what the speed controller was told, over its whole range: 0 to 1
  double thrust = 0;  ///< N
};

/// The part of the output that ArduPilot flies with; the defaults are its own.
struct SpinRange {
  double least = 0.15;  ///< MOT_SPIN_MIN, in [0, 0.3]: no thrust is asked for
  double most = 0.95;   ///< MOT_SPIN_MAX, in [0.9, 1]: all thrust is asked for
};

/// Pulses of speed controllers, µs: ArduPilot's defaults of MOT_PWM_MIN and MOT_PWM_MAX.
struct PulseRange {
  double least = 1000;  ///< output 0
  double most = 2000;   ///< output 1
};

/// ArduPilot's thrust curve as a bench shows it.
struct ThrustExpo {
  Estimate expo;           ///< MOT_THST_EXPO; its errors take the rows for independent
  double idle_thrust = 0;  ///< N, of the curve at MOT_SPIN_MIN
  double full_thrust = 0;  ///< N, of the curve at MOT_SPIN_MAX
  double scatter = 0;      ///< rms of the rows around the curve, over full less idle thrust
  double left_unbent = 0;  ///< the same around the best straight line
  std::size_t rows = 0;    ///< that were fitted: those within the spin range
};

/// Throttle and thrust that no curve can be made of.
class UnsuitableThrottle : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;  ///< with what is in the way
};

/// MOT_THST_EXPO by least squares.
///
/// ArduPilot takes thrust for (1 − e)·a + e·a², where a runs from 0 at MOT_SPIN_MIN to 1 at
/// MOT_SPIN_MAX (libraries/AP_Motors/AP_Motors_Thrust_Linearization.cpp,
/// `apply_thrust_curve_and_volt_scaling`), and asks for the a that makes thrust proportional to
/// what its controllers want. A motor that idles has thrust at a = 0, too, which bends nothing, so
/// fitted is T = T₀ + K·((1 − e)·a + e·a²) for T₀, K and e; the interval of e follows from the
/// covariance of the coefficients (delta method, Student's t with three degrees fewer than rows).
///
/// Battery voltage is left as it was: ArduPilot scales by the voltage of a battery at rest
/// (MOT_BAT_VOLT_MAX, `voltage_resting_estimate`), so that what sags under load belongs to the
/// curve.
///
/// Throws UnsuitableThrottle for fewer than 5 rows within the range or such as cover less than half
/// of it, thrust that does not rise, rows that tell e to no better than ±0.5, and an e whose whole
/// interval is outside ArduPilot's range of −1 to 1; one that reaches into it is taken at the end
/// of the range.
[[nodiscard]] ThrustExpo fit_thrust_expo(std::span<const ThrottledThrust> rows,
                                         const SpinRange& range = {});

}  // namespace tethercalc
