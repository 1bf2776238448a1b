// The load that a tether puts on the drone.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <unordered_map>

#include "tethercalc/model/design.hpp"
#include "tethercalc/model/hanging_cable.hpp"

namespace tethercalc {

/// What the drone and the ground feel of a tether in one flight state, with one conductor, however
/// it hangs. All +infinity where it cannot hang between station and drone.
struct TetherLoad {
  double along = 0;              ///< N at the drone against its motion through the air
  double down = 0;               ///< N at the drone downwards
  double tension_at_drone = 0;   ///< N
  double tension_at_ground = 0;  ///< N
  double mass = 0;               ///< kg in the air
  double length = 0;             ///< m in the air
  double across = 0;  ///< N at the drone, a quarter turn to the right of where the air goes

  /// N, what the cable has to stand.
  [[nodiscard]] double greatest_tension() const {
    return std::max(tension_at_drone, tension_at_ground);
  }
};

struct HangingSituation;

/// The tether that hangs straight between drone and ground, all of its weight, its drag and the
/// pull of the winch on the drone (paper section III-A and V-B), as functions of the conductor's
/// radius r in m, with what does not depend on r computed once. Mass is a quadratic in r, drag
/// linear in r, resistance linear in 1/r².
/// Refers to the tether, which must outlive it.
class StraightTether {
 public:
  /// `wall` in m of the insulation, `air_density` in kg/m³, `gravity` in m/s².
  StraightTether(const Tether& tether, double wall, const FlightState& state, double air_density,
                 double gravity);

  /// The same at another airspeed, sooner than anew.
  void set_airspeed(double airspeed);

  /// The load on the drone.
  [[nodiscard]] TetherLoad load(double radius) const {
    const double down = mass(radius) * gravity_ + winch_pull();
    const double along = drag(radius);
    return {along, down, std::hypot(down, along), winch_pull(), mass(radius), deployed_};
  }

  /// kg in the air.
  [[nodiscard]] double mass(double radius) const {
    return mass_0_ + radius * (mass_1_ + radius * mass_2_);
  }
  /// kg of `length` m of the tether.
  [[nodiscard]] double mass_of(double length, double radius) const;
  /// Derivative of the mass by the radius, kg/m.
  [[nodiscard]] double mass_slope(double radius) const { return mass_1_ + 2 * radius * mass_2_; }
  /// Second derivative, kg/m².
  [[nodiscard]] double mass_curvature() const { return 2 * mass_2_; }
  /// Radius at which the mass is `mass`; negative where even the thinnest tether is heavier.
  [[nodiscard]] double radius_of_mass(double mass) const;

  /// N at the drone, along the motion; ≥ 0.
  [[nodiscard]] double drag(double radius) const { return drag_0_ + drag_1_ * radius; }
  /// Its derivative by the radius, N/m.
  [[nodiscard]] double drag_slope() const { return drag_1_; }
  /// m, mean width that the wind meets.
  [[nodiscard]] double width(double radius) const {
    return 4 * tether_->projection_factor * (radius + width_);
  }
  /// The drag of a tether without thickness of metal, N.
  [[nodiscard]] double least_drag() const { return drag_0_; }

  /// N downwards at the ground end.
  [[nodiscard]] double winch_pull() const { return tether_->winch_pull; }

  /// Resistance of the loop in Ω without current: both conductors, the part on the drum, and the
  /// contacts, at the temperature of the air where the current warms the tether, else at its
  /// `conductor_temperature_C`.
  [[nodiscard]] double resistance(double radius) const {
    return contact_resistance() + resistance_area_ / (radius * radius);
  }
  /// The same with the conductor at these temperatures, °C, in the air and on the drum.
  [[nodiscard]] double resistance(double radius, double in_air_C, double on_drum_C) const;
  /// Derivative of `resistance(radius)` by the radius, Ω/m.
  [[nodiscard]] double resistance_slope(double radius) const {
    return -2 * resistance_area_ / (radius * radius * radius);
  }
  /// Radius at which the loop has `resistance`; +infinity where contacts alone have more.
  [[nodiscard]] double radius_of_resistance(double resistance) const {
    const double line = resistance - contact_resistance();
    return line > 0 ? std::sqrt(resistance_area_ / line) : std::numeric_limits<double>::infinity();
  }
  /// Ω of plugs and slip rings.
  [[nodiscard]] double contact_resistance() const { return tether_->contact_resistance; }
  /// Ω·m²: what the conductors' resistance is over r².
  [[nodiscard]] double resistance_area() const { return resistance_area_; }

