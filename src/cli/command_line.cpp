// The only file that sees CLI11, which takes long to compile.

#include "cli/commands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <deque>
#include <functional>
#include <limits>
#include <map>

#include "cli/command_help.hpp"
#include "files/output_files.hpp"
#include "io/checked_values.hpp"
#include "io/closest_name.hpp"

namespace tethercalc::cli {
namespace {

/// What a command runs once its arguments are parsed.
using Action = std::function<int()>;

constexpr std::uint64_t any_seed = std::numeric_limits<std::uint64_t>::max();

/// The parts of `text` between separators.
std::vector<std::string> parts_of(std::string_view text, char separator) {
  const auto parts = split(text, separator);
  return {parts.begin(), parts.end()};
}

/// A command under construction; its options are added in the order in which help lists them. Each
/// is named with what follows it: "-o,--output FILE". What is wrong with the value of one is noted
/// among the problems, so that all others are read as well.
class Command {
 public:
  Command(CLI::App& app, CommandHelp& help, Problems& problems)
      : app_(app), help_(help), problems_(problems) {}

  /// What the options that follow serve: their heading in help.
  Command& group(const char* name) {
    group_ = name;
    return *this;
  }

  template <typename Value>
  Command& option(const std::string& name, Value& value, const std::string& help) {
    app_.add_option(noted(name, help), value);
    return *this;
  }
  Command& option(const std::string& name, double& value, const std::string& help) {
    return read_by(
        name, help,
        [&problems = problems_, &value](const std::string& given, const std::string& text) {
          read_number(given, text, value, problems);
        });
  }
  Command& option(const std::string& name, std::optional<double>& value, const std::string& help) {
    return read_by(
        name, help,
        [&problems = problems_, &value](const std::string& given, const std::string& text) {
          read_number(given, text, value, problems);
        });
  }

  /// A whole number from `least` to `most`.
  template <typename Value>
  Command& whole(const std::string& name, Value& value, std::uint64_t least, std::uint64_t most,
                 const std::string& help) {
    return read_by(
        name, help,
        [=, &problems = problems_, &value](const std::string& given, const std::string& text) {
          std::uint64_t number = 0;
          const char* const end = text.data() + text.size();
          const auto [last, error] = std::from_chars(text.data(), end, number);
          if (error == std::errc() && last == end && number >= least && number <= most) {
            value =
                static_cast<std::remove_cvref_t<decltype(std::optional(value).value())>>(number);
          } else {
            problems.add(given, fmt::format("\"{}\" is not a whole number from {} to {}", text,
                                            least, most));
          }
        });
  }

  /// One of the words in the name, "--format table|json|csv", in the order of `Enum`.
  template <typename Enum>
  Command& choice(const std::string& name, Enum& value, const std::string& help) {
    const std::vector<std::string> words = parts_of(name.substr(name.rfind(' ') + 1), '|');
    return read_by(
        name, help,
        [=, &problems = problems_, &value](const std::string& given, const std::string& text) {
          const auto found = std::ranges::find(words, text);
          if (found != words.end()) {
            value = static_cast<Enum>(found - words.begin());
          } else {
            problems.add(given, fmt::format("\"{}\" is not allowed; allowed are {} and {}{}", text,
                                            fmt::join(words.begin(), words.end() - 1, ", "),
                                            words.back(), did_you_mean(text, words)));
          }
        });
  }

  /// What must be given, without a name.
  template <typename Value>
  Command& argument(const char* name, Value& value, const std::string& help) {
    return may_be_given(name, value, help, true);
  }

  /// The words of which the last argument is one.
  Command& among(std::vector<std::string> words) {
    help_.arguments.back().words = std::move(words);
    return *this;
  }

  /// What may be given without a name.
  template <typename Value>
  Command& optional_argument(const char* name, Value& value, const std::string& help) {
    return may_be_given(name, value, help, false);
  }

  Command& flag(const std::string& name, bool& value, const std::string& help) {
    app_.add_flag(noted(name, help), value);
    return *this;
  }

  /// An option that may be given without its value.
  Command& option_or_flag(const std::string& name, std::string& value, const std::string& help) {
    app_.add_option(noted(name, help), value)->expected(0, 1);
    return *this;
  }

  /// An option that takes one value, each time it is given.
  Command& repeatable(const std::string& name, std::vector<std::string>& values,
                      const std::string& help) {
    app_.add_option(noted(name, help), values)->allow_extra_args(false);
    return *this;
  }

