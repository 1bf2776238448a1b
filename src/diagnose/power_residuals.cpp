#include "diagnose/power_residuals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "identify/linear_algebra.hpp"
#include "identify/statistics.hpp"

namespace tethercalc {
namespace {

/// Standard deviation of normal noise with few outliers, from the median absolute value.
double robust_deviation(const std::vector<double>& x, const std::vector<char>& usable) {
  std::vector<double> size;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (usable[i]) size.push_back(std::abs(x[i]));
  }
  return mad_to_sigma * median(std::move(size));
}

/// Third differences of samples i … i+3, scaled to keep the variance of white noise; slow signals
/// vanish in them.
double third_difference(const std::vector<double>& x, std::size_t i) {
  return (x[i + 3] - 3 * x[i + 2] + 3 * x[i + 1] - x[i]) / std::sqrt(20.0);
}

/// Covariance of the noise and of all that is as fast in two channels, over usable samples.
double fast_covariance(const std::vector<double>& a, const std::vector<double>& b,
                       const std::vector<char>& usable) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i + 3 < a.size(); ++i) {
    const auto four = std::span(usable).subspan(i, 4);
    if (std::count(four.begin(), four.end(), char{1}) < 4) continue;
    sum += third_difference(a, i) * third_difference(b, i);
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

double square(double x) { return x * x; }

/// Of the usable and finite values; 0 of none.
double mean_of(const std::vector<double>& x, const std::vector<char>& usable) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!usable[i] || !std::isfinite(x[i])) continue;
    sum += x[i];
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

/// Input power in W per W of output. The curve is piecewise smooth: a difference over 1 W is its
/// slope wherever it matters.
double input_slope(const Converter& converter, double output) {
  return converter_input_power(converter, output + 0.5) -
         converter_input_power(converter, output - 0.5);
}

/// Height with its noise averaged out where the drone keeps it: over 81 samples, wherever both
/// halves of them have the same mean within noise. Elsewhere as read. Without this a model in which
/// height does not matter would seem to explain more, since it is spared the altimeter's noise.
std::vector<double> steadied(const std::vector<double>& x) {
  constexpr std::size_t half = 40;
  const std::size_t n = x.size();
  if (n < 2 * half + 1) return x;
  std::vector<double> step(n - 1);
  for (std::size_t i = 1; i < n; ++i) step[i - 1] = std::abs(x[i] - x[i - 1]);
  const double noise = mad_to_sigma * median(step) / std::sqrt(2.0);
  std::vector<double> sum(n + 1, 0);
  std::partial_sum(x.begin(), x.end(), sum.begin() + 1);
  const double limit = 3 * noise * std::sqrt(2.0 / half);
  std::vector<double> result = x;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t middle = std::clamp(i, half, n - half - 1);
    const double before = (sum[middle] - sum[middle - half]) / half;
    const double after = (sum[middle + half + 1] - sum[middle + 1]) / half;
    const double mean = (sum[middle + half + 1] - sum[middle - half]) / (2 * half + 1);
    if (std::abs(after - before) <= limit && std::abs(x[i] - mean) <= 5 * noise) result[i] = mean;
  }
  return result;
}

/// Smooth shapes that any of the effects, named or not, may leave in a stage: slow waves in time
/// together with low powers of height and airspeed; for the tether multiplied with the current, for
/// the converter joined by its load.
MatrixXd smooth_shapes(const PowerLog& log, Stage stage, const std::vector<double>& bus_power) {
  constexpr int waves = 6;
  const auto n = static_cast<Index>(log.time.size());
  std::vector<VectorXd> columns;
  Series height = Series::Zero(n);  // of a free flight it may be unknown
  if (!log.height.empty()) height = as_series(log.height) / 10;
  const Series speed = as_series(log.airspeed) / 5;
  const Series elapsed = as_series(log.time) - log.time.front();
  for (const Series& x : std::initializer_list<Series>{Series::Ones(n), height, height.square(),
                                                       speed, speed.square(), speed.cube(),
                                                       height * speed, height * speed.square()}) {
    columns.emplace_back(x.matrix());
  }
  for (int k = 1; k <= waves; ++k) {
    const Series wave = (std::numbers::pi * k * elapsed / elapsed[n - 1]).cos();
    columns.emplace_back(wave.matrix());
    if (stage == Stage::tether) columns.emplace_back((wave * height).matrix());
  }
  if (stage == Stage::tether) {
    for (VectorXd& column : columns) column.array() *= as_series(log.supply_current);
  }
  if (stage == Stage::converter) {
    columns.emplace_back((as_series(bus_power) / 300).matrix());
    columns.emplace_back((as_series(bus_power) / 300).square().matrix());
  }
  MatrixXd shapes(n, static_cast<Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c) {
    shapes.col(static_cast<Index>(c)) = columns[c];
  }
  return shapes;
}

