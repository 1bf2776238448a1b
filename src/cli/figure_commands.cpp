#include "cli/commands.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "files/input_files.hpp"
#include "files/logs_in_files.hpp"
#include "io/checked_values.hpp"
#include "io/closest_name.hpp"
#include "tethercalc/files/gnuplot.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/io/log_readers.hpp"
#include "tethercalc/io/rule_books.hpp"
#include "tethercalc/report/design_report.hpp"
#include "tethercalc/report/report_page.hpp"
#include "tethercalc/report/result_figures.hpp"
#include "tethercalc/report/rules_report.hpp"
#include "tethercalc/report/sweep_figure.hpp"

namespace tethercalc::cli {
namespace {

/// The heading asked for, or `otherwise`.
std::string heading(const PlotOptions& options, std::string otherwise) {
  return options.title.empty() ? std::move(otherwise) : options.title;
}

DesignFile titled_spec(const PlotOptions& options) {
  DesignFile file = read_spec({options.files.front(), options.made_of.spec.overrides});
  file.name = heading(options, file.name);
  return file;
}

/// A figure, and the exit code that goes with what it shows.
struct Drawn {
  Figure figure;
  int exit_code = done;
};

Drawn optimum(const PlotOptions& options) {
  const DesignFile file = titled_spec(options);
  remark_warnings("plot optimum", spec_warnings(file));
  const OptimumStudy study = study_optimum(file.design, wire_sizes());
  return {optimum_figure(file.name, study, area_curve(study)),
          study.result.feasible ? done : answer_is_no};
}

Drawn motors(const PlotOptions& options) {
  const DesignFile file = titled_spec(options);
  const auto ranking =
      compare_motors(file.design, chosen_motors(options.motors, file, files_in("")));
  const bool any = !ranking.empty() && ranking.front().result.feasible;
  return {motors_figure(file, ranking), any ? done : answer_is_no};
}

Drawn log(const PlotOptions& options) {
  const std::string& file = options.files.front();
  FlightOptions flight = options.made_of.flight;
  if (!flight.mass_g) flight.mass_g = 1000;  // accelerations do not depend on it
  try {
    return {log_figure(
        heading(options, base_name(file)),
        observe_part(read_flight_logs({file}, flight, logs_in_files(), note_on_error).front(),
                     identification_options(flight, logs_in_files())))};
  } catch (const UnsuitableFlight& error) {
    throw InputError(file, error.what());
  }
}

Drawn drag(const PlotOptions& options) {
  const std::vector<std::string> views{"speed", "surface"};
  const bool surface = options.view == "surface";
  if (!surface && !options.view.empty() && options.view != "speed") {
    throw InputError("--view",
                     fmt::format("\"{}\" is no view of drag; allowed are speed and surface{}",
                                 options.view, did_you_mean(options.view, views)));
  }
  DragStudy fitted = learn_drag("plot drag", options.files, options.made_of.flight).study;
  fitted.name = heading(options, fitted.name);
  return {surface ? drag_surface_figure(fitted) : drag_figure(fitted)};
}

Drawn diagnosis(const PlotOptions& options) {
  const DiagnoseOptions how = with_both_halves(options.made_of);
  if (how.flight_logs.empty() == how.power_logs.empty()) {
    throw InputError("plot diagnosis", "draws one log: --flight LOG or --power LOG");
  }
  const std::string log = heading_of(how.power_logs.empty() ? how.flight_logs : how.power_logs);
  const AnsweredDiagnosis told = diagnose_logs(how, titled_spec(options));
  try {
    return {diagnosis_figure(heading(options, log), told.flight ? *told.flight : *told.power)};
  } catch (const std::invalid_argument& error) {
    throw InputError(log, error.what());
  }
}

Drawn sweep(const PlotOptions& options) {
  const std::string& file = options.files.front();
  const MappedFile content(file == "-" ? "/dev/stdin" : file);
  return {sweep_figure(
      parse_sweep_csv(content.text(), file == "-" ? "standard input" : file, options.value),
      {options.x, options.y, heading(options, base_name(file))})};
}

Drawn shape(const PlotOptions& options) {
  ShapeOptions how = options.shape;
  how.spec = {options.files.front(), options.made_of.spec.overrides};
  const AskedShapes asked = asked_shapes(how, read_spec(how.spec));
  std::vector<ShapeStudy> studies;
  for (const ShapeRequest& request : asked.requests) {
    studies.push_back(study_cable_shape(asked.file.design, asked.area, request));
  }
  for (const std::string& sentence : undrawn_sentences(asked.requests, studies)) {
    remark("plot shape: not drawn " + sentence + "\n");
  }
  try {
    return {shape_figure(heading(options, asked.file.name), asked.requests, studies)};
  } catch (const std::invalid_argument& error) {
    throw InputError("plot shape", error.what());
  }
}

struct Kind {
  std::string_view name;
  std::string_view input;  ///< what FILE is
  std::string_view help;
  Drawn (*draw)(const PlotOptions&);
  bool many_files = false;
};

constexpr std::array kinds{
    Kind{"optimum", "SPEC", "thrust and power over the cross-section", optimum},
    Kind{"motors", "SPEC", "efficiency of motors, with what their best tethers ask of them",
         motors},
    Kind{"shape", "SPEC", "the cable as it hangs, from the side and from above", shape},
    Kind{"log", "LOG", "accelerations, drag and speed over time", log},
    Kind{"drag", "LOG...", "measured and fitted drag over airspeed", drag, true},
    Kind{"diagnosis", "SPEC", "what a log (--flight, --power) shows of the simulation's errors",
         diagnosis},
    Kind{"sweep", "CSV", "a heat map or curves from what sweep wrote", sweep},
};

const Kind& find_kind(const std::string& name) {
  const auto found = std::ranges::find(kinds, name, &Kind::name);
  if (found != kinds.end()) return *found;
  const std::vector<std::string> names = plot_kinds();
  throw InputError("plot", fmt::format("there is no kind of figure \"{}\"; allowed are {}{}", name,
                                       fmt::join(names, ", "), did_you_mean(name, names)));
}

/// An option that belongs to other kinds of figures was meant for something.
void check_options(const PlotOptions& options) {
  static const std::vector<std::pair<std::string, std::vector<std::string>>> takers{
      {"optimum, motors, shape, diagnosis", {"--set"}},
      {"shape",
       {"--area-mm2", "--height", "--offset", "--wind", "--wind-from", "--slack", "--length",
        "--winch-tension", "--stiffness", "--station-height", "--profile", "--reference-height",
        "--exponent", "--roughness"}},
      {"motors", {"--motors"}},
      {"drag", {"--view"}},
      {"diagnosis", {"--flight", "--power", "--base"}},
      {"sweep", {"--x", "--y", "--value"}},
      {"log, drag, diagnosis",
       {"--mass-g", "--from", "--to", "--pitch-offset-deg", "--trim-log", "--air-density",
        "--pressure-hPa", "--temperature-C"}}};
  Problems problems;
  for (const auto& [figures, names] : takers) {
    if (figures.find(options.kind) != std::string::npos) continue;
    for (const std::string& name : names) {
      if (std::ranges::count(options.given, name) == 0) continue;
      problems.add(name,
                   fmt::format("is an option of the figures {}, not of {}", figures, options.kind));
    }
  }
  problems.throw_if_any();
}

std::string shell_word(std::string_view word) {
  constexpr std::string_view plain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./=:,%+@-";
  if (!word.empty() && word.find_first_not_of(plain) == std::string_view::npos) {
    return std::string(word);
  }
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

std::vector<std::string> plot_kinds() {
  std::vector<std::string> names;
  for (const Kind& kind : kinds) names.emplace_back(kind.name);
  return names;
}

std::string plot_kinds_help() {
  std::string out;
  for (const Kind& kind : kinds) {
    out += fmt::format("{}{} {}: {}", out.empty() ? "" : "; ", kind.name, kind.input, kind.help);
  }
  return out;
}

int run_plot(const PlotOptions& options, const Output& output) {
  const Kind& kind = find_kind(options.kind);
  // Told before a long computation, not after it.
  const FigureFormat format =
      output.file.empty() ? FigureFormat::text : figure_format(output.file, "--output");
  if (options.files.size() != 1 && !kind.many_files) {
    throw InputError("plot " + options.kind,
                     fmt::format("is drawn from one file: plot {} {}", options.kind, kind.input));
  }
  check_options(options);
  check_figure_width(options.width_mm, "--width-mm");
  const FigureSize size{options.width_mm, std::clamp(terminal_columns(), 40, 400),
                        style_for(output).colour};
  const Drawn drawn = kind.draw(options);
  emit(output, render(drawn.figure, format, run_gnuplot, size));
  return drawn.exit_code;
}

int run_report(const DiagnoseOptions& options, const std::string& rules, const std::string& command,
               const Output& output) {
  Problems problems;
  std::optional<RuleBook> book;
  DesignFile file;
  problems.succeeds([&] { file = read_spec(options.spec); });
  if (!rules.empty()) problems.succeeds([&] { book = rule_book(rules); });
  problems.succeeds([&] { check_options_have_logs(options, !options.effect_files.empty()); });
  problems.throw_if_any();
  PageContent content{
      study_overview(file.design, wire_sizes(), chosen_motors({"alike"}, file, files_in(""))),
      file,
      {},
      {},
      {},
      command};
  if (!options.flight_logs.empty()) {
    content.drag =
        learn_drag("report", options.flight_logs, flown_as(options.flight, file.design)).study;
  }
  if (!options.flight_logs.empty() || !options.power_logs.empty()) {
    const AnsweredDiagnosis told = diagnose_logs(options, file);
    if (told.flight) content.diagnoses.push_back({heading_of(options.flight_logs), *told.flight});
    if (told.power) content.diagnoses.push_back({heading_of(options.power_logs), *told.power});
  }
  if (book) content.rules = study_rules({file.design, ruled_area(content.optimum)}, *book);
  emit(output, report_page(content));
  return content.optimum.result.feasible ? done : answer_is_no;
}

int run_rules(const SpecOptions& spec, const std::string& rules, const Output& output) {
  Problems problems;
  RuleBook book;
  DesignFile file;
  problems.succeeds([&] { file = read_spec(spec); });
  problems.succeeds([&] { book = rule_book(rules); });
  problems.throw_if_any();
  remark_warnings("rules", spec_warnings(file));
  const RuleStudy study = study_rules({file.design, ruled_area(optimum_of(file.design))}, book);
  emit(
      output, [&] { return rules_text(file.name, study, style_for(output)); },
      [&] { return rules_json(file.name, study); }, [&] { return rules_csv(study); });
  return study.count(RuleVerdict::fail) == 0 ? done : answer_is_no;
}

std::string shell_command(std::span<const char* const> arguments) {
  std::string out = "tethercalc";
  for (const char* word : arguments.subspan(1)) out += " " + shell_word(word);
  return out;
}

}  // namespace tethercalc::cli
