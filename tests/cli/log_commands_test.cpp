// `drag` and `log` through the real program.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/published.hpp"
#include "support/dataflash_writer.hpp"
#include "support/flight_csv.hpp"
#include "support/reference_data.hpp"
#include "support/run_program.hpp"

using namespace tethercalc::test;
using Catch::Contains;
using nlohmann::json;

namespace {

const std::string example = project_file("examples/simulated-flight.csv");

Ran drag(std::vector<std::string> logs, const std::vector<std::string>& options) {
  logs.insert(logs.begin(), "drag");
  logs.insert(logs.end(), options.begin(), options.end());
  return run_tethercalc(logs);
}

std::vector<std::string> and_also(std::vector<std::string> options,
                                  const std::vector<std::string>& more) {
  options.insert(options.end(), more.begin(), more.end());
  return options;
}

json drag_of(const std::vector<std::string>& logs, const std::vector<std::string>& options) {
  const Ran run = drag(logs, and_also(options, {"--format", "json"}));
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  return json::parse(run.out);
}

/// The example flight as two EKF cores would log it, the second one `second_pitch_deg` off.
std::vector<std::byte> example_as_dataflash(double second_pitch_deg) {
  const tethercalc::FlightLog flight = read_flight_csv(example);
  constexpr double centidegrees = 100 / 0.017453292519943295;
  DataFlashWriter log;
  define_xkf1(log);
  for (std::size_t i = 0; i < flight.time.size(); ++i) {
    const auto rounded = [](double value) { return static_cast<std::int64_t>(std::lround(value)); };
    LoggedEstimate s;
    s.time_us = static_cast<std::uint64_t>(std::llround(flight.time[i] * 1e6));
    s.roll_cdeg = rounded(flight.roll[i] * centidegrees);
    s.pitch_cdeg = rounded(flight.pitch[i] * centidegrees);
    s.yaw_cdeg = rounded(flight.yaw[i] * centidegrees);
    s.vn = flight.north_velocity[i];
    s.ve = flight.east_velocity[i];
    s.vd = flight.down_velocity[i];
    add_xkf1(log, 0, s);
    s.pitch_cdeg += rounded(100 * second_pitch_deg);
    add_xkf1(log, 1, s);
  }
  return log.bytes();
}

void write_bytes(const std::filesystem::path& path, const std::vector<std::byte>& bytes) {
  write_file(path, std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

/// Level hover whose pitch reads 0.8° too high.
std::string hover_csv() {
  std::ostringstream csv;
  csv << "time_s,roll_deg,pitch_deg,yaw_deg,vn_m_s,ve_m_s,vd_m_s\n";
  for (int i = 0; i < 200; ++i) {
    csv << 0.1 * i << ",0," << 0.8 + (i % 2 == 0 ? 0.1 : -0.1) << ",0,0,0,0\n";
  }
  return csv.str();
}

/// The header of a CSV text and its lines from `first` to before `last`.
std::string lines(const std::string& text, std::size_t first, std::size_t last) {
  std::istringstream in(text);
  std::ostringstream out;
  std::string line;
  for (std::size_t i = 0; std::getline(in, line); ++i) {
    if (i == 0 || (first <= i && i < last)) out << line << '\n';
  }
  return out.str();
}

}  // namespace

TEST_CASE("drag tells parameters, what is well known, and the range that it chose") {
  const Ran run = drag({example}, known);
  CHECK(run.exit_code == 0);
  CHECK(run.err.empty());
  CHECK_THAT(run.out, Contains("chosen automatically: 35.") && Contains("95 % interval") &&
                          Contains("Taken as known: 1550 g, 1.225 kg/m³, pitch offset 0.800°") &&
                          Contains("linear_m_s (correlation -0.9") &&
                          Contains("Well determined is the drag force"));
}

TEST_CASE("drag is told to be lost between samples a second apart") {
  const TemporaryFolder folder;
  const std::string slow = (folder.path() / "slow.csv").string();
  std::istringstream lines(file_text(example));
  std::string text;
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line); ++number) {
    if (number == 0 || number % 10 == 1) text += line + "\n";
  }
  write_file(slow, text);
  CHECK_THAT(drag({slow}, known).err, Contains("one sample every 1 s"));
  CHECK_THAT(drag_of({slow}, known).at("notes").dump(), Contains("one sample every 1 s"));
  CHECK_THAT(drag({example}, known).err, !Contains("one sample every"));
}

