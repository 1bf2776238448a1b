// The only file that sees CLI11, which takes long to compile.

#include "cli/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <map>

#include "cli/commands.hpp"
#include "io/checked_values.hpp"
#include "io/closest_name.hpp"

namespace tethercalc::cli {
namespace {

/// What a command runs once its arguments are parsed.
using Action = std::function<int()>;

Format parse_format(const std::string& text) {
  const std::vector<std::string> names{"table", "json", "csv"};  // as in Format
  const auto found = std::find(names.begin(), names.end(), text);
  if (found != names.end()) return static_cast<Format>(found - names.begin());
  throw InputError("--format", "\"" + text + "\" is not a format; allowed are table, json and csv" +
                                   did_you_mean(text, names));
}

void add_output_file(CLI::App& command, Output& output) {
  command.add_option("--output", output.file, "Write to this file, whole or not at all");
}

/// Adds --format and --output.
void add_output(CLI::App& command, Output& output) {
  command.add_option_function<std::string>(
      "--format", [&output](const std::string& text) { output.format = parse_format(text); },
      "table (default), json or csv");
  add_output_file(command, output);
}

/// An option that takes one value, each time it is given.
void add_repeatable(CLI::App& command, const std::string& name, std::vector<std::string>& values,
                    const std::string& help) {
  command.add_option(name, values, help)->allow_extra_args(false);
}

void add_spec(CLI::App& command, SpecOptions& spec) {
  command.add_option("SPEC", spec.file, "Design spec (JSON), - for standard input")->required();
  add_repeatable(command, "--set", spec.overrides,
                 "Change a field of the spec: path=value, such as supply.voltage_V=60; repeatable");
}

/// The options that say which part of a flight counts and what is known about it.
void add_flight(CLI::App& command, FlightOptions& flight) {
  command.add_option("--mass-g", flight.mass_g, "Mass of the drone as flown, in g");
  command.add_option("--from", flight.from, "First sample: seconds (120) or percent (25%)");
  command.add_option("--to", flight.to, "Last sample; with neither, the moving part is used");
  command.add_option("--pitch-offset-deg", flight.pitch_offset_deg,
                     "Pitch that the log shows in level flight, nose-up");
  command.add_option("--trim-log", flight.trim_log, "Hover flight whose mean pitch is that offset");
  command.add_option("--air-density", flight.air_density_kg_m3, "In kg/m³ (default 1.293)");
  command.add_option("--pressure-hPa", flight.pressure_hPa, "For the air density, with");
  command.add_option("--temperature-C", flight.temperature_C, "the air temperature");
  command.add_option("--core", flight.core, "EKF core to read (default 0)")
      ->check(CLI::Range(0, 255));
}

void add_comma_list(CLI::App& command, const std::string& name, std::vector<std::string>& values,
                    const std::string& help) {
  command.add_option(name, values, help)->delimiter(',')->allow_extra_args(false);
}

/// The options that name measured logs and say how to look at them.
void add_logs(
    CLI::App& command, DiagnoseOptions& logs, const std::string& flight_help,
    const std::string& power_help,
    const std::string& base_help = "Effects taken as part of the base model, EFFECT[,EFFECT...]") {
  command.add_option("--flight", logs.flight_log, flight_help);
  command.add_option("--power", logs.power_log, power_help);
  add_comma_list(command, "--base", logs.base, base_help);
  add_flight(command, logs.flight);
}

/// The commands and their options. Kept alive until the chosen action has run.
class CommandLine {
 public:
  CommandLine() : app_("Design calculator for drones powered through a tether.", "tethercalc") {
    app_.set_version_flag("--version", std::string("tethercalc ") + TETHERCALC_VERSION);
    app_.require_subcommand(1);
    add_optimize();
    add_evaluate();
    add_compare();
    add_sweep();
    add_check();
    add_design();
    add_envelope();
    add_validate();
    add_texts();
    add_drag();
    add_diagnose();
    add_log();
    add_plot();
    add_report();
    app_.footer("Exit codes: 0 done; 1 the honest answer is no; 2 bad input; 3 internal error.");
  }

