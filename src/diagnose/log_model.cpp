#include "diagnose/log_model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

#include "diagnose/fit_judgement.hpp"
#include "diagnose/flight_prediction.hpp"
#include "identify/statistics.hpp"
#include "model/constants.hpp"
#include "tethercalc/diagnose/power_log.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

/// In SI, at the neutral value in `design`.
ModelParameter in_SI(const EffectParameter& p, const Design& design) {
  ModelParameter m;
  m.neutral = p.in_design != nullptr ? p.in_design(design) : p.neutral * p.unit_SI;
  m.lower = p.lower * p.unit_SI;
  m.upper = p.upper * p.unit_SI;
  if (p.in_design != nullptr) {
    m.lower = std::min(m.neutral, m.lower);
    m.upper = std::max(m.neutral, m.upper);
  }
  m.scale = p.scale * p.unit_SI;
  m.start = std::clamp(m.neutral + p.start * p.unit_SI, m.lower, m.upper);
  return m;
}

/// Places of a moment are this part of the log's duration apart: a step that is at most half as far
/// from one still shows nearly whole.
constexpr int moments = 40;

void look_through(const EffectParameter& effect, double begin, double end, ModelParameter& p) {
  const double duration = end - begin;
  if (!(duration > 0)) return;
  switch (effect.look_through) {
    case LookThrough::nothing:
      return;
    case LookThrough::moments:
      p.lower = begin + 0.05 * duration;
      p.upper = end - 0.05 * duration;
      p.fitted = false;
      for (int k = 0; k < moments; ++k) {
        p.places.push_back(p.lower + (p.upper - p.lower) * (k + 0.5) / moments);
      }
      break;
    case LookThrough::periods:
      // Neighbours lose half a wave against each other over the log: the fit finds the rest.
      p.lower = effect.lower * effect.unit_SI;
      p.upper = std::max(p.lower, 1.5 * duration);
      for (double halves = 1.5; 2 * duration / halves >= p.lower; ++halves) {
        p.places.push_back(std::min(p.upper, 2 * duration / halves));
      }
      p.scale = 0.1 * p.lower;
      break;
    case LookThrough::ratios:
      for (double place = p.lower; place <= p.upper; place *= 1.25) p.places.push_back(place);
      break;
  }
  if (p.places.empty()) p.places.push_back(p.upper);
  p.start = p.places.front();
  // A value at a bound means that something else is at work, unless it is neutral.
  p.neutral = effect.look_through == LookThrough::ratios ? p.places[p.places.size() / 2] : p.start;
}

using Interval = std::pair<double, double>;

Interval symmetric_interval(const ModelFit& fit, std::size_t parameter, double student_factor) {
  const double half = student_factor * fit.standard_error[parameter];
  return {fit.values[parameter] - half, fit.values[parameter] + half};
}

/// What a ratio is made of: `numerator` over `base`, with their variances and covariance.
struct Ratio {
  double numerator = 0;
  double base = 1;
  double numerator_variance = 0;
  double base_variance = 0;
  double covariance = 0;
};

/// All p with (b − p·a)² ≤ t²·var(b − p·a) for the ratio b/a, as far as they hang together with it:
/// it has a usable spread also where a may be zero (Fieller, J. R. Stat. Soc. B 16, 1954).
Interval fieller(const Ratio& r, double student_factor) {
  const double t2 = student_factor * student_factor;
  // square·p² − 2·linear·p + constant ≤ 0
  const double square = r.base * r.base - t2 * r.base_variance;
  const double linear = r.base * r.numerator - t2 * r.covariance;
  const double constant = r.numerator * r.numerator - t2 * r.numerator_variance;
  const double discriminant = linear * linear - square * constant;
  if (!(discriminant > 0) || square == 0) return {-infinity, infinity};
  const double root = std::sqrt(discriminant);
  const auto [first, second] = std::minmax({(linear - root) / square, (linear + root) / square});
  if (square > 0) return {first, second};
  return r.numerator / r.base >= second ? Interval{second, infinity} : Interval{-infinity, first};
}

/// Of a ratio p = b/a that was fitted beside the parameter a, by its product b with that.
Interval ratio_interval(const ModelFit& fit, std::size_t parameter, std::size_t of,
                        double student_factor) {
  const double p = fit.values[parameter];
  const double a = fit.values[of];
  const double var_p = fit.standard_error[parameter] * fit.standard_error[parameter];
  const double var_a = fit.standard_error[of] * fit.standard_error[of];
  const double cov_pa = fit.product_covariance[parameter];
  return fieller(
      {a * p, a, a * a * var_p + 2 * a * p * cov_pa + p * p * var_a, var_a, a * cov_pa + p * var_a},
      student_factor);
}

