#include "tethercalc/study/design.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "model/constants.hpp"

namespace tethercalc {
namespace {

/// A constraint closer than this to its bound, relative, binds.
constexpr double binding = 1e-6;

/// Whether the conductor of least power, which a candidate without a cross-section flies, is the
/// best one: where its power is what is minimised, and no demand of the user judges its flight.
bool least_power_is_best(const DesignQuestion& question) {
  const DesignProblem& problem = question.problem;
  const auto* objective = std::get_if<PointQuantity>(&problem.objective);
  const auto of_fields = [](const UserLimit& limit) { return limit.quantity.index() == 1; };
  if (objective == nullptr || objective->member != &OperatingPoint::total_power || question.front ||
      !std::ranges::all_of(problem.limits, of_fields)) {
    return false;
  }
  return !objective->condition || (!problem.frees("requirements.power_at") &&
                                   *objective->condition == problem.base.requirements.power_at);
}

/// Frees the cross-section where it is neither given nor free and has to be searched.
DesignProblem with_cross_section(const DesignQuestion& question) {
  DesignProblem problem = question.problem;
  if (problem.base.tether.cross_section || problem.frees(cross_section_path) ||
      least_power_is_best(question)) {
    return problem;
  }
  // From below AWG 36 to what no drone lifts.
  problem.free.push_back(
      {std::string(cross_section_path), Uniform{0.01, 100},
       [](Design& d, double mm2) { d.tether.cross_section = mm2 * unit::square_millimetre; }});
  return problem;
}

/// A field that is moved: to give way to a demand that binds, or to see what it costs.
struct Movable {
  std::string_view path;       ///< of the field
  double* (*field)(Design&);   ///< where it stands, in SI
  double si_factor = 1;        ///< SI value of the field's unit
  double step = 1;             ///< in that unit
  bool step_is_share = false;  ///< of the field's value

  [[nodiscard]] double step_of(Design design) const {
    return step_is_share ? step * *field(design) : step;
  }
};

constexpr Movable fields[] = {
    {"tether.length_m", [](Design& d) { return &d.tether.length; }},
    {"drone.mass_g", [](Design& d) { return &d.drone.mass; }, unit::gram, 100},
    {"supply.voltage_V", [](Design& d) { return &d.supply.voltage; }},
};

constexpr Movable rated_temperature{
    "tether.insulation.material.rated_temperature_C",
    [](Design& d) { return &*d.tether.insulation.rated_temperature_C; }};

/// What gives way to which demand.
constexpr std::pair<Demand, Movable> relaxations[] = {
    {Demand::max_pitch,
     {"requirements.max_pitch_deg", [](Design& d) { return &d.requirements.max_pitch; },
      unit::degree}},
    {Demand::thrust_headroom,
     {"requirements.thrust_headroom", [](Design& d) { return &d.requirements.thrust_headroom; }, 1,
      -0.01}},
    {Demand::conductor_temperature, rated_temperature},
    {Demand::drum_temperature, rated_temperature},
    {Demand::tether_strength,
     {"requirements.strength_safety_factor",
      [](Design& d) { return &d.requirements.strength_safety_factor; }, 1, -0.01, true}},
    {Demand::converter_rating,
     {"supply.converter.rated_output_W",
      [](Design& d) { return &*d.supply.converter.rated_output_power; }, 1, 0.01, true}},
    {Demand::drum_width,
     {"tether.drum.width_mm", [](Design& d) { return &d.tether.drum.width; }, unit::millimetre}},
    {Demand::input_voltage,
     {"supply.converter.max_input_voltage_V",
      [](Design& d) { return &*d.supply.converter.max_input_voltage; }, 1, 0.01, true}}};

/// Whether anything gives way: level flight does not, nor the least input of a converter.
bool is_negotiable(const Design& design, const DemandMargin& margin) {
  if (margin.demand == Demand::thrust_headroom) {
    return is_headroom_demanded(design.requirements, margin.condition);
  }
  return margin.demand != Demand::input_voltage || design.supply.converter.max_input_voltage;
}

/// The prices of one study: each the least objective after a change, less that before it.
class Prices {
 public:
  Prices(const DesignProblem& problem, const DesignAnswer& answer, const MinimumOptions& search)
      : problem_(problem), answer_(answer), search_(search) {}

  std::vector<ShadowPrice> all() {
    for (std::size_t i = 0; i < problem_.limits.size(); ++i) add_limit(i);
    for (std::size_t i = 0; i < problem_.free.size(); ++i) add_range_end(i);
    add_demands();
    for (const Movable& field : fields) add_moved({Priced::field}, field, problem_.base);
    return std::move(prices_);
  }

 private:
  void add_limit(std::size_t i) {
    const UserLimit& limit = problem_.limits[i];
    const double value = quantity_of(answer_.best, limit.quantity);
    if (std::abs(value - limit.bound) > binding * limit.scale()) return;
    DesignProblem changed = problem_;
    ShadowPrice price{Priced::limit};
    price.name = limit.name;
    price.step = limit.sign * 0.01 * limit.scale();
    changed.limits[i].bound += price.step;
    add(std::move(price), changed);
  }

