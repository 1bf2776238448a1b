// A cable that a winch holds with a known tension, in one plane with its drone and an even wind.
#pragma once

#include <optional>

namespace tethercalc {

/// A cable from a winch at (0, 0) to a drone at (`aside`, `height`), in any units of force and
/// length that agree.
struct WinchedCable {
  double weight = 0;  ///< a unit of length
  double drag = 0;    ///< of a unit of length across the wind; negative where it blows towards −x
  double tension = 0;  ///< at the winch
  double aside = 0;
  double height = 0;
};

/// The tauter of the two cables that a winch may hold.
struct TautCable {
  bool hangs = false;  ///< else the winch pulls with less than any such cable needs
  struct Place {
    double along_x = 0;  ///< direction, towards the drone
    double along_z = 0;
    double tension = 0;
  };
  Place at_winch;
  Place at_drone;
  Place slackest;
  double length = 0;
  double sigma = 0;   ///< ∫ ds/T from the winch to the drone
  double before = 0;  ///< share of it from the winch to the slackest place
};

/// With φ the angle of the cable over x, w its weight and D its drag, T·dφ/ds = w·cos φ +
/// D·sin φ·|sin φ| and dT = w·dz, so that ln T is an elementary function of φ (Berteaux, Buoy
/// Engineering, 1976, chapter 4, has those of a towed cable) and φ one of the height. One integral
/// over the height is left, that of the way aside, by which the angle at the winch is found: with
/// that angle the way aside rises to a greatest one and falls again, and a drone beyond it is held
/// by no cable. To about 1e-9. Nothing where the drone is not above the winch, the drag far more
/// than the weight, the tension far more than the load or next to none, or the search does not end.
[[nodiscard]] std::optional<TautCable> taut_cable(const WinchedCable& cable);

}  // namespace tethercalc
