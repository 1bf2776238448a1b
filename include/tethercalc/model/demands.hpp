// What a design is held to, and how far each demand is met at one cross-section: the one judge.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "tethercalc/model/operating_point.hpp"
#include "tethercalc/model/tether_load.hpp"

namespace tethercalc {

/// A demand on a design. Where several are missed at once, the earlier is the cause of the later:
/// a drone that tilts too far has no thrust to judge.
enum class Demand {
  tether_shape,           ///< a solved tether can hang between station and drone
  takeoff_mass,           ///< a reserve battery can carry itself
  max_pitch,              ///< the tilt is within its limit
  input_voltage,          ///< the supply is within the converter's range
  drum_width,             ///< the drum's flanges hold a turn of the tether
  thrust_headroom,        ///< the headroom asked for in one condition, and 1 in the other
  conductor_temperature,  ///< in the air, at most the insulation's rated one, and steady
  drum_temperature,       ///< the same on the drum
  tether_strength,        ///< the breaking load over the tension
  converter_rating,       ///< the converter's output at most its rated one
};

/// How many there are.
inline constexpr std::size_t demand_count = 10;

/// "takeoff_mass", "max_pitch" …: the name of the enumerator.
[[nodiscard]] std::string_view demand_name(Demand demand);

/// Optima lie on demands, which are solved for to 1e-12; what misses one by no more than this,
/// relative, meets it.
inline constexpr double margin_rounding = 1e-9;

/// How far one demand is met in one condition.
struct DemandMargin {
  Demand demand = Demand::thrust_headroom;  ///< which
  Condition condition = Condition::hover;   ///< where
  double value = 0;  ///< relative to what is demanded, ≥ 0 where met; −1 where what it judges does
                     ///< not exist

  /// Whether the demand is met, but for rounding.
  [[nodiscard]] bool met() const { return value >= -margin_rounding; }
};

/// The margins of all demands that a design makes, hover before forward, in the order of `Demand`.
class Margins {
 public:
  /// In that order.
  [[nodiscard]] const DemandMargin* begin() const { return margins_.data(); }
  /// Behind the last.
  [[nodiscard]] const DemandMargin* end() const { return margins_.data() + count_; }

  /// The least met; of equal ones the cause. There is always one: a headroom is always asked for.
  [[nodiscard]] const DemandMargin& worst() const;

  /// Whether all are met.
  [[nodiscard]] bool met() const { return worst().met(); }

  /// Adds one; for `demand_margins`.
  void add(const DemandMargin& margin) { margins_[count_++] = margin; }

 private:
  std::array<DemandMargin, 2 * demand_count> margins_{};
  std::size_t count_ = 0;
};

/// The margins at one cross-section, given what the design does there in both conditions.
[[nodiscard]] Margins demand_margins(const Design& design, const OperatingPoint& hover,
                                     const OperatingPoint& forward);

/// The margins that one condition decides.
[[nodiscard]] Margins demand_margins(const Design& design, const OperatingPoint& point,
                                     Condition condition);

/// One cross-section in both flight conditions.
struct AreaPoints {
  double area = 0;         ///< m²
  OperatingPoint hover;    ///< in hover
  OperatingPoint forward;  ///< in forward flight
  DemandMargin worst;      ///< of the demands on the design, the one least met
  /// Where that is the way up to the drone, and told to people: what stands in it.
  std::optional<NoWayUp> no_way{};

  /// The point in `condition`.
  [[nodiscard]] const OperatingPoint& in(Condition condition) const {
    return condition == Condition::hover ? hover : forward;
  }
};

/// Whether the required headroom is demanded in `condition`: where it is asked for, and no buffer
/// battery makes it a wish.
[[nodiscard]] bool is_headroom_demanded(const Requirements& requirements, Condition condition);

/// The headroom demanded in `condition`: the required one where it is demanded, elsewhere 1,
/// below which the drone sinks.
[[nodiscard]] double demanded_headroom(const Requirements& requirements, Condition condition);

}  // namespace tethercalc
