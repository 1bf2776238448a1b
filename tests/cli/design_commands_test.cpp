#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/published.hpp"
#include "support/run_program.hpp"

using namespace tethercalc::test;
using Catch::Contains;
using nlohmann::json;

namespace {

json optimized(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"optimize", "--format", "json"});
  return json::parse(run_tethercalc(arguments).out);
}

}  // namespace

TEST_CASE("the published drone flies the published cable") {
  // Beffert and Zell 2025, section V-B: every digit they print.
  const Ran run = run_tethercalc({"optimize", published, "--format", "json"});
  CHECK(run.exit_code == 0);
  CHECK(run.err.empty());
  const json answer = json::parse(run.out);
  CHECK(answer["status"] == "optimal");
  const json& optimum = answer["optimum"];
  CHECK(std::round(optimum["cross_section_mm2"].get<double>() * 1e4) == 10886);
  CHECK(std::round(optimum["hover"]["tether_mass_g"].get<double>() * 10) == 5469);
  CHECK(std::round(optimum["hover"]["takeoff_mass_g"].get<double>() / 10) == 226);
  CHECK(std::round(optimum["hover"]["total_power_W"].get<double>() * 10) == 4054);
  CHECK(std::round(optimum["forward"]["total_power_W"].get<double>() * 10) == 4449);
  CHECK(optimum["limited_by"] == "available_power");
  CHECK(answer["headroom"]["required"] == 2.0);
  CHECK(answer["headroom"]["condition"] == "hover");
  CHECK(answer["headroom"]["feasible_mm2"][0][0] == optimum["cross_section_mm2"]);
  CHECK(answer["minimum_power"]["condition"] == "forward");
}

TEST_CASE("an operating point has every key that scripts rely on") {
  const json answer = optimized({published});
  for (const char* key :
       {"cross_section_mm2", "tether_resistance_ohm", "tether_mass_g", "takeoff_mass_g",
        "pitch_deg", "available_power_W", "available_thrust_g", "necessary_thrust_g", "headroom",
        "drone_power_W", "total_power_W", "tether_loss_W", "current_A", "received_voltage_V"}) {
    for (const char* condition : {"hover", "forward"}) {
      CHECK(answer["optimum"][condition].contains(key));
      CHECK(answer["table"][0][condition].contains(key));
    }
  }
}

TEST_CASE("an infeasible design exits with 1 and names what would help") {
  const Ran run = run_tethercalc({"optimize", published, "--set", "supply.voltage_V=40"});
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.out, Contains("cannot fly as required"));
  CHECK_THAT(run.out, Contains("a supply of"));

  const json answer = optimized({published, "--set", "supply.voltage_V=40"});
  CHECK(answer["status"] == "infeasible");
  CHECK(answer["optimum"]["cross_section_mm2"].is_null());
  CHECK(answer["optimum"]["hover"].is_null());
  CHECK(answer["headroom"]["feasible_mm2"].empty());
  CHECK(answer["headroom"]["best"].get<double>() < 2);
  for (const auto& [path, value] : answer["remedies"].items()) {
    INFO(path);
    const Ran remedied = run_tethercalc({"optimize", published, "--set", "supply.voltage_V=40",
                                         "--set", path + "=" + value.dump()});
    CHECK(remedied.exit_code == 0);
  }
}

TEST_CASE("a headroom that falls short is never printed as the one that is asked for") {
  const Ran run = run_tethercalc({"optimize", published, "--set", "supply.voltage_V=53"});
  CHECK(run.exit_code == 1);
  CHECK_THAT(run.out,
             Contains("No cross-section gives a thrust headroom of 2.00 in hover. The most "
                      "is\na headroom of 1.99") ||
                 Contains("The most is a headroom of 1.99"));
}

