// Flights of one drone as the search for effects sees them.
#pragma once

#include <deque>
#include <span>
#include <string>
#include <vector>

#include "diagnose/flight_log_faults.hpp"
#include "diagnose/flight_prediction.hpp"
#include "diagnose/log_model.hpp"
#include "identify/flight_units.hpp"
#include "tethercalc/diagnose/flight_diagnosis.hpp"

namespace tethercalc {

/// Shortest block, s: ten correlation times of about a second, and about one pass there or back, so
/// that blocks hardly know of each other.
inline constexpr double shortest_block = 12;
/// More blocks sharpen the spread between them only a little: with 30, Student's factor is 4 %
/// above the normal one.
inline constexpr std::size_t most_blocks = 30;
/// Of several flights each needs so many blocks: what is its own is told by the spread between
/// them.
inline constexpr std::size_t fewest_own_blocks = 3;
/// A step longer than this times the median one separates neighbours.
inline constexpr double step_tolerance = 1.5;

/// Of the speed that drag in proportion to the airspeed begins with.
inline constexpr const char* linear_speed_field = "drone.drag.linear_m_s";

/// One flight, read and checked.
struct FlightData {
  Observations observations;
  FlightRecord record;
  std::vector<int> block;  ///< of each sample, counted over all flights; −1 where it is left out
  LogFaults faults;
  double step = 0;         ///< s, median
  double usable = 0;       ///< s
  std::size_t blocks = 0;  ///< of its own
};

/// The flights as they are judged, one at least. Throws UnsuitableFlight; where there are several,
/// also for one that is too short, and the message says which.
[[nodiscard]] std::vector<FlightData> read_flights(const Design& design,
                                                   std::span<const MeasuredFlight> flights,
                                                   double pitch_offset);

/// Whether the samples of a flight can show the effect.
[[nodiscard]] bool testable(const Effect& effect, const LogFaults& faults);

/// Rows are the forward accelerations of the first flight, then those to the right where the flight
/// shows them, then those of the second, and so on. Drag, and what else belongs to the drone, is
/// shared; what belongs to a flight is a group of each.
class FlightModel : public LogModel {
 public:
  /// With these effects, of which some are always fitted. `flights` and effects must outlive it.
  FlightModel(const Design& design, const std::vector<FlightData>& flights,
              const std::vector<const Effect*>& tried, const std::vector<std::string>& base);

  /// What every flight fits beside its effects, with the values of the flight.
  [[nodiscard]] FlightBase base(std::size_t flight, std::span<const double> values) const;
  /// The effects that are not neutral and act in the flight.
  [[nodiscard]] std::vector<EffectValues> freed(std::size_t flight,
                                                std::span<const double> values) const;
  /// Index of the parameter in the group of this flight, else in one that is shared; nothing where
  /// there is none.
  [[nodiscard]] std::optional<std::size_t> index_in(std::size_t flight,
                                                    std::string_view parameter) const;
  /// What is compared: an acceleration of a flight along an axis.
  struct Readings {
    std::size_t flight = 0;
    Axis axis = Axis::forward;
    std::size_t first_row = 0;
    /// m/s², measured.
    std::span<const double> acceleration{};
  };
  /// Forward in every flight, then to the right in those that show it.
  [[nodiscard]] std::span<const Readings> readings() const { return readings_; }
  /// The rows of `readings` in a column over all.
  template <typename Values>
  [[nodiscard]] auto rows_of(const Readings& readings, Values& column) const {
    return std::span(column).subspan(readings.first_row, readings.acceleration.size());
  }

  [[nodiscard]] std::size_t series(std::size_t group) const override {
    return log_of(group).value_or(0);
  }
  [[nodiscard]] Channel channel(std::size_t group) const override {
    return flight_channel(effect(group).channel, flights_[series(group)].record);
  }
  [[nodiscard]] std::vector<double> left_by(std::size_t series,
                                            std::span<const double> values) const override;

 private:
  void add_kinds();
  void hold_hidden(const Effect& effect, const FlightData& flight);

  const std::vector<FlightData>& flights_;
  std::vector<Readings> readings_;
  std::deque<Effect> base_;              ///< areas, then what each flight fits
  std::vector<std::size_t> base_group_;  ///< of each flight, its first one
};

}  // namespace tethercalc
