// A tether by itself, hanging straight, asked by the area of its conductors.
#pragma once

#include "tethercalc/model/tether_load.hpp"

namespace tethercalc::test {

inline StraightTether straight(const Tether& tether, double airspeed = 0) {
  return {tether, tether.insulation.thickness,
          FlightState{airspeed, tether.length, tether.spooled_length, 20}, 1.293, 9.80665};
}

inline double airborne_mass(const Tether& tether, double area) {
  return straight(tether).mass(conductor_radius(area));
}

inline double loop_resistance(const Tether& tether, double area) {
  return straight(tether).resistance(conductor_radius(area));
}

}  // namespace tethercalc::test