TEST_CASE("the greatest height and headwind that envelope prints can be flown") {
  const Ran run = run_tethercalc({"envelope", published, "--area-mm2", "1.5"});
  REQUIRE(run.exit_code == 0);
  const auto printed = [&run](const std::string& what) {
    const std::size_t at = run.out.find("Greatest " + what + ": ");
    REQUIRE(at != std::string::npos);
    const std::string rest = run.out.substr(at + what.size() + 11);
    return rest.substr(0, rest.find(' '));
  };
  const auto flies = [](const std::string& field, const std::string& value) {
    const Ran evaluated =
        run_tethercalc({"evaluate", published, "--area-mm2", "1.5", "--set", field + "=" + value});
    return evaluated.out.find("does not meet") == std::string::npos;
  };
  CHECK(flies("tether.length_m", printed("height")));
  CHECK(flies("flight.headwind_m_s", printed("headwind")));
}

TEST_CASE("tables fit 100 columns") {
  const std::vector<std::vector<std::string>> commands{
      {"optimize", published},
      {"optimize", published, "--set", "supply.voltage_V=40"},
      {"evaluate", published, "--area-mm2", "0.05,1.0886,10,200"},
      {"compare", published, "--motors", "all"},
      {"list", "motors"},
      {"list", "conductors"},
      {"list", "insulation"},
      {"list", "sizes"}};
  for (const auto& command : commands) {
    const Ran run = run_tethercalc(command);
    INFO(command[0] << " " << command[1]);
    CHECK(run.err.empty());
    CHECK(widest_line(run.out) <= 100);
    CHECK(run.out.find("nan") == std::string::npos);
    CHECK(run.out.find("inf ") == std::string::npos);
    CHECK(run.out.find('\x1b') == std::string::npos);  // no colours into a file
  }
}

TEST_CASE("evaluate returns the table of both conditions, null where a quantity does not exist") {
  const json answer = json::parse(
      run_tethercalc({"evaluate", published, "--area-mm2", "0.05,1.0886", "--format", "json"}).out);
  REQUIRE(answer["table"].size() == 2);
  CHECK(answer["table"][0]["hover"]["total_power_W"].is_null());
  CHECK(answer["table"][0]["hover"]["tether_mass_g"].is_number());
  CHECK(answer["table"][1]["forward"]["total_power_W"].get<double>() ==
        Approx(444.93).margin(0.01));
  const Ran csv = run_tethercalc({"evaluate", published, "--area-mm2", "0.05", "--format", "csv"});
  CHECK_THAT(csv.out, Catch::StartsWith("condition,cross_section_mm2,"));
  CHECK_THAT(csv.out, Contains(",,"));
}

TEST_CASE("evaluate tells programs of each area whether it will do, and what it lacks") {
  // The published headroom of 2 is met from 1.0886 mm² on.
  const auto told = [](const std::string& format) {
    return run_tethercalc({"evaluate", published, "--area-mm2", "0.8,1.1", "--format", format}).out;
  };
  const json as_given = json::parse(told("json"))["as_given"];
  REQUIRE(as_given.size() == 2);
  CHECK(as_given[0] == json{{"feasible", false}, {"shortcoming", "headroom 1.68 < 2.00"}});
  CHECK(as_given[1] == json{{"feasible", true}, {"shortcoming", nullptr}});
  const std::string csv = told("csv");
  CHECK_THAT(csv, Contains(",feasible,shortcoming\n"));
  CHECK_THAT(csv, Contains(",false,headroom 1.68 < 2.00\n"));
  CHECK_THAT(csv, Catch::EndsWith(",true,\n"));
}

