#include "tethercalc/report/result_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "model/constants.hpp"
#include "report/figure_data.hpp"
#include "report/figure_ticks.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc {
namespace {

constexpr std::size_t most_samples = 700;

plot::Curve outline_curve(std::span<const double> time, std::span<const double> values,
                          plot::Colour colour, plot::Dash dash, const std::string& words = "") {
  plot::Series drawn = plot::outline(time, values);
  return {.x = std::move(drawn.x),
          .y = std::move(drawn.y),
          .colour = colour,
          .dash = dash,
          .width = 0.8,
          .words = words};
}

double root_mean_square(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / double(values.size()));
}

/// Drag at one sample as figures show it.
struct DragSample {
  double airspeed = 0;  ///< m/s
  double tilt = 0;      ///< deg
  double measured = 0;  ///< N
  double fitted = 0;    ///< N
  double residual = 0;  ///< N, measured less fitted
};

std::vector<DragSample> samples_of(const DragIdentification& drag) {
  std::vector<DragSample> out;
  for (const DragAtSample& at : drag_at_samples(drag.fit, drag.flights)) {
    out.push_back(
        {at.airspeed, at.tilt / unit::degree, at.measured, at.fitted, at.measured - at.fitted});
  }
  return out;
}

std::vector<DragSample> thinned(const std::vector<DragSample>& all, std::size_t step) {
  std::vector<DragSample> out;
  for (std::size_t i = 0; i < all.size(); i += step) out.push_back(all[i]);
  return out;
}

/// Steady flight at one airspeed, negative backwards.
struct SteadyPoint {
  double airspeed = 0;  ///< m/s
  double tilt = 0;      ///< deg
  double force = 0;     ///< N
  double lower = 0;     ///< N, of its 95 % interval
  double upper = 0;     ///< N
};

/// Steady flight in both directions, over `range` in m/s.
std::vector<SteadyPoint> steady_line(const DragFit& fit, plot::Range range) {
  std::vector<SteadyPoint> out;
  constexpr int steps = 60;
  for (int i = 0; i <= steps; ++i) {
    const double airspeed = range.lo + (range.hi - range.lo) * i / steps;
    const auto steady = steady_drag(fit, std::abs(airspeed));
    if (!steady) continue;
    // The law is odd in the airspeed.
    const Estimate& force = steady->force;
    const double tilt = steady->tilt.value / unit::degree;
    if (airspeed < 0) {
      out.push_back({airspeed, -tilt, -force.value, -force.upper, -force.lower});
    } else {
      out.push_back({airspeed, tilt, force.value, force.lower, force.upper});
    }
  }
  return out;
}

std::string parameter_words(const DragFit& fit) {
  return fmt::format("front area {} m², top area {} m², linear term {} m/s",
                     significant(fit.front_area().estimate.value, 3),
                     significant(fit.top_area().estimate.value, 3),
                     significant(fit.linear_speed().estimate.value, 3));
}

/// How many values the frame leaves out, where it does.
std::string outside_words(std::span<const double> values, plot::Range range) {
  const auto outside = std::ranges::count_if(
      values, [range](double value) { return value < range.lo || value > range.hi; });
  return outside == 0 ? "" : fmt::format("{} sample{} outside", outside, outside == 1 ? "" : "s");
}

std::string samples_words(std::size_t step) {
  if (step == 1) return "";
  const std::size_t last = step % 10;
  const bool teen = step / 10 % 10 == 1;
  const char* ending = teen ? "th" : last == 1 ? "st" : last == 2 ? "nd" : last == 3 ? "rd" : "th";
  return fmt::format(" (every {}{})", step, ending);
}

/// Those of the samples as points over the airspeed.
plot::Points over_airspeed(const std::vector<DragSample>& samples, double DragSample::*member,
                           plot::Mark mark, plot::Colour colour, const std::string& words) {
  return {.x = plot::column(samples, &DragSample::airspeed),
          .y = plot::column(samples, member),
          .mark = mark,
          .colour = colour,
          .words = words};
}

plot::Curve steady_curve(const std::vector<SteadyPoint>& steady, double SteadyPoint::*member,
                         const std::string& words) {
  return {.x = plot::column(steady, &SteadyPoint::airspeed),
          .y = plot::column(steady, member),
          .width = 1.5,
          .words = words};
}

/// What the fitted drag is over airspeed and tilt.
class DragSurface {
 public:
  DragSurface(const DragFit& fit, plot::Range airspeeds, plot::Range tilts)
      : fit_(fit), airspeeds_(airspeeds), tilts_(tilts) {}

