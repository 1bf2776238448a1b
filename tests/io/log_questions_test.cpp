// What is asked of logs, whoever asks.
#include "io/log_questions.hpp"

#include <catch2/catch.hpp>

#include "tethercalc/model/units.hpp"

using namespace tethercalc;

TEST_CASE("an answer is headed by its only log, or by how many flights there are") {
  CHECK(heading_of({"logs/today/flight.bin"}) == "flight.bin");
  CHECK(heading_of({"flight.bin"}) == "flight.bin");
  CHECK(heading_of({"-"}) == "standard input");
  CHECK(heading_of({"a.bin", "b.bin", "c.bin"}) == "3 flights");
}

TEST_CASE("a flight is that of its design, but for the mass and the air that were told") {
  Design design;
  design.drone.mass = 2;
  design.flight.air_density = 1.1;
  design.flight.gravity = 3.71;
  const auto taken = [&](const FlightOptions& options) {
    return identification_options(flown_as(options, design), {}).conditions;
  };
  CHECK(taken({}).mass == Approx(2));
  CHECK(taken({}).air_density == Approx(1.1));
  CHECK(taken({}).gravity == Approx(3.71));
  FlightOptions told;
  told.mass_g = 1500;
  told.pressure_hPa = 1013.25;
  told.temperature_C = 15;
  CHECK(taken(told).mass == Approx(1.5));
  CHECK(taken(told).air_density == Approx(1.225).epsilon(1e-4));
  told.air_density_kg_m3 = 1.2;
  told.pressure_hPa = told.temperature_C = std::nullopt;
  CHECK(taken(told).air_density == Approx(1.2));
  CHECK(identification_options(told, {}).conditions.gravity == Approx(standard_gravity));
}
