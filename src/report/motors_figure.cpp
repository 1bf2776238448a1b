#include <algorithm>
#include <array>
#include <cmath>

#include "report/gnuplot_script.hpp"
#include "tethercalc/report/design_sentences.hpp"
#include "tethercalc/report/result_figures.hpp"

namespace tethercalc {
namespace {

/// Colour and dashes together tell 35 motors apart; beyond, numbers alone do.
std::string style_of(std::size_t index, double width = 1.3) {
  constexpr std::array colours{colour::blue,   colour::vermilion, colour::green, colour::orange,
                               colour::purple, colour::sky,       colour::black};
  return gp::line(colours[index % colours.size()], int(index % 5) + 1, width);
}

std::string dot_colour(std::size_t index) {
  const std::string style = style_of(index);
  return style.substr(0, style.find(" dt"));
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
  const MotorCurve& curve = motor.design.drone.motor;
  const AreaPoints points = motor.points();
  const std::string colour = dot_colour(index);
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
             style_of(index, 0.5));
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
  const OperatingPoint judged = motor.points().in(motor.design.requirements.power_at);
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
    return std::none_of(taken_.begin(), taken_.end(), [place](Place other) {
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
    curves.push_back(efficiency_of(ranking[i].design.drone.motor));
    const EfficiencyCurve& curve = curves.back();
    figure.script += gp::data_block(fmt::format("motor{}", i + 1), curve,
                                    {&CurvePoint::thrust, &CurvePoint::efficiency});
    plot.curve(fmt::format("$motor{} using 1:2", i + 1), style_of(i), words_of(ranking[i], i));
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
