// What a design does at given cross-sections, which of them to fly, and what is told beside it; the
// same for a choice of motors.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tethercalc/model/demands.hpp"
#include "tethercalc/solve/headroom.hpp"
#include "tethercalc/solve/optimize.hpp"
#include "tethercalc/solve/remedies.hpp"
#include "tethercalc/study/cable_shape.hpp"

namespace tethercalc {

/// Both conditions at each of `areas` (m², > 0).
[[nodiscard]] std::vector<AreaPoints> evaluate_areas(const Design& design,
                                                     std::span<const double> areas,
                                                     ConductorsAsked asked = ConductorsAsked::many);

/// The same, of what does not hang up to the drone with the reason, `AreaPoints::no_way`.
[[nodiscard]] std::vector<AreaPoints> evaluate_areas_to_tell(const Design& design,
                                                             std::span<const double> areas);

/// What cables of given cross-sections do.
struct EvaluationStudy {
  std::vector<AreaPoints> table;        ///< in the order in which they were asked for
  std::optional<GroundContact> ground;  ///< of the first that lies on the ground
  std::optional<WorstSide> side;        ///< of the first that is flown
};

/// Evaluates the design at each of `areas` (m², > 0).
[[nodiscard]] EvaluationStudy study_evaluation(const Design& design, std::span<const double> areas);

/// A size in which conductors are sold.
struct WireSize {
  std::string standard;  ///< "AWG", "IEC 60228" or "VDE 0295"
  std::string name;      ///< "AWG 17", "1.5 mm²"
  double area = 0;       ///< m²
};

/// Neighbours of an area among the sizes of one standard. Both are the same where it is one of
/// them.
struct WireNeighbours {
  std::string standard;           ///< as in WireSize
  std::optional<WireSize> below;  ///< the largest not above the area
  std::optional<WireSize> above;  ///< the smallest not below it
};

/// The neighbours of `area` in m² (finite, ≥ 0) in each standard of `sizes`, which rise.
[[nodiscard]] std::vector<WireNeighbours> wire_sizes_near(std::span<const WireSize> sizes,
                                                          double area);

/// m², of conductors that drones are often fed by.
inline constexpr double usual_area = 1e-6;

/// Why a design has no optimum.
struct Refusal {
  Limit limit = Limit::available_power;    ///< what no cross-section keeps
  Condition condition = Condition::hover;  ///< where
  BestHeadroom best;              ///< the most there, for limits of power, weight, thrust and tilt
  bool converter_caps = false;    ///< whether the converter's rating, not the line, allows no more
  bool thicker_overheat = false;  ///< whether a slightly thicker cable has no steady temperature
  /// Of `Limit::tether_shape`, by `optimum_of`: with `usual_area`, or beside that of the most
  /// headroom where such a tether hangs.
  std::optional<NoWayUp> no_way{};
};

/// Of a `result` that is infeasible.
[[nodiscard]] Refusal refusal_of(const Design& design, const Optimization& result);

/// A conductor that can be bought, or the one of the design.
struct SizePoints {
  std::string name;   ///< "AWG 17"; "as specified" for `tether.cross_section`
  AreaPoints points;  ///< what it would give
};

/// A design with its optimum, or with what stands in its way.
struct DesignOptimum {
  Design design;                   ///< as asked about
  Optimization result;             ///< the optimum
  std::optional<Refusal> refusal;  ///< why there is none
  BestHeadroom best_headroom;      ///< at `requirements.headroom_at`
};

/// Optimises the design.
[[nodiscard]] DesignOptimum optimum_of(const Design& design);

/// The optimum of a design and what is told beside it.
struct OptimumStudy : DesignOptimum {
  std::vector<SizePoints> sizes;  ///< neighbours of the optimum in each standard, by rising area
  std::vector<AreaPoints> table;  ///< by rising area; holds optimum, minimum and feasible edges
  std::vector<Remedy> remedies;   ///< for an infeasible design
  std::vector<FlownShape> cable;  ///< how the optimum hangs, see `shapes_in_flight`
  std::optional<WorstSide> side;  ///< of the optimum
};

/// Optimises the design; `sizes` (rising) are those that can be bought.
[[nodiscard]] OptimumStudy study_optimum(const Design& design, std::span<const WireSize> sizes);

/// A design over the cross-sections of interest, for drawing.
struct AreaCurve {
  double lo = 1e-8;                ///< m², the least shown
  double hi = 1e-5;                ///< m², the largest
  bool logarithmic = true;         ///< what matters is spread too widely for a linear axis
  std::vector<AreaPoints> points;  ///< rising, 240 and those at which something is marked
};

/// Around optimum, least power, edges and the cable of the design.
[[nodiscard]] AreaCurve area_curve(const OptimumStudy& study);

/// One motor's best tether.
struct MotorOptimum : DesignOptimum {
  MotorEntry motor;                     ///< as given, and in `design`
  std::optional<GroundContact> ground;  ///< of the optimum
  std::optional<WorstSide> side;        ///< of the optimum
};

/// The design with each of `motors` in turn, feasible ones first by rising power, infeasible ones
/// last by falling best headroom.
[[nodiscard]] std::vector<MotorOptimum> compare_motors(const Design& design,
                                                       std::vector<MotorEntry> motors);

/// A design as a page shows it.
struct DesignOverview {
  OptimumStudy optimum;              ///< the answer
  AreaCurve curve;                   ///< that `area_curve` makes of it
  std::vector<MotorOptimum> motors;  ///< a ranking of `compare_motors`
};

/// All of that; `sizes` as in `study_optimum`.
[[nodiscard]] DesignOverview study_overview(const Design& design, std::span<const WireSize> sizes,
                                            std::vector<MotorEntry> motors);

}  // namespace tethercalc