TEST_CASE("drag tells the flights of a log that teach it nothing, unless a range is chosen") {
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "two-flights.csv").string();
  std::istringstream lines(file_text(example));
  std::string first;
  std::getline(lines, first);
  first += "\n";
  std::string second;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t comma = line.find(',');
    first += line + "\n";
    second += fmt::format("{:.1f}{}\n", std::stod(line.substr(0, comma)) + 600, line.substr(comma));
  }
  write_file(log, first + second);
  const std::string unused =
      "two-flights.csv: of its flights the longest is used, 35.7 s to 464.3 "
      "s; not used: 635.7 s to 1064.3 s";
  CHECK_THAT(drag({log}, known).err, Contains(unused));
  CHECK_THAT(drag_of({log}, known).at("notes").dump(), Contains(unused));
  CHECK_THAT(drag({log}, and_also(known, {"--from", "600"})).err, !Contains("not used"));
  CHECK_THAT(drag({example}, known).err, !Contains("not used"));
}

TEST_CASE("drag's parameters for an autopilot are those of its JSON, with intervals as comments") {
  const json answer = drag_of({example}, known).at("autopilot");
  for (const std::string autopilot : {"ardupilot", "px4"}) {
    const Ran run = drag({example}, and_also(known, {"--parameters", autopilot}));
    CAPTURE(autopilot, run.err);
    REQUIRE(run.exit_code == 0);
    std::map<std::string, double> set;
    std::istringstream file(run.out);
    for (std::string line; std::getline(file, line);) {
      if (line.starts_with("#")) continue;
      std::ranges::replace(line, ',', '\t');
      std::istringstream cells(line);
      std::string name;
      double value = 0;
      int vehicle = 0;
      int component = 0;
      if (autopilot == "px4") cells >> vehicle >> component;
      REQUIRE(cells >> name >> value);
      set[name] = value;
    }
    std::size_t determined = 0;
    for (const auto& [name, parameter] : answer.at(autopilot).items()) {
      if (parameter.at("value").is_null()) {
        CHECK(set.count(name) == 0);
        CHECK_THAT(run.out, Contains(name + " is left out"));
        continue;
      }
      ++determined;
      REQUIRE(set.count(name) == 1);
      CHECK(set[name] == Approx(parameter.at("value").get<double>()).epsilon(1e-3));
      CHECK_THAT(run.out, Contains(name + " in " + parameter.at("unit").get<std::string>() +
                                   ", 95 % interval "));
    }
    CHECK(set.size() == determined);
    CHECK(determined == 2);  // this flight shows no drag to the side
  }
}

TEST_CASE("an autopilot that drag does not know, and two answers at once, are refused") {
  const Ran unknown = drag({example}, and_also(known, {"--parameters", "pix4"}));
  CHECK(unknown.exit_code == 2);
  CHECK(unknown.out.empty());
  CHECK_THAT(unknown.err, Contains("ardupilot and px4") && Contains("did you mean \"px4\""));
  const Ran both =
      drag({example}, and_also(known, {"--parameters", "px4", "--spec", published, "--into"}));
  CHECK(both.exit_code == 2);
  CHECK_THAT(both.err, Contains("--into"));
}

TEST_CASE("drag's JSON has the documented keys, and its intervals hold the simulated truth") {
  const json answer = drag_of({example}, known);
  const json truth{{"front_area_m2", 0.0150}, {"top_area_m2", 0.0140}, {"linear_m_s", 19}};
  for (const auto& [key, value] : truth.items()) {
    const json& parameter = answer.at(key);
    // Of three intervals of 95 % one may well miss; twice as wide they hold.
    CHECK(std::abs(parameter.at("value").get<double>() - value.get<double>()) <
          4 * parameter.at("standard_error").get<double>());
    CHECK(parameter.at("standard_error") > parameter.at("standard_error_independent"));
    CHECK(parameter.at("ci95").at(0) < parameter.at("ci95").at(1));
    CHECK(answer.at("drone").at("drag").at(key) == parameter.at("value"));
  }
  REQUIRE(answer.at("wind_m_s").size() == 1);
  CHECK(answer.at("wind_m_s")[0].at("value").get<double>() == Approx(-0.9).margin(0.2));
  CHECK(answer.at("samples").get<int>() > answer.at("effective_samples").get<double>());
  CHECK(answer.at("rmse_m_s2").get<double>() == Approx(0.25).margin(0.05));
  CHECK(answer.at("mae_m_s2") < answer.at("rmse_m_s2"));
  CHECK(answer.at("r_squared").get<double>() > 0.9);
  CHECK(answer.at("residual_lag1_autocorrelation").get<double>() == Approx(0.86).margin(0.05));
  CHECK(answer.at("warnings").empty());
  CHECK(answer.at("entangled")[0].at("parameters") == json{"front_area_m2", "linear_m_s"});
  double before = 0;
  for (const json& row : answer.at("table")) {
    CHECK(row.at("drag_force_N").at("value") > before);
    before = row.at("drag_force_N").at("value");
    CHECK(row.at("pitch_deg").at("ci95").at(0) < row.at("pitch_deg").at("value"));
  }
}

