// 60 random designs as computed by the published implementation of Beffert & Zell 2025.

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "support/reference_data.hpp"
#include "tethercalc/model/operating_point.hpp"
#include "tethercalc/model/steady_flight.hpp"
#include "tethercalc/solve/headroom.hpp"
#include "tethercalc/solve/minimum_power.hpp"
#include "tethercalc/solve/optimize.hpp"

namespace {

using namespace tethercalc;
using nlohmann::json;

MotorCurve motor_of(const json& sheet) {
  std::map<int, MotorPoint> points;
  for (const auto& [throttle, value] : sheet.items()) {
    if (throttle == "name") continue;
    const double grams = value[0];
    const double grams_per_watt = value[1];
    points[std::stoi(throttle)] = {grams * unit::gram_force, grams / grams_per_watt};
  }
  std::vector<MotorPoint> rising;
  for (const auto& [throttle, point] : points) rising.push_back(point);
  return MotorCurve(rising);
}

Design design_of(const json& inputs, const json& motors) {
  Design d;
  d.drone.mass = inputs["drone_mass_g"].get<double>() * unit::gram;
  d.drone.motor_count = inputs["motor_count"];
  d.drone.motor = motor_of(motors[inputs["motor"].get<std::string>()]);
  d.drone.auxiliary_power = inputs["payload_power_W"];
  d.drone.drag = {inputs["drag_front_area_m2"], inputs["drag_top_area_m2"],
                  inputs["drag_linear_m_s"], 0};
  d.tether.length = inputs["tether_length_m"];
  // Paper Table I.
  d.tether.conductor = inputs["conductor"] == "copper" ? Conductor{0.0178e-6, 0, 8900}
                                                       : Conductor{0.0278e-6, 0, 2700};
  d.tether.insulation = {inputs["insulation_density_g_cm3"].get<double>() * 1000,
                         inputs["insulation_thickness_mm"].get<double>() / 1000};
  d.supply.voltage = inputs["supply_voltage_V"];
  d.supply.converter = {{{0, inputs["converter_efficiency"]}},
                        inputs["converter_min_input_voltage_V"]};
  d.flight = {inputs["airspeed_m_s"], 0, inputs["air_density_kg_m3"], inputs["gravity_m_s2"]};
  d.requirements.thrust_headroom = inputs["thrust_headroom"];
  return d;
}

json reference() {
  const auto path = test::reference_file("data/golden/reference-designs.json");
  if (!path) return {};
  std::ifstream file(*path);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  // The file writes some infeasible numbers as NaN, which JSON does not know.
  return json::parse(std::regex_replace(text, std::regex(": NaN"), ": null"));
}

void check(const json& expected, double value, double tolerance) {
  if (expected.is_null()) {
    CHECK(std::isnan(value));
  } else {
    CHECK(value == Approx(expected.get<double>()).epsilon(tolerance).margin(1e-12));
  }
}

/// Calls `visit(design, condition, expected)` for each design in hover and forward flight.
template <typename Visit>
void each_condition(Visit visit) {
  const json all = reference();
  if (all.is_null()) return;
  for (const json& expected : all["cases"]) {
    const Design design = design_of(expected["inputs"], all["motors"]);
    for (const char* condition : {"hover", "forward"}) {
      INFO(expected["id"].get<std::string>() << " in " << condition);
      visit(design, condition[0] == 'h' ? Condition::hover : Condition::forward,
            expected[condition]);
    }
  }
}

}  // namespace

TEST_CASE("operating points of the reference designs are the published ones") {
  each_condition([](const Design& design, Condition condition, const json& expected) {
    // Tilt comes out of a root finder there, to about 1e-8; what depends on it inherits that.
    const double tilt_tolerance = condition == Condition::hover ? 1e-9 : 1e-6;
    for (const json& point : expected["points"]) {
      const double area = point["area_mm2"].get<double>() * unit::square_millimetre;
      INFO("area " << point["area_mm2"]);
      const OperatingPoint ours = evaluate(design, area, condition);
      check(point["tether_resistance_ohm"], ours.tether_resistance, 1e-9);
      check(point["tether_mass_g"], ours.tether_mass / unit::gram, 1e-9);
      check(point["available_power_W"], ours.available_power, 1e-9);
      check(point["available_thrust_per_motor_g"], ours.available_thrust / unit::gram_force, 1e-9);
      check(point["pitch_deg"], ours.pitch / unit::degree, tilt_tolerance);
      check(point["necessary_thrust_per_motor_g"], ours.necessary_thrust / unit::gram_force,
            tilt_tolerance);
      check(point["drone_power_W"], ours.drone_power, tilt_tolerance);
      check(point["total_power_W"], ours.total_power, tilt_tolerance);
    }
  });
}

TEST_CASE("headroom crossings of the reference designs are the published ones") {
  each_condition([](const Design& design, Condition condition, const json& expected) {
    std::vector<double> edges;
    for (const Interval& range : headroom_areas(SteadyFlight(design, condition), 2)) {
      edges.push_back(range.lo / unit::square_millimetre);
      edges.push_back(range.hi / unit::square_millimetre);
    }
    // Published crossings end at the search limit, ours go on: compare theirs one by one.
    const auto& crossings = expected["headroom_crossings_mm2"];
    REQUIRE(edges.size() >= crossings.size());
    for (std::size_t i = 0; i < crossings.size(); ++i) {
      CHECK(edges[i] == Approx(crossings[i].get<double>()).epsilon(1e-9));
    }
  });
}

TEST_CASE("no reference design has a published power below our minimum") {
  const json all = reference();
  if (all.is_null()) return;
  for (const json& expected : all["cases"]) {
    const Design design = design_of(expected["inputs"], all["motors"]);
    const double search_limit = expected["search_upper_mm2"];
    for (const char* name : {"hover", "forward"}) {
      INFO(expected["id"].get<std::string>() << " in " << name);
      const Condition condition = name[0] == 'h' ? Condition::hover : Condition::forward;
      const MinimumPower ours = minimum_power(SteadyFlight(design, condition));
      const json& published = expected[name]["min_power_W"];
      if (published.is_null()) {
        // Nothing to fly where the published search looked; a thicker cable may hold the tilt.
        const json& area = expected[name]["min_power_area_mm2"];
        const double looked_up_to = area.is_null() ? search_limit : area.get<double>();
        INFO("area " << ours.area / unit::square_millimetre << " mm2");
        CHECK((std::isnan(ours.power) || ours.area > looked_up_to * unit::square_millimetre));
        continue;
      }
      CHECK(ours.power <= published.get<double>() * (1 + 1e-9));
      const double area = expected[name]["min_power_area_mm2"];
      if (area < search_limit * (1 - 1e-6)) {
        CHECK(ours.power == Approx(published.get<double>()).epsilon(1e-6));
      }
    }
  }
}
