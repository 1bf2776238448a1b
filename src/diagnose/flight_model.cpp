#include "diagnose/flight_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnose/flight_clock.hpp"
#include "diagnose/flight_samples.hpp"
#include "identify/flight_units.hpp"
#include "identify/slow_log.hpp"
#include "identify/statistics.hpp"
#include "model/constants.hpp"

namespace tethercalc {
namespace {

/// Whether the nose turns so little from sample to sample that what the lean does between them is
/// known: a force f that turns by an angle α is up to f·α²/8 more than a straight line has it.
bool turns_slowly(const FlightRecord& r, std::size_t i) {
  constexpr double tolerated = 0.05;  // m/s²: a fifth of what a good log leaves unexplained
  const double turned = 0.5 * (r.yaw[i + 1] - r.yaw[i - 1]);
  const double lean = r.gravity * std::hypot(r.tan_tilt[i], r.sideward_thrust[i]);
  return lean * turned * turned / 8 <= tolerated;
}

/// Whether a step beside the sample is too long to know an acceleration over it.
bool is_beside_long_step(const FlightRecord& r, std::size_t i, double usual) {
  return !(r.time[i] - r.time[i - 1] <= step_tolerance * usual &&
           r.time[i + 1] - r.time[i] <= step_tolerance * usual);
}

/// Samples whose central difference and average rest on three trustworthy samples.
std::vector<bool> usable_samples(const FlightLog& log, const LogFaults& faults,
                                 const FlightRecord& o, double step) {
  std::vector<bool> trusted(o.size());
  std::size_t in_log = 0;
  for (std::size_t i = 0; i < o.size(); ++i) {
    while (log.time[in_log] < o.time[i]) ++in_log;
    trusted[i] = !faults.sample[in_log];
  }
  std::vector<bool> usable(o.size(), false);
  for (std::size_t i = 1; i + 1 < o.size(); ++i) {
    usable[i] = trusted[i - 1] && trusted[i] && trusted[i + 1] && turns_slowly(o, i) &&
                !is_beside_long_step(o, i, step);
  }
  return usable;
}

/// Says what the times between samples cost.
void tell_steps(const FlightRecord& record, double step, std::vector<Warning>& notes) {
  constexpr double many = 0.05;
  std::size_t beside_long_ones = 0;
  for (std::size_t i = 1; i + 1 < record.size(); ++i) {
    beside_long_ones += is_beside_long_step(record, i, step) ? 1 : 0;
  }
  if (static_cast<double>(beside_long_ones) > many * static_cast<double>(record.size())) {
    notes.push_back({WarningKind::log_steps_uneven,
                     fmt::format("{} of {} samples left out: beside steps of more than {:g} times "
                                 "the usual {:.3g} s, over which no acceleration is known; "
                                 "differences over stamps that jump are wrong as well",
                                 beside_long_ones, record.size(), step_tolerance, step)});
  }
  if (auto slow = slow_log_warning(step)) notes.push_back(std::move(*slow));
}

FlightData read_flight(const Design& design, const MeasuredFlight& flight, double pitch_offset) {
  FlightLog log = flight.log;
  if (log.roll.empty()) log.roll.assign(log.time.size(), 0.0);
  if (log.down_velocity.empty()) log.down_velocity.assign(log.time.size(), 0.0);
  validate(log);
  const double gravity = design.flight.gravity;
  FlightSamples samples = flight.range ? FlightSamples{std::move(log), *flight.range, {}, {}}
                                       : flown_samples(std::move(log), gravity);

  FlightData data;
  data.faults = repair_flight_log(samples.log, samples.range);
  average_fast_samples(samples, data.faults.sample);
  if (auto note = even_out_stamps(samples.log)) samples.notes.push_back(std::move(*note));
  data.faults.notes.insert(data.faults.notes.begin(), samples.notes.begin(), samples.notes.end());
  data.observations = observe(samples.log, samples.range, pitch_offset, gravity);
  data.record = flight_record(data.observations, design.drone.mass, design.flight.air_density,
                              gravity, samples.taken_out);
  if (data.observations.size() < 3) {
    throw UnsuitableFlight("the chosen part of the flight has fewer than three samples");
  }
  data.step = median_step(data.observations.time);
  tell_steps(data.record, data.step, data.faults.notes);
  check_flight_units(data.observations, gravity);
  const std::vector<bool> usable = usable_samples(samples.log, data.faults, data.record, data.step);
  for (const bool use : usable) data.block.push_back(use ? 0 : -1);
  data.usable = static_cast<double>(std::count(usable.begin(), usable.end(), true)) * data.step;
  if (!(data.usable > 0)) {
    throw UnsuitableFlight("no sample of the flight can be judged: all are faulty or beside gaps");
  }
  return data;
}

/// The samples that are used, in blocks from `first` on.
void number_blocks(FlightData& data, int first) {
  const auto count = static_cast<std::size_t>(std::count(data.block.begin(), data.block.end(), 0));
  std::size_t seen = 0;
  for (int& block : data.block) {
    if (block == 0) block = first + static_cast<int>(seen++ * data.blocks / count);
  }
}

/// What all flights of a drone share beside its effects.
Effect drag_areas(const std::vector<FlightData>& flights) {
  constexpr double largest = 10;  // m², beyond any drone
  const EffectParameter area{
      .name = "front_area_m2", .unit = "m²", .upper = largest, .scale = 5e-3, .start = 0.015};
  EffectParameter top = area;
  top.name = "top_area_m2";
  Effect areas{.title = "drag areas", .parameters = {area, top}, .sizes = 2};
  if (std::any_of(flights.begin(), flights.end(),
                  [](const FlightData& f) { return f.record.both_axes; })) {
    // A ratio, since whatever shrinks the front area for a linear drag shrinks this one alike.
    areas.parameters.push_back({.name = "side_over_front_area",
                                .unit = "1",
                                .neutral = 1,
                                .upper = 20,
                                .scale = 0.2,
                                .product_with = "front_area_m2"});
    ++areas.sizes;
  }
  return areas;
}

/// What each flight fits beside its effects.
std::vector<Effect> instrument_gains(const FlightData& data) {
  const double known = data.faults.height_unknown ? 0 : 1;
  const double measured = data.observations.forward_wind.empty() ? 0 : 1;
  const double aside = data.record.both_axes ? 1 : 0;
  return {{.title = "vertical acceleration",
           .parameters = {{.name = "vertical_acceleration_gain",
                           .unit = "1",
                           .neutral = known,
                           .upper = 1.5 * known,
                           .scale = 0.2}}},
          {.title = "measured wind",
           .parameters = {{.name = "wind_gain",
                           .unit = "1",
                           .neutral = measured,
                           .upper = 1.5 * measured,
                           .scale = 0.2}}},
          {.title = "roll trim",
           .parameters = {{.name = "roll_trim_deg",
                           .unit = "deg",
                           .unit_SI = unit::degree,
                           .lower = -20 * aside,
                           .upper = 20 * aside,
                           .scale = 0.5}}}};
}

/// Along the axes of each sample's heading, the mean over the two intervals around it of an
/// acceleration over ground that is straight between samples, with the weights that the three-point
/// derivative gives to the intervals. At both ends the acceleration itself.
class MeanAround {
 public:
  explicit MeanAround(const FlightRecord& record) : neighbours_(record.size()) {
    for (std::size_t i = 1; i + 1 < record.size(); ++i) {
      const double before = record.time[i] - record.time[i - 1];
      const double after = record.time[i + 1] - record.time[i];
      const auto seen = [&](std::size_t neighbour, double other_side) {
        const double weight = other_side / (2 * (before + after));
        const double turned = record.yaw[i] - record.yaw[neighbour];
        return AtDrone{weight * std::cos(turned), weight * std::sin(turned)};
      };
      neighbours_[i] = {seen(i - 1, after), seen(i + 1, before)};
    }
  }
  /// Of the predicted acceleration.
  void along(Axis axis, const FlightPrediction& p, std::span<double> out) const {
    const bool forward = axis == Axis::forward;
    const double* own = (forward ? p.acceleration : p.side_acceleration).data();
    const double* other = (forward ? p.side_acceleration : p.acceleration).data();
    const double sign = forward ? 1 : -1;
    const std::size_t size = out.size();
    for (std::size_t i = 0; i < size; ++i) {
      if (i == 0 || i + 1 == size) {
        out[i] = own[i];
        continue;
      }
      const auto& [before, after] = neighbours_[i];
      out[i] = 0.5 * own[i] + before.forward * own[i - 1] + after.forward * own[i + 1] +
               sign * (before.right * other[i - 1] + after.right * other[i + 1]);
    }
  }