  /// Lines of equal drag at round numbers of newtons.
  [[nodiscard]] std::vector<plot::Layer> contours() const {
    plot::Range forces =
        plot::extent(std::array{force(airspeeds_.lo, tilts_.lo), force(airspeeds_.lo, tilts_.hi),
                                force(airspeeds_.hi, tilts_.lo), force(airspeeds_.hi, tilts_.hi)});
    std::vector<plot::Layer> out;
    for (const plot::Tick& level : plot::round_ticks(forces, 9, plot::Minus::typographic)) {
      plot::Curve line = contour(level.at);
      const auto shown = std::ranges::count_if(line.x, [](double x) { return std::isfinite(x); });
      if (shown < 2) continue;
      line.label = level.words + " N";
      line.words = out.empty() ? "fitted drag" : "";
      out.push_back(std::move(line));
    }
    return out;
  }

 private:
  [[nodiscard]] double force(double airspeed, double tilt) const {
    return airframe_drag_force(fit_.drag(), fit_.conditions.air_density, airspeed,
                               std::tan(tilt * unit::degree));
  }

  /// At each tilt, drag rises with the airspeed.
  [[nodiscard]] plot::Curve contour(double level) const {
    plot::Curve out{.colour = plot::Colour::grey, .width = 0.8};
    constexpr int steps = 60;
    for (int i = 0; i <= steps; ++i) {
      const double tilt = tilts_.lo + (tilts_.hi - tilts_.lo) * i / steps;
      auto [lo, hi] = airspeeds_;
      const bool reached = force(lo, tilt) <= level && level <= force(hi, tilt);
      constexpr int halvings = 40;
      for (int k = 0; k < halvings; ++k) {
        const double middle = (lo + hi) / 2;
        (force(middle, tilt) < level ? lo : hi) = middle;
      }
      out.x.push_back(reached ? lo : nan);
      out.y.push_back(tilt);
    }
    return out;
  }

  const DragFit& fit_;
  plot::Range airspeeds_;
  plot::Range tilts_;
};

/// The samples that the fit leaves something of, either more or less than it; the area of a mark
/// goes with how much.
plot::Points left_over(const std::vector<DragSample>& samples, bool more, double most,
                       const std::string& words) {
  plot::Points out{.mark = more ? plot::Mark::dot : plot::Mark::circle,
                   .colour = more ? plot::Colour::blue : plot::Colour::vermilion,
                   .words = words};
  for (const DragSample& sample : samples) {
    if ((sample.residual > 0) != more) continue;
    out.x.push_back(sample.airspeed);
    out.y.push_back(sample.tilt);
    out.sizes.push_back(1.2 * std::sqrt(std::min(1.0, std::abs(sample.residual) / most)));
  }
  return out;
}

}  // namespace

Figure log_figure(const std::string& name, const Observations& flight) {
  Figure figure{.id = "log", .title = "Accelerations of " + name, .heading = name};
  const std::vector<double> drag = forward_drag_over_mass(flight);
  const plot::Range drags = plot::extent(drag);
  const plot::Range speeds = plot::extent(flight.forward_speed);
  figure.description = fmt::format(
      "Three diagrams over {} s of flight, {} samples: forward acceleration expected from the "
      "attitude and observed; drag per mass, their difference, {} m/s² root mean square and at "
      "most {} m/s²; and forward speed, from {} to {} m/s.",
      fixed(flight.time.back() - flight.time.front(), 0), flight.size(),
      fixed(root_mean_square(drag), 2), fixed(std::max(drags.hi, -drags.lo), 2),
      fixed(speeds.lo, 1), fixed(speeds.hi, 1));
  using plot::Colour;
  using plot::Dash;
  const plot::Range times{flight.time.front(), flight.time.back()};
  const auto panel = [&](const std::string& label, double lines, plot::Range range,
                         std::vector<plot::Layer> curves) {
    curves.insert(curves.begin(), plot::zero_line());
    return plot::Panel{.x = {.range = times, .numbers = false},
                       .y = {.label = label, .range = plot::with_margin(range)},
                       .lines = lines,
                       .layers = std::move(curves)};
  };
  figure.parts.emplace_back(panel("forward acceleration (m/s²)", 11,
                                  plot::joint(plot::extent(flight.expected_acceleration),
                                              plot::extent(flight.forward_acceleration)),
                                  {outline_curve(flight.time, flight.expected_acceleration,
                                                 Colour::blue, Dash::solid, "expected (attitude)"),
                                   outline_curve(flight.time, flight.forward_acceleration,
                                                 Colour::orange, Dash::dashed, "observed")}));
  figure.parts.emplace_back(
      panel("drag per mass, expected less observed (m/s²)", 9.5, drags,
            {outline_curve(flight.time, drag, Colour::vermilion, Dash::solid)}));
  plot::Panel speed =
      panel("forward speed over ground (m/s)", 8.5, speeds,
            {outline_curve(flight.time, flight.forward_speed, Colour::ink, Dash::solid)});
  speed.x.label = "time of the log (s)";
  speed.x.numbers = true;
  figure.parts.emplace_back(std::move(speed));
  return figure;
}

