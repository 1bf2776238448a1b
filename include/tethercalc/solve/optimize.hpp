// The conductor cross-section to fly.
#pragma once

#include "tethercalc/model/demands.hpp"
#include "tethercalc/solve/headroom.hpp"
#include "tethercalc/solve/interval.hpp"
#include "tethercalc/solve/minimum_power.hpp"

namespace tethercalc {

/// What keeps the optimum, or an infeasible design, from being better.
enum class Limit {
  minimum_power,          ///< nothing: the least power lies inside the feasible set
  available_power,        ///< a thinner conductor would starve the motors of power
  takeoff_mass,           ///< a thicker conductor would be too heavy
  motor_thrust,           ///< the motors' last data-sheet point is below the thrust asked for
  max_pitch,              ///< the tilt limit
  conductor_temperature,  ///< the rated temperature of the insulation, in the air or on the drum
  tether_strength,        ///< the breaking load that the tether's tension asks for
  converter_rating,       ///< the rated output of the converter
  input_voltage,          ///< the range of the converter's input
  tether_shape,           ///< a winch's pull that holds the tether up between station and drone
  drum_width,             ///< the width of the drum, whose flanges hold a turn
};

/// How many there are.
inline constexpr std::size_t limit_count = 11;

/// The limit that a demand is told as.
[[nodiscard]] Limit limit_of(Demand demand);

/// The same for one that is missed at `point`: too little thrust there is the motors' fault where
/// they give their most, and the heat's where the cable overheats without end.
[[nodiscard]] Limit missed_limit(const Design& design, const OperatingPoint& point, Demand demand);

/// The answer to "which cross-section", the area NaN and the points meaningless where there is
/// none, or to why there is none. Areas in m².
struct Optimization : AreaPoints {
  bool feasible = false;                    ///< whether any area meets all that is asked
  Limit limited_by = Limit::minimum_power;  ///< what binds: at the optimum, or where there is none
  Condition limiting_condition = Condition::hover;  ///< where the limit binds

  IntervalSet
      headroom_areas;  ///< where the required headroom is met, at `requirements.headroom_at`
  IntervalSet feasible_areas;  ///< where the design meets everything it was checked against
  MinimumPower minimum_power;  ///< at `requirements.power_at`, no other constraint asked for

  /// The most in `limiting_condition`, where the design is infeasible and not for a demand on the
  /// cable or for the supply's voltage.
  BestHeadroom best_headroom;
};

/// The least power at `requirements.power_at` among the areas that
/// - leave `requirements.thrust_headroom` at `requirements.headroom_at` (unless a buffer battery
///   makes that a wish instead of a demand), and
/// - can be flown in hover and in forward flight: tilt within its limit and headroom at least 1.
///
/// and, where the design asks for them,
/// - keep conductors at or below the insulation's rated temperature, in the air and on the drum, in
///   both conditions (an ambient temperature is set),
/// - have a breaking load of `strength_safety_factor` times the tension,
/// - have a turn that the drum's flanges hold, and
/// - do not ask more of the converter than its rated output.
///
/// This is the paper's larger-of-two rule (section IV-A) where the headroom has only a lower edge;
/// where it has an upper edge too, the area stays below it. Takes about a microsecond, some
/// microseconds with an efficiency curve or a reserve battery, and some tens of them with heat.
[[nodiscard]] Optimization optimize(const Design& design);

/// The same but for the two sets of areas, which may be empty: sooner, for many designs.
[[nodiscard]] Optimization optimum_alone(const Design& design);

/// `optimize(design).feasible`, sooner; where a winch holds up conductors of some sizes only, and
/// those closer than `hanging_step`, either may miss them.
[[nodiscard]] bool is_feasible(const Design& design);

}  // namespace tethercalc
