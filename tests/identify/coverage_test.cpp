// Whether 95 % intervals hold the truth in 95 % of flights, judged by an independent simulator.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "support/random.hpp"
#include "support/simulated_flight.hpp"
#include "tethercalc/identify/drag_fit.hpp"

using namespace tethercalc;

namespace {

constexpr int flights = 300;

test::SimulatedFlight random_flight(std::uint64_t seed) {
  test::Dice dice(seed);
  test::SimulatedFlight f;
  f.mass = dice.between(1.2, 2.5);
  f.front_area = dice.between(0.010, 0.022);
  f.top_area = dice.between(0.010, 0.022);
  f.linear_speed = dice.between(10, 25);
  f.wind = dice.between(-2, 2);
  f.heading = dice.between(0, 6.28);
  f.seed = seed;
  return f;
}

/// Steady drag in N at `airspeed`, from the truth, by bisection of the force balance.
double true_steady_drag(const test::SimulatedFlight& truth, double airspeed) {
  double low = 0;
  double high = 1;
  const double weight = truth.mass * 9.80665;
  for (int i = 0; i < 60; ++i) {
    const double tilt = 0.5 * (low + high);
    const double drag = 0.5 * truth.air_density * airspeed * (airspeed + truth.linear_speed) *
                        (truth.front_area * std::cos(tilt) + truth.top_area * std::sin(tilt));
    (drag > weight * std::tan(tilt) ? low : high) = tilt;
  }
  return weight * std::tan(low);
}

/// Three standard deviations of a rate observed in so many flights.
double chance(double rate) { return 3 * std::sqrt(rate * (1 - rate) / flights); }

}  // namespace

TEST_CASE(
    "honest intervals cover the truth in 90 to 99 % of flights, independent ones fall short") {
  const std::uint64_t seed = test::run_seed();
  CAPTURE(seed);
  constexpr std::size_t quantities = 5;  // A_f, A_t, j, w and the drag at 8 m/s
  std::array<double, quantities> honest{};
  std::array<double, quantities> independent{};
  double autocorrelation = 0;
  for (int i = 0; i < test::draws(flights); ++i) {
    const auto truth = random_flight(seed + static_cast<std::uint64_t>(i));
    const FlightLog log = test::simulate(truth);
    const Observations flight = observe(log, moving_part(log), 0);
    const DragFit fit = fit_drag({&flight, 1}, {truth.mass, truth.air_density, standard_gravity});
    REQUIRE(fit.converged);
    autocorrelation += fit.quality.residual_lag1_autocorrelation / flights;

    const std::array<double, quantities> expected{truth.front_area, truth.top_area,
                                                  truth.linear_speed, truth.wind,
                                                  true_steady_drag(truth, 8)};
    for (std::size_t q = 0; q < quantities; ++q) {
      const Estimate e = q < 4 ? fit.parameters[q].estimate : steady_drag(fit, 8)->force;
      const double error = std::abs(e.value - expected[q]);
      honest[q] += (e.lower <= expected[q] && expected[q] <= e.upper) / double{flights};
      independent[q] += (error <= 1.96 * e.standard_error_independent) / double{flights};
    }
  }

  if (test::leave_rates_out()) return;
  CHECK(autocorrelation == Approx(0.86).margin(0.03));  // as in the published flight
  double pooled = 0;
  for (std::size_t q = 0; q < quantities; ++q) {
    CAPTURE(q);
    CHECK(honest[q] >= 0.90 - chance(0.90));
    CHECK(honest[q] <= 0.99 + chance(0.99));
    CHECK(independent[q] < 0.75);
    pooled += honest[q] / quantities;
  }
  CHECK(pooled >= 0.90);
  CHECK(pooled <= 0.99);
}

TEST_CASE("jerky flying that 10 Hz cannot differentiate is covered by the intervals") {
  // Tilt that jumps between samples biases A_f and A_t by several independent standard errors.
  const std::uint64_t seed = test::run_seed();
  CAPTURE(seed);
  constexpr int count = 60;
  std::array<int, 2> covered{};
  double bias = 0;
  for (int i = 0; i < count; ++i) {
    auto truth = random_flight(seed + static_cast<std::uint64_t>(i));
    truth.attitude_lag = 0.2;
    truth.slew_rate_deg_s = 1e4;
    truth.disturbance = 0.02;
    const FlightLog log = test::simulate(truth);
    const Observations flight = observe(log, moving_part(log), 0);
    const DragFit fit = fit_drag({&flight, 1}, {truth.mass, truth.air_density, standard_gravity});
    const std::array<double, 2> expected{truth.front_area, truth.top_area};
    for (std::size_t q = 0; q < 2; ++q) {
      const Estimate& e = fit.parameters[q].estimate;
      covered[q] += e.lower <= expected[q] && expected[q] <= e.upper;
    }
    const Estimate& top = fit.top_area().estimate;
    bias += (top.value - truth.top_area) / top.standard_error_independent / count;
  }
  CHECK(bias > 3);  // or this would test nothing
  CHECK(covered[0] >= 0.85 * count);
  CHECK(covered[1] >= 0.85 * count);
}