TEST_CASE("drag's CSV is the table of speed, force and tilt that the JSON has") {
  const Ran run = drag({example}, and_also(known, {"--format", "csv"}));
  CHECK(run.exit_code == 0);
  std::istringstream csv(run.out);
  std::string header;
  std::getline(csv, header);
  CHECK(header.substr(0, 26) == "airspeed_m_s,drag_force_N,");
  const json table = drag_of({example}, known).at("table");
  std::string line;
  std::size_t row = 0;
  for (; std::getline(csv, line); ++row) {
    REQUIRE(row < table.size());
    double speed = 0;
    double force = 0;
    char comma = 0;
    std::istringstream(line) >> speed >> comma >> force;
    CHECK(speed == table[row].at("airspeed_m_s").get<double>());
    CHECK(force == table[row].at("drag_force_N").at("value").get<double>());
  }
  CHECK(row == table.size());
}

TEST_CASE("what was not said and moves the answer is told on standard error") {
  const Ran run = drag({example}, {"--mass-g", "1550", "--format", "json"});
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.err, Contains("no air density given, 1.293 kg/m³ taken") &&
                          Contains("no pitch offset given, 0° taken"));
  CHECK(json::parse(run.out).at("air_density_kg_m3") == 1.293);

  const Ran drawn = run_tethercalc({"plot", "drag", example, "--mass-g", "1550"});
  CHECK(drawn.exit_code == 0);
  CHECK_THAT(drawn.err, Contains("plot drag: no air density given, 1.293 kg/m³ taken") &&
                            Contains("plot drag: no pitch offset given, 0° taken"));
  const Ran page = run_tethercalc({"report", published, "--flight", example});
  CHECK(page.exit_code == 0);
  CHECK_THAT(page.err, Contains("report: no pitch offset given, 0° taken") &&
                           !Contains("air density"));  // that is the spec's
}

TEST_CASE("learned drag goes into a spec, to a file or down a pipe to optimize") {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "learned.json").string();
  const json learned = drag_of({example}, known).at("drone").at("drag");
  const auto into = and_also(known, {"--spec", published, "--into"});
  const Ran beside = drag({example}, and_also(into, {file}));
  CHECK(beside.exit_code == 0);
  CHECK(beside.out == drag({example}, known).out);  // the fit is told all the same
  json spec = json::parse(file_text(file));
  const json before = json::parse(file_text(published));
  CHECK(spec.at("drone").at("drag") == learned);
  spec["drone"]["drag"] = before.at("drone").at("drag");
  CHECK(spec == before);

  std::string line = shell_quoted(TETHERCALC_COMMAND) + " drag " + shell_quoted(example);
  for (const std::string& option : into) line += " " + shell_quoted(option);
  const Ran piped =
      run_shell(line + " | " + shell_quoted(TETHERCALC_COMMAND) + " optimize - --format json");
  CHECK(piped.exit_code == 0);
  const Ran filed = run_tethercalc({"optimize", file, "--format", "json"});
  CHECK(json::parse(piped.out).at("optimum") == json::parse(filed.out).at("optimum"));
}

TEST_CASE(
    "drag takes mass and air from the spec that it is learned for, where options say nothing") {
  const TemporaryFolder folder;
  json spec = json::parse(file_text(published));
  spec["drone"]["mass_g"] = 2100;
  spec["flight"]["air_density_kg_m3"] = 1.05;
  const std::string mine = (folder.path() / "mine.json").string();
  const std::string learned = (folder.path() / "learned.json").string();
  write_file(mine, spec.dump());
  const std::vector<std::string> into{
      "--pitch-offset-deg", "0.8", "--spec", mine, "--into", learned};
  const auto taken = [&](const std::vector<std::string>& options, double mass_g, double density) {
    CAPTURE(options);
    const json answer = drag_of({example}, and_also(into, options));
    CHECK(answer.at("mass_g").get<double>() == Approx(mass_g));
    CHECK(answer.at("air_density_kg_m3").get<double>() == Approx(density).epsilon(1e-4));
    CHECK(json::parse(file_text(learned)).at("drone").at("drag") == answer.at("drone").at("drag"));
  };
  taken({}, 2100, 1.05);
  taken({"--mass-g", "1550"}, 1550, 1.05);
  taken({"--air-density", "1.2"}, 2100, 1.2);
  taken({"--pressure-hPa", "1013.25", "--temperature-C", "15"}, 2100, 1.225);
  const Ran run = drag({example}, into);
  CHECK(run.exit_code == 0);
  CHECK(run.err.empty());  // nothing was assumed
}