TEST_CASE("evaluate tells the same of a cable as optimize does") {
  const std::vector<std::string> solved{"--set", "tether.model=solved", "--format", "json"};
  const auto told = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), solved.begin(), solved.end());
    return json::parse(run_tethercalc(arguments).out);
  };
  const json best = told({"optimize", published});
  const std::string area = best["optimum"]["cross_section_mm2"].dump();
  const json given = told({"evaluate", published, "--area-mm2", area + ",2"});
  REQUIRE(given["cable"].size() == 2);
  for (const char* condition : {"hover", "forward"}) {
    for (const char* key : {"paid_out_m", "tension_N"}) {
      const auto hanging = [&](const json& cable) {
        return cable["hanging"][condition][key].get<double>();
      };
      CHECK(hanging(given["cable"][0]) == Approx(hanging(best["cable"])).epsilon(1e-4));
      CHECK(hanging(given["cable"][1]) > 0);
    }
  }
  CHECK_THAT(run_tethercalc({"evaluate", published, "--area-mm2", "1.5", "--set",
                             "tether.model=solved", "--set", "tether.slack_percent=20"})
                 .out,
             Contains("36.00 m are paid out in hover"));
}

TEST_CASE("what is told to lie on the drum is what lies there") {
  const auto told = [](const std::string& slack, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"evaluate",   published,
                                       "--area-mm2", "1.5",
                                       "--set",      "tether.model=solved",
                                       "--set",      "tether.ambient_temperature_C=25",
                                       "--set",      "tether.spooled_length_m=30",
                                       "--set",      "tether.slack_percent=" + slack};
    for (const std::string& one : more) arguments.insert(arguments.end(), {"--set", one});
    return run_tethercalc(arguments).out;
  };
  CHECK_THAT(told("50", {}), Contains("15.0 m lie on a drum"));
  CHECK_THAT(told("100", {}), !Contains("lie on a drum"));
  const std::vector<std::string> measured{"tether.drum.core_diameter_mm=100",
                                          "tether.drum.width_mm=60",
                                          "tether.heating.rise_K_m_per_W=5"};
  CHECK_THAT(told("50", measured), Contains("package counts for nothing"));
  CHECK_THAT(told("100", measured), !Contains("counts for nothing"));
}

TEST_CASE("evaluate takes the cable of the spec where no area is given") {
  const Ran without = run_tethercalc({"evaluate", published});
  CHECK(without.exit_code == 2);
  CHECK_THAT(without.err, Contains("--area-mm2") && Contains("tether.cross_section_mm2"));
  const Ran with = run_tethercalc({"evaluate", published, "--set", "tether.cross_section_mm2=1.5"});
  CHECK(with.exit_code == 0);
  CHECK_THAT(with.out, Contains("1.500"));
}

TEST_CASE("compare ranks feasible motors by power and tells why the others are not") {
  const json answer = json::parse(
      run_tethercalc({"compare", published, "--motors", "all", "--format", "json"}).out);
  REQUIRE(answer["motors"].size() == 34);
  double power = 0;
  bool seen_infeasible = false;
  for (const json& motor : answer["motors"]) {
    if (motor["status"] == "infeasible") {
      seen_infeasible = true;
      CHECK(motor["reason"].is_string());
      continue;
    }
    CHECK_FALSE(seen_infeasible);
    const double next = motor["optimum"]["forward"]["total_power_W"];
    CHECK(next >= power);
    power = next;
  }
  CHECK(seen_infeasible);
}

TEST_CASE("a spec on standard input gives the same answer as the file") {
  const Ran file = run_tethercalc({"optimize", published, "--format", "csv"});
  const Ran piped = run_tethercalc({"optimize", "-", "--format", "csv"}, file_text(published));
  CHECK(piped.exit_code == 0);
  CHECK(piped.out == file.out);
}

TEST_CASE("a --set equals editing the file, and the order of keys does not matter") {
  nlohmann::ordered_json edited = nlohmann::ordered_json::parse(file_text(published));
  edited["supply"]["voltage_V"] = 60;
  edited["drone"]["motor"] = "tmotor-mn2806-650kv-13in";
  const Ran set =
      run_tethercalc({"optimize", published, "--format", "json", "--set", "supply.voltage_V=60",
                      "--set", "drone.motor=tmotor-mn2806-650kv-13in"});
  const Ran by_hand = run_tethercalc({"optimize", "-", "--format", "json"}, edited.dump());
  CHECK(set.out == by_hand.out);
  // nlohmann::json sorts keys by the alphabet.
  const Ran reordered =
      run_tethercalc({"optimize", "-", "--format", "json"}, json::parse(edited.dump()).dump());
  CHECK(reordered.out == by_hand.out);
}

