// What a user should know of an input that can be used all the same.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tethercalc {

/// What a warning is about. Each has a code that stays the same when its sentence changes.
enum class WarningKind {
  motor_points_pooled,         ///< points of a motor whose power did not rise with thrust
  motor_rows_left_out,         ///< rows of a bench table without thrust or power
  motor_power_mismatch,        ///< measured power that is not the measured voltage times current
  motor_runs_averaged,         ///< repeated runs or sweeps of a bench table
  motor_estimated,             ///< a motor that nobody measured
  motor_flown,                 ///< a motor that is known at its hover only
  motor_bus_power,             ///< all of the bus's power taken for the motors'
  motor_forward_power,         ///< what a motor drew in forward flight, beside its curve
  motor_mass_not_counted,      ///< motors compared as if all weighed the same
  motor_air_density,           ///< a motor's curve that counts in air it was not measured in
  drag_estimated,              ///< drag of a drone that never flew
  drum_cooling_unknown,        ///< cable on a drum that nothing is known of
  drum_package_unknown,        ///< a drum whose cooling is known by its layers alone
  drum_package_unused,         ///< a drum's package beside a measured heating
  tether_inclination_unknown,  ///< a tether near its rating that may hang steeply
  rated_temperature_unknown,   ///< insulation that no heat limits
  slack_unused,                ///< a slack of a tether whose length something else decides
  field_unused,                ///< a field of the spec that counts for nothing beside others
  tether_touches_ground,       ///< a solved tether that hangs below its station
  tether_does_not_hang,        ///< a solved tether without a way up to its drone
  offset_is_upwind,            ///< a drone aside of its station, judged on the favourable side
  drag_at_bound,               ///< a fitted parameter at the end of its range
  drag_may_be_none,            ///< a flight that does not even tell that there is drag
  drag_kept,                   ///< a linear drag that the flight tells nothing of
  drag_not_converged,          ///< a fit that did not settle
  air_density_assumed,         ///< a flight in air whose density nobody gave
  pitch_offset_assumed,        ///< a flight whose autopilot is taken to know what level is
  log_damaged,                 ///< bytes of a log that could not be read
  log_definition_rejected,     ///< messages of a log that cannot be as they are defined
  log_values_implausible,      ///< samples with values that no flight can have
  log_times_unordered,         ///< samples whose time does not increase
  log_velocity_invalid,        ///< samples whose velocity their estimator does not trust
  log_attitude_missing,        ///< samples without an attitude at their time
  log_column_missing,          ///< a column of a flight that was taken for rest
  log_columns_passed_over,     ///< columns of a table that nothing is known of
  log_wind_unused,             ///< wind or airspeed of a log that is no measurement
  log_bus_chosen,              ///< the battery monitors that a power log is made of
  log_airspeed_derived,        ///< an airspeed that was measured in part or not at all
  log_ground_speed,            ///< ground speed taken as airspeed
  log_flight_of_several,       ///< which flight of several is which log, and what of it is used
  log_flights_joined,          ///< flights of one log judged together
  log_flights_unused,          ///< flights of one log beside the one that drag is learned of
  log_not_flying,              ///< seconds on the ground or tilted too far
  log_averaged,                ///< means judged instead of samples
  log_clock_jitter,            ///< stamps off the even moments of the samples
  log_steps_uneven,            ///< many samples beside gaps, or with stamps that jump
  log_slow,                    ///< samples too far apart for what a drone does between them
  log_spikes,                  ///< samples that stand out from their neighbours
  log_stuck,                   ///< a channel that repeats one value
  log_lag,                     ///< a channel on a clock of its own, shifted back
  log_unchanging,              ///< a channel that never changes
  log_too_short,               ///< too little to tell an effect from chance
  log_mean_heading,            ///< which way "ahead" is
  log_free_flight,             ///< a power log flown without its tether
  log_ambient_missing,         ///< a cable whose surroundings nobody measured
  log_power_untold,            ///< a drone that draws more or less, and no channel tells of what
  tilt_drag_shown,             ///< drag over mass as the tilt shows it
  tilt_drag_taken,             ///< the drag of the extended spec, from the tilt
  tilt_tells_nothing,          ///< a tilt that tells no drag from none
  tilt_missing,                ///< a flight too short to say how the drone leans
};

/// How many there are.
inline constexpr std::size_t warning_kind_count = 60;

/// "motor_points_pooled" …: the name of the enumerator, as `warning_codes` and `note_codes` of the
/// JSON answers have it.
[[nodiscard]] std::string_view warning_code(WarningKind kind);

/// A warning as it is told.
struct Warning {
  WarningKind kind{};    ///< what it is about
  std::string sentence;  ///< with the numbers of this case
};

}  // namespace tethercalc