  Command& comma_list(const std::string& name, std::vector<std::string>& values,
                      const std::string& help) {
    const auto read = [&problems = problems_, &values](const std::string& given,
                                                       const std::vector<std::string>& texts) {
      values.clear();
      for (const std::string& text : texts) {
        const std::vector<std::string> parts = parts_of(text, ',');
        if (std::ranges::count(parts, "") > 0) {
          problems.add(given, "\"" + text + "\" has nothing between two commas, or at an end");
        }
        values.insert(values.end(), parts.begin(), parts.end());
      }
    };
    read_option<std::vector<std::string>>(name, help, read)->allow_extra_args(false);
    return *this;
  }

  /// Shell lines that show the command.
  Command& examples(std::vector<std::string> lines) {
    help_.examples = std::move(lines);
    return *this;
  }

  Command& spec(SpecOptions& spec) {
    return argument("SPEC", spec.file, "Design spec (JSON), - for standard input")
        .group("Design")
        .repeatable(
            "--set PATH=VALUE", spec.overrides,
            "Change a field of the spec: path=value, such as supply.voltage_V=60; repeatable")
        .group("Options");
  }

  /// The options that say which part of a flight counts and what is known about it.
  Command& flight(FlightOptions& flight) {
    group("Flight");
    option("--mass-g G", flight.mass_g, "Mass of the drone as flown, in g (default: the spec's)");
    option("--from PLACE", flight.from, "First sample of a flight: seconds (120) or percent (25%)");
    option("--to PLACE", flight.to, "Last sample; with neither, what is flown is used");
    option("--pitch-offset-deg DEGREES", flight.pitch_offset_deg,
           "Pitch that the log shows in level flight, nose-up (default: 0)");
    option("--trim-log LOG", flight.trim_log, "Hover flight whose mean pitch is that offset");
    option("--air-density KG/M3", flight.air_density_kg_m3,
           "In kg/m³ (default: the spec's; without a spec 1.293)");
    option("--pressure-hPa HPA", flight.pressure_hPa, "For the air density, with");
    option("--temperature-C CELSIUS", flight.temperature_C, "the air temperature");
    comma_list("--columns COLUMNS", flight.columns,
               "Of a CSV with other names, NAME=COLUMN,...: airspeed_km_h=wind,vd_m_s=-climb");
    return whole("--core N", flight.core, 0, 255, "EKF core to read (default: 0)").group("Options");
  }

  /// Which monitors of a log of power count.
  Command& batteries(std::vector<std::string>& numbers) {
    return comma_list("--battery N,...", numbers,
                      "Battery monitors that feed the motors, where the log has several: "
                      "N[,N...], whose currents add up");
  }

  /// The options that name measured logs and say how to look at them.
  Command& logs(
      DiagnoseOptions& logs, const char* flight_help, const char* power_help,
      const char* base_help = "Effects taken as part of the base model, EFFECT[,EFFECT...]") {
    return group("Logs")
        .repeatable("--flight LOG", logs.flight_logs, flight_help)
        .repeatable("--power LOG", logs.power_logs, power_help)
        .repeatable("--log LOG", logs.whole_logs,
                    "Both from one log of one flight; repeatable, as --power is, for free flights")
        .batteries(logs.batteries)
        .flag("--free-flight", logs.free_flight,
              "The power was logged in flight without the tether, from a battery")
        .comma_list("--base EFFECT,...", logs.base, base_help)
        .repeatable("--effects FILE", logs.effect_files,
                    "Your own effects to try as well (JSON); repeatable")
        .flight(logs.flight);
  }

