// The load of a solved tether, held against the cable solver and against the straight tether.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>

#include "model/cable_family.hpp"
#include "support/random.hpp"
#include "support/random_designs.hpp"
#include "tethercalc/model/operating_point.hpp"
#include "tethercalc/model/tether_load.hpp"

using namespace tethercalc;
using test::each_random;
using test::Random;

namespace {

HangingSituation drawn_situation(Random& random) {
  HangingSituation s;
  s.weight = {random.uniform(0.01, 0.1), random.uniform(10, 300), random.uniform(1e5, 6e5)};
  s.width = {random.uniform(5e-4, 3e-3), 3};
  s.drag_coefficient = random.uniform(0.7, 1.3);
  s.height = random.uniform(5, 150);
  s.offset = random.chance(0.5) ? 0 : s.height * random.magnitude(0.01, 1.5);
  s.air.wind = {-random.uniform(0.5, 15), 0, 0};
  if (random.chance(0.3)) s.air.drone_velocity = {random.uniform(0, 15), 0, 0};
  if (random.chance(0.5)) {
    s.air.profile = random.chance(0.5) ? WindProfile::power_law : WindProfile::logarithmic;
    s.air.reference_height = s.height;
  }
  const double distance = std::hypot(s.height, s.offset);
  if (random.chance(0.3)) {
    s.paid_out.winch_tension = distance * random.uniform(0.3, 1.5);
  } else {
    s.paid_out.length = distance * (1 + random.magnitude(2e-3, 0.2));
  }
  if (random.chance(0.2)) s.axial_stiffness = random.magnitude(1e4, 1e6);
  return s;
}

Cable cable_at(const HangingSituation& s, double radius) {
  return {.weight = s.weight[0] + radius * (s.weight[1] + radius * s.weight[2]),
          .diameter = s.width[0] + s.width[1] * radius,
          .drag_coefficient = s.drag_coefficient,
          .axial_stiffness = s.axial_stiffness};
}

}  // namespace

TEST_CASE("the profile of the wind shapes the wind, not what the drone flies through it") {
  Design design = test::published_design();
  design.tether.model = TetherModel::solved;
  design.tether.slack = 0.03;
  const double area = 1.2e-6;
  const auto pull = [&] { return evaluate(design, area, Condition::forward).tether_tension; };
  const double in_still_air = pull();
  design.flight.wind_profile = WindProfile::logarithmic;
  design.flight.roughness_length = 0.5;
  CHECK(pull() == Approx(in_still_air).epsilon(1e-7));
  design.flight.headwind = 3;
  const double by_profile = pull();
  design.flight.wind_profile = WindProfile::uniform;
  const double in_even_wind = pull();
  // Nearer to the ground there is less of the wind, and all of the airspeed.
  CHECK(by_profile < in_even_wind);
  CHECK(by_profile > in_still_air);
  // With a wind from behind there is less of that.
  design.flight.headwind = -3;
  const double behind_evenly = pull();
  design.flight.wind_profile = WindProfile::logarithmic;
  CHECK(pull() > behind_evenly);
  CHECK(pull() < in_still_air);
}

TEST_CASE("the bare cable of a design weighs what its tether weighs") {
  const Design design = test::published_design();
  const double radius = std::sqrt(1.0886 / 3.14159265358979) / 1000;
  const Cable cable =
      cable_of(hanging_situation(design, flight_state(design, Condition::hover)), radius);
  // 546.9 g for 30 m, 4·k·(r + s) wide.
  CHECK(cable.weight * 30 / design.flight.gravity == Approx(0.5469).epsilon(2e-4));
  CHECK(cable.diameter == Approx(4 * 0.75 * (radius + 0.75e-3)).epsilon(1e-9));
}

