#include "tethercalc/report/result_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "report/gnuplot_script.hpp"
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
  return std::ranges::any_of(curves.hover_W, [](double power) { return std::isfinite(power); });
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
  std::ranges::sort(order, {}, &Tick::distance);
  constexpr double width_of_a_letter = 0.024;  // of the axis, 7.5 pt in one column
  for (Tick* tick : order) {
    tick->named = std::ranges::none_of(ticks, [&](const Tick& other) {
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
    const OperatingPoint judged = study.result.in(need.headroom_at);
    plot.mark(in_mm2(result.area), judged.available_thrust / unit::gram_force,
              gp::point(colour::black, 13, 0.9), "");
  } else if (study.best_headroom.value > 0) {
    const auto best = std::ranges::find(points, study.best_headroom.area, &AreaPoints::area);
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
    const OperatingPoint judged = study.result.in(study.design.requirements.power_at);
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

constexpr const char* circle = " pt 6 ps 0.8*dot_scale lw 1.4";
constexpr const char* dot = " pt 7 ps 0.6*dot_scale";
constexpr const char* plus = " pt 1 ps 0.9*dot_scale lw 1.4";

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

/// A mark on a curve.
struct Mark : CurvePoint {
  std::string style;
};

Mark mark_on(const MotorCurve& curve, double thrust, const std::string& style) {
  return {curve_point(curve, std::min(thrust, curve.max_thrust())), style};
}

/// Circle, dot and plus of the paper's figure on motors.
std::vector<Mark> marks_of(const MotorOptimum& motor, std::size_t index) {
  if (!motor.result.feasible) return {};
  const Requirements& need = motor.design.requirements;
  const MotorCurve curve = motor_in_flight(motor.design);
  const AreaPoints& points = motor.result;
  const std::string colour = fmt::format("lc rgb '{}'", gp::curve_colour(index));
  const double necessary = points.in(need.headroom_at).necessary_thrust;
  std::vector<Mark> marks{mark_on(curve, necessary, colour + circle),
                          mark_on(curve, need.thrust_headroom * necessary, colour + dot)};
  if (motor.result.limited_by == Limit::minimum_power) {
    marks.push_back(mark_on(curve, points.in(need.power_at).necessary_thrust, colour + plus));
  }
  return marks;
}

/// The first measured efficiency counts for smaller thrusts too (paper, section III): drawn thinly
/// from where the drone hovers.
void draw_assumed(gp::Plot& plot, const EfficiencyCurve& curve, std::span<const Mark> marks,
                  std::size_t index) {
  const CurvePoint first = curve.front();
  double least = first.thrust;
  for (const Mark& mark : marks) least = std::min(least, mark.thrust);
  if (!(least < first.thrust)) return;
  plot.curve(fmt::format("'+' using ($0 < 1 ? {} : {}):({}) every ::0::1", gp::number(least),
                         gp::number(first.thrust), gp::number(first.efficiency)),
             gp::curve_line(index, 0.5));
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

/// A place in shares of the frame.
struct Place {
  double x = 0;
  double y = 0;
};

/// Numbers at the ends of the curves, each at the nearest place where it covers neither
/// curves nor marks nor other numbers.
class EndNumbers {
 public:
  /// On axes of these ranges, clear of `points`.
  EndNumbers(gp::Range x, gp::Range y, std::span<const CurvePoint> points) : x_(x), y_(y) {
    for (const CurvePoint& point : points) taken_.push_back(share(point));
  }

  /// The label of `curve`, at that end of it where there is more room.
  std::string label(std::size_t tag, const EfficiencyCurve& curve) {
    const auto [right_distance, right] = nearest_free(share(curve.back()));
    const auto [left_distance, left] = nearest_free(share(curve.front()));
    const Place place = left_distance < right_distance ? left : right;
    for (const double dx : {-0.5, 0.0, 0.5}) {
      for (const double dy : {-0.5, 0.0, 0.5}) {
        taken_.push_back({place.x + dx * width, place.y + dy * height});
      }
    }
    return fmt::format("set label {} '{}' at graph {:.4f},{:.4f} center\n", tag, tag, place.x,
                       place.y);
  }

 private:
  // A number of two digits in 7.5 pt in one column.
  static constexpr double width = 0.045;
  static constexpr double height = 0.05;

  [[nodiscard]] Place share(const CurvePoint& point) const {
    return {(point.thrust - x_.lo) / (x_.hi - x_.lo), (point.efficiency - y_.lo) / (y_.hi - y_.lo)};
  }

  [[nodiscard]] bool is_free(Place place) const {
    if (place.x < width || place.x > 1 - width / 2 || place.y < height || place.y > 1 - height) {
      return false;
    }
    return std::ranges::none_of(taken_, [place](Place other) {
      return std::abs(place.x - other.x) < width / 2 + 0.01 &&
             std::abs(place.y - other.y) < height / 2;
    });
  }

  /// How far from `end` the nearest free place is, and which.
  [[nodiscard]] std::pair<double, Place> nearest_free(Place end) const {
    constexpr double farthest = 6;
    for (double distance = 1; distance < farthest; distance += 0.25) {
      for (const double angle : {0.0, -0.6, 0.6, -1.2, 1.2, -1.9, 1.9, -2.5, 2.5, 3.1}) {
        const Place place{end.x + 0.7 * width * distance * std::cos(angle),
                          end.y + 0.7 * height * distance * std::sin(angle)};
        if (is_free(place)) return {distance, place};
      }
    }
    return {farthest, end};
  }

  gp::Range x_;
  gp::Range y_;
  std::vector<Place> taken_;
};

/// Explains the marks, for the legend and for gnuplot's own key.
void explain_marks(gp::Plot& plot, const Requirements& need) {
  const auto explain = [&plot](const char* mark, const std::string& words) {
    plot.points("NaN", fmt::format("lc rgb '{}'{}", colour::black, mark), words);
  };
  explain(circle, "necessary in " + condition_words(need.headroom_at));
  explain(dot, fmt::format("required: {} times that", significant(need.thrust_headroom, 2)));
  explain(plus, "where least power, not headroom, decides");
}

/// A table of the motors with the cross-section and the power of their best tethers, above what
/// the marks mean.
std::vector<gp::LegendEntry> legend_of(std::span<const MotorOptimum> ranking,
                                       std::span<const gp::LegendEntry> plotted) {
  std::vector<gp::LegendEntry> legend{{gp::LegendEntry::Sample::none, "", "", {"mm²", "W"}}};
  legend.insert(legend.end(), plotted.begin(), plotted.end());
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    const Labels labels = labels_of(ranking[i]);
    legend[i + 1].words = name_of(ranking[i], i);
    legend[i + 1].cells = {labels.area, labels.power};
  }
  return legend;
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

}  // namespace

Figure optimum_figure(const std::string& name, const OptimumStudy& study, const AreaCurve& curve) {
  const gp::Range shown{in_mm2(curve.lo), in_mm2(curve.hi)};
  const Curves curves = curves_of(study.design.requirements, curve.points);
  const std::string heading = study.result.feasible ? name : "Cannot fly as required: " + name;
  Figure figure{
      .id = "optimum", .title = heading, .description = description_of(study), .lines = 43};
  const gp::Layout layout(figure.lines);
  figure.script =
      gp::prelude() +
      gp::data_block("curves", {curves.area, curves.available, curves.hover, curves.forward,
                                curves.required, curves.hover_W, curves.forward_W});
  figure.script += gp::set_range("x", shown) + gp::set_range("x2", shown);
  if (curve.logarithmic) figure.script += "set logscale x\nset logscale x2\n";
  figure.script += "set samples 2\nset multiplot\n";

  const gp::Plot thrust = thrust_plot(study, curve.points);
  figure.script += layout.panel(4, 18) + layout.heading(heading) + shading(study, curve);
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

Figure motors_figure(const DesignFile& file, std::span<const MotorOptimum> ranking) {
  constexpr double frame_bottom = 24;
  constexpr double legend_top = 28.2;
  Figure figure{.id = "motors",
                .title = "Motors for " + file.name,
                .description = description_of(ranking),
                .lines = int(legend_top) + 6 + int(ranking.size()),
                .script = gp::prelude()};

  std::vector<EfficiencyCurve> curves;
  std::vector<CurvePoint> points;  // of all curves
  gp::Plot plot;
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    curves.push_back(efficiency_of(motor_in_flight(ranking[i].design)));
    const EfficiencyCurve& curve = curves.back();
    figure.script += gp::data_block(fmt::format("motor{}", i + 1), curve,
                                    {&CurvePoint::thrust, &CurvePoint::efficiency});
    plot.curve(fmt::format("$motor{} using 1:2", i + 1), gp::curve_line(i, 1.3),
               words_of(ranking[i], i));
    points.insert(points.end(), curve.begin(), curve.end());
  }
  std::vector<Mark> marks;
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    const std::vector<Mark> own = marks_of(ranking[i], i);
    draw_assumed(plot, curves[i], own, i);
    marks.insert(marks.end(), own.begin(), own.end());
  }
  for (const Mark& mark : marks) plot.mark(mark.thrust, mark.efficiency, mark.style);
  explain_marks(plot, file.design.requirements);

  const gp::Range thrust{0, 1.08 * gp::extent(gp::column(points, &CurvePoint::thrust)).hi};
  const gp::Range efficiency =
      gp::with_margin(gp::extent(gp::column(points, &CurvePoint::efficiency)), 0.1);
  points.insert(points.end(), marks.begin(), marks.end());
  EndNumbers numbers(thrust, efficiency, points);

  const gp::Layout layout(figure.lines, 0.09, 0.045);
  figure.script += "set samples 2\n" + layout.panel(3.6, frame_bottom) + layout.heading(file.name);
  figure.script += layout.above(2.7, "efficiency (g/W)");
  figure.script += layout.below(26.4, "thrust of one motor (g)");
  figure.script += layout.legend(legend_top, 1, legend_of(ranking, plot.legend()));
  figure.script += gp::set_range("x", thrust) + gp::set_range("y", efficiency);
  for (std::size_t i = 0; i < curves.size(); ++i) figure.script += numbers.label(i + 1, curves[i]);
  figure.script += plot.text();
  return figure;
}

}  // namespace tethercalc
