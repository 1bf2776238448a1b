#include "tethercalc/study/envelope.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "tethercalc/study/optimum.hpp"

namespace tethercalc {
namespace {

/// Lengths below this are no tether.
constexpr double shortest_length = 0.1;

bool is_length(Reach reach) { return reach == Reach::height || reach == Reach::offset; }

/// Whether nothing is left on the drum, but for what the search leaves.
bool holds_all_cable(const Tether& tether, double in_air) {
  constexpr double nearly = 1 - 1e-6;
  return tether.spooled_length > 0 && in_air > (tether.length + tether.spooled_length) * nearly;
}

/// The field that is pushed; what is carried comes to the drone's mass.
double& pushed_field(Design& design, Reach reach) {
  double* const pushed[] = {&design.tether.length, &design.drone.mass, &design.flight.headwind,
                            &design.flight.airspeed,
                            &design.flight.horizontal_offset};  // in the order of Reach
  return *pushed[static_cast<std::size_t>(reach)];
}

/// Values to look at, rising: over the whole range and, closer, about the design's own.
std::vector<double> tried_values(Design design, Reach reach) {
  const double start = search_start(reach);
  const double end = search_end(design, reach);
  const double own = reach == Reach::payload ? 0 : pushed_field(design, reach);
  std::vector<double> values{own};
  // Each step of a solved tether solves cables anew.
  const int steps = design.tether.model == TetherModel::solved ? 50 : 400;
  // Squared, so that steps are finer where most answers lie.
  for (int step = 0; step <= steps; ++step) {
    const double share = static_cast<double>(step) / steps;
    values.push_back(start + (end - start) * share * share);
  }
  for (const double beside : {0.05, 0.1, 0.2}) {
    values.push_back(own * (1 - beside));
    values.push_back(own * (1 + beside));
  }
  std::erase_if(values, [&](double value) { return value < start || value > end; });
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

std::optional<GroundAtReach> lowest_on_ground(const Design& design,
                                              std::span<const ReachResult> greatest) {
  std::optional<GroundAtReach> lowest;
  const double area = *design.tether.cross_section;
  for (const ReachResult& result : greatest) {
    if (!result.end) continue;
    const double end = result.end->value;
    const Design there = at_reach(design, result.reach, end);
    const auto contact = ground_contact(area, shapes_in_flight(there, area));
    if (contact && !(lowest && lowest->contact.below_station >= contact->below_station)) {
      lowest = GroundAtReach{result.reach, end, *contact};
    }
  }
  return lowest;
}

}  // namespace

double search_start(Reach reach) { return reach == Reach::height ? shortest_length : 0; }

std::vector<Reach> reaches_of(const Design& design) {
  std::vector<Reach> reaches{Reach::height, Reach::payload, Reach::headwind, Reach::airspeed};
  if (design.tether.model == TetherModel::solved) reaches.push_back(Reach::offset);
  return reaches;
}

double search_end(const Design& design, Reach reach) {
  const Tether& tether = design.tether;
  if (is_length(reach)) {
    if (tether.spooled_length == 0) return 1e4;
    const double all = tether.length + tether.spooled_length;
    // An empty drum would mean a cable that is cut to the length it takes.
    return tether.model == TetherModel::solved ? all * (1 - 1e-9) : all;
  }
  if (reach != Reach::payload) return 100;
  return motor_in_flight(design).max_thrust() * design.drone.motor_count / design.flight.gravity;
}

Design at_reach(Design design, Reach reach, double value) {
  double& field = pushed_field(design, reach);
  Tether& tether = design.tether;
  if (reach == Reach::height && tether.spooled_length > 0) {
    tether.spooled_length = std::max(0.0, tether.length + tether.spooled_length - value);
  }
  field = reach == Reach::payload ? field + value : value;
  return design;
}

std::optional<ReachEnd> greatest_reach(const Design& design, Reach reach) {
  const auto points = [&](double value) {
    const Design pushed = at_reach(design, reach, value);
    return evaluate_areas(pushed, std::span(&*pushed.tether.cross_section, 1), ConductorsAsked::one)
        .front();
  };
  const auto meets = [&](double value) { return points(value).worst.met(); };
  /// Moves both ends of a step onto the edge between them, which what is granted to rounding does
  /// not move.
  const auto bisect = [&](double& good, double& bad) {
    while (std::abs(bad - good) > 1e-9 * std::max(good, bad)) {
      const double middle = 0.5 * (good + bad);
      (points(middle).worst.value >= 0 ? good : bad) = middle;
    }
  };
  const std::vector<double> values = tried_values(design, reach);
  std::size_t last = values.size();
  while (last > 0 && !meets(values[last - 1])) --last;
  if (last == 0) return std::nullopt;
  std::size_t first = last - 1;
  while (first > 0 && meets(values[first - 1])) --first;
  double from = values[first];
  if (first > 0) {
    double bad = values[first - 1];
    bisect(from, bad);
  }
  double good = values[last - 1];
  if (last == values.size()) {
    const bool drum_is_empty = design.tether.spooled_length > 0 && is_length(reach);
    return ReachEnd{good, from, false, Limit::available_power, Condition::hover, drum_is_empty};
  }
  double bad = values[last];
  bisect(good, bad);
  const AreaPoints beyond = points(bad);
  const DemandMargin& missed = beyond.worst;
  const bool drum_is_empty =
      missed.demand == Demand::tether_shape &&
      holds_all_cable(design.tether, points(good).in(missed.condition).tether_length);
  const Limit limit =
      missed_limit(at_reach(design, reach, bad), beyond.in(missed.condition), missed.demand);
  return ReachEnd{good, from, true, limit, missed.condition, drum_is_empty};
}

std::vector<EnvelopePoint> envelope_curve(const Design& design, Reach of, Reach against,
                                          int points) {
  std::vector<EnvelopePoint> curve;
  const auto most = greatest_reach(design, against);
  if (!most) return curve;
  const double start = search_start(against);
  for (int i = 0; i < points; ++i) {
    // The last one a hair inside, where rounding cannot push it out.
    const double share = i == points - 1 ? 1 - 1e-9 : static_cast<double>(i) / (points - 1);
    const double value = start + (most->value - start) * share;
    curve.push_back({value, greatest_reach(at_reach(design, against, value), of)});
  }
  return curve;
}

bool EnvelopeStudy::any() const {
  return std::ranges::any_of(greatest, [](const ReachResult& r) { return r.end.has_value(); });
}

EnvelopeStudy study_envelope(const Design& design) {
  EnvelopeStudy study;
  study.as_given =
      evaluate_areas_to_tell(design, std::span(&*design.tether.cross_section, 1)).front();
  for (const Reach reach : reaches_of(design)) {
    study.greatest.push_back({reach, greatest_reach(design, reach)});
  }
  std::vector<std::pair<Reach, Reach>> curves{{Reach::payload, Reach::height},
                                              {Reach::headwind, Reach::height},
                                              {Reach::payload, Reach::headwind}};
  if (design.tether.model == TetherModel::solved) {
    curves.insert(curves.end(), {{Reach::offset, Reach::height}, {Reach::offset, Reach::headwind}});
  }
  for (const auto& [of, against] : curves) {
    study.curves.push_back({of, against, envelope_curve(design, of, against)});
  }
  study.ground = lowest_on_ground(design, study.greatest);
  const auto aside = std::ranges::find(study.greatest, Reach::offset, &ReachResult::reach);
  const bool at_its_end =
      design.flight.horizontal_offset == 0 && aside != study.greatest.end() && aside->end;
  study.side = worst_side(at_its_end ? at_reach(design, Reach::offset, aside->end->value) : design,
                          *design.tether.cross_section);
  return study;
}

}  // namespace tethercalc
