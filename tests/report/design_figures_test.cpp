#include "tethercalc/files/read_files.hpp"
#include "tethercalc/report/result_figures.hpp"
#include "tethercalc/study/motor.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>

#include "support/figures.hpp"
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
  const std::string svg = render(figure, FigureFormat::svg, {});
  CHECK(text_boxes(svg).size() > 15);
  CHECK(layout_problems(svg) == std::vector<std::string>{});
}

}  // namespace

TEST_CASE("the curves of the optimum are the library's operating points") {
  const DesignFile file = read_design(project_file("examples/holybro-x500.json"), {});
  const std::vector<plot::Panel> panels = panels_of(figure_of(file));
  REQUIRE(panels.size() == 2);
  const auto available = named<plot::Curve>(panels[0], "available");
  const auto in_hover = named<plot::Curve>(panels[0], "necessary in hover");
  const auto in_forward = named<plot::Curve>(panels[0], "necessary forward");
  const auto required = named<plot::Curve>(panels[0], "required, 2.0× hover");
  const auto power = named<plot::Curve>(panels[1], "hover");
  REQUIRE(available.x.size() > 200);
  CHECK(power.x == available.x);
  for (std::size_t i = 0; i < available.x.size(); i += 29) {
    const double area = available.x[i] * unit::square_millimetre;
    const OperatingPoint hover = evaluate(file.design, area, Condition::hover);
    const OperatingPoint forward = evaluate(file.design, area, Condition::forward);
    const double g = unit::gram_force;
    CHECK(available.y[i] == Approx(hover.available_thrust / g).epsilon(1e-5));
    CHECK(in_hover.y[i] == Approx(hover.necessary_thrust / g).epsilon(1e-5));
    CHECK(in_forward.y[i] == Approx(forward.necessary_thrust / g).epsilon(1e-5));
    CHECK(required.y[i] == Approx(2 * hover.necessary_thrust / g).epsilon(1e-5));
    if (std::isfinite(hover.total_power)) {
      CHECK(power.y[i] == Approx(hover.total_power).epsilon(1e-5));
    } else {
      CHECK(std::isnan(power.y[i]));
    }
  }
}

TEST_CASE("the published optimum is marked and said in words") {
  // Beffert and Zell 2025, section V-B and figure on cable optimisation.
  const Figure figure = figure_of(read_design(project_file("examples/holybro-x500.json"), {}));
  CHECK_THAT(figure.description, Contains("1.09 mm²"));
  CHECK_THAT(figure.description, Contains("405.4 W in hover"));
  CHECK_THAT(figure.description, Contains("444.9 W in forward flight"));
  const std::string svg = render(figure, FigureFormat::svg, {});
  for (const char* words :
       {"thrust per motor (g)", "power from the supply (W)", "cross-section of one conductor (mm²)",
        "IEC 60228 (mm²)", "AWG", "optimum, 1.09 mm²", "necessary in hover",
        "least power, 0.980 mm²", "feasible", "1.09 mm²"}) {
    INFO(words);
    CHECK(shows(svg, words));
  }
}

TEST_CASE("the mark of the optimum stands where the axes have the published numbers") {
  // Beffert and Zell 2025: 1.0886 mm² and 444.9 W in forward flight.
  const std::string svg =
      render(figure_of(read_design(project_file("examples/holybro-x500.json"), {})),
             FigureFormat::svg, {});
  std::vector<TextBox> across;  // numbers of the common horizontal axis
  std::vector<TextBox> up;      // of the axis of power
  for (const TextBox& box : text_boxes(svg)) {
    if (box.text == "1.0" || box.text == "3.0") across.push_back(box);
    if (box.text == "400" || box.text == "550") up.push_back(box);
  }
  REQUIRE(across.size() == 2);
  REQUIRE(up.size() >= 2);
  std::sort(across.begin(), across.end(),
            [](const TextBox& a, const TextBox& b) { return a.left < b.left; });
  std::sort(up.begin(), up.end(), [](const TextBox& a, const TextBox& b) { return a.top > b.top; });
  const auto middle = [](const TextBox& box) { return (box.left + box.right) / 2; };
  const double a_mm2 = (middle(across[1]) - middle(across[0])) / 2;
  const double a_watt = (up[1].bottom - up[0].bottom) / (550 - 400);
  const double x = middle(across[0]) + (1.0886 - 1) * a_mm2;
  const double base = up[0].bottom - 0.24 * 10 - 0.36 * 10;  // the tick is at the digits' middle
  const double y = base + (444.9 - 400) * a_watt;
  // The second diamond; its topmost corner is written first.
  const std::regex diamond(R"re(<path d="M([\d.]+),([\d.]+)L[^"]*Z" class="ink")re");
  double nearest = 1e9;
  for (std::sregex_iterator it(svg.begin(), svg.end(), diamond), end; it != end; ++it) {
    nearest = std::min(nearest, std::hypot(std::stod((*it)[1]) - x, std::stod((*it)[2]) + 5 - y));
  }
  CHECK(nearest < 0.4);  // pixels: 0.6 W or 5e-3 mm²
}

TEST_CASE("the curves of motors are their efficiencies") {
  const DesignFile file = read_design(project_file("examples/holybro-x500.json"), {});
  const auto ranking = compare_motors(file.design, alike_motors(library_motors(), file.motor));
  const Figure figure = motors_figure(file, ranking);
  const auto curves = layers_of<plot::Curve>(panels_of(figure).front());
  REQUIRE(curves.size() >= ranking.size());
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    const plot::Curve& drawn = curves[i];
    const MotorCurve& curve = ranking[i].design.drone.motor;
    CHECK(drawn.label == std::to_string(i + 1));
    CHECK_THAT(drawn.words, Contains(ranking[i].motor.name));
    REQUIRE(drawn.x.size() > 10);
    for (std::size_t k = 0; k < drawn.x.size(); ++k) {
      CHECK(drawn.y[k] ==
            Approx(drawn.x[k] / curve.power(drawn.x[k] * unit::gram_force)).epsilon(1e-5));
    }
    CHECK(drawn.x.back() == Approx(curve.max_thrust() / unit::gram_force).epsilon(1e-5));
    CHECK_THAT(figure.description, Contains(ranking[i].motor.name));
  }
  const std::string svg = render(figure, FigureFormat::svg, {});
  CHECK(shows(svg, "efficiency (g/W)"));
  CHECK(shows(svg, "thrust of one motor (g)"));
}

