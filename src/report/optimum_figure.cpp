#include <algorithm>
#include <cmath>

#include "report/gnuplot_script.hpp"
#include "tethercalc/report/design_sentences.hpp"
#include "tethercalc/report/result_figures.hpp"
#include "tethercalc/study/results.hpp"

namespace tethercalc {
namespace {

double in_mm2(double area) { return area / unit::square_millimetre; }

std::string feasible_style() { return gp::area(colour::green); }

/// What is drawn over the cross-section, in practical units.
struct Curves {
  std::vector<double> area;       ///< mm²
  std::vector<double> available;  ///< g per motor, where headroom is demanded
  std::vector<double> hover;      ///< necessary, g per motor
  std::vector<double> forward;    ///< necessary, g per motor
  std::vector<double> required;   ///< with headroom, g per motor
  std::vector<double> hover_W;    ///< from the supply
  std::vector<double> forward_W;  ///< from the supply
};

Curves curves_of(const Requirements& need, std::span<const AreaPoints> points) {
  Curves curves;
  for (const AreaPoints& row : points) {
    const OperatingPoint& judged = row.in(need.headroom_at);
    curves.area.push_back(in_mm2(row.area));
    curves.available.push_back(judged.available_thrust / unit::gram_force);
    curves.hover.push_back(row.hover.necessary_thrust / unit::gram_force);
    curves.forward.push_back(row.forward.necessary_thrust / unit::gram_force);
    curves.required.push_back(need.thrust_headroom * judged.necessary_thrust / unit::gram_force);
    curves.hover_W.push_back(row.hover.total_power);
    curves.forward_W.push_back(row.forward.total_power);
  }
  return curves;
}

/// From zero to above what is asked for; what is far above that is cut off.
gp::Range thrust_range(const Curves& curves) {
  const double asked = std::max(
      {gp::extent(curves.required).hi, gp::extent(curves.hover).hi, gp::extent(curves.forward).hi});
  return {0, 1.08 * std::min(1.6 * asked, std::max(asked, gp::extent(curves.available).hi))};
}

bool any_power(const Curves& curves) {
  return std::any_of(curves.hover_W.begin(), curves.hover_W.end(),
                     [](double power) { return std::isfinite(power); });
}

/// Around the least power; thin conductors need any amount.
gp::Range power_range(const OptimumStudy& study, const Curves& curves) {
  if (!any_power(curves)) return {0, 1};
  const gp::Range hover = gp::extent(curves.hover_W);
  const gp::Range forward = gp::extent(curves.forward_W);
  const auto [least, most] = gp::joint(hover, forward);
  double reference = std::max(hover.lo, forward.lo);
  if (study.result.feasible) {
    reference =
        std::max({reference, study.result.hover.total_power, study.result.forward.total_power});
  }
  const double top = std::min(most, reference + 1.2 * (reference - 0.8 * least));
  return {least - 0.12 * (top - least), top};
}

/// Where `area` lies along the axis, 0 to 1.
double along(const AreaCurve& view, double area) {
  return view.logarithmic ? std::log(area / view.lo) / std::log(view.hi / view.lo)
                          : (area - view.lo) / (view.hi - view.lo);
}

/// Ticks of the sizes that `standard` names; those whose names would touch stay without one, the
/// sizes next to `middle` go first.
std::string size_ticks(const AreaCurve& view, std::string_view standard, double middle) {
  struct Tick {
    std::string name;
    double area = 0;
    double distance = 0;
    bool named = false;
  };
  std::vector<Tick> ticks;
  for (const WireSize& size : wire_sizes()) {
    if (size.standard != standard || size.area <= view.lo || size.area > view.hi) continue;
    std::string name = size.name;
    // Thin sizes crowd at the beginning of a linear axis; there they say nothing.
    if (along(view, size.area) < 0.06) continue;
    if (name.starts_with("AWG ")) name = name.substr(4);
    if (const auto space = name.find(' '); space != std::string::npos) name = name.substr(0, space);
    ticks.push_back({name, size.area, std::abs(std::log(size.area / middle)), false});
  }
  std::vector<Tick*> order;
  for (Tick& tick : ticks) order.push_back(&tick);
  std::sort(order.begin(), order.end(),
            [](const Tick* a, const Tick* b) { return a->distance < b->distance; });
  constexpr double width_of_a_letter = 0.024;  // of the axis, 7.5 pt in one column
  for (Tick* tick : order) {
    tick->named = std::none_of(ticks.begin(), ticks.end(), [&](const Tick& other) {
      const double letters = 0.5 * double(tick->name.size() + other.name.size()) + 1;
      return other.named && std::abs(along(view, tick->area) - along(view, other.area)) <
                                letters * width_of_a_letter;
    });
  }
  std::string list;
  for (const Tick& tick : ticks) {
    list += fmt::format("{}{} {}", list.empty() ? "" : ", ",
                        gnuplot_text(tick.named ? tick.name : ""), gp::number(in_mm2(tick.area)));
  }
  return list;
}

/// The upper axis with the sizes of a standard.
std::string top_axis(const OptimumStudy& study, const AreaCurve& view, std::string_view standard) {
  const double middle = study.result.feasible
                            ? study.result.area
                            : std::sqrt(std::max(view.lo, 0.1 * view.hi) * view.hi);
  const std::string ticks = size_ticks(view, standard, middle);
  return ticks.empty() ? "unset x2tics\n" : fmt::format("set x2tics ({}) offset 0,-0.4\n", ticks);
}

/// Shaded ranges behind the curves, and a line at the optimum.
std::string shading(const OptimumStudy& study, const AreaCurve& view) {
  std::string out = "if (!characters) {\n";
  for (const Interval& range : study.result.feasible_areas) {
    const double lo = std::max(view.lo, range.lo);
    const double hi = std::min(view.hi, range.hi);
    if (!(lo < hi)) continue;
    out += fmt::format("  set object rectangle from {},graph 0 to {},graph 1 behind {}\n",
                       gp::number(in_mm2(lo)), gp::number(in_mm2(hi)), feasible_style());
  }
  if (study.result.feasible) {
    const std::string at = gp::number(in_mm2(study.result.area));
    out += fmt::format("  set arrow from {0},graph 0 to {0},graph 1 nohead {1}\n", at,
                       gp::line(colour::black, 3, 0.8));
  }
  return out + "}\n";
}

std::string rounded_area(double area) { return significant(in_mm2(area), 3) + " mm²"; }

gp::Plot thrust_plot(const OptimumStudy& study, std::span<const AreaPoints> points) {
  const Requirements& need = study.design.requirements;
  const std::string factor = significant(need.thrust_headroom, 2);
  gp::Plot plot;
  plot.curve("$curves using 1:2", gp::line(colour::black, 1, 1.6), "available");
  plot.curve("$curves using 1:3", gp::line(colour::blue, 2), "necessary in hover");
  plot.curve("$curves using 1:5", gp::line(colour::vermilion, 4, 1.4),
             fmt::format("required, {}× {}", factor, condition_name(need.headroom_at)));
  plot.curve("$curves using 1:4", gp::line(colour::orange, 5), "necessary forward");
  const Optimization& result = study.result;
  if (result.feasible) {
    const OperatingPoint judged = study.points().in(need.headroom_at);
    plot.mark(in_mm2(result.area), judged.available_thrust / unit::gram_force,
              gp::point(colour::black, 13, 0.9), "");
  } else if (study.best_headroom.value > 0) {
    const auto best = std::find_if(points.begin(), points.end(), [&](const AreaPoints& row) {
      return row.area == study.best_headroom.area;
    });
    plot.mark(in_mm2(best->area), best->in(need.headroom_at).available_thrust / unit::gram_force,
              gp::point(colour::black, 9, 0.9),
              fmt::format("best headroom, {}×", significant(study.best_headroom.value, 3)));
  }
  return plot;
}

gp::Plot power_plot(const OptimumStudy& study) {
  const Optimization& result = study.result;
  gp::Plot plot;
  plot.curve("$curves using 1:6", gp::line(colour::blue, 2, 1.6), "hover");
  if (result.feasible) {
    const OperatingPoint judged = study.points().in(study.design.requirements.power_at);
    plot.mark(in_mm2(result.area), judged.total_power, gp::point(colour::black, 13, 0.9),
              "optimum, " + rounded_area(result.area));
  }
  plot.curve("$curves using 1:7", gp::line(colour::orange, 5, 1.6), "forward flight");
  const MinimumPower& least = result.minimum_power;
  plot.mark(in_mm2(least.area), least.power, gp::point(colour::green, 7, 0.8),
            "least power, " + rounded_area(least.area));
  if (!result.feasible_areas.empty())
    plot.entry({gp::LegendEntry::Sample::area, feasible_style(), "feasible"});
  return plot;
}

std::string description_of(const OptimumStudy& study) {
  const Design& design = study.design;
  const Optimization& result = study.result;
  std::string out =
      "Two diagrams over the cross-section of one conductor: thrust per motor, available, "
      "necessary and required; and power from the supply in hover and in forward flight. ";
  if (!result.feasible) return out + refusal_sentence(design, *study.refusal);
  out += fmt::format("The optimum is {}, drawing {} W in hover and {} W in forward flight. ",
                     rounded_area(result.area), fixed(result.hover.total_power, 1),
                     fixed(result.forward.total_power, 1));
  return out + limit_sentence(design, result);
}

}  // namespace

Figure optimum_figure(const std::string& name, const OptimumStudy& study, const AreaCurve& curve) {
  const gp::Range shown{in_mm2(curve.lo), in_mm2(curve.hi)};
  const Curves curves = curves_of(study.design.requirements, curve.points);
  Figure figure{.id = "optimum", .title = name, .description = description_of(study), .lines = 43};
  const gp::Layout layout(figure.lines);
  figure.script =
      gp::prelude() +
      gp::data_block("curves", {curves.area, curves.available, curves.hover, curves.forward,
                                curves.required, curves.hover_W, curves.forward_W});
  figure.script += gp::set_range("x", shown) + gp::set_range("x2", shown);
  if (curve.logarithmic) figure.script += "set logscale x\nset logscale x2\n";
  figure.script += "set samples 2\nset multiplot\n";

  const gp::Plot thrust = thrust_plot(study, curve.points);
  figure.script += layout.panel(4, 18) + layout.heading(name) + shading(study, curve);
  figure.script += layout.above(2.4, "thrust per motor (g)", "AWG");
  figure.script += layout.legend(19.2, 2, thrust.legend());
  figure.script += top_axis(study, curve, "AWG") + gp::set_range("y", thrust_range(curves));
  figure.script += "set format x ''\n" + thrust.text();

  const gp::Plot power = power_plot(study);
  figure.script += layout.panel(25.5, 36) + shading(study, curve);
  figure.script += layout.above(23.9, "power from the supply (W)", "IEC 60228 (mm²)");
  figure.script += layout.below(38.4, "cross-section of one conductor (mm²)");
  figure.script += layout.legend(40, 2, power.legend());
  figure.script += top_axis(study, curve, "IEC 60228");
  figure.script += gp::set_range("y", power_range(study, curves));
  if (!any_power(curves)) {
    figure.script += "set label 1 'cannot be delivered' at graph 0.5,0.5 center\n";
  }
  figure.script += "set format x '%g'\n" + power.text() + "unset multiplot\n";
  return figure;
}

}  // namespace tethercalc