TEST_CASE("drag is learned where things weigh what the spec says") {
  const TemporaryFolder folder;
  const std::string mine = (folder.path() / "mine.json").string();
  const std::string learned = (folder.path() / "learned.json").string();
  const auto with_gravity = [&](double gravity) {
    json spec = json::parse(file_text(published));
    spec["flight"]["gravity_m_s2"] = gravity;
    write_file(mine, spec.dump());
    return drag_of({example}, and_also(known, {"--spec", mine, "--into", learned}));
  };
  const json here = drag_of({example}, known);
  CHECK(with_gravity(9.80665).at("drone") == here.at("drone"));
  const json elsewhere = with_gravity(9.6);
  CHECK(elsewhere.at("drone") != here.at("drone"));
  for (const json& row : elsewhere.at("table")) {
    const double tilt = row.at("pitch_deg").at("value").get<double>() * 0.017453292519943295;
    CHECK(row.at("drag_force_N").at("value").get<double>() ==
          Approx(1.55 * 9.6 * std::tan(tilt)).epsilon(1e-6));
  }
}

TEST_CASE("drag --into writes a spec: neither without one to learn for, nor over a log") {
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "flight.csv").string();
  write_file(log, file_text(example));
  const std::string mine = (folder.path() / "mine.json").string();
  write_file(mine, file_text(published));
  const auto refused = [&](const std::vector<std::string>& options, const std::string& because) {
    const Ran run = drag({example}, and_also(known, options));
    CAPTURE(options);
    CHECK(run.exit_code == 2);
    CHECK(run.out.empty());
    CHECK_THAT(run.err, Contains(because));
  };
  refused({"--into", mine}, "--into: says where the spec with the learned drag goes");
  refused({"--into"}, "is given by --spec SPEC");
  refused({"--spec", mine}, "give --into as well");
  refused({"--spec", mine, "--into", mine}, "is read; give another file");
  refused({"--spec", mine, "--into", log}, "is there and no .json file");
  refused({"--spec", mine, "--into", "--format", "csv"}, "a spec in JSON");
  refused({"--core", "1"}, "flight.csv: is CSV and holds one estimate");
  CHECK(file_text(mine) == file_text(published));
  CHECK(file_text(log) == file_text(example));
}

TEST_CASE(
    "a spec that is not there, or has no place for drag, is refused before anything is written") {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "learned.json").string();
  const Ran missing = drag({example}, and_also(known, {"--spec", "no-such.json", "--into", file}));
  CHECK(missing.exit_code == 2);
  CHECK_THAT(missing.err, Contains("no-such.json: no such file"));
  const std::string broken = (folder.path() / "broken.json").string();
  write_file(broken, "{\"drone\": 7}");
  const Ran refused = drag({example}, and_also(known, {"--spec", broken, "--into", file}));
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.err, Contains("/drone"));
  CHECK_FALSE(std::filesystem::exists(file));
}

TEST_CASE("a hover's mean pitch is the offset, and only one offset can be right") {
  const TemporaryFolder folder;
  const std::string hover = (folder.path() / "hover.csv").string();
  write_file(hover, hover_csv());
  const std::vector<std::string> given{"--mass-g", "1550", "--air-density", "1.225"};
  const json trimmed = drag_of({example}, and_also(given, {"--trim-log", hover}));
  CHECK(trimmed.at("pitch_offset_deg").get<double>() == Approx(0.8).margin(1e-9));
  CHECK(trimmed.at("front_area_m2").at("value").get<double>() ==
        Approx(drag_of({example}, known).at("front_area_m2").at("value").get<double>()));
  const Ran both = drag({example}, and_also(known, {"--trim-log", hover}));
  CHECK(both.exit_code == 2);
  CHECK_THAT(both.err, Contains("--trim-log") && Contains("only one can be right"));
  const Ran moving = drag({example}, and_also(given, {"--trim-log", example}));
  CHECK(moving.exit_code == 2);
  CHECK_THAT(moving.err, Contains("simulated-flight.csv: is no hover"));
}

TEST_CASE("a range in seconds or in percent of the samples selects what it says") {
  const json seconds = drag_of({example}, and_also(known, {"--from", "60", "--to", "400s"}));
  CHECK(seconds.at("range") == "given");
  CHECK(seconds.at("flights")[0].at("from_s") == 60);
  CHECK(seconds.at("flights")[0].at("to_s") == 400);
  // 5001 samples from 5 s to 505 s: a quarter and nine tenths of them.
  const json percent = drag_of({example}, and_also(known, {"--from", "25%", "--to", "90%"}));
  CHECK(percent.at("flights")[0].at("from_s").get<double>() == Approx(130).margin(0.2));
  CHECK(percent.at("flights")[0].at("to_s").get<double>() == Approx(455).margin(0.2));
  for (const auto& [option, value, reason] :
       std::vector<std::tuple<std::string, std::string, std::string>>{
           {"--from", "soon", "\"soon\" is not a place in a log"},
           {"--to", "120 %", "is not a place in a log"},
           {"--from", "130%", "must satisfy 0 <= from < to <= 100"},
           {"--from", "4000", "the log runs from 5.000 s to"}}) {
    const Ran run = drag({example}, and_also(known, {option, value}));
    CAPTURE(option, value);
    CHECK(run.exit_code == 2);
    CHECK(run.out.empty());
    CHECK_THAT(run.err, Contains(reason));
  }
}

