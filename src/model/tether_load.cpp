// Notation as in the header; s wall of the insulation, h cable in the air.

#include "tethercalc/model/tether_load.hpp"

#include <cstdint>
#include <cstring>
#include <map>
#include <numbers>

#include "model/cable_memory.hpp"
#include "model/similar_cables.hpp"

namespace tethercalc {
namespace {

using std::numbers::pi;

/// Larger root of a·x² + b·x + c with a ≥ 0, b ≥ 0, c < 0, without cancellation.
double positive_root(double a, double b, double c) {
  return -2 * c / (b + std::sqrt(b * b - 4 * a * c));
}

}  // namespace

StraightTether::StraightTether(const Tether& tether, double wall, const FlightState& state,
                               double air_density, double gravity)
    : tether_(&tether),
      wall_(wall),
      deployed_(state.deployed),
      on_drum_(state.on_drum),
      half_density_(0.5 * air_density),
      gravity_(gravity) {
  const StrengthMemberData member = strength_member_data(tether.strength_member);
  const double insulation = 2 * deployed_ * tether.insulation.density * pi * wall;
  mass_0_ = insulation * wall + deployed_ * (member.mass_per_metre + tether.cover_mass);
  mass_1_ = 2 * insulation;
  mass_2_ = 2 * deployed_ * tether.conductor.density * pi;
  const double coldest_C =
      is_heated(tether) ? state.ambient_temperature_C : tether.conductor_temperature_C;
  resistance_area_ = 2 * (deployed_ + on_drum_) * effective_resistivity(tether, coldest_C) / pi;
  width_ = wall + 0.25 * (member.diameter + tether.cover_width);
  set_airspeed(state.airspeed);
}

void StraightTether::set_airspeed(double airspeed) {
  drag_1_ = half_density_ * airspeed * airspeed * vibrating_drag_coefficient(*tether_) *
            tether_->projection_factor * 4 * deployed_;
  drag_0_ = drag_1_ * width_;
}

double StraightTether::mass_of(double length, double radius) const {
  const double area = conductor_area(radius);
  const double insulation_area = pi * wall_ * (2 * radius + wall_);  // π((r+s)² − r²)
  return length *
         (2 * (tether_->conductor.density * area + tether_->insulation.density * insulation_area) +
          strength_member_data(tether_->strength_member).mass_per_metre + tether_->cover_mass);
}

double StraightTether::radius_of_mass(double mass) const {
  const double rest = mass_0_ - mass;
  return rest < 0 ? positive_root(mass_2_, mass_1_, rest) : -1;
}

double StraightTether::resistance(double radius, double in_air_C, double on_drum_C) const {
  return resistance(radius, deployed_, on_drum_, in_air_C, on_drum_C);
}

double StraightTether::resistance(double radius, double in_air, double on_drum, double in_air_C,
                                  double on_drum_C) const {
  return contact_resistance() + 2 *
                                    (in_air * effective_resistivity(*tether_, in_air_C) +
                                     on_drum * effective_resistivity(*tether_, on_drum_C)) /
                                    conductor_area(radius);
}

// --- HangingLoad ---

namespace {

/// ln r between places at which a cable is solved. The error of a cubic goes with its fourth power:
/// forces over the cable's own load change by less than themselves over a factor of e in r.
constexpr double stride = 0.25 * std::numbers::ln2;
/// Where a cable begins to hang no more, it is solved closer by as much; where its load bends
/// sharply, by a part of it.
constexpr long places_per_stride = 1024;
constexpr long closest_places = 16;
constexpr long places_for_end = 4;
/// Of what a cubic has beyond a parabola: it misses by about a two-hundredth of that, and by up to
/// a tenth where a winch soon holds the cable no more.
constexpr double little_bend = 2e-3;
constexpr double little_bend_on_winch = 2e-4;
constexpr double thickest_solved = 1;  // m
const double log_thinnest = std::log(thinnest_solved);
constexpr double log_thickest = 0;
const double first_stride = std::floor(log_thinnest / stride);

double log_radius_at(long place) {
  return stride * static_cast<double>(place) / static_cast<double>(places_per_stride);
}

}  // namespace

std::optional<double> HangingSituation::cylinder_diameter(double radius) const {
  // Metal of no thickness without a wall has the drag of the thinnest wire.
  constexpr double thinnest = 1e-6;
  if (!cylinder) return std::nullopt;
  return std::max((*cylinder)[0] + (*cylinder)[1] * radius, thinnest);
}

HangingLoad::HangingLoad(const HangingSituation& situation, ConductorsAsked asked)
    : situation_(situation),
      similar_(asked == ConductorsAsked::many ? SimilarCables::of(situation) : nullptr),
      asked_(asked) {
  // Where cables nearby take more than there is, what is between them may reach.
  situation_.cable_there_is = std::numeric_limits<double>::infinity();
  cable_there_is_ = situation.cable_there_is;
}

HangingLoad::Node HangingLoad::solved_node(double log_radius) const {
  if (situation_.memory != nullptr) {
    if (const auto known = situation_.memory->at_radius(situation_, std::exp(log_radius))) {
      return {known->hangs ? CableOutcome::hangs : CableOutcome::tension_too_low, known->value,
              known->slope};
    }
  }
  // Each from nothing, so that an answer does not depend on what was asked before.
  CableSolver solver(most_steps_for_load);
  Node node;
  node.outcome = solve_shares(situation_, solver, std::exp(log_radius), node.value);
  if (node.outcome != CableOutcome::hangs) return node;
  // Where a winch soon holds no more slopes turn sharply: they are those of what is closer by.
  constexpr double close_by = 3e-7;
  constexpr double much = 1e-2;
  for (const double step : {slope_step, close_by}) {
    Values above{};
    Values below{};
    const bool is_last =
        solve_shares(situation_, solver, std::exp(log_radius + step), above) != CableOutcome::hangs;
    if (is_last) above = node.value;
    node.outcome = solve_shares(situation_, solver, std::exp(log_radius - step), below);
    for (std::size_t i = 0; i < part_count; ++i) {
      node.slope[i] = (above[i] - below[i]) / (is_last ? step : 2 * step);
    }
    const double turn = above.back() + below.back() - 2 * node.value.back();
    if (!(std::abs(turn) > much * std::abs(above.back() - below.back()))) break;
  }
  return node;
}

const HangingLoad::Node& HangingLoad::node(long place) const {
  const auto known = nodes_.find(place);
  if (known != nodes_.end()) return known->second;
  return nodes_.emplace(place, solved_node(log_radius_at(place))).first->second;
}

namespace {

/// How far values leave the parabola of which these are the slopes, by `apart`. It has the mean
/// slope of its ends; beyond it is the third derivative times apart³/12.
double bend_of(double rise, double slope_a, double slope_b, double apart) {
  return std::abs(rise - 0.5 * apart * (slope_a + slope_b));
}

}  // namespace

double HangingLoad::bend_between(const Node& a, const Node& b, double width, bool by_length) {
  const double longer = b.value.back() - a.value.back();
  if (by_length && !(a.slope.back() > 0 && b.slope.back() > 0 && longer > 0)) {
    return std::numeric_limits<double>::infinity();
  }
  const double apart = by_length ? longer : width;
  const double per_a = by_length ? 1 / a.slope.back() : 1;
  const double per_b = by_length ? 1 / b.slope.back() : 1;
  const double tension = std::max(a.value[2], b.value[2]);
  double most = bend_of(width, per_a, per_b, apart);
  for (std::size_t i = 0; i < part_count; ++i) {
    const bool is_length = i + 1 == part_count;
    const double bend =
        bend_of(b.value[i] - a.value[i], per_a * a.slope[i], per_b * b.slope[i], apart);
    most = std::max(most, bend / (is_length ? a.value[i] : tension));
  }
  return most;
}

std::optional<HangingLoad::Places> HangingLoad::places_about(double x) const {
  constexpr int most_strides = 4;
  const double enough = situation_.paid_out.winch_tension ? little_bend_on_winch : little_bend;
  const auto outcome = [this](long place) { return node(place).outcome; };
  // Away from places at which nothing was found.
  const auto away_from = [&](long place, long step) {
    for (int i = 0; i < most_strides && outcome(place) == CableOutcome::not_found; ++i) {
      place += step;
    }
    return place;
  };
  const long first = static_cast<long>(std::floor(x / stride)) * places_per_stride;
  const long lo = away_from(first, -places_per_stride);
  long hi = away_from(first + places_per_stride, places_per_stride);
  const bool at_the_thin_end = x < log_thinnest + most_strides * stride;
  if (outcome(lo) != CableOutcome::hangs) {
    if (at_the_thin_end && outcome(hi) == CableOutcome::hangs) return Places{hi, hi};
    return std::nullopt;
  }
  long hangs = lo;
  while (outcome(hi) != CableOutcome::hangs) {  // towards where it ceases to hang
    const long middle = hangs + (hi - hangs) / 2;
    if (middle == hangs) {
      const long before = hangs - places_for_end;
      const bool leads_on =
          outcome(before) == CableOutcome::hangs &&
          bend_between(node(before), node(hangs), log_radius_at(places_for_end), true) < enough;
      return leads_on ? std::optional(Places{before, hangs, true, true}) : std::nullopt;
    }
    if (x < log_radius_at(middle)) {
      hi = middle;
    } else {
      hangs = middle;
      if (outcome(hangs) != CableOutcome::hangs) return std::nullopt;
    }
  }
  for (;;) {
    const double width = log_radius_at(hi - hangs);
    const double bend = bend_between(node(hangs), node(hi), width, false);
    // By the length, if the winch decides it, loads are smooth to the end.
    const bool by_length =
        bend > enough && bend_between(node(hangs), node(hi), width, true) < enough;
    const long middle = hangs + (hi - hangs) / 2;
    if (by_length || bend <= enough || hi - hangs <= closest_places ||
        outcome(middle) != CableOutcome::hangs) {
      return Places{hangs, hi, by_length};
    }
    (x < log_radius_at(middle) ? hi : hangs) = middle;
  }
}

std::optional<HangingLoad::Stretch> HangingLoad::stretch_about(double x) const {
  Stretch& known = stretches_[static_cast<std::size_t>(std::floor(x / stride) - first_stride)];
  if (known.begin <= x && x < known.end) return known;
  const auto places = places_about(x);
  if (!places) return std::nullopt;
  const auto [lo, hi, by_length, is_beyond] = *places;
  const double from = log_radius_at(lo);
  const double to = log_radius_at(hi);
  known = {&node(lo), &node(hi), from, lo == hi ? 1 : to - from, by_length, from, to};
  if (is_beyond) {
    known.begin = to;
    known.end = log_radius_at(hi + 1);
  }
  return known;
}

std::optional<HangingLoad::Shares> HangingLoad::solved_alone(double radius) const {
  const Node there = solved_node(std::log(std::clamp(radius, thinnest_solved, thickest_solved)));
  if (there.outcome != CableOutcome::hangs) return std::nullopt;
  Shares shares{there.value, {}};
  const bool moves = radius > thinnest_solved && radius < thickest_solved;
  for (std::size_t i = 0; moves && i < part_count; ++i) shares.slope[i] = there.slope[i] / radius;
  return shares;
}

std::optional<HangingLoad::Shares> HangingLoad::of_similar_cables(double radius) const {
  const double within = std::clamp(radius, thinnest_solved, thickest_solved);
  const DragOverWeight ratio = drag_over_weight(situation_, within);
  const auto at = similar_->at(ratio.value);
  if (!at) return std::nullopt;
  Shares shares{at->value, {}};
  const bool moves = within == radius && ratio.value > 0;
  for (std::size_t i = 0; moves && i < part_count; ++i) {
    shares.slope[i] = at->slope[i] * ratio.slope / ratio.value;
  }
  return shares;
}

namespace {

/// What Hermite's cubic from 0 over a width of 1 has of its rise and of the slopes at its ends.
struct CubicAt {
  double rise = 0;
  double slope_a = 0;
  double slope_b = 0;
  [[nodiscard]] double of(const CubicAt& cubic) const {
    return rise * cubic.rise + slope_a * cubic.slope_a + slope_b * cubic.slope_b;
  }
};
CubicAt cubic_at(double t) { return {t * t * (3 - 2 * t), t * (1 - t) * (1 - t), t * t * (t - 1)}; }
CubicAt cubic_slope_at(double t) {
  return {6 * t * (1 - t), (1 - t) * (1 - 3 * t), t * (3 * t - 2)};
}

/// Where such a cubic rises through `wanted` from t = 0, or a little beyond 1, by Newton's method;
/// nothing where it does not come that far.
std::optional<double> reaches(const CubicAt& cubic, double wanted) {
  constexpr int most_steps = 60;
  constexpr double last = 2.5;
  constexpr double digits = 1e-12;
  double t = std::clamp(wanted / cubic.rise, 0.0, 1.0);
  for (int i = 0; i < most_steps; ++i) {
    const double slope = cubic_slope_at(t).of(cubic);
    if (!(slope > 0)) return std::nullopt;
    const double next = std::max(0.0, t + (wanted - cubic_at(t).of(cubic)) / slope);
    if (next > last) return std::nullopt;
    if (std::abs(next - t) < digits) return next;
    t = next;
  }
  return std::nullopt;
}

}  // namespace

std::optional<HangingLoad::Shares> HangingLoad::between_nodes(double radius) const {
  const double x = std::clamp(std::log(radius), log_thinnest, log_thickest);
  const auto stretch = stretch_about(x);
  if (!stretch) return std::nullopt;
  const auto& [lo, hi, from, width, by_length, begin, end] = *stretch;
  const Node& a = *lo;
  const Node& b = *hi;
  const bool one_place = lo == hi;  // its forces over the cable's own load hold for thinner ones
  // Nodes are 1 apart by t; their slopes are by the logarithm of the radius.
  double t = one_place ? 0 : (x - from) / width;
  double per_a = width;
  double per_b = width;
  double t_slope = 1 / width;
  if (by_length) {
    const double longer = b.value.back() - a.value.back();
    per_a = longer / a.slope.back();
    per_b = longer / b.slope.back();
    const CubicAt logarithm{width, per_a, per_b};
    const auto reached = reaches(logarithm, x - from);
    if (!reached) return std::nullopt;
    t = *reached;
    t_slope = 1 / cubic_slope_at(t).of(logarithm);
  }
  const bool moves = !one_place && x > log_thinnest && x < log_thickest;
  const CubicAt value = cubic_at(t);
  const CubicAt slope = cubic_slope_at(t);
  const double by_radius = moves ? t_slope / radius : 0;
  Shares shares;
  for (std::size_t i = 0; i < part_count; ++i) {
    const CubicAt part{b.value[i] - a.value[i], per_a * a.slope[i], per_b * b.slope[i]};
    shares.value[i] = a.value[i] + value.of(part);
    shares.slope[i] = by_radius * slope.of(part);
  }
  return shares;
}

const HangingLoad::AtRadius& HangingLoad::at(double radius) const {
  // Searches ask for the ends of a stretch of radii by turns. By Fibonacci hashing.
  constexpr std::uint64_t golden = 0x9e3779b97f4a7c15;
  std::uint64_t bits = 0;
  static_assert(sizeof bits == sizeof radius);
  std::memcpy(&bits, &radius, sizeof bits);  // browsers' library has no std::bit_cast
  Known& known = known_[(bits * golden) >> 61];
  if (radius != known.radius) known = {radius, computed_at(radius)};
  return known.at;
}

HangingLoad::AtRadius HangingLoad::computed_at(double radius) const {
  const std::optional<double> fixed = fixed_length();
  std::optional<Shares> shares;
  // What asks for the point of no area at all gets a tether that does not hang.
  if (!std::isnan(radius) && !(fixed > cable_there_is_)) {
    if (asked_ == ConductorsAsked::one) shares = solved_alone(radius);
    if (similar_) shares = of_similar_cables(radius);
    if (!shares) shares = between_nodes(radius);
  }
  if (!shares || (!fixed && shares->value.back() > cable_there_is_)) {
    constexpr double none = std::numeric_limits<double>::infinity();
    return {{none, none, none, none, none, none}, {}};
  }
  Values& value = shares->value;
  Values& slope = shares->slope;
  const OwnLoad load = own_load(situation_, radius);
  for (std::size_t i = 0; i + 1 < part_count; ++i) {
    slope[i] = slope[i] * load.value + value[i] * load.slope;
    value[i] *= load.value;
  }
  if (fixed) {
    value.back() = *fixed;
    slope.back() = 0;
  }
  return {{value[0], value[1], value[2], value[3], value[4], value[5]},
          {slope[0], slope[1], slope[2], slope[3], slope[4], slope[5]}};
}

// --- TetherInFlight ---

namespace {

/// The load in a situation, which the one asked for later shares with its solutions.
std::shared_ptr<const HangingLoad> hanging_load(const HangingSituation& situation,
                                                ConductorsAsked asked) {
  if (asked == ConductorsAsked::one) {
    return std::make_shared<const HangingLoad>(situation, asked);
  }
  // Similar cables share their solutions beyond one situation.
  if (normal_form(situation)) return std::make_shared<const HangingLoad>(situation);
  KnownCables& known = known_cables(situation);
  if (known.loads.size() >= known.most) known.loads.clear();
  auto& load = known.loads[situation];
  if (!load) load = std::make_shared<const HangingLoad>(situation);
  return load;
}

/// Of the airspeed, what is the drone's own and no profile of the wind shapes. With a wind from
/// behind it may be more than all; where both nearly cancel the cable below meets more still.
double own_share(const FlightState& state) {
  constexpr double most = 2;
  return state.airspeed == 0 ? 0 : std::clamp(state.own_airspeed / state.airspeed, 0.0, most);
}

/// The air as the cable meets it, x from the station to the drone. All of the cable meets the
/// drone's own airspeed, which loads it more than following the drone would.
MovingAir air_about(const FlightState& state, const Flight& flight) {
  MovingAir air;
  air.density = flight.air_density;
  air.wind = level_wind(std::abs(state.airspeed), state.wind_from);
  air.profile = flight.wind_profile;
  air.station_height = flight.station_height;
  air.reference_height = flight.station_height + state.deployed;
  air.exponent = flight.wind_exponent;
  air.roughness_length = flight.roughness_length;
  if (air.profile != WindProfile::uniform) air.even_share = own_share(state);
  return air;
}

/// m in the air and on the drum. Without a drum a cable is cut to the length it takes.
double cable_there_is(const FlightState& state) {
  constexpr double a_hair_more = 1 + 1e-12;
  return state.on_drum > 0 ? (state.deployed + state.on_drum) * a_hair_more
                           : std::numeric_limits<double>::infinity();
}

}  // namespace

double left_on_drum(const FlightState& state, double in_air) {
  return std::max(0.0, state.on_drum - (in_air - state.deployed));
}

PaidOut paid_out_to(const Tether& tether, double height, double offset) {
  if (tether.winch_pull > 0) return {.length = {}, .winch_tension = tether.winch_pull};
  return {.length = (1 + tether.slack) * std::hypot(height, offset), .winch_tension = {}};
}

HangingSituation hanging_situation(const Tether& tether, double wall, const FlightState& state,
                                   const Flight& flight) {
  const StraightTether metre(tether, wall, {.deployed = 1}, flight.air_density, flight.gravity);
  const std::array cylinder{insulated_width(0, wall), 2.0};
  return {.weight = {flight.gravity * metre.mass_0_, flight.gravity * metre.mass_1_,
                     flight.gravity * metre.mass_2_},
          .width = {4 * tether.projection_factor * metre.width_, 4 * tether.projection_factor},
          .drag_coefficient = vibrating_drag_coefficient(tether),
          .cylinder = tether.drag_by_reynolds_number ? std::optional(cylinder) : std::nullopt,
          .air = air_about(state, flight),
          .paid_out = paid_out_to(tether, state.deployed, flight.horizontal_offset),
          .cable_there_is = cable_there_is(state),
          .axial_stiffness = tether.axial_stiffness,
          .offset = flight.horizontal_offset,
          .height = state.deployed,
          .memory = tether.memory};
}

HangingSituation hanging_situation(const Design& design, const FlightState& state) {
  const double wall = insulation_wall(design.tether.insulation, design.supply.voltage);
  return hanging_situation(design.tether, wall, state, design.flight);
}

NoWayUp no_way_up(const Design& design, double area, Condition condition) {
  CableSolver solver;
  const auto [outcome, cable] = solve_hanging(
      hanging_situation(design, flight_state(design, condition)), solver, conductor_radius(area));
  return {area, outcome, outcome == CableOutcome::too_short ? cable.length : 0};
}

TetherInFlight::TetherInFlight(const Tether& tether, double wall, const FlightState& state,
                               const Flight& flight, ConductorsAsked asked)
    : straight_(tether, wall, state, flight.air_density, flight.gravity), asked_(asked) {
  hang(state, flight);
}

void TetherInFlight::hang(const FlightState& state, const Flight& flight) {
  const Tether& tether = *straight_.tether_;
  // On the ground nothing hangs.
  if (tether.model == TetherModel::straight || !(state.deployed > 0)) return;
  hanging_ = hanging_load(hanging_situation(tether, straight_.wall_, state, flight), asked_);
}

TetherLoad TetherInFlight::load(double radius) const {
  if (!hanging_) return straight_.load(radius);
  const HangingLoad::Parts& parts = hanging_->at(radius).value;
  return {parts.along,
          parts.down,
          parts.tension_at_drone,
          parts.tension_at_ground,
          hanging_mass(radius),
          parts.length,
          parts.across};
}

double TetherInFlight::hanging_mass(double radius) const {
  return straight_.mass_of(1, radius) * hanging_->at(radius).value.length;
}

double TetherInFlight::hanging_length(double radius) const {
  const std::optional<double> fixed = hanging_->fixed_length();
  return fixed ? *fixed : hanging_->at(radius).value.length;
}

double TetherInFlight::radius_of_tension(double tension) const {
  const std::optional<double> stiffness = straight_.tether_->axial_stiffness;
  const double stretched = stiffness ? 1 + tension / (2 * *stiffness) : 1;
  return straight_.radius_of_mass(tension * stretched / straight_.gravity_);
}

double TetherInFlight::on_drum(double in_air) const {
  return left_on_drum({.deployed = straight_.deployed_, .on_drum = straight_.on_drum_}, in_air);
}

double TetherInFlight::circuit_share(double radius) const {
  const double in_air = hanging_length(radius);
  return (in_air + on_drum(in_air)) / (straight_.deployed_ + straight_.on_drum_);
}

double TetherInFlight::resistance(double radius, double in_air_C, double on_drum_C) const {
  if (!hanging_) return straight_.resistance(radius, in_air_C, on_drum_C);
  const double in_air = hanging_length(radius);
  return straight_.resistance(radius, in_air, on_drum(in_air), in_air_C, on_drum_C);
}

double TetherInFlight::resistance_slope(double radius) const {
  if (!hanging_) return straight_.resistance_slope(radius);
  const HangingLoad::AtRadius& at = hanging_->at(radius);
  const double circuit = straight_.deployed_ + straight_.on_drum_;
  const double growth = on_drum(at.value.length) > 0 ? 0 : at.slope.length / circuit;
  return straight_.resistance_slope(radius) * circuit_share(radius) +
         straight_.resistance_area() * growth / (radius * radius);
}

double TetherInFlight::radius_of_resistance(double resistance) const {
  double radius = straight_.radius_of_resistance(resistance);
  if (!hanging_ || !(radius < std::numeric_limits<double>::infinity())) return radius;
  // The length of the circuit hardly depends on the radius: each step leaves a small part of the
  // error. Where the cable cannot hang, no radius has a resistance.
  for (int step = 0; step < 60; ++step) {
    const double line = resistance - contact_resistance();
    const double next = std::sqrt(resistance_area(radius) / line);
    if (!(next < std::numeric_limits<double>::infinity())) break;
    if (!(std::abs(next - radius) > 1e-15 * radius)) break;
    radius = next;
  }
  return radius;
}

}  // namespace tethercalc
