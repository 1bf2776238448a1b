// The drag estimated from the mass, against what others published.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "tethercalc/model/airframe.hpp"

using namespace tethercalc;

TEST_CASE("at the published drone's mass the estimate is the published drag, named an estimate") {
  const AirframeDrag drag = drag_of_mass(1.549);
  CHECK(drag.front_area == Approx(0.01451).epsilon(1e-12));
  CHECK(drag.top_area == Approx(0.01361).epsilon(1e-12));
  CHECK(drag.linear_speed == Approx(19.27).epsilon(1e-12));
  CHECK(drag.is_estimate);
  CHECK_FALSE(AirframeDrag{}.is_estimate);
}

TEST_CASE("eight times the mass has four times the area, and eight times the drag of slow flight") {
  const AirframeDrag light = drag_of_mass(1);
  const AirframeDrag heavy = drag_of_mass(8);
  CHECK(heavy.front_area == Approx(4 * light.front_area).epsilon(1e-12));
  CHECK(heavy.top_area == Approx(4 * light.top_area).epsilon(1e-12));
  const double slow = 1e-3;
  CHECK(airframe_drag_force(heavy, 1.2, slow, 0) ==
        Approx(8 * airframe_drag_force(light, 1.2, slow, 0)).epsilon(1e-3));
}

TEST_CASE("drones whose flight others published drag within the stated factor of the estimate") {
  // Steady flight without wind: the drag is m·g·tan θ.
  struct Flown {
    std::string name;
    double mass;      // kg
    double airspeed;  // m/s
    double tilt_deg;
    double air_density;  // kg/m³
  };
  // ArduPilot, Tools/autotest/models: freestyle.json (607 m above the sea, 25 °C) and Callisto.json
  // (26 m, 25 °C); NASA's 3DR Solo at 6.1 m/s in a wind tunnel (Russell et al. 2016).
  for (const Flown& f :
       {Flown{"freestyle of 5 inch", 0.8, 20, 45, 1.10}, Flown{"Callisto", 32.5, 25, 30, 1.18},
        Flown{"3DR Solo", 1.5, 6.1, 6, 1.2}}) {
    INFO(f.name);
    const double t = std::tan(f.tilt_deg * 0.017453292519943295);
    const double flown = f.mass * 9.80665 * t;
    const double estimate = airframe_drag_force(drag_of_mass(f.mass), f.air_density, f.airspeed, t);
    CHECK(flown / estimate < drag_estimate_factor);
    CHECK(flown / estimate > 1 / drag_estimate_factor);
  }
  // The body alone, as a flat plate of 0.0327 ft²·(weight/lb)^0.8903: Russell et al., NASA
  // TM-2018-219758, as fitted by Kadhiresan and Duffy, AIAA 2019-2873.
  for (const double mass : {1.5, 5.0, 30.0}) {
    const double plate = 0.0327 * std::pow(mass / 0.45359237, 0.8903) * 0.3048 * 0.3048;
    CHECK(plate / drag_of_mass(mass).front_area < drag_estimate_factor);
    CHECK(plate / drag_of_mass(mass).front_area > 1 / drag_estimate_factor);
  }
}
