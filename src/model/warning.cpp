#include "tethercalc/model/warning.hpp"

#include <array>

namespace tethercalc {

std::string_view warning_code(WarningKind kind) {
  constexpr std::array<std::string_view, warning_kind_count> codes{
      "motor_points_pooled",    "motor_rows_left_out",       "motor_power_mismatch",
      "motor_runs_averaged",    "motor_estimated",           "motor_flown",
      "motor_bus_power",        "motor_forward_power",       "motor_log_note",
      "motor_mass_not_counted", "motor_air_density",         "drag_estimated",
      "drum_cooling_unknown",   "rated_temperature_unknown", "drag_at_bound",
      "drag_may_be_none",       "drag_not_converged"};
  return codes.at(static_cast<std::size_t>(kind));
}

}  // namespace tethercalc