  /// The options that say where a drone hangs on its cable, and in which air.
  Command& shape(ShapeOptions& shape) {
    return group("Cable")
        .repeatable("--area-mm2 AREA", shape.areas_mm2,
                    "Cross-section of one conductor (default: the spec's tether.cross_section_mm2)")
        .option("--height M", shape.height,
                "Of the drone over the station, m (default: tether.length_m)")
        .option("--offset M", shape.offset,
                "Of the drone aside, m (default: flight.horizontal_offset_m)")
        .comma_list("--wind M/S", shape.winds,
                    "m/s (default: what blows about the drone in forward flight; with a profile "
                    "in hover)")
        .option("--wind-from DEGREES", shape.wind_from,
                "Degrees, clockwise from above, 0 from where the drone stands aside (default: 0)")
        .comma_list(
            "--slack PERCENT", shape.slacks_percent,
            "Cable paid out beyond the distance, percent of it (default: tether.slack_percent)")
        .option("--length M", shape.length, "Or: the cable paid out, m")
        .option("--winch-tension N", shape.winch_tension,
                "Or: N that a winch holds at the station (default: tether.winch_pull_N)")
        .option("--stiffness N", shape.axial_stiffness, "EA, N (default: tether.axial_stiffness_N)")
        .option("--station-height M", shape.station_height,
                "Over ground, m (default: flight.station_height_m)")
        .option("--profile uniform|power-law|logarithmic", shape.profile,
                "How the wind grows with height: uniform, power-law or logarithmic (default: "
                "flight.wind_profile)")
        .option("--reference-height M", shape.reference_height,
                "m over ground at which --wind blows, with a profile (default: "
                "flight.wind_reference_height_m, or at the drone)")
        .option("--exponent X", shape.exponent, "Of the power law (default: flight.wind_exponent)")
        .option("--roughness M", shape.roughness_length,
                "m, of the logarithmic profile (default: flight.roughness_length_m)")
        .group("Options");
  }

  Command& output_file(Output& output) {
    group("Output");
    return option("-o,--output FILE", output.file,
                  "Write to this file, whole or not at all (default: -, standard output)")
        .voice(output);
  }

  /// Colours, and what is said beside the answer.
  Command& voice(Output& output) {
    choice("--color auto|always|never", output.colour,
           "Colours (default: auto, on a terminal without NO_COLOR)");
    app_.add_flag_callback(noted("-q,--quiet", "Nothing on standard error but errors"), be_quiet);
    return *this;
  }

  /// Adds --format and --output.
  Command& output(Output& output) {
    group("Output");
    choice("--format table|json|csv", output.format, "Form of the answer (default: table)");
    return output_file(output);
  }

 private:
  using Reader = std::function<void(const std::string& option, const std::string& text)>;

  /// Notes what help says; returns what the parser calls the option.
  std::string noted(const std::string& name, const std::string& help) {
    const std::size_t blank = std::min(name.find(' '), name.size());
    const std::string names = name.substr(0, blank);
    help_.options.push_back(
        {parts_of(names, ','), name.substr(std::min(blank + 1, name.size())), help, group_});
    return names;
  }

  /// An option whose `Given` goes to `read`, behind what the option is called.
  template <typename Given, typename Read>
  CLI::Option* read_option(const std::string& name, const std::string& help, Read read) {
    const std::string names = noted(name, help);
    return app_.add_option_function<Given>(
        names, [read = std::move(read), option = names.substr(names.rfind(',') + 1)](
                   const Given& given) { read(option, given); });
  }
  Command& read_by(const std::string& name, const std::string& help, Reader read) {
    read_option<std::string>(name, help, std::move(read));
    return *this;
  }

  template <typename Value>
  static void read_number(const std::string& given, const std::string& text, Value& value,
                          Problems& problems) {
    if (const auto number = parsed_number(text)) {
      value = *number;
    } else {
      problems.add(given, "\"" + text + "\" is not a number");
    }
  }

  template <typename Value>
  Command& may_be_given(const char* name, Value& value, const std::string& help, bool required) {
    app_.add_option(name, value)->required(required);
    help_.arguments.push_back({{required ? name : std::string("[") + name + "]"}, "", help, ""});
    return *this;
  }

  CLI::App& app_;
  CommandHelp& help_;
  Problems& problems_;
  std::string group_ = "Options";
};

/// The commands and their options. Kept alive until the chosen action has run.
class CommandLine {
 public:
  CommandLine() : app_("Design calculator for drones powered through a tether.", "tethercalc") {
    app_.set_version_flag("-V,--version", std::string("tethercalc ") + TETHERCALC_VERSION);
    app_.require_subcommand(1);
    add_design_commands();
    add_texts();
    add_log_commands();
    add_pictures();
    add_words_about_itself();
  }

  int run(int argc, const char* const* argv) {
    check_command(argc, argv);
    arguments_ = {argv, argv + argc};
    try {
      app_.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
      return print_help(chosen_command());
    } catch (const CLI::Success& version) {
      emit({}, std::string(version.what()) + "\n");
      return done;
    } catch (const CLI::ParseError& error) {
      const std::string chosen = chosen_command();
      const std::string name = chosen.empty() ? "" : " " + chosen;
      problems_.add("tethercalc" + name,
                    std::string(error.what()) + " (see tethercalc" + name + " --help)");
      problems_.throw_if_any();
    }
    const CLI::App* command = app_.get_subcommands().front();
    check_extras(*command);
    check_outputs(*command);
    if (problems_.count() > 0) add_problems_of_spec();
    problems_.throw_if_any();
    for (std::string* file : {&output_.file, &drag_.into_file, &diagnose_.into_file}) {
      if (*file == "-") file->clear();
    }
    return actions_.at(command->get_name())();
  }

