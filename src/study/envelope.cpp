#include "tethercalc/study/envelope.hpp"

#include <algorithm>
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

double search_start(Reach reach) { return reach == Reach::height ? shortest_length : 0; }

}  // namespace

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
  double* const pushed[] = {&design.tether.length, &design.drone.mass, &design.flight.headwind,
                            &design.flight.airspeed,
                            &design.flight.horizontal_offset};  // in the order of Reach
  double& field = *pushed[static_cast<std::size_t>(reach)];
  Tether& tether = design.tether;
  if (reach == Reach::height && tether.spooled_length > 0) {
    tether.spooled_length = std::max(0.0, tether.length + tether.spooled_length - value);
  }
  field = reach == Reach::payload ? field + value : value;
  return design;
}

std::optional<ReachEnd> greatest_reach(const Design& design, Reach reach) {
  const double start = search_start(reach);
  const double end = search_end(design, reach);
  const auto points = [&](double value) {
    const Design pushed = at_reach(design, reach, value);
    return evaluate_areas(pushed, std::span(&*pushed.tether.cross_section, 1), ConductorsAsked::one)
        .front();
  };
  const auto margin = [&](double value) { return points(value).worst; };
  // Each step of a solved tether solves cables anew.
  const int steps = design.tether.model == TetherModel::solved ? 50 : 400;
  // Squared, so that steps are finer where most answers lie.
  const auto at_step = [&](int step) {
    const double share = static_cast<double>(step) / steps;
    return start + (end - start) * share * share;
  };
  int last = steps;
  while (last >= 0 && margin(at_step(last)).value < 0) --last;
  if (last < 0) return std::nullopt;
  if (last == steps) {
    const bool drum_is_empty = design.tether.spooled_length > 0 && is_length(reach);
    return ReachEnd{end, false, Limit::available_power, Condition::hover, drum_is_empty};
  }
  double good = at_step(last);
  double bad = at_step(last + 1);
  while (bad - good > 1e-9 * bad) {
    const double middle = 0.5 * (good + bad);
    (margin(middle).value >= 0 ? good : bad) = middle;
  }
  const DemandMargin missed = margin(bad);
  const bool drum_is_empty =
      missed.demand == Demand::tether_shape &&
      holds_all_cable(design.tether, points(good).in(missed.condition).tether_length);
  return ReachEnd{good, true, limit_of(missed.demand), missed.condition, drum_is_empty};
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
  return study;
}

}  // namespace tethercalc
