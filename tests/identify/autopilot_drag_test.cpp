// A drag fit as autopilots take it, against their own laws written down once more.
#include "tethercalc/identify/autopilot_drag.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "support/flight_csv.hpp"
#include "support/reference_data.hpp"
#include "support/simulated_flight.hpp"
#include "tethercalc/identify/drag_identification.hpp"

using namespace tethercalc;

namespace {

DragFit fit_of(const test::SimulatedFlight& truth) {
  const FlightLog log = test::simulate(truth);
  DragIdentificationOptions options;
  options.conditions = {truth.mass, truth.air_density, standard_gravity};
  return identify_drag({&log, 1}, options).fit;
}

/// A fit of these numbers, known to a percent each and independently.
DragFit fit_with(double front_area, double linear_speed, double side_area) {
  DragFit fit;
  fit.conditions = {2.0, 1.0, standard_gravity};
  const auto add = [&](const char* name, double value) {
    const double error = 0.01 * std::abs(value);
    fit.parameters.push_back(
        {name, Estimate{value, error, error, 1e6, value - 1.96 * error, value + 1.96 * error}});
  };
  add("front_area_m2", front_area);
  add("top_area_m2", 0.01);
  add("linear_m_s", linear_speed);
  add("wind_m_s", 1);
  add("side_area_m2", side_area);
  const std::size_t n = fit.parameters.size();
  std::vector<double> covariance(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    covariance[i * n + i] = std::pow(fit.parameters[i].estimate.standard_error, 2);
  }
  fit.covariance_by_flight = {covariance};
  fit.covariance_independent = covariance;
  fit.degrees_of_freedom_by_flight = {1e6};
  fit.differentiation_correction.assign(n, 0.0);
  fit.max_airspeed = 12;
  return fit;
}

}  // namespace

TEST_CASE("near level attitude each autopilot's law with its parameters is the drag of the fit") {
  const DragFit fit = fit_with(0.02, 15, 0.025);
  const double rho = fit.conditions.air_density;
  const double sigma = rho / 1.225;
  for (const double v : {0.5, 3.0, 9.0}) {
    const double drag = 0.5 * rho * 0.02 * (v * v + 15 * v) / 2.0;
    {  // AP_NavEKF3_AirDataFusion.cpp: ρ = 1.225 σ, momentum drag times σ
      const AutopilotDrag told = autopilot_drag(fit, Autopilot::ardupilot);
      REQUIRE(told.parameters[0].value);
      REQUIRE(told.parameters[2].value);
      CHECK(0.5 / told.parameters[0].value->value * (1.225 * sigma) * v * v +
                v * told.parameters[2].value->value * sigma ==
            Approx(drag).epsilon(1e-12));
    }
    {  // drag_fusion.cpp: momentum drag times √σ
      const AutopilotDrag told = autopilot_drag(fit, Autopilot::px4);
      REQUIRE(told.parameters[0].value);
      REQUIRE(told.parameters[2].value);
      CHECK(0.5 / told.parameters[0].value->value * rho * v * v +
                v * told.parameters[2].value->value * std::sqrt(sigma) ==
            Approx(drag).epsilon(1e-12));
    }
  }
}

TEST_CASE("the side's ballistic coefficient is that of the side area, and the names are theirs") {
  const DragFit fit = fit_with(0.02, 15, 0.025);
  const AutopilotDrag ardupilot = autopilot_drag(fit, Autopilot::ardupilot);
  REQUIRE(ardupilot.parameters.size() == 3);
  CHECK(ardupilot.parameters[0].name == "EK3_DRAG_BCOEF_X");
  CHECK(ardupilot.parameters[1].name == "EK3_DRAG_BCOEF_Y");
  CHECK(ardupilot.parameters[2].name == "EK3_DRAG_MCOEF");
  REQUIRE(ardupilot.parameters[1].value);
  CHECK(ardupilot.parameters[1].value->value == Approx(2.0 / 0.025));
  CHECK(autopilot_drag(fit, Autopilot::px4).parameters[1].name == "EKF2_BCOEF_Y");
}

