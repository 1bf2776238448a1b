#include "tethercalc/report/figure.hpp"

#include <array>
#include <vector>

#include <fmt/format.h>

#include "io/closest_name.hpp"
#include "report/figure_characters.hpp"
#include "report/figure_gnuplot.hpp"
#include "report/figure_svg.hpp"
#include "tethercalc/io/input_error.hpp"

namespace tethercalc {

void check_figure_width(double width_mm, const std::string& where) {
  if (width_mm >= 85 && width_mm <= 400) return;
  throw InputError(where, fmt::format("{} is out of range; allowed is 85 to 400 mm", width_mm));
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
  switch (format) {
    case FigureFormat::svg:
      return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n" +
             plot::svg_element(figure, size.width_mm);
    case FigureFormat::text:
      return plot::character_figure(figure, size.columns, size.colour);
    case FigureFormat::script:
      return gnuplot_script(figure, format, size.width_mm);
    case FigureFormat::png:
    case FigureFormat::pdf:
      return gnuplot(gnuplot_script(figure, format, size.width_mm));
  }
  return "";
}

}  // namespace tethercalc