 private:
  friend class TetherInFlight;
  friend HangingSituation hanging_situation(const Tether& tether, double wall,
                                            const FlightState& state, const Flight& flight);
  /// Ω of conductors of `radius` with these lengths in the air and on the drum at these °C.
  [[nodiscard]] double resistance(double radius, double in_air, double on_drum, double in_air_C,
                                  double on_drum_C) const;

  const Tether* tether_;
  double wall_;
  double deployed_;
  double on_drum_;
  double width_;  ///< m over a conductor's radius, a quarter of the width that the wind meets
  double half_density_;
  double gravity_;
  double mass_0_, mass_1_, mass_2_;  ///< mass = mass_0 + mass_1·r + mass_2·r²
  double resistance_area_;           ///< Ω·m², (R − R_contact)·r²
  double drag_0_, drag_1_;           ///< drag = drag_0 + drag_1·r, N
};

/// What the design has paid out to a drone `height` m over the station and `offset` m aside: what
/// the winch's pull leaves out, or the distance and `slack`.
[[nodiscard]] PaidOut paid_out_to(const Tether& tether, double height, double offset);

/// m on the drum while `in_air` m are out, where a straight tether would leave `state.on_drum`:
/// what more hangs in the air is taken from there. 0 where `in_air` is not finite.
[[nodiscard]] double left_on_drum(const FlightState& state, double in_air);

/// All that decides how a tether hangs, but for its conductor's radius r.
struct HangingSituation {
  std::array<double, 3> weight{};  ///< N/m: weight[0] + weight[1]·r + weight[2]·r²
  std::array<double, 2> width{};   ///< m across the wind: width[0] + width[1]·r
  double drag_coefficient = 1;     ///< of that width
  /// Set, that is times `cylinder_drag` of one conductor, cylinder[0] + cylinder[1]·r m wide.
  std::optional<std::array<double, 2>> cylinder{};
  MovingAir air;     ///< x points from the station to where the drone stands aside
  PaidOut paid_out;  ///< how much cable is out
  double cable_there_is = std::numeric_limits<double>::infinity();  ///< m, on the drum included
  std::optional<double> axial_stiffness{};                          ///< N, EA
  double offset = 0;                                                ///< m aside
  double height = 0;                                                ///< m over the station
  const CableMemory* memory = nullptr;                              ///< as in `Tether`

  /// m of one conductor with its insulation, where that decides the drag coefficient.
  [[nodiscard]] std::optional<double> cylinder_diameter(double radius) const;