/// Of a size that is not freed.
Interval size_interval(const SizeEstimate& size, double student_factor) {
  return fieller({size.value, size.base, size.standard_error * size.standard_error,
                  size.base_error * size.base_error, size.covariance},
                 student_factor);
}

/// The parameters of the groups that are fitted, and of those that left their neutral values.
std::vector<ParameterEstimate> estimates(const LogModel& log, const Selection& selection,
                                         const ModelFit& fit, std::size_t group) {
  std::vector<ParameterEstimate> result;
  const Effect& effect = log.effect(group);
  for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
    const EffectParameter& p = effect.parameters[k];
    const ModelParameter& bounds = log.problem.groups[group].parameters[k];
    if (!(bounds.lower < bounds.upper)) continue;
    const std::size_t index = log.first_parameter(group) + k;
    const double value = fit.values[index];
    const double student = selection.student_factor[group];
    const auto [lower, upper] = bounds.product_with
                                    ? ratio_interval(fit, index, *bounds.product_with, student)
                                    : symmetric_interval(fit, index, student);
    result.push_back({p.name, value / p.unit_SI, p.unit, std::max(lower, bounds.lower) / p.unit_SI,
                      std::min(upper, bounds.upper) / p.unit_SI, log.flight_of(group)});
  }
  return result;
}

std::vector<ParameterEstimate> parameters(const LogModel& log, const Selection& selection,
                                          const ModelFit& fit) {
  std::vector<ParameterEstimate> result;
  for (std::size_t g = 0; g < log.effects().size(); ++g) {
    const std::size_t first = log.first_parameter(g);
    bool freed = log.problem.groups[g].fitted;
    for (std::size_t k = 0; k < log.effect(g).parameters.size(); ++k) {
      freed = freed || fit.standard_error[first + k] > 0 ||
              fit.values[first + k] != log.problem.groups[g].parameters[k].neutral;
    }
    if (!freed) continue;
    for (ParameterEstimate& p : estimates(log, selection, fit, g)) result.push_back(std::move(p));
  }
  return result;
}

Finding finding_of(const LogModel& log, const Selection& selection, const SelectedGroup& found) {
  const Effect& effect = log.effect(found.group);
  Finding finding;
  finding.effect = effect.id;
  finding.flight = log.flight_of(found.group);
  finding.title = effect.title;
  finding.mechanism = effect.mechanism;
  finding.stage = to_string(effect.stage);
  finding.parameters = estimates(log, selection, selection.complete, found.group);
  finding.holdout_rmse_before = found.rmse_before;
  finding.holdout_rmse_after = found.rmse_after;
  finding.gain_percent = found.gain_percent;
  finding.gain_se_percent = found.gain_se_percent;
  // Where several are told apart in one way, that is said once.
  std::vector<std::pair<std::string, std::vector<std::string>>> ways;
  bool some_in_the_same_way = false;
  for (const std::size_t g : found.indistinguishable) {
    const std::string& way = log.effect(g).to_separate;
    finding.indistinguishable_from.push_back(log.name(g));
    if (way == effect.to_separate) {
      some_in_the_same_way = true;
      continue;
    }
    const auto same = std::ranges::find(ways, way, &decltype(ways)::value_type::first);
    (same == ways.end() ? ways.emplace_back(way, 0) : *same)
        .second.push_back(in_words(log.name(g)));
  }
  std::vector<std::string> separators;
  if (some_in_the_same_way) separators.push_back(effect.to_separate);
  for (const auto& [way, rivals] : ways) {
    separators.push_back(fmt::format("{}: {}", fmt::join(rivals, ", "), way));
  }
  finding.to_separate = fmt::format("{}", fmt::join(separators, "; "));
  return finding;
}

FindingTrace trace_of(const LogModel& log, const Selection& selection, std::size_t group) {
  FindingTrace trace;
  trace.series = log.series(group);
  trace.channel = log.channel(group);
  std::vector<double> values = selection.complete.values;
  trace.with = log.left_by(trace.series, values);
  for (std::size_t k = 0; k < log.effect(group).parameters.size(); ++k) {
    values[log.first_parameter(group) + k] = log.problem.groups[group].parameters[k].neutral;
  }
  trace.without = log.left_by(trace.series, values);
  return trace;
}

