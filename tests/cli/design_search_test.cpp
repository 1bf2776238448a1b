#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/published.hpp"
#include "support/run_program.hpp"

using namespace tethercalc::test;
using Catch::Contains;
using nlohmann::json;

namespace {

Ran design(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"design", published});
  return run_tethercalc(arguments);
}

}  // namespace

TEST_CASE("a design study keeps its demands, and its spec flies as told") {
  const Ran run =
      design({"--free", "supply.voltage_V=40..400", "--free", "drone.motor=all", "--free",
              "tether.conductor=copper,aluminium", "--subject-to", "supply.voltage_V<=60",
              "--subject-to", "tether_mass_g<=600", "--format", "json"});
  CHECK(run.exit_code == 0);
  const json answer = json::parse(run.out);
  CHECK(answer["status"] == "optimal");
  CHECK(answer["free"]["supply.voltage_V"].get<double>() <= 60);
  CHECK(answer["forward"]["tether_mass_g"].get<double>() <= 600);
  CHECK(answer["voltage_class"]["name"] == "touchable_elv");
  CHECK(answer["confidence"]["agreeing"].get<int>() >= 2);
  bool voltage_binds = false;
  for (const json& price : answer["prices"]) {
    if (price["name"] == "supply.voltage_V<=60") voltage_binds = price["active"];
  }
  CHECK(voltage_binds);

  const TemporaryFolder folder;
  const std::string spec = (folder.path() / "ready.json").string();
  write_file(spec, answer["spec"].dump());
  const json flown = json::parse(run_tethercalc({"evaluate", spec, "--format", "json"}).out);
  CHECK(flown["table"][0]["forward"]["total_power_W"].get<double>() ==
        Approx(answer["value"].get<double>()).epsilon(1e-9));
}

TEST_CASE("an estimated drag is that of the mass, whoever changes the mass") {
  const TemporaryFolder folder;
  const std::string spec = (folder.path() / "undragged.json").string();
  json document = json::parse(file_text(published));
  document.at("drone").erase("drag");
  document.erase("$schema");
  write_file(spec, document.dump());
  const json set = json::parse(
      run_tethercalc({"optimize", spec, "--set", "drone.mass_g=1100", "--format", "json"}).out);
  const double least = set.at("optimum").at("forward").at("total_power_W").get<double>();
  const json swept = json::parse(
      run_tethercalc({"sweep", spec, "--vary", "drone.mass_g=1100", "--format", "jsonl"}).out);
  CHECK(swept.at("forward.total_power_W").get<double>() == Approx(least).epsilon(1e-9));
  const json freed = json::parse(
      run_tethercalc({"design", spec, "--free", "drone.mass_g=1100..1300", "--format", "json"})
          .out);
  CHECK(freed.at("value").get<double>() == Approx(least).epsilon(1e-7));
  const std::string ready = (folder.path() / "ready.json").string();
  write_file(ready, freed.at("spec").dump());
  const json flown = json::parse(run_tethercalc({"evaluate", ready, "--format", "json"}).out);
  CHECK(flown["table"][0]["forward"]["total_power_W"].get<double>() ==
        Approx(freed.at("value").get<double>()).epsilon(1e-9));
}

TEST_CASE("where leaning less saves power, no wind is ruled out unseen") {
  const TemporaryFolder folder;
  const std::string spec = (folder.path() / "leaning.json").string();
  write_file(spec, R"({
    "name": "a light drone under a large rotor, with drag from above alone",
    "drone": {"motor_count": 1, "motor": "tmotor-u8ii-85kv-28in", "mass_g": 17.6, "auxiliary_power_W": 15,
      "drag": {"front_area_m2": 0, "top_area_m2": 0.0136, "linear_m_s": 100},
      "translational_lift": {"induced_share": 0.471, "hover_induced_speed_m_s": 2},
      "reserve_battery": {"specific_energy_Wh_kg": 100, "descent_speed_m_s": 0.5, "discharge_C": 1}},
    "tether": {"length_m": 0.21, "conductor": "aluminium", "projection_factor": 0,
      "insulation": {"material": "silicone", "thickness_mm": 0}, "contact_resistance_ohm": 0.1},
    "supply": {"voltage_V": 80, "converter": {"efficiency": 1, "fixed_ratio": 0.0944, "min_input_voltage_V": 16}},
    "flight": {"airspeed_m_s": 0, "air_density_kg_m3": 1.293},
    "requirements": {"thrust_headroom": 1.2, "headroom_at": "forward", "power_at": "forward"}})");
  const std::string winds = "flight.headwind_m_s=-5,0,5";
  const Ran found = run_tethercalc({"design", spec, "--free", winds, "--format", "json"});
  const Ran rows = run_tethercalc({"sweep", spec, "--vary", winds, "--format", "jsonl"});
  REQUIRE(found.exit_code == 0);
  REQUIRE(rows.exit_code == 0);
  double least = std::numeric_limits<double>::infinity();
  std::istringstream lines(rows.out);
  for (std::string line; std::getline(lines, line);) {
    const json power = json::parse(line)["forward.total_power_W"];
    if (power.is_number()) least = std::min(least, power.get<double>());
  }
  CHECK(json::parse(found.out)["value"].get<double>() <= least * (1 + 1e-9));
}