TEST_CASE("a coefficient's interval is its area's turned over, the product's that of both errors") {
  const DragFit fit = fit_with(0.02, 15, 0.025);
  const AutopilotDrag told = autopilot_drag(fit, Autopilot::px4);
  const Estimate& area = fit.front_area().estimate;
  REQUIRE(told.parameters[0].value);
  CHECK(told.parameters[0].value->lower == Approx(2.0 / area.upper));
  CHECK(told.parameters[0].value->upper == Approx(2.0 / area.lower));
  REQUIRE(told.parameters[2].value);
  const Estimate& momentum = *told.parameters[2].value;
  CHECK(momentum.standard_error / momentum.value == Approx(0.01 * std::sqrt(2.0)).epsilon(1e-6));
}

TEST_CASE("what a fit does not determine is left out with the reason") {
  SECTION("no flight to the side") {
    test::SimulatedFlight truth;
    const AutopilotDrag told = autopilot_drag(fit_of(truth), Autopilot::ardupilot);
    CHECK_FALSE(told.parameters[1].value);
    CHECK_THAT(told.parameters[1].left_out_because, Catch::Contains("no drag to the side"));
  }
  SECTION("an area that may be none") {
    DragFit fit = fit_with(0.02, 15, 0.025);
    fit.parameters[0].estimate.lower = -0.001;
    const AutopilotDrag told = autopilot_drag(fit, Autopilot::ardupilot);
    CHECK_FALSE(told.parameters[0].value);
    CHECK_THAT(told.parameters[0].left_out_because, Catch::Contains("may be zero"));
  }
  SECTION("linear drag at its bound") {
    DragFit fit = fit_with(0.02, 0, 0.025);
    fit.parameters[2].at_bound = Bound::lower;
    const AutopilotDrag told = autopilot_drag(fit, Autopilot::px4);
    CHECK_FALSE(told.parameters[2].value);
    CHECK_THAT(told.parameters[2].left_out_because, Catch::Contains("linear_m_s at its bound"));
  }
  SECTION("beyond the range of the one autopilot, within that of the other") {
    const DragFit fit = fit_with(2.0 / 300, 15, 0.025);
    CHECK(autopilot_drag(fit, Autopilot::ardupilot).parameters[0].value);
    const AutopilotDrag told = autopilot_drag(fit, Autopilot::px4);
    CHECK_FALSE(told.parameters[0].value);
    CHECK_THAT(told.parameters[0].left_out_because, Catch::Contains("1 to 200"));
  }
}

TEST_CASE("without a top area both laws are one up to the tilt's cosine") {
  DragFit fit = fit_with(0.02, 15, 0.025);
  fit.parameters[1].estimate.value = 0;
  const auto check = autopilot_drag(fit, Autopilot::ardupilot).check;
  REQUIRE(check);
  CHECK(check->airspeed == 12);
  CHECK(check->tilt > 0);
  // ½ρA_f cos θ·(v² + jv)·cos θ against ½ρA_f((v cos θ)² + j v cos θ)
  const double c = std::cos(check->tilt);
  CHECK(check->by_fit / check->by_autopilot ==
        Approx(c * c * (144 + 15 * 12) / (144 * c * c + 15 * 12 * c)).epsilon(1e-6));
}

TEST_CASE("the published flight gives the ballistic coefficient of its printed area") {
  const auto path = test::reference_file("data/x500-flight.csv");
  if (!path) return;
  const FlightLog log = test::read_flight_csv(*path);
  const Observations flight =
      observe(log, range_in_percent(log, 25, 90), 1.4955439766569403 * unit::degree,
              standard_gravity, Kinematics::published);
  const DragFit fit = fit_drag({&flight, 1}, {1.549, 1.293, standard_gravity});
  const AutopilotDrag told = autopilot_drag(fit, Autopilot::ardupilot);
  REQUIRE(told.parameters[0].value);
  REQUIRE(told.parameters[2].value);
  // Beffert and Zell, section V-B: A_f 1.492e-2 m², j 19.43 m/s, of 1.549 kg at 1.293 kg/m³.
  CHECK(told.parameters[0].value->value == Approx(1.549 / 1.492e-2).epsilon(5e-4));
  CHECK(told.parameters[2].value->value * 1.293 / 1.225 ==
        Approx(0.5 * 1.293 * 1.492e-2 * 19.43 / 1.549).epsilon(5e-4));
  // Area and linear speed are entangled; their product is known far better than either.
  CHECK(told.parameters[2].value->standard_error / told.parameters[2].value->value <
        fit.linear_speed().estimate.standard_error / fit.linear_speed().estimate.value);
}
