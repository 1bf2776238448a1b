// The commands: what each is asked, the function that answers, and where its answer goes and in
// which form. Each of these functions returns the program's exit code and throws InputError for bad
// input.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/design_options.hpp"
#include "tethercalc/identify/observations.hpp"
#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/io/design_request.hpp"
#include "tethercalc/report/text_table.hpp"
#include "tethercalc/study/diagnosis.hpp"
#include "tethercalc/study/drag.hpp"
#include "tethercalc/study/next_flight.hpp"

namespace tethercalc::cli {

enum class Format { table, json, csv };

enum class Colour { automatic, always, never };

struct Output {
  Format format = Format::table;
  std::string file;  ///< empty: standard output
  Colour colour = Colour::automatic;
};

/// Exit codes of the program; scripts rely on them.
enum ExitCode : int { done = 0, answer_is_no = 1, bad_input = 2, internal_error = 3 };

/// Colours as asked for; else where the answer goes to a terminal that wants them: TERM is not
/// "dumb" and NO_COLOR is not set (no-color.org).
[[nodiscard]] TextStyle style_for(const Output& output);

/// How figures and pages name a file that they are made of: without folders, which say nothing to
/// others.
[[nodiscard]] std::string base_name(const std::string& file);

/// Says on standard error what is good to know beside an answer, without characters that would
/// command a terminal; nothing once `be_quiet` was called.
void remark(std::string_view lines);
void be_quiet();
/// Whether progress may be shown: standard error is a terminal and nobody asked to be quiet.
[[nodiscard]] bool shows_progress();

/// Columns of the terminal: COLUMNS, what the terminal says, or 100 where there is none.
[[nodiscard]] int terminal_columns();

/// Ends the program as one whose reader has enough, `head` perhaps: by the signal that says so to
/// the shell, without a word.
[[noreturn]] void die_of_closed_pipe();

/// Writes the answer, to the file whole or not at all. Throws InputError where it cannot.
void emit(const Output& output, const std::string& text);

/// Takes one line of an answer, with its newline.
using LineTaker = std::function<void(std::string_view line)>;

/// Writes an answer of any length as `lines` gives it, to the file whole or not at all. Throws
/// InputError where it cannot.
void emit_lines(const Output& output, const std::function<void(const LineTaker&)>& lines);

/// The text of a JSON answer.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& json);

/// Writes the answer in the form that was asked for, of which alone it is made.
void emit(const Output& output, const std::function<std::string()>& text,
          const std::function<nlohmann::ordered_json()>& json,
          const std::function<std::string()>& csv);

/// The program: parses the arguments and runs the command that they name. `argv` begins with the
/// program's name.
int run(int argc, const char* const* argv);

/// A spec and what the command line changes in it.
struct SpecOptions {
  std::string file;  ///< "-" is standard input
  std::vector<std::string> overrides;
};

/// The spec, read with its changes.
[[nodiscard]] DesignFile read_spec(const SpecOptions& spec);

int run_optimize(const SpecOptions& spec, const Output& output);

/// `areas_mm2` as typed; without any, at the spec's own cross-section.
int run_evaluate(const SpecOptions& spec, const std::vector<std::string>& areas_mm2,
                 const Output& output);

int run_compare(const SpecOptions& spec, const std::vector<std::string>& motors,
                const Output& output);

int run_design(const SpecOptions& spec, const DesignRequest& request, const Output& output);

/// The envelope of one cross-section: the one of `areas_mm2`, or the spec's own.
int run_envelope(const SpecOptions& spec, const std::vector<std::string>& areas_mm2,
                 const Output& output);

/// The cable of a spec, or cables of a file of cases.
struct ShapeOptions : CableOptions {
  SpecOptions spec;
  std::string cases_file;  ///< empty: the spec's cable
};

/// How the cable hangs; exit code 1 where it cannot, or would lie on the ground.
int run_shape(const ShapeOptions& options, const Output& output);

struct SweepOptions {
  SpecOptions spec;
  std::vector<std::string> varied;      ///< see read_axes
  std::string format = "csv";           ///< "csv", or "jsonl" (also "json") for JSON Lines
  std::string file;                     ///< empty or "-": standard output
  bool resume = false;                  ///< continue what `file` holds
  std::string shard;                    ///< "i/n"; empty: all rows
  unsigned jobs = 0;                    ///< threads; 0: one a core
  std::optional<std::uint64_t> sample;  ///< draw this many instead of every combination
  std::string method;                   ///< "sobol", which an empty one stands for, or "lhs"
  std::uint64_t seed = 0;
  std::string summary_file;  ///< JSON summary of a sample; empty: none
};

/// Writes one row a design as they are computed. The exit code is 128 + the signal's number where
/// it was interrupted; throws InputError also where rows cannot be written.
int run_sweep(const SweepOptions& options);

struct CheckOptions {
  std::vector<std::string> paths;  ///< folders, specs or records
  bool update = false;             ///< bring the records up to date
  std::string junit_file;          ///< empty: none
};

/// Exit code 1 where a reference design drifted or has no record, unless it was updated. Throws
/// InputError where a file could not be checked, after all others were.
int run_check(const CheckOptions& options, const Output& output);

/// Reads specs and says what is wrong with them, or that nothing is.
int run_validate(const std::vector<std::string>& files, const std::vector<std::string>& overrides,
                 const Output& output);

/// A motor from files, or from what is known of one that nobody measured.
struct MotorOptions {
  std::vector<std::string> files;    ///< tables of bench runs of one motor, or one motor file
  std::vector<std::string> columns;  ///< see MotorBenchOptions
  std::vector<std::string> where;    ///< likewise
  std::string id;
  std::string name;
  std::optional<double> propeller_in;
  std::optional<double> air_density_kg_m3;
  std::optional<double> figure_of_merit;  ///< of a motor without files, with
  std::optional<double> max_thrust_g;
  std::string power_log;               ///< or: of a free flight, with the greatest thrust and
  SpecOptions spec;                    ///< the drone that flew
  std::vector<std::string> batteries;  ///< see battery_numbers
};

/// Shows a motor, or writes it as a motor file: as JSON, which an output file ending in .json is.
int run_motor(const MotorOptions& options, Output output);

/// `what`: "motors", "conductors", "insulation" or "sizes".
int run_list(const std::string& what, const Output& output);

/// Which part of which flight log is looked at, and what is known about the flight; what is empty
/// was not given.
struct FlightOptions {
  int core = 0;
  std::string from;  ///< "25%" of the samples, or seconds of the log's clock
  std::string to;
  std::string trim_log;  ///< a hover flight whose mean pitch is the offset
  std::optional<double> pitch_offset_deg;
  std::optional<double> mass_g;
  std::optional<double> air_density_kg_m3;
  std::optional<double> pressure_hPa;
  std::optional<double> temperature_C;
  bool published_kinematics = false;
};

/// Where the part of the log begins or ends that `text`, as given to `option`, names: percent of
/// the samples with a "%", else seconds; nothing for an empty text. Throws InputError for anything
/// else.
[[nodiscard]] std::optional<LogPosition> log_position(const std::string& option,
                                                      const std::string& text);

/// rad: given, from the trim log, or 0.
[[nodiscard]] double pitch_offset(const FlightOptions& options);

/// The mass in kg that was given, if any. Throws InputError where it is out of range.
[[nodiscard]] std::optional<double> flown_mass(const FlightOptions& options);

/// kg/m³: given, or from pressure and temperature; nothing where neither was. Throws InputError for
/// impossible values, half a pair, or both.
[[nodiscard]] std::optional<double> air_density(const FlightOptions& options);

/// The numbers of battery monitors as typed for --battery. Throws InputError for what is none.
[[nodiscard]] std::vector<int> battery_numbers(const std::vector<std::string>& typed);

/// What an autopilot's log holds, or all messages of one name as CSV.
int run_log(const std::string& file, const std::string& message, const Output& output);

/// What the options say about the flight, checked; the mass must be given.
[[nodiscard]] DragIdentificationOptions identification_options(const FlightOptions& flight);

/// The logs of these names; what was amiss with them is told on standard error.
[[nodiscard]] std::vector<FlightLog> read_flight_logs(const std::vector<std::string>& names,
                                                      int core);

/// The drag of these logs, `name` their heading. Throws InputError where they show none.
[[nodiscard]] DragStudy studied_drag(const std::string& name, const std::vector<std::string>& logs,
                                     const FlightOptions& flight);

struct DragOptions {
  std::vector<std::string> logs;  ///< flights of one drone
  FlightOptions flight;
  SpecOptions spec;       ///< whose drag is replaced; without a name none
  bool into = false;      ///< print that spec instead of the fit
  std::string into_file;  ///< write it there instead, beside the fit
  std::string autopilot;  ///< "ardupilot" or "px4": print its parameter file instead
};

int run_drag(const DragOptions& options, const Output& output);

struct DiagnoseOptions {
  SpecOptions spec;
  std::vector<std::string> flight_logs;  ///< flights of one drone
  std::string power_log;
  std::string whole_log;                  ///< or: both halves in one log, see with_halves
  std::vector<std::string> batteries;     ///< see battery_numbers
  bool free_flight = false;               ///< the power was logged without the tether
  std::vector<std::string> base;          ///< ids of effects that are part of the base model
  std::vector<std::string> effect_files;  ///< effects to try beside those of the catalogue
  FlightOptions flight;
  bool into = false;             ///< print the extended spec instead of the diagnosis
  std::string into_file;         ///< write it there instead, beside the diagnosis
  std::string next_flight_file;  ///< write the mission of a further flight there
  std::string home;              ///< where it begins: "LAT,LON" in degrees
  std::optional<double> height_m;
  std::optional<double> reach_m;
};

/// The options with a log of both halves as the log of each. Throws InputError where another log
/// stands beside it.
[[nodiscard]] DiagnoseOptions with_halves(DiagnoseOptions options);

/// What the logs say; either may be absent.
struct ToldDiagnosis : DiagnosisStudy {
  nlohmann::ordered_json spec;              ///< of the extended design
  std::optional<NextFlight> next_flight{};  ///< where it was asked for
};

/// Compares each log that `options` name with the spec as it stands; what both together do to the
/// design stands in the last of them. Drag that a flight shows directly outranks what the power at
/// the motors says of it. Throws InputError for bad input.
[[nodiscard]] ToldDiagnosis diagnose_logs(const DiagnoseOptions& options, const DesignFile& file);

int run_diagnose(const DiagnoseOptions& options, const Output& output);

struct PlotOptions {
  std::string kind;                ///< as in `plot_kinds_help`
  std::vector<std::string> files;  ///< the spec, logs or CSV that the kind is drawn from
  std::vector<std::string> given;  ///< names of all options that were given
  DiagnoseOptions made_of;         ///< changes of the spec, logs and what is known of them
  std::string title;               ///< above the figure; empty: the design's or the file's name
  double width_mm = 85;
  std::vector<std::string> motors{"alike"};
  std::string view;
  std::string x;
  std::string y;
  std::string value;
  ShapeOptions shape;
};

/// Names and what they show, for help and messages.
[[nodiscard]] std::string plot_kinds_help();

[[nodiscard]] std::vector<std::string> plot_kinds();

/// Draws one figure, without a file of characters on standard output. Exit code 1 where it is of a
/// design that cannot fly as required.
int run_plot(const PlotOptions& options, const Output& output);

/// Writes the page. `options` names the spec and the logs, which may both be there; `command` is
/// what was typed, for a shell. The exit code is that of `optimize` for the spec.
int run_report(const DiagnoseOptions& options, const std::string& command, const Output& output);

/// The command line, given with the program's name, as one may type it into a shell again.
[[nodiscard]] std::string shell_command(std::span<const char* const> arguments);

}  // namespace tethercalc::cli