  int run(int argc, const char* const* argv) {
    check_command(argc, argv);
    arguments_ = {argv, argv + argc};
    try {
      app_.parse(argc, argv);
    } catch (const CLI::Success& help) {
      return app_.exit(help);
    } catch (const CLI::ParseError& error) {
      const auto chosen = app_.get_subcommands();
      const std::string name = chosen.empty() ? "" : " " + chosen.front()->get_name();
      throw InputError("tethercalc" + name,
                       std::string(error.what()) + " (see tethercalc" + name + " --help)");
    }
    const CLI::App* command = app_.get_subcommands().front();
    check_extras(*command);
    return actions_.at(command->get_name())();
  }

 private:
  CLI::App& add(const std::string& name, const std::string& help, Action action) {
    CLI::App& command = *app_.add_subcommand(name, help);
    command.allow_extras();  // told with the closest known option in check_extras
    actions_[name] = std::move(action);
    return command;
  }

  void add_optimize() {
    CLI::App& command = add("optimize", "Which conductor cross-section to fly, and what limits it",
                            [this] { return run_optimize(spec_, output_); });
    add_spec(command, spec_);
    add_output(command, output_);
  }

  void add_evaluate() {
    CLI::App& command =
        add("evaluate", "Operating points in hover and forward flight at given cross-sections",
            [this] { return run_evaluate(spec_, areas_, output_); });
    add_spec(command, spec_);
    add_comma_list(command, "--area-mm2", areas_, "Cross-sections of one conductor, X[,Y...]");
    add_output(command, output_);
  }

  void add_compare() {
    CLI::App& command = add("compare", "One optimum a motor, the most economical first",
                            [this] { return run_compare(spec_, motors_, output_); });
    add_spec(command, spec_);
    add_comma_list(command, "--motors", motors_,
                   "all, or names of the library and files, separated by commas (default: all)");
    add_output(command, output_);
  }

  void add_sweep() {
    CLI::App& command =
        add("sweep", "One row a design, for every combination or a sample of values",
            [this] { return run_sweep(sweep_); });
    add_spec(command, sweep_.spec);
    add_repeatable(command, "--vary", sweep_.varied,
                   "path=from:to:step, path=a,b,c or path=all; in a sample also path=lo..hi "
                   "(uniform) and path=mean~sd (normal); repeatable, the last changes fastest");
    command.add_option("--sample", sweep_.sample, "Draw N designs instead of every combination");
    command.add_option("--method", sweep_.method, "sobol (default) or lhs, a Latin hypercube");
    command.add_option("--seed", sweep_.seed, "Of the sample (default 0)");
    command.add_option("--summary", sweep_.summary_file, "Write a sample's summary here as JSON");
    command.add_option("--format", sweep_.format, "csv (default) or jsonl, JSON Lines");
    command.add_option("--output", sweep_.file, "Write rows to this file as they are computed");
    command.add_flag("--resume", sweep_.resume, "Continue what --output holds from an earlier run");
    command.add_option("--shard", sweep_.shard,
                       "i/n: only the i-th of n equal parts; joined they are the whole sweep");
    command.add_option("--jobs", sweep_.jobs, "Threads (default: one a core)");
  }

  void add_check() {
    CLI::App& command = add("check", "Reference designs against their recorded results",
                            [this] { return run_check(check_, output_); });
    command.add_option("PATH", check_.paths, "Folders of specs, or specs")->required();
    command.add_flag("--update", check_.update, "Bring the records up to date");
    command.add_option("--junit", check_.junit_file, "Write a JUnit XML report here");
    add_output(command, output_);
  }

