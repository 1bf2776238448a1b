#include "tethercalc/diagnose/flight_diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "diagnose/flight_log_faults.hpp"
#include "diagnose/flight_prediction.hpp"
#include "diagnose/log_model.hpp"
#include "diagnose/unnamed_shapes.hpp"
#include "identify/statistics.hpp"
#include "model/constants.hpp"
#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

/// Shortest block: ten correlation times of about a second, and about one pass there or back, so
/// that blocks hardly know of each other.
constexpr double shortest_block = 12.0;  // s
/// More blocks sharpen the spread between them only a little: with 30, Student's factor is 4 %
/// above the normal one.
constexpr std::size_t most_blocks = 30;
/// A step longer than this times the median one separates neighbours.
constexpr double step_tolerance = 1.5;
/// Part of a sampling interval within which the log does not say when a reading was taken, and by
/// which an estimator's own integration step shifts it: a standard deviation, the same for the
/// whole log.
constexpr double time_stamp_uncertainty = 0.05;

constexpr const char* unit_of_flights = "m/s²";
constexpr const char* quantity_of_flights = "forward acceleration";
/// A yaw that stays within this never turned; its noise would only be a regressor of noise.
constexpr double steady_yaw = 0.1;  // rad

struct FlightData {
  Observations observations;
  FlightRecord record;
  std::vector<int> block;
  LogFaults faults;
  double step = 0;    ///< s, median
  double usable = 0;  ///< s
  std::size_t blocks = 0;
};

/// Samples whose central difference and average rest on three trustworthy samples.
std::vector<bool> usable_samples(const FlightLog& log, const LogFaults& faults,
                                 const Observations& o, double step) {
  std::vector<bool> trusted(o.size());
  std::size_t in_log = 0;
  for (std::size_t i = 0; i < o.size(); ++i) {
    while (log.time[in_log] < o.time[i]) ++in_log;
    trusted[i] = !faults.sample[in_log];
  }
  std::vector<bool> usable(o.size(), false);
  for (std::size_t i = 1; i + 1 < o.size(); ++i) {
    usable[i] = trusted[i - 1] && trusted[i] && trusted[i + 1] &&
                o.time[i] - o.time[i - 1] <= step_tolerance * step &&
                o.time[i + 1] - o.time[i] <= step_tolerance * step;
  }
  return usable;
}

/// Drag and attitude act within some tenths of a second. Faster samples hold no more of them, but
/// the noise of a difference grows with the rate.
constexpr double fast_enough = 10;  // 1/s
/// Up to twice as many are left as they are.
constexpr double too_fast = 20;  // 1/s

/// So many neighbours of `range` are averaged: 1 where the log is slow enough.
std::size_t averaged_samples(const FlightLog& log, const SampleRange& range) {
  if (range.size() < 3) return 1;
  const auto begin = log.time.begin();
  const double rate = 1 / median_step({begin + static_cast<std::ptrdiff_t>(range.first),
                                       begin + static_cast<std::ptrdiff_t>(range.last)});
  return rate > too_fast ? static_cast<std::size_t>(rate / fast_enough) : 1;
}

/// The range in means over `count` samples each. One of them without trust takes the others with
/// it; the rest after the last full mean is left out.
FlightLog averaged(const FlightLog& log, const SampleRange& range, std::size_t count,
                   std::vector<bool>& faulty) {
  FlightLog means;
  means.other_vehicle = log.other_vehicle;
  std::vector<bool> any_faulty;
  for (std::size_t first = range.first; first + count <= range.last; first += count) {
    const auto begin = static_cast<std::ptrdiff_t>(first);
    const auto end = static_cast<std::ptrdiff_t>(first + count);
    for (auto series :
         {&FlightLog::time, &FlightLog::roll, &FlightLog::pitch, &FlightLog::yaw,
          &FlightLog::north_velocity, &FlightLog::east_velocity, &FlightLog::down_velocity}) {
      const auto values = (log.*series).begin();
      (means.*series)
          .push_back(std::accumulate(values + begin, values + end, 0.0) /
                     static_cast<double>(count));
    }
    const auto fault = std::find(faulty.begin() + begin, faulty.begin() + end, true);
    any_faulty.push_back(fault != faulty.begin() + end);
  }
  faulty = std::move(any_faulty);
  return means;
}

