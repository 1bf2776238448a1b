#include "diagnose/hanging_loads.hpp"

#include <algorithm>
#include <cmath>

#include "model/constants.hpp"
#include "model/similar_cables.hpp"

namespace tethercalc {
namespace {

constexpr double places_per_octave = 8;
/// Drag over weight up to which places are spread evenly from still air on, beyond by octaves.
constexpr double little_wind = 1.0 / 256;

double distance_to(const HangingSituation& situation) {
  return std::hypot(situation.height, situation.offset);
}

/// Of the cable: what is paid out beyond the distance over that, or the winch's tension over the
/// weight of a cable as long as the drone is high.
double held(const HangingSituation& situation, double weight) {
  const PaidOut& out = situation.paid_out;
  return out.length ? *out.length / distance_to(situation) - 1
                    : *out.winch_tension / (weight * situation.height);
}

void hold(HangingSituation& situation, double weight, double value) {
  PaidOut& out = situation.paid_out;
  if (out.length) {
    out.length = (1 + value) * distance_to(situation);
  } else {
    out.winch_tension = value * weight * situation.height;
  }
}

/// m/s at which the wind's drag is so many times the weight.
double wind_of(HangingSituation situation, double radius, double ratio) {
  situation.air.wind.x = 1;
  return std::sqrt(ratio / drag_over_weight(situation, radius).value);
}

/// What decides beside drag over weight and what is paid out, and with how many places an octave.
HangingLoads::ThirdAxis third_axis_of(const HangingSituation& situation) {
  using ThirdAxis = HangingLoads::ThirdAxis;
  if (situation.offset != 0 || situation.axial_stiffness)
    return {ThirdAxis::height, places_per_octave};
  const bool like_itself =
      situation.air.profile == WindProfile::uniform ||
      (situation.air.profile == WindProfile::power_law && situation.air.station_height == 0);
  // A wind over the height changes its shape as ln(height/roughness), a tenth an octave, and the
  // drag of a cylinder as little with the Reynolds number.
  if (!like_itself) return {ThirdAxis::height, 2};
  return situation.cylinder ? HangingLoads::ThirdAxis{ThirdAxis::reynolds_number, 2}
                            : HangingLoads::ThirdAxis{};
}

/// With drag over weight, it decides the Reynolds number's square.
double density_over_coefficient(const HangingSituation& situation) {
  return situation.air.density / situation.drag_coefficient;
}

constexpr HangingLoad::Parts no_load{infinity, infinity, infinity, infinity, 0, infinity};

HangingLoad::Parts solved_itself(const HangingSituation& situation, double radius) {
  return HangingLoad(situation, ConductorsAsked::one).at(radius).value;
}

/// Weights of four neighbours, `u` in their spacing from the first (Lagrange's cubic).
std::array<double, 4> cubic(double u) {
  const double a = u, b = u - 1, c = u - 2, d = u - 3;
  return {-b * c * d / 6, a * c * d / 2, -a * b * d / 2, a * b * c / 6};
}

/// Where between `lo` and `hi` a function that falls, then rises is least, by sections.
template <typename Function>
double place_of_least(const Function& f, double lo, double hi) {
  constexpr int sections = 24;  // the least is flat: 1e-4 of the first width is enough
  for (int i = 0; i < sections; ++i) {
    const double a = (2 * lo + hi) / 3, b = (lo + 2 * hi) / 3;
    if (f(a) < f(b)) {
      hi = b;
    } else {
      lo = a;
    }
  }
  return (lo + hi) / 2;
}

}  // namespace

HangingLoads::Family& HangingLoads::family_of(const HangingSituation& situation, double radius) {
  HangingSituation alike = situation;
  alike.height = 0;
  alike.paid_out.length = situation.paid_out.length ? std::optional(0.0) : std::nullopt;
  alike.paid_out.winch_tension =
      situation.paid_out.winch_tension ? std::optional(0.0) : std::nullopt;
  alike.cable_there_is = infinity;
  alike.air.wind.x = -1;
  alike.air.reference_height = 0;
  // Drag over weight has them, but where the Reynolds number follows the speed.
  const ThirdAxis third = third_axis_of(situation);
  if (!situation.cylinder || third.of == ThirdAxis::reynolds_number) {
    alike.air.density = alike.drag_coefficient = 1;
  }
  for (Family& one : families_) {
    if (one.radius == radius && one.alike == alike) return one;
  }
  Family& family = families_.emplace_back();
  family = {.alike = alike, .member = situation, .radius = radius};
  family.member.cable_there_is = infinity;
  family.third = third;
  return family;
}

const std::optional<HangingLoads::Values>& HangingLoads::solved_at(Family& family,
                                                                   const Place& place) {
  Known& known = family.known[place];
  if (known.is_solved) return known.values;
  known.is_solved = true;
  const auto octaves = [](int index) { return std::exp2(index / places_per_octave); };
  HangingSituation there = family.member;
  const double third = std::exp2(place[2] / family.third.places_per_octave);
  if (family.third.of == ThirdAxis::height) {
    there.height = third;
    there.air.reference_height += there.height - family.member.height;
  } else if (family.third.of == ThirdAxis::reynolds_number) {
    there.drag_coefficient = there.air.density / third;
  }
  there.air.wind.x = -wind_of(there, family.radius, little_wind * (octaves(place[0]) - 1));
  hold(there, weight_at(there, family.radius), octaves(place[1]));
  CableSolver solver(most_steps_for_load);
  LoadShares shares{};
  if (solve_shares(there, solver, family.radius, shares) == CableOutcome::hangs) {
    known.values = shares;
    known.values->back() /= distance_to(there);
  }
  return known.values;
}

const std::vector<HangingLoads::Values>& HangingLoads::corners_of(Family& family,
                                                                  const Place& first) {
  Known& known = family.known[first];
  if (known.has_corners) return known.corners;
  known.has_corners = true;
  const int thirds = family.third.of == ThirdAxis::none ? 1 : 4;
  const auto towards_middle = [](int index, int count) {
    return count == 1 ? index : std::clamp(index, 1, 2);
  };
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      for (int k = 0; k < thirds; ++k) {
        const auto* values = &solved_at(family, {first[0] + i, first[1] + j, first[2] + k});
        // Beside where it ceases to hang the outer corners are as those inside.
        if (!*values) {
          values =
              &solved_at(family, {first[0] + towards_middle(i, 4), first[1] + towards_middle(j, 4),
                                  first[2] + towards_middle(k, thirds)});
        }
        if (!*values) {
          known.corners.clear();
          return known.corners;
        }
        known.corners.push_back(**values);
      }
    }
  }
  return known.corners;
}