TEST_CASE("the load of a solved tether is that of its cable, to 1e-5 of its tension") {
  int hangs = 0;
  int far_off = 0;
  each_random(test::draws(400), [&](Random& random) {
    const HangingSituation s = drawn_situation(random);
    const HangingLoad load(s);
    const double radius = random.magnitude(1e-4, 2e-3);
    const HangingLoad::Parts found = load.at(radius).value;
    CableSolver solver;
    const Vector3 drone{s.offset, 0, s.height};
    if (solver.solve(cable_at(s, radius), s.air, s.paid_out, drone) != CableOutcome::hangs) return;
    if (!(found.down < INFINITY)) return;
    ++hangs;
    const HangingCable exact = solver.result();
    const double error =
        std::max({std::abs(found.along + exact.on_drone.x), std::abs(found.down + exact.on_drone.z),
                  std::abs(found.tension_at_ground - exact.tension_at_station)}) /
        exact.tension_at_drone;
    UNSCOPED_INFO("error " << error << " " << s.offset << " " << s.height);
    if (!(error < 1e-5)) ++far_off;
    CHECK(error < 0.02);
  });
  CAPTURE(hangs, far_off);
  CHECK(hangs > test::draws(350));
  // Where wind and weight balance about a taut cable, its load turns sharply; seen: 2 to 10 of 400.
  CHECK(far_off <= test::draws(20));
}

namespace {

/// Of a cable whose drag over weight decides how it hangs.
HangingSituation drawn_plain_situation(Random& random) {
  HangingSituation s = drawn_situation(random);
  const double distance = std::hypot(s.height, s.offset);
  s.paid_out = {.length = distance * (1 + random.magnitude(1e-4, 0.3)), .winch_tension = {}};
  s.axial_stiffness.reset();
  s.air.drone_velocity = {};
  return s;
}

/// The wind in which weight and drag of a cable along the chord to a drone aside balance across it,
/// so that its slack folds: drag over weight is then cos/sin² of the chord's slope.
double folding_wind(const HangingSituation& s, double radius) {
  const Cable cable = cable_at(s, radius);
  const double balance = s.offset * std::hypot(s.offset, s.height) / (s.height * s.height);
  const double drag_in_unit_wind = drag_across(cable, s.air, 1);
  return std::sqrt(balance * cable.weight / drag_in_unit_wind);
}

/// Of the greatest tension.
double error_of(const HangingLoad::Parts& found, const HangingCable& exact) {
  return std::max({std::abs(found.along + exact.on_drone.x),
                   std::abs(found.down + exact.on_drone.z),
                   std::abs(found.tension_at_drone - exact.tension_at_drone),
                   std::abs(found.tension_at_ground - exact.tension_at_station)}) /
         std::max(exact.tension_at_drone, exact.tension_at_station);
}
double error_of_load(const HangingSituation& s, double radius) {
  const HangingLoad::Parts found = HangingLoad(s).at(radius).value;
  CableSolver solver;
  REQUIRE(solver.solve(cable_at(s, radius), s.air, s.paid_out, {s.offset, 0, s.height}) ==
          CableOutcome::hangs);
  const HangingCable exact = solver.result();
  CHECK(found.length == *s.paid_out.length);
  return error_of(found, exact);
}

}  // namespace

TEST_CASE("where drag over weight decides how a cable hangs, its load is the solver's to 3e-7") {
  each_random(test::draws(150), [](Random& random) {
    const HangingSituation s = drawn_plain_situation(random);
    const double radius = random.magnitude(1e-4, 2e-3);
    const Cable cable = cable_at(s, radius);
    // Next to no wind leaves a fold above the station, which is taken as that in still air.
    const double slack = s.offset == 0 ? *s.paid_out.length / s.height - 1 : 0;
    const bool folds = drag_across(cable, s.air, s.air.wind.x) < 0.02 * slack * cable.weight;
    CHECK(error_of_load(s, radius) < (folds ? 3e-3 : 3e-7));
  });
}

