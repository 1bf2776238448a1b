// Real flights of a DJI Matrice 100 from its battery, where they are at hand (Rodrigues et al.,
// "In-flight positional and energy use data set of a DJI Matrice 100 quadcopter for small package
// delivery", Scientific Data 8, 155, 2021): flight 273 without payload tells how the drone draws
// power, and 268 and 269, which carried 500 g, are held against that. All of it as a user would,
// by the command line from the files as they were published.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "support/random.hpp"
#include "support/reference_data.hpp"
#include "support/run_program.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/model/units.hpp"

using namespace tethercalc;

namespace {

/// What the published columns hold: the anemometer on board reads the airspeed; the attitude is of
/// axes right, forward and up in a world of east, north and up.
const std::vector<std::string> columns{"time_s=time",
                                       "quaternion_w=orientation_w",
                                       "quaternion_x=orientation_y",
                                       "quaternion_y=orientation_x",
                                       "quaternion_z=-orientation_z",
                                       "body_forward_m_s=twist_linear_y",
                                       "body_right_m_s=twist_linear_x",
                                       "body_down_m_s=-twist_linear_z",
                                       "airspeed_m_s=wind_speed",
                                       "air_from_deg=wind_angle",
                                       "bus_power_W=power_W",
                                       "height_m=position_z"};

std::optional<std::string> flight(int number) {
  const auto file = test::reference_file(fmt::format("data/real/m100-flight-{}.csv", number));
  return file ? std::optional(file->string()) : std::nullopt;
}

/// What is known before any flight: mass, four propellers of 13 inch, and a guess of all else. The
/// figure of merit is the median of the library's motors, 0.59; the drag is a guess from its size.
std::string matrice(const test::TemporaryFolder& folder) {
  const test::Ran motor = test::run_tethercalc(
      {"motor", "--propeller-in", "13", "--figure-of-merit", "0.59", "--max-thrust-g", "2550",
       "--air-density", "1.17", "--output", (folder.path() / "motor.json").string()});
  REQUIRE(motor.exit_code == 0);
  const std::string spec = (folder.path() / "matrice.json").string();
  test::write_file(spec, R"({
    "name": "DJI Matrice 100",
    "drone": {"mass_g": 3680, "motor_count": 4, "motor": "motor.json", "auxiliary_power_W": 0,
              "drag": {"front_area_m2": 0.04, "top_area_m2": 0.04, "linear_m_s": 0}},
    "tether": {"length_m": 30, "conductor": "aluminium",
               "insulation": {"material": "pvc", "thickness_mm": 0.75}},
    "supply": {"voltage_V": 75,
               "converter": {"efficiency": 0.9, "min_input_voltage_V": 20}},
    "flight": {"airspeed_m_s": 8, "air_density_kg_m3": 1.17},
    "requirements": {"thrust_headroom": 2, "headroom_at": "hover", "power_at": "forward"}})");
  return spec;
}

nlohmann::json answered(const std::string& spec, const std::vector<std::string>& further) {
  std::vector<std::string> arguments{"diagnose",  spec,
                                     "--columns", fmt::format("{}", fmt::join(columns, ",")),
                                     "--format",  "json"};
  arguments.insert(arguments.end(), further.begin(), further.end());
  const test::Ran ran = test::run_tethercalc(arguments);
  INFO(ran.err);
  REQUIRE(ran.exit_code == 0);
  return nlohmann::json::parse(ran.out);
}

/// Of the power of a flight from its battery.
nlohmann::json diagnosed(const std::string& spec, std::vector<std::string> further) {
  further.emplace_back("--free-flight");
  return answered(spec, further);
}

/// The published file, whose first column is the time.
std::string with_clock_ahead(const std::string& file, double shift) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  std::string text = line + "\n";
  while (std::getline(in, line)) {
    const std::size_t comma = line.find(',');
    text += fmt::format("{:.3f}{}\n", std::stod(line.substr(0, comma)) + shift, line.substr(comma));
  }
  return text;
}

/// The spec with what flight 273 tells of a guessed motor: its factor is no finding but what the
/// flight is there to tell.
std::string learned(const test::TemporaryFolder& folder, const std::string& bare) {
  const std::string spec = (folder.path() / "learned.json").string();
  diagnosed(matrice(folder),
            {"--power", bare, "--base", "motor_power_scale,translational_lift", "--into", spec});
  return spec;
}

/// The flight less every 40th row: the very same one is not taken twice.
std::string once_more(const test::TemporaryFolder& folder, const std::string& flight) {
  std::istringstream lines(test::file_text(flight));
  std::string text;
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line); ++number) {
    if (number % 40 != 39) text += line + "\n";
  }
  const std::string path = folder.path() / "once-more.csv";
  test::write_file(path, text);
  return path;
}

}  // namespace