NotIdentifiable not_identifiable(const LogModel& log, const Selection::Aliased& aliased) {
  const Effect& effect = log.effect(aliased.group);
  std::string because = "it changes nothing in this log";
  if (!effect.aliased_because.empty()) {
    because = effect.aliased_because;
  } else if (!aliased.with.empty()) {
    because = fmt::format("in this log it acts like {}", in_words(log.name(aliased.with.front())));
  }
  return {effect.id, std::move(because), log.flight_of(aliased.group)};
}

std::string what_is_missing(const Effect& effect, const Selection::Open& open, double least_gain) {
  std::string sure = "a longer log, until chance cannot explain it";
  if (open.gain_percent < least_gain) {
    sure = fmt::format("a gain of {:g} % or more, below which nothing is named", least_gain);
  } else if (open.largest_block_share > most_of_one_block) {
    sure = "more than one stretch of the log that shows it";
  } else if (open.at_bound) {
    sure = "a size within its range: at the end of that something else is at work";
  } else if (open.spoils_kind) {
    sure =
        "a gain in every kind of flying: of turns, straight flight, changing and even speed it "
        "mends some and spoils others, as gusts do against which the controller leans";
  }
  return effect.to_separate.empty() ? sure : fmt::format("{}; {}", sure, effect.to_separate);
}

/// What found parameters would be with an effect freed, where that is beyond their intervals.
std::vector<ParameterEstimate> moved_by(const LogModel& log, const Selection& selection,
                                        const Selection::Open& open) {
  std::vector<ParameterEstimate> moved;
  // Structure without a name moves them by itself.
  if (!selection.unnamed.regressors.empty()) return moved;
  for (const SelectedGroup& found : selection.selected) {
    const auto alone = estimates(log, selection, selection.complete, found.group);
    const auto beside = estimates(log, selection, open.freed, found.group);
    for (std::size_t k = 0; k < alone.size(); ++k) {
      const double value = beside[k].value;
      if (value < alone[k].ci95_lower || value > alone[k].ci95_upper) moved.push_back(beside[k]);
    }
  }
  return moved;
}

/// The found effect that takes the place of this one, if any does.
std::optional<std::size_t> found_in_more_detail(const LogModel& log, const Selection& selection,
                                                std::size_t group) {
  for (const SelectedGroup& found : selection.selected) {
    if (log.problem.groups[found.group].replaces == group) return found.group;
  }
  return std::nullopt;
}

/// One verdict on an effect that is neither found nor indistinguishable from what is.
void tell_open(const LogModel& log, const Selection& selection, const Selection::Open& open,
               Diagnosis& diagnosis) {
  const Effect& effect = log.effect(open.group);
  if (const auto finer = found_in_more_detail(log, selection, open.group)) {
    diagnosis.not_identifiable.push_back(
        {effect.id,
         fmt::format("{}, which is found, tells it in more detail", in_words(log.name(*finer))),
         log.flight_of(open.group)});
    return;
  }
  const std::size_t first = log.first_parameter(open.group);
  std::vector<RuledOut> bounds;
  for (const SizeEstimate& size : open.sizes) {
    const EffectParameter& p = effect.parameters[size.parameter - first];
    const ModelParameter& m = log.problem.groups[open.group].parameters[size.parameter - first];
    if (!(m.lower < m.upper) || !(size.standard_error > 0)) continue;
    if (size.largest_block_share > most_of_one_block) continue;  // has no spread to judge by
    const double student = selection.student_factor[open.group];
    const auto [low, high] = size_interval(size, student);
    const double lower = std::clamp(low, m.lower, m.upper);
    const double upper = std::clamp(high, m.lower, m.upper);
    // An interval beyond a bound allows hardly anything, but no less than the error leaves open.
    const double bound =
        std::max({m.neutral - lower, upper - m.neutral, student * size.standard_error});
    const double widest = std::max(m.neutral - m.lower, m.upper - m.neutral);
    if ((low > m.lower || high < m.upper) && bound < widest) {
      bounds.push_back({effect.id, p.name, bound / p.unit_SI, p.unit, log.flight_of(open.group)});
    }
  }
  if (open.suspected) {
    diagnosis.suspected.push_back(
        {effect.id, effect.title, open.gain_percent, open.gain_se_percent,
         estimates(log, selection, open.freed, open.group),
         what_is_missing(effect, open, selection.least_gain_percent * effect.least_gain_factor),
         log.flight_of(open.group), moved_by(log, selection, open)});
  } else if (bounds.empty()) {
    diagnosis.not_testable.push_back(
        {effect.id, "a log that shows it: " + effect.to_separate, log.flight_of(open.group)});
  } else {
    for (RuledOut& bound : bounds) diagnosis.ruled_out.push_back(std::move(bound));
  }
}

