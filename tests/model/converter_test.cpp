#include "tethercalc/model/converter.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <stdexcept>

#include "support/plain_physics.hpp"
#include "support/random_designs.hpp"

using namespace tethercalc;

TEST_CASE("a converter's efficiency is straight between points and constant outside") {
  const Converter converter{{{100, 0.8}, {300, 0.9}}, 0};
  CHECK(efficiency_at(converter, 0) == 0.8);
  CHECK(efficiency_at(converter, 100) == 0.8);
  CHECK(efficiency_at(converter, 200) == Approx(0.85));
  CHECK(efficiency_at(converter, 300) == Approx(0.9));
  CHECK(efficiency_at(converter, 900) == 0.9);
  CHECK(converter_input_power(converter, 200) == Approx(200 / 0.85));
}

TEST_CASE("a converter without input gives no output, and infinite load stays infinite") {
  const Converter converter{{{100, 0.8}, {300, 0.9}}, 0};
  CHECK(converter_output_power(converter, 0) == 0);
  CHECK(converter_output_power(converter, -5) == 0);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  CHECK(converter_input_power(converter, infinity) == infinity);
  CHECK(converter_input_power(Converter{}, infinity) == infinity);
}

TEST_CASE("converter input and output are each other's inverse") {
  test::each_random(500, [](test::Random& random) {
    const Converter converter = test::random_converter(random, 100);
    validate(converter);
    for (int i = 0; i < 20; ++i) {
      const double output = random.magnitude(0.1, 3000);
      const double input = output / test::plain::efficiency(converter, output);
      CHECK(converter_input_power(converter, output) == Approx(input).epsilon(1e-12));
      CHECK(converter_output_power(converter, input) == Approx(output).epsilon(1e-12));
    }
  });
}

TEST_CASE("a converter curve that cannot be inverted is refused") {
  CHECK_THROWS_AS(validate({{}, 0}), std::invalid_argument);
  CHECK_THROWS_AS(validate({{{0, 0}}, 0}), std::invalid_argument);
  CHECK_THROWS_AS(validate({{{0, 1.01}}, 0}), std::invalid_argument);
  CHECK_THROWS_AS(validate({{{10, 0.9}, {10, 0.8}}, 0}), std::invalid_argument);
  CHECK_THROWS_AS(validate({{{-1, 0.9}, {10, 0.8}}, 0}), std::invalid_argument);
  // 100 W at 50 % draws 200 W, 110 W at 99 % would draw 111 W.
  CHECK_THROWS_AS(validate({{{100, 0.5}, {110, 0.99}}, 0}), std::invalid_argument);
}

TEST_CASE("a converter weighs what its table says, between and beyond the points") {
  Converter converter;
  converter.masses = {{200, 0.080}, {600, 0.160}};
  const auto mass_at = [&](double rated) {
    converter.rated_output_power = rated;
    return converter_mass(converter);
  };
  CHECK(mass_at(400) == Approx(0.120));
  CHECK(mass_at(600) == Approx(0.160));
  CHECK(mass_at(50) == 0.080);                // nothing smaller is sold
  CHECK(mass_at(1800) == Approx(3 * 0.160));  // three of them
  converter.rated_output_power.reset();
  CHECK(converter_mass(converter) == 0);

  CHECK_NOTHROW(validate(converter.masses));
  CHECK_THROWS_AS(validate(std::vector<ConverterMassPoint>{{200, 0.1}, {200, 0.2}}),
                  std::invalid_argument);
  CHECK_THROWS_AS(validate(std::vector<ConverterMassPoint>{{200, 0.2}, {300, 0.1}}),
                  std::invalid_argument);
  CHECK_THROWS_AS(validate(std::vector<ConverterMassPoint>{{0, 0.2}}), std::invalid_argument);
}

TEST_CASE(
    "a converter known by its losses draws output, fixed part and square, and gives them back") {
  Converter converter{{{0.0, 0.5}}};
  converter.losses = {15, 1.5e-4};
  // 400 W: 15 W fixed and 1.5e-4·160 000 W = 24 W in the windings.
  CHECK(converter_input_power(converter, 400) == Approx(439).epsilon(1e-14));
  CHECK(efficiency_at(converter, 400) == Approx(400.0 / 439).epsilon(1e-14));
  CHECK(converter_output_power(converter, 439) == Approx(400).epsilon(1e-14));
  CHECK(converter_output_power(converter, 14.9) == 0);
  CHECK(std::isinf(converter_input_power(converter, std::numeric_limits<double>::infinity())));
  converter.losses = {15, 0};
  CHECK(converter_output_power(converter, 115) == Approx(100).epsilon(1e-14));
  CHECK(std::isinf(converter_input_power(converter, std::numeric_limits<double>::infinity())));
}