TEST_CASE("a cross-section that the spec holds is told to be held") {
  const std::vector<std::string> free{"--free", "supply.voltage_V=40..100"};
  std::vector<std::string> held = free;
  held.insert(held.end(), {"--set", "tether.cross_section_mm2=1.2"});
  CHECK_THAT(design(held).out,
             Contains("cross-section 1.2000 mm², held as tether.cross_section_mm2 has it"));
  CHECK_THAT(design(free).out, Contains("cross-section") && !Contains("held as"));
}

TEST_CASE("a field that is set and free is told to be free") {
  const std::vector<std::string> free{"--free", "tether.conductor=copper,aluminium"};
  std::vector<std::string> also_set = free;
  also_set.insert(also_set.end(), {"--set", "tether.conductor=aluminium"});
  const Ran run = design(also_set);
  CHECK(run.exit_code == 0);
  CHECK_THAT(run.err, Contains("--set tether.conductor=aluminium is not used: --free gives"));
  CHECK(run.out == design(free).out);
}

TEST_CASE("the price of a metre is what a metre more costs") {
  const json at =
      json::parse(design({"--free", "supply.voltage_V=40..60", "--format", "json"}).out);
  const json longer = json::parse(design({"--free", "supply.voltage_V=40..60", "--set",
                                          "tether.length_m=31", "--format", "json"})
                                      .out);
  double price = 0;
  for (const json& p : at["prices"]) {
    if (p["name"] == "tether.length_m") price = p["change"];
  }
  CHECK(price > 0);
  CHECK(price == Approx(longer["value"].get<double>() - at["value"].get<double>()).epsilon(1e-6));
}

TEST_CASE("standard sizes only, a front, and any seed the same answer") {
  const json awg = json::parse(design({"--standard", "awg", "--format", "json"}).out);
  // The optimum of 1.0886 mm² lies between AWG 17 and AWG 16, of which the thicker one suffices.
  CHECK(awg["free"]["tether.cross_section_mm2"].get<double>() == Approx(1.309).margin(0.001));
  const json one = json::parse(design({"--free", "supply.voltage_V=40..100", "--pareto",
                                       "total_power_W,tether_mass_g", "--format", "json"})
                                   .out);
  const json two = json::parse(
      design({"--free", "supply.voltage_V=40..100", "--seed", "7", "--format", "json"}).out);
  CHECK(one["value"].get<double>() == Approx(two["value"].get<double>()).epsilon(1e-8));
  const json& front = one["pareto"];
  REQUIRE(!front.empty());
  for (std::size_t i = 1; i < front.size(); ++i) {
    CHECK(front[i]["tether_mass_g"] < front[i - 1]["tether_mass_g"]);
    CHECK(front[i]["total_power_W"] > front[i - 1]["total_power_W"]);
  }
}

TEST_CASE("an infeasible study says what is missed and by how much") {
  const Ran run = design({"--free", "supply.voltage_V=30..40", "--format", "json"});
  CHECK(run.exit_code == 1);
  const json answer = json::parse(run.out);
  CHECK(answer["status"] == "infeasible");
  CHECK(answer["missed"][0]["demand"] == "thrust_headroom in hover");
  // Nothing beats the highest voltage of the range there.
  CHECK(answer["free"]["supply.voltage_V"].get<double>() == Approx(40).epsilon(1e-3));
  const double by = answer["missed"][0]["by_percent"];
  const json best = json::parse(
      run_tethercalc({"optimize", published, "--set", "supply.voltage_V=40", "--format", "json"})
          .out);
  CHECK(by == Approx(100 * (1 - best["headroom"]["best"].get<double>() / 2)).margin(0.1));
}