FlightData read_flight(const Design& design, FlightLog log, const FlightDiagnosisOptions& options) {
  if (log.roll.empty()) log.roll.assign(log.time.size(), 0.0);
  if (log.down_velocity.empty()) log.down_velocity.assign(log.time.size(), 0.0);
  validate(log);
  SampleRange range = options.range ? *options.range : moving_part(log);

  FlightData data;
  data.faults = repair_flight_log(log, range);
  if (const std::size_t count = averaged_samples(log, range); count > 1) {
    log = averaged(log, range, count, data.faults.sample);
    range = {0, log.time.size()};
    data.faults.notes.push_back(fmt::format(
        "means of {} samples each are judged: a faster log knows no more of the drag", count));
  }
  data.observations = observe(log, range, options.pitch_offset, design.flight.gravity);
  data.record = flight_record(data.observations, design.drone.mass, design.flight.air_density,
                              design.flight.gravity);
  if (data.observations.size() < 3) {
    throw UnsuitableFlight("the chosen part of the flight has fewer than three samples");
  }
  data.step = median_step(data.observations.time);
  check_flight_units(data.record, data.observations.forward_acceleration, data.step);
  const std::vector<bool> usable = usable_samples(log, data.faults, data.observations, data.step);
  const auto count = static_cast<std::size_t>(std::count(usable.begin(), usable.end(), true));
  data.usable = static_cast<double>(count) * data.step;
  data.blocks = std::min(most_blocks, static_cast<std::size_t>(data.usable / shortest_block));
  data.block.assign(usable.size(), -1);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < usable.size(); ++i) {
    if (usable[i]) data.block[i] = static_cast<int>(seen++ * data.blocks / count);
  }
  return data;
}

bool testable(const Effect& effect, const LogFaults& faults) {
  return !(faults.height_unknown && contains(effect.needs, "vd_m_s"));
}

/// What every flight fits beside its effects, in the order of `FlightBase`.
std::vector<Effect> base_parameters(const FlightData& data) {
  constexpr double largest = 10;  // m², beyond any drone
  const double known = data.faults.height_unknown ? 0 : 1;
  const auto [least, most] = std::minmax_element(data.record.yaw.begin(), data.record.yaw.end());
  const double turns = *most - *least > steady_yaw ? 1 : 0;
  const EffectParameter area{
      .name = "front_area_m2", .unit = "m²", .upper = largest, .scale = 5e-3, .start = 0.015};
  EffectParameter top = area;
  top.name = "top_area_m2";
  return {{.title = "drag areas", .parameters = {area, top}, .sizes = 2},
          {.title = "vertical acceleration",
           .parameters = {{.name = "vertical_acceleration_gain",
                           .unit = "1",
                           .neutral = known,
                           .upper = 1.5 * known,
                           .scale = 0.2}}},
          {.title = "turning frame",
           .parameters = {{.name = "turn_gain", .unit = "1", .upper = 1.5 * turns, .scale = 0.2}}}};
}

FlightBase flight_base(std::span<const double> values) {
  return {.front_area = values[0],
          .top_area = values[1],
          .vertical_acceleration_gain = values[2],
          .turn_gain = values[3]};
}

/// Whether headings a good part of a turn apart are flown, each for some time.
bool turns(const FlightData& data) {
  constexpr double apart = 0.35;  // rad: a third of a force across the one is along the other
  std::vector<double> yaw = data.record.yaw;
  std::sort(yaw.begin(), yaw.end());
  return yaw[yaw.size() * 19 / 20] - yaw[yaw.size() / 20] > apart;
}

/// Mean over the two intervals around each sample of a quantity that is straight between samples,
/// with the weights that the three-point derivative gives to the intervals.
void average_around(const std::vector<double>& time, const std::vector<double>& a,
                    std::span<double> out) {
  const std::size_t size = a.size();
  out[0] = a[0];
  out[size - 1] = a[size - 1];
  for (std::size_t i = 1; i + 1 < size; ++i) {
    const double before = time[i] - time[i - 1];
    const double after = time[i + 1] - time[i];
    out[i] = ((a[i - 1] + a[i]) / 2 * after + (a[i] + a[i + 1]) / 2 * before) / (before + after);
  }
}

class FlightModel : public LogModel {
 public:
  FlightModel(const Design& design, const FlightData& data, const std::vector<std::string>& base)
      : LogModel(data.record.time), data_(data), base_(base_parameters(data)) {
    for (const Effect& effect : base_) add(effect, design, true);
    const bool turning = turns(data);
    for (const Effect& effect : effect_catalogue(LogKind::flight)) {
      if (!testable(effect, data.faults)) continue;
      add(effect, design, contains(base, effect.id));
      if (!turning) hold_across(effect);
    }
    problem.measured = data.observations.forward_acceleration;
    problem.noise.assign(problem.measured.size(), 1.0);
    problem.block = data.block;
    problem.predict = [this, prediction = FlightPrediction(data.record)](
                          std::span<const double> values, std::span<double> out) mutable {
      predict_acceleration(prediction, flight_base(values), freed(values));
      average_around(prediction.record.time, prediction.acceleration, out);
    };
  }

