#include "tethercalc/files/gnuplot.hpp"
#include "tethercalc/report/result_figures.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "support/gnuplot.hpp"
#include "support/simulated_flight.hpp"

using namespace tethercalc;
using namespace tethercalc::test;
using Catch::Contains;

namespace {

SimulatedFlight truth() {
  SimulatedFlight flight;
  flight.duration = 120;
  return flight;
}

DragIdentificationOptions known(const SimulatedFlight& flight) {
  DragIdentificationOptions options;
  options.conditions = {flight.mass, flight.air_density, standard_gravity};
  return options;
}

/// Fitted once: every test looks at the same flight.
const DragStudy& fitted() {
  static const DragStudy drag = [] {
    const std::vector<FlightLog> logs{simulate(truth())};
    return study_drag("simulated.csv", logs, known(truth()));
  }();
  return drag;
}

/// What leaning gives less what is seen, beside what the turning frame carries from one speed into
/// the other.
double missing_acceleration(const Observations& o, std::size_t i) {
  const bool inside = i > 0 && i + 1 < o.size();
  const double turn =
      inside ? (o.yaw[i + 1] - o.yaw[i - 1]) / (o.time[i + 1] - o.time[i - 1]) : 0.0;
  return o.expected_acceleration[i] - (o.forward_acceleration[i] - turn * o.right_speed[i]);
}

}  // namespace

TEST_CASE("the drag figure shows measured drag as mass times missing acceleration") {
  const Observations& flight = fitted().identified.flights.front();
  const double wind = fitted().identified.fit.wind()[0].estimate.value;
  const AirframeDrag drag = fitted().identified.fit.drag();
  const auto rows = block_of(drag_figure(fitted()).script, "samples");
  REQUIRE(rows.size() > 350);
  REQUIRE(rows.size() <= 700);
  const std::size_t step = (flight.size() + rows.size() - 1) / rows.size();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::size_t i = k * step;
    const double u = flight.forward_speed[i] - wind;
    CHECK(rows[k][0] == Approx(u).margin(1e-5));
    CHECK(rows[k][1] == Approx(truth().mass * missing_acceleration(flight, i)).margin(1e-5));
    // The paper's drag law, along the airspeed vector, written out.
    const double area = drag.front_area * std::cos(flight.tilt[i]) +
                        drag.top_area * std::abs(std::sin(flight.tilt[i]));
    const double law = 0.5 * truth().air_density * area * u *
                       (std::hypot(u, flight.right_speed[i]) + drag.linear_speed);
    CHECK(rows[k][2] == Approx(law).margin(1e-5));
    CHECK(rows[k][3] == Approx(rows[k][1] - rows[k][2]).margin(1e-5));
  }
}

TEST_CASE("the line of steady flight balances weight, tilt and drag in both directions") {
  const auto rows = block_of(drag_surface_figure(fitted()).script, "steady");
  REQUIRE(rows.size() > 50);
  bool forward = false;
  bool backward = false;
  for (const auto& row : rows) {
    const double tilt = row[1] * unit::degree;
    CHECK(row[2] == Approx(truth().mass * standard_gravity * std::tan(tilt)).margin(1e-4));
    forward = forward || row[0] > 5;
    backward = backward || row[0] < -5;
    CHECK(row[0] * row[2] >= 0);
  }
  CHECK(forward);
  CHECK(backward);
  for (const auto& row : block_of(drag_figure(fitted()).script, "steady")) {
    CHECK(row[2] <= row[1] + 1e-6);
    CHECK(row[1] <= row[3] + 1e-6);
  }
}

TEST_CASE("without the linear term the same flight is fitted by a steeper curve") {
  REQUIRE(fitted().without_linear);
  CHECK(fitted().without_linear->linear_speed().estimate.value < 1e-5);
  CHECK(fitted().without_linear->quality.rmse > fitted().identified.fit.quality.rmse);
  CHECK(block_of(drag_figure(fitted()).script, "bare").size() > 50);
}

TEST_CASE("a log's figure keeps the extremes of every series, and drag is their difference") {
  const Observations& flight = fitted().identified.flights.front();
  const Figure figure = log_figure("simulated.csv", flight);
  const auto extremes = [&](const char* block) {
    double lo = 1e300;
    double hi = -1e300;
    for (const auto& row : block_of(figure.script, block)) {
      lo = std::min(lo, row[1]);
      hi = std::max(hi, row[1]);
    }
    return std::pair{lo, hi};
  };
  const auto check = [&](const char* block, const std::vector<double>& series) {
    INFO(block);
    CHECK(extremes(block).first == Approx(*std::min_element(series.begin(), series.end())));
    CHECK(extremes(block).second == Approx(*std::max_element(series.begin(), series.end())));
  };
  check("expected", flight.expected_acceleration);
  check("observed", flight.forward_acceleration);
  check("speed", flight.forward_speed);
  std::vector<double> drag;
  for (std::size_t i = 0; i < flight.size(); ++i) {
    drag.push_back(missing_acceleration(flight, i));
  }
  check("drag", drag);
}

TEST_CASE("figures of flights name their axes with units and keep their texts apart") {
  const Figure log = log_figure("simulated.csv", fitted().identified.flights.front());
  for (const char* words : {"'forward acceleration (m/s²)'", "(m/s²)'", "'time of the log (s)'",
                            "'forward speed over ground (m/s)'"}) {
    CHECK_THAT(log.script, Contains(words));
  }
  const Figure drag = drag_figure(fitted());
  for (const char* words :
       {"'drag (N)'", "'airspeed, forward (m/s)'", "'measured less fitted (N)'"}) {
    CHECK_THAT(drag.script, Contains(words));
  }
  const Figure surface = drag_surface_figure(fitted());
  for (const char* words : {"'drag (N)'", "'airspeed (m/s)'", "'tilt (deg)'"}) {
    CHECK_THAT(surface.script, Contains(words));
  }
  if (!gnuplot_is_there()) return;
  for (const Figure& figure : {log, drag, surface}) {
    INFO(figure.id);
    const std::string svg = render(figure, FigureFormat::svg, run_gnuplot);
    CHECK(layout_problems(svg) == no_problems);
    CHECK(svg.size() < 100000);
  }
}
