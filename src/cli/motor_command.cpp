#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "files/input_files.hpp"
#include "io/checked_values.hpp"
#include "io/motor_points.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/identify/thrust_expo.hpp"
#include "tethercalc/io/motor_bench.hpp"
#include "tethercalc/report/motor_report.hpp"
#include "tethercalc/study/motor.hpp"

namespace tethercalc::cli {
namespace {

bool is_motor_file(const std::string& file) { return file.ends_with(".json"); }

/// Adds what `check_range` says of an option that was given.
template <typename... Range>
void check_given(Problems& problems, const char* option, const std::optional<double>& value,
                 const Range&... range) {
  if (value) problems.succeeds([&] { check_range(option, *value, range...); });
}

/// The field of a motor file that an option sets.
const SpecField& field_of(FieldKind object, std::string_view pointer) {
  return *std::ranges::find(object_fields(object), pointer, &SpecField::pointer);
}

void check_autopilot(const MotorOptions& options, Problems& problems) {
  if (options.autopilot.empty()) {
    const auto unused = [&](const char* option, const std::optional<double>& value) {
      if (value) problems.add(option, "belongs to --parameters ardupilot; give it");
    };
    unused("--spin-min", options.spin_min);
    unused("--spin-max", options.spin_max);
    unused("--pwm-min-us", options.pwm_min_us);
    unused("--pwm-max-us", options.pwm_max_us);
    return;
  }
  if (options.autopilot != "ardupilot") {
    problems.add(
        "--parameters",
        fmt::format("\"{}\" has no thrust curve here; allowed is ardupilot", options.autopilot));
  }
  const auto is_table = [](const std::string& file) { return !is_motor_file(file); };
  if (options.files.empty() || !std::ranges::all_of(options.files, is_table)) {
    problems.add("--parameters", "needs tables of a thrust stand with a throttle");
  }
  // As ArduPilot documents them.
  check_given(problems, "--spin-min", options.spin_min, 0, 0.3, "");
  check_given(problems, "--spin-max", options.spin_max, 0.9, 1, "");
  check_given(problems, "--pwm-min-us", options.pwm_min_us, 0, 2000, "µs");
  check_given(problems, "--pwm-max-us", options.pwm_max_us, 0, 2000, "µs");
  const PulseRange usual;
  if (options.pwm_min_us.value_or(usual.least) >= options.pwm_max_us.value_or(usual.most)) {
    problems.add("--pwm-min-us", "must be below --pwm-max-us");
  }
}

/// Every problem of the options by themselves.
void check(const MotorOptions& options) {
  Problems problems;
  check_given(problems, "--propeller-in", options.propeller_in,
              field_of(FieldKind::motor, "/propeller_in"));
  check_given(problems, "--air-density", options.air_density_kg_m3,
              field_of(FieldKind::motor, "/measured_air_density_kg_m3"));
  check_given(problems, "--figure-of-merit", options.figure_of_merit, 0.01, 0.99,
              "(1 is an ideal propeller on an ideal motor)");
  check_given(problems, "--max-thrust-g", options.max_thrust_g,
              field_of(FieldKind::motor_points, "/thrust_g"));
  const bool flown = !options.power_log.empty();
  if (flown && (options.spec.file.empty() || !options.max_thrust_g)) {
    problems.add(
        "--power-log",
        "needs --spec SPEC, the drone that flew, and --max-thrust-g, the greatest thrust of "
        "one motor");
  }
  if (flown && options.figure_of_merit) {
    problems.add("--figure-of-merit", "is what --power-log measures; give one of them");
  }
  if (flown && options.air_density_kg_m3) {
    problems.add("--air-density", "of a flight is the spec's: --set flight.air_density_kg_m3=X");
  }
  if (!flown && !(options.spec.file.empty() && options.spec.overrides.empty())) {
    problems.add("--spec", "is the drone that flew a --power-log; give one");
  }
  check_autopilot(options, problems);
  const bool generic = options.figure_of_merit || options.max_thrust_g || flown;
  if (!options.files.empty() && generic) {
    problems.add(flown                     ? "--power-log"
                 : options.figure_of_merit ? "--figure-of-merit"
                                           : "--max-thrust-g",
                 "is of a motor that nobody measured; a file already says it");
  }
  if (options.files.empty() && !flown) {
    const auto need = [&](const char* option, const std::optional<double>& value) {
      if (!value) {
        problems.add(option,
                     "is needed for a motor without a file; all of --propeller-in, "
                     "--figure-of-merit and --max-thrust-g are");
      }
    };
    need("--propeller-in", options.propeller_in);
    need("--figure-of-merit", options.figure_of_merit);
    need("--max-thrust-g", options.max_thrust_g);
  }
  if (!flown && !options.batteries.empty()) {
    problems.add("--battery", "chooses battery monitors of a --power-log; give one");
  }
  if (options.files.empty()) {
    if (!flown && !options.columns.empty()) {
      problems.add("--columns", "names columns of a file; give one");
    }
    if (!options.where.empty()) problems.add("--where", "chooses rows of a file; give one");
  }
  problems.throw_if_any();
}

/// A motor and what its file holds beside it.
struct ShownMotor {
  MotorEntry motor;
  nlohmann::ordered_json given{};  ///< the motor file that it was read from, if any
  std::optional<double> band{};    ///< percent of its power, where it is an estimate
};

ShownMotor generic_motor(const MotorOptions& options) {
  const GenericMotorRequest request{*options.propeller_in * metres_per_inch,
                                    *options.figure_of_merit,
                                    *options.max_thrust_g * unit::gram_force,
                                    options.air_density_kg_m3.value_or(standard_air_density)};
  // No motor file could hold what draws more.
  check_range("--propeller-in, --figure-of-merit and --max-thrust-g",
              ideal_hover_power(request.max_thrust, request.diameter, request.air_density) /
                  request.figure_of_merit,
              field_of(FieldKind::motor_points, "/power_W"));
  const FigureOfMeritSpread spread = figure_of_merit_spread(library_motors());
  const double band = std::round(100 * spread.power_band);
  ShownMotor out;
  MotorEntry& motor = out.motor;
  motor.id = fmt::format("generic-{:g}in-{:g}g", *options.propeller_in, *options.max_thrust_g);
  motor.name = fmt::format("Generic {:g} inch, {:g} g, figure of merit {:g}", *options.propeller_in,
                           *options.max_thrust_g, *options.figure_of_merit);
  motor.source = fmt::format(
      "Estimate, not measured: momentum theory, P = T^1.5/sqrt(2 rho A)/FM with FM {:g} of "
      "propeller "
      "and drive together, in air of {:g} kg/m3. 95 % of the {} measured points of the library are "
      "within {:g} % of the power that their median, FM {:.2f}, gives (FM {:.2f} to {:.2f})",
      *options.figure_of_merit, request.air_density, spread.points, band, spread.median,
      spread.least, spread.greatest);
  motor.propeller_in = options.propeller_in;
  motor.curve = generic_motor_curve(request);
  motor.warnings.push_back(
      {WarningKind::motor_estimated,
       fmt::format("an estimate, not measured: its power may be off by about {:g} % either way",
                   band)});
  out.band = band;
  return out;
}

std::string forward_words(const FlownForward& forward) {
  return fmt::format(
      "in forward flight ({} rows, mean airspeed {:.1f} m/s) the motors drew {:.2f} times what "
      "this "
      "curve gives for the thrust flown{}",
      forward.rows, forward.airspeed, forward.ratio,
      forward.ratio < 1 ? " (drone.translational_lift of a spec accounts for that)" : "");
}

/// The motor of a free flight.
ShownMotor motor_of_flight(const MotorOptions& options) {
  const DesignFile file = read_spec(options.spec);
  const PowerLogReading flight =
      read_power_log(options.power_log, {.free_flight = true,
                                         .batteries = battery_numbers(options.batteries),
                                         .columns = options.columns});
  const double density = file.design.flight.air_density;
  FlownMotor flown;
  try {
    flown = flown_motor(flight.log, file.design, *options.max_thrust_g * unit::gram_force,
                        library_motors());
  } catch (const std::invalid_argument& error) {
    throw InputError(options.power_log, error.what());
  }
  ShownMotor out;
  MotorEntry& motor = out.motor;
  const std::string name = base_name(options.power_log);
  motor.id = std::filesystem::path(name).stem().string();
  motor.name = motor.id + ", flown";
  motor.source = fmt::format(
      "Free flight {}: in {:.0f} s of hover {:.1f} W for {:.0f} g a motor, +-{:.1f} % (95 %), "
      "{:.0f} g in all, air of {:g} kg/m3; from there P = k T^1.5 (momentum theory)",
      name, flown.hover_seconds, flown.hover_power, flown.hover_thrust / unit::gram_force,
      100 * flown.hover_interval, file.design.drone.mass / unit::gram, density);
  motor.curve = flown.curve;
  out.band = std::ceil(100 * flown.band);
  motor.warnings.push_back(
      {WarningKind::motor_flown,
       fmt::format(
           "known at its hover only, to ±{:.1f} % (95 %); elsewhere its power may be off by "
           "about {:g} % "
           "either way",
           100 * flown.hover_interval, *out.band)});
  const double beside = file.design.drone.auxiliary_power;
  motor.warnings.push_back(
      {WarningKind::motor_bus_power,
       beside > 0 ? fmt::format("all of the bus's power but the {:g} W of drone.auxiliary_power_W "
                                "is taken for the motors'",
                                beside)
                  : "all of the bus's power is taken for the motors': what else it feeds counts as "
                    "theirs (drone.auxiliary_power_W)"});
  motor.warnings.insert(motor.warnings.end(), flight.notes.begin(), flight.notes.end());
  if (flown.forward) {
    motor.warnings.push_back({WarningKind::motor_forward_power, forward_words(*flown.forward)});
  }
  return out;
}

ShownMotor motor_of_json(const MotorOptions& options) {
  if (options.files.size() > 1) {
    throw InputError(options.files[1], "is one file too many: a motor file is a whole motor");
  }
  if (!options.columns.empty() || !options.where.empty()) {
    throw InputError(options.columns.empty() ? "--where" : "--columns",
                     "is for tables; " + options.files.front() + " is a motor file");
  }
  ShownMotor out;
  out.motor = find_motor(options.files.front(), files_in(""), "FILE");
  out.given = json_of(read_text_file(options.files.front()).text);
  return out;
}

/// What the options say beside the files.
void apply(const MotorOptions& options, MotorEntry& motor) {
  if (!options.id.empty()) motor.id = options.id;
  if (!options.name.empty()) motor.name = options.name;
  if (options.propeller_in) motor.propeller_in = options.propeller_in;
  if (options.air_density_kg_m3) motor.curve.set_measured_in(options.air_density_kg_m3);
}

/// The motor as a file: the one it was read from with what options change, so that its points and
/// remarks stay as they were written.
nlohmann::ordered_json document_of(const ShownMotor& shown) {
  nlohmann::ordered_json document = motor_document(shown.motor);
  if (!shown.given.is_null()) {
    document.erase("points");
    nlohmann::ordered_json out = shown.given;
    out.update(document);
    return out;
  }
  if (shown.band) document["power_uncertainty_percent"] = *shown.band;
  return document;
}

MotorBench read_bench(const MotorOptions& options) {
  std::vector<LoadedText> tables;
  for (const std::string& file : options.files) tables.push_back(read_text_file(file));
  return motor_from_bench(tables, {options.columns, options.where});
}

ShownMotor shown_motor(const MotorOptions& options) {
  if (!options.power_log.empty()) return motor_of_flight(options);
  if (options.files.empty()) return generic_motor(options);
  if (std::ranges::any_of(options.files, is_motor_file)) return motor_of_json(options);
  ShownMotor out;
  out.motor = read_bench(options).motor;
  return out;
}

/// Prints the thrust curve in the terms of an autopilot.
void print_thrust_curve(const MotorOptions& options, const Output& output) {
  if (output.format != Format::table) {
    throw InputError("--parameters", "and --format each ask for another answer; give one");
  }
  MotorBench bench = read_bench(options);
  apply(options, bench.motor);
  const SpinRange range{options.spin_min.value_or(SpinRange{}.least),
                        options.spin_max.value_or(SpinRange{}.most)};
  const PulseRange pulses{options.pwm_min_us.value_or(PulseRange{}.least),
                          options.pwm_max_us.value_or(PulseRange{}.most)};
  const std::string& file = options.files.front();
  try {
    const ThrustExpo curve = fit_thrust_expo(throttled_thrust(bench, file, pulses), range);
    const bool is_pulse = bench.throttle_unit == ThrottleUnit::microseconds;
    emit(output, thrust_expo_file(bench.motor, curve, range,
                                  is_pulse ? std::optional(pulses) : std::nullopt));
  } catch (const UnsuitableThrottle& error) {
    throw InputError(file, error.what());
  }
}

}  // namespace

int run_motor(const MotorOptions& options, Output output) {
  check(options);
  if (!options.autopilot.empty()) {
    print_thrust_curve(options, output);
    return done;
  }
  ShownMotor shown = shown_motor(options);
  apply(options, shown.motor);
  if (const auto impossible = impossible_merit(shown.motor)) {
    throw InputError(shown.motor.id, *impossible);
  }
  if (output.format == Format::table && output.file.ends_with(".json")) {
    output.format = Format::json;
  }
  if (output.format != Format::table) remark_warnings("motor", shown.motor.warnings);
  emit(
      output, [&] { return motor_text(shown.motor, style_for(output)); },
      [&] { return document_of(shown); }, [&] { return motor_csv(shown.motor); });
  return done;
}

}  // namespace tethercalc::cli