 private:
  Command add(const std::string& name, const std::string& summary, Action action) {
    CLI::App& command = *app_.add_subcommand(name, summary);
    command.allow_extras();  // told with the closest known option in check_extras
    actions_[name] = std::move(action);
    return Command(command, help_.emplace_back(CommandHelp{name, summary}), problems_);
  }

  void add_design_commands() {
    add("optimize", "Which conductor cross-section to fly, and what limits it",
        [this] { return run_optimize(spec_, output_); })
        .spec(spec_)
        .output(output_)
        .examples({"tethercalc optimize examples/holybro-x500.json",
                   "tethercalc optimize my.json --set supply.voltage_V=60 --format json"});
    add("evaluate", "Operating points in hover and forward flight at given cross-sections",
        [this] { return run_evaluate(spec_, areas_, output_); })
        .spec(spec_)
        .comma_list("--area-mm2 AREA", areas_, "Cross-sections of one conductor, X[,Y...]")
        .output(output_)
        .examples({"tethercalc evaluate my.json --area-mm2 0.75,1,AWG16"});
    add("compare", "One optimum a motor, the most economical first",
        [this] { return run_compare(spec_, motors_, output_); })
        .spec(spec_)
        .comma_list(
            "--motors MOTOR,...", motors_,
            "all, alike (the spec's own and the eight nearest in greatest thrust), or names of the "
            "library and files, separated by commas (default: all)")
        .output(output_)
        .examples({"tethercalc compare my.json",
                   "tethercalc compare my.json --motors holybro-air2216-920kv-10in,my-motor.json"});
    add("motor", "A motor file from thrust-stand tables, or from what is known of a propeller",
        [this] { return run_motor(motor_, output_); })
        .optional_argument(
            "FILE", motor_.files,
            "Tables (CSV) of bench runs of one motor, or a motor file (JSON) to check")
        .comma_list("--columns COLUMNS", motor_.columns,
                    "What a header's words do not say: thrust_g=HEADER,power_W=HEADER,...")
        .repeatable("--where COLUMN=VALUE", motor_.where,
                    "COLUMN=VALUE: only these rows of the tables; repeatable")
        .option("--id ID", motor_.id, "What specs call it (default: the file's name)")
        .option("--name WORDS", motor_.name, "What people call it (default: the file's name)")
        .option("--propeller-in INCH", motor_.propeller_in, "Diameter of the propeller, inch")
        .option("--air-density KG/M3", motor_.air_density_kg_m3,
                "Of the air on the bench, kg/m³ (default: not known)")
        .option("--figure-of-merit X", motor_.figure_of_merit,
                "Without a file: ideal over electrical power of the motor to estimate")
        .option("--max-thrust-g G", motor_.max_thrust_g, "Without a file: its greatest thrust")
        .option("--power-log LOG", motor_.power_log,
                "Instead of a file: a free flight with voltage and current, an autopilot's log or "
                "CSV")
        .batteries(motor_.batteries)
        .option("--spec SPEC", motor_.spec.file, "The drone that flew it: mass, motors, drag, air")
        .repeatable("--set PATH=VALUE", motor_.spec.overrides,
                    "Change a field of that spec: path=value")
        .group("Autopilot")
        .option("--parameters ardupilot", motor_.autopilot,
                "Print MOT_THST_EXPO from the throttles of the tables instead")
        .option("--spin-min X", motor_.spin_min, "MOT_SPIN_MIN (default: 0.15)")
        .option("--spin-max X", motor_.spin_max, "MOT_SPIN_MAX (default: 0.95)")
        .option("--pwm-min-us US", motor_.pwm_min_us,
                "MOT_PWM_MIN, of throttles in µs (default: 1000)")
        .option("--pwm-max-us US", motor_.pwm_max_us,
                "MOT_PWM_MAX, of throttles in µs (default: 2000)")
        .output(output_)
        .examples({"tethercalc motor bench.csv --output my-motor.json",
                   "tethercalc motor bench.csv --parameters ardupilot --output expo.param"});
    add("sweep", "One row a design, for every combination or a sample of values",
        [this] { return run_sweep(sweep_); })
        .spec(sweep_.spec)
        .group("Values")
        .repeatable("--vary PATH=VALUES", sweep_.varied,
                    "path=from:to:step, path=a,b,c or path=all; in a sample also path=lo..hi "
                    "(uniform) and path=mean~sd (normal); repeatable, the last changes fastest")
        .group("Sample")
        .whole("--sample N", sweep_.sample, 1, 1'000'000'000'000,
               "Draw N designs (default: every combination)")
        .option("--method sobol|lhs", sweep_.method,
                "How to draw: sobol, or lhs, a Latin hypercube (default: sobol)")
        .whole("--seed N", sweep_.seed, 0, any_seed, "Of the sample (default: 0)")
        .option("--summary FILE", sweep_.summary_file, "Write a sample's summary here as JSON")
        .group("Output")
        .option("--format csv|jsonl", sweep_.format, "csv, or jsonl for JSON Lines (default: csv)")
        .option("-o,--output FILE", sweep_.file,
                "Write rows to this file as they are computed (default: -, standard output)")
        .flag("--resume", sweep_.resume, "Continue what --output holds from an earlier run")
        .option(
            "--shard I/N", sweep_.shard,
            "i/n: only the i-th of n equal parts; joined they are the whole sweep (default: 1/1)")
        .whole("--jobs N", sweep_.jobs, 1, 1024, "Threads (default: one a core)")
        .voice(output_)
        .examples({"tethercalc sweep my.json --vary supply.voltage_V=40:100:5 --output rows.csv",
                   "tethercalc sweep my.json --vary drone.mass_g=1710~50 --sample 1000 --summary "
                   "sum.json"});
    add("check", "Reference designs against their recorded results",
        [this] { return run_check(check_, output_); })
        .argument("PATH", check_.paths, "Folders of specs, or specs")
        .flag("--update", check_.update, "Bring the records up to date")
        .option("--junit FILE", check_.junit_file, "Write a JUnit XML report here")
        .output(output_)
        .examples({"tethercalc check examples/reference",
                   "tethercalc check examples/reference --junit report.xml"});
    add("design", "The best whole design among those that free fields allow",
        [this] { return run_design(spec_, request_, output_); })
        .spec(spec_)
        .repeatable("--free PATH=VALUES", request_.free,
                    "A field the search may change: PATH=lo..hi, or what --vary of sweep takes; "
                    "repeatable")
        .option("--minimize PATH", request_.minimize,
                "Key of a result or path of a field (default: total_power_W)")
        .repeatable("--subject-to DEMAND", request_.subject_to,
                    "A demand beside the spec's: 'KEY<=VALUE' or 'KEY>=VALUE'; repeatable")
        .option("--standard awg|iec", request_.standard,
                "awg or iec: the cross-section is one of these sizes")
        .comma_list("--pareto KEY,KEY", request_.pareto,
                    "KEY,KEY: the front of two quantities, in ten even steps of the second")
        .whole("--seed N", request_.seed, 0, any_seed,
               "Of the points from which the search starts (default: 1)")
        .output(output_)
        .examples({"tethercalc design my.json --free supply.voltage_V=40..400 --free "
                   "tether.conductor=all"});
    add("envelope", "How high, how heavy, how fast and in how much wind a given cable flies",
        [this] { return run_envelope(spec_, areas_, output_); })
        .spec(spec_)
        .repeatable("--area-mm2 AREA", areas_,
                    "Cross-section of one conductor (default: the spec's tether.cross_section_mm2)")
        .output(output_)
        .examples({"tethercalc envelope my.json --area-mm2 1.1"});
    add("shape", "How the cable hangs between station and drone, and what that does to the drone",
        [this] {
          shape_.given = given_to("shape");
          return run_shape(shape_, output_);
        })
        .optional_argument("SPEC", shape_.spec.file, "Design spec (JSON), - for standard input")
        .repeatable("--set PATH=VALUE", shape_.spec.overrides,
                    "Change a field of the spec: path=value")
        .shape(shape_)
        .option("--cases FILE", shape_.cases_file,
                "Solve the bare cables of this file (JSON) instead")
        .output(output_)
        .examples({"tethercalc shape my.json --area-mm2 1.1 --wind 8 --offset 5"});
    add("rules", "What published rules ask of a tethered drone, and how its figures stand to them",
        [this] { return run_rules(spec_, rules_, output_); })
        .spec(spec_)
        .option(
            "--rules BOOK", rules_,
            "Which rules, required: eu-c3 (European Union, class C3), uk, us, or electrical alone")
        .output(output_)
        .examples({"tethercalc rules my.json --rules eu-c3"});
    add("validate", "Check specs without computing anything",
        [this] { return run_validate(files_, spec_.overrides, output_); })
        .argument("SPEC", files_, "Design specs (JSON), - for standard input")
        .repeatable("--set PATH=VALUE", spec_.overrides,
                    "Change a field first: path=value; repeatable")
        .output(output_)
        .examples({"tethercalc validate my.json other.json"});
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
    add("init", "A starting spec to edit",
        [this] {
          if (!force_) check_unedited(output_.file, starting_spec());
          emit(output_, starting_spec());
          return done;
        })
        .flag("--force", force_, "Write over a file that is there")
        .output_file(output_)
        .examples({"tethercalc init --output my.json"});
    add("list", "The library: motors, conductors, insulation or sizes",
        [this] { return run_list(what_, output_); })
        .argument("WHAT", what_, "motors, conductors, insulation or sizes")
        .among({"motors", "conductors", "insulation", "sizes"})
        .output(output_)
        .examples({"tethercalc list motors", "tethercalc list sizes --format csv"});
  }

