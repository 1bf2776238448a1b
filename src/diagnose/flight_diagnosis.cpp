#include "tethercalc/diagnose/flight_diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>

#include "diagnose/flight_log_faults.hpp"
#include "diagnose/flight_structure.hpp"
#include "diagnose/told_selection.hpp"
#include "diagnose/unit_checks.hpp"
#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/diagnose/channels.hpp"
#include "tethercalc/diagnose/flight_prediction.hpp"
#include "tethercalc/identify/correlated_errors.hpp"

namespace tethercalc {
namespace {

/// Shortest block: ten correlation times of about a second, and about one pass there or back, so
/// that blocks hardly know of each other.
constexpr double shortest_block = 12.0;  // s
/// More blocks sharpen the spread between them only a little: with 30, Student's factor is 4 %
/// above the normal one.
constexpr std::size_t most_blocks = 30;
/// A step longer than this times the median one separates neighbours.
constexpr double gap_factor = 1.5;
/// Part of a sampling interval within which the log does not say when a reading was taken, and by
/// which an estimator's own integration step shifts it: a standard deviation, the same for the
/// whole log.
constexpr double time_stamp_uncertainty = 0.05;

constexpr const char* unit_of_flights = "m/s²";
constexpr const char* areas_group = "drag areas";
constexpr const char* vertical_group = "vertical acceleration";
constexpr std::size_t turn_index = 2;  ///< among the groups
constexpr const char* turn_group = "turning frame";
/// A yaw that stays within this never turned; its noise would only be a regressor of noise.
constexpr double steady_yaw = 0.1;  // rad

/// Which group of the selection is which effect; null for the groups that are no effects.
struct FlightGroups {
  std::vector<ParameterGroup> groups;
  std::vector<const Effect*> effects;
  std::size_t parameter_count = 0;
};

struct FlightData {
  Observations observations;
  FlightRecord record;
  std::vector<int> block;
  LogFaults faults;
  double step = 0;    ///< s, median
  double usable = 0;  ///< s
  std::size_t blocks = 0;
};

double median_step(const std::vector<double>& time) {
  std::vector<double> steps(time.size() - 1);
  for (std::size_t i = 0; i < steps.size(); ++i) steps[i] = time[i + 1] - time[i];
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

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
                o.time[i] - o.time[i - 1] <= gap_factor * step &&
                o.time[i + 1] - o.time[i] <= gap_factor * step;
  }
  return usable;
}

FlightData read_flight(const Design& design, FlightLog log, const FlightDiagnosisOptions& options) {
  if (log.roll.empty()) log.roll.assign(log.time.size(), 0.0);
  if (log.down_velocity.empty()) log.down_velocity.assign(log.time.size(), 0.0);
  validate(log);
  const SampleRange range = options.range ? *options.range : moving_part(log);

  FlightData data;
  data.faults = repair_flight_log(log, range);
  data.observations = observe(log, range, options.pitch_offset, design.flight.gravity);
  data.record = flight_record(data.observations, design.drone.mass, design.flight.air_density,
                              design.flight.gravity);
  if (data.observations.size() < 3) {
    throw UnsuitableFlight("the chosen part of the flight has fewer than three samples");
  }
  data.step = median_step(data.observations.time);
  check_flight_units(data.observations, data.step);
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

ParameterGroup areas() {
  constexpr double largest = 10;  // m², beyond any drone
  const ModelParameter area{
      .neutral = 0, .lower = 0, .upper = largest, .scale = 5e-3, .start = 0.015};
  return {areas_group, ParameterGroup::Role::fitted, {area, area}, std::nullopt};
}

ParameterGroup vertical_acceleration(bool known) {
  const double start = known ? 1.0 : 0.0;
  return {vertical_group,
          ParameterGroup::Role::fitted,
          {{.neutral = start, .lower = 0, .upper = known ? 1.5 : 0, .scale = 0.2, .start = start}},
          std::nullopt};
}

ParameterGroup turning_frame(const std::vector<double>& yaw) {
  const auto [least, most] = std::minmax_element(yaw.begin(), yaw.end());
  const double upper = *most - *least > steady_yaw ? 1.5 : 0;
  return {turn_group,
          ParameterGroup::Role::fitted,
          {{.neutral = 0, .lower = 0, .upper = upper, .scale = 0.2, .start = 0}},
          std::nullopt};
}

bool testable(const Effect& effect, const LogFaults& faults) {
  const bool needs_height =
      std::find(effect.needs.begin(), effect.needs.end(), "vd_m_s") != effect.needs.end();
  return !(needs_height && faults.height_unknown);
}

FlightGroups flight_groups(const std::vector<std::string>& base, const FlightData& data) {
  const LogFaults& faults = data.faults;
  FlightGroups result;
  result.groups = {areas(), vertical_acceleration(!faults.height_unknown),
                   turning_frame(data.record.yaw)};
  result.effects = {nullptr, nullptr, nullptr};
  std::map<std::string, std::size_t, std::less<>> index;
  for (const Effect& effect : effect_catalogue()) {
    if (effect.log != LogKind::flight || !testable(effect, faults)) continue;
    ParameterGroup group;
    group.id = effect.id;
    const bool fitted = std::find(base.begin(), base.end(), effect.id) != base.end();
    group.role = fitted ? ParameterGroup::Role::fitted : ParameterGroup::Role::candidate;
    for (const EffectParameter& p : effect.parameters) {
      group.parameters.push_back({.neutral = p.neutral * p.unit_SI,
                                  .lower = p.lower * p.unit_SI,
                                  .upper = p.upper * p.unit_SI,
                                  .scale = p.scale * p.unit_SI,
                                  .start = p.neutral * p.unit_SI});
    }
    if (const auto replaced = index.find(effect.replaces); replaced != index.end()) {
      group.replaces = replaced->second;
    }
    index[effect.id] = result.groups.size();
    result.groups.push_back(std::move(group));
    result.effects.push_back(&effect);
  }
  for (const ParameterGroup& group : result.groups) {
    result.parameter_count += group.parameters.size();
  }
  return result;
}

FlightBase flight_base(std::span<const double> values) {
  return {.front_area = values[0],
          .top_area = values[1],
          .vertical_acceleration_gain = values[2],
          .turn_gain = values[3]};
}

std::vector<EffectValues> effect_values(const FlightGroups& groups,
                                        std::span<const double> values) {
  std::vector<EffectValues> result;
  std::size_t first = 0;
  for (std::size_t g = 0; g < groups.groups.size(); ++g) {
    const std::size_t count = groups.groups[g].parameters.size();
    const auto own = values.subspan(first, count);
    first += count;
    if (groups.effects[g] == nullptr) continue;
    const bool neutral =
        std::equal(own.begin(), own.end(), groups.groups[g].parameters.begin(),
                   [](double value, const ModelParameter& p) { return value == p.neutral; });
    if (!neutral) result.push_back({groups.effects[g], own});
  }
  return result;
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

SelectionProblem selection_problem(const FlightData& data, const FlightGroups& groups) {
  SelectionProblem problem;
  problem.groups = groups.groups;
  problem.measured = data.observations.forward_acceleration;
  problem.noise.assign(problem.measured.size(), 1.0);
  problem.block = data.block;
  problem.predict = [&groups, prediction = FlightPrediction(data.record)](
                        std::span<const double> values, std::span<double> out) mutable {
    predict_acceleration(prediction, flight_base(values), effect_values(groups, values));
    average_around(prediction.record.time, prediction.acceleration, out);
  };
  return problem;
}

/// What a fit with linear drag and wind tells before the search: good enough for the airspeed in
/// regressors and for what an error of the time stamps does.
struct Preliminary {
  double wind = 0;
  std::vector<double> time_stamp_error;  ///< change of the prediction by one standard deviation
};

Preliminary preliminary_fit(const FlightData& data) {
  const FlightGroups groups = flight_groups({"linear_drag", "wind"}, data);
  std::size_t first = 0;
  std::size_t wind = 0;
  std::size_t delay = 0;
  for (const ParameterGroup& group : groups.groups) {
    if (group.id == "wind") wind = first;
    if (group.id == "attitude_delay") delay = first;
    first += group.parameters.size();
  }
  const SelectionProblem problem = selection_problem(data, groups);
  SelectionOptions nothing;
  nothing.most_findings = 0;
  std::vector<double> values = select_effects(problem, nothing).base.values;

  Preliminary result;
  result.wind = values[wind];
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

class Report {
 public:
  Report(const FlightData& data, const FlightGroups& groups, const SelectionProblem& problem,
         const Selection& selection)
      : data_(data), groups_(groups), problem_(problem), selection_(selection) {}

  Diagnosis write(const FlightDiagnosisOptions& options) const;

 private:
  [[nodiscard]] std::size_t first_parameter(std::size_t group) const;
  [[nodiscard]] ParameterEstimate estimate(const ModelFit& fit, std::size_t index,
                                           const std::string& name, const std::string& unit,
                                           double unit_SI) const;
  void append_group(const ModelFit& fit, std::size_t g, std::vector<ParameterEstimate>& out) const;
  [[nodiscard]] std::vector<ParameterEstimate> parameters(const ModelFit& fit) const;
  [[nodiscard]] Finding finding(const SelectedGroup& selected) const;
  [[nodiscard]] std::vector<NotIdentifiable> not_identifiable() const;
  [[nodiscard]] Unexplained unexplained() const;
  [[nodiscard]] std::vector<SpecChange> spec_changes() const;
  [[nodiscard]] double speed_rmse(const ModelFit& fit, double window) const;
  [[nodiscard]] double effective_samples() const;
  [[nodiscard]] std::vector<double> left_by(std::span<const double> values) const;
  [[nodiscard]] ComparedSeries compared() const;
  [[nodiscard]] FindingTrace trace(const SelectedGroup& selected) const;

  const FlightData& data_;
  const FlightGroups& groups_;
  const SelectionProblem& problem_;
  const Selection& selection_;
};

std::size_t Report::first_parameter(std::size_t group) const {
  std::size_t first = 0;
  for (std::size_t g = 0; g < group; ++g) first += groups_.groups[g].parameters.size();
  return first;
}

ParameterEstimate Report::estimate(const ModelFit& fit, std::size_t index, const std::string& name,
                                   const std::string& unit, double unit_SI) const {
  const double half_width = selection_.student_factor * fit.standard_error[index] / unit_SI;
  const double value = fit.values[index] / unit_SI;
  return {name, value, unit, value - half_width, value + half_width};
}

void Report::append_group(const ModelFit& fit, std::size_t g,
                          std::vector<ParameterEstimate>& out) const {
  const std::size_t first = first_parameter(g);
  const Effect* effect = groups_.effects[g];
  for (std::size_t k = 0; k < effect->parameters.size(); ++k) {
    const EffectParameter& p = effect->parameters[k];
    out.push_back(estimate(fit, first + k, p.name, p.unit, p.unit_SI));
  }
}

std::vector<ParameterEstimate> Report::parameters(const ModelFit& fit) const {
  std::vector<ParameterEstimate> out{estimate(fit, 0, "front_area_m2", "m²", 1),
                                     estimate(fit, 1, "top_area_m2", "m²", 1)};
  if (!data_.faults.height_unknown) {
    out.push_back(estimate(fit, 2, "vertical_acceleration_gain", "1", 1));
  }
  if (groups_.groups[turn_index].parameters.front().upper > 0) {
    out.push_back(estimate(fit, 3, "turn_gain", "1", 1));
  }
  for (std::size_t g = 0; g < groups_.groups.size(); ++g) {
    const std::size_t first = first_parameter(g);
    const auto& own = groups_.groups[g].parameters;
    bool freed = false;
    for (std::size_t k = 0; k < own.size(); ++k) {
      freed = freed || fit.values[first + k] != own[k].neutral || fit.standard_error[first + k] > 0;
    }
    if (groups_.effects[g] != nullptr && freed) append_group(fit, g, out);
  }
  return out;
}

Finding Report::finding(const SelectedGroup& selected) const {
  const Effect& effect = *groups_.effects[selected.group];
  Finding f = finding_of(effect, selected);
  append_group(selection_.complete, selected.group, f.parameters);
  for (const std::size_t g : selected.indistinguishable) {
    const Effect& rival = *groups_.effects[g];
    f.indistinguishable_from.push_back(rival.id);
    f.to_separate +=
        fmt::format("{}{}: {}", f.to_separate.empty() ? "" : "; ", rival.id, rival.to_separate);
  }
  return f;
}

std::vector<NotIdentifiable> Report::not_identifiable() const {
  std::vector<NotIdentifiable> out{
      {"extra_mass",
       "a wrong mass only rescales the drag areas, since both enter as force over mass"}};
  for (const Selection::Aliased& aliased : selection_.aliased) {
    const Effect& effect = *groups_.effects[aliased.group];
    std::string because;
    if (effect.id == "turning_wind") {
      because =
          "the yaw hardly turns in this flight, where a wind over ground is a steady headwind";
    } else if (aliased.with.empty()) {
      because = "it changes nothing in this flight";
    } else {
      because =
          fmt::format("in this flight it acts like {}", groups_.groups[aliased.with.front()].id);
    }
    out.push_back({effect.id, std::move(because)});
  }
  return out;
}

Unexplained Report::unexplained() const {
  Unexplained out;
  out.detected = !selection_.unnamed.regressors.empty();
  if (!out.detected) return out;
  out.channels = selection_.unnamed.channels;
  out.share_percent = selection_.unnamed.share_percent;
  out.size = selection_.extended.holdout_rmse * std::sqrt(out.share_percent / 100);
  out.size_unit = unit_of_flights;
  out.regressor = problem_.unnamed[selection_.unnamed.regressors.front()].shape;
  out.shape = fmt::format(
      "the forward acceleration that is left follows {}; no effect of the catalogue does, so it "
      "stays unnamed",
      out.regressor);
  return out;
}

std::vector<SpecChange> Report::spec_changes() const {
  const ModelFit& fit = selection_.complete;
  std::vector<SpecChange> out{{"drone.drag.front_area_m2", fit.values[0]},
                              {"drone.drag.top_area_m2", fit.values[1]}};
  for (std::size_t g = 0; g < groups_.groups.size(); ++g) {
    if (groups_.effects[g] == nullptr) continue;
    const std::size_t first = first_parameter(g);
    for (std::size_t k = 0; k < groups_.effects[g]->parameters.size(); ++k) {
      const EffectParameter& p = groups_.effects[g]->parameters[k];
      // Also where neutral: the fitted areas belong to a drag law without it.
      if (!p.spec_field.empty()) out.push_back({p.spec_field, fit.values[first + k] / p.unit_SI});
    }
  }
  return out;
}

/// Each block is simulated with the parameters fitted without it.
double Report::speed_rmse(const ModelFit& fit, double window) const {
  double sum = 0;
  std::size_t count = 0;
  const FlightRecord& record = data_.record;
  for (std::size_t first = 0; first < record.size();) {
    const int block = data_.block[first];
    std::size_t last = first + 1;
    while (last < record.size() && data_.block[last] == block) ++last;
    if (block >= 0) {
      const FlightRecord part = part_of(record, first, last);
      const auto& values = fit.without_block[static_cast<std::size_t>(block)];
      const std::vector<double> speed =
          simulate_speed(part, flight_base(values), effect_values(groups_, values), window,
                         gap_factor * data_.step);
      for (std::size_t i = 0; i < speed.size(); ++i) {
        sum += std::pow(speed[i] - part.forward_speed[i], 2);
      }
      count += speed.size();
    }
    first = last;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

double Report::effective_samples() const {
  std::vector<double> residuals;
  for (std::size_t i = 0; i < data_.block.size(); ++i) {
    if (data_.block[i] >= 0) residuals.push_back(selection_.complete.holdout_residual[i]);
  }
  return effective_sample_size(residuals);
}

/// Measured less predicted; NaN in samples that are left out.
std::vector<double> Report::left_by(std::span<const double> values) const {
  std::vector<double> left(problem_.measured.size());
  problem_.predict(values, left);
  for (std::size_t i = 0; i < left.size(); ++i) {
    left[i] = data_.block[i] < 0 ? std::numeric_limits<double>::quiet_NaN()
                                 : problem_.measured[i] - left[i];
  }
  return left;
}

ComparedSeries Report::compared() const {
  ComparedSeries series;
  series.time = data_.record.time;
  series.measured = problem_.measured;
  for (std::size_t i = 0; i < series.time.size(); ++i) {
    const double used =
        data_.block[i] < 0 ? std::numeric_limits<double>::quiet_NaN() : problem_.measured[i];
    series.before.push_back(used - selection_.base.holdout_residual[i]);
    series.after.push_back(used - selection_.extended.holdout_residual[i]);
  }
  series.stage = to_string(Stage::airframe);
  return series;
}

FindingTrace Report::trace(const SelectedGroup& selected) const {
  FindingTrace trace;
  trace.channel = flight_channel(groups_.effects[selected.group]->channel, data_.record);
  std::vector<double> values = selection_.complete.values;
  trace.with = left_by(values);
  const auto& parameters = groups_.groups[selected.group].parameters;
  const std::size_t first = first_parameter(selected.group);
  for (std::size_t k = 0; k < parameters.size(); ++k) values[first + k] = parameters[k].neutral;
  trace.without = left_by(values);
  return trace;
}

Diagnosis Report::write(const FlightDiagnosisOptions& options) const {
  Diagnosis d;
  d.samples = selection_.rows;
  d.effective_samples = effective_samples();
  d.base = {selection_.base.holdout_rmse, parameters(selection_.base)};
  for (const SelectedGroup& selected : selection_.selected) d.findings.push_back(finding(selected));
  d.compared.push_back(compared());
  for (const SelectedGroup& selected : selection_.selected) d.traces.push_back(trace(selected));
  d.not_identifiable = not_identifiable();
  d.unexplained = unexplained();
  d.extended = {selection_.extended.holdout_rmse, parameters(selection_.complete)};
  d.spec_changes = spec_changes();
  d.budget = error_budget(selection_);
  for (const Selection::TooSmall& small : selection_.too_small) {
    d.notes.push_back(fmt::format(
        "{} is no chance, but lowers the error by {:.1f} % only: less than {:.0f} % is not named",
        groups_.groups[small.group].id, small.gain_percent, options.selection.least_gain_percent));
  }
  d.further.push_back(
      {fmt::format("forward speed simulated open-loop over {:g} s windows", options.speed_window),
       "m/s", speed_rmse(selection_.base, options.speed_window),
       speed_rmse(selection_.extended, options.speed_window)});
  return d;
}

void check_options(const Design& design, const FlightDiagnosisOptions& options) {
  if (!(design.drone.mass > 0) || !(design.flight.air_density > 0)) {
    throw std::invalid_argument("mass and air density must be positive");
  }
  std::string unknown;
  std::string known;
  for (const Effect& effect : effect_catalogue()) {
    if (effect.log == LogKind::flight) known += (known.empty() ? "" : ", ") + effect.id;
  }
  for (const std::string& id : options.base) {
    const Effect* effect = find_effect(id);
    if (effect == nullptr || effect->log != LogKind::flight) {
      unknown += (unknown.empty() ? "" : ", ") + id;
    }
  }
  if (!unknown.empty()) {
    throw std::invalid_argument(
        fmt::format("no effect of a flight is called {}; there are {}", unknown, known));
  }
}

Diagnosis too_short(const FlightData& data) {
  Diagnosis d;
  d.samples = static_cast<std::size_t>(
      std::count_if(data.block.begin(), data.block.end(), [](int b) { return b >= 0; }));
  d.base.holdout_rmse = std::numeric_limits<double>::quiet_NaN();
  d.extended.holdout_rmse = d.base.holdout_rmse;
  const double needed = shortest_block * static_cast<double>(fewest_blocks);
  for (const Effect& effect : effect_catalogue()) {
    if (effect.log == LogKind::flight) {
      d.not_testable.push_back(
          {effect.id,
           fmt::format("a longer flight: {:.0f} s, this one has {:.1f} s that can be used", needed,
                       data.usable)});
    }
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
  check_options(design, options);
  const FlightData data = read_flight(design, log, options);

  Diagnosis d;
  if (data.blocks < fewest_blocks) {
    d = too_short(data);
  } else {
    const FlightGroups groups = flight_groups(options.base, data);
    SelectionProblem problem = selection_problem(data, groups);
    Preliminary preliminary = preliminary_fit(data);
    problem.unnamed = flight_structure(data.observations, preliminary.wind);
    problem.systematic.push_back(std::move(preliminary.time_stamp_error));
    const Selection selection = select_effects(problem, options.selection, progress);
    d = Report(data, groups, problem, selection).write(options);
    for (const Effect& effect : effect_catalogue()) {
      if (effect.log == LogKind::flight && !testable(effect, data.faults)) {
        d.not_testable.push_back({effect.id, "a down velocity that moves (vd_m_s)"});
      }
    }
  }
  d.kind = "flight";
  d.unit = unit_of_flights;
  d.quantity = "forward acceleration";
  for (ComparedSeries& series : d.compared) {
    series.quantity = d.quantity;
    series.unit = d.unit;
  }
  d.notes.insert(d.notes.begin(), data.faults.notes.begin(), data.faults.notes.end());
  if (data.faults.level_assumed) d.notes.push_back("the roll never moves; it is taken as logged");
  return d;
}

}  // namespace tethercalc
