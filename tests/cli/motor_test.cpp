// `motor`, and motors of one's own in other commands, through the real program.
#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <nlohmann/json.hpp>

#include "cli/published.hpp"
#include "support/reference_data.hpp"
#include "support/run_program.hpp"

using namespace tethercalc::test;
using Catch::Contains;
using nlohmann::json;

namespace {

const std::string sheet =
    "Throttle (%);Thrust (g);Voltage (V);Current (A)\n"
    "40;300;16;1,8\n50;450;16;3,2\n65;800;16;7,5\n80;1200;16;13,8\n100;1700;16;24\n";

json parsed(const Ran& run) {
  CAPTURE(run.err);
  REQUIRE(run.exit_code == 0);
  return json::parse(run.out);
}

}  // namespace

TEST_CASE("motor writes a file that a spec takes, and the same as the table itself") {
  const TemporaryFolder folder;
  const std::string table = (folder.path() / "roof.csv").string();
  const std::string file = (folder.path() / "motor.json").string();
  write_file(table, sheet);
  const Ran run = run_tethercalc({"motor", table, "--propeller-in", "11", "--air-density", "1.2",
                                  "--name", "Roof bench", "--output", file});
  CHECK(run.exit_code == 0);
  CHECK(run.out.empty());
  const json motor = json::parse(file_text(file));
  CHECK(motor.at("id") == "roof");
  CHECK(motor.at("name") == "Roof bench");
  CHECK(motor.at("source") == "roof.csv");
  CHECK(motor.at("voltage_V") == 16);
  CHECK(motor.at("propeller_in") == 11);
  CHECK(motor.at("measured_air_density_kg_m3") == 1.2);
  CHECK(motor.at("points").size() == 5);
  CHECK(motor.at("points")[0].at("power_W") == 28.8);  // 16 V · 1.8 A

  const auto optimum = [&](const std::string& reference) {
    return parsed(
               run_tethercalc({"optimize", published, "--set", "drone.motor=" + reference, "--set",
                               "drone.motor_air_density_kg_m3=1.2", "--format", "json"}))
        .at("optimum");
  };
  CHECK(optimum(table) == optimum(file));
}

TEST_CASE("motor shows each point's figure of merit, and refuses an impossible one") {
  const TemporaryFolder folder;
  const std::string table = (folder.path() / "roof.csv").string();
  write_file(table, sheet);
  const Ran run = run_tethercalc(
      {"motor", table, "--propeller-in", "11", "--air-density", "1.2", "--format", "csv"});
  REQUIRE(run.exit_code == 0);
  // 1700 g in 1.2 kg/m³ on 11 inch: T 16.671 N, A 0.061312 m², 177.45 W ideal of 384 W.
  CHECK_THAT(run.out, Contains("1700,384,") && Contains(",0.462"));
  const Ran impossible = run_tethercalc(
      {"motor", table, "--propeller-in", "40", "--columns", "thrust_lbf=Thrust (g)"});
  CHECK(impossible.exit_code == 2);
  CHECK(impossible.out.empty());
  CHECK_THAT(impossible.err, Contains("above 1 is impossible"));
}

TEST_CASE("a motor file with an impossible figure of merit is refused wherever it is read") {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "impossible.json").string();
  // 1 kg on 5 inch needs 174.3 W of an ideal rotor: 9.80665^1.5/√(2·1.225·0.012668).
  write_file(file,
             R"({"id": "impossible", "name": "Impossible", "source": "none", "propeller_in": 5,
                       "points": [{"thrust_g": 500, "power_W": 60}, {"thrust_g": 1000, "power_W": 110}]})");
  const std::vector<std::vector<std::string>> readers = {
      {"motor", file},
      {"evaluate", published, "--area-mm2", "0.5", "--set", "drone.motor=" + file},
      {"optimize", published, "--set", "drone.motor=" + file},
      {"compare", published, "--motors", file}};
  for (const std::vector<std::string>& reader : readers) {
    const Ran run = run_tethercalc(reader);
    CAPTURE(reader.front(), run.err);
    CHECK(run.exit_code == 2);
    CHECK_THAT(run.err,
               Contains("figure of merit of 1.5") && Contains("with a propeller of 5 inch"));
  }
}