  void add_log_commands() {
    add("drag", "The drone's drag, learned from its own flight logs",
        [this] {
          drag_.into = app_.get_subcommand("drag")->count("--into") > 0;
          return run_drag(drag_, output_);
        })
        .argument("LOG", drag_.logs, "Flight logs: ArduPilot (.bin, .log), PX4 (.ulg) or CSV")
        .flight(drag_.flight)
        .flag("--published-kinematics", drag_.flight.published_kinematics,
              "The forward axis alone, by the paper's formulas: reproduces its digits")
        .option("--spec SPEC", drag_.spec.file,
                "The spec whose drag --into replaces: its mass, air and gravity are the flight's")
        .option_or_flag("--into FILE", drag_.into_file,
                        "Write the spec with its drag replaced to this file; without a name print "
                        "it instead of the fit")
        .option("--parameters ardupilot|px4", drag_.autopilot,
                "Print the drag as parameters of this autopilot's wind estimate instead")
        .output(output_)
        .examples({"tethercalc drag flight.bin --mass-g 1550 --pitch-offset-deg 0.8",
                   "tethercalc drag flight.bin --spec my.json --into learned.json"});
    add("diagnose", "What the simulation of a measured flight gets wrong, and why",
        [this] {
          diagnose_.into = app_.get_subcommand("diagnose")->count("--into") > 0;
          return run_diagnose(with_both_halves(diagnose_), output_);
        })
        .spec(diagnose_.spec)
        .logs(diagnose_,
              "Flight log: ArduPilot (.bin, .log), PX4 (.ulg) or CSV; repeatable, for flights of "
              "one drone",
              "Power log: the same, with voltage and current")
        .option_or_flag("--into FILE", diagnose_.into_file,
                        "Write the extended spec to this file; without a name print it instead of "
                        "the diagnosis")
        .option("--next-flight FILE", diagnose_.next_flight_file,
                "Write the shortest flight that settles what stays open as a mission: .waypoints "
                "(ArduPilot) or .plan (QGroundControl)")
        .option("--home LAT,LON", diagnose_.home,
                "Where it begins, LAT,LON in degrees (default: where the log took off)")
        .option("--height-m M", diagnose_.height_m,
                "Of its passes over home, m (default: the log's median, at least 10)")
        .option("--reach-m M", diagnose_.reach_m,
                "How far from home it may go, m (default: as far as the log did)")
        .output(output_)
        .examples({"tethercalc diagnose my.json --flight flight.bin",
                   "tethercalc diagnose my.json --log flight.ulg --free-flight --mass-g 2300",
                   "tethercalc diagnose my.json --power power.csv --into extended.json"});
    add("log", "What an autopilot's log holds",
        [this] { return run_log(what_, message_, output_); })
        .argument("LOG", what_, "ArduPilot's .bin or .log, PX4's .ulg; also as .gz, .xz or .zip")
        .option("--csv NAME", message_, "Export all messages of this name, such as XKF1")
        .output(output_)
        .examples({"tethercalc log flight.bin",
                   "tethercalc log flight.bin --csv XKF1 --output xkf1.csv"});
  }

