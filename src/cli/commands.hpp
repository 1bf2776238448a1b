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
#include "io/log_questions.hpp"
#include "report/told_diagnosis.hpp"
#include "tethercalc/io/design_reader.hpp"
#include "tethercalc/io/design_request.hpp"
#include "tethercalc/model/warning.hpp"
#include "tethercalc/report/text_table.hpp"
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
/// A line on standard error for each, behind the command's name.
void remark_warnings(std::string_view command, std::span<const Warning> warnings);
void be_quiet();
/// Whether progress may be shown: standard error is a terminal and nobody asked to be quiet.
[[nodiscard]] bool shows_progress();

/// Columns of the terminal: COLUMNS, what the terminal says, or 100 where there is none.
[[nodiscard]] int terminal_columns();

/// Ends the program as one whose reader has enough, `head` perhaps: by the signal that says so to
/// the shell, without a word.
[[noreturn]] void die_of_closed_pipe();

/// Why a file that is read is not written.
[[nodiscard]] std::string is_read_words(const std::string& file);

/// Refuses to write what `option` names over a file that this run has read, whoever named that: an
/// argument, a spec or a folder. Throws InputError.
void check_not_read(const std::string& option, const std::string& file);

/// Writes what `option` asks for, whole or not at all. Throws InputError where it cannot, and for a
/// file that was read.
void write_asked(const std::string& option, const std::string& file, std::string_view content);

/// Writes the answer, to the file whole or not at all. Throws InputError where it cannot.
void emit(const Output& output, const std::string& text);

/// Takes one line of an answer, with its newline.
using LineTaker = std::function<void(std::string_view line)>;

/// Writes an answer of any length as `lines` gives it, to the file whole or not at all. Throws
/// InputError where it cannot.
void emit_lines(const Output& output, const std::function<void(const LineTaker&)>& lines);

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

/// Remarks which changes are of fields that `option` of the command gives values of its own.
void remark_unused(const SpecOptions& spec, std::span<const SweepAxis> axes,
                   std::string_view command, std::string_view option);

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
  std::string cases_file;          ///< empty: the spec's cable
  std::vector<std::string> given;  ///< names of all options that were given
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
  std::optional<std::uint64_t> seed;
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
  std::string autopilot;               ///< "ardupilot": print its thrust curve instead
  std::optional<double> spin_min;      ///< see SpinRange
  std::optional<double> spin_max;
  std::optional<double> pwm_min_us;  ///< see PulseRange
  std::optional<double> pwm_max_us;
};

/// Shows a motor, or writes it as a motor file: as JSON, which an output file ending in .json is.
int run_motor(const MotorOptions& options, Output output);

/// `what`: "motors", "conductors", "insulation" or "sizes".
int run_list(const std::string& what, const Output& output);

/// Forms of an explanation.
enum class ExplanationForm { text, json, markdown };

/// The page of `code`, or where that is empty a list of all codes. Throws InputError with the
/// closest code where there is none.
int run_explain(const std::string& code, ExplanationForm form, const Output& output);

/// Says to a person at a terminal where more is told of `codes`, those that have a page, and of
/// `warnings`.
void point_to_explanations(std::vector<std::string> codes, std::span<const Warning> warnings,
                           const Output& output);

/// Says it on standard error.
void note_on_error(const Warning& note);

/// What an autopilot's log holds, or all messages of one name as CSV.
int run_log(const std::string& file, const std::string& message, const Output& output);

struct DragOptions {
  std::vector<std::string> logs;  ///< flights of one drone
  FlightOptions flight;
  SpecOptions spec;       ///< whose drag is replaced, and mass and air taken; without a name none
  bool into = false;      ///< print that spec instead of the fit
  std::string into_file;  ///< write it there instead, beside the fit
  std::string autopilot;  ///< "ardupilot" or "px4": print its parameter file instead
};

/// The drag of these logs. Says on standard error, so that no answer hides it, what was amiss with
/// them and, as of `command`, what was assumed.
[[nodiscard]] LearnedDrag learn_drag(std::string_view command, const std::vector<std::string>& logs,
                                     const FlightOptions& flight);

int run_drag(const DragOptions& options, const Output& output);

struct DiagnoseOptions : LogsAsked {
  SpecOptions spec;
  std::vector<std::string> effect_files;  ///< effects to try beside those of the catalogue
  bool into = false;                      ///< print the extended spec instead of the diagnosis
  std::string into_file;                  ///< write it there instead, beside the diagnosis
  std::string next_flight_file;           ///< write the mission of a further flight there
  std::string home;                       ///< where it begins: "LAT,LON" in degrees
  std::optional<double> height_m;
  std::optional<double> reach_m;
};

/// See with_halves.
[[nodiscard]] DiagnoseOptions with_both_halves(DiagnoseOptions options);

/// What the logs say, and which further flight would say more.
struct AnsweredDiagnosis : ToldDiagnosis {
  std::optional<NextFlight> next_flight{};  ///< where it was asked for
};

/// Compares the logs that `options` name with the spec, see studied_diagnosis; progress is shown on
/// a terminal. Throws InputError for bad input.
[[nodiscard]] AnsweredDiagnosis diagnose_logs(const DiagnoseOptions& options,
                                              const DesignFile& file);

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
/// `rules` is the id of a book of rules, or empty.
int run_report(const DiagnoseOptions& options, const std::string& rules, const std::string& command,
               const Output& output);

/// What the book of rules asks and how the design stands to it, with the conductor that the spec
/// states or else its optimum; exit code 1 where a clause fails.
int run_rules(const SpecOptions& spec, const std::string& rules, const Output& output);

/// The command line, given with the program's name, as one may type it into a shell again.
[[nodiscard]] std::string shell_command(std::span<const char* const> arguments);

}  // namespace tethercalc::cli
