// `explain`, and the codes that answers print for it.
#include <catch2/catch.hpp>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "cli/published.hpp"
#include "support/run_program.hpp"

using namespace tethercalc::test;
using Catch::Contains;
using nlohmann::json;

namespace {

/// All codes that `explain` knows.
std::set<std::string> known_codes() {
  const Ran run = run_tethercalc({"explain", "--format", "json"});
  REQUIRE(run.exit_code == 0);
  std::set<std::string> codes;
  for (const json& page : json::parse(run.out)) codes.insert(page["code"]);
  return codes;
}

}  // namespace

TEST_CASE("explain of a code says what, why, what to do, by which formula and source") {
  for (const char* code : {"available_power", "propwash", "contact_resistance", "drag_estimated",
                           "ruled_out", "infeasible", "elv", "too_short"}) {
    const Ran run = run_tethercalc({"explain", code});
    INFO(run.out << run.err);
    CHECK(run.exit_code == 0);
    CHECK(run.err.empty());
    CHECK(run.out.starts_with(std::string(code) + ": "));
    CHECK(widest_line(run.out) <= 100);
    for (const char* heading : {"What it means", "Why", "What to do", "Formula", "Source"}) {
      CHECK_THAT(run.out, Contains(std::string("\n") + heading + "\n  "));
    }
  }
}

TEST_CASE("explain alone lists each code once on a line of a terminal") {
  const Ran run = run_tethercalc({"explain"});
  CHECK(run.exit_code == 0);
  for (const std::string& code : known_codes()) CHECK_THAT(run.out, Contains("\n  " + code + " "));
  CHECK(widest_line(run.out) <= 110);
}

TEST_CASE("a code that nobody prints is refused with the closest one and nothing on the output") {
  const Ran run = run_tethercalc({"explain", "avaliable_power"});
  CHECK(run.exit_code == 2);
  CHECK(run.out.empty());
  CHECK_THAT(run.err, Contains("did you mean \"available_power\""));
}

TEST_CASE("a page as JSON and as Markdown holds the same paragraphs") {
  const json page =
      json::parse(run_tethercalc({"explain", "motor_thrust", "--format", "json"}).out);
  const std::string markdown =
      run_tethercalc({"explain", "motor_thrust", "--format", "markdown"}).out;
  CHECK(page["code"] == "motor_thrust");
  CHECK(page["group"] == "limit");
  std::string flat = markdown;
  for (char& c : flat) c = c == '\n' ? ' ' : c;
  for (const json& part : page["parts"]) {
    CHECK_THAT(flat, Contains("**" + part["heading"].get<std::string>()));
    for (const json& text : part["texts"]) CHECK_THAT(flat, Contains(text.get<std::string>()));
  }
}

TEST_CASE("completion offers the codes behind explain") {
  for (const char* shell : {"bash", "zsh", "fish"}) {
    const std::string script = run_tethercalc({"completion", shell}).out;
    CHECK_THAT(script, Contains("propwash") && Contains("drum_cooling_unknown"));
  }
}

TEST_CASE("answers about designs and logs have codes, and explain knows them all") {
  Codes codes;
  const auto ask = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--format", "json"});
    const Ran run = run_tethercalc(arguments);
    INFO(run.err);
    REQUIRE(run.exit_code <= 1);
    codes.merge(printed_codes(run.out));
  };
  const std::string large = project_file("examples/hexacopter-400v.json");
  ask({"optimize", published});
  ask({"optimize", large});
  ask({"optimize", published, "--set", "supply.voltage_V=40"});
  ask({"optimize", published, "--set", "requirements.max_pitch_deg=5"});
  ask({"evaluate", large, "--area-mm2", "0.2", "--set", "tether.spooled_length_m=20"});
  ask({"compare", published});
  ask({"envelope", large, "--area-mm2", "0.3"});
  ask({"validate", large});
  ask({"shape", published, "--area-mm2", "1.1"});
  ask({"shape", published, "--area-mm2", "1.1", "--length", "20"});
  std::vector<std::string> flight{"diagnose", published, "--flight",
                                  project_file("examples/simulated-flight.csv")};
  flight.insert(flight.end(), known.begin(), known.end());
  ask(flight);
  ask({"diagnose", published, "--set", "tether.cross_section_mm2=1.09", "--power",
       project_file("examples/simulated-power.csv")});
  ask({"drag", project_file("examples/simulated-flight.csv"), "--mass-g", "1550"});
  ask({"design", large, "--free", "supply.voltage_V=300..400"});
  ask({"rules", project_file("examples/tethered-25kg.json"), "--rules", "eu-c3"});
  ask({"check", project_file("examples/reference")});
  const std::set<std::string> pages = known_codes();
  CHECK(std::includes(pages.begin(), pages.end(), codes.begin(), codes.end()));
  CHECK(codes.size() > 25);
}

