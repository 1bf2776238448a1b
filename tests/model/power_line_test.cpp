#include "tethercalc/model/power_line.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/random.hpp"

using namespace tethercalc;

TEST_CASE("the lowest received voltage is the cut-off or half the supply") {
  CHECK(lowest_received_voltage(100, 20) == 50);
  CHECK(lowest_received_voltage(100, 60) == 60);
}

TEST_CASE("no more power arrives than at half the voltage") {
  CHECK(available_power(100, 0, 10) == Approx(100.0 * 100 / 4 / 10));
  CHECK(available_power(100, 80, 10) == Approx(80.0 * 20 / 10));
  CHECK(available_power(100, 100, 10) == 0);
  CHECK(available_power(100, 120, 10) == 0);
}

TEST_CASE("supplied power is the smaller root of the line's quadratic") {
  // 10 A over 2 ohm from 100 V: 200 W lost, 800 W arrive.
  CHECK(supplied_power(100, 2, 800) == Approx(1000));
  CHECK(supplied_power(100, 0, 800) == 800);
  // The most that arrives is U²/4R, at twice that from the supply.
  CHECK(supplied_power(100, 2, 1250) == Approx(2500));
  CHECK(std::isnan(supplied_power(100, 2, 1250.001)));
  CHECK(std::isnan(supplied_power(100, 2, std::nan(""))));
}

TEST_CASE("supplied power keeps its digits for a tiny resistance") {
  // y = P + R(P/U)² + 2R²P³/U⁴ + …: for a loss of 1e-9 of the power the series ends here.
  const double power = 500;
  const double voltage = 400;
  const double resistance = 1e-9 * voltage * voltage / power;
  const double loss = resistance * power * power / (voltage * voltage);
  CHECK(supplied_power(voltage, resistance, power) - power == Approx(loss).epsilon(1e-6));
}