  /// Names of all options that the command was given.
  std::vector<std::string> given_to(const char* command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app_.get_subcommand(command)->get_options()) {
      if (option->count() > 0) names.push_back(option->get_name());
    }
    return names;
  }

  void add_pictures() {
    add("plot", "A figure of a result",
        [this] {
          plot_.given = given_to("plot");
          return run_plot(plot_, output_);
        })
        .argument("KIND", plot_.kind, plot_kinds_help())
        .among(plot_kinds())
        .argument("FILE", plot_.files, "What it is drawn from")
        .repeatable("--set PATH=VALUE", plot_.made_of.spec.overrides,
                    "Change a field of the spec: path=value; repeatable")
        .option(
            "-o,--output FILE", output_.file,
            "F.svg, .txt, .pdf and .png (by gnuplot) or .gp (its script); without it the figure is "
            "drawn with characters, as wide as the terminal (COLUMNS, else 100)")
        .voice(output_)
        .group("Figure")
        .option("--title WORDS", plot_.title,
                "Words above the figure (default: the design's or the file's name)")
        .option("--width-mm MM", plot_.width_mm,
                "Width of the figure, 85 to 400 (default: 85, one column of a journal)")
        .comma_list(
            "--motors MOTOR,...", plot_.motors,
            "motors: all, alike, or names of the library and files, separated by commas (default: "
            "alike, the spec's own and the eight nearest to it in greatest thrust)")
        .option("--view speed|surface", plot_.view,
                "drag: over speed, or as a surface over airspeed and tilt (default: speed)")
        .option("--x PATH", plot_.x, "sweep: the varied field along the horizontal axis")
        .option("--y PATH", plot_.y, "sweep: the varied field along the vertical axis")
        .option("--value COLUMN", plot_.value,
                "sweep: the column shown (default: forward.total_power_W)")
        .logs(plot_.made_of, "diagnosis: the flight log", "diagnosis: the power log",
              "diagnosis: effects taken as part of the base model")
        .shape(plot_.shape)
        .examples({"tethercalc plot optimum my.json --output optimum.svg",
                   "tethercalc plot sweep rows.csv --x supply.voltage_V"});
    add("report", "One page with everything about a design, to be mailed or printed",
        [this] {
          return run_report(with_both_halves(diagnose_), rules_, shell_command(arguments_),
                            output_);
        })
        .spec(diagnose_.spec)
        .logs(diagnose_,
              "With what this flight log says: ArduPilot (.bin, .log), PX4 (.ulg) or CSV",
              "With what this power log says: the same, with voltage and current")
        .group("Rules")
        .option("--rules BOOK", rules_,
                "With what published rules ask: eu-c3, uk, us or electrical")
        .output_file(output_)
        .examples({"tethercalc report my.json --flight flight.bin --output report.html",
                   "tethercalc report my.json --rules eu-c3 --output report.html"});
  }

