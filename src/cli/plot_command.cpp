#include "cli/plot_command.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include "io/closest_name.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/report/design_figures.hpp"

namespace tethercalc::cli {
namespace {

DesignFile read_spec(const PlotOptions& options) {
  return read_design(options.files.front(), options.overrides);
}

Figure optimum(const PlotOptions& options) { return optimum_figure(study(read_spec(options))); }

Figure motors(const PlotOptions& options) {
  const DesignFile file = read_spec(options);
  const std::vector<std::string> all{"all"};
  return motors_figure(
      file,
      compare_motors(file.design, chosen_motors(options.motors.empty() ? all : options.motors)));
}

struct Kind {
  std::string_view name;
  std::string_view input;  ///< what FILE is
  std::string_view help;
  Figure (*draw)(const PlotOptions&);
};

constexpr std::array kinds{
    Kind{"optimum", "SPEC", "thrust and power over the cross-section", optimum},
    Kind{"motors", "SPEC", "efficiency of motors, with what their best tethers ask of them",
         motors},
};

const Kind& find_kind(const std::string& name) {
  std::vector<std::string> names;
  std::string list;
  for (const Kind& kind : kinds) {
    if (kind.name == name) return kind;
    names.emplace_back(kind.name);
    list += (list.empty() ? "" : ", ") + std::string(kind.name);
  }
  throw InputError("plot", "there is no kind of figure \"" + name + "\"; allowed are " + list +
                               did_you_mean(name, names));
}

/// Columns of the terminal: COLUMNS, what the terminal says, or 100 where there is none.
int text_columns() {
  constexpr int least = 40;
  constexpr int most = 400;
  if (const char* given = std::getenv("COLUMNS")) {
    const int columns = std::atoi(given);
    if (columns > 0) return std::clamp(columns, least, most);
  }
  winsize window{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 0) {
    return std::clamp<int>(window.ws_col, least, most);
  }
  return 100;
}

}  // namespace

std::string plot_kinds_help() {
  std::string out;
  for (const Kind& kind : kinds) {
    out += (out.empty() ? "" : "; ") + std::string(kind.name) + " " + std::string(kind.input) +
           ": " + std::string(kind.help);
  }
  return out;
}

int run_plot(const PlotOptions& options) {
  const Kind& kind = find_kind(options.kind);
  // Told before a long computation, not after it.
  const FigureFormat format =
      options.output.empty() ? FigureFormat::text : figure_format(options.output, "--output");
  if (options.files.size() != 1) {
    throw InputError("plot " + options.kind, "is drawn from one file: plot " + options.kind + " " +
                                                 std::string(kind.input));
  }
  if (!(options.width_mm >= 85 && options.width_mm <= 400)) {
    throw InputError("--width-mm", std::to_string(options.width_mm) +
                                       " is out of range; allowed is 85 to 400 mm");
  }
  Output output;
  output.file = options.output;
  FigureSize size;
  size.width_mm = options.width_mm;
  size.columns = text_columns();
  size.colour = style_for(output).colour;
  emit(output, render(kind.draw(options), format, size));
  return done;
}

}  // namespace tethercalc::cli
