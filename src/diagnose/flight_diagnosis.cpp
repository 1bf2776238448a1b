#include "tethercalc/diagnose/flight_diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "diagnose/flight_model.hpp"
#include "diagnose/tilt_comparison.hpp"
#include "diagnose/unnamed_shapes.hpp"
#include "identify/statistics.hpp"
#include "model/constants.hpp"
#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/diagnose/hypothesis.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

/// Part of a sampling interval within which the log does not say when a reading was taken, and by
/// which an estimator's own integration step shifts it: a standard deviation, the same for the
/// whole log.
constexpr double time_stamp_uncertainty = 0.05;

constexpr const char* unit_of_flights = "m/s²";
/// What a fit with linear drag and wind tells before the search: good enough for the airspeed in
/// regressors and for what an error of the time stamps does.
struct Preliminary {
  std::vector<double> wind;  ///< of each flight
  /// Change of the prediction by one standard deviation, of each flight.
  std::vector<std::vector<double>> time_stamp_error;
};

/// A delay of the attitude, which shifts the thrust against all else that is logged.
bool delays_attitude(const Effect& effect) {
  return effect.is_delay && effect.flight_phase == FlightPhase::attitude;
}

/// The headwind: of what the first look fits only the air is each flight's own.
bool is_steady_wind(const Effect& effect) {
  return effect.in_first_look && effect.own_in_each_flight;
}

/// Index of the size of the effect, the only one that `is_it`, that acts in the flight.
std::size_t size_in(const FlightModel& model, std::size_t flight, bool (*is_it)(const Effect&)) {
  std::size_t group = 0;
  while (!is_it(model.effect(group)) || model.log_of(group).value_or(flight) != flight) ++group;
  return model.first_parameter(group);
}

Preliminary preliminary_fit(const Design& design, const std::vector<FlightData>& flights) {
  const std::vector<const Effect*> effects = effects_for(LogKind::flight, {});
  std::vector<std::string> fitted;
  for (const Effect* effect : effects) {
    if (effect->in_first_look) fitted.push_back(effect->id);
  }
  const FlightModel model(design, flights, effects, fitted);
  const SelectionProblem& problem = model.problem;
  const std::size_t delay = size_in(model, 0, delays_attitude);
  SelectionOptions nothing;
  nothing.most_findings = 0;
  std::vector<double> values = select_effects(problem, nothing).base.values;

  std::vector<double> late(problem.measured.size());
  std::vector<double> early(problem.measured.size());
  Preliminary result;
  for (std::size_t k = 0; k < flights.size(); ++k) {
    result.wind.push_back(values[size_in(model, k, is_steady_wind)]);
    values[delay] = time_stamp_uncertainty * flights[k].step;
    problem.predict(values, late);
    values[delay] = -values[delay];
    problem.predict(values, early);
    values[delay] = 0;
    std::vector<double>& error = result.time_stamp_error.emplace_back(early.size(), 0.0);
    for (const FlightModel::Readings& readings : model.readings()) {
      if (readings.flight != k) continue;
      const auto rows = model.rows_of(readings, error);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i] = (model.rows_of(readings, late)[i] - model.rows_of(readings, early)[i]) / 2;
      }
    }
  }
  return result;
}

/// Shapes over the rows of all flights: those of the time of each, others of all alike.
std::vector<UnnamedRegressor> shapes_of(const std::vector<FlightData>& flights,
                                        const FlightModel& model, const Preliminary& preliminary) {
  std::vector<UnnamedRegressor> shapes;
  for (const FlightModel::Readings& readings : model.readings()) {
    const std::size_t k = readings.flight;
    for (UnnamedRegressor& own : flight_shapes(flights[k].observations, flights[k].record,
                                               preliminary.wind[k], readings.axis)) {
      const bool of_time = own.channel == "time_s";
      if (of_time && flights.size() > 1) own.shape += fmt::format(" of flight {}", k + 1);
      auto shape = std::find_if(shapes.begin(), shapes.end(), [&](const UnnamedRegressor& s) {
        return !of_time && s.shape == own.shape && s.quantity == own.quantity;
      });
      if (shape == shapes.end()) {
        shape = shapes.insert(shapes.end(), own);
        shape->column.assign(model.problem.measured.size(), 0.0);
      }
      std::copy(own.column.begin(), own.column.end(),
                model.rows_of(readings, shape->column).begin());
    }
  }
  return shapes;
}