TEST_CASE("with cables of other slacks, places or winds a load is the solver's to 3e-7 as well") {
  each_random(test::draws(45), [](Random& random) {
    HangingSituation s = drawn_plain_situation(random);
    const bool profile = s.air.profile != WindProfile::uniform;
    if (profile && random.chance(0.5)) s.air.even_share = random.uniform(0, 1.5);
    if (profile && random.chance(0.5)) {
      s.air.station_height = random.uniform(0.01, 0.3) * s.height;
      s.air.reference_height = s.height + s.air.station_height;
    }
    const bool has_length =
        s.air.profile == WindProfile::logarithmic || (profile && s.air.station_height > 0);
    const CableNumber place =
        random.chance(0.5) && s.offset > 0 ? CableNumber::aside : CableNumber::slack;
    const CableNumber share = s.air.even_share > 0 ? CableNumber::own_speed : place;
    const CableNumber by_length =
        random.chance(0.5) ? CableNumber::profile_under_one_wind : CableNumber::profile_under_drone;
    const CableNumber number = has_length && random.chance(0.5) ? by_length : share;
    const CableFamilies families(number);
    s.memory = &families;
    const double radius = random.magnitude(1e-4, 2e-3);
    const double slack = s.offset == 0 ? *s.paid_out.length / s.height - 1 : 0;
    const Cable cable = cable_at(s, radius);
    const bool folds = drag_across(cable, s.air, s.air.wind.x) < 0.02 * slack * cable.weight;
    INFO("number " << static_cast<int>(number));
    CHECK(error_of_load(s, radius) < (folds ? 3e-3 : 3e-7));
  });
}

TEST_CASE(
    "with cables of other winches or Reynolds numbers a load is what it is without, to 1e-5 of its "
    "tension") {
  int hangs = 0;
  int far_off = 0;
  int disagree = 0;
  const int count = std::max(10, test::draws(40));
  each_random(count, [&](Random& random) {
    HangingSituation s = drawn_situation(random);
    s.axial_stiffness.reset();
    s.air.drone_velocity = {};
    const double distance = std::hypot(s.height, s.offset);
    s.paid_out = {.length = {}, .winch_tension = distance * random.uniform(0.3, 1.5)};
    const bool by_reynolds = random.chance(0.5);
    if (by_reynolds) {
      s.cylinder = {random.uniform(5e-4, 3e-3), 2};
      s.paid_out = {.length = distance * (1 + random.magnitude(2e-3, 0.2)), .winch_tension = {}};
    }
    const double radius = random.magnitude(1e-4, 2e-3);
    const HangingLoad::Parts alone = HangingLoad(s).at(radius).value;
    const CableFamilies families(by_reynolds ? CableNumber::reynolds : CableNumber::winch_tension);
    s.memory = &families;
    const HangingLoad::Parts shared = HangingLoad(s).at(radius).value;
    if ((alone.down < INFINITY) != (shared.down < INFINITY)) ++disagree;
    if (!(alone.down < INFINITY && shared.down < INFINITY)) return;
    ++hangs;
    const double error =
        std::max({std::abs(alone.along - shared.along), std::abs(alone.down - shared.down),
                  std::abs(alone.tension_at_drone - shared.tension_at_drone)}) /
        alone.tension_at_drone;
    if (!(error < 1e-5)) ++far_off;
    CHECK(error < 1e-3);
    CHECK(shared.length == Approx(alone.length).epsilon(1e-3));
  });
  CAPTURE(hangs, far_off, disagree);
  CHECK(hangs > count / 2);
  // Where a winch hardly holds its cable, load turns sharply, and one of both may not be found.
  CHECK(far_off <= 2);
  CHECK(disagree <= 1);
}

namespace {

bool winch_holds(const HangingSituation& s, double radius) {
  CableSolver solver;
  return solver.solve(cable_at(s, radius), s.air, s.paid_out, {s.offset, 0, s.height}) ==
         CableOutcome::hangs;
}

/// The thickest conductor that the winch holds up, in an even wind; nothing where that is none or
/// all up to 5 mm.
std::optional<double> thickest_held(const HangingSituation& s) {
  double held = 2e-4;
  double not_held = 5e-3;
  if (!winch_holds(s, held) || winch_holds(s, not_held)) return std::nullopt;
  for (int i = 0; i < 50; ++i) {
    const double middle = std::sqrt(held * not_held);
    (winch_holds(s, middle) ? held : not_held) = middle;
  }
  return held;
}

}  // namespace

