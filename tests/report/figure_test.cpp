#include "tethercalc/report/figure.hpp"
#include "tethercalc/files/gnuplot.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <limits>
#include <optional>
#include <sstream>

#include "report/figure_data.hpp"
#include "report/figure_gnuplot.hpp"
#include "report/figure_ticks.hpp"
#include "support/figures.hpp"
#include "support/random.hpp"
#include "support/run_program.hpp"
#include "tethercalc/io/input_error.hpp"

using namespace tethercalc;
using namespace tethercalc::test;
using Catch::Contains;
using Catch::StartsWith;

namespace {

/// A line from 0 to 1 with the text in every place that a figure has for one.
Figure figure_with(const std::string& text) {
  plot::Panel panel{.title = text,
                    .x = {.label = text},
                    .y = {.label = text},
                    .layers = {plot::Curve{.x = {0, 1}, .y = {0, 1}, .words = text},
                               plot::Note{.x = 0.5, .y = 0.2, .words = text}},
                    .key = {text}};
  return {.id = "trial",
          .title = text,
          .description = text,
          .parts = {panel, plot::Bars{text, {{text, 0.5, "50 %", plot::Colour::blue}}},
                    plot::Lines{text, {text}}}};
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

TEST_CASE("whatever bytes a text has, gnuplot is given one quoted line") {
  CHECK(rc::check("a text and nothing else", [] {
    const std::string text = *rc::gen::container<std::string>(
        rc::gen::oneOf(rc::gen::arbitrary<char>(), rc::gen::elementOf(std::string("'\"`\\.ab"))));
    const auto shown = value_of(gnuplot_text(text));
    RC_ASSERT(shown);
    RC_ASSERT(characters_of(*shown) <= text.size());
    RC_ASSERT(std::none_of(shown->begin(), shown->end(),
                           [](char c) { return static_cast<unsigned char>(c) < 0x20; }));
    const bool plain =
        std::all_of(text.begin(), text.end(), [](char c) { return c >= 0x20 && c < 0x7F; });
    if (plain) RC_ASSERT(*shown == text);
  }));
}

TEST_CASE("a hostile text is shown as it is, and gnuplot runs nothing of it") {
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
    FigureSize wide;
    wide.width_mm = 300;
    const std::string svg = render(figure_with(text), FigureFormat::svg, {}, wide);
    CHECK(svg.find("<script") == std::string::npos);
    CHECK(svg.find("]]>") == std::string::npos);
    const std::vector<std::string> shown = texts_of(svg);
    CHECK(std::count(shown.begin(), shown.end(), text) >= 8);
    if (!gnuplot_is_there()) continue;
    CHECK_THAT(render(figure_with(text), FigureFormat::pdf, run_gnuplot), StartsWith("%PDF-"));
    CHECK(watched.untouched());
  }
}

TEST_CASE("control characters, broken UTF-8 and 300 characters do no harm to an SVG") {
  for (const std::string& text :
       {std::string("one\ntwo\r\nthree\tfour"), std::string("bell\a escape\x1b[31m nul\0!", 24),
        std::string("half \xC3 and \xFF\xFE"), std::string(300, 'W'),
        std::string("\u202Eesrever")}) {
    const std::string svg = render(figure_with(text), FigureFormat::svg, {});
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
  Figure figure = figure_with("plain");
  figure.title = "Speed & height";
  figure.description = "a < b";
  const std::string svg = render(figure, FigureFormat::svg, {});
  CHECK_THAT(svg, Contains("<title id=\"trial-title\">Speed &amp; height</title>"));
  CHECK_THAT(svg, Contains("<desc id=\"trial-desc\">a &lt; b</desc>"));
  CHECK_THAT(svg, Contains("role=\"img\""));
  for (const char* reference : {"href='http", "href=\"http", "url(http", "<image", "<a "}) {
    CHECK(svg.find(reference) == std::string::npos);
  }
}

TEST_CASE("a figure is as wide as asked, with letters of the same size") {
  const Figure figure = figure_with("x");
  for (const double width : {85.0, 170.0}) {
    FigureSize size;
    size.width_mm = width;
    const std::string svg = render(figure, FigureFormat::svg, {}, size);
    const int pixels = int(std::lround(width / 25.4 * 96));
    CHECK_THAT(svg, Contains("width=\"" + std::to_string(pixels) + "\""));
    CHECK_THAT(svg, Contains("font-size=\"10\""));
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
    const plot::Series drawn = plot::outline(x, y, 100);
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
  const plot::Series drawn = plot::outline(x, x, 10);
  CHECK(std::count_if(drawn.y.begin(), drawn.y.end(), [](double v) { return std::isnan(v); }) == 1);
}

TEST_CASE("ticks are round, few, and at least two") {
  each_random(200, [](Random& random) {
    const double lo = random.uniform(-1e3, 1e3);
    const double length = random.magnitude(1e-3, 1e6);
    const int most = random.integer(2, 8);
    const auto ticks = plot::round_ticks({lo, lo + length}, most, plot::Minus::hyphen);
    REQUIRE(ticks.size() >= 2);
    // Of a step of 5 there may be one tick; then up to five of the next one, 2, are within.
    CHECK(ticks.size() <= std::max<std::size_t>(most + 2, 5));
    const double step = ticks[1].at - ticks[0].at;
    const double digit = step / std::pow(10, std::floor(std::log10(step * (1 + 1e-9))));
    CHECK(std::abs(digit - std::round(digit)) < 1e-5);
    CHECK(((std::lround(digit) == 1) || (std::lround(digit) == 2) || (std::lround(digit) == 5)));
    for (const plot::Tick& tick : ticks) {
      CHECK(tick.at >= lo - 1e-6 * length);
      CHECK(tick.at <= lo + length * (1 + 1e-6));
      CHECK(std::stod(tick.words) == Approx(tick.at).margin(1e-6 * step));
    }
  });
}

TEST_CASE("every axis has two numbers or more, linear or logarithmic, and none touch") {
  const auto length_of = [](std::string_view words) { return 6.4 * double(words.size()); };
  each_random(300, [&](Random& random) {
    plot::Axis axis;
    axis.logarithmic = random.integer(0, 1) == 1;
    axis.range.lo = random.magnitude(1e-3, 1e3);
    axis.range.hi = axis.range.lo * (1 + random.magnitude(1e-2, 1e4));
    const double width = random.uniform(120, 600);
    const auto ticks = plot::ticks_of(axis, width, 4, plot::Minus::hyphen, length_of);
    INFO(axis.range.lo << " to " << axis.range.hi << (axis.logarithmic ? ", logarithmic" : ""));
    CHECK(ticks.size() >= 2);
    for (std::size_t i = 1; i < ticks.size(); ++i) {
      const double apart =
          width * (plot::along(axis, ticks[i].at) - plot::along(axis, ticks[i - 1].at));
      CHECK(apart > (length_of(ticks[i].words) + length_of(ticks[i - 1].words)) / 2);
    }
  });
}

TEST_CASE("numbers below zero have a minus sign on paper and a hyphen on a terminal") {
  Figure figure = figure_with("x");
  std::get<plot::Panel>(figure.parts[0]).y.range = {-10, 10};
  const std::string svg = render(figure, FigureFormat::svg, {});
  CHECK(shows(svg, "\u221210"));
  CHECK_FALSE(shows(svg, "-10"));
  const std::string text = render(figure, FigureFormat::text, {});
  CHECK_THAT(text, Contains(" -10 +"));
  CHECK(text.find("\u2212") == std::string::npos);
}

TEST_CASE("letters in a PDF are 7.5 points high, as those of an SVG are") {
  if (!gnuplot_is_there()) return;
  // Text matrices (ISO 32000-1, 9.4.2) of all streams, which are deflated.
  const TemporaryFolder folder;
  write_file(folder.path() / "sizes.py", R"(import re, sys, zlib
found = set()
for stream in re.findall(rb"stream\r?\n(.*?)endstream", open(sys.argv[1], "rb").read(), re.S):
    try:
        text = zlib.decompress(stream)
    except zlib.error:
        continue
    found.update(map(float, re.findall(rb"^([0-9.]+) 0 0 -?[0-9.]+ [-0-9.]+ [-0-9.]+ Tm", text, re.M)))
print(*sorted(found))
)");
  for (const double width : {85.0, 170.0}) {
    FigureSize size;
    size.width_mm = width;
    write_file(folder.path() / "a.pdf",
               render(figure_with("plain"), FigureFormat::pdf, run_gnuplot, size));
    const Ran sizes = run_shell("python3 " + shell_quoted((folder.path() / "sizes.py").string()) +
                                " " + shell_quoted((folder.path() / "a.pdf").string()));
    INFO(sizes.err);
    CHECK(sizes.out == "7.5\n");
  }
}

TEST_CASE("names in scripts without a font leave the figure its room") {
  // Wide characters, each shown as a box where there is no font for it.
  for (const std::string one : {"\u7F06", "\U0001F681"}) {
    std::string name;
    for (int i = 0; i < 40; ++i) name += one;
    const Figure figure = figure_with(name);
    CHECK(layout_problems(render(figure, FigureFormat::svg, {})) == no_problems);
    const std::string text = render(figure, FigureFormat::text, {}, {85, 60, false});
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      const auto wide = std::count_if(line.begin(), line.end(), [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return byte >= 0xE3 && byte <= 0xF4;
      });
      CHECK(characters_of(line) + std::size_t(wide) <= 60);
    }
    // gnuplot is given no more than has room: a box is as wide as high or wider.
    const std::string script = render(figure, FigureFormat::script, {});
    std::size_t longest = 0;
    std::istringstream commands(script);
    for (std::string line; std::getline(commands, line);) {
      if (!line.starts_with("set label")) continue;
      std::size_t count = 0;
      for (std::size_t k = 0; (k = line.find(one, k)) != std::string::npos; k += one.size()) {
        ++count;
      }
      longest = std::max(longest, count);
    }
    CHECK(longest > 5);
    CHECK(double(longest) * 12.5 < 85 / 25.4 * 96);
  }
}

TEST_CASE("what no font has is a box in a PNG and covers nothing") {
  if (!gnuplot_is_there()) return;
  // For private use of anybody, in the last plane: no font has it.
  const std::string none = "\U0010FF00\U0010FF01 h\u00E9llo \u0394";
  const std::string boxes = "\u25A1\u25A1 h\u00E9llo \u0394";
  const auto labelled = [](const std::string& text) {
    return "set terminal pngcairo noenhanced size 400,200\nset label 1 " + gnuplot_text(text) +
           " at screen 0.1,0.5\nplot [0:1] x notitle\n";
  };
  CHECK(run_gnuplot(labelled(none)) == run_gnuplot(labelled(boxes)));
  CHECK(run_gnuplot(labelled("hello")) != run_gnuplot(labelled(boxes)));
}

TEST_CASE("an SVG takes every colour from a class, for a page to exchange") {
  const std::string svg = render(figure_with("x"), FigureFormat::svg, {});
  for (const char* own : {"stroke=\"#", "fill=\"#", "stroke=\"black", "fill=\"black", "style="}) {
    CHECK(svg.find(own) == std::string::npos);
  }
  CHECK_THAT(svg, Contains("class=\"blue\" color=\"#0072B2\" fill=\"currentColor\""));
  CHECK_THAT(svg, Contains("class=\"paper\" color=\"#ffffff\" fill=\"currentColor\""));
}

TEST_CASE("a line of characters goes where its numbers are, and colours change nothing else") {
  const Figure figure = figure_with("x");
  const std::string plain = render(figure, FigureFormat::text, {}, {85, 60, false});
  // The line from the lower left to the upper right corner of the frame.
  std::vector<std::string> rows;
  std::istringstream lines(plain);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t edge = line.find_first_of("|+");
    const bool frame = edge != std::string::npos && edge < 8 && line.find("---") == line.npos;
    if (frame) rows.push_back(line.substr(edge + 1));
  }
  REQUIRE(rows.size() == 14);
  CHECK(rows.front().find_first_not_of(' ') > 48);
  CHECK(rows.back().front() == '*');
  std::size_t before = 60;
  for (const std::string& row : rows) {
    const std::size_t at = row.find('*');
    REQUIRE(at != std::string::npos);
    CHECK(at < before);
    before = at;
  }
  const std::string colourful = render(figure, FigureFormat::text, {}, {85, 60, true});
  CHECK(colourful != plain);  // its bar is blue
  CHECK(std::regex_replace(colourful, std::regex("\x1b\\[[0-9;]*m"), "") == plain);
}

TEST_CASE("what lies outside of the frame is cut off where it leaves it") {
  plot::Panel panel{.x = {.range = {0, 10}}, .y = {.range = {0, 10}}};
  panel.layers = {plot::Curve{.x = {-10, 20}, .y = {-10, 20}},
                  plot::Points{.x = {-1, 11, 5}, .y = {5, 5, 50}}};
  const std::string svg =
      render({.id = "a", .title = "a", .parts = {panel}}, FigureFormat::svg, {});
  const std::regex line(
      R"re(<path d="M([\d.]+),([\d.]+)L([\d.]+),([\d.]+)" class="ink"[^>]*linejoin)re");
  const std::regex frame(R"re(<path d="M([\d.]+),([\d.]+)V([\d.]+)H([\d.]+)M)re");
  std::smatch drawn;
  std::smatch sides;
  REQUIRE(std::regex_search(svg, drawn, line));
  REQUIRE(std::regex_search(svg, sides, frame));
  CHECK(drawn[1] == sides[1]);
  CHECK(drawn[2] == sides[3]);
  CHECK(drawn[3] == sides[4]);
  CHECK(drawn[4] == sides[2]);
  CHECK(svg.find("class=\"paper\" color=\"#ffffff\" stroke") == std::string::npos);  // no marks
}

TEST_CASE("a value that does not exist is a gap in the line, in every format") {
  plot::Panel panel{.x = {.range = {0, 4}}, .y = {.range = {0, 2}}};
  panel.layers = {plot::Curve{.x = {0, 1, 2, 3, 4},
                              .y = {1, 1, std::numeric_limits<double>::quiet_NaN(), 1, 1}}};
  const Figure figure{.id = "a", .title = "a", .parts = {panel}};
  const std::string svg = render(figure, FigureFormat::svg, {});
  const std::regex two_parts("<path d=\"M[^ML]+L[^ML]+M[^ML]+L[^ML]+\" class=\"ink\"");
  CHECK(std::regex_search(svg, two_parts));
  CHECK_THAT(render(figure, FigureFormat::script, {}), Contains("1 1\n\n3 1\n"));
  CHECK(std::regex_search(render(figure, FigureFormat::text, {}),
                          std::regex("\\*{9,} {30,}\\*{9,}")));
  for (const FigureFormat format : {FigureFormat::svg, FigureFormat::text}) {
    CHECK(render(figure, format, {}).find("nan") == std::string::npos);
  }
}

TEST_CASE("at most so many samples are drawn, and all where there are few") {
  CHECK(plot::thinning(100, 700) == 1);
  CHECK(plot::thinning(700, 700) == 1);
  CHECK(plot::thinning(701, 700) == 2);
  CHECK(plot::thinning(3396, 700) == 5);
}