/// Names beside each delay that is short against the time between samples its like.
void add_delays_alike(const std::vector<FlightData>& flights, const FlightModel& model,
                      Selection& selection) {
  for (SelectedGroup& found : selection.selected) {
    const std::size_t flight = model.log_of(found.group).value_or(0);
    const double late = selection.complete.values[model.first_parameter(found.group)];
    if (!model.effect(found.group).is_delay || std::abs(late) >= flights[flight].step) continue;
    std::erase_if(selection.open, [&](const Selection::Open& open) {
      const bool is_like = model.effect(open.group).is_delay &&
                           model.log_of(open.group) == model.log_of(found.group);
      if (is_like) found.indistinguishable.push_back(open.group);
      return is_like;
    });
  }
}

void size_up(const FlightModel& model, const Selection& selection, Unexplained& unexplained) {
  if (!unexplained.detected) return;
  unexplained.size = selection.extended.holdout_rmse * std::sqrt(unexplained.share_percent / 100);
  unexplained.size_unit = unit_of_flights;
  unexplained.shape = fmt::format(
      "{} that is left follows {}; no effect of the catalogue does, so it stays unnamed",
      model.problem.unnamed[selection.unnamed.regressors.front()].quantity, unexplained.regressor);
}

/// Of a fit that has no linear drag where the design has some: what the design's own drag leaves of
/// the accelerations, rms, all else as in the fit.
std::optional<double> left_by_linear_drag_of(const Design& design, const FlightModel& model,
                                             const ModelFit& fit) {
  const AirframeDrag& drag = design.drone.drag;
  const auto linear = model.index_of_field(linear_speed_field);
  if (!linear || fit.values[*linear] != 0 || !(drag.linear_speed > 0)) return std::nullopt;
  std::vector<double> values = fit.values;
  values[0] = drag.front_area;
  values[1] = drag.top_area;
  values[*linear] = drag.linear_speed;
  double sum = 0;
  double rows = 0;
  for (std::size_t series = 0; series < model.readings().size(); ++series) {
    for (const double left : model.left_by(series, values)) {
      if (std::isnan(left)) continue;  // left out
      sum += left * left;
      ++rows;
    }
  }
  return std::sqrt(sum / rows);
}

/// What turns the spec into the extended one. The drag stays where the flight tells nothing of its
/// linear part, as one of a single speed does, and is predicted better by it than by the areas
/// alone.
std::vector<SpecChange> spec_changes(const Design& design, const FlightModel& model,
                                     const ModelFit& fit, std::vector<Warning>& notes) {
  const std::optional<double> left = left_by_linear_drag_of(design, model, fit);
  const bool kept = left && *left < fit.holdout_rmse;
  std::vector<SpecChange> out;
  if (kept) {
    notes.push_back(
        {WarningKind::drag_kept,
         fmt::format("the extended spec keeps its drag, with its linear part: it predicts this "
                     "flight better than areas that are fitted without one, {:.3g} against {:.3g} "
                     "m/s²",
                     *left, fit.holdout_rmse)});
  } else {
    out = {{"drone.drag.front_area_m2", fit.values[0]}, {"drone.drag.top_area_m2", fit.values[1]}};
  }
  for (std::size_t g = 0; g < model.effects().size(); ++g) {
    for (std::size_t k = 0; k < model.effect(g).parameters.size(); ++k) {
      const EffectParameter& p = model.effect(g).parameters[k];
      // Also where neutral: the fitted areas belong to a drag law without it.
      if (p.spec_field.empty() || (kept && p.spec_field == linear_speed_field)) continue;
      out.push_back({p.spec_field, fit.values[model.first_parameter(g) + k] / p.unit_SI});
    }
  }
  return out;
}