TEST_CASE("the load on a winch is the solver's up to the thickest conductor that it holds") {
  int ends = 0;
  each_random(test::draws(120), [&](Random& random) {
    HangingSituation s = drawn_situation(random);
    s.axial_stiffness.reset();
    s.air.profile = WindProfile::uniform;
    s.air.drone_velocity = {};
    s.paid_out = {.length = {},
                  .winch_tension = std::hypot(s.height, s.offset) * random.uniform(0.1, 0.8)};
    const auto thickest = thickest_held(s);
    if (!thickest) return;
    ++ends;
    const CableFamilies families(CableNumber::winch_tension);
    const double thinner_by = random.magnitude(1e-5, 0.3);
    const double radius = *thickest * std::exp(-thinner_by);
    CableSolver solver;
    REQUIRE(solver.solve(cable_at(s, radius), s.air, s.paid_out, {s.offset, 0, s.height}) ==
            CableOutcome::hangs);
    const HangingCable exact = solver.result();
    for (const bool remembered : {false, true}) {
      s.memory = remembered ? &families : nullptr;
      const HangingLoad::Parts found = HangingLoad(s).at(radius).value;
      INFO("thinner by " << thinner_by << ", remembered " << remembered);
      // Forces turn with the root of what is left, which a cubic by the length leads on into. Seen
      // of 1,800: 3e-4 next to the end, else 3e-5.
      const double most = thinner_by < 1e-3 ? 1e-3 : 1e-4;
      CHECK(error_of(found, exact) < most);
      CHECK(found.length == Approx(exact.length).epsilon(most));
      CHECK(HangingLoad(s).at(1.001 * *thickest).value.down == INFINITY);
    }
  });
  CHECK(ends > test::draws(120) / 8);
}

TEST_CASE("a winch's cable reaches where no more is paid out than there is") {
  int hangs = 0;
  int wrong = 0;
  const int count = std::max(10, test::draws(60));
  each_random(count, [&](Random& random) {
    HangingSituation s = drawn_situation(random);
    s.axial_stiffness.reset();
    s.paid_out = {.length = {},
                  .winch_tension = std::hypot(s.height, s.offset) * random.uniform(0.3, 1.5)};
    const double radius = random.magnitude(1e-4, 2e-3);
    CableSolver solver;
    const auto [outcome, cable] = solve_hanging(s, solver, radius);
    if (outcome != CableOutcome::hangs) return;
    ++hangs;
    constexpr double little = 1e-3;  // an error of the length between solved cables
    s.cable_there_is = cable.length * (1 + little);
    if (!(HangingLoad(s).at(radius).value.down < INFINITY)) ++wrong;
    s.cable_there_is = cable.length * (1 - little);
    if (HangingLoad(s).at(radius).value.down < INFINITY) ++wrong;
  });
  CAPTURE(hangs, wrong);
  CHECK(hangs > count / 2);
  CHECK(wrong <= std::max(1, hangs / 30));  // where a winch hardly holds its cable
}

/// Of the widest piece about so many octaves of drag over weight that is not halved.
CableMemory::Piece piece_about(const CableMemory& memory, const HangingSituation& normal,
                               double octaves) {
  LoadSeries<4> series{};
  CableMemory::Piece piece = CableMemory::Piece::halved;
  for (double width = memory.widest(); piece == CableMemory::Piece::halved; width /= 2) {
    piece = memory.along_ratio(normal, width * std::floor(octaves / width), width, series);
  }
  return piece;
}

TEST_CASE("cables that differ by one number are remembered by it") {
  HangingSituation s{.weight = {0.05, 50, 3e5}, .width = {1e-3, 3}, .air = {}, .paid_out = {}};
  s.height = 30;
  s.offset = 6;
  s.air.wind = {-6, 0, 0};
  s.air.profile = WindProfile::power_law;
  s.air.reference_height = 30;
  s.air.even_share = 0.4;
  s.paid_out.length = 1.04 * std::hypot(30, 6);
  const HangingSituation normal = *normal_form(s);
  for (const CableNumber n : {CableNumber::slack, CableNumber::aside, CableNumber::own_speed}) {
    const CableFamilies families(n);
    CHECK(piece_about(families, normal, 3) == CableMemory::Piece::smooth);
  }
  const CableFamilies lengths(CableNumber::profile_under_drone);
  CHECK(piece_about(lengths, normal, 3) == CableMemory::Piece::not_known);
  s.air.station_height = 2;
  CHECK(piece_about(lengths, *normal_form(s), 3) == CableMemory::Piece::smooth);
  const CableFamilies winches(CableNumber::winch_tension);
  const CableFamilies speeds(CableNumber::reynolds);
  CHECK(piece_about(winches, normal, 3) == CableMemory::Piece::not_known);
  CHECK_FALSE(winches.at_radius(s, 5e-4).has_value());
  CHECK_FALSE(speeds.at_radius(s, 5e-4).has_value());
  s.cylinder = {1e-3, 2};
  CHECK(speeds.at_radius(s, 5e-4).has_value());
  CHECK_FALSE(winches.at_radius(s, 5e-4).has_value());
  s.paid_out = {.length = {}, .winch_tension = 20};
  CHECK_FALSE(speeds.at_radius(s, 5e-4).has_value());
  CHECK_FALSE(winches.at_radius(s, 5e-4).has_value());
  s.cylinder.reset();
  CHECK(winches.at_radius(s, 5e-4).has_value());
  // In an even wind it is known, too, that a winch does not hold a cable.
  s.air.profile = WindProfile::uniform;
  s.paid_out.winch_tension = 0.1;
  const auto too_weak = winches.at_radius(s, 5e-4);
  REQUIRE(too_weak.has_value());
  CHECK_FALSE(too_weak->hangs);
}