TEST_CASE("a starting spec is valid and can be optimised") {
  const Ran init = run_tethercalc({"init"});
  CHECK(init.exit_code == 0);
  const Ran valid = run_tethercalc({"validate", "-"}, init.out);
  CHECK(valid.exit_code == 0);
  CHECK_THAT(valid.out, Contains("valid"));
  CHECK(run_tethercalc({"optimize", "-"}, init.out).exit_code == 0);
}

TEST_CASE("the printed schema is the committed one") {
  CHECK(run_tethercalc({"schema"}).out ==
        file_text(project_file("data/schema/design.schema.json")));
}

TEST_CASE("validate names the problems of every file at once") {
  const TemporaryFolder folder;
  write_file(folder.path() / "a.json", "{}");
  write_file(folder.path() / "b.json", "{\"drone\": 3}");
  const Ran run = run_tethercalc(
      {"validate", (folder.path() / "a.json").string(), (folder.path() / "b.json").string()});
  CHECK(run.exit_code == 2);
  CHECK(run.out.empty());
  CHECK_THAT(run.err, Contains("a.json") && Contains("b.json"));
  CHECK(run_tethercalc({"validate", published, "--format", "csv"}).out ==
        "file,valid,code,warning\n" + std::string(published) + ",true,,\n");
}

TEST_CASE("an --output that is a link makes or replaces what it points to, and stays a link") {
  const TemporaryFolder folder;
  const auto link = folder.path() / "link.json";
  const auto target = folder.path() / "target.json";
  std::filesystem::create_symlink("target.json", link);
  for (int round = 0; round < 2; ++round) {
    CHECK(run_tethercalc({"optimize", published, "--format", "json", "--output", link.string()})
              .exit_code == 0);
    CHECK(std::filesystem::is_symlink(link));
    CHECK(json::accept(file_text(target)));
  }
}

TEST_CASE("a folder that cannot be read is refused by check, and is no internal error") {
  if (::geteuid() == 0) return;  // nothing is closed to the administrator
  const TemporaryFolder folder;
  std::filesystem::permissions(folder.path(), std::filesystem::perms::none);
  const Ran run = run_tethercalc({"check", folder.path().string()});
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
  CHECK(run.exit_code == 2);
  CHECK_THAT(run.err, Contains("cannot be read"));
}

TEST_CASE("an --output file gets the whole answer or keeps what it held") {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "answer.json").string();
  CHECK(run_tethercalc({"optimize", published, "--format", "json", "--output", file}).exit_code ==
        0);
  CHECK(json::parse(file_text(file))["status"] == "optimal");
  const std::string before = file_text(file);
  const Ran refused = run_tethercalc(
      {"optimize", published, "--set", "drone.mass_g=-1", "--format", "json", "--output", file});
  CHECK(refused.exit_code == 2);
  CHECK(file_text(file) == before);
  const Ran nowhere =
      run_tethercalc({"optimize", published, "--output", (folder.path() / "no" / "x").string()});
  CHECK(nowhere.exit_code == 2);
  CHECK_THAT(nowhere.err, Contains("cannot be written"));
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
}

TEST_CASE("a full disk is an error with a reason") {
  const std::string command =
      shell_quoted(TETHERCALC_COMMAND) + " optimize " + shell_quoted(published);
  const Ran full = run_shell(command + " >/dev/full");
  CHECK(full.exit_code == 2);
  CHECK_THAT(full.err, Contains("No space left on device"));
  CHECK(run_tethercalc({"optimize", published, "--output", "/dev/full"}).exit_code == 2);
}

