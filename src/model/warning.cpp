#include "tethercalc/model/warning.hpp"

#include <array>

namespace tethercalc {

std::string_view warning_code(WarningKind kind) {
  constexpr std::array<std::string_view, warning_kind_count> codes{"motor_points_pooled",
                                                                   "motor_rows_left_out",
                                                                   "motor_power_mismatch",
                                                                   "motor_runs_averaged",
                                                                   "motor_estimated",
                                                                   "motor_flown",
                                                                   "motor_bus_power",
                                                                   "motor_forward_power",
                                                                   "motor_mass_not_counted",
                                                                   "motor_air_density",
                                                                   "drag_estimated",
                                                                   "drum_cooling_unknown",
                                                                   "drum_package_unknown",
                                                                   "drum_package_unused",
                                                                   "tether_inclination_unknown",
                                                                   "rated_temperature_unknown",
                                                                   "tether_touches_ground",
                                                                   "tether_does_not_hang",
                                                                   "offset_is_upwind",
                                                                   "drag_at_bound",
                                                                   "drag_may_be_none",
                                                                   "drag_not_converged",
                                                                   "air_density_assumed",
                                                                   "pitch_offset_assumed",
                                                                   "log_damaged",
                                                                   "log_definition_rejected",
                                                                   "log_values_implausible",
                                                                   "log_times_unordered",
                                                                   "log_velocity_invalid",
                                                                   "log_attitude_missing",
                                                                   "log_column_missing",
                                                                   "log_columns_passed_over",
                                                                   "log_wind_unused",
                                                                   "log_bus_chosen",
                                                                   "log_airspeed_derived",
                                                                   "log_ground_speed",
                                                                   "log_flight_of_several",
                                                                   "log_flights_joined",
                                                                   "log_not_flying",
                                                                   "log_averaged",
                                                                   "log_clock_jitter",
                                                                   "log_spikes",
                                                                   "log_stuck",
                                                                   "log_lag",
                                                                   "log_unchanging",
                                                                   "log_too_short",
                                                                   "log_mean_heading",
                                                                   "log_free_flight",
                                                                   "log_ambient_missing",
                                                                   "tilt_drag_shown",
                                                                   "tilt_drag_taken",
                                                                   "tilt_tells_nothing",
                                                                   "tilt_missing"};
  return codes.at(static_cast<std::size_t>(kind));
}

}  // namespace tethercalc
