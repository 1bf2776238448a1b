// The published fit on the published flight, and what the published errors leave out.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <optional>
#include <random>

#include "support/flight_csv.hpp"
#include "support/random.hpp"
#include "support/reference_data.hpp"
#include "tethercalc/identify/drag_fit.hpp"

using namespace tethercalc;

namespace {

/// The flight of the paper, or nothing where it is not at hand.
std::optional<FlightLog> published_log() {
  const auto path = test::reference_file("data/x500-flight.csv");
  if (!path) return std::nullopt;
  return test::read_flight_csv(*path);
}

Observations published_observations(const FlightLog& log) {
  return observe(log, range_in_percent(log, 25, 90), 1.4955439766569403 * unit::degree,
                 standard_gravity, Kinematics::published);
}

constexpr DragFitConditions published_conditions{1.549, 1.293, standard_gravity};

std::string as_printed(const Estimate& e, const char* format) {
  return fmt::format(fmt::runtime(format), e.value) +
         fmt::format(" ± {:.2f} %", 100 * e.standard_error_independent / std::abs(e.value));
}

void check_as_printed(const DragFit& fit) {
  // Beffert and Zell, Cable Optimization and Drag Estimation, section V-B.
  CHECK(as_printed(fit.front_area().estimate, "{:.3e}") == "1.492e-02 ± 3.07 %");
  CHECK(as_printed(fit.top_area().estimate, "{:.3e}") == "1.368e-02 ± 3.18 %");
  CHECK(as_printed(fit.linear_speed().estimate, "{:.2f}") == "19.43 ± 4.35 %");
  CHECK(as_printed(fit.wind()[0].estimate, "{:.3f}") == "-1.196 ± 1.61 %");
}

}  // namespace

TEST_CASE("the published fit comes out to every printed digit") {
  const auto log = published_log();
  if (!log) return;
  const Observations flight = published_observations(*log);
  const DragFit fit = fit_drag({&flight, 1}, published_conditions);
  CHECK(fit.converged);
  CHECK(fit.quality.samples == 3396);
  check_as_printed(fit);
}

TEST_CASE("the published fit is reached from many random starts") {
  const auto log = published_log();
  if (!log) return;
  const Observations flight = published_observations(*log);
  const unsigned seed = test::run_seed();
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 100; ++i) {
    DragFitOptions options;
    options.start = DragParameters{
        between(0.001, 0.1), between(0.001, 0.1), between(1, 100), {between(-10, 10)}};
    check_as_printed(fit_drag({&flight, 1}, published_conditions, options));
  }
}

TEST_CASE("the published errors understate, and the drag force is known better than A_f and j") {
  const auto log = published_log();
  if (!log) return;
  const Observations flight = published_observations(*log);
  const DragFit fit = fit_drag({&flight, 1}, published_conditions);
  CHECK(fit.quality.residual_lag1_autocorrelation == Approx(0.86).margin(0.01));
  CHECK(fit.quality.effective_samples < 0.1 * 3396);
  for (const FittedParameter& p : fit.parameters) {
    CHECK(p.estimate.standard_error > 3 * p.estimate.standard_error_independent);
  }
  // The published correlation of A_f and j, from the independent covariance.
  const auto& c = fit.covariance_independent;
  CHECK(c[2] / std::sqrt(c[0] * c[10]) == Approx(-0.97).margin(0.005));
  REQUIRE(entangled_pairs(fit).size() == 1);
  const Estimate force = steady_drag(fit, 30 / 3.6)->force;
  CHECK(force.standard_error < 0.03 * force.value);
  const Estimate& j = fit.linear_speed().estimate;
  CHECK(j.standard_error > 0.15 * j.value);
}

TEST_CASE("the moving part of the published flight is found") {
  const auto log = published_log();
  if (!log) return;
  const SampleRange part = moving_part(*log);
  CHECK(log->time[part.first] == Approx(160).margin(25));    // passes begin at about 155 s
  CHECK(log->time[part.last - 1] == Approx(472).margin(4));  // and end before the descent
}