TEST_CASE("demands that cannot be met together are missed by as little as they can be") {
  const std::vector<std::string> study{"--free",       "supply.voltage_V=100..100",
                                       "--subject-to", "tether_mass_g<=300",
                                       "--format",     "json"};
  const Ran run = design(study);
  CHECK(run.exit_code == 1);
  const json answer = json::parse(run.out);
  double least = 10;  // the larger of the two violations, over all cross-sections
  std::string areas = "0.05";
  for (double area = 0.05; area < 3; area *= 1.01) areas += "," + std::to_string(area);
  const json points =
      json::parse(run_tethercalc({"evaluate", published, "--set", "supply.voltage_V=100",
                                  "--area-mm2", areas, "--format", "json"})
                      .out);
  for (const json& row : points["table"]) {
    const double headroom = row["hover"]["headroom"];
    const double mass = row["hover"]["tether_mass_g"];
    least = std::min(least, std::max(1 - headroom / 2, mass / 300 - 1));
  }
  CHECK(answer["missed"].size() >= 2);
  CHECK(answer["missed"][0]["by_percent"].get<double>() <= 100 * least + 1e-6);
  CHECK(answer["missed"][0]["by_percent"].get<double>() > 95 * least);
}

TEST_CASE("what the cross-section decides is searched over cross-sections") {
  // The least power at 110 V is drawn by 0.552 mm²; a lighter tether is a thinner one.
  const json light = json::parse(design({"--free", "supply.voltage_V=110..110", "--subject-to",
                                         "tether_mass_g<=385", "--format", "json"})
                                     .out);
  CHECK(light["status"] == "optimal");
  CHECK(light["free"]["tether.cross_section_mm2"].get<double>() < 0.54);
  CHECK(light["hover"]["tether_mass_g"].get<double>() == Approx(385).epsilon(1e-6));
  // The lightest take-off is at the cross-section where the headroom begins to be met.
  const json lightest = json::parse(design({"--free", "supply.voltage_V=110..110", "--minimize",
                                            "takeoff_mass_g", "--format", "json"})
                                        .out);
  const json plain = json::parse(
      run_tethercalc({"optimize", published, "--set", "supply.voltage_V=110", "--format", "json"})
          .out);
  CHECK(lightest["free"]["tether.cross_section_mm2"].get<double>() ==
        Approx(plain["headroom"]["feasible_mm2"][0][0].get<double>()).epsilon(1e-6));
}

TEST_CASE("what binds is told in plain words, and round numbers stay round") {
  const Ran text = design({"--free", "supply.voltage_V=40..400", "--free", "drone.motor=all",
                           "--subject-to", "supply.voltage_V<=120"});
  CHECK(text.exit_code == 0);
  CHECK_THAT(text.out, Contains("supply.voltage_V<=120 binds: 1.20 V more would save 0."));
  CHECK_THAT(text.out, Contains("One more metre of tether would cost 1."));
  CHECK_THAT(text.out, Contains("\"voltage_V\": 120.0,"));
  const Ran twice =
      design({"--free", "supply.voltage_V=40..100", "--subject-to", "supply.voltage_V<=100"});
  CHECK_THAT(twice.out, Contains("something else binds"));
  // Heat binds, and its price is told.
  const Ran hot = design({"--set", "tether.ambient_temperature_C=35", "--set",
                          "tether.sun_W_m2=1000", "--set", "tether.spooled_length_m=70", "--set",
                          "tether.drum.derating=0.217", "--free", "supply.voltage_V=60..120"});
  CHECK_THAT(hot.out, Contains("The insulation's rated 70.0 °C binds: 1.00 °C more would save"));
}

