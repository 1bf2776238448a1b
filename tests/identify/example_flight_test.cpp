// The simulated flight that the examples ship, and the way to write it anew:
// test_identify "[write-example]".
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "support/flight_csv.hpp"
#include "support/simulated_flight.hpp"
#include "tethercalc/identify/drag_identification.hpp"

using namespace tethercalc;

namespace {

const std::filesystem::path example =
    std::filesystem::path(TETHERCALC_SOURCE_DIR) / "examples" / "simulated-flight.csv";

test::SimulatedFlight example_flight() {
  test::SimulatedFlight f;
  f.mass = 1.55;
  f.duration = 440;
  f.idle = 30;
  f.wind = -0.9;
  f.pitch_offset = 0.8 * unit::degree;
  f.seed = 2024;
  return f;
}

}  // namespace

TEST_CASE("the example flight is what the simulator flies, to the digits written") {
  const FlightLog written = test::read_flight_csv(example);
  const FlightLog flown = test::simulate(example_flight());
  REQUIRE(written.time.size() == flown.time.size());
  for (std::size_t i = 0; i < flown.time.size(); ++i) {
    REQUIRE(written.time[i] == Approx(flown.time[i]).margin(1e-6));
    REQUIRE(written.pitch[i] == Approx(flown.pitch[i]).margin(0.006 * unit::degree));
    REQUIRE(written.north_velocity[i] == Approx(flown.north_velocity[i]).margin(1e-4));
  }
}

TEST_CASE("the example flight gives back the drag it was flown with") {
  const auto truth = example_flight();
  const FlightLog log = test::read_flight_csv(example);
  DragIdentificationOptions options;
  options.conditions = {truth.mass, truth.air_density, standard_gravity};
  options.pitch_offset = truth.pitch_offset;
  const DragFit fit = identify_drag({&log, 1}, options).fit;
  const double expected[] = {truth.front_area, truth.top_area, truth.linear_speed, truth.wind};
  for (std::size_t i = 0; i < 4; ++i) {
    const Estimate& e = fit.parameters[i].estimate;
    CHECK(std::abs(e.value - expected[i]) < 3 * e.standard_error);
  }
}

TEST_CASE("write the example flight", "[.][write-example]") {
  const FlightLog log = test::simulate(example_flight());
  std::ofstream file(example);
  file << "time_s,roll_deg,pitch_deg,yaw_deg,vn_m_s,ve_m_s,vd_m_s\n";
  for (std::size_t i = 0; i < log.time.size(); ++i) {
    file << fmt::format("{:.6f},{:.2f},{:.2f},{:.2f},{:.5f},{:.5f},{:.5f}\n", log.time[i],
                        log.roll[i] / unit::degree, log.pitch[i] / unit::degree,
                        log.yaw[i] / unit::degree, log.north_velocity[i], log.east_velocity[i],
                        log.down_velocity[i]);
  }
}