  void add_words_about_itself() {
    add("completion", "A script that completes commands, fields and library names in a shell",
        [this] {
          const auto shells = completed_shells();
          if (std::ranges::count(shells, what_) == 0) {
            const std::vector<std::string> names(shells.begin(), shells.end());
            throw InputError("completion", "\"" + what_ +
                                               "\" is no shell that is known; allowed are " +
                                               "bash, zsh and fish" + did_you_mean(what_, names));
          }
          emit(output_, completion_script(all_help(), what_));
          return done;
        })
        .argument("SHELL", what_, "bash, zsh or fish")
        .among({"bash", "zsh", "fish"})
        .output_file(output_)
        .examples({"source <(tethercalc completion bash)"});
    add("man", "The manual page, made from the same words as help",
        [this] {
          emit(output_, manual_page(all_help()));
          return done;
        })
        .output_file(output_)
        .examples({"tethercalc man | man -l -"});
    add("explain", "What a code of an answer means, why it comes about, and what to do",
        [this] { return run_explain(what_, explanation_form_, output_); })
        .optional_argument(
            "CODE", what_,
            "As answers print it: a limit, a warning, a verdict, an effect (default: "
            "all codes, a line each)")
        .group("Output")
        .choice("--format text|json|markdown", explanation_form_,
                "Form of the page (default: text)")
        .output_file(output_)
        .examples({"tethercalc explain available_power", "tethercalc explain propwash"});
    add("help", "What a command does, and its options", [this] { return print_help(what_); })
        .optional_argument("COMMAND", what_, "One of the commands (default: all, briefly)")
        .examples({"tethercalc help optimize"});
  }

  [[nodiscard]] std::vector<CommandHelp> all_help() const { return {help_.begin(), help_.end()}; }