Figure drag_figure(const DragStudy& drag) {
  const std::vector<DragSample> all = samples_of(drag.identified);
  const std::size_t step = plot::thinning(all.size(), most_samples);
  const std::vector<DragSample> shown = thinned(all, step);
  const std::vector<double> measured = plot::column(all, &DragSample::measured);
  const plot::Range flown = plot::extent(plot::column(all, &DragSample::airspeed));
  const plot::Range speeds = plot::with_margin(flown, 0.03);
  const std::vector<SteadyPoint> steady = steady_line(drag.identified.fit, flown);

  Figure figure{.id = "drag", .title = "Drag of " + drag.name, .heading = drag.name};
  figure.description = fmt::format(
      "Drag in newtons over airspeed from {} to {} m/s, measured at {} samples{} and fitted: {}. "
      "The line is steady flight. Below, measured less fitted: {} m/s² root mean square.",
      fixed(flown.lo, 1), fixed(flown.hi, 1), all.size(), samples_words(step),
      parameter_words(drag.identified.fit), fixed(drag.identified.fit.quality.rmse, 3));
  using plot::Colour;
  using plot::Mark;
  const plot::Range forces = plot::bulk(measured);
  plot::Panel fit{.x = {.range = speeds, .numbers = false},
                  .y = {.label = "drag (N)", .range = forces},
                  .remark = outside_words(measured, forces),
                  .lines = 16.5};
  fit.layers = {plot::zero_line(),
                plot::Band{.x = plot::column(steady, &SteadyPoint::airspeed),
                           .lower = plot::column(steady, &SteadyPoint::lower),
                           .upper = plot::column(steady, &SteadyPoint::upper),
                           .words = "its 95 % interval"},
                over_airspeed(shown, &DragSample::measured, Mark::speck, Colour::blue,
                              "measured" + samples_words(step)),
                over_airspeed(shown, &DragSample::fitted, Mark::cross, Colour::vermilion,
                              "fitted" + samples_words(step)),
                steady_curve(steady, &SteadyPoint::force, "steady flight")};
  if (drag.without_linear) {
    plot::Curve bare = steady_curve(steady_line(*drag.without_linear, flown), &SteadyPoint::force,
                                    "without a linear term");
    bare.colour = Colour::orange;
    bare.dash = plot::Dash::dashed;
    fit.layers.emplace_back(std::move(bare));
  }
  const plot::Panel rest{
      .x = {.label = "airspeed, forward (m/s)", .range = speeds},
      .y = {.label = "measured less fitted (N)",
            .range = plot::bulk(plot::column(shown, &DragSample::residual))},
      .lines = 9,
      .layers = {plot::zero_line(),
                 over_airspeed(shown, &DragSample::residual, Mark::speck, Colour::green, "")}};
  figure.parts = {std::move(fit), rest};
  return figure;
}

Figure drag_surface_figure(const DragStudy& drag) {
  const std::vector<DragSample> all = samples_of(drag.identified);
  constexpr std::size_t most_dots = 500;
  const std::size_t step = plot::thinning(all.size(), most_dots);
  const std::vector<DragSample> shown = thinned(all, step);
  const plot::Range airspeeds = plot::extent(plot::column(all, &DragSample::airspeed));
  const plot::Range tilts = plot::extent(plot::column(all, &DragSample::tilt));
  const DragFit& fit = drag.identified.fit;
  std::vector<double> sizes;
  for (const DragSample& sample : all) sizes.push_back(std::abs(sample.residual));
  std::ranges::sort(sizes);
  const double large = sizes[sizes.size() * 99 / 100];  // rare ones would make specks of the rest

  Figure figure{.id = "dragsurface",
                .title = "Drag of " + drag.name + " over airspeed and tilt",
                .heading = drag.name};
  figure.description = fmt::format(
      "Lines of equal fitted drag over airspeed from {} to {} m/s and tilt from {} to {} degrees, "
      "positive leaning forward: {}. Marks are samples{}, full where measured drag is more than "
      "fitted and hollow where it is less; the largest stand for {} N and more. The thick line is "
      "steady flight.",
      fixed(airspeeds.lo, 1), fixed(airspeeds.hi, 1), fixed(tilts.lo, 0), fixed(tilts.hi, 0),
      parameter_words(fit), samples_words(step), significant(large, 2));
  plot::Panel panel{
      .x = {.label = "airspeed, forward (m/s)", .range = plot::with_margin(airspeeds, 0.03)},
      .y = {.label = "tilt (deg)", .range = plot::with_margin(tilts, 0.03)},
      .lines = 20,
      .layers = DragSurface(fit, airspeeds, tilts).contours()};
  panel.layers.emplace_back(left_over(shown, true, large, "measured more" + samples_words(step)));
  panel.layers.emplace_back(left_over(shown, false, large, "measured less" + samples_words(step)));
  panel.layers.emplace_back(
      steady_curve(steady_line(fit, airspeeds), &SteadyPoint::tilt, "steady flight"));
  panel.key = {fmt::format("The largest marks are {} N and more off the fitted drag.",
                           significant(large, 2))};
  figure.parts = {std::move(panel)};
  return figure;
}

}  // namespace tethercalc