TEST_CASE("a number is told that tells the cables of designs apart, where it is the only one") {
  Design base = test::published_design();
  base.tether.model = TetherModel::solved;
  const auto told = [&](const auto& change) {
    std::vector<Design> designs;
    for (int i = 0; i < 16; ++i) change(designs.emplace_back(base), 1 + 0.1 * i);
    return told_apart_by(designs);
  };
  const auto slack = [](Design& d, double x) { d.tether.slack = 0.01 * x; };
  const auto aside = [](Design& d, double x) { d.flight.horizontal_offset = 3 * x; };
  const auto winch = [](Design& d, double x) { d.tether.winch_pull = 8 * x; };
  const auto wind = [](Design& d, double x) { d.flight.headwind = x; };
  const auto height = [](Design& d, double x) { d.tether.length *= x; };
  const auto profile = [](Design& d) { d.flight.wind_profile = WindProfile::power_law; };
  CHECK(told(slack) == CableNumber::slack);
  CHECK(told(aside) == CableNumber::aside);
  CHECK(told(winch) == CableNumber::winch_tension);
  CHECK(told([&](Design& d, double x) { profile(d), wind(d, x); }) == CableNumber::own_speed);
  CHECK(told([&](Design& d, double x) { slack(d, x), wind(d, x); }) == CableNumber::slack);
  const auto logarithmic = [](Design& d) { d.flight.wind_profile = WindProfile::logarithmic; };
  const auto aloft = [&](Design& d, double x) {
    logarithmic(d), height(d, x);
    d.flight.headwind = 3;
  };
  CHECK(told(aloft) == CableNumber::profile_under_drone);
  CHECK(told([&](Design& d, double x) {
          aloft(d, x);
          d.flight.wind_reference_height = 10;
        }) == CableNumber::profile_under_one_wind);
  CHECK(told([&](Design& d, double x) {
          aloft(d, x), profile(d);
          d.flight.station_height = 4;
        }) == CableNumber::profile_under_drone);
  const auto reynolds = [](Design& d) { d.tether.drag_by_reynolds_number = true; };
  CHECK(told([&](Design& d, double x) { reynolds(d), wind(d, x); }) == CableNumber::reynolds);
  CHECK(told([&](Design& d, double x) { reynolds(d), height(d, x); }) == CableNumber::reynolds);
  CHECK(told([&](Design& d, double x) { reynolds(d), slack(d, x); }) == std::nullopt);
  CHECK(told([&](Design& d, double x) { reynolds(d), winch(d, x); }) == std::nullopt);
  // Drag over weight alone, or nothing.
  CHECK(told(wind) == std::nullopt);
  CHECK(told(height) == std::nullopt);
  CHECK(told([](Design& d, double x) { d.drone.mass *= x; }) == std::nullopt);
  // Two numbers; a profile over another height; winches and slacks; three places in all.
  CHECK(told([&](Design& d, double x) { slack(d, x), aside(d, x); }) == std::nullopt);
  CHECK(told([&](Design& d, double x) {
          d.flight.wind_profile = WindProfile::logarithmic;
          height(d, x), slack(d, x);
        }) == std::nullopt);
  CHECK(told([&](Design& d, double x) { x < 1.5 ? slack(d, x) : winch(d, x); }) == std::nullopt);
  CHECK(told([&](Design& d, double x) { aside(d, x < 1.5 ? 1 : 2); }) == std::nullopt);
  base.tether.model = TetherModel::straight;
  CHECK(told(slack) == std::nullopt);
}

