#include <catch2/catch.hpp>

#include <cmath>
#include <set>
#include <string>

#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/library.hpp"
#include "tethercalc/model/units.hpp"
#include "tethercalc/study/motor.hpp"

using namespace tethercalc;

TEST_CASE("every library entry reads cleanly, has its own id and names its source") {
  std::set<std::string> ids;
  for (const MotorEntry& motor : library_motors()) {
    INFO(motor.id);
    CHECK(find_motor(motor.id).name == motor.name);
    CHECK(ids.insert("motor " + motor.id).second);
    CHECK(motor.warnings.empty());
    CHECK_FALSE(motor.source.empty());
    CHECK(motor.voltage_V.has_value());
    REQUIRE(motor.propeller_in.has_value());
    CHECK(motor.curve.max_thrust() < 20000 * unit::gram_force);
    for (const double merit : figures_of_merit(motor)) {
      CHECK(merit > 0.25);
      CHECK(merit < 0.75);
    }
  }
  for (const ConductorEntry& conductor : library_conductors()) {
    INFO(conductor.id);
    CHECK(find_conductor(conductor.id).name == conductor.name);
    CHECK(ids.insert("conductor " + conductor.id).second);
    CHECK_FALSE(conductor.source.empty());
  }
  for (const InsulationEntry& insulation : library_insulation()) {
    INFO(insulation.id);
    CHECK(find_insulation(insulation.id).name == insulation.name);
    CHECK(ids.insert("insulation " + insulation.id).second);
    CHECK_FALSE(insulation.source.empty());
  }
  CHECK(library_motors().size() == 34);
  CHECK(ids.count("conductor aluminium") == 1);
  CHECK(ids.count("conductor copper") == 1);
  for (const char* material : {"pvc", "fep", "ptfe", "etfe", "pe", "pur", "silicone"}) {
    CHECK(ids.count(std::string("insulation ") + material) == 1);
  }
}

TEST_CASE("an AWG wire has the diameter that its number stands for") {
  // ASTM B258 fixes AWG 36 at 0.005 inch; a step of 39 gauges is a factor of 92 in diameter. The
  // table values, 0.644 mm for AWG 22 and 1.29 mm for AWG 16, are those of wire catalogues.
  const auto diameter_mm = [](int gauge) {
    for (const WireSize& size : wire_sizes()) {
      if (size.name == "AWG " + std::to_string(gauge)) return 2e3 * std::sqrt(size.area / M_PI);
    }
    return 0.0;
  };
  CHECK(diameter_mm(36) == Approx(0.127).epsilon(1e-12));
  CHECK(diameter_mm(22) == Approx(0.644).margin(0.0005));
  CHECK(diameter_mm(16) == Approx(1.29).margin(0.005));
}

TEST_CASE("the neighbours of an area enclose it") {
  const std::vector<WireSize> sizes = wire_sizes();
  for (const double area_mm2 : {0.3, 1.0, 1.0886, 1.5, 7.0}) {
    const double area = area_mm2 * unit::square_millimetre;
    for (const WireNeighbours& near : wire_sizes_near(sizes, area)) {
      INFO(near.standard << " " << area_mm2);
      if (near.below) CHECK(near.below->area <= area);
      if (near.above) CHECK(near.above->area >= area);
    }
  }
  const auto near = [&](const std::string& standard, double area) {
    for (const WireNeighbours& found : wire_sizes_near(sizes, area)) {
      if (found.standard == standard) return found;
    }
    return WireNeighbours{};
  };
  REQUIRE(near("AWG", 1.0886e-6).below);
  CHECK(near("AWG", 1.0886e-6).below->name == "AWG 17");
  CHECK(near("AWG", 1.0886e-6).above->name == "AWG 16");
  CHECK(near("IEC 60228", 1.0886e-6).below->name == "1 mm²");
  CHECK(near("IEC 60228", 1.0886e-6).above->name == "1.5 mm²");
  CHECK(near("IEC 60228", 1.5e-6).below->name == "1.5 mm²");
  CHECK(near("IEC 60228", 1.5e-6).above->name == "1.5 mm²");
  CHECK_FALSE(near("IEC 60228", 1e-9).below);
  CHECK_FALSE(near("AWG", 1.0).above);
}

TEST_CASE("an unknown name is refused with the closest one") {
  try {
    (void)find_motor("holybro-air2216-920kv", {}, "--motors");
    FAIL("must throw");
  } catch (const InputError& error) {
    CHECK(error.problems().front().where == "--motors");
    CHECK_THAT(error.what(), Catch::Contains("did you mean \"holybro-air2216-920kv-10in\"?"));
  }
}