  auto operator<=>(const HangingSituation&) const = default;  ///< member by member
};

/// That of a tether in one state of a design's flight, with `wall` m of insulation; the drone's own
/// motion counts as wind.
[[nodiscard]] HangingSituation hanging_situation(const Tether& tether, double wall,
                                                 const FlightState& state, const Flight& flight);

/// The same with the wall that the design's supply asks for.
[[nodiscard]] HangingSituation hanging_situation(const Design& design, const FlightState& state);

/// The bare cable with conductors of `radius` m: the weight of both with insulation and strength
/// member, and the mean width that `projection_factor` makes of them.
[[nodiscard]] Cable cable_of(const HangingSituation& situation, double radius);

/// A cable as it hangs in such a situation, or why it does not.
struct HangingOutcome {
  CableOutcome outcome =
      CableOutcome::not_found;  ///< `too_short` also where there is no more cable
  HangingCable cable;           ///< of `hangs`, and of a cable of which there is not as much
};

/// Solves the cable with conductors of `radius` m, from the solver's last solution; only of `hangs`
/// the solver has its shape.
[[nodiscard]] HangingOutcome solve_hanging(const HangingSituation& situation, CableSolver& solver,
                                           double radius);

/// Why a solved tether does not hang up to its drone.
struct NoWayUp {
  double area = 0;                                 ///< m², of its conductor
  CableOutcome outcome = CableOutcome::not_found;  ///< not `hangs`
  double needed = 0;  ///< m of cable, where there is not as much; else 0
};

/// That, with conductors of `area` m², solved anew.
[[nodiscard]] NoWayUp no_way_up(const Design& design, double area, Condition condition);

class SimilarCables;

/// What will be asked of a tether that hangs as weight and wind have it: a search asks for the
/// loads with conductors of many sizes, for which neighbours are solved, too; where one size is
/// held against many places of the drone that does not pay, and each load is solved by itself.
enum class ConductorsAsked { many, one };

/// About as far apart, as a ratio, as radii are looked at of a tether that hangs with conductors of
/// some and not of other sizes (see `TetherInFlight::hangs_alike`).
inline constexpr double hanging_step = 1.2;

/// m, 0.0003 mm²: tethers with thinner conductors hang as with these.
inline constexpr double thinnest_solved = 1e-5;

/// The load of a tether that hangs as weight and wind have it (`CableSolver`), as a smooth function
/// of its conductor's radius. Where length, place and profile of the wind are known, and the cable
/// does not stretch nor its drag depend on the Reynolds number, drag over weight decides how it
/// hangs, and `SimilarCables` have the load to about 1e-9 of the greatest tension.
/// Else the cable is solved at radii a quarter of an octave apart, when one between them is asked
/// for, and forces over the cable's own load, hypot(weight, drag)·height + winch tension, are cubic
/// in ln r between those, with their slopes: mostly within 1e-5 of the solver. Near the thickest
/// conductor that a winch holds they, and ln r, are cubics of the length, up to there and within
/// about 3e-4.
/// Where more is to be paid out than there is, it does not reach.
/// Where the solver finds no equilibrium, the cubic spans up to an octave; a cable with slack right
/// above its station that hardly any wind moves is taken as the fold it is in still air, all of its
/// drag on the drone.
///
/// Mostly a thicker conductor pulls more. Of a taut cable far aside in much wind weight and wind
/// may nearly balance each other; up to there its load falls, hardly ever faster than with 1/r.
/// Remembers what it solved; not for two threads at once.
class HangingLoad {
 public:
  /// Of the cable in this situation; nothing is solved yet.
  explicit HangingLoad(const HangingSituation& situation,
                       ConductorsAsked asked = ConductorsAsked::many);

  /// The parts of a load, N, and m of cable in the air.
  struct Parts {
    double along = 0;              ///< against the wind, ≥ 0 of a drone upwind
    double down = 0;               ///< at the drone
    double tension_at_drone = 0;   ///< N
    double tension_at_ground = 0;  ///< N
    double across = 0;             ///< of a wind from aside, see `TetherLoad`
    double length = 0;             ///< m
  };
  /// A load and its derivative by the radius. +infinity and 0 where the cable cannot hang.
  struct AtRadius {
    Parts value;  ///< N, m
    Parts slope;  ///< N/m, 1
  };
  /// m in the air, where that does not depend on the radius.
  [[nodiscard]] std::optional<double> fixed_length() const { return situation_.paid_out.length; }

  /// Whether it hangs with conductors of every radius up to this one, or with none of them.
  [[nodiscard]] bool hangs_alike(double up_to) const {
    return similar_ != nullptr || up_to <= thinnest_solved;
  }

  /// The load with conductors of `radius` ≥ 0; thinner ones than `thinnest_solved` have the forces
  /// of such over their own load.
  [[nodiscard]] const AtRadius& at(double radius) const;