  /// The help of a command, or of the program where `name` is empty.
  int print_help(const std::string& name) const {
    const auto columns = static_cast<std::size_t>(std::clamp(terminal_columns(), 60, 100));
    if (name.empty()) {
      emit({}, program_help(all_help(), columns));
      return done;
    }
    check_name(name);
    emit({}, command_help(*std::ranges::find(help_, name, &CommandHelp::name), columns));
    return done;
  }

  [[nodiscard]] std::string chosen_command() const {
    const auto chosen = app_.get_subcommands();
    return chosen.empty() ? "" : chosen.front()->get_name();
  }

  /// What else is wrong, while at it.
  void add_problems_of_spec() {
    for (const SpecOptions* spec : {&spec_, &sweep_.spec, &shape_.spec, &drag_.spec, &motor_.spec,
                                    &diagnose_.spec, &plot_.made_of.spec}) {
      if (spec->file.empty()) continue;
      problems_.succeeds([spec] { [[maybe_unused]] const DesignFile read = read_spec(*spec); });
    }
  }

  /// Refuses what cannot be written, to write over a file that is read, and two answers into one
  /// file.
  void check_outputs(const CLI::App& command) {
    std::vector<std::pair<std::string, std::string>> outputs;  // option, file
    std::vector<std::string> inputs;
    for (const CLI::Option* option : command.get_options()) {
      const std::string& name = option->get_name();
      const bool written = name == "--output" || name == "--summary" || name == "--junit" ||
                           name == "--next-flight" || name == "--into";
      for (const std::string& value : option->results()) {
        if (written && !value.empty()) {
          outputs.emplace_back(name, value);
        } else {
          inputs.push_back(value);
        }
      }
    }
    for (const auto& [option, file] : outputs) {
      if (file == "-" && option != "--output") {
        problems_.add(option, "\"-\" is no file: standard output has the answer itself");
        continue;
      }
      // Told before a long computation, not after it.
      if (file != "-") problems_.succeeds([&file = file] { check_can_be_written(file); });
      if (std::ranges::any_of(inputs,
                              [&file = file](const auto& read) { return same_file(file, read); })) {
        problems_.add(option, is_read_words(file));
      }
      // A log behind --into, meant to be read, would be lost.
      if (option == "--into" && same_file(file, file) && !file.ends_with(".json")) {
        problems_.add(option, "\"" + file + "\" is there and no .json file; a spec goes there");
      }
    }
    for (std::size_t i = 1; i < outputs.size(); ++i) {
      const auto& [option, file] = outputs[i];
      for (std::size_t k = 0; k < i; ++k) {
        if (file != outputs[k].second || file == "-") continue;
        problems_.add(option, "\"" + file + "\" is what " + outputs[k].first + " writes, too");
      }
    }
  }

  /// A mistyped command gets the closest one instead of CLI11's "argument was not expected".
  void check_command(int argc, const char* const* argv) const {
    if (argc < 2)
      throw InputError("tethercalc", "a command is needed (tethercalc --help lists them)");
    if (argv[1][0] == '-') return;
    check_name(argv[1]);
  }

  void check_name(const std::string& given) const {
    std::vector<std::string> names;
    for (const auto& [name, action] : actions_) names.push_back(name);
    if (actions_.count(given) == 0) {
      throw InputError("tethercalc", "there is no command \"" + given + "\"" +
                                         did_you_mean(given, names) +
                                         " (tethercalc --help lists them)");
    }
  }

  void check_extras(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    bool after_option = false;  // what follows an unknown option is probably its value
    for (const std::string& extra : command.remaining()) {
      const std::string given = extra.substr(0, extra.find('='));
      const bool option = given.starts_with("-");
      if (option) {
        problems_.add("tethercalc " + command.get_name(),
                      "there is no option " + given + did_you_mean(given, names));
      } else if (!after_option) {
        problems_.add("tethercalc " + command.get_name(),
                      "\"" + extra + "\" is one argument too many");
      }
      after_option = option && given == extra;
    }
  }

  CLI::App app_;
  std::deque<CommandHelp> help_;
  Problems problems_;
  bool force_ = false;
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
  DragOptions drag_;
  DiagnoseOptions diagnose_;
  std::span<const char* const> arguments_;  ///< what was typed, the program's name first
  std::string message_;
  PlotOptions plot_;
  std::string rules_;
  ExplanationForm explanation_form_ = ExplanationForm::text;
};

}  // namespace

int run(int argc, const char* const* argv) { return CommandLine().run(argc, argv); }

}  // namespace tethercalc::cli
