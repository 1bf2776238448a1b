// Figures of merit and the motor that nobody measured, against momentum theory written out.
#include "tethercalc/study/motor.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tethercalc/io/library.hpp"

using namespace tethercalc;

namespace {

/// Thrust times the speed of the air through the disc, v = √(T/(2ρA)).
double thrust_times_induced_speed(double thrust, double diameter, double density) {
  const double area = std::numbers::pi * diameter * diameter / 4;
  return thrust * std::sqrt(thrust / (2 * density * area));
}

}  // namespace

TEST_CASE("ideal hover power is thrust times induced speed") {
  for (const double thrust : {0.5, 4.0, 80.0}) {
    CHECK(ideal_hover_power(thrust, 0.3, 1.1) ==
          Approx(thrust_times_induced_speed(thrust, 0.3, 1.1)).epsilon(1e-14));
  }
  CHECK(ideal_hover_power(0, 0.3, 1.1) == 0);
}

TEST_CASE("a generic motor has its figure of merit at its points and, nearly, between them") {
  const GenericMotorRequest request{0.7, 0.6, 80, 1.1};
  const MotorCurve curve = generic_motor_curve(request);
  CHECK(curve.max_thrust() == Approx(80).epsilon(1e-14));
  CHECK(curve.measured_in() == 1.1);
  for (double thrust = 4; thrust <= 80; thrust += 0.37) {
    const double expected = thrust_times_induced_speed(thrust, 0.7, 1.1) / 0.6;
    CHECK(curve.power(thrust) >= expected * (1 - 1e-12));
    CHECK(curve.power(thrust) <= expected * 1.001);
  }
  MotorEntry motor;
  motor.curve = curve;
  CHECK(figures_of_merit(motor).empty());  // the propeller is not known
  motor.propeller_in = 0.7 / 0.0254;
  for (const double merit : figures_of_merit(motor)) CHECK(merit == Approx(0.6).epsilon(1e-9));
}

TEST_CASE("what cannot be a motor is refused") {
  CHECK_THROWS_AS(generic_motor_curve({0.7, 1.0, 80, 1.1}), std::invalid_argument);
  CHECK_THROWS_AS(generic_motor_curve({0, 0.6, 80, 1.1}), std::invalid_argument);
  CHECK_THROWS_AS(figure_of_merit_spread({}), std::invalid_argument);
}

TEST_CASE("the band holds the power of 95 % of the library's measured points") {
  const std::vector<MotorEntry> library = library_motors();
  const FigureOfMeritSpread spread = figure_of_merit_spread(library);
  std::size_t points = 0;
  std::size_t within = 0;
  for (const MotorEntry& motor : library) {
    REQUIRE(motor.propeller_in);
    const double diameter = *motor.propeller_in * 0.0254;
    for (const MotorPoint& point : motor.curve.vertices().subspan(1)) {
      const double guess = thrust_times_induced_speed(point.thrust, diameter,
                                                      motor.curve.measured_in().value_or(1.225)) /
                           spread.median;
      ++points;
      if (std::abs(point.power / guess - 1) <= spread.power_band * (1 + 1e-12)) ++within;
    }
  }
  CHECK(points == spread.points);
  CHECK(double(within) >= 0.95 * double(points));
  CHECK(double(within) <= 0.97 * double(points));
  // Of these 34 motors: 0.293 (5 inch, 85.2 g for 14.81 W) to 0.691 (15 inch, 430 g
  // for 23.68 W: 8.659 N/23.68 W·√(4.217 N/(2·1.225 kg/m³·0.11401 m²))).
  CHECK(spread.least == Approx(0.293).margin(0.001));
  CHECK(spread.greatest == Approx(0.692).margin(0.002));
}

TEST_CASE("the motors alike are the own one and the eight nearest in greatest thrust") {
  const auto entry = [](const std::string& id, double newton) {
    MotorEntry motor;
    motor.id = id;
    motor.curve = MotorCurve({{newton / 2, newton}, {newton, 3 * newton}});
    return motor;
  };
  std::vector<MotorEntry> library;
  for (int i = 1; i <= 12; ++i) library.push_back(entry("m" + std::to_string(i), i));
  const auto ids = [](const std::vector<MotorEntry>& motors) {
    std::string out;
    for (const MotorEntry& motor : motors) out += motor.id + " ";
    return out;
  };
  // By ratio 11 is nearer to 5 than 2 is.
  CHECK(ids(alike_motors(library, library[4])) == "m3 m4 m5 m6 m7 m8 m9 m10 m11 ");
  CHECK(ids(alike_motors(library, entry("mine", 5))) == "m3 m4 m5 m6 m7 m8 m9 m10 mine ");
  CHECK(ids(alike_motors({}, library[0])) == "m1 ");
}