TEST_CASE("bad usage exits with 2, names the closest known word, and prints nothing else") {
  struct Usage {
    std::vector<std::string> arguments;
    std::string says;
  };
  const std::vector<Usage> usages{
      {{}, "a command is needed (tethercalc --help lists them)"},
      {{"optimise", published}, "did you mean \"optimize\"?"},
      {{"frobnicate"}, "there is no command \"frobnicate\""},
      {{"optimize"}, "SPEC"},
      {{"optimize", published, "--formt", "json"}, "did you mean \"--format\"?"},
      {{"optimize", published, "--format", "jsn"}, "did you mean \"json\"?"},
      {{"optimize", published, "--format"}, "--format"},
      {{"optimize", published, "again.json"}, "one argument too many"},
      {{"optimize", published, "--set", "supply.voltage=60"}, "supply.voltage_V"},
      {{"optimize", published, "--set", "supply.voltage_V"}, "supply.voltage_V"},
      {{"evaluate", published, "--area-mm2", "1,zwei,0"}, "\"zwei\""},
      {{"evaluate", published, "--area-mm2", "1,zwei,-1"}, "\"-1\""},
      {{"evaluate", published, "--area-mm2", "nan"}, "\"nan\""},
      {{"compare", published, "--motors", "holybro-air2216-920kv-11in"},
       "holybro-air2216-920kv-10in"},
      {{"list", "motor"}, "motors"},
      {{"validate"}, "SPEC"},
  };
  for (const Usage& usage : usages) {
    const Ran run = run_tethercalc(usage.arguments);
    INFO(run.err);
    CHECK(run.exit_code == 2);
    CHECK(run.out.empty());
    CHECK_THAT(run.err, Contains(usage.says));
  }
}

TEST_CASE(
    "what an optimum was not checked for is said, with the fields that would have it checked") {
  const std::vector<std::string> strong{"optimize", published, "--set", "supply.voltage_V=400"};
  const std::string plain = run_tethercalc(strong).out;
  CHECK_THAT(plain, Contains("Nothing that was checked limits it") && Contains("Not checked"));
  for (const char* field :
       {"tether.ambient_temperature_C", "requirements.strength_safety_factor",
        "tether.insulation.dielectric_safety_factor", "drone.motor_air_density_kg_m3"}) {
    CHECK_THAT(plain, Contains(field));
  }
  std::vector<std::string> one = strong;
  one.insert(one.end(), {"--set", "tether.ambient_temperature_C=20"});
  CHECK_THAT(run_tethercalc(one).out,
             Contains("Not checked") && !Contains("tether.ambient_temperature_C"));
  for (const char* air : {"flight.air_density_kg_m3=1.225", "flight.air_density_kg_m3=1.1"}) {
    one.back() = air;  // as in the standard's, or with a note that has the figures
    CHECK_THAT(run_tethercalc(one).out, !Contains("the air of the motors' bench"));
  }
  one.back() = "tether.ambient_temperature_C=20";
  std::vector<std::string> all = one;
  all.insert(all.end(), {"--set", "tether.insulation.material=etfe", "--set",
                         "requirements.strength_safety_factor=3", "--set",
                         "tether.insulation.dielectric_safety_factor=2", "--set",
                         "tether.strength_member.material=aramid", "--set",
                         "tether.strength_member.cross_section_mm2=0.5", "--set",
                         "drone.motor_air_density_kg_m3=1.293"});
  const Ran checked = run_tethercalc(all);
  INFO(checked.err);
  REQUIRE(checked.exit_code == 0);
  CHECK_THAT(checked.out, !Contains("Not checked") && !Contains("Nothing that was checked"));
}

TEST_CASE("a cable of any cross-section that the spec takes has an answer in numbers") {
  for (const char* area : {"1e-300", "1e-9", "1e6"}) {
    for (const char* format : {"table", "json", "csv"}) {
      const Ran run =
          run_tethercalc({"evaluate", published, "--area-mm2", area, "--format", format});
      INFO(area << " " << format << run.err << run.out);
      CHECK(run.exit_code == 0);
      CHECK_THAT(run.out, !Contains("nan", Catch::CaseSensitive::No) && !Contains("inf"));
    }
  }
}