TEST_CASE("air density comes directly or from pressure and temperature, not from both") {
  const std::vector<std::string> rest{"--mass-g", "1550", "--pitch-offset-deg", "0.8"};
  const json answer =
      drag_of({example}, and_also(rest, {"--pressure-hPa", "1013.25", "--temperature-C", "15"}));
  // The International Standard Atmosphere at sea level, ISO 2533.
  CHECK(answer.at("air_density_kg_m3").get<double>() == Approx(1.225).margin(5e-5));
  for (const auto& [options, reason] :
       std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"--pressure-hPa", "1000"}, "give the air density together"},
           {{"--temperature-C", "20"}, "give the air density together"},
           {{"--pressure-hPa", "101325", "--temperature-C", "15"},
            "101325 is out of range; allowed is 100 to 1200 hPa"},
           {{"--air-density", "1.2", "--temperature-C", "15"}, "goes without --pressure-hPa"},
           {{"--air-density", "12"}, "12 is out of range; allowed is 0.1 to 2 kg/m³"}}) {
    const Ran run = drag({example}, and_also(rest, options));
    CAPTURE(reason);
    CHECK(run.exit_code == 2);
    CHECK(run.out.empty());
    CHECK_THAT(run.err, Contains(reason));
  }
}

TEST_CASE("several logs share the drag and not the wind") {
  const TemporaryFolder folder;
  const std::string text = file_text(example);
  const std::string first = (folder.path() / "first.csv").string();
  const std::string second = (folder.path() / "second.csv").string();
  write_file(first, lines(text, 1, 2500));
  write_file(second, lines(text, 2500, 6000));
  const json both = drag_of({first, second}, known);
  const json alone = drag_of({first}, known);
  REQUIRE(both.at("wind_m_s").size() == 2);
  REQUIRE(both.at("flights").size() == 2);
  CHECK(both.at("wind_m_s")[0].at("value") != both.at("wind_m_s")[1].at("value"));
  CHECK(both.at("linear_m_s").at("standard_error") < alone.at("linear_m_s").at("standard_error"));
  const Ran text_run = drag({first, second}, known);
  CHECK_THAT(text_run.out, Contains("log 1 ") && Contains("log 2 ") && Contains("wind_m_s, log 2"));
}

TEST_CASE("a DataFlash log gives what its CSV gives, core by core") {
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "flight.bin").string();
  write_bytes(log, example_as_dataflash(0.5));
  const json from_csv = drag_of({example}, known);
  const json from_log = drag_of({log}, known);
  // Velocities are logged in single precision.
  CHECK(from_log.at("front_area_m2").at("value").get<double>() ==
        Approx(from_csv.at("front_area_m2").at("value").get<double>()).epsilon(1e-5));
  const json second = drag_of({log}, {"--mass-g", "1550", "--air-density", "1.225",
                                      "--pitch-offset-deg", "1.3", "--core", "1"});
  CHECK(second.at("front_area_m2").at("value").get<double>() ==
        Approx(from_csv.at("front_area_m2").at("value").get<double>()).epsilon(1e-5));
  const Ran third = drag({log}, and_also(known, {"--core", "2"}));
  CHECK(third.exit_code == 2);
  CHECK_THAT(third.err, Contains("there is no EKF core 2") && Contains("it has core 0, 1"));
}

TEST_CASE("a damaged log is used, and what was skipped of it is told") {
  const TemporaryFolder folder;
  std::vector<std::byte> bytes = example_as_dataflash(0);
  const auto middle = bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 2);
  bytes.erase(middle, middle + 1000);
  bytes.resize(bytes.size() - 10);
  const std::string log = (folder.path() / "damaged.bin").string();
  write_bytes(log, bytes);
  const Ran run = drag({log}, known);
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.err, Contains("damaged.bin: the log is damaged or cut: ") &&
                          Contains(" bytes and at least "));
  CHECK_THAT(run.out, Contains("front_area_m2"));

  const Ran summary = run_tethercalc({"log", log});
  CHECK(summary.exit_code == 0);
  CHECK_THAT(summary.out, Contains("bytes skipped, with at least ") && Contains("bytes at byte "));
  const json told = json::parse(run_tethercalc({"log", log, "--format", "json"}).out);
  // The two cuts leave pieces of messages of 32 bytes.
  CHECK(told.at("skipped").at("bytes").get<int>() > 0);
  CHECK(told.at("skipped").at("bytes").get<int>() < 200);
  CHECK(told.at("skipped").at("messages").get<int>() >= 2);
  CHECK(told.at("skipped").at("stretches").size() == 2);
}