 private:
  static constexpr std::size_t part_count = 6;
  using Values = std::array<double, part_count>;
  struct Node {
    CableOutcome outcome = CableOutcome::not_found;
    Values value{};
    Values slope{};
  };
  /// Shares of the cable's own load, and their derivatives by the radius.
  struct Shares {
    Values value{};
    Values slope{};
  };
  [[nodiscard]] std::optional<Shares> solved_alone(double radius) const;
  [[nodiscard]] std::optional<Shares> of_similar_cables(double radius) const;
  [[nodiscard]] std::optional<Shares> between_nodes(double radius) const;
  [[nodiscard]] Node solved_node(double log_radius) const;
  [[nodiscard]] const Node& node(long place) const;
  /// How far shares between two places that are `width` apart in ln r leave a parabola of it, of
  /// the tension or the length. Or by the length that a winch pays out, with ln r itself; infinite
  /// where that does not grow.
  [[nodiscard]] static double bend_between(const Node& a, const Node& b, double width,
                                           bool by_length);
  /// Two places about `log_radius` at which the cable hangs, and nothing is known against it
  /// between them; nothing where it does not.
  struct Places {
    long lo = 0;
    long hi = 0;
    bool by_length = false;  ///< shares are cubics of the length
    bool is_beyond = false;  ///< `log_radius` lies between `hi` and the place after it
  };
  [[nodiscard]] std::optional<Places> places_about(double log_radius) const;
  /// Radii between two solved cables, or one cable that stands for thinner ones.
  struct Stretch {
    const Node* lo = nullptr;
    const Node* hi = nullptr;
    double from = 0;         ///< ln r
    double width = 1;        ///< in ln r
    bool by_length = false;  ///< as of `Places`
    double begin = 0;        ///< ln r, for which it stands
    double end = 0;          ///< and up to which
  };
  [[nodiscard]] std::optional<Stretch> stretch_about(double log_radius) const;

  HangingSituation situation_;                    ///< as if there were any length of cable
  double cable_there_is_;                         ///< m
  std::shared_ptr<const SimilarCables> similar_;  ///< null where more decides how it hangs
  ConductorsAsked asked_;
  mutable std::unordered_map<long, Node> nodes_;
  mutable std::array<Stretch, 68> stretches_{};  ///< the last of each stride, from the thinnest
  /// Of the last radii that were asked for, each at a place that its digits decide.
  struct Known {
    double radius = std::numeric_limits<double>::quiet_NaN();
    AtRadius at;
  };
  mutable std::array<Known, 8> known_;
  [[nodiscard]] AtRadius computed_at(double radius) const;
};

/// The tether of a design in one flight state by the model that it asks for, as functions of its
/// conductor's radius r in m. Resistance falls with r. Of a straight tether weight and drag rise
/// with r; for a solved one see `HangingLoad`. Refers to the tether, which must outlive it.
class TetherInFlight {
 public:
  /// `wall` in m of the insulation.
  TetherInFlight(const Tether& tether, double wall, const FlightState& state, const Flight& flight,
                 ConductorsAsked asked = ConductorsAsked::many);

  /// The same tether in another state.
  void set_state(const FlightState& state, const Flight& flight) {
    straight_.set_airspeed(state.airspeed);
    hang(state, flight);
  }

  /// Whether it hangs as weight and wind have it, so that nothing of it is a polynomial of r.
  [[nodiscard]] bool is_solved() const { return hanging_ != nullptr; }

  /// Whether it hangs with conductors of every radius up to this one, or with none of them.
  [[nodiscard]] bool hangs_alike(double up_to = std::numeric_limits<double>::infinity()) const {
    return !hanging_ || hanging_->hangs_alike(up_to);
  }

  /// The load on the drone.
  [[nodiscard]] TetherLoad load(double radius) const;