 private:
  /// A sample's heading by the axes of its neighbours, times their weights.
  struct Neighbours {
    AtDrone before;
    AtDrone after;
  };
  std::vector<Neighbours> neighbours_;
};

std::vector<LogModel::Span> spans_of(const std::vector<FlightData>& flights) {
  std::vector<LogModel::Span> spans;
  for (const FlightData& data : flights) {
    spans.push_back(span_of(data.record.time, flights.size() > 1 ? data.blocks : 0));
  }
  return spans;
}

}  // namespace

std::vector<FlightData> read_flights(const Design& design, std::span<const MeasuredFlight> flights,
                                     double pitch_offset) {
  std::vector<FlightData> read;
  double usable = 0;
  for (std::size_t k = 0; k < flights.size(); ++k) {
    try {
      read.push_back(read_flight(design, flights[k], pitch_offset));
    } catch (const UnsuitableFlight& error) {
      if (flights.size() == 1) throw;
      throw UnsuitableFlight(fmt::format("flight {}: {}", k + 1, error.what()));
    }
    usable += read.back().usable;
  }
  int first_block = 0;
  for (std::size_t k = 0; k < read.size(); ++k) {
    FlightData& data = read[k];
    const double share = data.usable / usable * static_cast<double>(most_blocks);
    data.blocks = static_cast<std::size_t>(std::min(share, data.usable / shortest_block));
    if (read.size() > 1) {
      data.blocks = std::max(
          data.blocks,
          std::min(fewest_own_blocks, static_cast<std::size_t>(data.usable / shortest_block)));
      if (data.blocks < fewest_own_blocks) {
        throw UnsuitableFlight(fmt::format(
            "flight {}: {:.1f} s of it can be used; together with others {:.0f} s are needed",
            k + 1, data.usable, shortest_block * fewest_own_blocks));
      }
    }
    number_blocks(data, first_block);
    first_block += static_cast<int>(data.blocks);
  }
  return read;
}

bool testable(const Effect& effect, const LogFaults& faults) {
  return !(faults.height_unknown && contains(effect.needs, "vd_m_s"));
}

namespace {

/// A size that is looked for elsewhere than at its neutral value begins where the first of the
/// flights from `first` on shows it that does.
void start_where_shown(const Effect& effect, const std::vector<FlightData>& flights,
                       std::size_t first, double gravity, ModelParameter& size) {
  if (effect.starts_at == nullptr) return;
  for (std::size_t k = first; k < flights.size(); ++k) {
    const double start = effect.starts_at(flights[k].observations, gravity);
    if (start == 0) continue;
    size.start = std::clamp(start, size.lower, size.upper);
    return;
  }
}

}  // namespace

FlightModel::FlightModel(const Design& design, const std::vector<FlightData>& flights,
                         const std::vector<const Effect*>& tried,
                         const std::vector<std::string>& base)
    : LogModel(spans_of(flights)), flights_(flights) {
  const bool several = flights.size() > 1;
  const auto which = [several](std::size_t k) { return several ? std::optional(k) : std::nullopt; };
  add(base_.emplace_back(drag_areas(flights)), design, true);
  for (std::size_t k = 0; k < flights.size(); ++k) {
    base_group_.push_back(effects().size());
    for (Effect& gain : instrument_gains(flights[k])) {
      add(base_.emplace_back(std::move(gain)), design, true, which(k));
    }
  }
  for (const Effect* const entry : tried) {
    const Effect& effect = *entry;
    const bool fitted = contains(base, effect.id);
    bool added = false;
    for (std::size_t k = 0; k < flights.size(); ++k) {
      if (!testable(effect, flights[k].faults)) continue;
      const bool own = several && effect.own_in_each_flight;
      if (added && !own) continue;
      add(effect, design, fitted, own ? which(k) : std::nullopt);
      added = true;
      start_where_shown(effect, flights, k, design.flight.gravity,
                        problem.groups.back().parameters.front());
      // Beside a wind along the nose it is looked for only where the nose turns.
      if (!effect.replaces.empty()) problem.groups.back().usual = turns(flights[k].observations);
      hold_hidden(effect, flights[k]);
    }
  }

  std::vector<FlightPrediction> predictions;
  std::vector<MeanAround> means;
  const auto add_readings = [this](std::size_t flight, Axis axis,
                                   const std::vector<double>& acceleration) {
    readings_.push_back({flight, axis, problem.measured.size(), acceleration});
    problem.measured.insert(problem.measured.end(), acceleration.begin(), acceleration.end());
    const std::vector<int>& block = flights_[flight].block;
    problem.block.insert(problem.block.end(), block.begin(), block.end());
  };
  for (std::size_t k = 0; k < flights.size(); ++k) {
    add_readings(k, Axis::forward, flights[k].observations.forward_acceleration);
    predictions.emplace_back(flights[k].record);
    means.emplace_back(flights[k].record);
  }
  for (std::size_t k = 0; k < flights.size(); ++k) {
    if (!flights[k].record.both_axes) continue;
    add_readings(k, Axis::right, flights[k].observations.right_acceleration);
  }
  problem.noise.assign(problem.measured.size(), 1.0);
  add_kinds();
  problem.predict = [this, predictions = std::move(predictions), means = std::move(means)](
                        std::span<const double> values, std::span<double> out) mutable {
    for (std::size_t k = 0; k < predictions.size(); ++k) {
      predict_acceleration(predictions[k], this->base(k, values), freed(k, values));
    }
    for (const Readings& r : readings_) {
      means[r.flight].along(r.axis, predictions[r.flight], rows_of(r, out));
    }
  };
}

/// Along each axis the samples of turns and of straight flight, and those that gain or lose speed
/// fast and all others. Where gusts push and the controller leans against them, what follows the
/// lean less mends straight and even flight, in which all of it answers gusts, and spoils the rest.
void FlightModel::add_kinds() {
  constexpr double fastest_part = 0.2;
  constexpr double slowest_turn = 0.15;  // rad/s, beyond what a yaw held against gusts moves by
  for (const Axis axis : {Axis::forward, Axis::right}) {
    if (std::ranges::none_of(readings_, [axis](const Readings& r) { return r.axis == axis; })) {
      continue;
    }
    const std::vector<bool> none(problem.measured.size());
    std::vector<bool> turning = none;
    std::vector<bool> straight = none;
    std::vector<bool> changing_speed = none;
    std::vector<bool> even = none;
    for (const Readings& r : readings_) {
      if (r.axis != axis) continue;
      const Observations& o = flights_[r.flight].observations;
      std::vector<double> change(o.size());
      for (std::size_t i = 0; i < o.size(); ++i) {
        change[i] = std::hypot(o.forward_acceleration[i], o.right_acceleration[i]);
      }
      const double fast = quantile(change, 1 - fastest_part);
      for (std::size_t i = 0; i < o.size(); ++i) {
        const bool is_turning = std::abs(flights_[r.flight].record.yaw_rate[i]) > slowest_turn;
        (is_turning ? turning : straight)[r.first_row + i] = true;
        (change[i] > fast ? changing_speed : even)[r.first_row + i] = true;
      }
    }
    problem.kinds.insert(problem.kinds.end(), {turning, straight, changing_speed, even});
  }
}

/// What the flight cannot show of the group added last stays neutral.
void FlightModel::hold_hidden(const Effect& effect, const FlightData& flight) {
  const bool aside = flight.record.both_axes;
  const bool across = aside || turns(flight.observations);
  for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
    const Shown shown = effect.parameters[k].shown;
    ModelParameter& p = problem.groups.back().parameters[k];
    if (shown == Shown::always || (shown == Shown::to_the_side ? aside : across)) continue;
    p.lower = p.upper = p.neutral;
    if (shown == Shown::to_the_side) --problem.groups.back().numbers;
  }
}