TEST_CASE("a reserve battery and a converter's mass table are flown and told") {
  const std::vector<std::string> fields{
      "--set",
      "drone.reserve_battery.specific_energy_Wh_kg=150",
      "--set",
      "supply.converter.rated_output_W=800",
      "--set",
      R"(supply.converter.mass_table=[{"rated_output_W":400,"mass_g":90},)"
      R"({"rated_output_W":1200,"mass_g":250}])",
      "--set",
      "requirements.thrust_headroom=1.5"};
  std::vector<std::string> arguments{"optimize", published};
  arguments.insert(arguments.end(), fields.begin(), fields.end());
  const Ran text = run_tethercalc(arguments);
  CHECK(text.exit_code == 0);
  CHECK_THAT(text.out, Contains("The converter for 800.0 W weighs 170 g"));
  CHECK_THAT(text.out, Contains("its discharge rate makes it so large") ||
                           Contains("its discharge\nrate makes it so large"));
  // Hovering takes what landing does, unless a winch pulls.
  CHECK_THAT(text.out, !Contains("pulls as in hover"));
  std::vector<std::string> pulled = arguments;
  pulled.insert(pulled.end(), {"--set", "tether.winch_pull_N=1"});
  const std::string told = run_tethercalc(pulled).out;
  CHECK_THAT(told,
             Contains("as in hover the drone takes") || Contains("as in\nhover the drone takes"));
  arguments.insert(arguments.end(), {"--format", "json"});
  const json answer = json::parse(run_tethercalc(arguments).out);
  const json& cable = answer["cable"];
  const json& hover = answer["optimum"]["hover"];
  CHECK(cable["converter"]["mass_g"].get<double>() == Approx(170));
  const double battery = cable["reserve_battery"]["mass_g"];
  CHECK(hover["takeoff_mass_g"].get<double>() ==
        Approx(1710 + 170 + battery + hover["tether_mass_g"].get<double>()).epsilon(1e-9));
  // 10C of 150 Wh/kg are 1500 W/kg; 30 m at 1.5 m/s take 20 s.
  CHECK(battery ==
        Approx(cable["reserve_battery"]["landing_power_W"].get<double>() / 1.5).epsilon(1e-9));
  CHECK(cable["reserve_battery"]["landing_time_s"] == 20);
}

TEST_CASE("behind a fixed ratio the motors' voltage is told, and what cannot be is refused") {
  const std::vector<std::string> ratio{"optimize", published, "--set",
                                       "supply.converter.fixed_ratio=0.25"};
  auto arguments = ratio;
  arguments.insert(arguments.end(), {"--format", "json"});
  const json answer = json::parse(run_tethercalc(arguments).out);
  CHECK(answer["cable"]["converter"]["hover_output_voltage_V"].get<double>() ==
        Approx(answer["optimum"]["hover"]["received_voltage_V"].get<double>() / 4));
  arguments = ratio;
  arguments.insert(arguments.end(), {"--set", "supply.converter.min_output_voltage_V=19"});
  const Ran low = run_tethercalc(arguments);  // 75 V make 18.75 V without any loss
  CHECK(low.exit_code == 2);
  CHECK_THAT(low.err, Contains("make only 18.75 V, and the motors need 19 V"));
  const Ran massless = run_tethercalc(
      {"optimize", published, "--set", "supply.converter.specific_mass_kg_per_kW=1"});
  CHECK(massless.exit_code == 2);
  CHECK_THAT(massless.err, Contains("give rated_output_W"));
}

TEST_CASE("systems that exist are feasible, and take about the power that their makers state") {
  // docs/design.md tells what is published, and what had to be supposed: eight motors, ETFE walls,
  // an aramid member, heat and sun.
  const auto with = [](const std::string& command, const std::vector<std::string>& fields) {
    std::vector<std::string> arguments{command, published, "--format", "json"};
    for (const std::string& field : fields) arguments.insert(arguments.end(), {"--set", field});
    return json::parse(run_tethercalc(arguments).out);
  };
  const auto large = [&](const std::string& command, std::vector<std::string> fields) {
    for (const char* supposed :
         {"drone.motor_count=8", "drone.motor=iflight-4214-400kv-14in", "tether.conductor=copper",
          "tether.insulation.material=etfe", "tether.insulation.thickness_mm=0.3",
          "tether.strength_member.material=aramid", "tether.strength_member.cross_section_mm2=0.4",
          "tether.ambient_temperature_C=40", "tether.sun_W_m2=1000"}) {
      fields.emplace_back(supposed);
    }
    return with(command, fields);
  };
  // XM2 EON800: 800 V, 80 m, 2979 W at the airborne unit's output.
  const json eon = large("optimize", {"drone.mass_g=16500", "supply.voltage_V=800",
                                      "tether.length_m=80", "requirements.thrust_headroom=1"});
  CHECK(eon["status"] == "optimal");
  CHECK(eon["optimum"]["hover"]["total_power_W"].get<double>() == Approx(2979).epsilon(0.1));
  // Elistair Safe-T 2: below 400 V, 100 m, 2200 W.
  const json safe_t = large("optimize", {"drone.mass_g=11500", "supply.voltage_V=400",
                                         "tether.length_m=100", "requirements.thrust_headroom=1"});
  CHECK(safe_t["status"] == "optimal");
  CHECK(safe_t["optimum"]["hover"]["total_power_W"].get<double>() == Approx(2200).epsilon(0.1));
  // Elistair Orion 2.2 TE: 4 kg at 70 m, 5 kg at 50 m.
  for (const auto& [height, payload] : {std::pair{"70", 4000.0}, std::pair{"50", 5000.0}}) {
    const json orion =
        large("envelope", {"drone.mass_g=9000", "supply.voltage_V=400",
                           std::string("tether.length_m=") + height,
                           "tether.cross_section_mm2=0.326", "requirements.thrust_headroom=1.2"});
    CHECK(orion["greatest"]["payload_g"]["value"].get<double>() > payload);
  }
  // ArduPilot's tether of 2017: 24 V, 12.2 m of AWG 14, a buffer battery.
  const json maker = with(
      "envelope", {"supply.voltage_V=24", "tether.conductor=copper",
                   "tether.cross_section_mm2=2.08", "tether.length_m=12.2",
                   "supply.converter.min_input_voltage_V=12", "requirements.buffer_battery=true"});
  CHECK(maker["greatest"]["height_m"]["value"].get<double>() > 12.2);
}

