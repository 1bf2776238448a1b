// The only file that sees CLI11, which takes long to compile.

#include "cli/commands.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <map>

#include "io/checked_values.hpp"
#include "io/closest_name.hpp"

namespace tethercalc::cli {
namespace {

/// What a command runs once its arguments are parsed.
using Action = std::function<int()>;

Format parse_format(const std::string& text) {
  const std::vector<std::string> names{"table", "json", "csv"};  // as in Format
  const auto found = std::ranges::find(names, text);
  if (found != names.end()) return static_cast<Format>(found - names.begin());
  throw InputError("--format", "\"" + text + "\" is not a format; allowed are table, json and csv" +
                                   did_you_mean(text, names));
}

/// A command under construction; its options are added in the order in which help lists them.
class Command {
 public:
  explicit Command(CLI::App& app) : app_(app) {}

  template <typename Value>
  Command& option(const char* name, Value& value, const std::string& help) {
    app_.add_option(name, value, help);
    return *this;
  }

  /// What must be given, without a name.
  template <typename Value>
  Command& argument(const char* name, Value& value, const std::string& help) {
    app_.add_option(name, value, help)->required();
    return *this;
  }

  Command& flag(const char* name, bool& value, const char* help) {
    app_.add_flag(name, value, help);
    return *this;
  }

  /// An option that may be given without its value.
  Command& option_or_flag(const char* name, std::string& value, const char* help) {
    app_.add_option(name, value, help)->expected(0, 1);
    return *this;
  }

  /// An option that takes one value, each time it is given.
  Command& repeatable(const char* name, std::vector<std::string>& values, const char* help) {
    app_.add_option(name, values, help)->allow_extra_args(false);
    return *this;
  }

  Command& comma_list(const char* name, std::vector<std::string>& values, const char* help) {
    app_.add_option(name, values, help)->delimiter(',')->allow_extra_args(false);
    return *this;
  }

  Command& spec(SpecOptions& spec) {
    return argument("SPEC", spec.file, "Design spec (JSON), - for standard input")
        .repeatable(
            "--set", spec.overrides,
            "Change a field of the spec: path=value, such as supply.voltage_V=60; repeatable");
  }

  /// The options that say which part of a flight counts and what is known about it.
  Command& flight(FlightOptions& flight) {
    option("--mass-g", flight.mass_g, "Mass of the drone as flown, in g");
    option("--from", flight.from, "First sample: seconds (120) or percent (25%)");
    option("--to", flight.to, "Last sample; with neither, what is flown is used");
    option("--pitch-offset-deg", flight.pitch_offset_deg,
           "Pitch that the log shows in level flight, nose-up");
    option("--trim-log", flight.trim_log, "Hover flight whose mean pitch is that offset");
    option("--air-density", flight.air_density_kg_m3, "In kg/m³ (default 1.293)");
    option("--pressure-hPa", flight.pressure_hPa, "For the air density, with");
    option("--temperature-C", flight.temperature_C, "the air temperature");
    app_.add_option("--core", flight.core, "EKF core to read (default 0)")
        ->check(CLI::Range(0, 255));
    return *this;
  }

  /// The options that name measured logs and say how to look at them.
  Command& logs(
      DiagnoseOptions& logs, const char* flight_help, const char* power_help,
      const char* base_help = "Effects taken as part of the base model, EFFECT[,EFFECT...]") {
    return repeatable("--flight", logs.flight_logs, flight_help)
        .option("--power", logs.power_log, power_help)
        .comma_list("--base", logs.base, base_help)
        .repeatable("--effects", logs.effect_files,
                    "Your own effects to try as well (JSON); repeatable")
        .flight(logs.flight);
  }

