#include "cli/commands.hpp"

#include <string_view>

#include "tethercalc/files/gnuplot.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/io/library.hpp"
#include "tethercalc/report/report_page.hpp"

namespace tethercalc::cli {
namespace {

/// The drag that the flight shows, mass and air as the spec has them where the options do not say.
DragStudy learn_drag(const DiagnoseOptions& options, const Design& design) {
  FlightOptions flight = options.flight;
  if (!flight.mass_g) flight.mass_g = design.drone.mass / unit::gram;
  if (!air_density(flight)) flight.air_density_kg_m3 = design.flight.air_density;
  return studied_drag(base_name(options.flight_log), {options.flight_log}, flight);
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

int run_report(const DiagnoseOptions& options, const std::string& command, const Output& output) {
  const DesignFile file = read_spec(options.spec);
  PageContent content;
  content.file = file;
  content.command = command;
  content.gnuplot = run_gnuplot;
  if (!options.flight_log.empty()) content.drag = learn_drag(options, file.design);
  if (!options.flight_log.empty() || !options.power_log.empty()) {
    const ToldDiagnosis told = diagnose_logs(options, file);
    if (told.flight) content.diagnoses.push_back({base_name(options.flight_log), *told.flight});
    if (told.power) content.diagnoses.push_back({base_name(options.power_log), *told.power});
  }
  content.motors = compare_motors(file.design, library_motors());
  content.optimum = study_optimum(file.design, wire_sizes());
  content.curve = area_curve(content.optimum);
  emit(output, report_page(content));
  return content.optimum.result.feasible ? done : answer_is_no;
}

std::string shell_command(std::span<const char* const> arguments) {
  std::string out = "tethercalc";
  for (const char* word : arguments.subspan(1)) out += " " + shell_word(word);
  return out;
}

}  // namespace tethercalc::cli
