#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "report/figure_data.hpp"
#include "tethercalc/report/cable_report.hpp"
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
  if (winds || !lengths) out += fmt::format("{:.4g} m/s", request.wind);
  if (lengths || !winds) {
    if (!out.empty()) out += ", ";
    out += request.paid_out.length
               ? significant(*request.paid_out.length, 4) + " m out"
               : significant(*request.paid_out.winch_tension, 3) + " N at the winch";
  }
  return out;
}

plot::Range extent_of(const std::vector<Drawn>& drawn, double Vector3::*member) {
  plot::Range range{0, 0};
  for (const Drawn& one : drawn) {
    for (const CablePoint& p : one.study->shape.points) {
      range = plot::joint(range, {p.position.*member, p.position.*member});
    }
  }
  return range;
}

/// The cables in the plane of `x` and another direction.
plot::Panel view(const std::vector<Drawn>& drawn, double Vector3::*member, bool legend) {
  plot::Panel panel{
      .x = {.label = "to where the drone stands aside (m)", .range = extent_of(drawn, &Vector3::x)},
      .y = {.range = extent_of(drawn, member)},
      .layers = {plot::zero_line()}};
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    plot::Curve curve{.colour = plot::curve_colour(k),
                      .dash = plot::curve_dash(k),
                      .width = 1.2,
                      .words = legend ? drawn[k].words : ""};
    for (const CablePoint& p : drawn[k].study->shape.points) {
      curve.x.push_back(p.position.x);
      curve.y.push_back(p.position.*member);
    }
    panel.layers.push_back(std::move(curve));
  }
  const auto mark = [&](double x, double y, plot::Mark shape, const char* words) {
    panel.layers.push_back(
        plot::Points{.x = {x}, .y = {y}, .mark = shape, .words = legend ? words : ""});
  };
  const Vector3& drone = drawn.front().study->drone;
  mark(0, 0, plot::Mark::square, "station");
  mark(drone.x, drone.*member, plot::Mark::triangle, "drone");
  panel.x.range = plot::with_margin(panel.x.range);
  panel.y.range = plot::with_margin(panel.y.range);
  return panel;
}

}  // namespace

std::vector<std::string> undrawn_sentences(std::span<const ShapeRequest> requests,
                                           std::span<const ShapeStudy> studies) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < studies.size(); ++k) {
    if (studies[k].outcome == CableOutcome::hangs) continue;
    out.push_back("at " + words_of(requests, requests[k]) + ": " +
                  no_shape_sentence(studies[k], requests[k]));
  }
  return out;
}

Figure shape_figure(const std::string& name, std::span<const ShapeRequest> requests,
                    std::span<const ShapeStudy> studies) {
  std::vector<Drawn> drawn;
  for (std::size_t k = 0; k < studies.size(); ++k) {
    if (studies[k].outcome == CableOutcome::hangs) {
      drawn.push_back({words_of(requests, requests[k]), &studies[k]});
    }
  }
  std::string left_out;
  for (const std::string& sentence : undrawn_sentences(requests, studies)) {
    left_out += " There is no shape " + sentence;
  }
  if (drawn.empty()) throw std::invalid_argument("none of the cables asked for has a shape");

  const plot::Range up = extent_of(drawn, &Vector3::z);
  const plot::Range aside = extent_of(drawn, &Vector3::y);
  const bool from_above = aside.hi - aside.lo > 1e-6 * (up.hi - up.lo);
  Figure figure{.id = "shape", .title = "The cable of " + name, .heading = name, .to_scale = true};
  figure.description = fmt::format(
      "The cable between its station and a drone {} m up and {} m aside, to scale, from the "
      "side{}: "
      "{} shapes.{}",
      significant(requests.front().height, 3), significant(requests.front().offset, 3),
      from_above ? " and from above" : "", drawn.size(), left_out);
  plot::Panel side = view(drawn, &Vector3::z, true);
  side.y.label = "height over the station (m)";
  side.lines = 20.5;
  figure.parts.emplace_back(std::move(side));
  if (from_above) {
    plot::Panel above = view(drawn, &Vector3::y, false);
    above.y.label = "from above: to the left of that (m)";
    above.lines = 9;
    figure.parts.emplace_back(std::move(above));
  }
  return figure;
}

}  // namespace tethercalc
