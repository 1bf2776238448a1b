#include "diagnose/power_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

namespace tethercalc {
namespace {

struct PowerShape {
  std::string channel;
  std::string words;
  std::function<double(std::size_t)> at;  ///< by sample
};

/// Steps that are tried throughout the log.
constexpr int coarse_steps = 40;

PowerShape step_at(const PowerLog& log, double share) {
  const double at = log.time.front() + share * (log.time.back() - log.time.front());
  return {"time_s", fmt::format("a step at {:.0f} s", at),
          [&log, at](std::size_t i) { return log.time[i] >= at ? 1.0 : 0.0; }};
}

std::vector<PowerShape> shapes_of(const PowerLog& log) {
  const double first = log.time.front();
  const double duration = log.time.back() - first;
  const auto share = [&log, first, duration](std::size_t i) {
    return (log.time[i] - first) / duration;
  };
  std::vector<PowerShape> shapes;

  for (int k = 1; k < coarse_steps; ++k) {
    shapes.push_back(step_at(log, static_cast<double>(k) / coarse_steps));
  }
  shapes.push_back({"time_s", "a steady drift", share});
  for (int k = 1; k <= 8; ++k) {
    for (const bool sine : {false, true}) {
      shapes.push_back({"time_s", fmt::format("a wave of {:.0f} s", duration / k),
                        [share, k, sine](std::size_t i) {
                          const double phase = 2 * std::numbers::pi * k * share(i);
                          return sine ? std::sin(phase) : std::cos(phase);
                        }});
    }
  }

  const auto powers = [&](const char* channel, const char* word, const std::vector<double>& x) {
    if (x.empty()) return;
    const auto [low, high] = std::minmax_element(x.begin(), x.end());
    const double middle = 0.5 * (*low + *high);
    const double half = 0.5 * (*high - *low);
    if (!(half > 0)) return;
    const auto z = [&x, middle, half](std::size_t i) { return (x[i] - middle) / half; };
    shapes.push_back({channel, fmt::format("in proportion to the {}", word), z});
    // A temperature hardly varies: its powers would be constants, which effects with a name are.
    if (&x == &log.ambient_temperature_C) return;
    shapes.push_back({channel, fmt::format("with the square of the {}", word),
                      [&x, high = *high](std::size_t i) { return x[i] * x[i] / (high * high); }});
    shapes.push_back({channel, fmt::format("bent over the {}", word),
                      [z](std::size_t i) { return z(i) * z(i); }});
    shapes.push_back({channel, fmt::format("with the cube of the {}", word),
                      [z](std::size_t i) { return z(i) * z(i) * z(i); }});
  };
  powers("height_m", "height", log.height);
  powers("airspeed_m_s", "airspeed", log.airspeed);
  powers("ambient_temperature_C", "ambient temperature", log.ambient_temperature_C);
  return shapes;
}

const char* stage_words(Stage stage) {
  switch (stage) {
    case Stage::tether:
      return "tether resistance";
    case Stage::converter:
      return "converter input power";
    default:
      return "motor power";
  }
}

const char* stage_unit(Stage stage) {
  switch (stage) {
    case Stage::tether:
      return "ohm";
    case Stage::converter:
      return "W";
    default:
      return "%";
  }
}

/// `shape` in stage `k` as rows.
UnnamedRegressor regressor(const PowerResiduals& residuals, std::size_t k,
                           const PowerShape& shape) {
  const PowerStage& stage = residuals.stages()[k];
  std::vector<double> column(residuals.samples());
  for (std::size_t i = 0; i < column.size(); ++i) {
    column[i] =
        shape.at(i) * (stage.stage == Stage::tether ? residuals.log().supply_current[i] : 1.0);
  }
  UnnamedRegressor result{
      shape.channel, fmt::format("{}: {}", stage_words(stage.stage), shape.words),
      std::vector<double>(residuals.rows(), 0),
      stage.noise * (stage.stage == Stage::motors ? 100 : 1), stage_unit(stage.stage)};
  residuals.whitened(k, column, std::span(result.column).subspan(stage.first_row, stage.rows));
  return result;
}

/// Shapes of every stage that come first in the list of regressors: the coarse steps.
std::size_t shapes_per_stage(const PowerResiduals& residuals) {
  return shapes_of(residuals.log()).size();
}

}  // namespace

std::vector<UnnamedRegressor> power_shapes(const PowerResiduals& residuals) {
  std::vector<UnnamedRegressor> regressors;
  for (std::size_t k = 0; k < residuals.stages().size(); ++k) {
    for (const PowerShape& shape : shapes_of(residuals.log())) {
      regressors.push_back(regressor(residuals, k, shape));
    }
  }
  return regressors;
}

bool add_finer_steps(const PowerResiduals& residuals, const std::vector<std::size_t>& found,
                     std::vector<UnnamedRegressor>& shapes) {
  const std::size_t per_stage = shapes_per_stage(residuals);
  bool added = false;
  for (const std::size_t u : found) {
    const std::size_t k = u / per_stage;
    const std::size_t step = u % per_stage;
    if (step + 1 >= coarse_steps) continue;
    const PowerStage& stage = residuals.stages()[k];
    // At most 64 between the neighbours on either side: one every few rows in a long log.
    const double finest = 1.0 / static_cast<double>(stage.rows);
    const double spacing = std::max(finest, 2.0 / coarse_steps / 64);
    const double middle = static_cast<double>(step + 1) / coarse_steps;
    for (double at = middle - 1.0 / coarse_steps + spacing; at < middle + 1.0 / coarse_steps;
         at += spacing) {
      shapes.push_back(regressor(residuals, k, step_at(residuals.log(), at)));
    }
    added = true;
  }
  return added;
}

}  // namespace tethercalc
