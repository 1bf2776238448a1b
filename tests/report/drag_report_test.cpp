// The drag result as JSON, text and CSV.
#include "tethercalc/report/drag_report.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "support/simulated_flight.hpp"

using namespace tethercalc;

namespace {

DragIdentification identified(double top_area = 0.014) {
  test::SimulatedFlight truth;
  truth.top_area = top_area;
  const FlightLog log = test::simulate(truth);
  DragIdentificationOptions options;
  options.conditions = {truth.mass, truth.air_density, standard_gravity};
  return identify_drag({&log, 1}, options);
}

}  // namespace

TEST_CASE("drag JSON holds each parameter with both errors and an interval around it") {
  const DragIdentification result = identified();
  const auto json = drag_json(result);
  for (const auto& parameter :
       {json["front_area_m2"], json["top_area_m2"], json["linear_m_s"], json["wind_m_s"][0]}) {
    CHECK(parameter["standard_error"] > parameter["standard_error_independent"]);
    CHECK(parameter["ci95"][0] < parameter["value"]);
    CHECK(parameter["ci95"][1] > parameter["value"]);
    CHECK_FALSE(parameter.contains("at_bound"));
  }
  CHECK(json["wind_m_s"].size() == 1);
  CHECK(json["samples"] == result.fit.quality.samples);
  CHECK(json["effective_samples"] < json["samples"]);
  CHECK(json["range"] == "automatic");
  CHECK(json["drone"]["drag"]["linear_m_s"] == json["linear_m_s"]["value"]);
  CHECK(json["table"].size() >= 8);
  auto determined = json;
  determined.erase("autopilot");  // this flight shows no drag to the side
  CHECK(determined.dump().find("null") == std::string::npos);
}

TEST_CASE("a parameter at its bound is null in JSON, a dash in text, and named in both") {
  const DragIdentification result = identified(-0.01);
  REQUIRE(result.fit.top_area().at_bound == Bound::lower);
  const auto json = drag_json(result);
  CHECK(json["top_area_m2"]["value"] == 0);
  CHECK(json["top_area_m2"]["standard_error"].is_null());
  CHECK(json["top_area_m2"]["ci95"].is_null());
  CHECK(json["top_area_m2"]["at_bound"] == "lower");
  const std::string text = drag_text(result, {});
  CHECK(json["warnings"].size() == 1);
  CHECK(text.find("top_area_m2 wants to leave its lower bound") != std::string::npos);
  CHECK(text.find("nan") == std::string::npos);
}

TEST_CASE("drag text names the range, the entangled pair and the well determined force") {
  const std::string text = drag_text(identified(), {});
  CHECK(text.find("chosen automatically") != std::string::npos);
  CHECK(text.find("Hardly told apart by this flight") != std::string::npos);
  CHECK(text.find("Well determined is the drag force") != std::string::npos);
  CHECK(text.find("nan") == std::string::npos);
}

TEST_CASE("drag CSV has one row a speed and nine cells in each") {
  const DragIdentification result = identified();
  const std::string csv = drag_csv(result);
  const auto rows = static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n'));
  CHECK(rows == 1 + steady_drag_table(result.fit).size());
  CHECK(std::count(csv.begin(), csv.end(), ',') == static_cast<std::ptrdiff_t>(8 * rows));
}

TEST_CASE("of several logs the unsuitable one is named") {
  const std::vector<FlightLog> logs{test::simulate({}), FlightLog{}};
  DragIdentificationOptions options;
  options.conditions.mass = 1.6;
  CHECK_THROWS_WITH(identify_drag(logs, options), Catch::StartsWith("log 2: "));
}