/// Each block is simulated with the parameters fitted without it.
double speed_rmse(const std::vector<FlightData>& flights, const FlightModel& model,
                  const ModelFit& fit, double window) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < flights.size(); ++k) {
    const FlightData& data = flights[k];
    const FlightRecord& record = data.record;
    for (std::size_t first = 0; first < record.size();) {
      const int block = data.block[first];
      std::size_t last = first + 1;
      while (last < record.size() && data.block[last] == block) ++last;
      if (block >= 0) {
        const FlightRecord part = part_of(record, first, last);
        const auto& values = fit.without_block[static_cast<std::size_t>(block)];
        const std::vector<double> speed =
            simulate_speed(part, model.base(k, values), model.freed(k, values), window,
                           step_tolerance * data.step);
        for (std::size_t i = 0; i < speed.size(); ++i) {
          sum += std::pow(speed[i] - part.forward_speed[i], 2);
        }
        count += speed.size();
      }
      first = last;
    }
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

double effective_samples(const std::vector<FlightData>& flights, const FlightModel& model,
                         const ModelFit& fit) {
  // Of the axes of a flight the mean: their gusts are of one air.
  const auto axes =
      static_cast<double>(model.readings().size()) / static_cast<double>(flights.size());
  double sum = 0;
  for (const FlightModel::Readings& readings : model.readings()) {
    const auto left = model.rows_of(readings, fit.holdout_residual);
    std::vector<double> residuals;
    for (std::size_t i = 0; i < left.size(); ++i) {
      if (flights[readings.flight].block[i] >= 0) residuals.push_back(left[i]);
    }
    sum += effective_sample_size(residuals);
  }
  return sum / axes;
}

ComparedSeries compared(const FlightData& data, const FlightModel& model,
                        const FlightModel::Readings& readings, const Selection& selection) {
  ComparedSeries series{
      readings.axis == Axis::forward ? "forward acceleration" : "acceleration to the right",
      unit_of_flights,
      std::string(to_string(Stage::airframe)),
      data.record.time,
      {readings.acceleration.begin(), readings.acceleration.end()},
      {},
      {}};
  if (model.logs() > 1) series.quantity += fmt::format(" of flight {}", readings.flight + 1);
  const auto base = model.rows_of(readings, selection.base.holdout_residual);
  const auto extended = model.rows_of(readings, selection.extended.holdout_residual);
  for (std::size_t i = 0; i < series.time.size(); ++i) {
    const double used = data.block[i] < 0 ? nan : series.measured[i];
    series.before.push_back(used - base[i]);
    series.after.push_back(used - extended[i]);
  }
  return series;
}

/// Before what is told of one flight of several.
std::string in_flight(const std::vector<FlightData>& flights, std::size_t flight) {
  return flights.size() > 1 ? fmt::format("flight {}: ", flight + 1) : "";
}

/// Which way "ahead" and "right" are in what was found or is suspected, where that is said.
void tell_headings(const std::vector<FlightData>& flights, Diagnosis& d) {
  for (std::size_t k = 0; k < flights.size(); ++k) {
    const auto is_directed = [k](const auto& told) {
      const Effect* effect = find_effect(told.effect);
      return effect != nullptr && (told.flight == 0 || told.flight == k + 1) &&
             std::any_of(
                 effect->parameters.begin(), effect->parameters.end(),
                 [](const EffectParameter& p) { return p.shown == Shown::turning_or_to_the_side; });
    };
    if (std::none_of(d.findings.begin(), d.findings.end(), is_directed) &&
        std::none_of(d.suspected.begin(), d.suspected.end(), is_directed)) {
      continue;
    }
    const double heading = flights[k].record.mean_heading / unit::degree;
    d.notes.push_back(
        {WarningKind::log_mean_heading,
         fmt::format(
             "{}ahead is along the mean heading of the flight, {:.0f}° from north over east; "
             "right is to the right of it",
             in_flight(flights, k), heading < 0 ? heading + 360 : heading)});
  }
}

std::size_t used_samples(const FlightData& data) {
  return static_cast<std::size_t>(
      std::count_if(data.block.begin(), data.block.end(), [](int b) { return b >= 0; }));
}

/// Middle of each block on the clock of its flight, s.
std::vector<double> middles_of_blocks(const std::vector<FlightData>& flights) {
  std::vector<double> middles;
  for (const FlightData& data : flights) {
    std::vector<double> first(data.blocks, nan);
    std::vector<double> last(data.blocks, nan);
    for (std::size_t i = 0; i < data.block.size(); ++i) {
      if (data.block[i] < 0) continue;
      const std::size_t own = static_cast<std::size_t>(data.block[i]) - middles.size();
      if (std::isnan(first[own])) first[own] = data.record.time[i];
      last[own] = data.record.time[i];
    }
    for (std::size_t b = 0; b < data.blocks; ++b) middles.push_back((first[b] + last[b]) / 2);
  }
  return middles;
}

/// What each group of as many samples has in the mean, in rising order.
std::vector<double> means_of_equal_parts(std::vector<double> x) {
  constexpr std::size_t parts = 20;
  std::sort(x.begin(), x.end());
  std::vector<double> means;
  for (std::size_t p = 0; p < parts; ++p) {
    const std::size_t first = p * x.size() / parts;
    const std::size_t last = (p + 1) * x.size() / parts;
    if (first == last) continue;
    double sum = 0;
    for (std::size_t i = first; i < last; ++i) sum += x[i];
    means.push_back(sum / static_cast<double>(last - first));
  }
  return means;
}

DragByTilt drag_by_tilt(const std::vector<FlightData>& flights, const FlightModel& model,
                        const ModelFit& fit) {
  const auto predicted = [&](std::size_t k, std::span<const double> values) {
    FlightPrediction prediction(flights[k].record);
    predict_acceleration(prediction, model.base(k, values), model.freed(k, values));
    return prediction;
  };
  DragByTilt shown;
  std::vector<double> airspeed;
  for (std::size_t k = 0; k < flights.size(); ++k) {
    const FlightPrediction flown = predicted(k, fit.values);
    shown.law = flown.law;
    for (std::size_t i = 0; i < flown.airspeed.size(); ++i) {
      if (flights[k].block[i] >= 0) airspeed.push_back(flown.airspeed[i]);
    }
  }
  shown.airspeed = means_of_equal_parts(std::move(airspeed));
  shown.time = middles_of_blocks(flights);
  const auto over_mass = [&](const AirframeDrag& law) {
    const FlightRecord& record = flights.front().record;
    return drag_over_mass(law, record.mass, record.air_density, record.gravity, shown.airspeed);
  };
  const double whole = over_mass(shown.law);
  const auto blocks = static_cast<double>(fit.without_block.size());
  for (const std::vector<double>& values : fit.without_block) {
    shown.over_mass.push_back(blocks * whole - (blocks - 1) * over_mass(predicted(0, values).law));
  }
  return shown;
}

/// Says what of the effects in the base model the flights do not tell.
void tell_bounds(const FlightModel& model, const ModelFit& base, std::vector<Warning>& notes) {
  for (std::size_t g = 0; g < model.effects().size(); ++g) {
    const Effect& effect = model.effect(g);
    if (effect.id.empty() || !model.problem.groups[g].fitted) continue;
    for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
      const ModelParameter& p = model.problem.groups[g].parameters[k];
      const double value = base.values[model.first_parameter(g) + k];
      const double close = 1e-3 * (p.upper - p.lower);
      const bool inside = p.lower + close < value && value < p.upper - close;
      if (!p.is_free() || std::abs(value - p.neutral) <= close || inside) continue;
      notes.push_back(
          {WarningKind::drag_at_bound,
           fmt::format(
               "in the base model {} of {} is {:g}{}, at the end of its range: these data do "
               "not tell it apart from what else is in the base",
               effect.parameters[k].name, in_words(model.name(g)),
               value / effect.parameters[k].unit_SI,
               effect.parameters[k].unit == "1" ? "" : " " + effect.parameters[k].unit)});
    }
  }
}