TEST_CASE(
    "the load is the solver's, too, where wind and weight all but balance and the slack folds") {
  each_random(test::draws(60), [](Random& random) {
    HangingSituation s = drawn_plain_situation(random);
    if (s.offset == 0) s.offset = s.height * random.magnitude(0.05, 1);
    s.air.profile = WindProfile::uniform;
    s.paid_out.length = std::hypot(s.height, s.offset) * (1 + random.magnitude(1e-3, 0.2));
    const double radius = random.magnitude(1e-4, 2e-3);
    const double beside = random.magnitude(1e-6, 0.1) * (random.chance(0.5) ? 1 : -1);
    s.air.wind.x = -folding_wind(s, radius) * (1 + beside);
    INFO("beside " << beside);
    CHECK(error_of_load(s, radius) < 3e-7);
  });
}

TEST_CASE("the slope of a solved tether's load is that of its load") {
  each_random(test::draws(100), [](Random& random) {
    const HangingLoad load(drawn_situation(random));
    const double radius = random.magnitude(1e-4, 2e-3);
    const double step = 1e-5 * radius;
    const HangingLoad::AtRadius at = load.at(radius);
    const HangingLoad::Parts below = load.at(radius - step).value;
    const HangingLoad::Parts above = load.at(radius + step).value;
    if (!(above.down < INFINITY)) return;
    const double tension = at.value.tension_at_drone / radius;
    CHECK(at.slope.down ==
          Approx((above.down - below.down) / (2 * step)).epsilon(2e-3).margin(1e-3 * tension));
    CHECK(at.slope.along ==
          Approx((above.along - below.along) / (2 * step)).epsilon(2e-3).margin(1e-3 * tension));
    CHECK(
        at.slope.length ==
        Approx((above.length - below.length) / (2 * step)).margin(1e-3 * at.value.length / radius));
  });
}

TEST_CASE("a thicker conductor of a solved tether pulls more, but where wind and weight balance") {
  int pairs = 0;
  int less = 0;
  int far_less = 0;
  each_random(test::draws(300), [&](Random& random) {
    const HangingLoad load(drawn_situation(random));
    const double radius = random.magnitude(1e-4, 1e-3);
    const HangingLoad::Parts thin = load.at(radius).value;
    const HangingLoad::Parts thick = load.at(1.1 * radius).value;
    if (!(thin.down < INFINITY && thick.down < INFINITY)) return;
    ++pairs;
    const double ratio = std::min(thick.down / thin.down, thick.along / thin.along);
    if (ratio < 1) ++less;
    if (ratio < 1 / 1.1) ++far_less;
  });
  CAPTURE(pairs);
  // Seen in 8000: 14 and 2.
  CHECK(less <= 8);
  CHECK(far_less <= 2);
}

TEST_CASE("a drone below the roughness length flies, and its tether hangs as in still air") {
  Tether tether;
  tether.model = TetherModel::solved;
  tether.conductor.density = 2700;
  tether.length = 30;
  Flight flight;
  flight.wind_profile = WindProfile::logarithmic;
  flight.roughness_length = 1;
  for (const double slack : {0.01, 0.3}) {
    tether.slack = slack;
    for (const double aside : {0.0, 0.2}) {
      flight.horizontal_offset = aside;
      const TetherInFlight windy(tether, 0, {.airspeed = 9, .deployed = 0.5}, flight);
      const TetherInFlight still(tether, 0, {.airspeed = 0, .deployed = 0.5}, flight);
      for (const double radius : {1e-4, 6e-4, 2e-3}) {
        const TetherLoad load = windy.load(radius);
        const TetherLoad expected = still.load(radius);
        CHECK(load.down == Approx(expected.down).epsilon(1e-6));
        CHECK(load.along == Approx(expected.along).epsilon(1e-6).margin(1e-6 * expected.down));
      }
    }
  }
}
