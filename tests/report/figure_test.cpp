#include "tethercalc/report/figure.hpp"
#include "tethercalc/files/gnuplot.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <optional>

#include "report/gnuplot_script.hpp"
#include "support/gnuplot.hpp"
#include "support/random.hpp"
#include "support/run_program.hpp"
#include "tethercalc/io/input_error.hpp"

using namespace tethercalc;
using namespace tethercalc::test;
using Catch::Contains;

namespace {

Figure figure_with(const std::string& text) {
  Figure figure;
  figure.id = "trial";
  figure.title = text;
  figure.description = text;
  figure.script = "set termoption noenhanced\nset label 1 " + gnuplot_text(text, 1000) +
                  " at graph 0.5,0.5 center\nplot [0:1] x title " + gnuplot_text(text, 1000) + "\n";
  return figure;
}

std::size_t characters_of(const std::string& text) {
  return std::size_t(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

/// A folder in which nothing may appear.
class Watched {
 public:
  [[nodiscard]] bool untouched() const { return std::filesystem::is_empty(folder_.path()); }
  [[nodiscard]] std::string file() const { return (folder_.path() / "breach").string(); }

 private:
  TemporaryFolder folder_;
};

/// The text that the expression stands for, by the rules that no version of gnuplot disagrees on:
/// literals in single quotes without one inside, "'", and points between them.
std::optional<std::string> value_of(const std::string& expression) {
  std::string text;
  for (std::size_t at = 0; at < expression.size();) {
    if (at > 0 && expression[at++] != '.') return std::nullopt;
    const char quote = expression[at];
    const std::size_t end = expression.find(quote, at + 1);
    if ((quote != '\'' && quote != '"') || end == std::string::npos) return std::nullopt;
    const std::string inside = expression.substr(at + 1, end - at - 1);
    if (quote == '"' && inside != "'") return std::nullopt;
    text += inside;
    at = end + 1;
  }
  return text;
}

}  // namespace

TEST_CASE("whatever bytes a text has, it becomes one quoted line of bounded length") {
  CHECK(rc::check("a text and nothing else", [] {
    const std::string text = *rc::gen::container<std::string>(
        rc::gen::oneOf(rc::gen::arbitrary<char>(), rc::gen::elementOf(std::string("'\"`\\.ab"))));
    const auto shown = value_of(gnuplot_text(text, 20));
    RC_ASSERT(shown);
    RC_ASSERT(characters_of(*shown) <= 20U);
    RC_ASSERT(std::none_of(shown->begin(), shown->end(),
                           [](char c) { return static_cast<unsigned char>(c) < 0x20; }));
    const bool plain = text.size() <= 20 && std::all_of(text.begin(), text.end(), [](char c) {
                         return c >= 0x20 && c < 0x7F;
                       });
    if (plain) RC_ASSERT(*shown == text);
  }));
}

TEST_CASE("gnuplot shows a hostile text as it is and runs nothing of it") {
  if (!gnuplot_is_there()) return;
  const Watched watched;
  const std::string touch = "touch " + watched.file();
  const std::vector<std::string> hostile{
      "<script>alert(1)</script>",
      "'; system('" + touch + "'); '",
      "\"; system(\"" + touch + "\"); \"",
      "`" + touch + "`",
      "$(" + touch + ")",
      "@evil and %s %n %d {/=40 big} a_b^c &{x} ~a{.8-}",
      "\\', system('" + touch + "')",
      "EOD",
      "''",
      "'",
      "''''; system('" + touch + "')",
      "a''b'''c",
      "# comment",
      "a\\",
      "]]> --> <!-- &amp; &#x41;",
  };
  for (const std::string& text : hostile) {
    INFO(text);
    const std::string svg = render(figure_with(text), FigureFormat::svg, run_gnuplot);
    CHECK(svg.find("<script") == std::string::npos);
    const auto boxes = text_boxes(svg);
    const auto shown = [&](const TextBox& box) { return box.text == text; };
    CHECK(std::count_if(boxes.begin(), boxes.end(), shown) >= 1);
    CHECK(watched.untouched());
  }
}

TEST_CASE("control characters, broken UTF-8 and 300 characters do no harm to an SVG") {
  if (!gnuplot_is_there()) return;
  for (const std::string& text :
       {std::string("one\ntwo\r\nthree\tfour"), std::string("bell\a escape\x1b[31m nul\0!", 24),
        std::string("half \xC3 and \xFF\xFE"), std::string(300, 'W'),
        std::string("\u202Eesrever")}) {
    const std::string svg = render(figure_with(text), FigureFormat::svg, run_gnuplot);
    const bool clean = std::all_of(svg.begin(), svg.end(), [](char c) {
      return static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t' || c == '\r';
    });
    CHECK(clean);
    CHECK(svg.find("\u202E") == std::string::npos);
    const TemporaryFolder folder;
    write_file(folder.path() / "a.svg", svg);
    const Ran parsed =
        run_shell("python3 -c 'import sys, xml.dom.minidom as m; m.parse(sys.argv[1])' " +
                  shell_quoted((folder.path() / "a.svg").string()));
    INFO(parsed.err);
    CHECK(parsed.exit_code == 0);
  }
}

TEST_CASE("an SVG tells its title and description, and refers to nothing outside itself") {
  if (!gnuplot_is_there()) return;
  Figure figure = figure_with("plain");
  figure.title = "Speed & height";
  figure.description = "a < b";
  const std::string svg = render(figure, FigureFormat::svg, run_gnuplot);
  CHECK_THAT(svg, Contains("<title id=\"trial-title\">Speed &amp; height</title>"));
  CHECK_THAT(svg, Contains("<desc id=\"trial-desc\">a &lt; b</desc>"));
  CHECK_THAT(svg, Contains("role=\"img\""));
  for (const char* reference : {"href='http", "href=\"http", "url(http", "<image", "<a "}) {
    CHECK(svg.find(reference) == std::string::npos);
  }
}

TEST_CASE("a figure is as wide as asked, with letters of the same size") {
  if (!gnuplot_is_there()) return;
  const Figure figure = figure_with("x");
  for (const double width : {85.0, 170.0}) {
    FigureSize size;
    size.width_mm = width;
    const std::string svg = render(figure, FigureFormat::svg, run_gnuplot, size);
    const int pixels = int(std::lround(width / 25.4 * 96));
    CHECK_THAT(svg, Contains("width=\"" + std::to_string(pixels) + "\""));
    CHECK_THAT(svg, Contains("font-size=\"10.00\""));
  }
}

TEST_CASE("each suffix has its format, and an unknown one is refused with the nearest") {
  CHECK(figure_format("a.svg", "--output") == FigureFormat::svg);
  CHECK(figure_format("/tmp/x.y/a.png", "--output") == FigureFormat::png);
  CHECK(figure_format("a.b.pdf", "--output") == FigureFormat::pdf);
  CHECK(figure_format("a.gp", "--output") == FigureFormat::script);
  CHECK(figure_format("a.txt", "--output") == FigureFormat::text);
  CHECK_THROWS_WITH(figure_format("a.svgz", "--output"), Contains("\".svg\""));
  CHECK_THROWS_AS(figure_format("folder.svg/file", "--output"), InputError);
  CHECK_THROWS_AS(figure_format("", "--output"), InputError);
}

TEST_CASE("the outline of a series keeps its ends, extremes and gaps") {
  each_random(20, [](Random& random) {
    std::vector<double> x;
    std::vector<double> y;
    double at = random.uniform(0, 100);
    const int samples = random.integer(2, 5000);
    for (int i = 0; i < samples; ++i) {
      x.push_back(at += random.uniform(0.05, 0.15));
      y.push_back(random.uniform(-1, 1));
    }
    const gnuplot::Series drawn = gnuplot::outline(x, y, 100);
    REQUIRE(drawn.x.size() == drawn.y.size());
    CHECK(drawn.x.size() <= 4 * 110);
    CHECK(drawn.x.front() == x.front());
    CHECK(drawn.y.back() == y.back());
    CHECK(std::is_sorted(drawn.x.begin(), drawn.x.end()));
    CHECK(*std::max_element(drawn.y.begin(), drawn.y.end()) ==
          *std::max_element(y.begin(), y.end()));
    CHECK(*std::min_element(drawn.y.begin(), drawn.y.end()) ==
          *std::min_element(y.begin(), y.end()));
  });
  std::vector<double> x;
  for (int i = 0; i < 100; ++i) x.push_back(i < 50 ? 0.1 * i : 100 + 0.1 * i);
  const gnuplot::Series drawn = gnuplot::outline(x, x, 10);
  CHECK(std::count_if(drawn.y.begin(), drawn.y.end(), [](double v) { return std::isnan(v); }) == 1);
}

TEST_CASE("ticks are round and few") {
  each_random(50, [](Random& random) {
    const double lo = random.uniform(-1e3, 1e3);
    const double length = random.magnitude(1e-6, 1e6);
    const int most = random.integer(2, 8);
    const std::string command = gnuplot::set_tics("x", {lo, lo + length}, most);
    double step = 0;
    REQUIRE(std::sscanf(command.c_str(), "set xtics %lf", &step) == 1);
    CHECK(length / step <= most * (1 + 1e-6));
    CHECK(length / step > most / 2.6);
    const double digit = step / std::pow(10, std::floor(std::log10(step * (1 + 1e-9))));
    CHECK(std::abs(digit - std::round(digit)) < 1e-5);
    CHECK(((std::lround(digit) == 1) || (std::lround(digit) == 2) || (std::lround(digit) == 5)));
  });
}

TEST_CASE("at most so many samples are drawn, and all where there are few") {
  CHECK(gnuplot::thinning(100, 700) == 1);
  CHECK(gnuplot::thinning(700, 700) == 1);
  CHECK(gnuplot::thinning(701, 700) == 2);
  CHECK(gnuplot::thinning(3396, 700) == 5);
}
