#include "tethercalc/report/result_figures.hpp"

#include <algorithm>
#include <cmath>

#include "report/gnuplot_script.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc {
namespace {

constexpr std::size_t most_samples = 700;

std::string outline_block(std::string_view name, std::span<const double> time,
                          std::span<const double> values) {
  const gp::Series drawn = gp::outline(time, values);
  return gp::data_block(name, {drawn.x, drawn.y});
}

double root_mean_square(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / double(values.size()));
}

/// Drag at one sample, N.
struct DragSample {
  double airspeed = 0;  ///< m/s
  double tilt = 0;      ///< deg
  double measured = 0;
  double fitted = 0;
  double residual = 0;  ///< measured less fitted
};

std::vector<DragSample> samples_of(const DragStudy& drag) {
  std::vector<DragSample> out;
  const DragFitConditions& known = drag.identified.fit.conditions;
  const AirframeDrag parameters = drag.identified.fit.drag();
  for (std::size_t f = 0; f < drag.identified.flights.size(); ++f) {
    const Observations& flight = drag.identified.flights[f];
    const double wind = drag.identified.fit.wind()[f].estimate.value;
    const FittedParameter* crosswind = drag.identified.fit.find("crosswind_m_s", f);
    const double blown = crosswind == nullptr ? 0 : crosswind->estimate.value;
    const bool exact = flight.kinematics == Kinematics::exact;
    const std::vector<double> over_mass = forward_drag_over_mass(flight);
    for (std::size_t i = 0; i < flight.size(); ++i) {
      const double airspeed = flight.forward_speed[i] - wind;
      const double aside = exact ? flight.right_speed[i] - blown : 0;
      const double measured = known.mass * over_mass[i];
      const double fitted = airframe_drag_along(parameters, known.air_density, airspeed, aside,
                                                std::tan(flight.tilt[i]));
      out.push_back({airspeed, flight.tilt[i] / unit::degree, measured, fitted, measured - fitted});
    }
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
std::vector<SteadyPoint> steady_line(const DragFit& fit, gp::Range range) {
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
std::string outside_words(std::span<const double> values, gp::Range range) {
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

}  // namespace

Figure log_figure(const std::string& name, const Observations& flight) {
  Figure figure{.id = "log", .title = "Accelerations of " + name, .description = {}, .lines = 43};
  const std::vector<double> drag = forward_drag_over_mass(flight);
  const gp::Range drags = gp::extent(drag);
  const gp::Range speeds = gp::extent(flight.forward_speed);
  figure.description = fmt::format(
      "Three diagrams over {} s of flight, {} samples: forward acceleration expected from the "
      "attitude and observed; drag per mass, their difference, {} m/s² root mean square and at "
      "most {} m/s²; and forward speed, from {} to {} m/s.",
      fixed(flight.time.back() - flight.time.front(), 0), flight.size(),
      fixed(root_mean_square(drag), 2), fixed(std::max(drags.hi, -drags.lo), 2),
      fixed(speeds.lo, 1), fixed(speeds.hi, 1));
  const gp::Layout layout(figure.lines, 0.105);
  figure.script = gp::prelude() +
                  outline_block("expected", flight.time, flight.expected_acceleration) +
                  outline_block("observed", flight.time, flight.forward_acceleration) +
                  outline_block("drag", flight.time, drag) +
                  outline_block("speed", flight.time, flight.forward_speed);
  figure.script += gp::set_range("x", {flight.time.front(), flight.time.back()}) + gp::zero_line +
                   "set multiplot\n";

  gp::Plot accelerations;
  accelerations.curve("$expected using 1:2", gp::line(colour::blue, 1, 0.7), "expected (attitude)");
  accelerations.curve("$observed using 1:2", gp::line(colour::sky, 1, 0.7), "observed");
  figure.script +=
      layout.panel(3.5, 14.5) + layout.heading(name) +
      layout.above(2.6, "forward acceleration (m/s²)") +
      layout.legend(15.6, 2, accelerations.legend()) +
      gp::set_range("y", gp::with_margin(gp::joint(gp::extent(flight.expected_acceleration),
                                                   gp::extent(flight.forward_acceleration)))) +
      "set format x ''\n" + accelerations.text();

  gp::Plot difference_plot;
  difference_plot.curve("$drag using 1:2", gp::line(colour::vermilion, 1, 0.7));
  figure.script += layout.panel(18.5, 28) + layout.legend(0, 1, {}) +
                   layout.above(17.6, "drag per mass, expected less observed (m/s²)") +
                   gp::set_range("y", gp::with_margin(drags)) + difference_plot.text();

  gp::Plot speed;
  speed.curve("$speed using 1:2", gp::line(colour::black, 1, 0.8));
  figure.script += layout.panel(30.6, 39) + layout.legend(0, 1, {}) +
                   layout.above(29.7, "forward speed over ground (m/s)") +
                   layout.below(41.6, "time of the log (s)") +
                   gp::set_range("y", gp::with_margin(speeds)) + "set format x '%g'\n" +
                   speed.text() + "unset multiplot\n";
  return figure;
}

Figure drag_figure(const DragStudy& drag) {
  const std::vector<DragSample> all = samples_of(drag);
  const std::size_t step = gp::thinning(all.size(), most_samples);
  const std::vector<DragSample> shown = thinned(all, step);
  const std::vector<double> measured = gp::column(all, &DragSample::measured);
  const gp::Range flown = gp::extent(gp::column(all, &DragSample::airspeed));
  const gp::Range speeds = gp::with_margin(flown, 0.03);
  const std::vector<SteadyPoint> steady = steady_line(drag.identified.fit, flown);

  Figure figure{.id = "drag", .title = "Drag of " + drag.name, .description = {}, .lines = 40};
  figure.description = fmt::format(
      "Drag in newtons over airspeed from {} to {} m/s, measured at {} samples{} and fitted: {}. "
      "The line is steady flight. Below, measured less fitted: {} m/s² root mean square.",
      fixed(flown.lo, 1), fixed(flown.hi, 1), all.size(), samples_words(step),
      parameter_words(drag.identified.fit), fixed(drag.identified.fit.quality.rmse, 3));
  const gp::Layout layout(figure.lines, 0.105);
  figure.script = gp::prelude() +
                  gp::data_block("samples", shown,
                                 {&DragSample::airspeed, &DragSample::measured, &DragSample::fitted,
                                  &DragSample::residual}) +
                  gp::data_block("steady", steady,
                                 {&SteadyPoint::airspeed, &SteadyPoint::force, &SteadyPoint::lower,
                                  &SteadyPoint::upper});

  gp::Plot plot;
  const double dot = 0.004 * (speeds.hi - speeds.lo);
  plot.add("$steady using 1:3:4 with filledcurves " + gp::area(colour::black, 0.25));
  plot.dots("$samples", 1, 2, dot, colour::blue, "measured" + samples_words(step));
  plot.dots("$samples", 1, 3, dot, colour::vermilion, "fitted" + samples_words(step));
  plot.curve("$steady using 1:2", gp::line(colour::black, 1, 1.4), "steady flight");
  if (drag.without_linear) {
    figure.script += gp::data_block("bare", steady_line(*drag.without_linear, flown),
                                    {&SteadyPoint::airspeed, &SteadyPoint::force});
    plot.curve("$bare using 1:2", gp::line(colour::orange, 2, 1.6), "without a linear term");
  }
  plot.entry({gp::LegendEntry::Sample::area, gp::area(colour::black, 0.25), "its 95 % interval"});
  gp::Plot rest;
  rest.dots("$samples", 1, 4, dot, colour::green);

  figure.script += gp::set_range("x", speeds) + gp::zero_line + "set multiplot\n";
  const gp::Range forces = gp::bulk(measured);
  figure.script += layout.panel(3.5, 20) + layout.heading(drag.name) +
                   layout.above(2.6, "drag (N)", outside_words(measured, forces)) +
                   layout.legend(21.2, 2, plot.legend()) + gp::set_range("y", forces) +
                   "set format x ''\n" + plot.text();
  figure.script += layout.panel(27, 36) + layout.above(26, "measured less fitted (N)") +
                   layout.legend(0, 1, {}) + layout.below(38.6, "airspeed, forward (m/s)") +
                   gp::set_range("y", gp::bulk(gp::column(shown, &DragSample::residual))) +
                   "set format x '%g'\n" + rest.text() + "unset multiplot\n";
  return figure;
}

Figure drag_surface_figure(const DragStudy& drag) {
  const std::vector<DragSample> all = samples_of(drag);
  constexpr std::size_t most_dots = 500;
  const std::size_t step = gp::thinning(all.size(), most_dots);
  const std::vector<double> measured = gp::column(all, &DragSample::measured);
  const auto [slowest, fastest] = gp::extent(gp::column(all, &DragSample::airspeed));
  const auto [least_tilt, most_tilt] = gp::extent(gp::column(all, &DragSample::tilt));
  const gp::Range forces = gp::bulk(measured);
  const std::string outside = outside_words(measured, forces);

  Figure figure{.id = "dragsurface",
                .title = "Drag of " + drag.name + " over airspeed and tilt",
                .description = {},
                .lines = 32};
  figure.description = fmt::format(
      "A surface of drag in newtons over airspeed from {} to {} m/s and tilt from {} to {} "
      "degrees, positive leaning forward: {}. Dots are measured drag{}, the line is steady "
      "flight{}.",
      fixed(slowest, 1), fixed(fastest, 1), fixed(least_tilt, 0), fixed(most_tilt, 0),
      parameter_words(drag.identified.fit), samples_words(step),
      outside.empty() ? "" : "; " + outside);
  constexpr int grid = 16;
  figure.script = gp::prelude() + "$surface << EOD\n";
  for (int i = 0; i <= grid; ++i) {
    const double airspeed = slowest + (fastest - slowest) * i / grid;
    for (int k = 0; k <= grid; ++k) {
      const double tilt = least_tilt + (most_tilt - least_tilt) * k / grid;
      const double force = airframe_drag_force(drag.identified.fit.drag(),
                                               drag.identified.fit.conditions.air_density, airspeed,
                                               std::tan(tilt * unit::degree));
      figure.script +=
          fmt::format("{} {} {}\n", gp::number(airspeed), gp::number(tilt), gp::number(force));
    }
    figure.script += "\n";
  }
  figure.script += "EOD\n";
  const std::vector<SteadyPoint> steady = steady_line(drag.identified.fit, {slowest, fastest});
  figure.script +=
      gp::data_block(
          "samples", thinned(all, step),
          {&DragSample::airspeed, &DragSample::tilt, &DragSample::measured, &DragSample::fitted}) +
      gp::data_block("steady", steady,
                     {&SteadyPoint::airspeed, &SteadyPoint::tilt, &SteadyPoint::force});

  gp::Plot plot;
  const double dot = 0.004 * (fastest - slowest);
  plot.curve("$surface using 1:2:3", gp::line(colour::vermilion, 1, 0.5), "fitted");
  plot.add("$samples using 1:2:4:(0):(0):($3-$4) with vectors nohead " +
           gp::line(colour::sky, 1, 0.5));
  plot.add(fmt::format("$samples using 1:2:3:({}*dot_length):(0):(0) with vectors nohead {}",
                       gp::number(dot), gp::line(colour::blue, 1, 1.4)),
           "measured" + samples_words(step));
  plot.entry({gp::LegendEntry::Sample::point, gp::point(colour::blue, 5, 0.4),
              "measured" + samples_words(step)});
  plot.entry({gp::LegendEntry::Sample::line, gp::line(colour::sky, 1, 0.8), "what the fit leaves"});
  plot.curve("$steady using 1:2:3", gp::line(colour::black, 1, 2), "steady flight");

  const gp::Layout layout(figure.lines, 0.105);
  figure.script += layout.heading(drag.name) + layout.above(6.5, "drag (N)") +
                   layout.legend(29, 2, plot.legend());
  figure.script +=
      "set view 58,332,1.2,0.85\n"
      "set size 1,0.82\n"
      "set origin 0,0.12\n"
      "set ticslevel 0\n"
      "set border 31 lw 0.5\n"
      "set grid lw 0.3\n"
      "set xtics offset 0,-0.3\n"
      "set ytics offset 0.3,-0.2\n"
      // gnuplot's own axis labels may be pushed out of the picture, and are then left out.
      "set label 1 'tilt (deg)' at screen 0.01,screen 0.24 left\n"
      "set label 2 'airspeed (m/s)' at screen 0.97,screen 0.18 right\n";
  figure.script += gp::set_range("x", {slowest, fastest}) +
                   gp::set_range("y", {least_tilt, most_tilt}) + gp::set_range("z", forces) +
                   plot.text("splot");
  return figure;
}

}  // namespace tethercalc