TEST_CASE("a parameter that the flight lacks the means for is held at its bound, and told") {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "linear.csv").string();
  // A drone of purely linear drag: a = g·tanθ − 1.2·v, flown back and forth by a swinging tilt.
  std::ostringstream csv;
  csv.precision(9);
  csv << "time_s,roll_deg,pitch_deg,yaw_deg,vn_m_s,ve_m_s,vd_m_s\n";
  double v = 0;
  constexpr int finer = 100;
  for (int i = 0; i < 3000 * finer; ++i) {
    const double t = 0.1 * i / finer;
    const double tilt = 0.35 * std::sin(0.8 * t) + 0.08 * std::sin(0.31 * t);
    if (i % finer == 0) csv << t << ",0," << -tilt / 0.017453292519943295 << ",0," << v << ",0,0\n";
    v += 0.1 / finer * (9.80665 * std::tan(tilt) - 0.6 * v);
  }
  write_file(file, csv.str());
  const Ran run = drag({file}, known);
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.out, Contains("held at its upper bound") &&
                          Contains("linear_m_s wants to leave its upper bound 500.0"));
  const json answer = drag_of({file}, known);
  CHECK(answer.at("linear_m_s").at("at_bound") == "upper");
  CHECK(answer.at("linear_m_s").at("ci95").is_null());
  REQUIRE(answer.at("warnings").size() == 1);
  const Ran into = drag({file}, and_also(known, {"--spec", published, "--into"}));
  CHECK_THAT(into.err, Contains("drag: linear_m_s wants to leave its upper bound"));
}

/// The example flight with its rows changed: time, roll, pitch, yaw, north, east and down velocity.
void write_changed_example(const std::string& file,
                           const std::function<void(std::array<double, 7>&)>& change) {
  std::istringstream original(file_text(example));
  std::ostringstream changed;
  std::string line;
  std::getline(original, line);
  changed << line << "\n";
  while (std::getline(original, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream cells(line);
    std::array<double, 7> row{};
    for (double& cell : row) cells >> cell;
    change(row);
    changed << fmt::format("{}\n", fmt::join(row, ","));
  }
  write_file(file, changed.str());
}

TEST_CASE("drag refuses a flight in other units as diagnose does") {
  const TemporaryFolder folder;
  constexpr double degree = 0.017453292519943295;
  struct Mistake {
    std::vector<std::size_t> columns;
    double factor;
    const char* told;
  };
  for (const Mistake& mistake :
       {Mistake{{1, 2, 3}, degree, "radians"}, Mistake{{4, 5, 6}, 3.6, "km/h"},
        Mistake{{4, 5, 6}, 1.943844, "knots"}, Mistake{{0}, 1000, "milliseconds"},
        Mistake{{2}, -1, "pitch were positive nose-down"}}) {
    const std::string file = (folder.path() / "changed.csv").string();
    write_changed_example(file, [&](auto& row) {
      for (const std::size_t column : mistake.columns) row[column] *= mistake.factor;
    });
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"drag", file}, {"diagnose", published, "--flight", file}}) {
      const Ran run = run_tethercalc(and_also(command, {"--mass-g", "1550"}));
      INFO(run.err);
      CHECK(run.exit_code == 2);
      CHECK(run.out.empty());
      CHECK_THAT(run.err, Contains(mistake.told));
    }
  }
}

TEST_CASE("a heading that is off teaches no drag, and diagnose sizes it") {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "turned.csv").string();
  write_changed_example(file, [](auto& row) { row[3] += 20; });
  const Ran drag = run_tethercalc({"drag", file, "--mass-g", "1550"});
  CHECK(drag.exit_code == 2);
  CHECK(drag.out.empty());
  CHECK_THAT(drag.err, Contains("20° to the left of where its nose leans"));
  const json answer = json::parse(
      run_tethercalc({"diagnose", published, "--flight", file, "--format", "json"}).out);
  CHECK(answer.at("findings")[0].at("effect") == "yaw_misalign");
  const json& off = answer.at("findings")[0].at("parameters")[0];
  CHECK(off.at("ci95")[0] <= 20);
  CHECK(off.at("ci95")[1] >= 20);
}