/// The usable values, 0 in place of the others.
VectorXd usable_part(const std::vector<double>& x, const std::vector<char>& usable) {
  VectorXd part(static_cast<Index>(x.size()));
  std::transform(x.begin(), x.end(), usable.begin(), part.begin(),
                 [](double value, char ok) { return ok ? value : 0.0; });
  return part;
}

/// What `shapes` leave of `x` by least squares over usable rows; 0 in the others.
std::vector<double> without_shapes(const MatrixXd& shapes, const std::vector<double>& x,
                                   const std::vector<char>& usable) {
  const VectorXd target = usable_part(x, usable);
  MatrixXd used = shapes;
  for (Index i = 0; i < shapes.rows(); ++i) {
    if (!usable[static_cast<std::size_t>(i)]) used.row(i).setZero();
  }
  // Heights or airspeeds that never change make columns equal: the decomposition must bear that.
  const VectorXd rest =
      target - used * pseudo_solution(gram_matrix(used), inner_products_with(used, target));
  return {rest.begin(), rest.end()};
}

/// Autoregression by Levinson and Durbin's recursion; its order has the least BIC (Schwarz 1978).
struct Autoregression {
  std::vector<double> memory;
  double innovation = 1;  ///< standard deviation of the white part over that of `x`
  double criterion = 0;   ///< BIC, less that of white noise
};

/// Of `x`, which is 0 where it is not usable; `samples` of it are.
Autoregression autoregression(const VectorXd& x, double samples) {
  const Index orders = std::min<Index>(20, x.size() / 20);
  // Without a division by the number of pairs the sequence stays positive definite.
  VectorXd covariance(orders + 1);
  for (Index lag = 0; lag <= orders; ++lag) {
    covariance[lag] = x.head(x.size() - lag).dot(x.tail(x.size() - lag));
  }
  Autoregression best;
  if (!(covariance[0] > 0)) return best;
  covariance /= covariance[0];
  VectorXd phi;
  double variance = 1;
  for (Index order = 1; order <= orders; ++order) {
    const double reflected =
        (covariance[order] - phi.dot(covariance.segment(1, order - 1).reverse())) / variance;
    VectorXd next = VectorXd::Constant(order, reflected);
    next.head(order - 1) = phi - reflected * phi.reverse();
    phi = std::move(next);
    variance *= 1 - reflected * reflected;
    if (!(variance > 0)) break;
    const double criterion =
        samples * std::log(variance) + static_cast<double>(order) * std::log(samples);
    if (criterion < best.criterion) {
      best = {{phi.begin(), phi.end()}, std::sqrt(variance), criterion};
    }
  }
  return best;
}

/// `x` less the wave in it that has most of its squares, with `half_turns` at most over all of it;
/// 0 where it is not usable.
VectorXd without_strongest_wave(const VectorXd& x, const std::vector<char>& usable,
                                int half_turns) {
  VectorXd best = x;
  MatrixXd wave(x.size(), 2);
  for (int k = 2; k <= half_turns; ++k) {
    const double turn = std::numbers::pi * k / static_cast<double>(x.size());
    for (Index i = 0; i < x.size(); ++i) {
      const double used = usable[static_cast<std::size_t>(i)] ? 1 : 0;
      wave.row(i) << used * std::cos(turn * static_cast<double>(i)),
          used * std::sin(turn * static_cast<double>(i));
    }
    VectorXd rest = left_by(wave, x);
    if (rest.squaredNorm() < best.squaredNorm()) best = std::move(rest);
  }
  return best;
}

struct Noise {
  VectorXd values;  ///< 0 where they are not usable
  Autoregression memory;
};

/// Noise alone, and not a load that comes and goes, which an autoregression follows as well: waves
/// are left out of `x` for as long as what is left has the lesser BIC, each counted with its size,
/// its phase and its period, one of so many.
Noise noise_in(VectorXd x, const std::vector<char>& usable, double samples) {
  constexpr int most_waves = 3;
  const int half_turns = std::min(most_half_turns, static_cast<int>(samples / 2));
  const double price = 3 * std::log(samples) + 2 * std::log(std::max(1, half_turns));
  Noise noise{std::move(x), {}};
  noise.memory = autoregression(noise.values, samples);
  for (int waves = 0; waves < most_waves; ++waves) {
    Noise less{without_strongest_wave(noise.values, usable, half_turns), {}};
    const double all = noise.values.squaredNorm();
    if (!(all > 0) || !(less.values.squaredNorm() > 0)) break;
    less.memory = autoregression(less.values, samples);
    const double gained = noise.memory.criterion - less.memory.criterion -
                          samples * std::log(less.values.squaredNorm() / all);
    if (!(gained > price)) break;
    noise = std::move(less);
  }
  return noise;
}

