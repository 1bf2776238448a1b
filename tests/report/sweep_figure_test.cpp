#include "tethercalc/report/sweep_figure.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "report/result_values.hpp"
#include "support/figures.hpp"
#include "support/random.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/study/results.hpp"

using namespace tethercalc;
using namespace tethercalc::test;
using Catch::Contains;

namespace {

const std::string ending = ",status,cross_section_mm2,forward.total_power_W,reason\n";

/// Every combination of 5 voltages and 4 lengths; thin air beyond 30 m at 40 V.
std::string grid() {
  std::string csv = "supply.voltage_V,tether.length_m" + ending;
  for (int voltage = 40; voltage <= 80; voltage += 10) {
    for (int length = 10; length <= 40; length += 10) {
      const bool flies = voltage > 40 || length <= 30;
      csv += std::to_string(voltage) + "," + std::to_string(length) +
             (flies ? ",optimal,1.5," + std::to_string(300 + 4 * length - voltage) + ",\n"
                    : ",infeasible,,,\"too weak, too far\"\n");
    }
  }
  return csv;
}

/// The cells of the heat map.
std::vector<plot::Cell> cells_of(const Figure& figure) {
  return layers_of<plot::Cells>(panels_of(figure).front()).front().cells;
}

double middle(plot::Range range) { return (range.lo + range.hi) / 2; }

std::vector<InputProblem> problems_of(const std::string& csv, const std::string& value = "") {
  try {
    (void)parse_sweep_csv(csv, "rows.csv", value);
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

}  // namespace

TEST_CASE("a heat map has the sweep's values at their places and gaps where there is none") {
  const SweepTable table = parse_sweep_csv(grid(), "rows.csv");
  CHECK(table.infeasible == 1);
  const auto cells = cells_of(sweep_figure(table));
  REQUIRE(cells.size() == 20);
  for (const plot::Cell& cell : cells) {
    CHECK(cell.x.hi - cell.x.lo == 10);
    CHECK(cell.y.hi - cell.y.lo == 10);
    if (middle(cell.x) == 40 && middle(cell.y) == 40) {
      CHECK(std::isnan(cell.value));
    } else {
      CHECK(cell.value == 300 + 4 * middle(cell.y) - middle(cell.x));
    }
  }
  const std::string svg = render(sweep_figure(table), FigureFormat::svg, {});
  for (const char* words : {"supply voltage (V)", "tether length (m)", "forward total power (W)",
                            "least: 260.0 at 80, 10", "infeasible"}) {
    INFO(words);
    CHECK(shows(svg, words));
  }
}

TEST_CASE("axes can be chosen, exchanged and left to the least of the rest") {
  const SweepTable table = parse_sweep_csv(grid(), "rows.csv");
  const auto turned = cells_of(sweep_figure(table, {"tether.length_m", "supply.voltage_V"}));
  REQUIRE(turned.size() == 20);
  CHECK(middle(turned.front().x) == 10);
  CHECK(middle(turned.front().y) == 40);

  std::string three = "a_V,b_m,c_g" + ending;
  for (int i = 0; i < 27; ++i) {
    three += std::to_string(i / 9) + "," + std::to_string(i / 3 % 3) + "," + std::to_string(i % 3) +
             ",optimal,1," + std::to_string(100 + i) + ",\n";
  }
  const Figure figure = sweep_figure(parse_sweep_csv(three, "rows.csv"));
  for (const plot::Cell& cell : cells_of(figure)) {
    CHECK(cell.value == 100 + 9 * middle(cell.x) + 3 * middle(cell.y));
  }
  CHECK_THAT(render(figure, FigureFormat::svg, {}), Contains("least over c_g"));
  CHECK_THROWS_WITH(sweep_figure(table, {"tether.lenght_m", ""}), Contains("tether.length_m"));
  CHECK_THROWS_WITH(sweep_figure(table, {"tether.length_m", "tether.length_m"}),
                    Contains("other axis"));
}

TEST_CASE("one field makes a curve, with one curve for each of a few names") {
  std::string one = "supply.voltage_V" + ending;
  for (int v = 60; v >= 40; v -= 5) {
    one += std::to_string(v) + ",optimal,1," + std::to_string(1000 / v) + ",\n";
  }
  const auto curve =
      layers_of<plot::Curve>(panels_of(sweep_figure(parse_sweep_csv(one, "rows.csv"))).front())
          .front();
  CHECK(curve.x == std::vector<double>{40, 45, 50, 55, 60});
  CHECK(curve.y == std::vector<double>{25, 22, 20, 18, 16});

  std::string two = "drone.motor,supply.voltage_V" + ending;
  for (const char* motor : {"heavy", "\"light, fast\""}) {
    for (int v = 40; v <= 60; v += 10) {
      two += std::string(motor) + "," + std::to_string(v) + ",optimal,1," +
             std::to_string(motor[0] == 'h' ? v : 2 * v) + ",\n";
    }
  }
  const Figure figure = sweep_figure(parse_sweep_csv(two, "rows.csv"));
  const auto heavy = named<plot::Curve>(panels_of(figure).front(), "heavy");
  const auto light = named<plot::Curve>(panels_of(figure).front(), "light, fast");
  CHECK(heavy.y == heavy.x);
  CHECK(light.y == std::vector<double>{80, 100, 120});
}

TEST_CASE("what is wrong with a sweep's file is told by line, all at once") {
  CHECK(problems_of("").front().where == "rows.csv");
  CHECK_THAT(problems_of("a,b\n1,2\n").front().message, Contains("status"));
  CHECK(problems_of("a,b\n1,2\n").front().where == "rows.csv:1");
  CHECK_THAT(problems_of("status,forward.total_power_W\n").front().message, Contains("varied"));
  CHECK_THAT(problems_of("supply.voltage_V" + ending).front().message, Contains("no rows"));
  const auto problems = problems_of("supply.voltage_V" + ending + "40,optimal,1,300,\n" +
                                    "fifty,optimal,1,300,\n60,optimal,1\n70,optimal,1,much,\n" +
                                    "80,optimal,1,inf,\nnan,optimal,1,2,\n");
  REQUIRE(problems.size() == 5);
  CHECK(problems[0].where == "rows.csv:3");
  CHECK_THAT(problems[0].message, Contains("supply.voltage_V: \"fifty\" is no number"));
  CHECK(problems[1].where == "rows.csv:4");
  CHECK_THAT(problems[1].message, Contains("3 cells"));
  CHECK(problems[2].where == "rows.csv:5");
  CHECK(problems[3].where == "rows.csv:6");
  CHECK(problems[4].where == "rows.csv:7");
  CHECK_THAT(problems_of(grid(), "forward.total_power").front().message,
             Contains("forward.total_power_W"));
  CHECK(problems_of(grid() + "40,\"open").front().where == "rows.csv:22");

  std::string many = "supply.voltage_V" + ending;
  for (int i = 0; i < 30; ++i) many += "x,optimal,1,1,\n";
  CHECK(problems_of(many).size() == 21);
  CHECK_THAT(problems_of(many).back().message, Contains("10 more"));
}

TEST_CASE("a sweep in which nothing varies or nothing flies has no figure and says so") {
  const std::string row = "40,optimal,1,300,\n";
  CHECK_THROWS_WITH(sweep_figure(parse_sweep_csv("supply.voltage_V" + ending + row + row, "a.csv")),
                    Contains("no field has two values"));
  CHECK_THROWS_WITH(
      sweep_figure(parse_sweep_csv(
          "supply.voltage_V" + ending + "40,infeasible,,,\n50,infeasible,,,\n", "a.csv")),
      Contains("no row with a value"));
}

TEST_CASE("a quantity that is the same in every row is drawn at its value") {
  std::string text = "drone.mass_g,supply.voltage_V" + ending;
  for (const char* place : {"1500,60", "1500,70", "1600,60", "1600,70"}) {
    text += std::string(place) + ",optimal,1,300.5,\n";
  }
  const Figure figure = sweep_figure(parse_sweep_csv(text, "a.csv"));
  for (const FigureFormat format : {FigureFormat::svg, FigureFormat::text}) {
    const std::string drawn = render(figure, format, {});
    CHECK_THAT(drawn, Contains("300.5"));
    CHECK_THAT(drawn, !Contains("nan") && !Contains("inf"));
  }
}

TEST_CASE("the unit in a field's name is the unit on the axis") {
  CHECK(axis_label("supply.voltage_V") == "supply voltage (V)");
  CHECK(axis_label("forward.received_voltage_V") == "forward received voltage (V)");
  CHECK(axis_label("requirements.thrust_headroom") == "requirements thrust headroom");
  const auto unit_of = [](std::string_view name) {
    const std::string label = axis_label(name);
    const std::size_t open = label.find(" (");
    return open == std::string::npos ? "" : label.substr(open + 2, label.size() - open - 3);
  };
  const std::pair<std::string, std::span<const SpecField>> groups[] = {
      {"", spec_fields()},
      {"/tether/conductor", object_fields(FieldKind::conductor)},
      {"/tether/insulation/material", object_fields(FieldKind::insulation_material)}};
  for (const auto& [place, fields] : groups) {
    for (const SpecField& field : fields) {
      const std::string path = dot_path(place + std::string(field.pointer));
      INFO(path);
      if (is_numeric(field)) CHECK(unit_of(path) == field.unit);
    }
  }
  for (const OperatingPointField& field : operating_point_fields()) {
    const bool has_unit = field.key.find_last_of('_') != std::string_view::npos;
    INFO(field.key);
    CHECK(unit_of(field.key).empty() != has_unit);
  }
}

TEST_CASE("figures of sweeps keep their texts apart") {
  std::string names = "drone.motor,tether.conductor" + ending;
  std::string sample = "supply.voltage_V,tether.length_m" + ending;
  Random random(run_seed());
  for (int i = 0; i < 72; ++i) {
    names += "a-motor-with-a-long-name-" + std::to_string(i / 8) + ",material-" +
             std::to_string(i % 8) + ",optimal,1," + std::to_string(300 + i) + ",\n";
    sample += csv_number(random.uniform(40, 120)) + "," + csv_number(random.uniform(10, 50)) +
              ",optimal,1," + csv_number(random.uniform(300, 500)) + ",\n";
  }
  for (const std::string& csv : {grid(), names, sample}) {
    const Figure figure = sweep_figure(parse_sweep_csv(csv, "rows.csv"));
    CHECK(layout_problems(render(figure, FigureFormat::svg, {})) == no_problems);
  }
}
