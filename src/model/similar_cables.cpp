#include "model/similar_cables.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/cable_memory.hpp"

namespace tethercalc {
namespace {

/// Drag over weight below which a cable above its station is a fold, over its slack.
constexpr double folded_below = 0.02;

/// N/m², of the wind at its reference height on a width.
double pressure_on(const HangingSituation& situation) {
  const Vector3& wind = situation.air.wind;
  return 0.5 * situation.air.density * situation.drag_coefficient *
         (wind.x * wind.x + wind.y * wind.y);
}

}  // namespace

double slack_above_station(const HangingSituation& situation) {
  const bool rests = situation.air.drone_velocity == Vector3{};
  return situation.offset == 0 && rests && situation.paid_out.length
             ? *situation.paid_out.length / situation.height - 1
             : 0;
}

double weight_at(const HangingSituation& situation, double radius) {
  const auto& [w0, w1, w2] = situation.weight;
  return w0 + radius * (w1 + radius * w2);
}

double weight_slope_at(const HangingSituation& situation, double radius) {
  return situation.weight[1] + 2 * radius * situation.weight[2];
}

OwnLoad own_load(const HangingSituation& situation, double radius) {
  const double weight = weight_at(situation, radius);
  const double per_width = pressure_on(situation);
  const double drag = per_width * (situation.width[0] + situation.width[1] * radius);
  const double both = std::sqrt(weight * weight + drag * drag);
  const double slope =
      both > 0
          ? (weight * weight_slope_at(situation, radius) + drag * per_width * situation.width[1]) /
                both
          : 0;
  return {situation.height * both + situation.paid_out.winch_tension.value_or(0),
          situation.height * slope};
}

DragOverWeight drag_over_weight(const HangingSituation& situation, double radius) {
  const double weight = weight_at(situation, radius);
  const double per_width = pressure_on(situation);
  const double drag = per_width * (situation.width[0] + situation.width[1] * radius);
  const double value = drag / weight;
  return {value,
          (per_width * situation.width[1] - value * weight_slope_at(situation, radius)) / weight};
}

Cable cable_of(const HangingSituation& situation, double radius) {
  return {.weight = weight_at(situation, radius),
          .diameter = situation.width[0] + situation.width[1] * radius,
          .drag_coefficient = situation.drag_coefficient,
          .cylinder_diameter = situation.cylinder_diameter(radius),
          .axial_stiffness = situation.axial_stiffness};
}

HangingOutcome solve_hanging(const HangingSituation& situation, CableSolver& solver,
                             double radius) {
  const PaidOut& paid_out = situation.paid_out;
  const Cable cable = cable_of(situation, radius);
  const Vector3 drone{situation.offset, 0, situation.height};
  // The wind swings a fold above its station aside by half of drag over weight. With a fiftieth of
  // its slack it stays a fold, and no solution is needed; with three times its slack nearly so.
  const Vector3& wind = situation.air.wind;
  const double speed = std::hypot(wind.x, wind.y);
  const double drag = drag_across(cable, situation.air, speed);
  const double slack = slack_above_station(situation);
  const auto swings_less_than = [&](double slacks) { return drag < slacks * slack * cable.weight; };
  const bool folded = swings_less_than(folded_below);
  HangingOutcome out;
  if (!folded) out.outcome = solver.solve(cable, situation.air, paid_out, drone);
  double drag_of_fold = 0;
  if (folded || (out.outcome == CableOutcome::not_found && swings_less_than(3))) {
    drag_of_fold = drag * situation.height;
    MovingAir still = situation.air;
    still.wind = {};
    out.outcome = solver.solve(cable, still, paid_out, drone);
  }
  if (out.outcome != CableOutcome::hangs) return out;
  out.cable = solver.result();
  if (drag_of_fold > 0) {
    out.cable.on_drone.x += drag_of_fold * wind.x / speed;
    out.cable.on_drone.y += drag_of_fold * wind.y / speed;
  }
  if (out.cable.length > situation.cable_there_is) out.outcome = CableOutcome::too_short;
  return out;
}

CableOutcome solve_shares(const HangingSituation& situation, CableSolver& solver, double radius,
                          LoadShares& shares) {
  const auto [outcome, hangs] = solve_hanging(situation, solver, radius);
  if (outcome != CableOutcome::hangs) return outcome;
  const double load = own_load(situation, radius).value;
  const Vector3& pull = hangs.on_drone;
  const Vector3& wind = situation.air.wind;
  double along = std::max(0.0, -pull.x);
  double across = 0;
  if (const double speed = std::hypot(wind.x, wind.y); wind.y != 0 || wind.x > 0) {
    along = (pull.x * wind.x + pull.y * wind.y) / speed;
    across = (pull.x * wind.y - pull.y * wind.x) / speed;
  }
  shares = {
      along / load,  -pull.z / load, hangs.tension_at_drone / load, hangs.tension_at_station / load,
      across / load, hangs.length};
  return outcome;
}

namespace {

/// Whether what is paid out spans the distance and is there; a winch may pay it out.
bool reaches(const HangingSituation& situation) {
  if (situation.paid_out.winch_tension) return true;
  const double length = situation.paid_out.length.value_or(0);
  return length > std::hypot(situation.height, situation.offset) &&
         length <= situation.cable_there_is;
}

}  // namespace

std::optional<HangingSituation> normal_form(const HangingSituation& situation) {
  if (situation.paid_out.winch_tension || situation.cylinder) return std::nullopt;
  return normal_but_for_radius(situation);
}

std::optional<HangingSituation> normal_but_for_radius(const HangingSituation& situation) {
  const MovingAir& air = situation.air;
  const double height = situation.height;
  if (!(height > 0) || !reaches(situation) || situation.axial_stiffness || air.wind.y != 0 ||
      air.wind.z != 0 || air.drone_velocity != Vector3{}) {
    return std::nullopt;
  }
  HangingSituation normal{.weight = {1, 0, 0}, .width = {0, 2}, .air = {}, .paid_out = {}};
  normal.memory = situation.memory;
  normal.height = 1;
  normal.offset = situation.offset / height;
  if (situation.paid_out.length) {
    normal.paid_out.length = *situation.paid_out.length / height;
  } else {
    normal.paid_out.winch_tension = 1;
  }
  if (situation.cylinder) {
    normal.cylinder = {1, 0};
    normal.air.viscosity = 1;
  }
  normal.air.density = 1;
  normal.air.wind.x = air.wind.x > 0 ? 1 : -1;
  normal.air.profile = air.profile;
  if (air.profile == WindProfile::uniform) return normal;
  normal.air.even_share = air.even_share;
  normal.air.station_height = air.station_height / height;
  normal.air.reference_height = air.reference_height / height;
  if (air.profile == WindProfile::power_law) {
    normal.air.exponent = air.exponent;
  } else {
    normal.air.roughness_length = air.roughness_length / height;
  }
  return normal;
}

KnownCables& known_cables(const HangingSituation& situation) {
  // A flight log has thousands of states; a sweep over the wind solves up to fifty cables for each.
  thread_local KnownCables of_thread{1 << 13, {}, {}};
  return situation.memory != nullptr ? situation.memory->known() : of_thread;
}

std::shared_ptr<const SimilarCables> SimilarCables::of(const HangingSituation& situation) {
  const std::optional<HangingSituation> normal = normal_form(situation);
  if (!normal) return nullptr;
  KnownCables& known = known_cables(situation);
  if (known.similar.size() >= known.most) known.similar.clear();
  auto& cables = known.similar[*normal];
  if (!cables) cables = std::make_shared<const SimilarCables>(*normal);
  return cables;
}

double first_ratio(const HangingSituation& normal) {
  if (const double slack = slack_above_station(normal); slack > 0) return folded_below * slack;
  const double offset = normal.offset;
  const bool opposed = normal.air.profile == WindProfile::uniform && normal.air.wind.x < 0;
  // A hair beside the balance itself, where a cable takes a thousand times as long.
  constexpr double beside = 1 + 1e-5;
  return offset > 0 && opposed ? beside * offset * std::hypot(1, offset) : 1;
}

SimilarCables::SimilarCables(const HangingSituation& normal)
    : normal_(normal),
      first_(first_ratio(normal)),
      widest_(normal.memory != nullptr ? normal.memory->widest() : widest_piece),
      folds_(slack_above_station(normal) > 0) {}

std::optional<SimilarCables::At> SimilarCables::at(double ratio) const {
  if (ratio == 0) {
    if (!still_) still_ = solved_at(0);
    return still_;
  }
  const double octaves = std::log2(ratio / first_);
  if (!(std::abs(octaves) < most_octaves) || (folds_ && octaves < 0)) return solved_at(ratio);
  const auto [piece, from, width] = piece_about(
      pieces_, octaves, widest_, [this](Piece& p, double f, double w) { make(p, f, w); });
  if (piece->kind == Piece::Kind::solved_where_asked) return solved_at(ratio);
  return on(*piece, (octaves - from) / width);
}

std::optional<SimilarCables::At> SimilarCables::solved_at(double ratio) const {
  CableSolver solver;
  At at;
  if (solve_shares(normal_, solver, ratio, at.value) != CableOutcome::hangs) return std::nullopt;
  if (ratio == 0) return at;
  LoadShares below{};
  if (solve_shares(normal_, solver, ratio * std::exp(-slope_step), below) != CableOutcome::hangs) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < forces; ++i) at.slope[i] = (at.value[i] - below[i]) / slope_step;
  return at;
}