TEST_CASE("one's own motor stands in the ranking under its file's name") {
  const TemporaryFolder folder;
  const std::string table = (folder.path() / "roof.csv").string();
  write_file(table, sheet);
  const json ranking = parsed(
      run_tethercalc({"compare", published, "--set", "drone.motor=" + table, "--format", "json"}));
  std::vector<std::string> names;
  for (const json& row : ranking.at("motors")) names.push_back(row.at("motor"));
  CHECK(std::count(names.begin(), names.end(), "roof") == 1);
  const json library = parsed(run_tethercalc({"compare", published, "--format", "json"}));
  CHECK(names.size() == library.at("motors").size() + 1);
  const json chosen =
      parsed(run_tethercalc({"compare", published, "--motors", table, "--format", "json"}));
  CHECK(chosen.at("motors")[0].at("motor") == "roof");
}

TEST_CASE("a generic motor is a file whose answers say that it is an estimate") {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "big.json").string();
  const Ran run = run_tethercalc({"motor", "--propeller-in", "28", "--figure-of-merit", "0.6",
                                  "--max-thrust-g", "8000", "--output", file});
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.err, Contains("estimate"));
  const json motor = json::parse(file_text(file));
  CHECK_THAT(motor.at("source").get<std::string>(),
             Contains("not measured") && Contains("momentum theory"));
  // 8 kgf on 28 inch in 1.225 kg/m³: T 78.453 N, A 0.39726 m², 704.3 W ideal.
  const json& last = motor.at("points").back();
  CHECK(last.at("thrust_g") == 8000);
  CHECK(last.at("power_W").get<double>() == Approx(704.3 / 0.6).epsilon(1e-3));
  for (const std::string command : {"optimize", "compare"}) {
    const Ran answer = run_tethercalc({command, published, "--set", "drone.motor=" + file});
    CAPTURE(command, answer.out);
    CHECK(answer.exit_code == 0);
    CHECK_THAT(answer.out, Contains("the motor is an estimate, not measured"));
  }
}

TEST_CASE("motor says every option that it lacks or that does not fit") {
  const Ran bare = run_tethercalc({"motor", "--figure-of-merit", "1.2", "--where", "a=b"});
  CHECK(bare.exit_code == 2);
  CHECK(bare.out.empty());
  CHECK_THAT(bare.err, Contains("--figure-of-merit: 1.2 is out of range") &&
                           Contains("--propeller-in: is needed") &&
                           Contains("--max-thrust-g: is needed") && Contains("--where"));
  // What no motor file may hold is refused, not written.
  for (const auto& [option, value] :
       {std::pair{"--propeller-in", "1e-300"}, std::pair{"--max-thrust-g", "2e6"},
        std::pair{"--figure-of-merit", "1e-9"}, std::pair{"--air-density", "0"}}) {
    std::vector<std::string> arguments{"motor", "--propeller-in", "10",  "--figure-of-merit",
                                       "0.5",   "--max-thrust-g", "1000"};
    const auto given = std::ranges::find(arguments, option);
    if (given != arguments.end()) {
      *(given + 1) = value;
    } else {
      arguments.insert(arguments.end(), {option, value});
    }
    const Ran refused = run_tethercalc(arguments);
    INFO(option << refused.err);
    CHECK(refused.exit_code == 2);
    CHECK(refused.out.empty());
    CHECK_THAT(refused.err, Contains(option) && Contains("out of range"));
  }
  const TemporaryFolder folder;
  const std::string table = (folder.path() / "unclear.csv").string();
  write_file(table, "F,P\n1,2\n3,4\n");
  const Ran unclear = run_tethercalc({"motor", table});
  CHECK(unclear.exit_code == 2);
  CHECK_THAT(unclear.err, Contains("F | P") && Contains("--columns thrust_g=\"…\",power_W=\"…\""));
}

