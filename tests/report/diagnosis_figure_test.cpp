#include "tethercalc/files/gnuplot.hpp"
#include "tethercalc/report/result_figures.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "support/gnuplot.hpp"
#include "support/random.hpp"

using namespace tethercalc;
using namespace tethercalc::test;
using Catch::Contains;

namespace {

/// A diagnosis of 2000 samples in which one finding is a straight line over its channel.
Diagnosis power_diagnosis() {
  Random random(run_seed());
  Diagnosis d;
  d.kind = "power";
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
  const auto means = block_of(figure.script, "meansfinding1");
  REQUIRE(means.size() > 15);
  for (const auto& row : means) {
    CHECK(row[1] == Approx(0.3 * row[0]).margin(0.03));
    CHECK(row[2] == Approx(0).margin(0.03));
  }
  const auto dots = block_of(figure.script, "compared1");
  CHECK(dots.size() > 100);
  CHECK(dots.size() <= 250);
  for (const auto& row : dots) {
    REQUIRE(row.size() == 3);
    CHECK(row[2] == Approx(row[1] * 1.25).epsilon(1e-5));
  }
}

TEST_CASE("the error budget names stage and effect, and all shares stand in words") {
  const Figure figure = diagnosis_figure("power.csv", power_diagnosis());
  for (const char* words :
       {"'tether: contact_resistance'", "'88.9 %'", "'unexplained'", "'1.1 %'", "'noise'",
        "'10.0 %'", "'share (%)'", "'supply current (A)'", "'measured less predicted (V)'",
        "'measured (V)'", "'before: 1.65 V'", "'after: 0.0290 V'"}) {
    CHECK_THAT(figure.script, Contains(words));
  }
  CHECK_THAT(figure.description, Contains("tether: contact_resistance 88.9 %"));
}

TEST_CASE("every effect stands in the figure with its verdict") {
  Diagnosis d = power_diagnosis();
  d.findings[0].gain_percent = 60.2;
  d.findings[0].gain_se_percent = 4.1;
  d.findings[0].indistinguishable_from = {"spooled_length"};
  d.suspected.push_back({"extra_mass", 3.1, 1.2, {}, "a longer log", 0});
  d.ruled_out.push_back({"tether_drag", "tether_drag_scale", 0.31, "1", 0});
  d.ruled_out.push_back({"air_density", "air_density_kg_m3", 0.0412, "kg/m³", 0});
  d.not_testable.push_back({"converter_efficiency_curve", "bus_voltage_V", 0});
  d.not_identifiable.push_back({"wind", "it changes nothing", 2});
  const Figure figure = diagnosis_figure("power.csv", d);
  for (const char* words :
       {"contact_resistance: found, 60.2 ± 4.1 %",
        "spooled_length: would explain as well as contact_resistance",
        "extra_mass: suspected, 3.1 ± 1.2 %", "tether_drag: ruled out beyond 0.31",
        "air_density: ruled out beyond 0.041 kg/m³", "converter_efficiency_curve: not testable",
        "wind (flight 2): not identifiable"}) {
    CHECK_THAT(figure.description, Contains(words));
    CHECK_THAT(figure.script, Contains(std::string(words).substr(0, 45)));
  }
  if (!gnuplot_is_there()) return;
  CHECK(layout_problems(render(figure, FigureFormat::svg, run_gnuplot)) ==
        std::vector<std::string>{});
}

TEST_CASE("a diagnosis without anything compared has no figure and says why") {
  Diagnosis d;
  d.notes.push_back("the log is too short to judge");
  CHECK_THROWS_WITH(diagnosis_figure("a.csv", d), "the log is too short to judge");
}

TEST_CASE("the texts of a diagnosis with six findings keep apart") {
  if (!gnuplot_is_there()) return;
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
  CHECK(layout_problems(render(diagnosis_figure("power.csv", d), FigureFormat::svg, run_gnuplot)) ==
        std::vector<std::string>{});
}