void SimilarCables::make(Piece& piece, double from, double width) const {
  using Known = CableMemory::Piece;
  Series value{};
  const CableMemory* memory = normal_.memory;
  const Known known = memory ? memory->along_ratio(normal_, from, width, value) : Known::not_known;
  if (known == Known::smooth || (known == Known::not_known && fit(value, from, width))) {
    const Series slope = slope_of(value, width);
    for (std::size_t k = 0; k <= load_degree; ++k) {
      std::copy_n(value[k].begin(), forces, piece.value_and_slope[k].begin());
      std::copy_n(slope[k].begin(), forces, piece.value_and_slope[k].begin() + forces);
    }
    piece.kind = Piece::Kind::smooth;
  } else if (width > narrowest_piece && known != Known::too_sharp) {
    piece.halves = std::make_unique<std::array<Piece, 2>>();
    piece.kind = Piece::Kind::halved;
  } else {
    piece.kind = Piece::Kind::solved_where_asked;
  }
}

bool SimilarCables::fit(Series& value, double from, double width) const {
  // Both ends from nothing, as the pieces beside this have them; between them each from the last.
  CableSolver solver(most_steps_for_load);
  Series solved{};
  double tension = 0;
  for (std::size_t j = 0; j <= load_degree; ++j) {
    if (j == load_degree) solver = CableSolver(most_steps_for_load);
    LoadShares shares{};
    const double ratio = first_ * std::exp2(load_place(from, width, j));
    if (solve_shares(normal_, solver, ratio, shares) != CableOutcome::hangs) return false;
    std::copy_n(shares.begin(), forces, solved[j].begin());
    tension = std::max(tension, shares[2]);
  }
  value = series_through(solved);
  return is_converged(value, tension);
}

SimilarCables::At SimilarCables::on(const Piece& piece, double share) const {
  const double x = 2 * share - 1;
  const auto there = value_at(piece.value_and_slope, x);
  At at;
  std::copy_n(there.begin(), forces, at.value.begin());
  std::copy_n(there.begin() + forces, forces, at.slope.begin());
  at.value.back() = *normal_.paid_out.length;
  return at;
}

}  // namespace tethercalc
