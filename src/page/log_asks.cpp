#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "io/json_document.hpp"
#include "io/log_questions.hpp"
#include "page/asks.hpp"
#include "page/page_json.hpp"
#include "report/result_values.hpp"
#include "report/told_diagnosis.hpp"
#include "tethercalc/io/log_summary.hpp"
#include "tethercalc/io/spec_writer.hpp"
#include "tethercalc/report/drag_report.hpp"
#include "tethercalc/report/log_report.hpp"
#include "tethercalc/report/result_figures.hpp"

namespace tethercalc::page {
namespace {

LogReaders logs_of(const Request& request) {
  return {[&request](const std::string& name, const FlightLogOptions& how) {
            return parse_flight_log(request.file(name), name, how);
          },
          [&request](const std::string& name, const PowerLogOptions& how) {
            return parse_power_log(request.file(name), name, how);
          }};
}

FlightOptions flight_options(const Request& request) {
  FlightOptions options;
  options.core = request.whole("core", 0);
  if (options.core < 0 || options.core > 255) {
    throw InputError("core", fmt::format("{} is out of range; allowed is 0 to 255", options.core));
  }
  options.from = request.typed("from").value_or("");
  options.to = request.typed("to").value_or("");
  options.trim_log = request.text_or("trim_log", "");
  options.pitch_offset_deg = request.number("pitch_offset_deg");
  options.mass_g = request.number("mass_g");
  options.air_density_kg_m3 = request.number("air_density_kg_m3");
  options.pressure_hPa = request.number("pressure_hPa");
  options.temperature_C = request.number("temperature_C");
  options.published_kinematics = request.flag("published_kinematics");
  return options;
}

ordered_json log(const Request& request) {
  const std::string name = request.text("file");
  const LogSummary summary = summarize_log(AutopilotLog(request.file(name), name));
  return {{"text", log_text(summary, name)}, {"result", log_json(summary, name)}};
}

/// What the options say of mass and air, as `drag` takes them.
std::string drag_command(const std::vector<std::string>& names, const FlightOptions& flight) {
  std::string out = "tethercalc drag";
  for (const std::string& name : names) out += " " + name;
  const auto add = [&out](const char* option, const auto& value) {
    if (value) out += fmt::format(" {} {}", option, *value);
  };
  add("--mass-g", flight.mass_g);
  add("--air-density", flight.air_density_kg_m3);
  add("--pressure-hPa", flight.pressure_hPa);
  add("--temperature-C", flight.temperature_C);
  add("--pitch-offset-deg", flight.pitch_offset_deg);
  if (!flight.trim_log.empty()) out += " --trim-log " + flight.trim_log;
  if (!flight.from.empty()) out += " --from " + flight.from;
  if (!flight.to.empty()) out += " --to " + flight.to;
  if (flight.core != 0) out += fmt::format(" --core {}", flight.core);
  return out;
}

ordered_json drag(const Request& request) {
  const std::vector<std::string> names = request.list("file");
  if (names.empty()) throw InputError("file", "is needed: a log, or a list of them");
  FlightOptions flight = flight_options(request);
  std::optional<DesignFile> design;
  if (request.has("spec")) {
    design = request.design();
    flight = flown_as(std::move(flight), design->design);
  }
  const LearnedDrag learned = learned_drag(names, flight, logs_of(request));
  const DragStudy& study = learned.study;
  ordered_json figures = ordered_json::array();
  add_figure(figures, "drag", drag_figure(study));
  add_figure(figures, "drag surface", drag_surface_figure(study));
  add_figure(figures, "log", log_figure(names.front(), study.identified.flights.front()));
  ordered_json out{{"text", drag_text(study.identified, {})},
                   {"result", drag_json(study.identified, learned.notes)},
                   {"figures", std::move(figures)},
                   {"command", drag_command(names, flight)}};
  add_notes(out, learned.notes);
  if (design) out["spec"] = json_text(spec_with_drag(*design, study.identified.fit));
  return out;
}

LogsAsked logs_asked(const Request& request) {
  LogsAsked options;
  options.flight_logs = request.list("flights");
  if (const auto power = request.text_or("power", ""); !power.empty()) options.power_logs = {power};
  if (const auto log = request.text_or("log", ""); !log.empty()) options.whole_logs = {log};
  options.batteries = request.list("batteries");
  options.free_flight = request.flag("free_flight");
  options.base = request.list("base");
  options.flight = flight_options(request);
  return with_halves(std::move(options));
}

ordered_json diagnose(const Request& request) {
  const LogsAsked options = logs_asked(request);
  const DesignFile file = request.design();
  const AskedDiagnosis asked = diagnosis_question(options, file.design, {}, logs_of(request));
  const ToldDiagnosis told = told_diagnosis(studied_diagnosis(asked, options), file);
  ordered_json figures = ordered_json::array();
  const auto draw = [&figures](const char* kind, const std::string& log,
                               const std::optional<Diagnosis>& diagnosis) {
    // Logs too short to judge have nothing to draw.
    if (!diagnosis || diagnosis->compared.empty()) return;
    add_figure(figures, kind, diagnosis_figure(log, *diagnosis));
  };
  draw("flight", heading_of(options.flight_logs), told.flight);
  draw("power", heading_of(options.power_logs), told.power);
  return {{"text", told_text(told, {})},
          {"result", told_json(told)},
          {"figures", std::move(figures)},
          {"spec", json_text(told.spec)}};
}

}  // namespace

std::span<const Ask> log_asks() {
  static constexpr std::array asks{Ask{"log", log}, Ask{"drag", drag}, Ask{"diagnose", diagnose}};
  return asks;
}

}  // namespace tethercalc::page
