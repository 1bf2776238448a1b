#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "support/run_program.hpp"

using namespace tethercalc::test;
using Catch::Contains;
using nlohmann::json;

namespace {

const std::string published = project_file("examples/holybro-x500.json");

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
  CHECK(answer["most_violated"]["demand"] == "thrust_headroom in hover");
  // Nothing beats the highest voltage of the range there.
  CHECK(answer["free"]["supply.voltage_V"].get<double>() == Approx(40).epsilon(1e-3));
  const double by = answer["most_violated"]["by_percent"];
  const json best = json::parse(
      run_tethercalc({"optimize", published, "--set", "supply.voltage_V=40", "--format", "json"})
          .out);
  CHECK(by == Approx(100 * (1 - best["headroom"]["best"].get<double>() / 2)).margin(0.1));
}

TEST_CASE("a mistyped study is refused with everything that is wrong") {
  const Ran run = design({"--free", "supply.volt=20..25", "--minimize", "total_powr_W",
                          "--subject-to", "x<3", "--standard", "bwg"});
  CHECK(run.exit_code == 2);
  CHECK(run.out.empty());
  CHECK_THAT(run.err, Contains("did you mean \"supply.voltage_V\"?"));
  CHECK_THAT(run.err, Contains("did you mean \"total_power_W\"?"));
  CHECK_THAT(run.err, Contains("expected KEY<=VALUE"));
  CHECK_THAT(run.err, Contains("allowed are awg and iec"));
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