/// Parts of the base model's held-out squared error, which sum to the whole.
ErrorBudget error_budget(const Selection& selection) {
  const double all = selection.base.holdout_rmse * selection.base.holdout_rmse;
  ErrorBudget budget;
  double left = 100;
  for (const SelectedGroup& s : selection.selected) {
    const double share = 100 * (s.rmse_before * s.rmse_before - s.rmse_after * s.rmse_after) / all;
    budget.findings.push_back(share);
    left -= share;
  }
  budget.unexplained = left * selection.unnamed.share_percent / 100;
  budget.noise = left - budget.unexplained;
  return budget;
}

std::vector<double> in_degrees(std::vector<double> angle) {
  for (double& value : angle) value /= unit::degree;
  return angle;
}

/// Central differences; one-sided at the ends.
std::vector<double> rate_of(const std::vector<double>& x, const std::vector<double>& time) {
  std::vector<double> rate(x.size(), 0.0);
  for (std::size_t i = 0; i < x.size() && x.size() > 1; ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t after = std::min(i + 1, x.size() - 1);
    rate[i] = (x[after] - x[before]) / (time[after] - time[before]);
  }
  return rate;
}

std::vector<double> braking(const FlightRecord& record) {
  std::vector<double> out = product(record.forward_speed, in_degrees(record.tilt));
  for (std::size_t i = 0; i < out.size(); ++i) {
    // Signed like the motion, so that a force against it lies on a line.
    const double against = record.forward_speed[i] > 0 ? -out[i] : out[i];
    out[i] = out[i] < 0 ? against : nan;
  }
  return out;
}

[[noreturn]] void unknown(const std::string& id) {
  throw std::invalid_argument("there is no channel \"" + id + "\"");
}

}  // namespace

void LogModel::add(const Effect& effect, const Design& design, bool fitted,
                   std::optional<std::size_t> log) {
  first_.push_back(effects_.empty() ? 0 : first_.back() + effects_.back()->parameters.size());
  effects_.push_back(&effect);
  in_log_.push_back(log);
  ParameterGroup group;
  group.id = effect.id.empty() ? effect.title : effect.id;
  if (log) group.id += fmt::format(" (flight {})", *log + 1);
  group.fitted = fitted;
  group.usual = effect.in_first_look;
  group.numbers = effect.parameters.size();
  group.least_gain_factor = effect.least_gain_factor;
  if (log) group.blocks = logs_[*log].blocks;
  for (const EffectParameter& p : effect.parameters) {
    group.parameters.push_back(in_SI(p, design));
    const Span& span = logs_[log.value_or(0)];
    look_through(p, span.begin, span.end, group.parameters.back());
    group.parameters.back().shape_only = group.parameters.size() > effect.sizes;
    if (!p.product_with.empty()) group.parameters.back().product_with = index_of(p.product_with);
  }
  for (std::size_t g = 0; g < effects_.size(); ++g) {
    if (in_log_[g] != log) continue;
    if (!effect.replaces.empty() && effects_[g]->id == effect.replaces) group.replaces = g;
    if (!effect.twin_of.empty() && effects_[g]->id == effect.twin_of) group.twin_of = g;
  }
  problem.groups.push_back(std::move(group));
}

std::optional<std::size_t> LogModel::index_of(std::string_view parameter) const {
  return index_where(&EffectParameter::name, parameter);
}

std::optional<std::size_t> LogModel::index_of_field(std::string_view spec_field) const {
  return index_where(&EffectParameter::spec_field, spec_field);
}

std::optional<std::size_t> LogModel::index_where(std::string EffectParameter::*member,
                                                 std::string_view text) const {
  for (std::size_t g = 0; g < effects_.size(); ++g) {
    for (std::size_t k = 0; k < effects_[g]->parameters.size(); ++k) {
      if (effects_[g]->parameters[k].*member == text) return first_[g] + k;
    }
  }
  return std::nullopt;
}

bool LogModel::is_neutral(std::size_t group, std::span<const double> values) const {
  const auto sizes =
      own(group, values)
          .first(std::min(effects_[group]->sizes, effects_[group]->parameters.size()));
  return std::equal(sizes.begin(), sizes.end(), problem.groups[group].parameters.begin(),
                    [](double value, const ModelParameter& p) { return value == p.neutral; });
}

LogModel::Span span_of(std::span<const double> time, std::size_t blocks) {
  return time.empty() ? LogModel::Span{} : LogModel::Span{time.front(), time.back(), blocks};
}