TEST_CASE("one sample of an impossible velocity is left out and told, and moves nothing") {
  const TemporaryFolder folder;
  std::istringstream original(file_text(example));
  std::ostringstream with, without;
  std::string line;
  for (int row = 0; std::getline(original, line); ++row) {
    if (row != 1500) without << line << "\n";
    if (row == 1500) {
      std::size_t comma = 0;
      for (int k = 0; k < 4; ++k) comma = line.find(',', comma) + 1;
      line.replace(comma, line.find(',', comma) - comma, "499");
    }
    with << line << "\n";
  }
  const std::string bad = (folder.path() / "bad.csv").string();
  const std::string good = (folder.path() / "good.csv").string();
  write_file(bad, with.str());
  write_file(good, without.str());
  const Ran run = drag({bad}, known);
  CHECK_THAT(run.err, Contains("1 sample left out: values that no flight can have"));
  json told = drag_of({bad}, known);
  json silent = drag_of({good}, known);
  CHECK_THAT(told.at("note_codes").dump(), Contains("log_values_implausible"));
  for (json* answer : {&told, &silent}) {
    answer->erase("notes");
    answer->erase("note_codes");
  }
  CHECK(told == silent);
}

TEST_CASE("a drag command that cannot work says why, and prints nothing else") {
  const TemporaryFolder folder;
  const std::string empty = (folder.path() / "empty.bin").string();
  const std::string text = (folder.path() / "notes.txt").string();
  const std::string hover = (folder.path() / "hover.csv").string();
  write_file(empty, "");
  write_file(text, "Flew well today.\n");
  write_file(hover, hover_csv());
  for (const auto& [arguments, reason] :
       std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{example}, "--mass-g: is needed"},
           {{example, "--mass-g", "0"},
            "--mass-g: 0 is out of range; allowed is at least 10 and at most 1000000 g"},
           {{example, "--mass-g", "1.55"},
            "--mass-g: 1.55 is out of range; allowed is at least 10 and at most 1000000 g; did you "
            "mean 1550? The unit is the gram"},
           {{"/dev/zero", "--mass-g", "1550"}, "goes on beyond 256 MiB"},
           {{"no-such.bin", "--mass-g", "1550"}, "no-such.bin: cannot be opened"},
           {{empty, "--mass-g", "1550"}, "empty.bin:1: the file is empty"},
           {{text, "--mass-g", "1550"}, "column \"time_s\" is missing"},
           {{hover, "--mass-g", "1550"}, "never flies at"},
           {{folder.path().string(), "--mass-g", "1550"}, "is a directory"},
           {{example, "--mass-gr", "1550"}, "did you mean \"--mass-g\"?"},
           {{}, "LOG is required"}}) {
    const Ran run = drag({}, arguments);
    CAPTURE(reason);
    CHECK(run.exit_code == 2);
    CHECK(run.out.empty());
    CHECK_THAT(run.err, Contains(reason));
  }
}

TEST_CASE("log tells messages, rates and times, for people and programs") {
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "flight.bin").string();
  write_bytes(log, example_as_dataflash(0));
  const std::size_t samples = read_flight_csv(example).time.size();
  const Ran text = run_tethercalc({"log", log});
  CHECK(text.exit_code == 0);
  CHECK(text.err.empty());
  CHECK_THAT(text.out, Contains("nothing skipped") && Contains("XKF1") &&
                           Contains("gaps       none over 1 s") &&
                           Contains(std::to_string(2 * samples)));
  const json told = json::parse(run_tethercalc({"log", log, "--format", "json"}).out);
  CHECK(told.at("messages") == 2 * samples + 2);  // with the definitions of FMT and XKF1
  CHECK(told.at("first_s") == 5);
  CHECK(told.at("duration_s").get<double>() == Approx(0.1 * static_cast<double>(samples - 1)));
  CHECK(told.at("flying").at("duration_s").get<double>() == Approx(430).margin(10));
  const json& ekf = told.at("types")[1];
  CHECK(ekf.at("name") == "XKF1");
  CHECK(ekf.at("rate_Hz").get<double>() == Approx(20).epsilon(0.01));
  CHECK(ekf.at("longest_gap_s").get<double>() == Approx(0.1).margin(1e-6));
  const Ran csv = run_tethercalc({"log", log, "--format", "csv"});
  CHECK_THAT(csv.out, Catch::StartsWith("name,count,rate_Hz,first_s,last_s,longest_gap_s\n"));
  CHECK(std::count(csv.out.begin(), csv.out.end(), '\n') == 3);
}

TEST_CASE("log says of a short flight what diagnose says of it") {
  const auto log = reference_file("data/logs/sitl_delorean_00000116.bin");
  if (!log) return;
  CHECK_THAT(run_tethercalc({"log", log->string()}).out,
             Contains("diagnose --flight: no, 30 s flown, 72 s are needed"));
  CHECK_THAT(run_tethercalc({"diagnose", published, "--flight", log->string()}).out,
             Contains("30.0 s of usable flight, 72 s are needed"));
}