TEST_CASE("whatever a sweep can vary a design can free") {
  const std::vector<std::string> axes{"tether.conductor=all",
                                      "requirements.headroom_at=hover,forward",
                                      "tether.strength_member.material=none,aramid",
                                      "requirements.buffer_battery=true,false",
                                      "supply.voltage_V=60:75:5",
                                      "drone.motor_count=4:6:2",
                                      "tether.conductor.density_g_cm3=2.7,8.9",
                                      "tether.cross_section_mm2=1.1,1.5",
                                      "supply.converter.efficiency=0.8,0.95"};
  for (const std::string& axis : axes) {
    INFO(axis);
    const Ran swept = run_tethercalc({"sweep", published, "--vary", axis, "--format", "jsonl"});
    REQUIRE(swept.exit_code == 0);
    double least = std::numeric_limits<double>::infinity();
    std::istringstream lines(swept.out);
    for (std::string line; std::getline(lines, line);) {
      const json row = json::parse(line);
      if (row["status"] != "infeasible") {
        least = std::min(least, row["forward.total_power_W"].get<double>());
      }
    }
    const json best = json::parse(design({"--free", axis, "--format", "json"}).out);
    REQUIRE(best["status"] == "optimal");
    CHECK(best["value"].get<double>() == Approx(least).epsilon(1e-9));
    const TemporaryFolder folder;
    const std::string spec = (folder.path() / "ready.json").string();
    write_file(spec, best["spec"].dump());
    const json flown = json::parse(run_tethercalc({"evaluate", spec, "--format", "json"}).out);
    CHECK(flown["table"][0]["forward"]["total_power_W"].get<double>() ==
          Approx(least).epsilon(1e-9));
  }
}

TEST_CASE("a field is freed once, within one range") {
  const Ran twice =
      design({"--free", "supply.voltage_V=40..60", "--free", "supply.voltage_V=100..200"});
  CHECK(twice.exit_code == 2);
  CHECK(twice.out.empty());
  CHECK_THAT(twice.err, Contains("supply.voltage_V is freed twice"));
  const Ran sizes = design({"--free", "tether.cross_section_mm2=1,2", "--standard", "awg"});
  CHECK(sizes.exit_code == 2);
  CHECK_THAT(sizes.err, Contains("tether.cross_section_mm2 is freed twice"));
  const Ran many = design({"--free", "supply.voltage_V=1:1000:0.001"});
  CHECK(many.exit_code == 2);
  CHECK_THAT(many.err, Contains("write lo..hi for a range"));
}

TEST_CASE("a choice that conflicts with the spec is refused, not flown without what it asks for") {
  const Ran run = design({"--free", "tether.insulation.material=all", "--set",
                          "tether.insulation.dielectric_safety_factor=3"});
  CHECK(run.exit_code == 2);
  CHECK_THAT(run.err, Contains("--free: asks for a wall by the voltage"));
  const Ran aside = design({"--free", "flight.horizontal_offset_m=0..20"});
  CHECK(aside.exit_code == 2);
  CHECK_THAT(aside.err, Contains("--free: a straight tether hangs down from the drone"));
  for (const char* roughness :
       {"flight.roughness_length_m=5,8", "flight.roughness_length_m=1..8"}) {
    const Ran rough =
        design({"--free", roughness, "--set", "flight.wind_profile=logarithmic", "--set",
                "flight.wind_reference_height_m=2", "--set", "flight.headwind_m_s=4"});
    CHECK(rough.exit_code == 2);
    CHECK_THAT(rough.err, Contains("m is not less than the 2 m over ground"));
  }
}

