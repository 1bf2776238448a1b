// The published fit on the published flight, and what the published errors leave out.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <random>

#include "support/flight_csv.hpp"
#include "tethercalc/identify/drag_fit.hpp"

using namespace tethercalc;

namespace {

const std::filesystem::path published_log =
    std::filesystem::path(TETHERCALC_REFERENCE_DATA) / "data" / "x500-flight.csv";

bool absent() {
  if (std::filesystem::exists(published_log)) return false;
  std::puts("SKIPPED: the published flight is not at hand");
  return true;
}

Observations published_observations() {
  const FlightLog log = test::read_flight_csv(published_log);
  return observe(log, range_in_percent(log, 25, 90), 1.4955439766569403 * unit::degree);
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
  if (absent()) return;
  const Observations flight = published_observations();
  const DragFit fit = fit_drag({&flight, 1}, published_conditions);
  CHECK(fit.converged);
  CHECK(fit.quality.samples == 3396);
  check_as_printed(fit);
}
