// `shape`: how the cable of a design hangs, and bare cables from a file.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/published.hpp"
#include "support/random.hpp"
#include "support/reference_data.hpp"
#include "support/run_program.hpp"

using namespace tethercalc::test;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

Ran shaped(std::vector<std::string> options) {
  options.insert(options.begin(), {"shape", published, "--area-mm2", "1.0886"});
  return run_tethercalc(options);
}

Json shape_of(std::vector<std::string> options) {
  options.insert(options.end(), {"--format", "json"});
  return Json::parse(shaped(options).out);
}

}  // namespace

TEST_CASE("without wind the cable pulls down with its weight and what it is taut by") {
  // Straight above, 1 % slack: 0.15 m of the spare 0.3 m hang below the station.
  const Json above = shape_of({"--wind", "0", "--slack", "1", "--station-height", "1"});
  const double weight = above["cable"]["w_N_per_m"];
  CHECK(above["outcome"] == "hangs");
  CHECK(above["F_on_drone_N"][2].get<double>() == Approx(-30.15 * weight));
  CHECK(above["F_on_drone_N"][0] == 0);
  CHECK(above["z_low_m"].get<double>() == Approx(-0.15));
  CHECK(above["hangs_free"] == true);
  // The published tether of 30 m has 546.9 g.
  CHECK(30 * weight == Approx(0.5469 * 9.80665).epsilon(2e-4));
}

TEST_CASE("the wind's direction counts clockwise from where the drone stands aside") {
  const auto pull = [](const char* from) {
    return shape_of({"--offset", "10", "--wind", "8", "--wind-from", from})["wind_m_s"];
  };
  CHECK(pull("0")[0] == -8);
  CHECK(pull("180")[0] == 8);
  CHECK(pull("90")[1].get<double>() == Approx(8));
  CHECK(pull("270")[1].get<double>() == Approx(-8));
}

TEST_CASE("the straight tether beside the solved one is that of evaluate") {
  const Json shape = shape_of({"--wind", "8.33333333"});
  const Json evaluated = Json::parse(
      run_tethercalc({"evaluate", published, "--area-mm2", "1.0886", "--format", "json"}).out);
  const Json& forward = evaluated["table"][0]["forward"];
  CHECK(shape["straight"]["total_power_W"].get<double>() ==
        Approx(forward["total_power_W"].get<double>()).epsilon(1e-9));
  CHECK(shape["straight"]["pitch_deg"].get<double>() ==
        Approx(forward["pitch_deg"].get<double>()).epsilon(1e-9));
  CHECK(shape["solved"]["total_power_W"].get<double>() !=
        Approx(forward["total_power_W"].get<double>()).epsilon(1e-3));
}

TEST_CASE("every format of a shape says the same") {
  const std::vector<std::string> options{"--offset", "10", "--slack", "3"};
  const Json in_json = shape_of(options);
  const Ran text = shaped(options);
  CHECK(text.exit_code == 0);
  const auto tension = in_json["T_drone_N"].get<double>();
  CHECK_THAT(text.out, Catch::Contains(fmt::format("{:.2f} N at the drone", tension)));
  auto with_csv = options;
  with_csv.insert(with_csv.end(), {"--format", "csv"});
  const std::string csv = shaped(with_csv).out;
  CHECK(csv.starts_with("s_m,x_m,y_m,z_m,tension_N\n"));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 402);
}

TEST_CASE("what cannot hang is an answer with exit code 1") {
  const Ran short_cable = shaped({"--length", "29"});
  CHECK(short_cable.exit_code == 1);
  CHECK_THAT(short_cable.out, Catch::Contains("too short"));
  const Ran weak = shaped({"--winch-tension", "0.01", "--offset", "30"});
  CHECK(weak.exit_code == 1);
  CHECK_THAT(weak.out, Catch::Contains("cannot hold the cable up"));
  const Ran lying = shaped({"--slack", "40", "--offset", "20", "--wind", "0"});
  CHECK(lying.exit_code == 1);
  CHECK_THAT(lying.out, Catch::Contains("touches the ground"));
  CHECK(shaped({"--slack", "40", "--offset", "20", "--wind", "0", "--station-height", "30"})
            .exit_code == 0);
}

