// What the header of a thrust-stand table calls a quantity and its unit.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "tethercalc/io/motor_bench.hpp"

namespace tethercalc {

/// What a column of a thrust-stand table may hold.
enum class BenchQuantity { thrust, power, efficiency, voltage, current, throttle };

/// A column that is understood.
struct BenchColumnMeaning {
  BenchQuantity quantity = BenchQuantity::thrust;
  /// Turns its numbers into grams-force, watts, grams-force per watt, volts, amperes or, of a
  /// throttle, whatever it is counted in.
  double factor = 1;
  ThrottleUnit throttle_unit = ThrottleUnit::unknown;  ///< of a throttle
};

/// The meaning of a header's cell, such as "Thrust (g)", "Thrust [N]", "thrust_kgf", "Power, W",
/// "Electrical Power (W)", "Watts", "Efficiency (g/W)"; nothing where it is none of these
/// quantities, or the unit is missing or none of its units. Mechanical and shaft power are none: a
/// motor's curve holds the electrical one. Upper and lower case count as equal.
[[nodiscard]] std::optional<BenchColumnMeaning> bench_column_meaning(std::string_view header);

/// The words of a header's cell without its unit, in lower case: "supply_nominal_V" is "supply
/// nominal".
[[nodiscard]] std::string bench_column_words(std::string_view header);

/// What a quantity is called in messages and options, with its plainest unit: "thrust_g".
[[nodiscard]] std::string_view bench_quantity_name(BenchQuantity quantity);

}  // namespace tethercalc
