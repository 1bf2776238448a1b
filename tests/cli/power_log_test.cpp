// Power logs through the real program: whatever they come as, whatever is wrong with what is asked.
#include <zlib.h>

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/published.hpp"
#include "support/dataflash_writer.hpp"
#include "support/run_program.hpp"

using namespace tethercalc::test;
using Catch::Contains;
using nlohmann::json;

namespace {

const std::string example_power = project_file("examples/simulated-power.csv");

Ran diagnosed(std::vector<std::string> arguments) {
  std::vector<std::string> all = {"diagnose", published, "--set", "tether.cross_section_mm2=1.09"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return run_tethercalc(all);
}

json answer_to(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--format", "json"});
  const Ran run = diagnosed(std::move(arguments));
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  return json::parse(run.out);
}

/// The example flight with a battery beside it: 25 A at 16 V all the time.
std::string example_flight_with_power() {
  std::istringstream rows(file_text(project_file("examples/simulated-flight.csv")));
  std::string line;
  std::getline(rows, line);
  std::string text = line + ",height_m,bus_voltage_V,bus_current_A\n";
  for (int i = 0; std::getline(rows, line); ++i) {
    text += line + ",20,16," + (i % 3 == 0 ? "25.2" : "24.9") + "\n";
  }
  return text;
}

const json* found(const json& answer, const std::string& effect) {
  for (const json& finding : answer.at("findings")) {
    if (finding.at("effect") == effect) return &finding;
  }
  return nullptr;
}

std::string gz_of(const std::string& text, const std::string& path) {
  const gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
  gzclose(file);
  return path;
}

}  // namespace

TEST_CASE("the example power log shows its plugs and its mass, and no mass where that was told") {
  const json answer = answer_to({"--power", example_power});
  REQUIRE(found(answer, "contact_resistance") != nullptr);
  REQUIRE(found(answer, "extra_mass") != nullptr);
  const json& parameter = found(answer, "extra_mass")->at("parameters")[0];
  CHECK(parameter.at("ci95")[0] < 0.15);
  CHECK(parameter.at("ci95")[1] > 0.15);

  // The mass as flown, 1710 g and 150 g: what is found comes to the spec's, which stays.
  const json told = answer_to({"--power", example_power, "--mass-g", "1860"});
  CHECK(found(told, "contact_resistance") != nullptr);
  CHECK(found(told, "extra_mass") == nullptr);
  const json spec =
      json::parse(diagnosed({"--power", example_power, "--mass-g", "1860", "--into"}).out);
  CHECK(spec.at("drone").at("mass_g").get<double>() == Approx(1710));
}

TEST_CASE("one log of both halves has its flight judged as alone, its power by the tilt as well") {
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "both.csv").string();
  write_file(log, example_flight_with_power());
  const std::vector<std::string> flown = {"--free-flight", "--core", "0"};
  const auto asked = [&](std::vector<std::string> logs) {
    logs.insert(logs.end(), flown.begin(), flown.end());
    return answer_to(logs);
  };
  const json whole = asked({"--log", log});
  const json apart = asked({"--flight", log, "--power", log});
  CHECK(whole.at("kind") == "flight and power");
  CHECK(whole.at("findings")[0] == apart.at("findings")[0]);
  const auto by_tilt = [](const json& answer) {
    return answer.dump().find("drag over mass that the tilt shows") != std::string::npos;
  };
  CHECK(by_tilt(whole));
  CHECK_FALSE(by_tilt(apart));
}

TEST_CASE("a compressed power log is the log itself") {
  const TemporaryFolder folder;
  const std::string gz = gz_of(file_text(example_power), (folder.path() / "power.csv.gz").string());
  CHECK(answer_to({"--power", gz}).at("findings") ==
        answer_to({"--power", example_power}).at("findings"));
}

