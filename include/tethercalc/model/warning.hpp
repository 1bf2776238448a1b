// What a user should know of an input that can be used all the same.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tethercalc {

/// What a warning is about. Each has a code that stays the same when its sentence changes.
enum class WarningKind {
  motor_points_pooled,        ///< points of a motor whose power did not rise with thrust
  motor_rows_left_out,        ///< rows of a bench table without thrust or power
  motor_power_mismatch,       ///< measured power that is not the measured voltage times current
  motor_runs_averaged,        ///< repeated runs or sweeps of a bench table
  motor_estimated,            ///< a motor that nobody measured
  motor_flown,                ///< a motor that is known at its hover only
  motor_bus_power,            ///< all of the bus's power taken for the motors'
  motor_forward_power,        ///< what a motor drew in forward flight, beside its curve
  motor_log_note,             ///< what was noticed in the log that a motor was learned from
  motor_mass_not_counted,     ///< motors compared as if all weighed the same
  motor_air_density,          ///< a motor's curve that counts in air it was not measured in
  drag_estimated,             ///< drag of a drone that never flew
  drum_cooling_unknown,       ///< cable on a drum that nothing is known of
  rated_temperature_unknown,  ///< insulation that no heat limits
  drag_at_bound,              ///< a fitted parameter at the end of its range
  drag_may_be_none,           ///< a flight that does not even tell that there is drag
  drag_not_converged,         ///< a fit that did not settle
};

/// How many there are.
inline constexpr std::size_t warning_kind_count = 17;

/// "motor_points_pooled" …: the name of the enumerator, as `warning_codes` of the JSON answers have
/// it.
[[nodiscard]] std::string_view warning_code(WarningKind kind);

/// A warning as it is told.
struct Warning {
  WarningKind kind = WarningKind::motor_log_note;  ///< what it is about
  std::string sentence;                            ///< with the numbers of this case
};

}  // namespace tethercalc
