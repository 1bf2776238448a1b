#include "tethercalc/study/design.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "support/random.hpp"
#include "support/random_designs.hpp"
#include "tethercalc/model/steady_flight.hpp"

using namespace tethercalc;

TEST_CASE("the cross-section of least power is the one on paper") {
  // A motor with P = e·T, a lossless converter, no insulation, drag or auxiliary power, and a load
  // small against what the line delivers are not needed: with m(A) = 2hρ_cA and R = 2hρ/A,
  // P_drone = e·g·(m_d + 2hρ_cA) = a + bA and U·I = P_drone + I²R. At the least U·I = y the
  // envelope theorem gives b = (y/U)²·2hρ/A², so A = (y/U)·q with q = √(2hρ/b); and from y = a + bA
  // + (y/U)²·2hρ/A, with 2hρ = b·q², y = a + b·q·y/U + b·q·y/U, hence y = a/(1 − 2bq/U) and A =
  // q·y/U.
  for (const double voltage : {60.0, 120.0, 400.0}) {
    Design design;
    const double slope = 12.0;  // W/N
    design.drone.mass = 1.5;
    design.drone.motor = MotorCurve({{10, 10 * slope}, {100, 100 * slope}});
    design.tether.length = 50;
    design.tether.conductor = {0.0178e-6, 0, 8900, 0};
    design.supply.voltage = voltage;
    design.supply.converter.efficiency = {{0, 1.0}};
    const double a = slope * standard_gravity * 1.5;
    const double b = slope * standard_gravity * 2 * 50 * 8900;
    const double q = std::sqrt(2 * 50 * 0.0178e-6 / b);
    const double power = a / (1 - 2 * b * q / voltage);
    const double area = q * power / voltage;
    DesignProblem problem;
    problem.base = design;
    problem.base.requirements.buffer_battery = true;
    problem.free.push_back(
        {"area", Uniform{0.05e-6, 20e-6}, [](Design& d, double x) { d.tether.cross_section = x; }});
    problem.objective = PointQuantity{.condition = Condition::hover};
    const DesignAnswer answer = search_design(problem);
    REQUIRE(answer.feasible);
    CHECK(answer.best.hover.total_power == Approx(power).epsilon(1e-8));
    // The power is flat there: its minimum to 1e-15 fixes the place to the root of that.
    CHECK(answer.best.area == Approx(area).epsilon(1e-6));
    // The exact search finds the place as well.
    problem.free.clear();
    CHECK(search_design(problem).best.area == Approx(area).epsilon(1e-8));
  }
}

TEST_CASE("a design search is never worse than brute force over its fields") {
  for (unsigned i = 0; i < 30; ++i) {
    test::Random random(test::run_seed() + i);
    INFO("TETHERCALC_TEST_SEED=" << test::run_seed() << ", case " << i);
    DesignProblem problem;
    problem.base = test::random_design(random);
    problem.base.supply.converter.min_input_voltage = 0;
    problem.free = {
        {"voltage", Uniform{20, 400}, [](Design& d, double x) { d.supply.voltage = x; }},
        {"area", Uniform{0.1e-6, 10e-6}, [](Design& d, double x) { d.tether.cross_section = x; }}};
    problem.objective = PointQuantity{.condition = Condition::forward};
    const double most = random.uniform(30, 400);
    problem.limits.push_back(
        {"voltage", [](const Design& d) { return d.supply.voltage; }, most, 1});
    const DesignAnswer answer = search_design(problem);
    for (const DemandState& state : demand_states(answer.best, problem.limits)) {
      if (answer.feasible) CHECK(state.violation <= constraint_tolerance);
    }
    double best = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 1000; ++k) {
      Design design = problem.base;
      design.supply.voltage = 20 + 380 * k / 999.0;
      if (design.supply.voltage > most) break;
      const SteadyFlight hover(design, Condition::hover), forward(design, Condition::forward);
      for (int l = 0; l < 1000; ++l) {
        const double area = 0.1e-6 * std::pow(100, l / 999.0);
        const OperatingPoint f = evaluate(forward, area);
        if (!(f.total_power < best) || !(f.headroom >= 1)) continue;
        const OperatingPoint h = evaluate(hover, area);
        const Requirements& need = design.requirements;
        const OperatingPoint& judged = need.headroom_at == Condition::hover ? h : f;
        const bool met = (h.headroom >= 1) && (f.headroom >= 1) &&
                         (need.buffer_battery || judged.headroom >= need.thrust_headroom);
        if (met && f.total_power < best) best = f.total_power;
      }
    }
    if (best < std::numeric_limits<double>::infinity()) {
      CHECK(answer.feasible);
      CHECK(answer.best.forward.total_power <= best * (1 + 1e-9));
    }
  }
}
