#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "report/gnuplot_script.hpp"
#include "tethercalc/report/result_figures.hpp"
#include "tethercalc/report/text_table.hpp"

namespace tethercalc {
namespace {

/// A line of the figure.
struct Drawn {
  std::string words;
  const ShapeStudy* study = nullptr;
};

bool differ(std::span<const ShapeRequest> requests, double ShapeRequest::*member) {
  return std::ranges::any_of(
      requests, [&](const ShapeRequest& r) { return r.*member != requests.front().*member; });
}

bool lengths_differ(std::span<const ShapeRequest> requests) {
  return std::ranges::any_of(requests, [&](const ShapeRequest& r) {
    return r.paid_out.length != requests.front().paid_out.length;
  });
}

/// What tells this request from the others, or all of it where there are none.
std::string words_of(std::span<const ShapeRequest> requests, const ShapeRequest& request) {
  const bool winds = differ(requests, &ShapeRequest::wind);
  const bool lengths = lengths_differ(requests);
  std::string out;
  if (winds || !lengths) out += fmt::format("{:g} m/s", request.wind);
  if (lengths || !winds) {
    if (!out.empty()) out += ", ";
    out += request.paid_out.length
               ? significant(*request.paid_out.length, 4) + " m out"
               : significant(*request.paid_out.winch_tension, 3) + " N at the winch";
  }
  return out;
}

/// Around `needed`, as long as `length`.
gp::Range widened(gp::Range needed, double length) {
  const double spare = length - (needed.hi - needed.lo);
  return {needed.lo - 0.5 * spare, needed.hi + 0.5 * spare};
}

gp::Range extent_of(const std::vector<Drawn>& drawn, double Vector3::*member) {
  gp::Range range{0, 0};
  for (const Drawn& one : drawn) {
    for (const CablePoint& p : one.study->shape.points) {
      range = gp::joint(range, {p.position.*member, p.position.*member});
    }
  }
  return range;
}

gp::Plot view(const std::vector<Drawn>& drawn, int column, const Vector3& drone, double across) {
  gp::Plot plot;
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    plot.curve(fmt::format("$cable{} using 1:{}", k, column), gp::curve_line(k, 1.2),
               drawn[k].words);
  }
  plot.mark(0, 0, gp::point(colour::black, 5, 0.8), "station");
  plot.mark(drone.x, across, gp::point(colour::black, 9, 0.9), "drone");
  return plot;
}

}  // namespace

Figure shape_figure(const std::string& name, std::span<const ShapeRequest> requests,
                    std::span<const ShapeStudy> studies) {
  std::vector<Drawn> drawn;
  std::string left_out;
  for (std::size_t k = 0; k < studies.size(); ++k) {
    const std::string words = words_of(requests, requests[k]);
    if (studies[k].outcome == CableOutcome::hangs) {
      drawn.push_back({words, &studies[k]});
    } else {
      left_out += " There is no shape at " + words + ".";
    }
  }
  if (drawn.empty()) throw std::invalid_argument("none of the cables asked for has a shape");

  const gp::Range along = extent_of(drawn, &Vector3::x);
  const gp::Range up = extent_of(drawn, &Vector3::z);
  const gp::Range aside = extent_of(drawn, &Vector3::y);
  const bool from_above = aside.hi - aside.lo > 1e-6 * (up.hi - up.lo);
  const double rows = std::ceil(double(drawn.size() + 2) / 2);
  const double top_of_second = 29.5 + rows;
  Figure figure{.id = "shape",
                .title = "The cable of " + name,
                .description = {},
                .lines = static_cast<int>(from_above ? top_of_second + 13 : 28.8 + rows)};
  const gp::Layout layout(figure.lines, 0.105);
  const double side = layout.shape_of_panel(3.5, 24);
  const double above = layout.shape_of_panel(top_of_second, top_of_second + 9);
  // One scale for all three directions.
  const double width = 1.1 * std::max({along.hi - along.lo, (up.hi - up.lo) / side,
                                       from_above ? (aside.hi - aside.lo) / above : 0.0});

  figure.description = fmt::format(
      "The cable between its station and a drone {} m up and {} m aside, to scale, from the "
      "side{}: "
      "{} shapes.{}",
      significant(requests.front().height, 3), significant(requests.front().offset, 3),
      from_above ? " and from above" : "", drawn.size(), left_out);
  figure.script = gp::prelude();
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    std::vector<double> x;
    std::vector<double> y;
    std::vector<double> z;
    for (const CablePoint& p : drawn[k].study->shape.points) {
      x.push_back(p.position.x);
      y.push_back(p.position.y);
      z.push_back(p.position.z);
    }
    figure.script += gp::data_block(fmt::format("cable{}", k), {x, y, z});
  }
  figure.script += gp::set_range("x", widened(along, width)) + gp::zero_line + "set multiplot\n";
  const Vector3& drone = drawn.front().study->drone;
  const gp::Plot from_side = view(drawn, 3, drone, drone.z);
  figure.script += layout.panel(3.5, 24) + layout.heading(name) +
                   layout.above(2.6, "height over the station (m)") +
                   layout.below(26.6, "to where the drone stands aside (m)") +
                   layout.legend(27.9, 2, from_side.legend()) +
                   gp::set_range("y", widened(up, width * side)) + from_side.text();
  if (from_above) {
    const gp::Plot seen_from_above = view(drawn, 2, drone, drone.y);
    figure.script += layout.panel(top_of_second, top_of_second + 9) + layout.legend(0, 1, {}) +
                     layout.above(top_of_second - 0.9, "from above: to the left of that (m)") +
                     layout.below(top_of_second + 11.6, "to where the drone stands aside (m)") +
                     gp::set_range("y", widened(aside, width * above)) + seen_from_above.text();
  }
  figure.script += "unset multiplot\n";
  return figure;
}

}  // namespace tethercalc
