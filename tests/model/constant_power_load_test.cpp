#include <catch2/catch.hpp>
#include <cmath>

#include "support/straight_tether.hpp"
#include "tethercalc/model/power_line.hpp"
#include "tethercalc/model/steady_flight.hpp"

using namespace tethercalc;

TEST_CASE("600 W behind 100 m of AWG 18 need more than 48 V") {
  // Copper of IEC 60287 (0.01724 Ω·mm²/m) and 0.823 mm²: I = (U − √(U² − 4RP))/2R.
  Tether tether;
  tether.length = 100;
  tether.conductor = {0.01724e-6, 0.00393, 8890};
  CHECK(test::loop_resistance(tether, 0.823e-6) == Approx(4.19).margin(0.005));
  const double resistance = 4.19;  // as rounded for the currents below
  CHECK(std::isnan(supplied_power(48, resistance, 600)));
  CHECK(available_power(48, 0, resistance) == Approx(137).margin(0.5));
  const auto current = [&](double voltage) {
    return supplied_power(voltage, resistance, 600) / voltage;
  };
  CHECK(current(120) == Approx(6.455).margin(0.0005));
  CHECK(120 * current(120) - 600 == Approx(174.6).margin(0.05));
  CHECK(current(200) == Approx(3.217).margin(0.0005));
  CHECK(200 * current(200) - 600 == Approx(43.4).margin(0.05));
}