TEST_CASE("what lies on the ground is told where its power is, too") {
  const std::vector<std::string> loose{"--set", "tether.model=solved",
                                       "--set", "tether.slack_percent=100",
                                       "--set", "flight.horizontal_offset_m=20"};
  const auto with = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), loose.begin(), loose.end());
    return run_tethercalc(arguments);
  };
  const Ran evaluated = with({"evaluate", published, "--area-mm2", "1.8", "--format", "json"});
  const auto codes = nlohmann::json::parse(evaluated.out).at("warning_codes");
  CHECK(std::count(codes.begin(), codes.end(), "tether_touches_ground") == 1);
  CHECK_THAT(with({"evaluate", published, "--area-mm2", "1.8"}).out,
             Contains("would hang 17.88 m\nbelow the station"));
  // The same depth as the shape's own.
  const Ran shape = run_tethercalc({"shape", published, "--area-mm2", "1.8", "--offset", "20",
                                    "--wind", "0", "--slack", "100", "--format", "json"});
  CHECK(shape.exit_code == 1);
  const auto told = nlohmann::json::parse(shape.out);
  CHECK(told.at("outcome") == "touches_ground");
  CHECK(told.at("z_low_m").get<double>() == Approx(-17.88).margin(0.005));
}

TEST_CASE("why a tether does not hang is told to programs as to people") {
  const std::vector<std::string> weak{"evaluate",   published,
                                      "--area-mm2", "1.2",
                                      "--set",      "tether.model=solved",
                                      "--set",      "tether.winch_pull_N=0.05",
                                      "--set",      "flight.horizontal_offset_m=20"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), weak.begin(), weak.end());
    return run_tethercalc(more).out;
  };
  const auto told = nlohmann::json::parse(with({"--format", "json"}));
  CHECK(told.at("warning_codes") == nlohmann::json{"tether_does_not_hang"});
  CHECK_THAT(told.at("warnings").at(0).get<std::string>(), Contains("0.0500 N cannot hold"));
  CHECK_THAT(with({}), Contains("cannot hold the tether up") && !Contains("It hangs as weight"));
}

TEST_CASE("bad numbers of a shape are told all at once") {
  const Ran run = shaped({"--height", "0", "--slack", "-1", "--profile", "log", "--offset", "-3"});
  CHECK(run.exit_code == 2);
  CHECK(run.out.empty());
  for (const char* part :
       {"--height", "--slack", "--profile", "did you mean \"logarithmic\"", "--offset"}) {
    CHECK_THAT(run.err, Catch::Contains(part));
  }
  CHECK(shaped({"--slack", "1", "--length", "31"}).exit_code == 2);
  CHECK(shaped({"--profile", "logarithmic", "--roughness", "0"}).exit_code == 2);
  CHECK(run_tethercalc({"shape"}).exit_code == 2);
  const Ran no_profile = shaped({"--roughness", "0.1", "--exponent", "0.2"});
  CHECK(no_profile.exit_code == 2);
  CHECK_THAT(no_profile.err, Catch::Contains("says nothing without --profile logarithmic") &&
                                 Catch::Contains("says nothing without --profile power-law"));
  const Ran no_area = run_tethercalc({"shape", published});
  CHECK(no_area.exit_code == 2);
  CHECK_THAT(no_area.err, Catch::Contains("--area-mm2"));
}

TEST_CASE("a winch that does not pull is refused, not taken for slack") {
  const Ran none = shaped({"--winch-tension", "0"});
  CHECK(none.exit_code == 2);
  CHECK_THAT(none.err, Contains("--winch-tension: has to be more than 0 N, found 0"));
  CHECK_THAT(shaped({"--winch-tension", "-1"}).err, Contains("more than 0 N, found -1"));
}

TEST_CASE("bare cables of a file are answered under their ids, with the keys of exact solutions") {
  for (const char* name : {"data/shape/catenary.json", "data/shape/drag.json"}) {
    const auto file = reference_file(name);
    if (!file) return;
    const Ran run = run_tethercalc({"shape", "--cases", file->string()});
    REQUIRE(run.exit_code == 0);
    const Json answer = Json::parse(run.out);
    const Json expected = *reference_json(name);
    REQUIRE(answer["cases"].size() == expected["cases"].size());
    for (std::size_t i = 0; i < expected["cases"].size(); ++i) {
      const Json& want = expected["cases"][i];
      const Json& got = answer["cases"][i];
      INFO(want["id"]);
      CHECK(got["id"] == want["id"]);
      for (const auto& [key, value] : want["expect"].items()) CHECK(got["result"].contains(key));
    }
  }
}

TEST_CASE("a case that is none is refused with its line and its pointer") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& text) {
    const auto path = folder.path() / "cases.json";
    write_file(path, text);
    const Ran run = run_tethercalc({"shape", "--cases", path.string()});
    CHECK(run.exit_code == 2);
    CHECK(run.out.empty());
    return run.err;
  };
  CHECK_THAT(refused("[]"), Catch::Contains("\"cases\""));
  const std::string bad = refused(
      R"({"cases": [{"id": "a", "input": {"x_m": 1, "z_m": 2, "L_m": -3, "w_N_per_m": 1}},
{"id": "b", "input": {"drone_m": [1, 2], "wind_m_s": [0, 0, 0], "L_m": 3, "w_N_per_m": 1,
 "diameter": 0.1, "Cd": 1, "rho_kg_m3": 1}}]})");
  CHECK_THAT(bad, Catch::Contains("/cases/0/input/L_m") && Catch::Contains("-3"));
  CHECK_THAT(bad, Catch::Contains("diameter_m"));
}