TEST_CASE("a payload shows in a battery flight after one without has told of the motors") {
  const auto bare = flight(273);
  const auto near = flight(268);
  const auto fast = flight(269);
  if (!bare || !near || !fast) return;
  const test::TemporaryFolder folder;
  const nlohmann::json answer =
      diagnosed(learned(folder, *bare), {"--power", *near, "--power", *fast});
  REQUIRE_FALSE(answer.at("findings").empty());
  const nlohmann::json& first = answer.at("findings").front();
  const auto rivals = first.value("indistinguishable_from", std::vector<std::string>{});
  INFO(first.dump(1));
  if (first.at("effect") == "extra_mass") {
    const double mass = first.at("parameters").at(0).at("value");
    CHECK(mass > 0.35);
    CHECK(mass < 0.65);
  } else {
    CHECK(std::ranges::count(rivals, "extra_mass") > 0);
  }
}

TEST_CASE("what a flight is told of does not hang on when its clock began") {
  for (const int number : {273, 268, 269}) {
    if (test::leave_rates_out() && number != 273) return;
    const auto file = flight(number);
    if (!file) return;
    const test::TemporaryFolder folder;
    const std::string spec = matrice(folder);
    std::vector<std::set<std::string>> told;
    std::vector<double> shifts{0.0, 86400.123};
    // Another clock makes the same code run: under a sanitizer one is enough.
    if (!test::leave_rates_out()) shifts.insert(shifts.end(), {1.0, 7.3, -13.37, 1000.0});
    for (const double shift : shifts) {
      const std::string shifted = (folder.path() / "shifted.csv").string();
      test::write_file(shifted, with_clock_ahead(*file, shift));
      std::set<std::string>& names = told.emplace_back();
      const nlohmann::json answer = answered(spec, {"--flight", shifted});
      for (const nlohmann::json& finding : answer.at("findings")) {
        names.insert(finding.at("effect"));
        for (const nlohmann::json& rival : finding.at("indistinguishable_from")) {
          names.insert("or " + rival.get<std::string>());
        }
      }
      for (const nlohmann::json& out : answer.at("ruled_out")) {
        names.insert("not " + out.at("effect").get<std::string>());
      }
    }
    INFO("flight " << number);
    for (const std::set<std::string>& names : told) CHECK(names == told.front());
  }
}

TEST_CASE("the mean power of flights with a known payload is what one without has taught") {
  const auto bare = flight(273);
  if (!bare || !flight(268) || !flight(269)) return;
  const test::TemporaryFolder folder;
  const std::string drone = learned(folder, *bare);
  // Flight 273 flew at airspeeds up to 10 m/s, 269 up to 14.7 m/s. Each of the two is too short to
  // be judged alone, so it stands there twice: nothing is fitted to it.
  for (const int number : {268, 269}) {
    const std::string again = once_more(folder, *flight(number));
    const nlohmann::json held_out =
        diagnosed(drone, {"--mass-g", "4180", "--power", *flight(number), "--power", again});
    const double ratio = held_out.at("further").at(0).at("base_mean_ratio");
    INFO(number << ": mean predicted over measured power " << ratio);
    CHECK(std::abs(ratio - 1) < 0.05);
  }
}

TEST_CASE("a design keeps its drag where the tilt of its flight tells none from it") {
  const auto bare = flight(273);
  if (!bare) return;
  const test::TemporaryFolder folder;
  const std::string spec = (folder.path() / "flown.json").string();
  diagnosed(matrice(folder), {"--log", *bare, "--into", spec});
  const AirframeDrag drag = read_design(spec).design.drone.drag;
  CHECK(drag.front_area == 0.04);
  CHECK(drag.top_area == 0.04);
}

TEST_CASE("a velocity along the drone's own axes is that of its track") {
  const auto bare = flight(273);
  if (!bare) return;
  const FlightLog log = read_flight_log(*bare, {.columns = columns}).log;
  // Where it was, as published beside the velocity: degrees of longitude and latitude, metres up.
  const std::vector<std::string> track{
      "time_s=time",        "vn_m_s=position_y",       "ve_m_s=position_x",
      "vd_m_s=-position_z", "pitch_deg=orientation_x", "yaw_deg=orientation_y"};
  const FlightLog at = read_flight_log(*bare, {.level_where_missing = true, .columns = track}).log;
  REQUIRE(at.time.size() == log.time.size());
  constexpr double metres_per_degree = 6371e3 * unit::degree;
  double squares = 0;
  std::size_t count = 0;
  constexpr std::size_t apart = 10;
  for (std::size_t i = apart; i + apart < log.time.size(); ++i) {
    const double seconds = at.time[i + apart] - at.time[i - apart];
    if (seconds > 3) continue;
    const auto rate = [&](const std::vector<double>& position) {
      return (position[i + apart] - position[i - apart]) / seconds;
    };
    const double cosine = std::cos(at.north_velocity[i] * unit::degree);
    const double north = metres_per_degree * rate(at.north_velocity);
    const double east = metres_per_degree * cosine * rate(at.east_velocity);
    squares += std::pow(north - log.north_velocity[i], 2) +
               std::pow(east - log.east_velocity[i], 2) +
               std::pow(rate(at.down_velocity) - log.down_velocity[i], 2);
    ++count;
  }
  CHECK(std::sqrt(squares / static_cast<double>(count)) < 0.3);  // m/s, flown at 4
}