HangingLoad::Parts HangingLoads::by_length(HangingSituation situation, double radius) {
  const double tension = *situation.paid_out.winch_tension;
  const double distance = distance_to(situation);
  const auto with_slack = [&](double octaves) {
    situation.paid_out = {.length = (1 + std::exp2(octaves)) * distance, .winch_tension = {}};
    return at(situation, radius);
  };
  const auto pull = [&](double octaves) { return with_slack(octaves).tension_at_ground; };
  constexpr double tautest = -12, slackest = 6, step = 0.5;
  constexpr int halvings = 28;
  // The slack between `strong` and `weak` at which the cable pulls as the winch does.
  const auto as_the_winch = [&](double strong, double weak) {
    for (int i = 0; i < halvings; ++i) {
      const double middle = (strong + weak) / 2;
      (pull(middle) > tension ? strong : weak) = middle;
    }
    return with_slack(weak);
  };
  double before = pull(tautest);
  for (double octaves = tautest; octaves < slackest; octaves += step) {
    const double next = pull(octaves + step);
    if (next <= tension) return as_the_winch(octaves, octaves + step);
    if (next > before) {
      const double least = place_of_least(pull, octaves - step, octaves + step);
      return pull(least) <= tension ? as_the_winch(octaves - step, least) : with_slack(least);
    }
    before = next;
  }
  return no_load;
}

HangingLoad::Parts HangingLoads::at(const HangingSituation& situation, double radius) {
  Family& family = family_of(situation, radius);
  const double weight = weight_at(situation, radius);
  const double ratio = drag_over_weight(situation, radius).value;
  const auto third = [&]() -> double {
    switch (family.third.of) {
      case ThirdAxis::height:
        return situation.height;
      case ThirdAxis::reynolds_number:
        return density_over_coefficient(situation);
      case ThirdAxis::none:
        break;
    }
    return 1;
  };
  const std::array<double, 3> at{places_per_octave * std::log2(1 + ratio / little_wind),
                                 places_per_octave * std::log2(held(situation, weight)),
                                 family.third.places_per_octave * std::log2(third())};
  // A cable without slack or weight, or in a storm, has no place.
  constexpr double furthest = 1000;
  const auto has_place = [](double x) { return std::abs(x) < furthest; };
  if (!std::all_of(at.begin(), at.end(), has_place)) return solved_itself(situation, radius);
  Place first{};
  std::array<std::array<double, 4>, 3> weights{};
  weights[2] = {1};  // where nothing more decides
  for (std::size_t axis = 0; axis < at.size(); ++axis) {
    if (axis == 2 && family.third.of == ThirdAxis::none) break;
    first[axis] = static_cast<int>(std::floor(at[axis])) - 1;
    if (axis == 0) first[axis] = std::max(0, first[axis]);
    weights[axis] = cubic(at[axis] - first[axis]);
  }
  const std::vector<Values>& corners = corners_of(family, first);
  if (corners.empty()) {
    return situation.paid_out.winch_tension ? by_length(situation, radius) : no_load;
  }
  Values values{};
  auto corner = corners.begin();
  const std::size_t thirds = family.third.of == ThirdAxis::none ? 1 : 4;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t k = 0; k < thirds; ++k, ++corner) {
        const double share = weights[0][i] * weights[1][j] * weights[2][k];
        for (std::size_t part = 0; part < part_count; ++part) {
          values[part] += share * (*corner)[part];
        }
      }
    }
  }
  const double load = own_load(situation, radius).value;
  const double length =
      situation.paid_out.length.value_or(std::max(1.0, values.back()) * distance_to(situation));
  if (length > situation.cable_there_is) return no_load;
  return {std::max(0.0, values[0]) * load,
          values[1] * load,
          values[2] * load,
          values[3] * load,
          0,
          length};
}

}  // namespace tethercalc