TEST_CASE("a roughness that leaves no wind is refused with both lengths, as evaluate refuses it") {
  const char* const conflict = "5 m is not less than the 3 m over ground";
  CHECK_THAT(
      shaped({"--profile", "logarithmic", "--roughness", "5", "--reference-height", "3"}).err,
      Contains(std::string("--roughness: ") + conflict));
  CHECK_THAT(
      run_tethercalc({"evaluate", published, "--area-mm2", "1", "--set",
                      "flight.wind_profile=logarithmic", "--set", "flight.roughness_length_m=5",
                      "--set", "flight.wind_reference_height_m=3"})
          .err,
      Contains(conflict));
}

TEST_CASE("options that say nothing of bare cables are refused, all at once") {
  const Ran run = run_tethercalc(
      {"shape", "--cases", "none.json", "--wind", "5", "--set", "a=1", "--format", "csv"});
  CHECK(run.exit_code == 2);
  for (const char* option : {"--wind", "--set", "--format"}) {
    CHECK_THAT(run.err, Contains(std::string(option) + ": "));
  }
}

TEST_CASE("a tilt that is not allowed is said to be none") {
  CHECK_THAT(shaped({"--wind", "16"}).out, Contains("(requirements.max_pitch_deg)"));
  CHECK_THAT(shaped({"--wind", "5"}).out, !Contains("max_pitch_deg"));
}

TEST_CASE("cables that a figure leaves out are told, with why") {
  const Ran run = run_tethercalc({"plot", "shape", published, "--area-mm2", "1.5",
                                  "--winch-tension", "0.5", "--wind", "0,8", "--offset", "20"});
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.err, Contains("not drawn at 0 m/s: 0.500 N at the winch cannot hold"));
}

TEST_CASE("a winch that is too weak and a drum with too little cable are named by evaluate") {
  const auto evaluated = [](std::vector<std::string> fields) {
    std::vector<std::string> arguments{"evaluate", published, "--area-mm2",
                                       "1.5",      "--set",   "tether.model=solved"};
    for (const std::string& field : fields) arguments.insert(arguments.end(), {"--set", field});
    return run_tethercalc(arguments).out;
  };
  CHECK_THAT(evaluated({"tether.winch_pull_N=0.5", "flight.horizontal_offset_m=20"}),
             Contains("the winch's 0.500 N cannot hold the tether up to the drone in hover"));
  CHECK_THAT(
      evaluated({"tether.slack_percent=10", "tether.spooled_length_m=1"}),
      Contains("33.00 m of cable are needed up to the drone in hover, and there are 31.00 m"));
}

TEST_CASE("a drone aside in wind is said to stand on the favourable side") {
  for (const char* command : {"evaluate", "optimize", "envelope"}) {
    if (leave_rates_out() && command != std::string("evaluate")) break;
    INFO(command);
    const Ran run =
        run_tethercalc({command, published, "--set", "tether.model=solved", "--set",
                        "tether.cross_section_mm2=1.5", "--set", "flight.horizontal_offset_m=10",
                        "--set", "flight.headwind_m_s=3", "--format", "json"});
    const auto codes = Json::parse(run.out).at("warning_codes");
    CHECK(std::count(codes.begin(), codes.end(), "offset_is_upwind") == 1);
  }
}

TEST_CASE("a slack that counts for nothing is told, and one that counts is not") {
  const auto codes = [](std::vector<std::string> fields) {
    std::vector<std::string> arguments{"evaluate", published, "--format", "json"};
    fields.insert(fields.end(), {"tether.slack_percent=5", "tether.cross_section_mm2=1"});
    for (const std::string& field : fields) arguments.insert(arguments.end(), {"--set", field});
    const auto all = Json::parse(run_tethercalc(arguments).out).at("warning_codes");
    return std::count(all.begin(), all.end(), "slack_unused");
  };
  CHECK(codes({}) == 1);
  CHECK(codes({"tether.model=solved", "tether.winch_pull_N=5"}) == 1);
  CHECK(codes({"tether.model=solved"}) == 0);
  // A shape is solved whatever the spec's model.
  const Ran shape = run_tethercalc({"shape", published, "--area-mm2", "1", "--slack", "5"});
  CHECK_THAT(shape.out, !Contains("counts for nothing"));
}