  /// kg in the air; +infinity where it cannot hang.
  [[nodiscard]] double mass(double radius) const {
    return hanging_ ? hanging_mass(radius) : straight_.mass(radius);
  }
  /// N at the drone downwards beyond the weight of what is in the air.
  [[nodiscard]] double pull_beyond_weight(double radius) const {
    return hanging_ ? hanging_->at(radius).value.down - hanging_mass(radius) * straight_.gravity_
                    : straight_.winch_pull();
  }
  /// N/m, how the force at the drone downwards changes with the radius.
  [[nodiscard]] double down_slope(double radius) const {
    return hanging_ ? hanging_->at(radius).slope.down
                    : straight_.mass_slope(radius) * straight_.gravity_;
  }
  /// N at the drone against its motion through the air; ≥ 0 of a drone upwind.
  [[nodiscard]] double drag(double radius) const {
    return hanging_ ? hanging_->at(radius).value.along : straight_.drag(radius);
  }
  /// N at the drone across that, to the right of where the air goes; 0 of a drone upwind.
  [[nodiscard]] double across(double radius) const {
    return hanging_ ? hanging_->at(radius).value.across : 0;
  }
  /// Its derivative by the radius, N/m.
  [[nodiscard]] double drag_slope(double radius) const {
    return hanging_ ? hanging_->at(radius).slope.along : straight_.drag_slope();
  }

  /// Resistance of the loop in Ω, as `StraightTether` has it: of all that is in the air and on the
  /// drum, from which more cable in the air is taken.
  [[nodiscard]] double resistance(double radius) const {
    return contact_resistance() + resistance_area(radius) / (radius * radius);
  }
  /// The same with the conductor at these temperatures, °C, in the air and on the drum.
  [[nodiscard]] double resistance(double radius, double in_air_C, double on_drum_C) const;
  /// Derivative of `resistance(radius)` by the radius, Ω/m.
  [[nodiscard]] double resistance_slope(double radius) const;
  /// Radius at which the loop has `resistance`; +infinity where contacts alone have more.
  [[nodiscard]] double radius_of_resistance(double resistance) const;
  /// Radius beyond which the tension at the drone exceeds `tension` N, however a solved tether
  /// hangs; negative where that of every conductor does. The wind pushes across a cable only, so
  /// that along it T + T²/(2·EA) grows by the weight a metre times the height gained.
  [[nodiscard]] double radius_of_tension(double tension) const;
  /// How much more of a solved tether hangs in the air for a thicker conductor: d ln(length)/d
  /// ln(r), 0 where its length is given.
  [[nodiscard]] double length_growth(double radius) const {
    if (!hanging_ || hanging_->fixed_length()) return 0;
    const HangingLoad::AtRadius& at = hanging_->at(radius);
    return at.slope.length * radius / at.value.length;
  }
  /// m on the drum (`left_on_drum`).
  [[nodiscard]] double on_drum_with(double radius) const {
    return hanging_ ? on_drum(hanging_length(radius)) : straight_.on_drum_;
  }
  /// Ω of plugs and slip rings.
  [[nodiscard]] double contact_resistance() const { return straight_.contact_resistance(); }
  /// Ω·m²: what the conductors' resistance is over r².
  [[nodiscard]] double resistance_area(double radius) const {
    return hanging_ ? straight_.resistance_area() * circuit_share(radius)
                    : straight_.resistance_area();
  }

  /// The same cable straight down from the drone: what its mass and drag come to without a load.
  [[nodiscard]] const StraightTether& straight() const { return straight_; }

 private:
  /// Where the model asks for a solved tether.
  void hang(const FlightState& state, const Flight& flight);
  [[nodiscard]] double hanging_mass(double radius) const;
  [[nodiscard]] double hanging_length(double radius) const;
  [[nodiscard]] double on_drum(double in_air) const;
  /// Length of the circuit over that of a straight tether's.
  [[nodiscard]] double circuit_share(double radius) const;

  StraightTether straight_;
  ConductorsAsked asked_;
  std::shared_ptr<const HangingLoad> hanging_;
};

}  // namespace tethercalc