TEST_CASE("log exports the messages of a name, and names the nearest for one that is not there") {
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "flight.bin").string();
  const std::string file = (folder.path() / "xkf1.csv").string();
  write_bytes(log, example_as_dataflash(0));
  CHECK(run_tethercalc({"log", log, "--csv", "XKF1", "--output", file}).exit_code == 0);
  std::istringstream csv(file_text(file));
  std::string header;
  std::string first;
  std::getline(csv, header);
  std::getline(csv, first);
  CHECK(header == "TimeUS,C,Roll,Pitch,Yaw,VN,VE,VD");
  CHECK_THAT(first, Catch::StartsWith("5000000,0,-1.15,-2.63,57.3,-0.01886,0.00818,"));
  const Ran in_json = run_tethercalc({"log", log, "--csv", "XKF1", "--format", "json"});
  CHECK(in_json.exit_code == 2);
  CHECK(in_json.out.empty());
  CHECK_THAT(in_json.err, Contains("--format: json is not what --csv exports"));
  const Ran missing = run_tethercalc({"log", log, "--csv", "XKF"});
  CHECK(missing.exit_code == 2);
  CHECK(missing.out.empty());
  CHECK_THAT(missing.err, Contains("no message XKF; did you mean \"XKF1\"?"));
  const Ran far = run_tethercalc({"log", log, "--csv", "BARO"});
  CHECK(far.exit_code == 2);
  CHECK_THAT(far.err, Contains("no message BARO; it holds FMT, XKF1"));
}

#ifndef TETHERCALC_SANITIZED  // it maps more than any limit
TEST_CASE("an export is written as it is read, not gathered in memory") {
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "long.bin").string();
  const std::string rows = (folder.path() / "rows.csv").string();
  constexpr std::size_t megabyte = 1'000'000;
  const std::vector<std::byte> once = example_as_dataflash(0);
  std::vector<std::byte> bytes;
  while (bytes.size() < 60 * megabyte) bytes.insert(bytes.end(), once.begin(), once.end());
  write_bytes(log, bytes);
  // The log is mapped, the program with its libraries takes 50 MB.
  const Ran run = run_shell("ulimit -v 140000 && " + shell_quoted(TETHERCALC_COMMAND) + " log " +
                            shell_quoted(log) + " --csv XKF1 --output " + shell_quoted(rows));
  INFO(run.err);
  CHECK(run.exit_code == 0);
  CHECK(std::filesystem::file_size(rows) > 80 * megabyte);
}
#endif

TEST_CASE("a log that is none is refused") {
  const TemporaryFolder folder;
  const std::string empty = (folder.path() / "empty.bin").string();
  write_file(empty, "");
  const std::string noise = (folder.path() / "noise.bin").string();
  write_file(noise, std::string(3000, '\0'));
  const std::string dangling = (folder.path() / "dangling.json").string();
  std::filesystem::create_symlink("nowhere", dangling);
  CHECK_THAT(run_tethercalc({"validate", dangling}).err,
             Contains("a link to a file that is not there"));
  for (const auto& [file, reason] : std::vector<std::pair<std::string, std::string>>{
           {"no-such.bin", "no-such.bin: cannot be opened"},
           {empty, "the file is empty"},
           {noise, "no message of ArduPilot or PX4 was found in its 3000 bytes"},
           {example, "is a text, but not one of an autopilot's log"},
           {folder.path().string(), "is a directory"}}) {
    const Ran run = run_tethercalc({"log", file});
    CAPTURE(file);
    CHECK(run.exit_code == 2);
    CHECK(run.out.empty());
    CHECK_THAT(run.err, Contains(reason));
  }
}

TEST_CASE("the published fit comes out of the published log, DataFlash or CSV") {
  for (const char* name : {"data/x500-flight.bin", "data/x500-flight.csv"}) {
    const auto log = reference_file(name);
    if (!log) return;
    const Ran run = drag({log->string()}, {"--mass-g", "1549", "--from", "25%", "--to", "90%",
                                           "--air-density", "1.293", "--pitch-offset-deg",
                                           "1.4955439766569403", "--published-kinematics"});
    CHECK(run.exit_code == 0);
    // Beffert and Zell, Cable Optimization and Drag Estimation, section V-B.
    for (const char* printed : {"1.492e-02", "3.07 %", "1.368e-02", "3.18 %", "19.43", "4.35 %",
                                "-1.196", "1.61 %", "(3396 samples)"}) {
      CHECK_THAT(run.out, Contains(printed));
    }
  }
}

TEST_CASE("a flight given once more, whole or in part, is refused") {
  const TemporaryFolder folder;
  const std::string text = file_text(example);
  const std::size_t middle = text.find('\n', text.size() / 2) + 1;
  const std::string second_half = folder.path() / "second-half.csv";
  write_file(second_half, text.substr(0, text.find('\n') + 1) + text.substr(middle));
  for (const std::string& again : {example, second_half}) {
    const Ran run = drag({example, again}, {"--mass-g", "1550"});
    CHECK(run.exit_code == 2);
    CHECK_THAT(run.err, Contains("is the same flight as another of these logs, or a part of it"));
  }
}