  /// The effects that are not neutral.
  [[nodiscard]] std::vector<EffectValues> freed(std::span<const double> values) const {
    std::vector<EffectValues> result;
    for (std::size_t g = base_.size(); g < effects().size(); ++g) {
      if (!is_neutral(g, values)) result.push_back({&effect(g), own(g, values)});
    }
    return result;
  }

  [[nodiscard]] std::size_t series(const Effect&) const override { return 0; }
  [[nodiscard]] Channel channel(const Effect& effect) const override {
    return flight_channel(effect.channel, data_.record);
  }
  [[nodiscard]] std::vector<double> left_by(std::size_t,
                                            std::span<const double> values) const override {
    std::vector<double> left(problem.measured.size());
    problem.predict(values, left);
    for (std::size_t i = 0; i < left.size(); ++i) {
      left[i] = data_.block[i] < 0 ? nan : problem.measured[i] - left[i];
    }
    return left;
  }

 private:
  /// In the group added last.
  void hold_across(const Effect& effect) {
    for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
      ModelParameter& p = problem.groups.back().parameters[k];
      if (effect.parameters[k].only_if_turning) p.lower = p.upper = p.neutral;
    }
  }

  const FlightData& data_;
  std::vector<Effect> base_;
};

/// What a fit with linear drag and wind tells before the search: good enough for the airspeed in
/// regressors and for what an error of the time stamps does.
struct Preliminary {
  double wind = 0;
  std::vector<double> time_stamp_error;  ///< change of the prediction by one standard deviation
};

Preliminary preliminary_fit(const Design& design, const FlightData& data) {
  const FlightModel model(design, data, {"linear_drag", "wind"});
  const SelectionProblem& problem = model.problem;
  const std::size_t delay = model.index_of("attitude_delay_s").value();
  SelectionOptions nothing;
  nothing.most_findings = 0;
  std::vector<double> values = select_effects(problem, nothing).base.values;

  Preliminary result;
  result.wind = values[model.index_of("wind_m_s").value()];
  result.time_stamp_error.resize(problem.measured.size());
  std::vector<double> early(problem.measured.size());
  values[delay] = time_stamp_uncertainty * data.step;
  problem.predict(values, result.time_stamp_error);
  values[delay] = -values[delay];
  problem.predict(values, early);
  for (std::size_t i = 0; i < early.size(); ++i) {
    result.time_stamp_error[i] = (result.time_stamp_error[i] - early[i]) / 2;
  }
  return result;
}

void size_up(const Selection& selection, Unexplained& unexplained) {
  if (!unexplained.detected) return;
  unexplained.size = selection.extended.holdout_rmse * std::sqrt(unexplained.share_percent / 100);
  unexplained.size_unit = unit_of_flights;
  unexplained.shape = fmt::format(
      "the forward acceleration that is left follows {}; no effect of the catalogue does, so it "
      "stays unnamed",
      unexplained.regressor);
}

std::vector<SpecChange> spec_changes(const FlightModel& model, const ModelFit& fit) {
  std::vector<SpecChange> out{{"drone.drag.front_area_m2", fit.values[0]},
                              {"drone.drag.top_area_m2", fit.values[1]}};
  for (std::size_t g = 0; g < model.effects().size(); ++g) {
    for (std::size_t k = 0; k < model.effect(g).parameters.size(); ++k) {
      const EffectParameter& p = model.effect(g).parameters[k];
      // Also where neutral: the fitted areas belong to a drag law without it.
      if (p.spec_field.empty()) continue;
      out.push_back({p.spec_field, fit.values[model.first_parameter(g) + k] / p.unit_SI});
    }
  }
  return out;
}

