#include "tethercalc/model/catenary.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "support/random.hpp"
#include "support/reference_data.hpp"

using namespace tethercalc;
using test::each_random;
using test::Random;

namespace {

std::optional<double> number_or_nothing(const nlohmann::json& value) {
  return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

}  // namespace

TEST_CASE("exact catenaries come out to the digits that their inputs leave") {
  const auto file = test::reference_json("data/shape/catenary.json");
  if (!file) return;
  for (const auto& c : file->at("cases")) {
    INFO(c["id"]);
    const auto& in = c["input"];
    const auto& expected = c["expect"];
    const double length = in["L_m"];
    const double weight = in["w_N_per_m"];
    const auto stiffness = number_or_nothing(in["EA_N"]);
    const auto shape = catenary(in["x_m"], in["z_m"], length, weight, stiffness);
    REQUIRE(shape);
    const double scale = expected["T_top_N"];
    const double margin = std::max(1e-11, c["check"]["suggested_rel_tol"].get<double>());
    CHECK(shape->horizontal == Approx(expected["H_N"].get<double>()).margin(margin * scale));
    CHECK(shape->vertical_at_start ==
          Approx(expected["V_anchor_N"].get<double>()).margin(margin * scale));
    CHECK(shape->vertical_at_end ==
          Approx(expected["V_drone_N"].get<double>()).margin(margin * scale));
    for (const auto& station : expected["stations"]) {
      const CatenaryPoint p = catenary_point(*shape, station[0], weight, stiffness);
      CHECK(p.x == Approx(station[1].get<double>()).margin(margin * length));
      CHECK(p.z == Approx(station[2].get<double>()).margin(margin * length));
      CHECK(p.tension == Approx(station[3].get<double>()).margin(margin * scale));
    }
  }
}

TEST_CASE("a catenary ends where it should, whatever its stiffness") {
  each_random(300, [](Random& random) {
    const double x = random.chance(0.1) ? 0 : random.uniform(0, 80);
    const double z = random.uniform(-50, 100);
    const double distance = std::hypot(x, z);
    const bool stretches = random.chance(0.5);
    const double stiffness = random.magnitude(1e2, 1e8);
    const double weight = random.magnitude(1e-2, 10);
    const double slack =
        stretches && random.chance(0.5) ? -random.magnitude(1e-6, 0.05) : random.magnitude(1e-6, 3);
    const double length = distance * (1 + slack);
    const auto given = stretches ? std::optional(stiffness) : std::nullopt;
    const auto shape = catenary(x, z, length, weight, given);
    REQUIRE(shape);
    const CatenaryPoint end = catenary_point(*shape, length, weight, given);
    CHECK(end.x == Approx(x).margin(1e-9 * length));
    CHECK(end.z == Approx(z).margin(1e-9 * length));
    CHECK(shape->vertical_at_end - shape->vertical_at_start ==
          Approx(weight * length).epsilon(1e-9));
  });
}

TEST_CASE("the stiffness of a catenary is how its forces change") {
  each_random(100, [](Random& random) {
    const double x = random.uniform(1, 50);
    const double z = random.uniform(1, 50);
    const auto given =
        random.chance(0.5) ? std::optional(random.magnitude(1e3, 1e6)) : std::nullopt;
    const double length = std::hypot(x, z) * (1 + random.uniform(0.02, 1));
    const double step = 1e-5 * length;
    const auto at = [&](double dx, double dz) {
      return *catenary(x + dx, z + dz, length, 0.2, given);
    };
    const CatenaryStiffness k = catenary_stiffness(at(0, 0), length, 0.2, given);
    const auto slope = [step](double more, double less) { return (more - less) / (2 * step); };
    // The error of a central difference is the step's square over that of what the slack leaves.
    CHECK(k.horizontal_by_x ==
          Approx(slope(at(step, 0).horizontal, at(-step, 0).horizontal)).epsilon(1e-4));
    CHECK(k.horizontal_by_z ==
          Approx(slope(at(0, step).horizontal, at(0, -step).horizontal)).epsilon(1e-4));
    CHECK(k.vertical_by_z ==
          Approx(slope(at(0, step).vertical_at_end, at(0, -step).vertical_at_end)).epsilon(1e-4));
  });
}

TEST_CASE("a plumb cable begins at its station") {
  const auto plumb = catenary(0, 30, 30, 0.18);
  REQUIRE(plumb);
  const CatenaryPoint start = catenary_point(*plumb, 0, 0.18);
  CHECK(start.x == 0);
  CHECK(start.z == 0);
}

TEST_CASE("a cable that does not reach has no shape, one that stretches has") {
  CHECK_FALSE(catenary(3, 4, 5, 1));
  CHECK_FALSE(catenary(3, 4, 4.9, 1));
  CHECK_FALSE(catenary(0, 4, 3.9, 1));
  const auto taut = catenary(3, 4, 4.9, 1e-6, 1e4);
  REQUIRE(taut);
  // Without weight, a spring: EA·(5/4.9 − 1), along the chord.
  CHECK(taut->horizontal == Approx(0.6 * 1e4 * (5 / 4.9 - 1)).epsilon(1e-4));
}