TEST_CASE("the strength of a cable is told where it is known") {
  const auto told = [](const std::string& member) {
    return run_tethercalc({"evaluate", published, "--area-mm2", "1", "--set",
                           "tether.ambient_temperature_C=20", "--set",
                           "requirements.strength_safety_factor=3", "--set",
                           "tether.strength_member.cross_section_mm2=0.5", "--set",
                           "tether.strength_member.material=" + member})
        .out;
  };
  CHECK_THAT(told("aramid"), Contains("breaks at 1370 N"));
  CHECK_THAT(told("none"), Contains("breaks at a load that is unknown") && !Contains("0 times"));
}

TEST_CASE("tables speak in words, files in names") {
  const std::vector<std::string> compare{"compare", published};
  CHECK_THAT(run_tethercalc(compare).out,
             Contains("power that arrives") && !Contains("available_power"));
  CHECK_THAT(run_tethercalc({"compare", published, "--format", "csv"}).out,
             Contains("available_power"));
}

TEST_CASE("help and version exit with 0") {
  CHECK_THAT(run_tethercalc({"--help"}).out, Contains("optimize") && Contains("Exit codes"));
  CHECK_THAT(run_tethercalc({"--version"}).out, Catch::StartsWith("tethercalc "));
  CHECK(run_tethercalc({"optimize", "--help"}).exit_code == 0);
}

TEST_CASE("air that the motors' curve was not measured in is told, or the curve is scaled") {
  const auto told = [](std::vector<std::string> changes) {
    std::vector<std::string> arguments{"evaluate", published,  "--area-mm2",
                                       "1.0886",   "--format", "json"};
    for (const std::string& change : changes) arguments.insert(arguments.end(), {"--set", change});
    return json::parse(run_tethercalc(arguments).out);
  };
  // The published density is nobody's choice, and the standard atmosphere's is near enough.
  CHECK(told({})["warnings"].empty());
  CHECK(told({"flight.air_density_kg_m3=1.225"})["warnings"].empty());
  CHECK(told({"flight.air_density_kg_m3=1.19"})["warnings"].empty());
  const json high = told({"flight.air_density_kg_m3=1.0"});
  REQUIRE(high["warnings"].size() == 1);
  CHECK_THAT(high["warnings"][0].get<std::string>(),
             Contains("not in air of 1.000 kg/m³") && Contains("11 % more power") &&
                 Contains("18 % less at most") && Contains("drone.motor_air_density_kg_m3"));
  CHECK_THAT(run_tethercalc({"optimize", published, "--set", "flight.air_density_kg_m3=1.0"}).out,
             Contains("Note: the motors' curve counts as it was measured"));
  const TemporaryFolder folder;
  for (std::vector<std::string> line : std::vector<std::vector<std::string>>{
           {"plot", "optimum", published, "--output", (folder.path() / "optimum.svg").string()},
           {"rules", published, "--rules", "eu-c3"}}) {
    CHECK(run_tethercalc(line).err.empty());
    line.insert(line.end(), {"--set", "flight.air_density_kg_m3=1.0"});
    CHECK_THAT(run_tethercalc(line).err,
               Contains(line.front()) && Contains("not in air of 1.000 kg/m³"));
  }

  const json scaled = told({"flight.air_density_kg_m3=1.0", "drone.motor_air_density_kg_m3=1.293"});
  CHECK(scaled["warnings"].empty());
  const auto hover = [](const json& answer, const char* key) {
    return answer["table"][0]["hover"][key].get<double>();
  };
  CHECK(hover(scaled, "drone_power_W") > 1.07 * hover(high, "drone_power_W"));
  CHECK(hover(scaled, "available_thrust_g") < 0.93 * hover(high, "available_thrust_g"));
  CHECK(hover(scaled, "necessary_thrust_g") == hover(high, "necessary_thrust_g"));
}