void check_base_effects(LogKind kind, std::span<const Effect* const> effects,
                        std::span<const std::string> ids) {
  std::vector<std::string> known, unknown;
  for (const Effect* effect : effects) known.push_back(effect->id);
  for (const std::string& id : ids) {
    if (!contains(known, id)) unknown.push_back(id);
  }
  if (unknown.empty()) return;
  throw std::invalid_argument(fmt::format("no effect of a {} is called {}; there are {}",
                                          kind == LogKind::flight ? "flight" : "power log",
                                          fmt::join(unknown, ", "), fmt::join(known, ", ")));
}

void tell(const LogModel& log, const Selection& selection, Diagnosis& diagnosis) {
  diagnosis.base = {selection.base.holdout_rmse, parameters(log, selection, selection.base)};
  diagnosis.extended = {selection.extended.holdout_rmse,
                        parameters(log, selection, selection.complete)};
  for (const SelectedGroup& found : selection.selected) {
    diagnosis.findings.push_back(finding_of(log, selection, found));
    diagnosis.traces.push_back(trace_of(log, selection, found.group));
  }
  for (const Selection::Aliased& aliased : selection.aliased) {
    // A rival's verdict is that it explains the log as well.
    const auto has_as_rival = [&](const SelectedGroup& found) {
      return contains(found.indistinguishable, aliased.group);
    };
    if (std::ranges::any_of(selection.selected, has_as_rival)) continue;
    diagnosis.not_identifiable.push_back(not_identifiable(log, aliased));
  }
  for (const Selection::Open& open : selection.open) tell_open(log, selection, open, diagnosis);
  std::ranges::stable_sort(diagnosis.suspected, std::ranges::greater{}, &Suspected::gain_percent);
  diagnosis.budget = error_budget(selection);
  const UnnamedStructure& unnamed = selection.unnamed;
  if (unnamed.regressors.empty()) return;
  diagnosis.unexplained.detected = true;
  diagnosis.unexplained.channels = unnamed.channels;
  diagnosis.unexplained.share_percent = unnamed.share_percent;
  const UnnamedRegressor& strongest = log.problem.unnamed[unnamed.regressors.front()];
  diagnosis.unexplained.regressor = strongest.shape;
  diagnosis.unexplained.formula = strongest.formula;
  diagnosis.unexplained.coefficient = strongest.formula_unit * unnamed.coefficients.front();
}

double undetectable_percent(double samples, std::size_t shapes, double false_alarm_probability) {
  const double chance =
      false_alarm_probability / 2 / static_cast<double>(std::max<std::size_t>(shapes, 1));
  const double t = student_quantile(std::max(samples - 2, 1.0), chance);
  return 100 * t * t / (t * t + samples);
}

// --- Channels ---

Channel flight_channel(const std::string& id, const FlightRecord& record) {
  if (id == "forward_speed") return {"forward speed", "m/s", record.forward_speed};
  if (id == "tilt") return {"tilt, leaning forward", "deg", in_degrees(record.tilt)};
  if (id == "tilt_rate") {
    return {"rate of the tilt", "deg/s", in_degrees(rate_of(record.tilt, record.time))};
  }
  if (id == "yaw") return {"yaw", "deg", in_degrees(record.yaw)};
  if (id == "place") return {"place along the mean heading", "m", record.place_along};
  if (id == "height") return {"height", "m", record.height};
  if (id == "time") return {"time of the log", "s", record.time};
  if (id == "braking") {
    return {"forward speed times tilt while they oppose", "m/s·deg", braking(record)};
  }
  if (id == "sinking") {
    return {"forward speed times down speed", "m²/s²",
            product(record.forward_speed, record.down_speed)};
  }
  unknown(id);
}

Channel power_channel(const std::string& id, const PowerLog& log) {
  if (id == "supply_current") return {"supply current", "A", log.supply_current};
  if (id == "current_height") {
    return {"supply current times height", "A·m", product(log.supply_current, log.height)};
  }
  if (id == "bus_power") {
    return {"power at the bus", "W", bus_power_of(log)};
  }
  // Free flight needs no height: thrust then varies with the airspeed alone.
  if (id == "height" && !log.height.empty()) return {"height", "m", log.height};
  if (id == "height") return {"airspeed", "m/s", log.airspeed};
  if (id == "airspeed") return {"airspeed", "m/s", log.airspeed};
  if (id == "time") return {"time of the log", "s", log.time};
  unknown(id);
}

}  // namespace tethercalc