TEST_CASE("each warning has its code in the same place") {
  const json answer =
      json::parse(run_tethercalc({"optimize", project_file("examples/hexacopter-400v.json"),
                                  "--set", "tether.spooled_length_m=20", "--format", "json"})
                      .out);
  REQUIRE(answer["warnings"].size() == answer["warning_codes"].size());
  CHECK(answer["warning_codes"] == json({"drag_estimated", "drum_cooling_unknown"}));
  CHECK_THAT(answer["warnings"][0].get<std::string>(), Contains("the drag is an estimate"));
  CHECK_THAT(answer["warnings"][1].get<std::string>(), Contains("lie on a drum"));
}

TEST_CASE("a warning has one code whichever command tells it") {
  const std::string drone = project_file("examples/hexacopter-400v.json");
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"optimize"},
           {"validate"},
           {"evaluate", "--area-mm2", "0.2"},
           {"envelope", "--area-mm2", "0.2"},
           {"shape", "--area-mm2", "0.2"},
           {"compare", "--motors", "tmotor-mn5008-340kv-18in,tmotor-mn3508-380kv-15in"},
           {"design", "--free", "drone.motor=tmotor-mn5008-340kv-18in,tmotor-mn3508-380kv-15in"}}) {
    INFO(words[0]);
    std::vector<std::string> arguments{words[0],   drone, "--set", "flight.air_density_kg_m3=1",
                                       "--format", "json"};
    arguments.insert(arguments.end(), words.begin() + 1, words.end());
    const Ran run = run_tethercalc(arguments);
    INFO(run.err);
    const json printed = json::parse(run.out);
    const json& answer = printed.is_array() ? printed.at(0) : printed;
    CHECK(answer["warnings"].size() == answer["warning_codes"].size());
    const auto codes = answer["warning_codes"].get<std::set<std::string>>();
    CHECK(codes.count("drag_estimated") == 1);
    CHECK(codes.count("motor_air_density") == 1);
    const bool compares = words[0] == "design" || words[0] == "compare";
    CHECK(codes.count("motor_mass_not_counted") == (compares ? 1 : 0));
  }
}

TEST_CASE("each note on a log has its code in the same place, and the page says why") {
  const std::string flight = project_file("examples/simulated-flight.csv");
  const json drag =
      json::parse(run_tethercalc({"drag", flight, "--mass-g", "1550", "--format", "json"}).out);
  CHECK(drag["notes"].size() == drag["note_codes"].size());
  CHECK(drag["note_codes"] == json({"air_density_assumed", "pitch_offset_assumed"}));

  // Forty seconds of flight are too short, and a roll that is missing is taken for level flight.
  TemporaryFolder folder;
  std::ifstream log(flight);
  std::ofstream cut(folder.path() / "cut.csv");
  std::string line;
  for (int i = 0; i < 700 && std::getline(log, line); ++i) {
    const std::size_t roll = line.find(',');
    cut << line.substr(0, roll) << line.substr(line.find(',', roll + 1)) << '\n';
  }
  cut.close();
  const json diagnosis = json::parse(
      run_tethercalc({"diagnose", published, "--flight", (folder.path() / "cut.csv").string(),
                      "--mass-g", "1550", "--format", "json"})
          .out);
  REQUIRE(diagnosis["notes"].size() == diagnosis["note_codes"].size());
  const auto codes = diagnosis["note_codes"].get<std::set<std::string>>();
  CHECK(codes.count("log_column_missing") == 1);
  CHECK(codes.count("log_too_short") == 1);
}

TEST_CASE("where to read more is said on a terminal's standard error only") {
  const Ran run = run_tethercalc({"optimize", published});
  CHECK(run.err.empty());
  CHECK(run.out.find("tethercalc explain") == std::string::npos);
}