  void add_range_end(std::size_t i) {
    const SweepAxis& axis = problem_.free[i];
    const auto* range = std::get_if<Uniform>(&axis.values);
    if (range == nullptr || !(range->hi > range->lo)) return;
    const double share = VariableRange{range->lo, range->hi}.share_of(answer_.values[i]);
    const bool at_lo = share <= binding;
    const bool at_hi = share >= 1 - binding;
    if (!at_lo && !at_hi) return;
    const double end = at_lo ? range->lo : range->hi;
    DesignProblem changed = problem_;
    ShadowPrice price{Priced::range_end, !at_lo};
    price.name = axis.name;
    price.step = (at_lo ? -0.01 : 0.01) * std::abs(end);
    auto& moved = std::get<Uniform>(changed.free[i].values);
    (at_lo ? moved.lo : moved.hi) += price.step;
    if (price.step != 0 && allowed(axis, end + price.step)) add(std::move(price), changed);
  }

  /// Whether the field may have that value at all.
  bool allowed(const SweepAxis& axis, double value) const {
    try {
      Design design = problem_.base;
      axis.apply(design, value);
      return true;
    } catch (const std::invalid_argument&) {
      return false;
    }
  }

  /// The demands of the design that bind, each once.
  void add_demands() {
    const Candidate& best = answer_.best;
    std::vector<std::string_view> told;
    for (const DemandMargin& margin : demand_margins(best.design, best.hover, best.forward)) {
      if (margin.value > binding || !is_negotiable(best.design, margin)) continue;
      for (const auto& [demand, way] : relaxations) {
        if (demand != margin.demand || std::ranges::count(told, way.path) > 0) continue;
        told.push_back(way.path);
        add_moved({Priced::demand, false, demand}, way, best.design);
      }
    }
  }

  void add_moved(ShadowPrice price, const Movable& movable, const Design& design) {
    if (problem_.frees(movable.path)) return;
    price.name = movable.path;
    price.step = movable.step_of(design);
    DesignProblem changed = problem_;
    // Last, so that no material or motor chosen undoes it.
    changed.free.push_back(
        {price.name, std::vector<double>{price.step}, [&movable](Design& d, double step) {
           *movable.field(d) += step * movable.si_factor;
           if (movable.field(d) == &d.drone.mass) renew_drag_estimate(d.drone);
         }});
    add(std::move(price), changed);
  }

  void add(ShadowPrice price, const DesignProblem& changed) {
    const double least = answer_.minimum.value;
    const DesignAnswer after = search_design(changed, search_);
    price.price = after.feasible ? after.minimum.value - least : nan;
    // What two searches may differ by.
    constexpr double noise = 1e-9;
    if (std::abs(price.price) <= noise * std::abs(least)) {
      if (!price.active()) return;
      price.price = 0;
    }
    prices_.push_back(std::move(price));
  }

  const DesignProblem& problem_;
  const DesignAnswer& answer_;
  const MinimumOptions& search_;
  std::vector<ShadowPrice> prices_;
};

std::vector<FrontPoint> pareto_front(DesignProblem problem,
                                     const std::array<CandidateQuantity, 2>& wanted,
                                     const MinimumOptions& search) {
  std::vector<FrontPoint> front;
  const CandidateQuantity& first = wanted[0];
  const CandidateQuantity& second = wanted[1];
  problem.objective = first;
  const DesignAnswer best_first = search_design(problem, search);
  problem.objective = second;
  const DesignAnswer best_second = search_design(problem, search);
  if (!best_first.feasible || !best_second.feasible) return front;
  const auto add = [&](const DesignAnswer& answer) {
    const double one = quantity_of(answer.best, first);
    const double other = quantity_of(answer.best, second);
    if (!front.empty() && std::abs(front.back().second - other) <= 1e-6 * std::abs(other)) return;
    front.push_back({one, other, answer.values});
  };
  add(best_first);
  const double from = quantity_of(best_first.best, second);
  const double to = quantity_of(best_second.best, second);
  constexpr int points = 10;
  problem.objective = first;
  problem.limits.push_back({"", second, from, 1});
  for (int i = 1; i <= points; ++i) {
    problem.limits.back().bound = from + (to - from) * i / points + 1e-9 * std::abs(to);
    const DesignAnswer answer = search_design(problem, search);
    if (answer.feasible) add(answer);
  }
  return front;
}

}  // namespace

DesignStudy study_design(const DesignQuestion& question) {
  DesignStudy study;
  study.problem = with_cross_section(question);
  study.answer = search_design(study.problem, question.search);
  if (study.answer.feasible) {
    study.prices = Prices(study.problem, study.answer, question.search).all();
  }
  if (question.front) study.front = pareto_front(study.problem, *question.front, question.search);
  const Candidate& best = study.answer.best;
  study.ground = ground_contact(best.area, shapes_in_flight(best.design, best.area));
  study.side = worst_side(best.design, best.area);
  return study;
}

}  // namespace tethercalc