  /// The options that say where a drone hangs on its cable, and in which air.
  Command& shape(ShapeOptions& shape) {
    return repeatable(
               "--area-mm2", shape.areas_mm2,
               "Cross-section of one conductor (default: the spec's tether.cross_section_mm2)")
        .option("--height", shape.height,
                "Of the drone over the station, m (default: tether.length_m)")
        .option("--offset", shape.offset,
                "Of the drone aside, m (default: flight.horizontal_offset_m)")
        .comma_list("--wind", shape.winds, "m/s (default: flight.airspeed_m_s)")
        .option("--wind-from", shape.wind_from,
                "Degrees, clockwise from above, 0 from where the drone stands aside (default 0)")
        .comma_list(
            "--slack", shape.slacks_percent,
            "Cable paid out beyond the distance, percent of it (default: tether.slack_percent)")
        .option("--length", shape.length, "Or: the cable paid out, m")
        .option("--winch-tension", shape.winch_tension,
                "Or: N that a winch holds at the station (default: tether.winch_pull_N)")
        .option("--stiffness", shape.axial_stiffness, "EA, N (default: tether.axial_stiffness_N)")
        .option("--station-height", shape.station_height,
                "Over ground, m (default: flight.station_height_m)")
        .option("--profile", shape.profile,
                "How the wind grows with height: uniform, power-law or logarithmic (default: "
                "flight.wind_profile)")
        .option("--reference-height", shape.reference_height,
                "m over ground at which --wind blows, with a profile (default: "
                "flight.wind_reference_height_m, or 10)")
        .option("--exponent", shape.exponent, "Of the power law (default: flight.wind_exponent)")
        .option("--roughness", shape.roughness_length,
                "m, of the logarithmic profile (default: flight.roughness_length_m)");
  }

  Command& output_file(Output& output) {
    return option("--output", output.file, "Write to this file, whole or not at all");
  }

  /// Adds --format and --output.
  Command& output(Output& output) {
    app_.add_option_function<std::string>(
        "--format", [&output](const std::string& text) { output.format = parse_format(text); },
        "table (default), json or csv");
    return output_file(output);
  }

