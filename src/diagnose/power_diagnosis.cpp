#include "tethercalc/diagnose/power_diagnosis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "diagnose/log_model.hpp"
#include "diagnose/power_residuals.hpp"
#include "diagnose/tilt_comparison.hpp"
#include "diagnose/unnamed_shapes.hpp"
#include "identify/statistics.hpp"
#include "model/constants.hpp"
#include "tethercalc/diagnose/hypothesis.hpp"
#include "tethercalc/identify/observations.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

/// Stretches of the log that are left out one at a time. Long against the seconds that the motors'
/// deviation lasts, short against the minutes at one height.
constexpr double shortest_power_block = 30;  // s
constexpr std::size_t most_power_blocks = 24;
/// A tenth of a log of the shortest length at 1 Hz would be too few to estimate noise from.
constexpr std::ptrdiff_t fewest_power_samples = 100;
/// Of a false name in the whole catalogue, were the noise known exactly. Its memory is estimated
/// from some 200 rows, which makes the tails heavier; measured rates stand in
/// docs/diagnosis-power.md.
constexpr double chance_of_a_false_alarm = 0.002;
/// Percent. Half of what a flight has to gain: instruments of a chain that is electrical throughout
/// lack less of a model than a flight does.
constexpr double least_gain_of_a_name = 1;

void check_lengths(const PowerLog& log) {
  for (const PowerChannel& channel : power_channels) {
    const std::size_t size = (log.*channel.values).size();
    if (size != log.time.size() && !(channel.optional && size == 0)) {
      throw std::invalid_argument("the channels of a power log must be equally long");
    }
  }
}