FlightBase FlightModel::base(std::size_t flight, std::span<const double> values) const {
  const std::size_t gains = first_parameter(base_group_[flight]);
  return {.front_area = values[0],
          .top_area = values[1],
          .side_area = values[0] * (base_[0].parameters.size() > 2 ? values[2] : 1),
          .vertical_acceleration_gain = values[gains],
          .wind_gain = values[gains + 1],
          .roll_trim = values[gains + 2]};
}

std::vector<EffectValues> FlightModel::freed(std::size_t flight,
                                             std::span<const double> values) const {
  std::vector<EffectValues> result;
  for (std::size_t g = base_.size(); g < effects().size(); ++g) {
    if (log_of(g).value_or(flight) == flight && !is_neutral(g, values)) {
      result.push_back({&effect(g), own(g, values)});
    }
  }
  return result;
}

std::optional<std::size_t> FlightModel::index_in(std::size_t flight,
                                                 std::string_view parameter) const {
  for (std::size_t g = 0; g < effects().size(); ++g) {
    if (log_of(g).value_or(flight) != flight) continue;
    for (std::size_t k = 0; k < effect(g).parameters.size(); ++k) {
      if (effect(g).parameters[k].name == parameter) return first_parameter(g) + k;
    }
  }
  return std::nullopt;
}

std::vector<double> FlightModel::left_by(std::size_t series, std::span<const double> values) const {
  const Readings& readings = readings_[series];
  std::vector<double> predicted(problem.measured.size());
  problem.predict(values, predicted);
  const auto measured = readings.acceleration;
  const auto rows = rows_of(readings, predicted);
  std::vector<double> left;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    left.push_back(flights_[readings.flight].block[i] < 0 ? nan : measured[i] - rows[i]);
  }
  return left;
}

}  // namespace tethercalc