 private:
  CLI::App& app_;
};

/// The commands and their options. Kept alive until the chosen action has run.
class CommandLine {
 public:
  CommandLine() : app_("Design calculator for drones powered through a tether.", "tethercalc") {
    app_.set_version_flag("--version", std::string("tethercalc ") + TETHERCALC_VERSION);
    app_.require_subcommand(1);
    add_design_commands();
    add_texts();
    add_log_commands();
    add_pictures();
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
  Command add(const std::string& name, const std::string& help, Action action) {
    CLI::App& command = *app_.add_subcommand(name, help);
    command.allow_extras();  // told with the closest known option in check_extras
    actions_[name] = std::move(action);
    return Command(command);
  }

  void add_design_commands() {
    add("optimize", "Which conductor cross-section to fly, and what limits it",
        [this] { return run_optimize(spec_, output_); })
        .spec(spec_)
        .output(output_);
    add("evaluate", "Operating points in hover and forward flight at given cross-sections",
        [this] { return run_evaluate(spec_, areas_, output_); })
        .spec(spec_)
        .comma_list("--area-mm2", areas_, "Cross-sections of one conductor, X[,Y...]")
        .output(output_);
    add("compare", "One optimum a motor, the most economical first",
        [this] { return run_compare(spec_, motors_, output_); })
        .spec(spec_)
        .comma_list("--motors", motors_,
                    "all, or names of the library and files, separated by commas (default: all)")
        .output(output_);
    add("motor", "A motor file from thrust-stand tables, or from what is known of a propeller",
        [this] { return run_motor(motor_, output_); })
        .option("FILE", motor_.files,
                "Tables (CSV) of bench runs of one motor, or a motor file (JSON) to check")
        .comma_list("--columns", motor_.columns,
                    "What a header's words do not say: thrust_g=HEADER,power_W=HEADER,...")
        .repeatable("--where", motor_.where,
                    "COLUMN=VALUE: only these rows of the tables; repeatable")
        .option("--id", motor_.id, "What specs call it (default: the file's name)")
        .option("--name", motor_.name, "What people call it (default: the file's name)")
        .option("--propeller-in", motor_.propeller_in, "Diameter of the propeller, inch")
        .option("--air-density", motor_.air_density_kg_m3,
                "Of the air on the bench, kg/m³ (default: not known)")
        .option("--figure-of-merit", motor_.figure_of_merit,
                "Without a file: ideal over electrical power of the motor to estimate")
        .option("--max-thrust-g", motor_.max_thrust_g, "Without a file: its greatest thrust")
        .option("--power-log", motor_.power_log,
                "Instead of a file: a free flight (CSV: time_s, airspeed_m_s, bus_voltage_V, "
                "bus_current_A)")
        .option("--spec", motor_.spec.file, "The drone that flew it: mass, motors, drag, air")
        .repeatable("--set", motor_.spec.overrides, "Change a field of that spec: path=value")
        .output(output_);
    add("sweep", "One row a design, for every combination or a sample of values",
        [this] { return run_sweep(sweep_); })
        .spec(sweep_.spec)
        .repeatable("--vary", sweep_.varied,
                    "path=from:to:step, path=a,b,c or path=all; in a sample also path=lo..hi "
                    "(uniform) and path=mean~sd (normal); repeatable, the last changes fastest")
        .option("--sample", sweep_.sample, "Draw N designs instead of every combination")
        .option("--method", sweep_.method, "sobol (default) or lhs, a Latin hypercube")
        .option("--seed", sweep_.seed, "Of the sample (default 0)")
        .option("--summary", sweep_.summary_file, "Write a sample's summary here as JSON")
        .option("--format", sweep_.format, "csv (default) or jsonl, JSON Lines")
        .option("--output", sweep_.file, "Write rows to this file as they are computed")
        .flag("--resume", sweep_.resume, "Continue what --output holds from an earlier run")
        .option("--shard", sweep_.shard,
                "i/n: only the i-th of n equal parts; joined they are the whole sweep")
        .option("--jobs", sweep_.jobs, "Threads (default: one a core)");
    add("check", "Reference designs against their recorded results",
        [this] { return run_check(check_, output_); })
        .argument("PATH", check_.paths, "Folders of specs, or specs")
        .flag("--update", check_.update, "Bring the records up to date")
        .option("--junit", check_.junit_file, "Write a JUnit XML report here")
        .output(output_);
    add("design", "The best whole design among those that free fields allow",
        [this] { return run_design(spec_, request_, output_); })
        .spec(spec_)
        .repeatable("--free", request_.free,
                    "A field the search may change: PATH=lo..hi, or what --vary of sweep takes; "
                    "repeatable")
        .option("--minimize", request_.minimize,
                "Key of a result or path of a field (default: total_power_W)")
        .repeatable("--subject-to", request_.subject_to,
                    "A demand beside the spec's: 'KEY<=VALUE' or 'KEY>=VALUE'; repeatable")
        .option("--standard", request_.standard,
                "awg or iec: the cross-section is one of these sizes")
        .comma_list("--pareto", request_.pareto, "KEY,KEY: the front of two quantities")
        .option("--seed", request_.seed, "Of the points from which the search starts")
        .output(output_);
    add("envelope", "How high, how heavy, how fast and in how much wind a given cable flies",
        [this] { return run_envelope(spec_, areas_, output_); })
        .spec(spec_)
        .repeatable("--area-mm2", areas_,
                    "Cross-section of one conductor (default: the spec's tether.cross_section_mm2)")
        .output(output_);
    add("shape", "How the cable hangs between station and drone, and what that does to the drone",
        [this] { return run_shape(shape_, output_); })
        .option("SPEC", shape_.spec.file, "Design spec (JSON), - for standard input")
        .repeatable("--set", shape_.spec.overrides, "Change a field of the spec: path=value")
        .shape(shape_)
        .option("--cases", shape_.cases_file, "Solve the bare cables of this file (JSON) instead")
        .output(output_);
    add("validate", "Check specs without computing anything",
        [this] { return run_validate(files_, spec_.overrides, output_); })
        .argument("SPEC", files_, "Design specs (JSON), - for standard input")
        .repeatable("--set", spec_.overrides, "Change a field first: path=value; repeatable")
        .output(output_);
  }

  /// What is printed as it stands: the schema, a starting spec, the library.
  void add_texts() {
    const auto add_text = [this](const char* name, const char* help, const auto& text) {
      add(name, help, [this, text] {
        emit(output_, text());
        return done;
      }).output_file(output_);
    };
    add_text("schema", "The JSON Schema of design specs, for editors",
             [] { return json_text(spec_schema()); });
    add_text("init", "A starting spec to edit", starting_spec);
    add("list", "The library: motors, conductors, insulation or sizes",
        [this] { return run_list(what_, output_); })
        .argument("WHAT", what_, "motors, conductors, insulation or sizes")
        .output(output_);
  }

  void add_log_commands() {
    add("drag", "The drone's drag, learned from its own flight logs",
        [this] { return run_drag(files_, flight_, what_, autopilot_, output_); })
        .argument("LOG", files_, "Flight logs: ArduPilot (.bin, .log), PX4 (.ulg) or CSV")
        .flight(flight_)
        .flag("--published-kinematics", flight_.published_kinematics,
              "The forward axis alone, by the paper's formulas: reproduces its digits")
        .option("--into", what_, "Print this spec with its drag replaced, instead of the fit")
        .option("--parameters", autopilot_,
                "ardupilot or px4: print the drag as parameters of its wind estimate instead")
        .output(output_);
    add("diagnose", "What the simulation of a measured flight gets wrong, and why",
        [this] {
          diagnose_.into = app_.get_subcommand("diagnose")->count("--into") > 0;
          return run_diagnose(diagnose_, output_);
        })
        .spec(diagnose_.spec)
        .logs(diagnose_,
              "Flight log: ArduPilot (.bin, .log), PX4 (.ulg) or CSV; repeatable, for flights of "
              "one drone",
              "Power log (CSV)")
        .option_or_flag("--into", diagnose_.into_file,
                        "Write the extended spec to this file; without a name print it instead of "
                        "the diagnosis")
        .option("--next-flight", diagnose_.next_flight_file,
                "Write the shortest flight that settles what stays open as a mission: .waypoints "
                "(ArduPilot) or .plan (QGroundControl)")
        .option("--home", diagnose_.home,
                "Where it begins, LAT,LON in degrees (default: where the log took off)")
        .option("--height-m", diagnose_.height_m,
                "Of its passes over home, m (default: the log's median, at least 10)")
        .option("--reach-m", diagnose_.reach_m,
                "How far from home it may go, m (default: as far as the log did)")
        .output(output_);
    add("log", "What an autopilot's log holds",
        [this] { return run_log(what_, message_, output_); })
        .argument("LOG", what_, "ArduPilot's .bin or .log, PX4's .ulg; also as .gz, .xz or .zip")
        .option("--csv", message_, "Export all messages of this name, such as XKF1")
        .output(output_);
  }

  void add_pictures() {
    add("plot", "A figure of a result, drawn by gnuplot",
        [this] {
          for (const CLI::Option* option : app_.get_subcommand("plot")->get_options()) {
            if (option->count() > 0) plot_.given.push_back(option->get_name());
          }
          return run_plot(plot_, output_);
        })
        .argument("KIND", plot_.kind, plot_kinds_help())
        .argument("FILE", plot_.files, "What it is drawn from")
        .repeatable("--set", plot_.made_of.spec.overrides,
                    "Change a field of the spec: path=value; repeatable")
        .option("--output", output_.file,
                "F.svg, .png, .pdf, .gp (the gnuplot script) or .txt; without it the figure is "
                "drawn with characters, as wide as the terminal (COLUMNS, else 100)")
        .option("--title", plot_.title,
                "Words above the figure (default: the design's or the file's name)")
        .option("--width-mm", plot_.width_mm,
                "Width of the figure, 85 to 400 (default: 85, one column of a journal)")
        .comma_list("--motors", plot_.motors,
                    "motors: all, or names of the library and files, separated by commas")
        .option("--view", plot_.view, "drag: speed (default), or surface over airspeed and tilt")
        .option("--x", plot_.x, "sweep: the varied field along the horizontal axis")
        .option("--y", plot_.y, "sweep: the varied field along the vertical axis")
        .option("--value", plot_.value, "sweep: the column shown (default: forward.total_power_W)")
        .logs(plot_.made_of, "diagnosis: the flight log", "diagnosis: the power log",
              "diagnosis: effects taken as part of the base model")
        .shape(plot_.shape);
    add("report", "One page with everything about a design, to be mailed or printed",
        [this] { return run_report(diagnose_, shell_command(arguments_), output_); })
        .spec(diagnose_.spec)
        .logs(diagnose_,
              "With what this flight log says: ArduPilot (.bin, .log), PX4 (.ulg) or CSV",
              "With what this power log says (CSV)")
        .output_file(output_);
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
  MotorOptions motor_;
  DesignRequest request_;
  ShapeOptions shape_;
  std::vector<std::string> files_;
  std::string what_;
  std::string autopilot_;
  FlightOptions flight_;
  DiagnoseOptions diagnose_;
  std::span<const char* const> arguments_;  ///< what was typed, the program's name first
  std::string message_;
  PlotOptions plot_;
};

}  // namespace

int run(int argc, const char* const* argv) { return CommandLine().run(argc, argv); }

}  // namespace tethercalc::cli
