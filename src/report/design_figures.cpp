#include "tethercalc/report/result_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/figure_data.hpp"
#include "tethercalc/study/results.hpp"

namespace tethercalc {
namespace {

using plot::Colour;
using plot::Dash;
using plot::Mark;

double in_mm2(double area) { return area / unit::square_millimetre; }

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
plot::Range thrust_range(const Curves& curves) {
  const double asked = std::max({plot::extent(curves.required).hi, plot::extent(curves.hover).hi,
                                 plot::extent(curves.forward).hi});
  return {0, 1.08 * std::min(1.6 * asked, std::max(asked, plot::extent(curves.available).hi))};
}

bool any_power(const Curves& curves) {
  return std::ranges::any_of(curves.hover_W, [](double power) { return std::isfinite(power); });
}

/// Around the least power; thin conductors need any amount.
plot::Range power_range(const OptimumStudy& study, const Curves& curves) {
  if (!any_power(curves)) return {0, 1};
  const plot::Range hover = plot::extent(curves.hover_W);
  const plot::Range forward = plot::extent(curves.forward_W);
  const auto [least, most] = plot::joint(hover, forward);
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

/// The sizes that `standard` names as ticks, those next to `middle` first.
std::vector<plot::Tick> size_ticks(const AreaCurve& view, std::string_view standard,
                                   double middle) {
  std::vector<WireSize> shown;
  std::vector<WireSize> crowded;  // thin sizes at the beginning of a linear axis
  for (const WireSize& size : wire_sizes()) {
    if (size.standard != standard || size.area <= view.lo || size.area > view.hi) continue;
    (along(view, size.area) < 0.06 ? crowded : shown).push_back(size);
  }
  if (shown.empty() && !crowded.empty()) shown.push_back(crowded.back());
  std::ranges::sort(
      shown, {}, [middle](const WireSize& size) { return std::abs(std::log(size.area / middle)); });
  std::vector<plot::Tick> ticks;
  for (const WireSize& size : shown) {
    std::string name = size.name;
    if (name.starts_with("AWG ")) name = name.substr(4);
    if (const auto space = name.find(' '); space != std::string::npos) name = name.substr(0, space);
    ticks.push_back({in_mm2(size.area), name});
  }
  return ticks;
}

/// The cross-section along the lower edge.
plot::Axis area_axis(const AreaCurve& view) {
  return {.label = "cross-section of one conductor (mm²)",
          .range = {in_mm2(view.lo), in_mm2(view.hi)},
          .logarithmic = view.logarithmic};
}

/// The sizes of a standard along the upper edge, where there are any.
std::optional<plot::Axis> size_axis(const OptimumStudy& study, const AreaCurve& view,
                                    std::string_view standard, const std::string& label) {
  const double middle = study.result.feasible
                            ? study.result.area
                            : std::sqrt(std::max(view.lo, 0.1 * view.hi) * view.hi);
  plot::Axis axis = area_axis(view);
  axis.label = label;
  axis.ticks = size_ticks(view, standard, middle);
  if (axis.ticks.empty()) return std::nullopt;
  return axis;
}

std::string rounded_area(double area) { return significant(in_mm2(area), 3) + " mm²"; }

/// Shaded ranges behind the curves, in the legend once, and a line at the optimum.
std::vector<plot::Layer> backdrop(const OptimumStudy& study, const std::string& feasible_words,
                                  const std::string& optimum_words) {
  std::vector<plot::Layer> out;
  for (const Interval& range : study.result.feasible_areas) {
    out.push_back(plot::Span{.range = {in_mm2(range.lo), in_mm2(range.hi)},
                             .colour = Colour::green,
                             .words = out.empty() ? feasible_words : ""});
  }
  if (study.result.feasible) {
    out.push_back(plot::Reference{.at = in_mm2(study.result.area),
                                  .vertical = true,
                                  .colour = Colour::ink,
                                  .dash = Dash::dotted,
                                  .words = optimum_words});
  }
  return out;
}

/// A single point with its words in the legend.
plot::Points marked(double x, double y, Mark mark, Colour colour, const std::string& words) {
  return {.x = {x}, .y = {y}, .mark = mark, .colour = colour, .words = words};
}

plot::Panel thrust_panel(const OptimumStudy& study, const AreaCurve& view, const Curves& curves) {
  const Requirements& need = study.design.requirements;
  const Optimization& result = study.result;
  plot::Panel panel{.x = area_axis(view),
                    .y = {.label = "thrust per motor (g)", .range = thrust_range(curves)},
                    .top = size_axis(study, view, "AWG", "AWG"),
                    .lines = 14,
                    .layers = backdrop(study, "", rounded_area(result.area))};
  panel.x.label = "";  // that of the panel below
  panel.x.numbers = false;
  const auto curve = [&](const std::vector<double>& y, Colour colour, Dash dash, double width,
                         const std::string& words) {
    panel.layers.push_back(plot::Curve{
        .x = curves.area, .y = y, .colour = colour, .dash = dash, .width = width, .words = words});
  };
  curve(curves.available, Colour::ink, Dash::solid, 1.6, "available");
  curve(curves.hover, Colour::blue, Dash::dashed, 1.2, "necessary in hover");
  curve(curves.required, Colour::vermilion, Dash::dash_dotted, 1.4,
        fmt::format("required, {}× {}", significant(need.thrust_headroom, 2),
                    condition_name(need.headroom_at)));
  curve(curves.forward, Colour::orange, Dash::dash_dot_dotted, 1.2, "necessary forward");
  if (result.feasible) {
    const OperatingPoint judged = result.in(need.headroom_at);
    panel.layers.push_back(marked(in_mm2(result.area), judged.available_thrust / unit::gram_force,
                                  Mark::diamond, Colour::ink, "optimum"));
  } else if (study.best_headroom.value > 0) {
    const auto best = std::ranges::find(view.points, study.best_headroom.area, &AreaPoints::area);
    panel.layers.push_back(
        marked(in_mm2(best->area), best->in(need.headroom_at).available_thrust / unit::gram_force,
               Mark::triangle, Colour::ink,
               fmt::format("best headroom, {}×", significant(study.best_headroom.value, 3))));
  }
  return panel;
}

plot::Panel power_panel(const OptimumStudy& study, const AreaCurve& view, const Curves& curves) {
  const Optimization& result = study.result;
  plot::Panel panel{.x = area_axis(view),
                    .y = {.label = "power from the supply (W)",
                          .range = power_range(study, curves),
                          .numbers = any_power(curves)},
                    .top = size_axis(study, view, "IEC 60228", "IEC 60228 (mm²)"),
                    .lines = 11,
                    .layers = backdrop(study, "feasible", "")};
  panel.layers.push_back(plot::Curve{.x = curves.area,
                                     .y = curves.hover_W,
                                     .colour = Colour::blue,
                                     .dash = Dash::dashed,
                                     .width = 1.6,
                                     .words = "hover"});
  panel.layers.push_back(plot::Curve{.x = curves.area,
                                     .y = curves.forward_W,
                                     .colour = Colour::orange,
                                     .dash = Dash::dash_dot_dotted,
                                     .width = 1.6,
                                     .words = "forward flight"});
  const MinimumPower& least = result.minimum_power;
  if (std::isfinite(least.power)) {
    panel.layers.push_back(marked(in_mm2(least.area), least.power, Mark::dot, Colour::green,
                                  "least power, " + rounded_area(least.area)));
  }
  if (result.feasible) {
    const OperatingPoint judged = result.in(study.design.requirements.power_at);
    panel.layers.push_back(marked(in_mm2(result.area), judged.total_power, Mark::diamond,
                                  Colour::ink, "optimum, " + rounded_area(result.area)));
  }
  if (!any_power(curves)) {
    const auto [lo, hi] = panel.x.range;
    panel.layers.push_back(plot::Note{.x = view.logarithmic ? std::sqrt(lo * hi) : (lo + hi) / 2,
                                      .y = 0.5,
                                      .words = "cannot be delivered"});
  }
  return panel;
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

/// A point of efficiency over thrust.
struct CurvePoint {
  double thrust = 0;      ///< g
  double efficiency = 0;  ///< g/W
};

/// As far as it was measured.
using EfficiencyCurve = std::vector<CurvePoint>;

CurvePoint curve_point(const MotorCurve& curve, double thrust) {
  return {thrust / unit::gram_force, thrust / unit::gram_force / curve.power(thrust)};
}

EfficiencyCurve efficiency_of(const MotorCurve& curve) {
  EfficiencyCurve out;
  const auto vertices = curve.vertices();
  // Power is straight between the points, efficiency is not.
  constexpr int steps = 12;
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    const double from = i == 1 ? vertices[1].thrust : vertices[i - 1].thrust;
    for (int k = i == 1 ? steps : 1; k <= steps; ++k) {
      out.push_back(curve_point(curve, from + (vertices[i].thrust - from) * k / steps));
    }
  }
  return out;
}

plot::Points mark_on(const MotorCurve& curve, double thrust, Mark mark, Colour colour) {
  const CurvePoint at = curve_point(curve, std::min(thrust, curve.max_thrust()));
  return marked(at.thrust, at.efficiency, mark, colour, "");
}

/// Circle, dot and plus of the paper's figure on motors.
std::vector<plot::Points> marks_of(const MotorOptimum& motor, Colour colour) {
  if (!motor.result.feasible) return {};
  const Requirements& need = motor.design.requirements;
  const MotorCurve curve = motor_in_flight(motor.design);
  const double necessary = motor.result.in(need.headroom_at).necessary_thrust;
  std::vector<plot::Points> marks{
      mark_on(curve, necessary, Mark::circle, colour),
      mark_on(curve, need.thrust_headroom * necessary, Mark::dot, colour)};
  if (motor.result.limited_by == Limit::minimum_power) {
    marks.push_back(
        mark_on(curve, motor.result.in(need.power_at).necessary_thrust, Mark::plus, colour));
  }
  return marks;
}

/// The first measured efficiency counts for smaller thrusts too (paper, section III): drawn thinly
/// from where the drone hovers. Empty where that is measured.
plot::Curve assumed(const EfficiencyCurve& curve, std::span<const plot::Points> marks,
                    std::size_t index) {
  const CurvePoint first = curve.front();
  double least = first.thrust;
  for (const plot::Points& mark : marks) least = std::min(least, mark.x.front());
  if (!(least < first.thrust)) return {};
  return {.x = {least, first.thrust},
          .y = {first.efficiency, first.efficiency},
          .colour = plot::curve_colour(index),
          .dash = plot::curve_dash(index),
          .width = 0.5};
}

std::string name_of(const MotorOptimum& motor, std::size_t index) {
  return fmt::format("{} {}", index + 1,
                     motor.motor.name.empty() ? motor.motor.id : motor.motor.name);
}

/// What a motor's best tether is and draws; a word where there is none.
struct Labels {
  std::string area;
  std::string power;
};

Labels labels_of(const MotorOptimum& motor) {
  if (!motor.result.feasible) return {"", "infeasible"};
  const OperatingPoint judged = motor.result.in(motor.design.requirements.power_at);
  return {significant(motor.result.area / unit::square_millimetre, 3),
          fixed(judged.total_power, 0)};
}

std::string words_of(const MotorOptimum& motor, std::size_t index) {
  const Labels labels = labels_of(motor);
  if (labels.area.empty()) return name_of(motor, index) + ": " + labels.power;
  return fmt::format("{}: {} mm², {} W", name_of(motor, index), labels.area, labels.power);
}

/// What the marks on curves mean.
std::vector<plot::Layer> explained_marks(const Requirements& need) {
  const auto explain = [](Mark mark, const std::string& words) {
    return plot::Points{.mark = mark, .words = words};
  };
  return {explain(Mark::circle, "necessary in " + condition_words(need.headroom_at)),
          explain(Mark::dot,
                  fmt::format("required: {} times that", significant(need.thrust_headroom, 2))),
          explain(Mark::plus, "where least power, not headroom, decides")};
}

std::string description_of(std::span<const MotorOptimum> ranking) {
  std::string out =
      "Efficiency in gram-force per watt over the thrust of one motor, a curve a motor, with the "
      "thrust that each needs at its best tether. By rising power: ";
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    out += (i == 0 ? "" : "; ") + words_of(ranking[i], i);
  }
  return out + ".";
}

/// Logarithmic where motors are so unlike that the small ones would be a heap at its beginning.
plot::Axis thrust_axis(const plot::Range& thrusts) {
  plot::Axis axis{.label = "thrust of one motor (g)", .range = {0, 1.08 * thrusts.hi}};
  constexpr double unlike = 30;
  axis.logarithmic = thrusts.lo > 0 && thrusts.hi > unlike * thrusts.lo;
  if (axis.logarithmic) axis.range = {thrusts.lo / 1.08, 1.15 * thrusts.hi};
  return axis;
}

}  // namespace

Figure optimum_figure(const std::string& name, const OptimumStudy& study, const AreaCurve& curve) {
  const Curves curves = curves_of(study.design.requirements, curve.points);
  return {.id = "optimum",
          .title = study.result.feasible ? name : "Cannot fly as required: " + name,
          .description = description_of(study),
          .parts = {thrust_panel(study, curve, curves), power_panel(study, curve, curves)}};
}

Figure motors_figure(const DesignFile& file, std::span<const MotorOptimum> ranking) {
  plot::Panel panel{
      .y = {.label = "efficiency (g/W)"}, .lines = 20.5, .legend_heads = {"mm²", "W"}};
  std::vector<double> thrusts;
  std::vector<double> efficiencies;
  std::vector<plot::Layer> assumptions;
  std::vector<plot::Layer> marks;
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    const EfficiencyCurve curve = efficiency_of(motor_in_flight(ranking[i].design));
    const Labels labels = labels_of(ranking[i]);
    plot::Curve drawn{.x = plot::column(curve, &CurvePoint::thrust),
                      .y = plot::column(curve, &CurvePoint::efficiency),
                      .colour = plot::curve_colour(i),
                      .dash = plot::curve_dash(i),
                      .width = 1.3,
                      .words = name_of(ranking[i], i),
                      .cells = {labels.area, labels.power},
                      .label = std::to_string(i + 1)};
    thrusts.insert(thrusts.end(), drawn.x.begin(), drawn.x.end());
    efficiencies.insert(efficiencies.end(), drawn.y.begin(), drawn.y.end());
    panel.layers.push_back(std::move(drawn));
    const std::vector<plot::Points> own = marks_of(ranking[i], plot::curve_colour(i));
    assumptions.push_back(assumed(curve, own, i));
    marks.insert(marks.end(), own.begin(), own.end());
  }
  for (const auto& more : {assumptions, marks, explained_marks(file.design.requirements)}) {
    panel.layers.insert(panel.layers.end(), more.begin(), more.end());
  }
  panel.x = thrust_axis(plot::extent(thrusts));
  panel.y.range = plot::with_margin(plot::extent(efficiencies), 0.1);
  return {.id = "motors",
          .title = "Motors for " + file.name,
          .heading = file.name,
          .description = description_of(ranking),
          .parts = {std::move(panel)}};
}

}  // namespace tethercalc