/// Airspeed noise must be averaged before the memory of the motors' noise is taken out: that takes
/// the slow part of the airspeed out too, and what is left of it would drown in its noise and
/// attenuate every drag. 8 s is twice the memory seen in flight, and short against a change of
/// airspeed.
constexpr double motor_averaging = 8;  // s

void set_usable_rows(PowerStage& stage) {
  stage.usable_rows.assign(stage.rows, 0);
  for (std::size_t row = 0; row < stage.rows; ++row) {
    const auto samples =
        std::span(stage.usable).subspan(row * stage.samples_per_row, stage.samples_per_row);
    const auto usable = std::count(samples.begin(), samples.end(), char{1});
    stage.usable_rows[row] = 2 * static_cast<std::size_t>(usable) >= stage.samples_per_row;
  }
}

std::vector<double> row_means(const PowerStage& stage, std::span<const double> samples) {
  std::vector<double> means(stage.rows, 0);
  for (std::size_t row = 0; row < stage.rows; ++row) {
    std::size_t count = 0;
    for (std::size_t j = 0; j < stage.samples_per_row; ++j) {
      const std::size_t i = row * stage.samples_per_row + j;
      if (!stage.usable[i]) continue;
      means[row] += samples[i];
      ++count;
    }
    if (count > 0) means[row] /= static_cast<double>(count);
  }
  return means;
}

/// Standard deviation of the usable values after a fit of so many parameters; 0 of none.
double deviation_of(const VectorXd& usable_values, double count, double parameters) {
  return count > 0 ? std::sqrt(usable_values.squaredNorm() / std::max(1.0, count - parameters)) : 0;
}

double count_of(const std::vector<char>& usable) {
  return static_cast<double>(std::count(usable.begin(), usable.end(), char{1}));
}

/// Standard deviation and memory of the stage's noise, from what a fit with `parameters` left.
void set_noise(std::vector<double> noise, double parameters, PowerStage& stage) {
  stage.noise = deviation_of(usable_part(noise, stage.usable), count_of(stage.usable), parameters);
  if (!(stage.noise > 0) || !std::isfinite(stage.noise)) stage.noise = 1;
  for (double& x : noise) x /= stage.noise;
  set_usable_rows(stage);
  const VectorXd averaged = usable_part(row_means(stage, noise), stage.usable_rows);
  const double rows = count_of(stage.usable_rows);
  const auto [values, fitted] = noise_in(averaged, stage.usable_rows, rows);
  stage.memory = fitted.memory;
  // The parameters took as many degrees of freedom from the means as from the samples.
  stage.innovation = fitted.innovation * deviation_of(values, rows, parameters);
  if (!(stage.innovation > 0)) stage.innovation = 1;
}

}  // namespace

PowerResiduals::PowerResiduals(const PowerModel& base, ScreenedPowerLog screened)
    : screened_(std::move(screened)) {
  const PowerLog& log = screened_.log;
  const std::size_t n = log.time.size();
  bus_power_ = bus_power_of(log);
  for (const double power : bus_power_) log_bus_power_.push_back(std::log(std::max(power, 1e-3)));

  screened_.log.height = steadied(log.height);

  for (PowerStage s :
       {PowerStage{Stage::tether, "voltage lost in the tether", "V", "tether resistance", "ohm"},
        {Stage::converter, "power at the converter's input", "W", "converter input power", "W"},
        {Stage::motors, "power at the motors' bus", "%", "motor power", "%"}}) {
    const auto usable = screened_.usable.find(s.stage);
    if (usable == screened_.usable.end()) continue;
    s.usable = usable->second;
    if (s.stage == Stage::motors) {
      const double interval = (log.time.back() - log.time.front()) / static_cast<double>(n - 1);
      s.samples_per_row = std::max<std::size_t>(
          1, static_cast<std::size_t>(std::lround(motor_averaging / interval)));
    }
    s.first_row = rows_;
    s.rows = n / s.samples_per_row;
    rows_ += s.rows;
    stages_.push_back(std::move(s));
  }
  estimate_reading_noise(base);
  for (std::size_t k = 0; k < stages_.size(); ++k) estimate_noise(base, stages_[k], k);
}

