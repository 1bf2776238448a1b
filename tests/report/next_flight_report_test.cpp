// What is told of a planned flight.
#include "tethercalc/report/next_flight_report.hpp"

#include <catch2/catch.hpp>

using namespace tethercalc;

TEST_CASE("an area that begins at home begins at no distance, which has no sign") {
  NextFlight flight;
  flight.limits = {.speed = 8, .acceleration = 2, .height = 10, .ceiling = 20, .reach = 60};
  flight.decides.push_back({.effect = "wind", .told_from = {}});
  Manoeuvre out_and_back;
  out_and_back.words = "out and back";
  out_and_back.waypoints = {{.north = 40, .east = 0, .height = 12},
                            {.north = 0, .east = -0.2, .height = 12}};
  flight.manoeuvres = {out_and_back};
  const std::string told = next_flight_text(flight, "next.plan");
  CAPTURE(told);
  CHECK(told.find("from 0 m south to 40 m north") != std::string::npos);
  CHECK(told.find("from 0 m west to 0 m") != std::string::npos);
}