/// Where the areas are small beside their errors, the design that they are put into has hardly any
/// drag, which the flight does not say.
void tell_drag_that_may_be_none(const DragByTilt& shown, std::vector<Warning>& notes) {
  const auto [mean, error] = mean_drag_over_mass(shown);
  const auto blocks = static_cast<double>(shown.over_mass.size());
  const double half_width = student_quantile(blocks - 1, 0.975) * error;
  if (mean > half_width) return;
  notes.push_back(
      {WarningKind::drag_may_be_none,
       fmt::format(
           "the flight does not even tell that there is drag: in its mean {:.2g} ± {:.2g} "
           "m/s² of drag over mass (95 %); fly longer, faster and in both directions before "
           "its areas are put into a design",
           mean, half_width)});
}

void report(const Design& design, const std::vector<FlightData>& flights, const FlightModel& model,
            const Selection& selection, const FlightDiagnosisOptions& options,
            const std::vector<const Effect*>& effects, Diagnosis& d) {
  for (const Effect& effect : effect_catalogue(LogKind::power)) {
    if (effect.no_flight_shows_because.empty()) continue;
    d.not_identifiable.push_back({effect.id, effect.no_flight_shows_because});
  }
  tell(model, selection, d);
  tell_headings(flights, d);
  for (const FlightData& flight : flights) d.samples += used_samples(flight);
  d.effective_samples = effective_samples(flights, model, selection.complete);
  d.unexplained.undetectable_percent = undetectable_percent(
      d.effective_samples, model.problem.unnamed.size(), options.selection.false_alarm_probability);
  for (const FlightModel::Readings& readings : model.readings()) {
    d.compared.push_back(compared(flights[readings.flight], model, readings, selection));
  }
  size_up(model, selection, d.unexplained);
  d.spec_changes = spec_changes(design, model, selection.complete, d.notes);
  d.drag_by_tilt = drag_by_tilt(flights, model, selection.complete);
  tell_bounds(model, selection.base, d.notes);
  tell_drag_that_may_be_none(*d.drag_by_tilt, d.notes);
  d.further.push_back(
      {fmt::format("forward speed simulated open-loop over {:g} s windows", options.speed_window),
       "m/s", speed_rmse(flights, model, selection.base, options.speed_window),
       speed_rmse(flights, model, selection.extended, options.speed_window)});
  for (const Effect* effect : effects) {
    if (std::none_of(flights.begin(), flights.end(),
                     [&](const FlightData& f) { return testable(*effect, f.faults); })) {
      d.not_testable.push_back({effect->id, "a down velocity that moves (vd_m_s)"});
    }
  }
}

