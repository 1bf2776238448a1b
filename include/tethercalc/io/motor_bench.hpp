// Motors from thrust-stand tables as they come: any separator, any order of columns, any unit.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tethercalc/identify/thrust_expo.hpp"
#include "tethercalc/io/library.hpp"
#include "tethercalc/study/flown_motor.hpp"

namespace tethercalc {

/// What the header of a table does not say, or which of its rows are meant.
struct MotorBenchOptions {
  /// QUANTITY=HEADER each, where the header's own words are not understood: the quantity with its
  /// unit, such as "thrust_g" or "current_mA", and the column that holds it.
  std::vector<std::string> columns;
  /// COLUMN=VALUE each: only rows that have this value there, as text or as number, count.
  std::vector<std::string> where;
};

/// What a throttle is counted in, as a header says it.
enum class ThrottleUnit {
  unknown,      ///< not said
  percent,      ///< of the speed controller's range
  microseconds  ///< length of its pulses
};

/// A motor and what its curve was made of.
struct MotorBench {
  /// What a row says.
  struct Row {
    double throttle = 0;  ///< in `throttle_unit`; NaN where it has none
    double thrust = 0;    ///< N
  };

  MotorEntry motor;        ///< called after the (first) file; `warnings` say what was done to rows
  std::size_t rows = 0;    ///< that thrust and power were taken from
  std::size_t passes = 1;  ///< how often a thrust was visited: repeated runs, up and down
  double scatter = 0;      ///< root mean square of power over the curve's, less 1, of those rows
  std::vector<Row> throttled;  ///< those rows, as they stand
  /// Unknown as well where the tables differ in it.
  ThrottleUnit throttle_unit = ThrottleUnit::unknown;
};

/// One motor from the tables of its bench runs.
///
/// A table is CSV: commas, semicolons or tabs, quoted cells or not, decimal points or commas, with
/// or without a byte order mark; blank lines, lines that begin with # or // and up to 20 lines
/// above the header are passed over. The header names each quantity and its unit, in any order and
/// among other columns: thrust (g, kg, N, lbf, oz), electrical power (W, kW) or else efficiency
/// (g/W and the like) or voltage and current, of which power is made in this order; as "Thrust
/// (g)", "Thrust [N]", "thrust_kgf", "Power, W" and so on. Rows without thrust or power are left
/// out and told. Rows of one throttle, and passes over the same thrusts, are averaged; what still
/// does not rise is pooled (`isotonic_motor_points`).
///
/// Throws InputError, each problem as "file:line", for what cannot be read: a header without what
/// is needed (with what was found and how to name it), two columns of one quantity and unit,
/// numbers that are none, more than one motor, propeller or nominal voltage among the rows.
[[nodiscard]] MotorBench motor_from_bench(std::span<const LoadedText> tables,
                                          const MotorBenchOptions& options = {});

/// The rows of a bench by the output that an autopilot gives, for `fit_thrust_expo`: a throttle in
/// percent is the output's, one in microseconds runs over `pulses`.
///
/// Throws InputError, in the name of `file`, where no row has a throttle or its unit is unknown.
[[nodiscard]] std::vector<ThrottledThrust> throttled_thrust(const MotorBench& bench,
                                                            const std::string& file,
                                                            const PulseRange& pulses);

/// A motor as a motor file, which `find_motor` reads back: texts that are empty and numbers that
/// are absent left out.
[[nodiscard]] nlohmann::ordered_json motor_document(const MotorEntry& motor);

}  // namespace tethercalc