  void add_design() {
    CLI::App& command = add("design", "The best whole design among those that free fields allow",
                            [this] { return run_design(spec_, request_, output_); });
    add_spec(command, spec_);
    add_repeatable(
        command, "--free", request_.free,
        "A field the search may change: PATH=lo..hi, or what --vary of sweep takes; repeatable");
    command.add_option("--minimize", request_.minimize,
                       "Key of a result or path of a field (default: total_power_W)");
    add_repeatable(command, "--subject-to", request_.subject_to,
                   "A demand beside the spec's: 'KEY<=VALUE' or 'KEY>=VALUE'; repeatable");
    command.add_option("--standard", request_.standard,
                       "awg or iec: the cross-section is one of these sizes");
    add_comma_list(command, "--pareto", request_.pareto, "KEY,KEY: the front of two quantities");
    command.add_option("--seed", request_.seed, "Of the points from which the search starts");
    add_output(command, output_);
  }

  void add_envelope() {
    CLI::App& command =
        add("envelope", "How high, how heavy, how fast and in how much wind a given cable flies",
            [this] { return run_envelope(spec_, areas_, output_); });
    add_spec(command, spec_);
    add_repeatable(command, "--area-mm2", areas_,
                   "Cross-section of one conductor (default: the spec's tether.cross_section_mm2)");
    add_output(command, output_);
  }

  void add_validate() {
    CLI::App& command = add("validate", "Check specs without computing anything",
                            [this] { return run_validate(files_, spec_.overrides, output_); });
    command.add_option("SPEC", files_, "Design specs (JSON), - for standard input")->required();
    add_repeatable(command, "--set", spec_.overrides,
                   "Change a field first: path=value; repeatable");
    add_output(command, output_);
  }

  /// What is printed as it stands: the schema, a starting spec, the library.
  void add_texts() {
    const auto add_text = [this](const char* name, const char* help, const auto& text) {
      add_output_file(add(name, help,
                          [this, text] {
                            emit(output_, text());
                            return done;
                          }),
                      output_);
    };
    add_text("schema", "The JSON Schema of design specs, for editors",
             [] { return json_text(spec_schema()); });
    add_text("init", "A starting spec to edit", starting_spec);
    CLI::App& list = add("list", "The library: motors, conductors, insulation or sizes",
                         [this] { return run_list(what_, output_); });
    list.add_option("WHAT", what_, "motors, conductors, insulation or sizes")->required();
    add_output(list, output_);
  }

  void add_drag() {
    CLI::App& command = add("drag", "The drone's drag, learned from its own flight logs",
                            [this] { return run_drag(files_, flight_, what_, output_); });
    command.add_option("LOG", files_, "Flight logs: DataFlash (.bin) or CSV")->required();
    add_flight(command, flight_);
    command.add_option("--into", what_,
                       "Print this spec with its drag replaced, instead of the fit");
    add_output(command, output_);
  }

  void add_diagnose() {
    CLI::App& command =
        add("diagnose", "What the simulation of a measured flight gets wrong, and why", [this] {
          diagnose_.into = app_.get_subcommand("diagnose")->count("--into") > 0;
          return run_diagnose(diagnose_, output_);
        });
    add_spec(command, diagnose_.spec);
    add_logs(command, diagnose_, "Flight log: DataFlash (.bin) or CSV", "Power log (CSV)");
    command
        .add_option("--into", diagnose_.into_file,
                    "Write the extended spec to this file; without a name print it instead of the "
                    "diagnosis")
        ->expected(0, 1);
    add_output(command, output_);
  }

  void add_log() {
    CLI::App& command = add("log", "What a DataFlash log holds",
                            [this] { return run_log(what_, message_, output_); });
    command.add_option("LOG", what_, "DataFlash log (.bin)")->required();
    command.add_option("--csv", message_, "Export all messages of this name, such as XKF1");
    add_output(command, output_);
  }

