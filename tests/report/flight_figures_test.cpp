#include "tethercalc/report/result_figures.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <tuple>

#include "support/figures.hpp"
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

/// What leaning gives less what is seen.
double missing_acceleration(const Observations& o, std::size_t i) {
  return o.expected_acceleration[i] - o.forward_acceleration[i];
}

}  // namespace

TEST_CASE("the drag figure shows measured drag as mass times missing acceleration") {
  const Observations& flight = fitted().identified.flights.front();
  const std::vector<DragAtSample> samples =
      drag_at_samples(fitted().identified.fit, fitted().identified.flights);
  const std::vector<plot::Panel> panels = panels_of(drag_figure(fitted()));
  const auto points = layers_of<plot::Points>(panels[0]);
  REQUIRE(points.size() == 2);  // measured and fitted
  const auto left = layers_of<plot::Points>(panels[1]).front();
  REQUIRE(points[0].x.size() > 350);
  REQUIRE(points[0].x.size() <= 700);
  const std::size_t step = (flight.size() + points[0].x.size() - 1) / points[0].x.size();
  for (std::size_t k = 0; k < points[0].x.size(); ++k) {
    const std::size_t i = k * step;
    CHECK(points[0].x[k] == Approx(samples[i].airspeed).margin(1e-5));
    CHECK(points[0].y[k] == Approx(truth().mass * missing_acceleration(flight, i)).margin(1e-5));
    CHECK(points[1].y[k] == Approx(samples[i].fitted).margin(1e-5));
    CHECK(left.y[k] == Approx(points[0].y[k] - points[1].y[k]).margin(1e-5));
  }
}

TEST_CASE("the line of steady flight balances weight, tilt and drag in both directions") {
  const plot::Panel surface = panels_of(drag_surface_figure(fitted())).front();
  const plot::Panel over_speed = panels_of(drag_figure(fitted())).front();
  const auto tilts = named<plot::Curve>(surface, "steady flight");
  const auto forces = named<plot::Curve>(over_speed, "steady flight");
  REQUIRE(tilts.x.size() > 50);
  REQUIRE(forces.x == tilts.x);
  for (std::size_t i = 0; i < tilts.x.size(); ++i) {
    const double tilt = tilts.y[i] * unit::degree;
    CHECK(forces.y[i] == Approx(truth().mass * standard_gravity * std::tan(tilt)).margin(1e-4));
    CHECK(tilts.x[i] * forces.y[i] >= 0);
  }
  CHECK(tilts.x.front() < -5);
  CHECK(tilts.x.back() > 5);
  const auto band = named<plot::Band>(over_speed, "its 95 % interval");
  REQUIRE(band.x == forces.x);
  for (std::size_t i = 0; i < band.x.size(); ++i) {
    CHECK(band.lower[i] <= forces.y[i] + 1e-6);
    CHECK(forces.y[i] <= band.upper[i] + 1e-6);
  }
}

TEST_CASE("lines of equal drag follow the paper's law, and marks are full where it is exceeded") {
  const plot::Panel panel = panels_of(drag_surface_figure(fitted())).front();
  const AirframeDrag drag = fitted().identified.fit.drag();
  const auto law = [&](double u, double tilt) {
    const double area = drag.front_area * std::cos(tilt) + drag.top_area * std::abs(std::sin(tilt));
    return 0.5 * truth().air_density * area * u * (std::abs(u) + drag.linear_speed);
  };
  std::size_t lines = 0;
  for (const plot::Curve& curve : layers_of<plot::Curve>(panel)) {
    if (curve.label.empty()) continue;
    ++lines;
    REQUIRE(curve.label.ends_with(" N"));
    const bool negative = curve.label.starts_with("−");
    const double level = std::stod(curve.label.substr(negative ? 3 : 0)) * (negative ? -1 : 1);
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      if (!std::isfinite(curve.x[i])) continue;
      CHECK(law(curve.x[i], curve.y[i] * unit::degree) == Approx(level).margin(1e-4));
    }
  }
  CHECK(lines >= 3);
  const auto points = layers_of<plot::Points>(panel);
  REQUIRE(points.size() == 2);
  CHECK(points[0].mark != points[1].mark);
  const Observations& flight = fitted().identified.flights.front();
  const std::size_t shown = points[0].x.size() + points[1].x.size();
  CHECK(shown <= 500);
  const std::size_t step = (flight.size() + shown - 1) / shown;
  const std::vector<DragAtSample> samples =
      drag_at_samples(fitted().identified.fit, fitted().identified.flights);
  std::size_t more = 0;
  for (std::size_t i = 0; i < samples.size(); i += step) {
    more += samples[i].measured > samples[i].fitted ? 1 : 0;
  }
  CHECK(std::abs(double(more) - double(points[0].x.size())) <= 1);
}