TEST_CASE("a mistyped study is refused with everything that is wrong") {
  const Ran run = design({"--free", "supply.volt=20..25", "--free", "drone.motor=x500", "--free",
                          "tether.length_m=60..0", "--minimize", "total_powr_W", "--subject-to",
                          "x<3", "--standard", "bwg"});
  CHECK(run.exit_code == 2);
  CHECK(run.out.empty());
  CHECK_THAT(run.err, Contains("did you mean \"supply.voltage_V\"?"));
  CHECK_THAT(run.err, Contains("no motor \"x500\" in the library"));
  CHECK_THAT(run.err, Contains("60 must be below"));
  CHECK_THAT(run.err, Contains("did you mean \"total_power_W\"?"));
  CHECK_THAT(run.err, Contains("expected KEY<=VALUE"));
  CHECK_THAT(run.err, Contains("allowed are awg and iec"));
}

TEST_CASE("where motors are at the end of their curve, an envelope and a sweep say so alike") {
  const Ran envelope = run_tethercalc({"envelope", published, "--set", "supply.voltage_V=400",
                                       "--area-mm2", "1.5", "--format", "json"});
  const json payload = json::parse(envelope.out)["greatest"]["payload_g"];
  CHECK(payload["limited_by"] == "motor_thrust");
  const double too_much = 1710 + 1.001 * payload["value"].get<double>();
  const Ran sweep = run_tethercalc({"sweep", published, "--set", "supply.voltage_V=400", "--vary",
                                    "tether.cross_section_mm2=1.5", "--vary",
                                    fmt::format("drone.mass_g={:.3f}", too_much)});
  CHECK_THAT(sweep.out, Contains("infeasible,motor_thrust,hover"));
}

TEST_CASE("an envelope names what ends it, and needs a cable") {
  CHECK(run_tethercalc({"envelope", published}).exit_code == 2);
  const Ran run = run_tethercalc({"envelope", published, "--area-mm2", "1.5", "--format", "json"});
  CHECK(run.exit_code == 0);
  const json answer = json::parse(run.out);
  const double height = answer["greatest"]["height_m"]["value"];
  CHECK(answer["greatest"]["height_m"]["limited_by"] == "available_power");
  const auto at = [&](double length) {
    const json points = json::parse(
        run_tethercalc({"evaluate", published, "--area-mm2", "1.5", "--set",
                        "tether.length_m=" + std::to_string(length), "--format", "json"})
            .out);
    return points["table"][0]["hover"]["headroom"].get<double>();
  };
  CHECK(at(height) == Approx(2).epsilon(1e-5));
  CHECK(answer["curves"].size() == 3);
}

TEST_CASE("an envelope of a cable that does not fly says why") {
  const std::vector<std::string> heavy{"envelope", published, "--area-mm2",
                                       "1.5",      "--set",   "drone.mass_g=9000"};
  const Ran text = run_tethercalc(heavy);
  CHECK(text.exit_code == 1);
  CHECK_THAT(text.out, Contains("At no payload does this cable meet the demands; at the design's "
                                "own:"));
  auto as_json = heavy;
  as_json.insert(as_json.end(), {"--format", "json"});
  const json answer = json::parse(run_tethercalc(as_json).out);
  CHECK(answer["as_given"]["feasible"] == false);
  CHECK(answer["as_given"]["shortcoming"].get<std::string>().size() > 5);
  CHECK(answer["greatest"]["payload_g"].is_null());
}

TEST_CASE("a bound on the cross-section is kept where there is a design that keeps it") {
  const Ran run = design({"--free", "supply.voltage_V=40..75", "--subject-to",
                          "tether.cross_section_mm2<=1.2", "--format", "json"});
  CHECK(run.exit_code == 0);
  CHECK(json::parse(run.out)["cross_section_mm2"].get<double>() == Approx(1.0886).margin(1e-4));
}

TEST_CASE("what would leave no design is told only where none is left") {
  const std::vector<std::string> sizes{"--standard", "awg", "--set"};
  auto lighter = sizes;
  lighter.emplace_back("drone.mass_g=1850");
  auto heavier = sizes;
  heavier.emplace_back("drone.mass_g=1950");
  CHECK_THAT(design(lighter).out, !Contains("would leave no design"));
  CHECK(design(heavier).exit_code == 0);
}