/// What the effect needs and the log or the design lacks, "" where nothing.
std::string lacking(const Effect& effect, const Design& design, const PowerLog& log) {
  const bool in_the_air = std::all_of(effect.shows_in.begin(), effect.shows_in.end(), [](Stage s) {
    return s == Stage::motors || s == Stage::airframe;
  });
  if (log.free_flight && (effect.of_tether || !in_the_air)) return "a flight on the tether";
  std::string of_design = effect.lacking_in ? effect.lacking_in(design) : "";
  if (!of_design.empty()) return of_design;
  const bool has_bus = !bus_power_of(log).empty();
  std::vector<std::string_view> names;
  for (const PowerChannel& channel : power_channels) {
    const bool of_bus =
        channel.values == &PowerLog::bus_voltage || channel.values == &PowerLog::bus_current;
    const bool missing = (log.*channel.values).empty() && !(of_bus && has_bus);
    if (missing && contains(effect.needs, channel.name)) names.push_back(channel.name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Throws where the log can show no part of the chain.
void check_stages(const PowerLog& log) {
  const bool has_stage = is_measured(Stage::tether, log) || is_measured(Stage::converter, log) ||
                         is_measured(Stage::motors, log);
  check_flies_free(log);
  if (has_stage) return;
  const auto of = [&](Stage stage) {
    return fmt::format("{}", fmt::join(channels_needed({stage}, log.free_flight), ", "));
  };
  throw std::invalid_argument(
      (log.free_flight
           ? fmt::format("nothing of the motors was measured: a free flight needs {}",
                         of(Stage::motors))
           : fmt::format("no part of the chain was measured whole; the motors need {}; the "
                         "converter {}; the tether {}",
                         of(Stage::motors), of(Stage::converter), of(Stage::tether))) +
      "; bus_power_W will do for bus_voltage_V and bus_current_A");
}

/// Of each sample. Blocks are equal stretches of measured time.
std::vector<std::size_t> blocks_of_samples(const PowerLog& log) {
  const std::vector<double> since = time_without_gaps(log);
  const double duration = since.back();
  const std::size_t blocks = std::clamp(static_cast<std::size_t>(duration / shortest_power_block),
                                        fewest_blocks, most_power_blocks);
  std::vector<std::size_t> out;
  for (const double time : since) {
    const double share = time / duration * static_cast<double>(blocks);
    out.push_back(std::min(blocks - 1, static_cast<std::size_t>(share)));
  }
  return out;
}

/// Takes away the stages that too few healthy stretches are left of, with what each would need.
std::map<Stage, std::string> drop_unusable_stages(ScreenedPowerLog& screened) {
  std::map<Stage, std::string> dropped;
  const std::vector<std::size_t> block = blocks_of_samples(screened.log);
  std::erase_if(screened.usable, [&](const auto& found) {
    const auto& [stage, usable] = found;
    std::set<std::size_t> blocks;
    for (std::size_t i = 0; i < usable.size(); ++i) {
      if (usable[i]) blocks.insert(block[i]);
    }
    const auto healthy = std::count(usable.begin(), usable.end(), char{1});
    if (blocks.size() >= fewest_blocks && healthy >= fewest_power_samples) return false;
    dropped[stage] = fmt::format("instruments that work for longer: of {} samples {} are healthy",
                                 usable.size(), healthy);
    return true;
  });
  return dropped;
}

/// What was taken for granted where the log does not say.
void note_assumptions(const Design& design, const PowerLog& log, std::vector<Warning>& notes) {
  if (log.free_flight) {
    notes.push_back(
        {WarningKind::log_free_flight,
         fmt::format("flown free: without tether, converter and reserve battery; the auxiliary "
                     "power of the spec ({:g} W) comes out of the same battery",
                     design.drone.auxiliary_power)});
  } else if (log.ambient_temperature_C.empty() && is_measured(Stage::tether, log)) {
    notes.push_back(
        {WarningKind::log_ambient_missing,
         fmt::format(
             "ambient_temperature_C is missing: the cable is taken to be at the spec's {:g} "
             "°C before it heats, so its resistivity may stand for the weather",
             flight_state_at(design, 0, 0).ambient_temperature_C)});
  }
  for (const auto& [name, values] :
       {std::pair{"height_m", &log.height}, std::pair{"airspeed_m_s", &log.airspeed}}) {
    if (!values->empty() && std::all_of(values->begin(), values->end(), [first = values](double x) {
          return x == first->front();
        })) {
      notes.push_back({WarningKind::log_unchanging,
                       fmt::format("{} never changes in this log: taken as it is", name)});
    }
  }
}

bool acts_on(const Effect& effect, Stage compared) { return contains(effect.shows_in, compared); }

/// What the stage compares, as its instruments show it.
std::vector<double> measured_in(const PowerStage& stage, const PowerLog& log) {
  if (stage.stage == Stage::converter) return product(log.drone_voltage, log.supply_current);
  if (stage.stage == Stage::motors) return bus_power_of(log);
  std::vector<double> lost(log.supply_voltage);
  for (std::size_t i = 0; i < lost.size(); ++i) lost[i] -= log.drone_voltage[i];
  return lost;
}

/// What the model predicts where the residual over the noise is `standardised`. The motors'
/// residual is one of logarithms.
std::vector<double> predicted_in(const PowerStage& stage, const std::vector<double>& measured,
                                 std::span<const double> standardised) {
  std::vector<double> out(measured);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double residual = stage.noise * standardised[i];
    out[i] =
        stage.stage == Stage::motors ? measured[i] * std::exp(-residual) : measured[i] - residual;
  }
  return out;
}

/// The search's view of a log: rows of all stages, their memory taken out, and those of the tilt
/// behind them.
class PowerLogModel : public LogModel {
 public:
  PowerLogModel(const PowerModel& base, const PowerResiduals& residuals,
                const std::optional<TiltComparison>& tilt,
                const std::vector<const Effect*>& effects,
                const std::vector<std::string>& base_effects)
      : LogModel({span_of(residuals.log().time)}),
        base_(base),
        residuals_(residuals),
        tilt_(tilt),
        cache_(residuals.stages().size() + 1) {
    for (const Effect* effect : effects) {
      add(*effect, base.design, contains(base_effects, effect->id));
    }
    problem.predict = [this](std::span<const double> values, std::span<double> out) {
      predict(values, out);
    };
    problem.left_of_readings = [this](std::span<const double> values) {
      return left_of_readings(values);
    };
  }

  /// The base model with every effect that is not neutral, or those that act on one comparison.
  [[nodiscard]] PowerModel model(std::span<const double> values,
                                 std::optional<Stage> compared = {}) const {
    PowerModel changed = base_;
    for (std::size_t g = 0; g < effects().size(); ++g) {
      const bool wanted = !compared || acts_on(effect(g), *compared);
      if (wanted && !is_neutral(g, values)) effect(g).on_power(changed, own(g, values));
    }
    return changed;
  }

  [[nodiscard]] const PowerResiduals& residuals() const { return residuals_; }
  [[nodiscard]] const std::optional<TiltComparison>& tilt() const { return tilt_; }
  [[nodiscard]] std::size_t rows() const { return residuals_.rows() + (tilt_ ? tilt_->rows() : 0); }

  /// After the residuals' noise has changed.
  void forget() { cache_.assign(cache_.size(), {}); }

  [[nodiscard]] std::size_t series(std::size_t group) const override {
    std::size_t stage = 0;
    while (!acts_on(effect(group), residuals_.stages()[stage].stage)) ++stage;
    return stage;
  }
  [[nodiscard]] Channel channel(std::size_t group) const override {
    return power_channel(effect(group).channel, residuals_.log());
  }
  [[nodiscard]] std::vector<double> left_by(std::size_t k,
                                            std::span<const double> values) const override {
    const PowerStage& stage = residuals_.stages()[k];
    std::vector<double> r(residuals_.samples());
    residuals_.standardised(k, model(values), r);
    const std::vector<double> measured = measured_in(stage, residuals_.log());
    std::vector<double> left = predicted_in(stage, measured, r);
    for (std::size_t i = 0; i < left.size(); ++i) {
      left[i] = stage.usable[i] ? measured[i] - left[i] : nan;
    }
    return left;
  }

 private:
  /// Of each stage's usable samples, over their noise.
  [[nodiscard]] std::vector<double> left_of_readings(std::span<const double> values) const {
    std::vector<double> left;
    std::vector<double> standardised(residuals_.samples());
    for (std::size_t k = 0; k < residuals_.stages().size(); ++k) {
      const PowerStage& stage = residuals_.stages()[k];
      residuals_.standardised(k, model(values, stage.stage), standardised);
      double sum = 0;
      for (std::size_t i = 0; i < standardised.size(); ++i) {
        if (stage.usable[i] && std::isfinite(standardised[i])) {
          sum += standardised[i] * standardised[i];
        }
      }
      left.push_back(std::sqrt(sum));
    }
    return left;
  }

  /// Minus the whitened residual of every row. A stage whose effects have the values of the last
  /// call is not computed again: slopes move one parameter at a time.
  void predict(std::span<const double> values, std::span<double> out) {
    std::vector<double> standardised(residuals_.samples());
    for (std::size_t k = 0; k < residuals_.stages().size(); ++k) {
      const PowerStage& compared = residuals_.stages()[k];
      const auto whitened = [&](std::span<double> rows) {
        residuals_.standardised(k, model(values, compared.stage), standardised);
        residuals_.whitened(k, standardised, rows);
      };
      predict_stage(compared.stage, values, cache_[k], whitened,
                    out.subspan(compared.first_row, compared.rows));
    }
    if (!tilt_) return;
    const auto whitened = [&](std::span<double> rows) {
      tilt_->whitened(model(values, Stage::airframe), rows);
    };
    predict_stage(Stage::airframe, values, cache_.back(), whitened, out.last(tilt_->rows()));
  }

  struct Cached {
    std::vector<double> key;
    std::vector<double> rows;
  };
  template <typename Whitened>
  void predict_stage(Stage stage, std::span<const double> values, Cached& last,
                     const Whitened& whitened, std::span<double> out) const {
    std::vector<double> key;
    for (std::size_t g = 0; g < effects().size(); ++g) {
      if (!acts_on(effect(g), stage)) continue;
      const auto of_group = own(g, values);
      key.insert(key.end(), of_group.begin(), of_group.end());
    }
    if (last.rows.empty() || last.key != key) {
      last.key = std::move(key);
      last.rows.resize(out.size());
      whitened(last.rows);
      // A tilt beyond the limit has no power: far off, but finite.
      for (double& r : last.rows) {
        if (!std::isfinite(r)) r = 1e3;
      }
    }
    std::transform(last.rows.begin(), last.rows.end(), out.begin(), std::negate<>());
  }

  const PowerModel& base_;
  const PowerResiduals& residuals_;
  const std::optional<TiltComparison>& tilt_;
  std::vector<Cached> cache_;  ///< one a stage, the tilt's last
};

/// Block of every row; −1 for rows that are not used.
std::vector<int> blocks_of(const PowerResiduals& residuals) {
  const std::vector<std::size_t> of_sample = blocks_of_samples(residuals.log());
  std::vector<int> block;
  block.reserve(residuals.rows());
  for (const PowerStage& stage : residuals.stages()) {
    for (std::size_t row = 0; row < stage.rows; ++row) {
      const bool used = stage.usable_rows[row] && row >= stage.memory.size();
      block.push_back(used ? static_cast<int>(of_sample[row * stage.samples_per_row]) : -1);
    }
  }
  return block;
}

/// The same with the tilt's rows, which are spread evenly: they are stretches of the same flight,
/// in their order.
std::vector<int> blocks_of(const PowerLogModel& view) {
  std::vector<int> block = blocks_of(view.residuals());
  if (!view.tilt()) return block;
  std::set<int> used(block.begin(), block.end());
  used.erase(-1);
  const std::vector<int> in_order(used.begin(), used.end());
  const std::size_t rows = view.tilt()->rows();
  for (std::size_t i = 0; i < rows; ++i) block.push_back(in_order[i * in_order.size() / rows]);
  return block;
}

/// Takes away the stages of which too few stretches are left once their outliers are, with what
/// each would need. True where there was one.
bool drop_scattered_stages(const PowerResiduals& residuals, ScreenedPowerLog& screened,
                           std::map<Stage, std::string>& dropped) {
  const std::vector<int> blocks = blocks_of(residuals);
  bool any = false;
  for (const PowerStage& stage : residuals.stages()) {
    const auto begin = blocks.begin() + static_cast<std::ptrdiff_t>(stage.first_row);
    std::set<int> used(begin, begin + static_cast<std::ptrdiff_t>(stage.rows));
    used.erase(-1);
    if (used.size() >= fewest_blocks) continue;
    dropped[stage.stage] = fmt::format(
        "a longer flight: without its outliers only {} of {} stretches of this one are left",
        used.size(), std::set<int>(blocks.begin(), blocks.end()).size());
    screened.usable.erase(stage.stage);
    any = true;
  }
  return any;
}

/// The part of the rows that is of the motors and the tilt.
double share_in_the_air(const PowerLogModel& view) {
  double on_the_line = 0;
  for (const PowerStage& stage : view.residuals().stages()) {
    if (stage.stage != Stage::motors) on_the_line += static_cast<double>(stage.rows);
  }
  return 1 - on_the_line / static_cast<double>(view.rows());
}

/// Gusts, and what of speeding up no log tells, take power that no steady flight has, however long
/// the log: 0.2 % of it in the mean of simulated flights, which two standard deviations are to
/// hold. The change of the rows by one of them.
std::vector<double> unsteady_power(const PowerLogModel& view) {
  constexpr double relative = 0.001;
  const PowerResiduals& residuals = view.residuals();
  std::vector<double> change(view.rows(), 0);
  for (std::size_t k = 0; k < residuals.stages().size(); ++k) {
    const PowerStage& stage = residuals.stages()[k];
    if (stage.stage != Stage::motors) continue;
    const std::vector<double> samples(residuals.samples(), relative / stage.noise);
    residuals.whitened(k, samples, std::span(change).subspan(stage.first_row, stage.rows));
  }
  return change;
}

/// The search with the residuals' present noise.
Selection search(PowerLogModel& view, const SelectionProgress& progress) {
  const PowerResiduals& residuals = view.residuals();
  SelectionProblem& problem = view.problem;
  problem.measured.assign(view.rows(), 0);
  problem.noise.assign(view.rows(), 1);
  problem.block = blocks_of(view);
  problem.systematic = {unsteady_power(view)};
  const auto behind_stages = [&] {  // no shape of a stage is in the tilt
    for (UnnamedRegressor& shape : problem.unnamed) shape.column.resize(view.rows(), 0);
  };
  problem.unnamed = power_shapes(residuals);
  behind_stages();
  SelectionOptions options;
  options.false_alarm_probability = chance_of_a_false_alarm;
  options.least_gain_percent = least_gain_of_a_name;
  // Few rows tell of the airframe: what they gain is not to drown in those of the line.
  if (view.tilt()) options.least_gain_percent *= share_in_the_air(view);
  Selection selection = select_subset(problem, options, progress);
  // A step must stand where it happened, or names are sought for the stretch between.
  if (add_finer_steps(residuals, selection.unnamed.regressors, problem.unnamed)) {
    behind_stages();
    selection = select_subset(problem, options, progress);
  }
  return selection;
}

/// The motors' noise lasts for seconds, and few rows tell how long. Takes it from what the model
/// that was found leaves, provided that no unnamed structure is in it. False where it stays.
bool refine_noise(PowerResiduals& residuals, const PowerModel& found,
                  const SelectionProblem& problem, const Selection& selection) {
  for (std::size_t k = 0; k < residuals.stages().size(); ++k) {
    const PowerStage& stage = residuals.stages()[k];
    if (stage.stage != Stage::motors) continue;
    for (const std::size_t u : selection.unnamed.regressors) {
      const auto rows = std::span(problem.unnamed[u].column).subspan(stage.first_row, stage.rows);
      if (std::any_of(rows.begin(), rows.end(), [](double x) { return x != 0; })) return false;
    }
    residuals.refine_noise(k, found);
    return true;
  }
  return false;
}

/// Held-out residuals of a stage over its noise: every sample's by the fit without its block. NaN
/// in samples that are left out.
std::vector<double> held_out(const PowerResiduals& residuals, std::size_t k, const ModelFit& fit,
                             const PowerLogModel& view) {
  const std::size_t n = residuals.samples();
  const PowerStage& stage = residuals.stages()[k];
  std::vector<double> all(n, nan);
  std::vector<double> r(n);
  const std::vector<std::size_t> of_sample = blocks_of_samples(residuals.log());
  std::set<int> blocks(view.problem.block.begin(), view.problem.block.end());
  blocks.erase(-1);
  for (auto without = fit.without_block.begin(); const int block : blocks) {
    residuals.standardised(k, view.model(*without++), r);
    for (std::size_t i = 0; i < n; ++i) {
      const bool in_block = static_cast<int>(of_sample[i]) == block;
      if (stage.usable[i] && in_block && std::isfinite(r[i])) all[i] = r[i];
    }
  }
  return all;
}

/// Root mean square of held-out residuals in the stage's own unit, its noise's memory included.
double stage_rmse(const PowerStage& stage, std::span<const double> held_out) {
  double sum = 0;
  std::size_t count = 0;
  for (const double r : held_out) {
    if (!std::isfinite(r)) continue;
    sum += r * r;
    ++count;
  }
  const double percent = stage.stage == Stage::motors ? 100 : 1;
  return count > 0 ? percent * stage.noise * std::sqrt(sum / static_cast<double>(count)) : 0;
}

/// The effects that the log can show; the others go to `diagnosis.not_testable`.
std::vector<const Effect*> testable_effects(const Design& design, const PowerLog& log,
                                            const std::map<Stage, std::string>& unusable,
                                            const std::vector<const Effect*>& candidates,
                                            Diagnosis& diagnosis) {
  std::vector<const Effect*> effects;
  for (const Effect* effect : candidates) {
    std::string needs = lacking(*effect, design, log);
    for (const auto& [stage, reason] : unusable) {
      if (needs.empty() && acts_on(*effect, stage)) needs = reason;
    }
    if (needs.empty()) {
      effects.push_back(effect);
    } else {
      diagnosis.not_testable.push_back({effect->id, needs});
    }
  }
  return effects;
}

/// The effects as they act where the tether is solved.
std::vector<Effect> of_solved_tether(const Tether& tether, const PowerResiduals& residuals,
                                     const std::vector<const Effect*>& effects) {
  const bool loss_shows_length =
      hangs_on_winch(tether) &&
      std::ranges::count(residuals.stages(), Stage::tether, &PowerStage::stage) > 0;
  std::vector<Effect> out;
  for (const Effect* effect : effects) {
    out.push_back(*effect);
    Effect& solved = out.back();
    solved.twin_of.clear();
    if (solved.bends_tether && loss_shows_length) solved.shows_in.push_back(Stage::tether);
  }
  return out;
}

/// True where nothing can be judged from a log this short, which is then told.
bool too_short(const PowerLog& log, const std::vector<const Effect*>& candidates,
               Diagnosis& diagnosis) {
  const double duration = log.time.empty() ? 0 : time_without_gaps(log).back();
  if (duration >= shortest_power_log && log.time.size() >= fewest_power_samples) return false;
  const std::string needs =
      fmt::format("a log of at least {:.0f} s with 100 samples, this one has {:.0f} s and {}",
                  shortest_power_log, duration, log.time.size());
  for (const Effect* effect : candidates) {
    diagnosis.not_testable.push_back({effect->id, needs});
  }
  diagnosis.notes.push_back({WarningKind::log_too_short, "the log is too short to judge"});
  return true;
}

void size_up(const LogModel& view, const Selection& selection, Unexplained& told) {
  if (!told.detected) return;
  const UnnamedRegressor& strongest = view.problem.unnamed[selection.unnamed.regressors.front()];
  const double size = strongest.size * selection.unnamed.coefficients.front();
  told.size = std::abs(size);
  told.size_unit = strongest.unit;
  // The cable's resistance follows the height, and an error of that which lasts is no noise.
  const bool as_misread = strongest.channel == "height_m" && strongest.unit == "ohm";
  told.shape = fmt::format(
      "{}, by {} {}; no effect of the catalogue does, so it stays unnamed{}", strongest.shape,
      told.size < 99.5 ? fmt::format("{:+.2g}", size) : fmt::format("{:+.0f}", size),
      strongest.unit,
      as_misread ? "; a height that is misread for a minute at a time leaves the same" : "");
}

/// Mean predicted over mean measured, of the samples that are predicted.
double mean_ratio(std::span<const double> predicted, std::span<const double> measured) {
  double of_predicted = 0;
  double of_measured = 0;
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    if (!std::isfinite(predicted[i])) continue;
    of_predicted += predicted[i];
    of_measured += measured[i];
  }
  return of_predicted / of_measured;
}

/// Measured and predicted, before and after, of every stage in its own unit.
void compare_stages(const PowerResiduals& residuals, const PowerLogModel& view,
                    const Selection& selection, Diagnosis& diagnosis) {
  for (std::size_t k = 0; k < residuals.stages().size(); ++k) {
    const PowerStage& stage = residuals.stages()[k];
    const std::vector<double> before = held_out(residuals, k, selection.base, view);
    const std::vector<double> after = held_out(residuals, k, selection.extended, view);
    const std::vector<double> measured = measured_in(stage, residuals.log());
    std::vector<double> predicted = predicted_in(stage, measured, before);
    std::vector<double> with_findings = predicted_in(stage, measured, after);
    diagnosis.further.push_back({stage.quantity, stage.unit, stage_rmse(stage, before),
                                 stage_rmse(stage, after), mean_ratio(predicted, measured),
                                 mean_ratio(with_findings, measured)});
    diagnosis.compared.push_back({stage.quantity, stage.stage == Stage::tether ? "V" : "W",
                                  std::string(to_string(stage.stage)), residuals.log().time,
                                  measured, std::move(predicted), std::move(with_findings)});
  }
}

/// The same of the tilt: what its blocks show, held against the fits without them.
void compare_tilt(const PowerLogModel& view, const Selection& selection, Diagnosis& diagnosis) {
  const TiltComparison& tilt = *view.tilt();
  const DragByTilt& shown = tilt.shown();
  const auto of_tilt = std::span(view.problem.block).last(tilt.rows());
  std::set<int> blocks(view.problem.block.begin(), view.problem.block.end());
  blocks.erase(-1);
  const auto held_out = [&](const ModelFit& fit) {
    std::vector<double> of_block;
    for (const auto& without : fit.without_block) {
      of_block.push_back(tilt.predicted(view.model(without)));
    }
    std::vector<double> predicted;
    for (const int block : of_tilt) {
      const auto place = std::distance(blocks.begin(), blocks.find(block));
      predicted.push_back(of_block[static_cast<std::size_t>(place)]);
    }
    return predicted;
  };
  const auto rms = [&](const std::vector<double>& predicted) {
    double sum = 0;
    for (std::size_t i = 0; i < predicted.size(); ++i) {
      sum += std::pow(shown.over_mass[i] - predicted[i], 2);
    }
    return std::sqrt(sum / static_cast<double>(predicted.size()));
  };
  const std::vector<double> before = held_out(selection.base);
  const std::vector<double> after = held_out(selection.extended);
  diagnosis.quantity += std::string(", ") + TiltComparison::quantity;
  diagnosis.further.push_back(
      {TiltComparison::quantity, TiltComparison::unit, rms(before), rms(after)});
  diagnosis.compared.push_back({TiltComparison::quantity, TiltComparison::unit,
                                std::string(to_string(Stage::airframe)), shown.time,
                                shown.over_mass, before, after});
}

/// Gives `base`, whose drag nobody measured, the drag that the tilt of the same flight shows, where
/// it shows any. Held against that the tilt would only say what it was taken for.
void take_drag_of_tilt(const DragByTilt& shown, const PowerLog& log, double false_alarm_probability,
                       PowerModel& base, Diagnosis& diagnosis) {
  const auto tilt = TiltComparison::of(shown, base, log, false_alarm_probability, diagnosis.notes);
  if (!tilt) return;
  base.design.drone.drag = tilt->drag_of(base);
  diagnosis.drag_by_tilt = shown;
  const Drone& drone = base.design.drone;
  diagnosis.notes.push_back(
      {WarningKind::tilt_drag_taken,
       fmt::format("the spec's drag is an estimate: the power is judged with the drag that the "
                   "tilt shows of a drone of {:.0f} g, a front area of {:.5f} m², a top area of "
                   "{:.5f} m² and {:.2f} m/s of linear drag, so the tilt does not say whether the "
                   "drone is heavier or its motors are hungrier",
                   drone.mass / unit::gram, drone.drag.front_area, drone.drag.top_area,
                   drone.drag.linear_speed)});
}

/// What the tilt says in words, and what a verdict by it rests on.
void tell_tilt(const TiltComparison& tilt, const PowerModel& base, const PowerModel& found,
               const Drone& extended, Diagnosis& diagnosis) {
  diagnosis.notes.push_back(
      {WarningKind::tilt_drag_shown,
       fmt::format(
           "the tilt shows a drag over mass of {:.3f} ± {:.3f} {}; the spec comes to {:.3f}, with "
           "the "
           "findings to {:.3f}. A heavier drone leans less and draws more, hungrier motors lean as "
           "before. That rests on the spec's drag: where it was guessed, weigh the drone",
           tilt.mean(), tilt.half_width(), TiltComparison::unit, tilt.predicted(base),
           tilt.predicted(found))});
  diagnosis.notes.push_back(
      {WarningKind::tilt_drag_taken,
       fmt::format("of a drone of {:.0f} g this tilt makes a front area of {:.5f} m², a top area "
                   "of {:.5f} m² "
                   "and {:.2f} m/s of linear drag: the drag of the extended spec",
                   extended.mass / unit::gram, extended.drag.front_area, extended.drag.top_area,
                   extended.drag.linear_speed)});
  for (Suspected& suspected : diagnosis.suspected) {
    const Effect* effect = find_effect(suspected.effect);
    if (effect == nullptr || !acts_on(*effect, Stage::airframe)) continue;
    suspected.missing +=
        "; and a drag of the spec that was measured, since the tilt is held "
        "against it";
  }
}

/// Where nothing was measured behind the converter's input, how far the model is off there, by
/// whichever of its parts.
void tell_power_of_drone(const PowerResiduals& residuals, const PowerModel& found,
                         Diagnosis& diagnosis) {
  const std::span<const PowerStage> stages = residuals.stages();
  if (stages.size() != 1 || stages.front().stage != Stage::tether) return;
  if (found.design.drone.drag.is_estimate) return;
  constexpr double least = 0.02;  // flights are seldom as steady, nor masses weighed as exactly
  constexpr double least_t = 3;
  const std::vector<double> share = residuals.predicted_share_of_input(found);
  const std::vector<std::size_t> blocks = blocks_of_samples(residuals.log());
  std::vector<double> of_block(most_power_blocks, 0);
  std::vector<double> samples(most_power_blocks, 0);
  for (std::size_t i = 0; i < share.size(); ++i) {
    // On the ground a drone draws next to nothing, or idles.
    if (!stages.front().usable[i] || !(share[i] > 0.3 && share[i] < 3)) continue;
    of_block[blocks[i]] -= std::log(share[i]);
    samples[blocks[i]] += 1;
  }
  std::vector<double> means;
  for (std::size_t block = 0; block < of_block.size(); ++block) {
    if (samples[block] > 0) means.push_back(of_block[block] / samples[block]);
  }
  if (means.size() < 2) return;
  const MeanOfStretches mean = mean_of_stretches(means);
  const double off = std::expm1(mean.value);
  const double unsure = found.design.drone.motor.uncertainty().value_or(0);
  if (!(std::abs(off) > std::max(least, unsure) && std::abs(mean.value) > least_t * mean.error)) {
    return;
  }
  diagnosis.notes.push_back(
      {WarningKind::log_power_untold,
       fmt::format(
           "the drone is read to draw {:.1f} % {} than the spec with what was found comes to; "
           "only power measured at the bus tells of what, and the optimum does not know of it",
           100 * std::abs(off), off > 0 ? "more" : "less")});
}

/// In words, of the stages that are measured.
std::string compared_quantities(const PowerLog& log) {
  std::vector<std::string> words;
  for (const auto& [stage, quantity] : {std::pair{Stage::tether, "voltage lost in the tether"},
                                        {Stage::converter, "converter input"},
                                        {Stage::motors, "motor power"}}) {
    if (is_measured(stage, log)) words.emplace_back(quantity);
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace

std::vector<double> time_without_gaps(const PowerLog& log) {
  std::vector<double> since(log.time.size(), 0);
  if (since.size() < 2) return since;
  const double gap = std::max(shortest_power_block, shortest_gap(log.time));
  for (std::size_t i = 1; i < since.size(); ++i) {
    const double step = log.time[i] - log.time[i - 1];
    since[i] = since[i - 1] + (step < gap ? step : 0);
  }
  return since;
}

PowerDiagnosis diagnose_power(const Design& design, const PowerLog& log,
                              std::span<const std::string> base_effects,
                              const SelectionProgress& progress, std::span<const Effect> hypotheses,
                              const std::optional<DragByTilt>& shown_by_tilt) {
  check_lengths(log);
  check_stages(log);
  if (!design.tether.cross_section && !log.free_flight) {
    throw std::invalid_argument(
        "a power log needs the cross-section of the cable that flew (tether.cross_section_mm2), "
        "unless the drone flew free (--free-flight)");
  }
  const std::vector<const Effect*> candidates = effects_for(LogKind::power, hypotheses);
  check_base_effects(LogKind::power, candidates, base_effects);

  PowerDiagnosis result{{}, design};
  Diagnosis& diagnosis = result.diagnosis;
  diagnosis.kind = LogKind::power;
  diagnosis.unit = "standard deviations of the noise";
  diagnosis.quantity = compared_quantities(log);
  diagnosis.samples = log.time.size();
  diagnosis.base.holdout_rmse = nan;
  diagnosis.extended.holdout_rmse = nan;
  if (too_short(log, candidates, diagnosis)) return result;
  check_power_units(design, log);

  if (progress) progress("screening the instruments");
  PowerModel base{design};
  const double tilt_alarm = chance_of_a_false_alarm / static_cast<double>(candidates.size());
  if (shown_by_tilt && design.drone.drag.is_estimate) {
    take_drag_of_tilt(*shown_by_tilt, log, tilt_alarm, base, diagnosis);
  }
  ScreenedPowerLog screened = screen_power_log(base, log);
  std::map<Stage, std::string> unusable = drop_unusable_stages(screened);
  average_fast_samples(screened);
  diagnosis.notes.insert(diagnosis.notes.end(), screened.notes.begin(), screened.notes.end());
  note_assumptions(design, log, diagnosis.notes);
  PowerResiduals residuals(base, screened);
  if (drop_scattered_stages(residuals, screened, unusable)) {
    residuals = PowerResiduals(base, std::move(screened));
  }
  std::vector<const Effect*> effects =
      testable_effects(design, residuals.log(), unusable, candidates, diagnosis);
  if (residuals.stages().empty()) return result;
  std::vector<Effect> of_solved;
  if (design.tether.model == TetherModel::solved) {
    of_solved = of_solved_tether(design.tether, residuals, effects);
    std::transform(of_solved.begin(), of_solved.end(), effects.begin(),
                   [](const Effect& e) { return &e; });
  }

  std::optional<TiltComparison> tilt;
  if (shown_by_tilt && !design.drone.drag.is_estimate) {
    tilt = TiltComparison::of(*shown_by_tilt, base, residuals.log(),
                              chance_of_a_false_alarm / static_cast<double>(effects.size()),
                              diagnosis.notes);
  }
  PowerLogModel view(base, residuals, tilt, effects, {base_effects.begin(), base_effects.end()});
  Selection selection = search(view, progress);
  if (refine_noise(residuals, view.model(selection.extended.values), view.problem, selection)) {
    view.forget();
    selection = search(view, progress);
  }

  tell(view, selection, diagnosis);
  // Rows are whitened: each counts.
  diagnosis.effective_samples =
      std::round(static_cast<double>(selection.rows - (tilt ? tilt->rows() : 0)) /
                 static_cast<double>(residuals.stages().size()));
  diagnosis.unexplained.undetectable_percent = undetectable_percent(
      diagnosis.effective_samples, view.problem.unnamed.size(), chance_of_a_false_alarm);
  size_up(view, selection, diagnosis.unexplained);
  compare_stages(residuals, view, selection, diagnosis);
  if (tilt) compare_tilt(view, selection, diagnosis);
  const PowerModel found = view.model(selection.extended.values);
  tell_power_of_drone(residuals, found, diagnosis);
  result.extended = found.design;
  if (tilt) {
    diagnosis.drag_by_tilt = tilt->shown();
    result.extended.drone.drag = tilt->drag_of(found);
    tell_tilt(*tilt, base, found, result.extended.drone, diagnosis);
  }
  // What the payload draws less than nothing is another's error; a spec cannot hold it.
  result.extended.drone.auxiliary_power = std::max(0.0, result.extended.drone.auxiliary_power);
  return result;
}

}  // namespace tethercalc