/// Each block is simulated with the parameters fitted without it.
double speed_rmse(const FlightData& data, const FlightModel& model, const ModelFit& fit,
                  double window) {
  double sum = 0;
  std::size_t count = 0;
  const FlightRecord& record = data.record;
  for (std::size_t first = 0; first < record.size();) {
    const int block = data.block[first];
    std::size_t last = first + 1;
    while (last < record.size() && data.block[last] == block) ++last;
    if (block >= 0) {
      const FlightRecord part = part_of(record, first, last);
      const auto& values = fit.without_block[static_cast<std::size_t>(block)];
      const std::vector<double> speed = simulate_speed(
          part, flight_base(values), model.freed(values), window, step_tolerance * data.step);
      for (std::size_t i = 0; i < speed.size(); ++i) {
        sum += std::pow(speed[i] - part.forward_speed[i], 2);
      }
      count += speed.size();
    }
    first = last;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

double effective_samples(const FlightData& data, const ModelFit& fit) {
  std::vector<double> residuals;
  for (std::size_t i = 0; i < data.block.size(); ++i) {
    if (data.block[i] >= 0) residuals.push_back(fit.holdout_residual[i]);
  }
  return effective_sample_size(residuals);
}

ComparedSeries compared(const FlightData& data, const FlightModel& model,
                        const Selection& selection) {
  ComparedSeries series{quantity_of_flights,
                        unit_of_flights,
                        std::string(to_string(Stage::airframe)),
                        data.record.time,
                        model.problem.measured,
                        {},
                        {}};
  for (std::size_t i = 0; i < series.time.size(); ++i) {
    const double used = data.block[i] < 0 ? nan : series.measured[i];
    series.before.push_back(used - selection.base.holdout_residual[i]);
    series.after.push_back(used - selection.extended.holdout_residual[i]);
  }
  return series;
}

/// Which way "ahead" and "right" are in what was found or is suspected, where that is said.
void tell_heading(const FlightData& data, Diagnosis& d) {
  const auto is_directed = [](const auto& told) {
    const auto& parameters = find_effect(told.effect)->parameters;
    return std::any_of(parameters.begin(), parameters.end(),
                       [](const EffectParameter& p) { return p.only_if_turning; });
  };
  if (std::none_of(d.findings.begin(), d.findings.end(), is_directed) &&
      std::none_of(d.suspected.begin(), d.suspected.end(), is_directed)) {
    return;
  }
  const double heading = data.record.mean_heading / unit::degree;
  d.notes.push_back(
      fmt::format("ahead is along the mean heading of the flight, {:.0f}° from north over east; "
                  "right is to the right of it",
                  heading < 0 ? heading + 360 : heading));
}

void report(const FlightData& data, const FlightModel& model, const Selection& selection,
            const FlightDiagnosisOptions& options, Diagnosis& d) {
  d.not_identifiable.push_back(
      {"extra_mass",
       "a wrong mass only rescales the drag areas, since both enter as force over mass"});
  tell(model, selection, d);
  tell_heading(data, d);
  d.samples = selection.rows;
  d.effective_samples = effective_samples(data, selection.complete);
  d.unexplained.undetectable_percent = undetectable_percent(
      d.effective_samples, model.problem.unnamed.size(), options.selection.false_alarm_probability);
  d.compared.push_back(compared(data, model, selection));
  size_up(selection, d.unexplained);
  d.spec_changes = spec_changes(model, selection.complete);
  d.further.push_back(
      {fmt::format("forward speed simulated open-loop over {:g} s windows", options.speed_window),
       "m/s", speed_rmse(data, model, selection.base, options.speed_window),
       speed_rmse(data, model, selection.extended, options.speed_window)});
}

Diagnosis too_short(const FlightData& data) {
  Diagnosis d;
  d.samples = static_cast<std::size_t>(
      std::count_if(data.block.begin(), data.block.end(), [](int b) { return b >= 0; }));
  d.base.holdout_rmse = nan;
  d.extended.holdout_rmse = d.base.holdout_rmse;
  const double needed = shortest_block * static_cast<double>(fewest_blocks);
  const std::string needs = fmt::format(
      "a longer flight: {:.0f} s, this one has {:.1f} s that can be used", needed, data.usable);
  for (const Effect& effect : effect_catalogue(LogKind::flight)) {
    d.not_testable.push_back({effect.id, needs});
  }
  d.notes.push_back(fmt::format(
      "too short to tell an effect from chance: {:.1f} s of usable flight, {:.0f} s are needed",
      data.usable, needed));
  return d;
}

}  // namespace

Diagnosis diagnose_flight(const Design& design, const FlightLog& log,
                          const FlightDiagnosisOptions& options,
                          const SelectionProgress& progress) {
  if (!(design.drone.mass > 0) || !(design.flight.air_density > 0)) {
    throw std::invalid_argument("mass and air density must be positive");
  }
  check_base_effects(LogKind::flight, options.base);
  const FlightData data = read_flight(design, log, options);

  Diagnosis d;
  if (data.blocks < fewest_blocks) {
    d = too_short(data);
  } else {
    FlightModel model(design, data, options.base);
    Preliminary preliminary = preliminary_fit(design, data);
    model.problem.unnamed = flight_shapes(data.observations, preliminary.wind);
    model.problem.systematic.push_back(std::move(preliminary.time_stamp_error));
    const Selection selection = select_effects(model.problem, options.selection, progress);
    report(data, model, selection, options, d);
    for (const Effect& effect : effect_catalogue(LogKind::flight)) {
      if (!testable(effect, data.faults)) {
        d.not_testable.push_back({effect.id, "a down velocity that moves (vd_m_s)"});
      }
    }
  }
  d.kind = "flight";
  d.unit = unit_of_flights;
  d.quantity = quantity_of_flights;
  d.notes.insert(d.notes.begin(), data.faults.notes.begin(), data.faults.notes.end());
  if (data.faults.level_assumed) d.notes.push_back("the roll never moves; it is taken as logged");
  return d;
}

}  // namespace tethercalc
