#include "tethercalc/report/result_figures.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "support/figures.hpp"
#include "support/random.hpp"
#include "tethercalc/report/diagnosis_report.hpp"

using namespace tethercalc;
using namespace tethercalc::test;
using Catch::Contains;

namespace {

/// A diagnosis of 2000 samples in which one finding is a straight line over its channel.
Diagnosis power_diagnosis() {
  Random random(run_seed());
  Diagnosis d;
  d.kind = LogKind::power;
  d.unit = "standard deviations of the noise";
  d.base.holdout_rmse = 3;
  d.extended.holdout_rmse = 1;
  ComparedSeries series{"voltage lost in the tether", "V", "tether", {}, {}, {}, {}};
  FindingTrace trace{0, {"supply current", "A", {}}, {}, {}};
  for (int i = 0; i < 2000; ++i) {
    const double current = random.uniform(3, 8);
    const double noise = random.uniform(-0.05, 0.05);
    const bool left_out = i % 100 == 7;
    const double predicted = left_out ? std::numeric_limits<double>::quiet_NaN() : 1.2 * current;
    series.time.push_back(i);
    series.measured.push_back(1.5 * current + noise);
    series.before.push_back(predicted);
    series.after.push_back(predicted + 0.3 * current);
    trace.channel.values.push_back(current);
    trace.without.push_back(series.measured.back() - series.before.back());
    trace.with.push_back(series.measured.back() - series.after.back());
  }
  d.compared.push_back(series);
  d.traces.push_back(trace);
  Finding finding;
  finding.effect = "contact_resistance";
  finding.title = "Plugs or slip rings add resistance";
  finding.stage = "tether";
  d.findings.push_back(finding);
  d.budget = {{88.9}, 1.1, 10};
  d.further.push_back({"voltage lost in the tether", "V", 1.65, 0.029});
  return d;
}

}  // namespace

TEST_CASE("the means over a channel show the line that a finding explains") {
  const Figure figure = diagnosis_figure("power.csv", power_diagnosis());
  const std::vector<plot::Panel> panels = panels_of(figure);
  REQUIRE(panels.size() == 3);  // before, after, the finding
  const auto without = named<plot::Curve>(panels[2], "means without it");
  const auto with = named<plot::Curve>(panels[2], "means with it");
  REQUIRE(without.x.size() > 15);
  for (std::size_t i = 0; i < without.x.size(); ++i) {
    CHECK(without.y[i] == Approx(0.3 * without.x[i]).margin(0.03));
    CHECK(with.y[i] == Approx(0).margin(0.03));
  }
  const auto before = layers_of<plot::Points>(panels[0]).front();
  const auto after = layers_of<plot::Points>(panels[1]).front();
  CHECK(panels[1].beside);
  CHECK(before.x.size() > 100);
  CHECK(before.x.size() <= 250);
  REQUIRE(after.x == before.x);
  for (std::size_t i = 0; i < before.x.size(); ++i) {
    CHECK(after.y[i] == Approx(before.y[i] * 1.25).epsilon(1e-5));
  }
}

TEST_CASE("the error budget names stage and effect, and all shares stand in words") {
  Diagnosis d = power_diagnosis();
  d.unexplained.undetectable_percent = 5;
  const Figure figure = diagnosis_figure("power.csv", d);
  const std::string svg = render(figure, FigureFormat::svg, {});
  for (const char* words :
       {"tether: contact resistance", "88.9 %", "unexplained", "1.1 %", "noise", "10.0 %",
        "supply current (A)", "measured less predicted (V)", "measured (V)", "before: 1.65 V",
        "after: 0.0290 V", "voltage lost in the tether, predicted (V)"}) {
    INFO(words);
    CHECK(shows(svg, words));
  }
  CHECK_THAT(figure.description, Contains("tether: contact resistance 88.9 %"));
}

TEST_CASE("what is left is called noise only where structure in it would have shown") {
  Diagnosis d = power_diagnosis();
  d.unexplained.undetectable_percent = 60;
  CHECK(rest_words(d.unexplained) == "noise or not");
  CHECK(shows(render(diagnosis_figure("power.csv", d), FigureFormat::svg, {}), "noise or not"));
  d.unexplained.undetectable_percent = 10;
  CHECK(rest_words(d.unexplained) == "noise");
}

TEST_CASE("every effect stands in the figure with its verdict") {
  Diagnosis d = power_diagnosis();
  d.findings[0].gain_percent = 60.2;
  d.findings[0].gain_se_percent = 4.1;
  d.findings[0].indistinguishable_from = {"spooled_length"};
  d.suspected.push_back(
      {"extra_mass", "The drone is heavier than the spec says", 3.1, 1.2, {}, "a longer log", 0});
  d.ruled_out.push_back({"tether_drag", "tether_drag_scale", 0.31, "1", 0});
  d.ruled_out.push_back({"air_density", "air_density_kg_m3", 0.0412, "kg/m³", 0});
  d.not_testable.push_back({"converter_efficiency_curve", "bus_voltage_V", 0});
  d.not_identifiable.push_back({"wind", "it changes nothing", 2});
  const Figure figure = diagnosis_figure("power.csv", d);
  const std::string svg = render(figure, FigureFormat::svg, {});
  for (const char* words :
       {"contact resistance: found, 60.2 ± 4.1 %",
        "spooled length: would explain as well as contact resistance",
        "extra mass: suspected, 3.1 ± 1.2 %", "tether drag: ruled out beyond 0.31",
        "air density: ruled out beyond 0.041 kg/m³", "converter efficiency curve: not testable",
        "wind (flight 2): not identifiable"}) {
    CHECK_THAT(figure.description, Contains(words));
    CHECK_THAT(svg, Contains(std::string(words).substr(0, 45)));
  }
  CHECK(layout_problems(render(figure, FigureFormat::svg, {})) == std::vector<std::string>{});
}

TEST_CASE("a diagnosis without anything compared has no figure and says why") {
  Diagnosis d;
  d.notes.push_back({WarningKind::log_too_short, "the log is too short to judge"});
  CHECK_THROWS_WITH(diagnosis_figure("a.csv", d), "the log is too short to judge");
}

TEST_CASE("the texts of a diagnosis with six findings keep apart") {
  Diagnosis d = power_diagnosis();
  while (d.compared.size() < 3) d.compared.push_back(d.compared.front());
  while (d.further.size() < 3) d.further.push_back(d.further.front());
  while (d.traces.size() < 6) {
    d.traces.push_back(d.traces.front());
    d.findings.push_back(d.findings.front());
    d.findings.back().effect = "converter_efficiency_curve";
    d.findings.back().stage = "converter";
    d.budget.findings.push_back(0.5);
  }
  CHECK(layout_problems(render(diagnosis_figure("power.csv", d), FigureFormat::svg, {})) ==
        std::vector<std::string>{});
}