void PowerResiduals::estimate_reading_noise(const PowerModel& base) {
  const auto of_line = std::find_if(stages_.begin(), stages_.end(),
                                    [](const PowerStage& s) { return s.stage != Stage::motors; });
  if (of_line == stages_.end()) return;
  const std::vector<char>& usable = of_line->usable;
  const PowerLog& log = screened_.log;
  const auto fast = [&](const auto& a, const auto& b) { return fast_covariance(a, b, usable); };
  readings_.mean_voltage = mean_of(log.drone_voltage, usable);
  readings_.mean_current = mean_of(log.supply_current, usable);
  if (!log.supply_voltage.empty()) {
    const double of_supply = std::max(0.0, fast(log.supply_voltage, log.drone_voltage));
    readings_.supply_voltage =
        std::max(0.0, fast(log.supply_voltage, log.supply_voltage) - of_supply);
  }
  std::vector<double> lost(log.drone_voltage);
  for (std::size_t i = 0; i < lost.size(); ++i) {
    lost[i] = (log.supply_voltage.empty() ? 0 : log.supply_voltage[i]) - log.drone_voltage[i];
  }
  const double resistance =
      mean_of(loop_resistance(base, without_errors(log, base.instruments), memory_), usable);
  const double all_current = fast(log.supply_current, log.supply_current);
  const double all_lost = fast(lost, lost) - readings_.supply_voltage;
  // A current that changes is seen in the voltage lost on the way, its noise is not.
  const double true_current =
      resistance > 0 ? std::clamp(fast(log.supply_current, lost) / resistance, 0.0, all_current)
                     : all_current;
  constexpr double least = 1e-12;  // V² and A², of a log without noise
  readings_.supply_current = std::max(least, all_current - true_current);
  readings_.drone_voltage = std::max(least, all_lost - square(resistance) * true_current);
  // Over an ohm it hardly tells; the power at the converter's input has all of it. With the larger
  // one the line would be judged too mildly where heights drift, and a contact be told for a
  // voltmeter.
  const auto of_converter = std::ranges::find(stages_, Stage::converter, &PowerStage::stage);
  if (of_converter != stages_.end()) {
    const auto [total, output_share, slope] = converter_noise(base, of_converter->usable);
    output_variance_ = output_share / square(slope);
    input_variance_ = 1 - output_share;
    readings_.current_at_converter = std::max(
        least,
        (total * input_variance_ - readings_.drone_voltage * square(readings_.mean_current)) /
            square(readings_.mean_voltage));
  }
  lost_voltage_variance_ = lost_voltage_variance(base.instruments, resistance);
  input_power_variance_ = input_power_variance(base.instruments);
}

PowerResiduals::ConverterNoise PowerResiduals::converter_noise(
    const PowerModel& base, const std::vector<char>& usable) const {
  // Input and output share the true power and have noise of their own, so the covariance of their
  // fast changes holds the former and what exceeds it the latter.
  const PowerLog& log = screened_.log;
  const std::vector<double> input = product(log.drone_voltage, log.supply_current);
  std::vector<double> slopes(samples());
  std::transform(bus_power_.begin(), bus_power_.end(), slopes.begin(), [&base](double power) {
    return input_slope(base.design.supply.converter, power);
  });
  const double slope = mean_of(slopes, usable);
  const double out = slope * slope * fast_covariance(bus_power_, bus_power_, usable);
  const double both = slope * fast_covariance(input, bus_power_, usable);
  const double total = fast_covariance(input, input, usable) + out - 2 * both;
  if (!(total > 0) || !(slope > 0)) return {};
  return {total, std::clamp((out - both) / total, 0.02, 0.98), slope};
}

double PowerResiduals::lost_voltage_variance(const PowerInstruments& instruments,
                                             double resistance) const {
  return readings_.supply_voltage / square(instruments.supply_voltage_gain) +
         readings_.drone_voltage +
         readings_.supply_current * square(resistance / instruments.supply_current_gain);
}

double PowerResiduals::input_power_variance(const PowerInstruments& instruments) const {
  const double gain = instruments.supply_current_gain;
  const double current = (readings_.mean_current - instruments.supply_current_offset) / gain;
  const double voltage = readings_.mean_voltage - instruments.drone_voltage_offset;
  return readings_.drone_voltage * square(current) +
         readings_.current_at_converter * square(voltage / gain);
}