TEST_CASE("no curve of a motor runs through the number of another, at any width") {
  const DesignFile file = read_design(project_file("examples/holybro-x500.json"), {});
  const Figure figure = motors_figure(file, compare_motors(file.design, library_motors()));
  for (const double width : {85.0, 170.0}) {
    FigureSize size;
    size.width_mm = width;
    const std::string svg = render(figure, FigureFormat::svg, {}, size);
    std::size_t numbers = 0;
    const std::regex path(
        R"re(<path d="(M[^"]*)" class="\w+" color="[^"]*" stroke="currentColor" )re"
        R"re(fill="none" stroke-width="1.3")re");
    for (const TextBox& box : text_boxes(svg)) {
      if (box.text.size() != 1 || box.text.find_first_of("123456789") == std::string::npos)
        continue;
      if (box.left < 30 || box.left > 3.7 * width) continue;
      ++numbers;
      for (std::sregex_iterator it(svg.begin(), svg.end(), path), end; it != end; ++it) {
        const std::string commands = (*it)[1];
        static const std::regex corner(R"re([ML]([\d.]+),([\d.]+))re");
        for (std::sregex_iterator at(commands.begin(), commands.end(), corner); at != end; ++at) {
          const double x = std::stod((*at)[1]);
          const double y = std::stod((*at)[2]);
          const bool inside = x > box.left && x < box.right && y > box.top && y < box.bottom - 2.4;
          INFO(box.text << " at " << x << ", " << y);
          CHECK_FALSE(inside);
        }
      }
    }
    CHECK(numbers >= 9);
  }
}

TEST_CASE("no label covers another in the figures of any reference design") {
  const std::vector<MotorEntry> motors = library_motors();
  for (const std::string& spec : reference_specs()) {
    INFO(spec);
    const DesignFile file = read_design(spec, {});
    check_layout(figure_of(file));
    check_layout(
        motors_figure(file, compare_motors(file.design, alike_motors(motors, file.motor))));
    check_layout(motors_figure(file, compare_motors(file.design, motors)));
  }
}

TEST_CASE("an axis of sizes has a size, whichever cable is looked at") {
  const DesignFile file = read_design(project_file("examples/holybro-x500.json"), {});
  OptimumStudy study = study_optimum(file.design, wire_sizes());
  AreaCurve curve = area_curve(study);
  // From thin foil to a busbar: between two sizes, below all and above all.
  for (const double hi : {0.001, 0.02, 0.1, 1.2, 3.0, 40.0, 1e4, 1e7}) {
    for (const bool logarithmic : {false, true}) {
      curve.lo = hi / 50 * unit::square_millimetre;
      curve.hi = hi * unit::square_millimetre;
      curve.logarithmic = logarithmic;
      for (const plot::Panel& panel : panels_of(optimum_figure("any", study, curve))) {
        INFO(hi);
        if (panel.top) CHECK_FALSE(panel.top->ticks.empty());
      }
    }
  }
}

TEST_CASE("a design whose power cannot be delivered says so in its figure") {
  const DesignFile file =
      read_design(project_file("examples/reference/infeasible-power-hover.json"), {});
  const std::string svg = render(figure_of(file), FigureFormat::svg, {});
  CHECK(shows(svg, "cannot be delivered"));
  CHECK_FALSE(shows(svg, "0.5"));  // no number of watts on an axis without any
}

TEST_CASE("a figure's legend and heading survive a name of 300 characters") {
  DesignFile file = read_design(project_file("examples/holybro-x500.json"), {});
  file.name = std::string(150, 'n') + std::string(150, '\'');
  check_layout(figure_of(file));
}

TEST_CASE("the pictures of the documents are those that the program draws") {
  const DesignFile file = read_design(project_file("examples/holybro-x500.json"), {});
  const auto check = [](const Figure& figure, const std::string& document) {
    INFO(document << ": scripts/draw-figures draws it anew");
    CHECK(file_text(project_file(document)) == render(figure, FigureFormat::svg, {}));
    CHECK(std::filesystem::file_size(project_file(document)) < 100000);
  };
  check(figure_of(file), "docs/figures/optimum.svg");
  check(
      motors_figure(file, compare_motors(file.design, alike_motors(library_motors(), file.motor))),
      "docs/figures/motors.svg");
}
