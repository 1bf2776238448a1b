// A cable in one plane with its drone and an even wind.
#pragma once

#include <array>
#include <optional>

namespace tethercalc {

/// A cable from its station at (0, 0) to a drone at (`aside`, `height`), in any units of force and
/// length that agree.
struct PlanarCable {
  double weight = 0;  ///< a unit of length
  double drag = 0;    ///< of a unit of length across the wind; negative where that blows to −x
  double compliance = 0;  ///< 1/EA: of a unit of force
  double aside = 0;
  double height = 0;
};

/// Where on the curve that all such cables are parts of one begins and ends.
using PlanarEnds = std::array<double, 2>;

/// How it hangs.
struct PlanarShape {
  bool hangs = false;  ///< else the winch pulls with less than any such cable needs
  struct Place {
    double along_x = 0;  ///< direction, towards the drone
    double along_z = 0;
    double tension = 0;
  };
  Place at_station;
  Place at_drone;
  Place slackest;
  double length = 0;  ///< without tension
  double sigma = 0;   ///< ∫ ds/T from the station to the drone
  double before = 0;  ///< share of it from the station to the slackest place
  PlanarEnds ends{};
};

// With φ the angle of the cable over x, w its weight, D its drag and s its length without tension,
// T·dφ/ds = w·cos φ + D·sin φ·|sin φ| and dT/ds = w·sin φ, so that ln T is an elementary function
// of φ (Berteaux, Buoy Engineering, 1976, chapter 4, has those of a towed cable). Heights follow
// from the tensions by w·dz = (1 + T/EA)·dT, and integrals are left for the way aside and the
// length. To about 1e-9. Nothing where the drag is far more than the weight, load and chord are in
// line, or a search does not end. From `near`, the ends of a cable much like it, one is found in
// half of the time.

/// The tauter of the two cables that a winch holds with this tension at the station. By the angle
/// there: with it the way aside rises to a greatest one and falls again, and a drone beyond that is
/// held by no cable. Nothing also where the drone is not above the winch, the tension far more than
/// the load or next to none.
[[nodiscard]] std::optional<PlanarShape> held_by_winch(const PlanarCable& cable, double tension,
                                                       const std::optional<PlanarEnds>& near = {});

/// The tension at the station below which a winch does not hold it; its compliance is 0. Nothing
/// also where any tension holds it, that has no such bound, or `held_by_winch` has no answer.
[[nodiscard]] std::optional<double> least_winch_tension(const PlanarCable& cable);

/// The one that is that long; its compliance is 0. Nothing also where it hardly reaches.
[[nodiscard]] std::optional<PlanarShape> of_length(const PlanarCable& cable, double length,
                                                   const std::optional<PlanarEnds>& near = {});

}  // namespace tethercalc
