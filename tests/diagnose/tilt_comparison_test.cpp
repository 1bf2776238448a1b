// The drag over mass that a tilt shows, against the balance of forces written out.
#include "diagnose/tilt_comparison.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "support/random_designs.hpp"

using namespace tethercalc;

namespace {

/// tan θ = F(v, θ)/W by iteration, with the areas' law of the paper's section III-B.
double lean(const AirframeDrag& drag, double density, double v, double weight, double other_drag) {
  double angle = 0;
  for (int i = 0; i < 200; ++i) {
    const double area = drag.front_area * std::cos(angle) + drag.top_area * std::sin(angle);
    const double force = 0.5 * density * area * (v * v + drag.linear_speed * v);
    angle = std::atan((force + other_drag) / weight);
  }
  return std::tan(angle);
}

PowerLog hover_and_pass(double height) {
  PowerLog log;
  for (int i = 0; i < 400; ++i) {
    log.time.push_back(i);
    log.height.push_back(height);
    log.airspeed.push_back(i % 2 == 0 ? 0.0 : 6.0);
  }
  return log;
}

DragByTilt shown_by(const AirframeDrag& law, double over_mass, double spread) {
  DragByTilt shown{law, {2, 4, 6, 8}, {}, {}};
  for (int b = 0; b < 20; ++b) {
    shown.time.push_back(20.0 * b);
    shown.over_mass.push_back(over_mass + (b % 2 == 0 ? spread : -spread));
  }
  return shown;
}

PowerModel flown_design() {
  Design design = test::published_design();
  design.tether.cross_section = 1.09e-6;
  return {design};
}

}  // namespace

TEST_CASE("drag over mass is g times the tangent of the tilt that holds an airspeed") {
  const AirframeDrag law{0.0145, 0.0136, 19, 0};
  const std::vector<double> airspeed{3, 9};
  const double weight = 1.7 * 9.80665;
  const double by_hand =
      9.80665 * (lean(law, 1.2, 3, weight, 0) + lean(law, 1.2, 9, weight, 0)) / 2;
  CHECK(drag_over_mass(law, 1.7, 1.2, 9.80665, airspeed) == Approx(by_hand).epsilon(1e-9));
}

TEST_CASE("a heavier drone is predicted to lean less, and one with hungrier motors as before") {
  std::vector<Warning> notes;
  PowerModel model = flown_design();
  const auto tilt = TiltComparison::of(shown_by(model.design.drone.drag, 0.6, 0.01), model,
                                       hover_and_pass(15), 1e-4, notes);
  REQUIRE(tilt);
  const double before = tilt->predicted(model);
  PowerModel heavy = model;
  heavy.design.drone.mass *= 1.3;
  CHECK(tilt->predicted(heavy) < 0.9 * before);
  PowerModel hungry = model;
  hungry.design.drone.motor_power_factor = 1.3;
  CHECK(tilt->predicted(hungry) == before);
  PowerModel bluff = model;
  bluff.design.drone.drag.front_area *= 1.3;
  CHECK(tilt->predicted(bluff) > 1.02 * before);
}

TEST_CASE(
    "the drag that is told makes the design lean as the flight did, the tether's share taken off") {
  std::vector<Warning> notes;
  PowerModel model = flown_design();
  const AirframeDrag law{0.03, 0.02, 5, 0};
  const auto tilt =
      TiltComparison::of(shown_by(law, 0.9, 0.01), model, hover_and_pass(15), 1e-4, notes);
  REQUIRE(tilt);
  PowerModel told = model;
  told.design.drone.drag = tilt->drag_of(model);
  CHECK(tilt->predicted(told) == Approx(0.9).epsilon(1e-6));
  // The shape of the law stays the flight's.
  CHECK(told.design.drone.drag.linear_speed == law.linear_speed);
  CHECK(told.design.drone.drag.front_area / told.design.drone.drag.top_area ==
        Approx(law.front_area / law.top_area));
}

TEST_CASE("a tilt that the tether alone explains leaves the drag as the design has it") {
  std::vector<Warning> notes;
  PowerModel model = flown_design();
  const auto tilt = TiltComparison::of(shown_by({0.03, 0.02, 5, 0}, 0.05, 0.001), model,
                                       hover_and_pass(30), 1e-4, notes);
  REQUIRE(tilt);
  CHECK(tilt->drag_of(model).front_area == model.design.drone.drag.front_area);
}

TEST_CASE("a tilt that tells no drag from none is not compared, and a note says what is missing") {
  std::vector<Warning> notes;
  const PowerModel model = flown_design();
  CHECK_FALSE(TiltComparison::of(shown_by(model.design.drone.drag, 0.6, 8), model,
                                 hover_and_pass(15), 1e-4, notes));
  REQUIRE(notes.size() == 1);
  CHECK_THAT(notes.front().sentence, Catch::Contains("passes at speed"));
}

TEST_CASE("rows of a tilt are noise of size 1 or less where the model is right") {
  std::vector<Warning> notes;
  const PowerModel model = flown_design();
  // Their mean is what the model predicts: asked for once, then shown.
  const double right = TiltComparison::of(shown_by(model.design.drone.drag, 0.6, 0.05), model,
                                          hover_and_pass(15), 1e-4, notes)
                           ->predicted(model);
  const auto tilt = TiltComparison::of(shown_by(model.design.drone.drag, right, 0.05), model,
                                       hover_and_pass(15), 1e-4, notes);
  REQUIRE(tilt);
  std::vector<double> rows(tilt->rows());
  tilt->whitened(model, rows);
  const double squares = std::inner_product(rows.begin(), rows.end(), rows.begin(), 0.0);
  CHECK(squares < static_cast<double>(rows.size()));
  CHECK(squares > 0);
}