void PowerResiduals::estimate_noise(const PowerModel& base, PowerStage& stage, std::size_t k) {
  const PowerLog& log = screened_.log;
  const std::size_t n = log.time.size();
  std::vector<double> raw(n);
  standardised(k, base, raw);
  for (std::size_t i = 0; i < n; ++i) {
    if (!std::isfinite(raw[i])) stage.usable[i] = 0;
  }
  const MatrixXd shapes = smooth_shapes(log, stage.stage, bus_power_);
  std::vector<double> noise = without_shapes(shapes, raw, stage.usable);
  // Spikes that the channels alone do not show; after them the shapes fit better. What no shape
  // follows and lasts, as about the moment of a leap, is none.
  for (int pass = 0; pass < 2; ++pass) {
    constexpr double outlying = 5;
    constexpr std::size_t half = 7;
    const double most = outlying * robust_deviation(noise, stage.usable);
    const std::vector<double> alone = distance_from_neighbours(noise, half);
    for (std::size_t i = 0; i < n; ++i) {
      if (std::min(std::abs(noise[i]), alone[i]) > most) stage.usable[i] = 0;
    }
    noise = without_shapes(shapes, raw, stage.usable);
  }
  set_noise(std::move(noise), static_cast<double>(shapes.cols()), stage);
}

void PowerResiduals::refine_noise(std::size_t k, const PowerModel& model) {
  PowerStage& stage = stages_[k];
  stage.noise = 1;
  std::vector<double> noise(samples());
  standardised(k, model, noise);
  set_noise(std::move(noise), 0, stage);
}

void PowerResiduals::standardised(std::size_t k, const PowerModel& model,
                                  std::span<double> out) const {
  const PowerStage& stage = stages_[k];
  const PowerInstruments& instruments = model.instruments;
  std::optional<PowerLog> corrected;
  if (instruments != PowerInstruments{}) corrected = without_errors(screened_.log, instruments);
  const PowerLog& log = corrected ? *corrected : screened_.log;
  if (stage.stage == Stage::tether) {
    const std::vector<double> resistance = loop_resistance(model, log, memory_);
    const double noise =
        stage.noise *
        std::sqrt(lost_voltage_variance(instruments, mean_of(resistance, stage.usable)) /
                  lost_voltage_variance_);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double lost = log.supply_voltage[i] - log.drone_voltage[i];
      out[i] = (lost - log.supply_current[i] * resistance[i]) / noise;
    }
  } else if (stage.stage == Stage::converter) {
    const double input_variance =
        input_variance_ * input_power_variance(instruments) / input_power_variance_;
    const double out_gain = instruments.bus_current_gain;
    const Converter& converter = model.design.supply.converter;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double input = log.drone_voltage[i] * log.supply_current[i];
      const double output = bus_power_[i] / out_gain;
      const double slope = input_slope(converter, output);
      const double variance =
          input_variance + slope * slope * output_variance_ / (out_gain * out_gain);
      out[i] =
          (input - model.design.drone.auxiliary_power - converter_input_power(converter, output)) /
          (std::sqrt(variance) * stage.noise);
    }
  } else {
    const std::vector<double> power = motor_power(model, log, memory_.loads);
    const double gain = std::log(instruments.bus_current_gain);
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i] = (log_bus_power_[i] - gain - std::log(power[i])) / stage.noise;
    }
  }
}

std::vector<double> PowerResiduals::predicted_share_of_input(const PowerModel& model) const {
  const PowerLog log = without_errors(screened_.log, model.instruments);
  std::vector<double> share = motor_power(model, log, memory_.loads);
  for (std::size_t i = 0; i < share.size(); ++i) {
    const double predicted = model.design.drone.auxiliary_power +
                             converter_input_power(model.design.supply.converter, share[i]);
    share[i] = predicted / (log.drone_voltage[i] * log.supply_current[i]);
  }
  return share;
}

void PowerResiduals::whitened(std::size_t k, std::span<const double> standardised,
                              std::span<double> out) const {
  const PowerStage& stage = stages_[k];
  const std::size_t order = stage.memory.size();
  // Unusable rows are bridged by the last usable one: good enough to predict the next from.
  std::vector<double> bridged = row_means(stage, standardised);
  for (std::size_t i = 1; i < stage.rows; ++i) {
    if (!stage.usable_rows[i]) bridged[i] = bridged[i - 1];
  }
  for (std::size_t i = 0; i < stage.rows; ++i) {
    out[i] = 0;
    if (!stage.usable_rows[i] || i < order) continue;
    double predicted = 0;
    for (std::size_t j = 0; j < order; ++j) predicted += stage.memory[j] * bridged[i - 1 - j];
    out[i] = (bridged[i] - predicted) / stage.innovation;
  }
}

}  // namespace tethercalc
