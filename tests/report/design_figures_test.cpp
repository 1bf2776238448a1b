#include "tethercalc/files/gnuplot.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/report/result_figures.hpp"
#include "tethercalc/study/motor.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>

#include "support/gnuplot.hpp"
#include "support/run_program.hpp"
#include "tethercalc/io/library.hpp"

using namespace tethercalc;
using namespace tethercalc::test;
using Catch::Contains;

namespace {

std::vector<std::string> reference_specs() {
  std::vector<std::string> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(project_file("examples/reference"))) {
    const std::string file = entry.path().string();
    if (file.ends_with(".json") && !file.ends_with(".expected.json")) files.push_back(file);
  }
  std::sort(files.begin(), files.end());
  return files;
}

Figure figure_of(const DesignFile& file) {
  const OptimumStudy study = study_optimum(file.design, wire_sizes());
  return optimum_figure(file.name, study, area_curve(study));
}

void check_layout(const Figure& figure) {
  const std::string svg = render(figure, FigureFormat::svg, run_gnuplot);
  CHECK(text_boxes(svg).size() > 15);
  CHECK(layout_problems(svg) == std::vector<std::string>{});
}

}  // namespace

TEST_CASE("the curves of the optimum are the library's operating points") {
  const DesignFile file = read_design(project_file("examples/holybro-x500.json"), {});
  const auto rows = block_of(figure_of(file).script, "curves");
  REQUIRE(rows.size() > 200);
  for (std::size_t i = 0; i < rows.size(); i += 29) {
    const double area = rows[i][0] * unit::square_millimetre;
    const OperatingPoint hover = evaluate(file.design, area, Condition::hover);
    const OperatingPoint forward = evaluate(file.design, area, Condition::forward);
    const double g = unit::gram_force;
    CHECK(rows[i][1] == Approx(hover.available_thrust / g).epsilon(1e-5));
    CHECK(rows[i][2] == Approx(hover.necessary_thrust / g).epsilon(1e-5));
    CHECK(rows[i][3] == Approx(forward.necessary_thrust / g).epsilon(1e-5));
    CHECK(rows[i][4] == Approx(2 * hover.necessary_thrust / g).epsilon(1e-5));
    if (std::isfinite(hover.total_power)) {
      CHECK(rows[i][5] == Approx(hover.total_power).epsilon(1e-5));
    } else {
      CHECK(std::isnan(rows[i][5]));
    }
  }
}

TEST_CASE("the published optimum is marked and said in words") {
  // Beffert and Zell 2025, section V-B and figure on cable optimisation.
  const Figure figure = figure_of(read_design(project_file("examples/holybro-x500.json"), {}));
  CHECK_THAT(figure.description, Contains("1.09 mm²"));
  CHECK_THAT(figure.description, Contains("405.4 W in hover"));
  CHECK_THAT(figure.description, Contains("444.9 W in forward flight"));
  for (const char* words :
       {"thrust per motor (g)", "power from the supply (W)", "cross-section of one conductor (mm²)",
        "IEC 60228 (mm²)", "AWG", "'optimum, 1.09 mm²'", "'necessary in hover'",
        "'least power, 0.980 mm²'", "'feasible'"}) {
    CHECK_THAT(figure.script, Contains(words));
  }
}

TEST_CASE("the curves of motors are their efficiencies") {
  const DesignFile file = read_design(project_file("examples/holybro-x500.json"), {});
  const auto ranking = compare_motors(file.design, alike_motors(library_motors(), file.motor));
  const Figure figure = motors_figure(file, ranking);
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    const auto rows = block_of(figure.script, "motor" + std::to_string(i + 1));
    const MotorCurve& curve = ranking[i].design.drone.motor;
    REQUIRE(rows.size() > 10);
    for (const auto& row : rows) {
      CHECK(row[1] == Approx(row[0] / curve.power(row[0] * unit::gram_force)).epsilon(1e-5));
    }
    CHECK(rows.back()[0] == Approx(curve.max_thrust() / unit::gram_force).epsilon(1e-5));
    CHECK_THAT(figure.description, Contains(ranking[i].motor.name));
  }
  CHECK_THAT(figure.script,
             Contains("'efficiency (g/W)'") && Contains("'thrust of one motor (g)'"));
}

TEST_CASE("no label covers another in the figures of any reference design") {
  if (!gnuplot_is_there()) return;
  const std::vector<MotorEntry> motors = library_motors();
  for (const std::string& spec : reference_specs()) {
    INFO(spec);
    const DesignFile file = read_design(spec, {});
    check_layout(figure_of(file));
    check_layout(
        motors_figure(file, compare_motors(file.design, alike_motors(motors, file.motor))));
  }
}

TEST_CASE("a design whose power cannot be delivered says so in its figure") {
  const DesignFile file =
      read_design(project_file("examples/reference/infeasible-power-hover.json"), {});
  CHECK_THAT(figure_of(file).script, Contains("'cannot be delivered'"));
}

TEST_CASE("a figure's legend and heading survive a name of 300 characters") {
  if (!gnuplot_is_there()) return;
  DesignFile file = read_design(project_file("examples/holybro-x500.json"), {});
  file.name = std::string(150, 'n') + std::string(150, '\'');
  check_layout(figure_of(file));
}

TEST_CASE("the pictures of the documents are those that the program draws") {
  if (!gnuplot_is_there()) return;
  const DesignFile file = read_design(project_file("examples/holybro-x500.json"), {});
  const auto check = [](const Figure& figure, const std::string& document) {
    INFO(document << ": scripts/draw-figures draws it anew");
    const auto texts = [](const std::string& svg) {
      std::vector<std::string> out;
      for (const TextBox& box : text_boxes(svg)) out.push_back(box.text);
      return out;
    };
    CHECK(texts(file_text(project_file(document))) ==
          texts(render(figure, FigureFormat::svg, run_gnuplot)));
    CHECK(std::filesystem::file_size(project_file(document)) < 100000);
  };
  check(figure_of(file), "docs/figures/optimum.svg");
  check(
      motors_figure(file, compare_motors(file.design, alike_motors(library_motors(), file.motor))),
      "docs/figures/motors.svg");
}