Diagnosis too_short(const std::vector<FlightData>& flights,
                    const std::vector<const Effect*>& effects) {
  Diagnosis d;
  double usable = 0;
  for (const FlightData& data : flights) {
    d.samples += used_samples(data);
    usable += data.usable;
  }
  d.base.holdout_rmse = nan;
  d.extended.holdout_rmse = d.base.holdout_rmse;
  static_assert(shortest_flight == shortest_block * static_cast<double>(fewest_blocks));
  const std::string needs = fmt::format(
      "a longer flight: {:.0f} s, this one has {:.1f} s that can be used", shortest_flight, usable);
  for (const Effect* effect : effects) {
    d.not_testable.push_back({effect->id, needs});
  }
  d.notes.push_back(
      {WarningKind::log_too_short, fmt::format("too short to tell an effect from chance: {:.1f} s "
                                               "of usable flight, {:.0f} s are needed",
                                               usable, shortest_flight)});
  return d;
}

/// What was done to the logs.
std::vector<Warning> notes_of(const std::vector<FlightData>& flights) {
  std::vector<Warning> notes;
  for (std::size_t k = 0; k < flights.size(); ++k) {
    if (flights.size() > 1) {
      notes.push_back({WarningKind::log_flight_of_several,
                       fmt::format("flight {}: {} samples, {:.0f} s, are used", k + 1,
                                   used_samples(flights[k]), flights[k].usable)});
    }
    for (const auto& [kind, note] : flights[k].faults.notes) {
      notes.push_back({kind, in_flight(flights, k) + note});
    }
  }
  return notes;
}

}  // namespace

Diagnosis diagnose_flights(const Design& design, std::span<const MeasuredFlight> flights,
                           const FlightDiagnosisOptions& options,
                           const SelectionProgress& progress) {
  if (flights.empty()) throw std::invalid_argument("there is no flight to diagnose");
  if (!(design.drone.mass > 0) || !(design.flight.air_density > 0)) {
    throw std::invalid_argument("mass and air density must be positive");
  }
  const std::vector<const Effect*> effects = effects_for(LogKind::flight, options.hypotheses);
  check_base_effects(LogKind::flight, effects, options.base);
  const std::vector<FlightData> read = read_flights(design, flights, options.pitch_offset);

  Diagnosis d;
  const std::size_t blocks =
      std::accumulate(read.begin(), read.end(), std::size_t{0},
                      [](std::size_t sum, const FlightData& f) { return sum + f.blocks; });
  if (blocks < fewest_blocks) {
    d = too_short(read, effects);
  } else {
    FlightModel model(design, read, effects, options.base);
    Preliminary preliminary = preliminary_fit(design, read);
    model.problem.unnamed = shapes_of(read, model, preliminary);
    model.problem.systematic = std::move(preliminary.time_stamp_error);
    Selection selection = select_effects(model.problem, options.selection, progress);
    add_delays_alike(read, model, selection);
    report(design, read, model, selection, options, effects, d);
  }
  d.kind = LogKind::flight;
  d.unit = unit_of_flights;
  const bool aside =
      std::any_of(read.begin(), read.end(), [](const FlightData& f) { return f.record.both_axes; });
  d.quantity = aside ? "forward acceleration and that to the right" : "forward acceleration";
  const std::vector<Warning> notes = notes_of(read);
  d.notes.insert(d.notes.begin(), notes.begin(), notes.end());
  for (std::size_t k = 0; k < read.size(); ++k) {
    if (read[k].faults.level_assumed) {
      d.notes.push_back({WarningKind::log_unchanging,
                         in_flight(read, k) + "the roll never moves; it is taken as logged"});
    }
  }
  return d;
}

Diagnosis diagnose_flight(const Design& design, FlightLog log,
                          const FlightDiagnosisOptions& options,
                          const SelectionProgress& progress) {
  const MeasuredFlight flight{std::move(log), std::nullopt};
  return diagnose_flights(design, {&flight, 1}, options, progress);
}

double judged_time(FlightLog log) {
  Design design;
  design.drone.mass = 1;  // forces over it are compared
  return read_flights(design, std::array{MeasuredFlight{std::move(log), {}}}, 0).front().usable;
}

}  // namespace tethercalc
