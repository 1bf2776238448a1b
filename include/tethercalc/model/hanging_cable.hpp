// A cable in three dimensions with weight and wind, from its station to the drone.
#pragma once

#include <array>
#include <compare>
#include <optional>
#include <vector>

#include "tethercalc/model/catenary.hpp"
#include "tethercalc/model/moving_air.hpp"

namespace tethercalc {

/// A flexible cable, the same all along.
struct Cable {
  double weight = 0;            ///< N/m without tension, ≥ 0
  double diameter = 0;          ///< m, mean width that the wind meets
  double drag_coefficient = 1;  ///< of that width, for the wind across it

  /// m. Set, the drag coefficient is times that of a smooth cylinder of this diameter at the
  /// Reynolds number of the wind across it (`cylinder_drag`).
  std::optional<double> cylinder_diameter{};

  /// N, EA: relative stretch is tension over this. Nothing: it does not stretch.
  std::optional<double> axial_stiffness{};

  auto operator<=>(const Cable&) const = default;  ///< member by member
};

/// N/m, drag of a cable that stands across a wind of `speed` m/s.
[[nodiscard]] double drag_across(const Cable& cable, const MovingAir& air, double speed);

/// What is known of a cable's length.
struct PaidOut {
  /// m without tension; else the winch decides.
  std::optional<double> length{};
  /// N at the station, which a winch holds. One of both is set.
  std::optional<double> winch_tension{};

  auto operator<=>(const PaidOut&) const = default;  ///< member by member
};

/// Whether a cable has a shape, and why not.
enum class CableOutcome {
  hangs,            ///< solved
  too_short,        ///< it does not reach and does not stretch
  tension_too_low,  ///< the winch's tension cannot hold the cable up between the two points
  not_found,        ///< no equilibrium was found; nothing is claimed
};

/// A cable in equilibrium between (0, 0, 0) and the drone.
struct HangingCable {
  double length = 0;     ///< m, without tension
  Vector3 on_drone{};    ///< N, the force on the drone
  Vector3 on_station{};  ///< N, the force on the station

  /// N, tensions at the ends.
  double tension_at_drone = 0;
  double tension_at_station = 0;  ///< N
};

/// A point of a hanging cable.
struct CablePoint {
  double s = 0;        ///< m along the cable without tension, from the station
  Vector3 position{};  ///< m
  double tension = 0;  ///< N
};

/// The shape of a cable, at points evenly spread along it.
struct CableShape {
  std::vector<CablePoint> points;  ///< the first at the station, the last at the drone

  /// Of the points (in still air with a known length, of the cable) the lowest, and those with the
  /// least and the greatest tension.
  CablePoint lowest;
  CablePoint slackest;  ///< least tension
  CablePoint tautest;   ///< greatest tension
};

/// Solves cables one after the other and starts each from the last, as a controller asks.
///
/// Equilibrium of a perfectly flexible cable, N' = w·ẑ − ½·ρ·C·d·|v_n|·v_n with the tension N along
/// it and v_n the part of the air's velocity across it (the cross-flow principle, Hoerner 1965,
/// "Fluid-Dynamic Drag", 3-11), r' = N/|N|·(1 + |N|/EA), primes by the length without tension. With
/// dσ = ds/|N| as the variable the direction of the cable does not depend on its tension, and
/// places with next to none are as smooth as others. Direction and tension at the station and
/// the end of σ are found by Newton's method with exact derivatives, from the cable under even load
/// (a catenary in the load's own plane) or, where that does not lead there, with that load turned
/// into the true one in steps. A cable in one plane with an even wind, on a winch or of a length
/// that does not stretch, is known but for integrals, and solved anew each time. Forces are good to
/// 1e-8 of the greatest, mostly to 1e-10.
///
/// Not in it: bending and torsion, drag along the cable, lift, vibration, the ground, waves along
/// the cable (it is taken to follow at once).
class CableSolver {
 public:
  /// Gives up after `most_steps` steps along cables: a usual one takes a hundred, one that is hard
  /// to find thousands, of a few microseconds each.
  explicit CableSolver(int most_steps = 100000) : most_steps_(most_steps) {}

  /// Solves a cable between (0, 0, 0) and `drone` (m; not the same place). `cable` and `air` as
  /// their members say, a length > 0 or a tension > 0.
  /// @throws std::invalid_argument for values out of those ranges.
  CableOutcome solve(const Cable& cable, const MovingAir& air, const PaidOut& paid_out,
                     const Vector3& drone);

  /// The cable that was solved last. Only after `hangs`.
  [[nodiscard]] HangingCable result() const;

  /// Its shape at `pieces` + 1 points, `pieces` ≥ 1. Only after `hangs`.
  [[nodiscard]] CableShape shape(int pieces) const;

  /// How the force on the drone changes, by column, with x, y and z of something.
  using Derivative = std::array<Vector3, 3>;

  /// Derivatives of the force on the drone. Only after `hangs`.
  struct Derivatives {
    Derivative by_position{};  ///< N/m, of the drone
    Derivative by_wind{};      ///< N·s/m, of the wind at the reference height
  };
  /// Exact, from the same equations. What is held, length or winch tension, stays.
  [[nodiscard]] Derivatives derivatives() const;

 private:
  struct Problem;

  int most_steps_;
  Cable cable_;
  MovingAir air_;
  PaidOut paid_out_;
  Vector3 drone_;
  /// A place on the cable from which it is followed both ways, and where that leads.
  struct Last {
    Vector3 position{};   ///< of the place
    Vector3 direction{};  ///< of the cable there, towards the drone
    double tension = 0;
    double sigma = 0;   ///< from the station to the drone
    double before = 0;  ///< share of it that lies before the place
    /// What is found at the ends, or how that changes with an unknown.
    struct Ends {
      Vector3 at_station{};  ///< tension along the cable
      Vector3 at_drone{};    ///< the same
      double length = 0;     ///< paid out
    };
    Ends ends;
    std::array<Ends, 7> by_unknowns{};
    std::array<double, 49> inverse{};  ///< of how the ends follow the unknowns
  };
  std::optional<Last> last_;
  bool can_go_on_ = true;  ///< `last_` has what Newton's method goes on from
  /// Of the last cable that lay in a plane, from which the next such is found.
  std::optional<std::array<double, 2>> planar_ends_;
  std::optional<Catenary> still_;  ///< instead, in still air with a known length

  [[nodiscard]] Problem problem() const;
  [[nodiscard]] Vector3 ahead() const;
  [[nodiscard]] CableShape catenary_shape(int pieces) const;
  [[nodiscard]] Derivatives catenary_derivatives() const;
};

}  // namespace tethercalc
