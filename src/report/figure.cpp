#include "tethercalc/report/figure.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "io/closest_name.hpp"
#include "report/characters.hpp"
#include "report/gnuplot_script.hpp"
#include "tethercalc/io/input_error.hpp"

namespace tethercalc {
namespace {

constexpr double font_pt = 7.5;  // of 72 to the inch
constexpr double millimetre_per_inch = 25.4;

double height_over_width(const Figure& figure) {
  return figure.lines * gnuplot::line_mm / gnuplot::column_mm;
}

/// The command that chooses and sizes the terminal.
std::string set_terminal(const Figure& figure, FigureFormat format, const FigureSize& size) {
  const double inches = size.width_mm / millimetre_per_inch;
  const double ratio = height_over_width(figure);
  switch (format) {
    case FigureFormat::svg: {
      const double pixels = 96 * inches;  // CSS pixels
      return fmt::format(
          "set terminal svg noenhanced size {:.0f},{:.0f} fixed font 'sans-serif,{}' "
          "background '#ffffff' name '{}'\ndot_scale = 0.75\n",
          pixels, pixels * ratio, font_pt * 96 / 72, figure.id);
    }
    case FigureFormat::png: {
      constexpr double dots = 300;
      constexpr double scale = dots / 96;  // gnuplot takes 96 dots for an inch here
      return fmt::format(
          "set terminal pngcairo noenhanced size {:.0f},{:.0f} font 'sans-serif,{}' fontscale {} "
          "linewidth {} pointscale {} dashlength 0.6 background '#ffffff'\n",
          dots * inches, dots * inches * ratio, font_pt, scale, scale, scale);
    }
    case FigureFormat::pdf:
    case FigureFormat::script:
      return fmt::format(
          "set terminal pdfcairo noenhanced size {:.3f}in,{:.3f}in font 'sans-serif,{}' "
          "fontscale 1 dashlength 0.6 background '#ffffff'\n",
          inches, inches * ratio, font_pt);
    case FigureFormat::text:
      return fmt::format("set terminal dumb noenhanced size {},{} {}\ncharacters = 1\n",
                         size.columns, figure.lines, size.colour ? "ansi256" : "mono");
  }
  return "";
}

/// The terminal, and how long a dot is there that is as high as its stroke is wide.
std::string preparation(const Figure& figure, FigureFormat format, const FigureSize& size) {
  return fmt::format("{}dot_length = {:.4g}\n", set_terminal(figure, format, size),
                     gnuplot::column_mm / size.width_mm);
}

/// gnuplot's SVG with title and description for those who cannot see it, and with ids that stay
/// unique where several figures stand in one page.
std::string finished_svg(const Figure& figure, std::string svg) {
  const auto replace_all = [&svg](std::string_view from, const std::string& to) {
    for (std::size_t at = 0; (at = svg.find(from, at)) != std::string::npos; at += to.size()) {
      svg.replace(at, from.size(), to);
    }
  };
  for (const char* name : {"gpDot", "gpPt", "textbox", "greybox", "gnuplot_canvas"}) {
    const std::string own = figure.id + "-" + name;
    replace_all(fmt::format("id='{}", name), "id='" + own);
    replace_all(fmt::format("id=\"{}", name), "id=\"" + own);
    replace_all(fmt::format("'#{}", name), "'#" + own);
    replace_all(fmt::format("(#{})", name), "(#" + own + ")");
  }
  replace_all("]]>", "]]&gt;");  // gnuplot leaves it, which XML allows nowhere in a text (2.4)
  const std::size_t from = svg.find("<title>");
  const std::string_view last = "</desc>";
  const std::size_t to = svg.find(last, from);
  if (from == std::string::npos || to == std::string::npos) {
    throw std::runtime_error("gnuplot wrote an SVG without title and description");
  }
  constexpr std::size_t longest_description = 2000;
  svg.replace(from, to + last.size() - from,
              fmt::format("<title id=\"{0}-title\">{1}</title>\n<desc id=\"{0}-desc\">{2}</desc>",
                          figure.id, markup_text(printable(figure.title, 200)),
                          markup_text(printable(figure.description, longest_description))));
  const std::string_view root = "<svg ";
  svg.insert(svg.find(root) + root.size(),
             fmt::format("role=\"img\" aria-labelledby=\"{0}-title {0}-desc\"", figure.id));
  return svg;
}

/// gnuplot's picture of characters without the form feed before it, the blanks at the ends of lines
/// and the empty lines around it.
std::string finished_text(std::string_view drawn) {
  constexpr std::string_view plain_again = "\x1b[0;39m";  // gnuplot's end of a colour
  std::string out;
  std::size_t empty_lines = 0;
  while (!drawn.empty()) {
    const std::size_t end = std::min(drawn.find('\n'), drawn.size());
    std::string_view line = drawn.substr(0, end);
    drawn.remove_prefix(std::min(end + 1, drawn.size()));
    while (line.starts_with('\f')) line.remove_prefix(1);
    while (line.ends_with(' ')) line.remove_suffix(1);
    if (line == plain_again) line = {};
    if (line.empty()) {
      ++empty_lines;
      continue;
    }
    if (!out.empty()) out.append(empty_lines, '\n');
    empty_lines = 0;
    out.append(line) += '\n';
  }
  return out;
}

std::string standalone_script(const Figure& figure, const FigureSize& size) {
  return fmt::format(
      "# {0}\n# Draw it with: gnuplot {1}.gp > {1}.pdf\n"
      "# For another format change the next line, such as to\n"
      "#   set terminal pngcairo size 1004,{2:.0f} noenhanced font 'sans-serif,7.5' \\\n"
      "#     fontscale 3.125 linewidth 3.125 pointscale 3.125\n{3}{4}",
      printable(figure.title, 200), figure.id, 1004 * height_over_width(figure),
      preparation(figure, FigureFormat::script, size), figure.script);
}

}  // namespace

std::string gnuplot_text(std::string_view text, std::size_t longest) {
  const std::string safe = printable(text, longest);
  std::string out;
  for (std::size_t begin = 0; begin <= safe.size();) {
    const std::size_t end = std::min(safe.find('\'', begin), safe.size());
    if (end > begin)
      out += fmt::format("{}'{}'", out.empty() ? "" : ".", safe.substr(begin, end - begin));
    if (end < safe.size()) out += fmt::format("{}\"'\"", out.empty() ? "" : ".");
    begin = end + 1;
  }
  return out.empty() ? "''" : out;
}

FigureFormat figure_format(std::string_view file, const std::string& where) {
  const std::size_t dot = file.find_last_of("./");
  const bool has_suffix = dot != std::string_view::npos && file[dot] == '.';
  const std::string suffix(has_suffix ? file.substr(dot) : "");
  constexpr std::array<std::pair<std::string_view, FigureFormat>, 5> formats{
      {{".svg", FigureFormat::svg},
       {".png", FigureFormat::png},
       {".pdf", FigureFormat::pdf},
       {".gp", FigureFormat::script},
       {".txt", FigureFormat::text}}};
  std::vector<std::string> names;
  for (const auto& [name, format] : formats) {
    if (name == suffix) return format;
    names.emplace_back(name);
  }
  throw InputError(where, fmt::format("\"{}\" does not end in .svg, .png, .pdf, .gp (a script for "
                                      "gnuplot) or .txt{}",
                                      file, did_you_mean(suffix, names)));
}

std::string render(const Figure& figure, FigureFormat format, const GnuplotRunner& gnuplot,
                   const FigureSize& size) {
  if (format == FigureFormat::script) return standalone_script(figure, size);
  std::string drawn = gnuplot(preparation(figure, format, size) + figure.script);
  if (format == FigureFormat::svg) return finished_svg(figure, std::move(drawn));
  return format == FigureFormat::text ? finished_text(drawn) : drawn;
}

}  // namespace tethercalc