TEST_CASE("a motor is learned from the power of a flight, and says how well") {
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "free.csv").string();
  std::string csv = "time_s,height_m,airspeed_m_s,bus_voltage_V,bus_current_A\n";
  for (int i = 0; i < 300; ++i) {  // 400 W, give or take 2 % in turns
    csv += std::to_string(i) + ",20,0.5,16," + (i % 2 == 0 ? "25.5" : "24.5") + "\n";
  }
  write_file(log, csv);
  const Ran run = run_tethercalc({"motor", "--power-log", log, "--spec", published,
                                  "--max-thrust-g", "1300", "--format", "json"});
  const json motor = parsed(run);
  CHECK(motor.at("id") == "free");
  CHECK_THAT(motor.at("source").get<std::string>(),
             Contains("in 299 s of hover 96.2 W for 427 g a motor"));
  CHECK(motor.at("power_uncertainty_percent").get<double>() > 5);
  CHECK(motor.at("points").back().at("thrust_g") == 1300);
  // 400 W less the published drone's 15 W beside its motors: 96.25 W · (1300/427.5)^1.5
  CHECK(motor.at("points").back().at("power_W").get<double>() == Approx(510.4).epsilon(1e-3));
  CHECK_THAT(run.err, Contains("known at its hover only"));

  const Ran tethered =
      run_tethercalc({"motor", "--power-log", project_file("examples/simulated-power.csv"),
                      "--spec", published, "--max-thrust-g", "1300"});
  CHECK(tethered.exit_code == 2);
  CHECK_THAT(tethered.err, Contains("was it flown on the tether?"));

  const Ran bare = run_tethercalc({"motor", "--power-log", log});
  CHECK(bare.exit_code == 2);
  CHECK_THAT(bare.err, Contains("needs --spec SPEC"));
}

TEST_CASE("the thrust curve for ArduPilot comes from throttles in percent and in pulses alike") {
  const TemporaryFolder folder;
  const auto table = [&](const std::string& header, const std::function<double(int)>& throttle) {
    const std::string file = (folder.path() / "bench.csv").string();
    std::string text = header + ",thrust_g,power_W\n";
    for (int i = 0; i <= 16; ++i) {  // MOT_SPIN_MIN to MOT_SPIN_MAX, with a bend of 0.4
      const double a = i / 16.0;
      const double grams = 50 + 900 * (0.6 * a + 0.4 * a * a);
      text += std::to_string(throttle(15 + 5 * i)) + "," + std::to_string(grams) + "," +
              std::to_string(grams / 8) + "\n";
    }
    write_file(file, text);
    return file;
  };
  const auto percent = [](int output) { return double(output); };
  const auto printed = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "motor");
    arguments.insert(arguments.end(), {"--parameters", "ardupilot"});
    return run_tethercalc(arguments);
  };
  const Ran by_percent = printed({table("throttle_percent", percent)});
  CHECK(by_percent.exit_code == 0);
  CHECK_THAT(by_percent.out, Contains("\nMOT_THST_EXPO,0.400\n") && !Contains("MOT_PWM_MIN"));
  const auto pulse = [](int output) { return 1100 + 8.0 * output; };
  const Ran by_pulse = printed(
      {table("ESC signal (\u00B5s)", pulse), "--pwm-min-us", "1100", "--pwm-max-us", "1900"});
  CHECK_THAT(by_pulse.out, Contains("\nMOT_THST_EXPO,0.400\n") && Contains("MOT_PWM_MIN,1100\n"));
  const Ran beyond = printed({table("throttle_percent", percent), "--spin-min", "0.5", "--spin-max",
                              "0.5", "--pwm-max-us", "3000"});
  CHECK(beyond.exit_code == 2);
  CHECK_THAT(beyond.err,
             Contains("--spin-min: 0.5 is out of range; allowed is 0 to 0.3\n") &&
                 Contains("--spin-max: 0.5 is out of range; allowed is 0.9 to 1\n") &&
                 Contains("--pwm-max-us: 3000 is out of range; allowed is 0 to 2000 µs\n"));

  const std::string unsaid = table("throttle", percent);
  CHECK_THAT(printed({unsaid}).err, Contains("does not say what its throttle is counted in"));
  CHECK_THAT(printed({unsaid, "--columns", "throttle_percent=throttle"}).out,
             Contains("MOT_THST_EXPO,0.400"));
  write_file(unsaid, "thrust_g,power_W\n100,10\n200,26\n");
  const Ran without = printed({unsaid});
  CHECK(without.exit_code == 2);
  CHECK(without.out.empty());
  CHECK_THAT(without.err, Contains("has no column of the throttle"));
}

TEST_CASE("the thrust curve of a real bench run is that of another least squares") {
  const auto path = reference_file("data/bench/strawson_all.csv");
  if (!path) return;
  // By normal equations in plain Python over the eight rows between the spin limits.
  for (const auto& [run, expo] : {std::pair{"f4_11", "0.303"}, std::pair{"g4_11", "0.471"}}) {
    const Ran ran = run_tethercalc({"motor", path->string(), "--where", std::string("test=") + run,
                                    "--parameters", "ardupilot"});
    CHECK(ran.exit_code == 0);
    CHECK_THAT(ran.out, Contains(std::string("\nMOT_THST_EXPO,") + expo + "\n"));
  }
}
