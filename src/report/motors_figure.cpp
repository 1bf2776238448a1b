#include <algorithm>
#include <array>
#include <cmath>

#include "report/gnuplot_script.hpp"
#include "tethercalc/report/design_figures.hpp"

namespace tethercalc {
namespace {

namespace gp = gnuplot;
namespace colour = gnuplot::colour;

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

/// Efficiency over thrust, as far as it was measured: thrust in g, efficiency in g/W.
struct EfficiencyCurve {
  std::vector<double> thrust;
  std::vector<double> efficiency;
};

double efficiency_at(const MotorCurve& curve, double thrust) {
  return thrust / unit::gram_force / curve.power(thrust);
}

EfficiencyCurve efficiency_of(const MotorCurve& curve) {
  EfficiencyCurve out;
  const auto vertices = curve.vertices();
  // Power is straight between the points, efficiency is not.
  constexpr int steps = 12;
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    const double from = i == 1 ? vertices[1].thrust : vertices[i - 1].thrust;
    for (int k = i == 1 ? steps : 1; k <= steps; ++k) {
      const double thrust = from + (vertices[i].thrust - from) * k / steps;
      out.thrust.push_back(thrust / unit::gram_force);
      out.efficiency.push_back(efficiency_at(curve, thrust));
    }
  }
  return out;
}

void mark_at(gp::Plot& plot, const MotorCurve& curve, double thrust, const std::string& style) {
  const double shown = std::min(thrust, curve.max_thrust());
  plot.mark(shown / unit::gram_force, efficiency_at(curve, shown), style);
}

/// Circle, dot and plus of the paper's figure on motors.
void mark_optimum(gp::Plot& plot, const MotorOptimum& motor, std::size_t index) {
  if (!motor.result.feasible) return;
  const Requirements& need = motor.design.requirements;
  const MotorCurve& curve = motor.design.drone.motor;
  const auto at = [&](Condition condition) -> const OperatingPoint& {
    return condition == Condition::hover ? motor.result.hover : motor.result.forward;
  };
  const std::string colour = dot_colour(index);
  const double necessary = at(need.headroom_at).necessary_thrust;
  mark_at(plot, curve, necessary, colour + " pt 6 ps 0.8*dot_scale lw 1.4");
  mark_at(plot, curve, need.thrust_headroom * necessary, colour + " pt 7 ps 0.6*dot_scale");
  if (motor.result.limited_by == Limit::minimum_power) {
    mark_at(plot, curve, at(need.power_at).necessary_thrust,
            colour + " pt 1 ps 0.9*dot_scale lw 1.4");
  }
}

std::string words_of(const MotorOptimum& motor, std::size_t index) {
  const std::string name = motor.motor.name.empty() ? motor.motor.id : motor.motor.name;
  if (!motor.result.feasible) return fmt::format("{} {}: infeasible", index + 1, name);
  const bool by_hover = motor.design.requirements.power_at == Condition::hover;
  const OperatingPoint& judged = by_hover ? motor.result.hover : motor.result.forward;
  return fmt::format("{} {}: {} mm², {} W", index + 1, name,
                     significant(motor.result.area / unit::square_millimetre, 3),
                     fixed(judged.total_power, 0));
}

/// Numbers at the right ends of the curves, moved up where they would cover another one.
std::string end_numbers(std::span<const EfficiencyCurve> curves, gp::Range x, gp::Range y) {
  std::string out;
  struct Place {
    double x, y;
  };
  std::vector<Place> taken;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    // In shares of the frame.
    Place place{(curves[i].thrust.back() - x.lo) / (x.hi - x.lo) + 0.012,
                (curves[i].efficiency.back() - y.lo) / (y.hi - y.lo)};
    const auto covered = [&place](const Place& other) {
      return std::abs(place.x - other.x) < 0.035 && std::abs(place.y - other.y) < 0.05;
    };
    while (std::any_of(taken.begin(), taken.end(), covered)) place.y -= 0.01;
    taken.push_back(place);
    out += fmt::format("set label {} '{}' at graph {:.4f},{:.4f} left\n", i + 200, i + 1, place.x,
                       place.y);
  }
  return out;
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
  Figure figure;
  figure.id = "motors";
  figure.title = "Motors for " + file.name;
  figure.description = description_of(ranking);
  constexpr double frame_bottom = 24;
  constexpr double legend_top = 28.2;
  figure.lines = int(legend_top) + 5 + int(ranking.size());
  figure.script = gp::prelude();

  std::vector<EfficiencyCurve> curves;
  std::vector<double> thrusts{0};
  std::vector<double> efficiencies;
  gp::Plot plot;
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    curves.push_back(efficiency_of(ranking[i].design.drone.motor));
    const EfficiencyCurve& curve = curves.back();
    figure.script +=
        gp::data_block(fmt::format("motor{}", i + 1), {curve.thrust, curve.efficiency});
    plot.curve(fmt::format("$motor{} using 1:2", i + 1), style_of(i), words_of(ranking[i], i));
    thrusts.push_back(curve.thrust.back());
    efficiencies.insert(efficiencies.end(), curve.efficiency.begin(), curve.efficiency.end());
  }
  for (std::size_t i = 0; i < ranking.size(); ++i) mark_optimum(plot, ranking[i], i);

  const gp::Range thrust{0, 1.06 * gp::extent(thrusts).hi};
  const auto [least, most] = gp::extent(efficiencies);
  const gp::Range efficiency = gp::with_margin(least, most, 0.06);
  const gp::Layout layout(figure.lines, 0.09);
  figure.script += "set samples 2\n" + layout.panel(4, frame_bottom) + layout.heading(file.name);
  figure.script += layout.above(2.8, "efficiency (g/W)");
  figure.script += layout.below(26.4, "thrust of one motor (g)");
  std::vector<gp::LegendEntry> legend(plot.legend().begin(), plot.legend().end());
  const auto explain = [&legend](const char* style, const std::string& words) {
    legend.push_back({gp::LegendEntry::Sample::point,
                      fmt::format("lc rgb '{}' {}", colour::black, style), words});
  };
  if (!ranking.empty()) {
    const Requirements& need = ranking.front().design.requirements;
    const char* where = need.headroom_at == Condition::hover ? "hover" : "forward flight";
    explain("pt 6 ps 0.8*dot_scale lw 1.4", fmt::format("necessary in {}", where));
    explain("pt 7 ps 0.6*dot_scale",
            fmt::format("required: {} times that", significant(need.thrust_headroom, 2)));
    explain("pt 1 ps 0.9*dot_scale lw 1.4", "where least power, not headroom, decides");
  }
  figure.script += layout.legend(legend_top, 1, legend);
  figure.script += gp::set_range("x", thrust) + gp::set_range("y", efficiency);
  figure.script += end_numbers(curves, thrust, efficiency);
  figure.script += plot.text();
  return figure;
}

}  // namespace tethercalc
