#include "tethercalc/study/optimum.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "tethercalc/model/steady_flight.hpp"

namespace tethercalc {
namespace {

/// `value` rounded to two significant digits.
double rounded(double value) {
  const double step = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return std::round(value / step) * step;
}

/// The finite, positive ones of `areas`.
std::vector<double> existing(std::vector<double> areas) {
  std::erase_if(areas, [](double area) { return !(std::isfinite(area) && area > 0); });
  return areas;
}

/// The optimum or, where there is none, the area that comes closest.
double central_area(const OptimumStudy& study) {
  return study.result.feasible ? study.result.area : study.best_headroom.area;
}

/// Round areas around what matters, and what matters itself, rising.
std::vector<double> table_areas(const OptimumStudy& study) {
  std::vector<double> areas{central_area(study), study.result.minimum_power.area};
  for (const Interval& range : study.result.feasible_areas) {
    areas.push_back(range.lo);
    areas.push_back(range.hi);
  }
  areas = existing(std::move(areas));
  if (areas.empty()) return areas;
  const auto [least, most] = std::ranges::minmax_element(areas);
  const double from = 0.5 * *least;
  const double to = 1.5 * *most;
  constexpr int steps = 12;
  for (int i = 0; i <= steps; ++i) {
    const double area = from * std::pow(to / from, double(i) / steps);
    areas.push_back(rounded(area / unit::square_millimetre) * unit::square_millimetre);
  }
  std::ranges::sort(areas);
  const auto same = [](double a, double b) { return b - a <= 1e-9 * b; };
  areas.erase(std::unique(areas.begin(), areas.end(), same), areas.end());
  return areas;
}

/// The sizes below and above `area` in each standard, and the cable of the design.
std::vector<SizePoints> sizes_near(const Design& design, double area,
                                   std::span<const WireSize> sizes) {
  std::vector<SizePoints> near;
  const auto add = [&](const std::string& name, double size) {
    near.push_back({name, evaluate_areas_to_tell(design, std::span(&size, 1)).front()});
  };
  if (std::isfinite(area)) {
    // The end of a short standard is no neighbour; it counts where no standard goes further.
    std::vector<WireNeighbours> standards = wire_sizes_near(sizes, area);
    const auto brackets = [](const WireNeighbours& s) { return s.below && s.above; };
    if (std::ranges::any_of(standards, brackets)) {
      std::erase_if(standards, std::not_fn(brackets));
    }
    for (const WireNeighbours& standard : standards) {
      for (const auto& size : {standard.below, standard.above}) {
        if (size) add(size->name, size->area);
      }
    }
  }
  if (design.tether.cross_section) add("as specified", *design.tether.cross_section);
  std::ranges::stable_sort(near, {}, [](const SizePoints& size) { return size.points.area; });
  const auto same = [](const SizePoints& a, const SizePoints& b) { return a.name == b.name; };
  near.erase(std::unique(near.begin(), near.end(), same), near.end());
  return near;
}

/// Cross-sections that the reader of a curve looks for.
std::vector<double> landmarks(const OptimumStudy& study) {
  std::vector<double> areas{central_area(study), study.result.minimum_power.area};
  for (const Interval& range : study.result.feasible_areas) areas.push_back(range.lo);
  if (study.design.tether.cross_section) areas.push_back(*study.design.tether.cross_section);
  return existing(std::move(areas));
}

/// What of the cross-sections is shown.
AreaCurve curve_around(const std::vector<double>& areas, const IntervalSet& feasible) {
  if (areas.empty()) return {};  // nothing flies: the sizes that tethers have
  const auto [least, most] = std::ranges::minmax_element(areas);
  constexpr double most_on_a_linear_axis = 8;
  if (*most > most_on_a_linear_axis * *least) return {*least / 2.5, *most * 2.5, true, {}};
  double hi = 2.2 * *most;
  // An upper edge of the feasible range is shown unless it would crowd the rest.
  for (const Interval& range : feasible) {
    if (range.hi < 4 * *most) hi = std::max(hi, 1.15 * range.hi);
  }
  return {0, hi, false, {}};
}

/// Whether the thrust available at `area` is what the converter's rating leaves of the line's.
bool converter_caps(const Design& design, Condition condition, double area) {
  const Converter& converter = design.supply.converter;
  if (!converter.rated_output_power) return false;
  const double arriving = evaluate(design, area, condition).available_power;
  // At the best of all areas the line gives just as much, but for the refinement of that area.
  return converter_output_power(converter, arriving - design.drone.auxiliary_power) >
         *converter.rated_output_power * (1 - 1e-3);
}

}  // namespace

std::vector<AreaPoints> evaluate_areas(const Design& design, std::span<const double> areas,
                                       ConductorsAsked asked) {
  const SteadyFlight hover(design, Condition::hover, asked);
  const SteadyFlight forward(design, Condition::forward, asked);
  std::vector<AreaPoints> table;
  for (const double area : areas) {
    AreaPoints points{area, evaluate(hover, area), evaluate(forward, area), {}};
    points.worst = demand_margins(design, points.hover, points.forward).worst();
    table.push_back(points);
  }
  return table;
}

std::vector<AreaPoints> evaluate_areas_to_tell(const Design& design,
                                               std::span<const double> areas) {
  std::vector<AreaPoints> table = evaluate_areas(design, areas);
  for (AreaPoints& points : table) {
    const DemandMargin& missed = points.worst;
    if (missed.met() || missed.demand != Demand::tether_shape) continue;
    points.no_way = no_way_up(design, points.area, missed.condition);
  }
  return table;
}

EvaluationStudy study_evaluation(const Design& design, std::span<const double> areas) {
  EvaluationStudy study{evaluate_areas_to_tell(design, areas), {}, {}};
  for (const double area : areas) {
    study.side = worst_side(design, area);
    if (study.side) break;
  }
  for (const double area : areas) {
    study.ground = ground_contact(area, shapes_in_flight(design, area));
    if (study.ground) break;
  }
  return study;
}

std::vector<WireNeighbours> wire_sizes_near(std::span<const WireSize> sizes, double area) {
  std::vector<WireNeighbours> all;
  for (const WireSize& size : sizes) {
    auto near = std::ranges::find(all, size.standard, &WireNeighbours::standard);
    if (near == all.end()) near = all.insert(all.end(), {size.standard, {}, {}});
    if (size.area <= area) near->below = size;
    if (size.area >= area && !near->above) near->above = size;
  }
  return all;
}

Refusal refusal_of(const Design& design, const Optimization& result) {
  Refusal refusal;
  refusal.limit = result.limited_by;
  refusal.condition = result.limiting_condition;
  switch (result.limited_by) {
    case Limit::conductor_temperature:
    case Limit::tether_strength:
    case Limit::converter_rating:
    case Limit::input_voltage:
    case Limit::tether_shape:
    case Limit::drum_width:
      return refusal;
    default:
      refusal.best = result.best_headroom;
  }
  if (!(refusal.best.value > 0)) return refusal;
  constexpr double slightly = 1.01;
  refusal.converter_caps = converter_caps(design, refusal.condition, refusal.best.area);
  refusal.thicker_overheat =
      evaluate(design, slightly * refusal.best.area, refusal.condition).thermal_runaway;
  return refusal;
}

namespace {

/// What keeps a tether that hangs with conductors of `area` from hanging with others beside it.
NoWayUp no_way_beside(const Design& design, double area, Condition condition) {
  constexpr double little = 1.01;
  const NoWayUp thicker = no_way_up(design, area * little, condition);
  if (thicker.outcome != CableOutcome::hangs) return thicker;
  return no_way_up(design, area / little, condition);
}

}  // namespace

DesignOptimum optimum_of(const Design& design) {
  DesignOptimum optimum{design, optimize(design), {}, {}};
  Optimization& result = optimum.result;
  const Condition where = result.limiting_condition;
  const bool no_way = result.limited_by == Limit::tether_shape;
  if (!result.feasible) {
    optimum.refusal = refusal_of(design, result);
    if (no_way) {
      std::optional<NoWayUp>& told = optimum.refusal->no_way;
      told = no_way_up(design, usual_area, where);
      if (told->outcome == CableOutcome::hangs) {
        told = no_way_beside(design, result.best_headroom.area, where);
      }
    }
  } else if (no_way) {
    result.no_way = no_way_beside(design, result.area, where);
  }
  optimum.best_headroom = best_headroom(design, design.requirements.headroom_at);
  return optimum;
}

OptimumStudy study_optimum(const Design& design, std::span<const WireSize> sizes) {
  OptimumStudy study{optimum_of(design), {}, {}, {}, {}, {}};
  study.table = evaluate_areas_to_tell(design, table_areas(study));
  study.sizes = sizes_near(design, central_area(study), sizes);
  if (study.refusal) study.remedies = remedies(design);
  study.cable = shapes_in_flight(design, study.result.area);
  study.side = worst_side(design, study.result.area);
  return study;
}

AreaCurve area_curve(const OptimumStudy& study) {
  std::vector<double> areas = landmarks(study);
  AreaCurve curve = curve_around(areas, study.result.feasible_areas);
  constexpr int samples = 240;  // a point every third of a millimetre of a column
  for (int i = 0; i <= samples; ++i) {
    const double share = double(i) / samples;
    const double area = curve.logarithmic ? curve.lo * std::pow(curve.hi / curve.lo, share)
                                          : curve.lo + (curve.hi - curve.lo) * share;
    if (area > 0) areas.push_back(area);
  }
  std::ranges::sort(areas);
  curve.points = evaluate_areas(study.design, areas);
  return curve;
}

std::vector<MotorOptimum> compare_motors(const Design& design, std::vector<MotorEntry> motors) {
  std::vector<MotorOptimum> ranking;
  for (MotorEntry& motor : motors) {
    Design with_motor = design;
    with_motor.drone.motor = motor.curve;
    MotorOptimum& entry =
        ranking.emplace_back(MotorOptimum{optimum_of(with_motor), std::move(motor), {}, {}});
    const double area = entry.result.area;
    entry.ground = ground_contact(area, shapes_in_flight(with_motor, area));
    entry.side = worst_side(with_motor, area);
  }
  std::ranges::stable_sort(ranking, {}, [&](const MotorOptimum& entry) {
    return entry.result.feasible
               ? std::pair(false, entry.result.in(design.requirements.power_at).total_power)
               : std::pair(true, -entry.best_headroom.value);
  });
  return ranking;
}

DesignOverview study_overview(const Design& design, std::span<const WireSize> sizes,
                              std::vector<MotorEntry> motors) {
  DesignOverview overview{study_optimum(design, sizes), {}, {}};
  overview.curve = area_curve(overview.optimum);
  overview.motors = compare_motors(design, std::move(motors));
  return overview;
}

}  // namespace tethercalc