TEST_CASE("without the linear term the same flight is fitted by a steeper curve") {
  REQUIRE(fitted().without_linear);
  CHECK(fitted().without_linear->linear_speed().estimate.value < 1e-5);
  CHECK(fitted().without_linear->quality.rmse > fitted().identified.fit.quality.rmse);
  const plot::Panel panel = panels_of(drag_figure(fitted())).front();
  CHECK(named<plot::Curve>(panel, "without a linear term").x.size() > 50);
}

TEST_CASE("a log's figure keeps the extremes of every series, and drag is their difference") {
  const Observations& flight = fitted().identified.flights.front();
  const Figure figure = log_figure("simulated.csv", flight);
  const std::vector<plot::Panel> panels = panels_of(figure);
  REQUIRE(panels.size() == 3);
  const auto check = [](const plot::Curve& curve, const std::vector<double>& series) {
    const auto extreme = [](const std::vector<double>& values, bool most) {
      double out = most ? -1e300 : 1e300;
      for (const double v : values) out = most ? std::fmax(out, v) : std::fmin(out, v);
      return out;
    };
    INFO(curve.words);
    CHECK(extreme(curve.y, false) == Approx(extreme(series, false)));
    CHECK(extreme(curve.y, true) == Approx(extreme(series, true)));
  };
  check(named<plot::Curve>(panels[0], "expected (attitude)"), flight.expected_acceleration);
  check(named<plot::Curve>(panels[0], "observed"), flight.forward_acceleration);
  std::vector<double> drag;
  for (std::size_t i = 0; i < flight.size(); ++i) {
    drag.push_back(missing_acceleration(flight, i));
  }
  check(layers_of<plot::Curve>(panels[1]).front(), drag);
  check(layers_of<plot::Curve>(panels[2]).front(), flight.forward_speed);
}

TEST_CASE("figures of flights name their axes with units and keep their texts apart") {
  const Figure log = log_figure("simulated.csv", fitted().identified.flights.front());
  const Figure drag = drag_figure(fitted());
  const Figure surface = drag_surface_figure(fitted());
  const std::vector<std::pair<Figure, std::vector<std::string>>> figures{
      {log,
       {"forward acceleration (m/s²)", "time of the log (s)", "forward speed over ground (m/s)",
        "drag per mass, expected less observed (m/s²)"}},
      {drag, {"drag (N)", "airspeed, forward (m/s)", "measured less fitted (N)"}},
      {surface, {"airspeed, forward (m/s)", "tilt (deg)"}}};
  for (const auto& [figure, texts] : figures) {
    INFO(figure.id);
    const std::string svg = render(figure, FigureFormat::svg, {});
    for (const std::string& words : texts) CHECK(shows(svg, words));
    CHECK(layout_problems(svg) == no_problems);
    CHECK(svg.size() < 100000);
  }
}

TEST_CASE("what stands in one legend differs without its colour") {
  const auto& flight = fitted().identified.flights.front();
  for (const Figure& figure : {log_figure("simulated.csv", flight), drag_figure(fitted()),
                               drag_surface_figure(fitted())}) {
    for (const plot::Panel& panel : panels_of(figure)) {
      std::set<std::tuple<plot::Dash, double>> lines;
      std::set<plot::Mark> marks;
      for (const plot::Curve& curve : layers_of<plot::Curve>(panel)) {
        INFO(figure.id << ": " << curve.words);
        if (!curve.words.empty()) CHECK(lines.insert({curve.dash, curve.width}).second);
      }
      for (const plot::Points& points : layers_of<plot::Points>(panel)) {
        INFO(figure.id << ": " << points.words);
        if (!points.words.empty()) CHECK(marks.insert(points.mark).second);
      }
    }
  }
}