  void add_plot() {
    CLI::App& command = add("plot", "A figure of a result, drawn by gnuplot", [this] {
      for (const CLI::Option* option : app_.get_subcommand("plot")->get_options()) {
        if (option->count() > 0) plot_.given.push_back(option->get_name());
      }
      return run_plot(plot_, output_);
    });
    command.add_option("KIND", plot_.kind, plot_kinds_help())->required();
    command.add_option("FILE", plot_.files, "What it is drawn from")->required();
    add_repeatable(command, "--set", plot_.made_of.spec.overrides,
                   "Change a field of the spec: path=value; repeatable");
    command.add_option("--output", output_.file,
                       "F.svg, .png, .pdf, .gp (the gnuplot script) or .txt; without it the figure "
                       "is drawn with characters, as wide as the terminal (COLUMNS, else 100)");
    command.add_option("--title", plot_.title,
                       "Words above the figure (default: the design's or the file's name)");
    command.add_option("--width-mm", plot_.width_mm,
                       "Width of the figure, 85 to 400 (default: 85, one column of a journal)");
    add_comma_list(command, "--motors", plot_.motors,
                   "motors: all, or names of the library and files, separated by commas");
    command.add_option("--view", plot_.view,
                       "drag: speed (default), or surface over airspeed and tilt");
    command.add_option("--x", plot_.x, "sweep: the varied field along the horizontal axis");
    command.add_option("--y", plot_.y, "sweep: the varied field along the vertical axis");
    command.add_option("--value", plot_.value,
                       "sweep: the column shown (default: forward.total_power_W)");
    add_logs(command, plot_.made_of, "diagnosis: the flight log", "diagnosis: the power log",
             "diagnosis: effects taken as part of the base model");
  }

  void add_report() {
    CLI::App& command =
        add("report", "One page with everything about a design, to be mailed or printed",
            [this] { return run_report(diagnose_, shell_command(arguments_), output_); });
    add_spec(command, diagnose_.spec);
    add_logs(command, diagnose_, "With what this flight log says: DataFlash (.bin) or CSV",
             "With what this power log says (CSV)");
    add_output_file(command, output_);
  }

  /// A mistyped command gets the closest one instead of CLI11's "argument was not expected".
  void check_command(int argc, const char* const* argv) const {
    if (argc < 2)
      throw InputError("tethercalc", "a command is needed (tethercalc --help lists them)");
    if (argv[1][0] == '-') return;
    std::vector<std::string> names;
    for (const auto& [name, action] : actions_) names.push_back(name);
    const std::string given = argv[1];
    if (actions_.count(given) == 0) {
      throw InputError("tethercalc", "there is no command \"" + given + "\"" +
                                         did_you_mean(given, names) +
                                         " (tethercalc --help lists them)");
    }
  }

  static void check_extras(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    Problems problems;
    bool after_option = false;  // what follows an unknown option is probably its value
    for (const std::string& extra : command.remaining()) {
      const std::string given = extra.substr(0, extra.find('='));
      const bool option = given.starts_with("-");
      if (option) {
        problems.add("tethercalc " + command.get_name(),
                     "there is no option " + given + did_you_mean(given, names));
      } else if (!after_option) {
        problems.add("tethercalc " + command.get_name(),
                     "\"" + extra + "\" is one argument too many");
      }
      after_option = option && given == extra;
    }
    problems.throw_if_any();
  }

  CLI::App app_;
  std::map<std::string, Action> actions_;
  Output output_;
  SpecOptions spec_;
  SweepOptions sweep_;
  CheckOptions check_;
  std::vector<std::string> areas_;
  std::vector<std::string> motors_{"all"};
  DesignRequest request_;
  std::vector<std::string> files_;
  std::string what_;
  FlightOptions flight_;
  DiagnoseOptions diagnose_;
  std::span<const char* const> arguments_;  ///< what was typed, the program's name first
  std::string message_;
  PlotOptions plot_;
};

}  // namespace

int run(int argc, const char* const* argv) { return CommandLine().run(argc, argv); }

}  // namespace tethercalc::cli