TEST_CASE("no answer about a drone of unknown drag hides that it was estimated") {
  const TemporaryFolder folder;
  json spec = json::parse(file_text(published));
  spec["drone"].erase("drag");
  const std::string file = (folder.path() / "no-drag.json").string();
  write_file(file, spec.dump());
  for (std::vector<std::string> line : std::vector<std::vector<std::string>>{
           {"optimize", file},
           {"evaluate", file, "--area-mm2", "1.5"},
           {"compare", file, "--motors", "all"},
           {"design", file, "--free", "supply.voltage_V=60..80"},
           {"envelope", file, "--set", "tether.cross_section_mm2=1.5"},
           {"shape", file, "--area-mm2", "1.5", "--slack", "2"}}) {
    CAPTURE(line.front());
    CHECK_THAT(run_tethercalc(line).out, Contains("the drag is an estimate, not measured"));
    line.insert(line.end(), {"--format", "json"});
    const json answer = json::parse(run_tethercalc(line).out);
    const bool ranks = line.front() == "compare";
    CHECK((ranks ? answer.at("motors")[0] : answer).at("drag_uncertainty_factor") == 2);
    line[1] = published;
    const json known = json::parse(run_tethercalc(line).out);
    CHECK((ranks ? known.at("motors")[0] : known).at("drag_uncertainty_factor").is_null());
  }
  const Ran sweep = run_tethercalc({"sweep", file, "--vary", "supply.voltage_V=75"});
  CHECK_THAT(sweep.err, Contains("the drag is an estimate, not measured"));
  CHECK_THAT(sweep.out, Contains(",2,\n"));
}

TEST_CASE("rows of sweep and compare tell estimated motors from measured ones") {
  const TemporaryFolder folder;
  const std::string motor = (folder.path() / "guess.json").string();
  REQUIRE(run_tethercalc({"motor", "--propeller-in", "12", "--figure-of-merit", "0.5",
                          "--max-thrust-g", "1500", "--output", motor})
              .exit_code == 0);
  const double percent = json::parse(file_text(motor)).at("power_uncertainty_percent");
  CHECK(percent > 0);
  const Ran sweep = run_tethercalc({"sweep", published, "--format", "jsonl", "--vary",
                                    "drone.motor=holybro-air2216-920kv-10in," + motor});
  const std::size_t end = sweep.out.find('\n');
  CHECK(json::parse(sweep.out.substr(0, end)).at("power_uncertainty_percent").is_null());
  CHECK(json::parse(sweep.out.substr(end)).at("power_uncertainty_percent") == Approx(percent));
  const json compared =
      json::parse(run_tethercalc({"compare", published, "--format", "json", "--motors",
                                  "holybro-air2216-920kv-10in," + motor})
                      .out);
  for (const json& row : compared.at("motors")) {
    const bool measured = row.at("motor") == "holybro-air2216-920kv-10in";
    CHECK(row.at("power_uncertainty_percent").is_null() == measured);
  }
}

TEST_CASE("fields that count for nothing beside others are told, and those that count are not") {
  const auto told = [](const std::vector<std::string>& fields) {
    std::vector<std::string> asked{"optimize", published, "--format", "json"};
    for (const std::string& field : fields) asked.insert(asked.end(), {"--set", field});
    return json::parse(run_tethercalc(asked).out).at("warnings").dump();
  };
  const std::string reference = "flight.wind_reference_height_m=5";
  CHECK_THAT(told({reference, "flight.station_height_m=3"}),
             Contains(": flight.wind_reference_height_m, flight.station_height_m"));
  CHECK_THAT(told({"tether.axial_stiffness_N=1e5"}),
             Contains("of no effect") && Contains(": tether.axial_stiffness_N"));
  CHECK_THAT(told({reference, "flight.wind_profile=power_law", "tether.axial_stiffness_N=1e5",
                   "tether.model=solved"}),
             !Contains("of no effect"));
}