TEST_CASE("a motor is learned from an autopilot's log") {
  DataFlashWriter log;
  log.define(64, "XKF1", "QBffffff", "TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD");
  log.define(65, "BAT", "QBff", "TimeUS,Inst,Volt,Curr");
  log.define(66, "EV", "QB", "TimeUS,Id");
  for (int i = 0; i < 1000; ++i) {
    const auto time = static_cast<std::uint64_t>(i + 50) * 100'000;
    if (i == 5) log.add(66, {time, std::uint64_t{28}});
    log.add(64, {time, std::uint64_t{0}, 0.0, 0.0, 0.0, 0.3, 0.0, 0.0});
    // 415 W, of which 15 W are beside the motors.
    log.add(65, {time, std::uint64_t{0}, 16.6, i % 2 == 0 ? 24.5 : 25.5});
  }
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "hover.bin").string();
  const auto bytes = log.bytes();
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  write_file(file, text);
  const auto learned = [&](const std::string& name) {
    return run_tethercalc({"motor", "--power-log", name, "--spec", published, "--max-thrust-g",
                           "1300", "--format", "json"});
  };
  const Ran run = learned(file);
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  const json motor = json::parse(run.out);
  CHECK_THAT(motor.at("source").get<std::string>(), Contains("of hover 100.0 W for 427 g a motor"));
  CHECK_THAT(run.err, Contains("ground speed is taken as airspeed"));
  const json from_gz = json::parse(learned(gz_of(text, file + ".gz")).out);
  CHECK(from_gz.at("points") == motor.at("points"));
}

TEST_CASE("a power log given twice, and one whose time is in milliseconds, are refused") {
  const TemporaryFolder folder;
  const std::string once = (folder.path() / "once.csv").string();
  const std::string milliseconds = (folder.path() / "milliseconds.csv").string();
  std::string csv = "time_s,height_m,airspeed_m_s,bus_voltage_V,bus_current_A\n";
  std::string stretched = csv;
  for (int i = 0; i < 300; ++i) {
    const std::string row = fmt::format(",{},{:.2f},16,{:.2f}\n", 20 + i % 7, 0.05 * (i * i % 97),
                                        25 + 0.01 * (i * 31 % 101));
    csv += std::to_string(i) + row;
    stretched += std::to_string(1000 * i) + row;
  }
  write_file(once, csv);
  write_file(milliseconds, stretched);
  const Ran twice = diagnosed({"--free-flight", "--power", once, "--power", once});
  CHECK(twice.exit_code == 2);
  CHECK_THAT(twice.err, Contains("is the same flight as another of these logs"));
  const Ran slow = diagnosed({"--free-flight", "--power", milliseconds});
  CHECK(slow.exit_code == 2);
  CHECK_THAT(slow.err, Contains("is it in milliseconds?"));
}

TEST_CASE("options of a power log that contradict each other or the log are refused") {
  const TemporaryFolder folder;
  const std::string flight_csv = project_file("examples/simulated-flight.csv");
  struct Case {
    std::vector<std::string> arguments;
    std::string says;
  };
  for (const Case& c :
       {Case{{"--log", example_power, "--power", example_power}, "--log: is both"},
        {{"--flight", flight_csv, "--free-flight"}, "--free-flight: is of the power"},
        {{"--flight", flight_csv, "--battery", "0"}, "--battery: is of the power"},
        {{"--power", example_power, "--from", "200"}, "--from: is of a flight"},
        {{"--power", example_power, "--pitch-offset-deg", "2"}, "--pitch-offset-deg: is of a"},
        {{"--power", example_power, "--trim-log", flight_csv}, "--trim-log: is of a flight"},
        {{"--power", example_power, "--battery", "first"},
         "--battery: \"first\" is no number of a battery monitor"},
        {{"--power", example_power, "--battery", "0"}, "--battery: chooses among"},
        {{"--power", example_power, "--free-flight"}, "flies free has no supply"},
        {{"--power", flight_csv}, "column \"height_m\" is missing"},
        {{"--log", example_power}, "column \"pitch_deg\" is missing"}}) {
    const Ran run = diagnosed(c.arguments);
    INFO(c.says << ": " << run.err);
    CHECK(run.exit_code == 2);
    CHECK(run.out.empty());
    CHECK_THAT(run.err, Contains(c.says));
  }
  for (const std::vector<std::string>& of_logs : std::vector<std::vector<std::string>>{
           {"--mass-g", "1500"}, {"--base", "propwash"}, {"--to", "50%"}, {"--free-flight"}}) {
    std::vector<std::string> arguments{"report", published};
    arguments.insert(arguments.end(), of_logs.begin(), of_logs.end());
    const Ran run = run_tethercalc(arguments);
    CHECK(run.exit_code == 2);
    CHECK(run.out.empty());
    CHECK_THAT(run.err, Contains(of_logs.front() + ": is of "));
  }
}
