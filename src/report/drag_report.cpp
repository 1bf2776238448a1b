#include "tethercalc/report/drag_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "report/result_values.hpp"

namespace tethercalc {
namespace {

ordered_json estimate_json(const Estimate& e, double unit = 1) {
  const auto interval =
      std::isfinite(e.lower) ? ordered_json{e.lower / unit, e.upper / unit} : ordered_json(nullptr);
  return {{"value", number_or_null(e.value / unit)},
          {"standard_error_independent", number_or_null(e.standard_error_independent / unit)},
          {"standard_error", number_or_null(e.standard_error / unit)},
          {"ci95", interval}};
}

std::string_view bound_name(Bound bound) { return bound == Bound::lower ? "lower" : "upper"; }

ordered_json parameter_json(const FittedParameter& parameter, double unit = 1) {
  ordered_json out = estimate_json(parameter.estimate, unit);
  if (parameter.at_bound != Bound::none) out["at_bound"] = bound_name(parameter.at_bound);
  return out;
}

/// Of each flight, null where it does not show it.
ordered_json own_json(const DragFit& fit, std::string_view name, double unit) {
  ordered_json out = ordered_json::array();
  for (std::size_t f = 0; f < fit.wind().size(); ++f) {
    const FittedParameter* own = fit.find(name, f);
    out.push_back(own == nullptr ? ordered_json(nullptr) : parameter_json(*own, unit));
  }
  return out;
}

/// Correlations of all pairs, as a matrix in the order of `parameters`.
ordered_json correlation_json(const DragFit& fit) {
  ordered_json matrix = ordered_json::array();
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    ordered_json row = ordered_json::array();
    for (std::size_t j = 0; j < fit.parameters.size(); ++j) row.push_back(fit.correlation(i, j));
    matrix.push_back(row);
  }
  const auto name = [](const FittedParameter& parameter) { return parameter.name; };
  return {{"parameters", json_list(fit.parameters, name)}, {"matrix", matrix}};
}

bool automatic(const DragIdentification& result) {
  return !result.options.from && !result.options.to;
}

constexpr std::string_view angle = "roll_trim_rad";  ///< the only one, for people in degrees

/// Areas as they are written in print, such as "1.492e-02"; the rest plainly.
std::string parameter_number(const FittedParameter& parameter, double value) {
  if (!std::isfinite(value)) return "–";
  if (parameter.name.starts_with(angle)) value /= unit::degree;
  const bool area = parameter.name.ends_with("area_m2");
  return area && value != 0 ? fmt::format("{:.3e}", value) : significant(value, 4);
}

std::string percent_of(double error, double value) {
  return std::isfinite(error) && value != 0 ? fixed(100 * error / std::abs(value), 2) + " %" : "–";
}

/// "wind_m_s[1]", as results name the second log's wind, for readers who count from one.
std::string title_of(const FittedParameter& parameter) {
  const std::size_t bracket = parameter.name.find('[');
  const std::string name = parameter.name.substr(0, bracket);
  const std::string title = name == angle ? "roll_trim_deg" : name;
  if (bracket == std::string::npos) return title;
  const int index = std::stoi(parameter.name.substr(bracket + 1));
  return fmt::format("{}, log {}", title, index + 1);
}

std::string range_sentence(const DragIdentification& result) {
  const bool several = result.flights.size() > 1;
  std::string out = automatic(result) ? "The moving part was chosen automatically: " : "Used: ";
  for (std::size_t i = 0; i < result.flights.size(); ++i) {
    const std::vector<double>& time = result.flights[i].time;
    out += fmt::format("{}{}{:.1f} s to {:.1f} s ({} samples)", i > 0 ? ", " : "",
                       several ? fmt::format("log {} ", i + 1) : "", time.front(), time.back(),
                       time.size());
  }
  return out + ".";
}

/// The tabulated speed whose force is relatively best known.
const SteadyDrag* best_known(const std::vector<SteadyDrag>& table) {
  const auto share = [](const SteadyDrag& row) {
    return row.force.standard_error / row.force.value;
  };
  const auto best = std::ranges::min_element(table, {}, share);
  return best == table.end() ? nullptr : &*best;
}

/// Force that is known this well, relative, may be called well determined.
constexpr double well_determined = 0.05;

/// deg in [0, 360).
double compass(double heading) {
  const double degrees = heading / unit::degree;
  return degrees < 0 ? degrees + 360 : degrees;
}

std::string wind_sentence(const DragFit& fit) {
  std::vector<std::string> headings;
  for (std::size_t f = 0; f < fit.wind_heading.size(); ++f) {
    if (!fit.wind_heading[f]) continue;
    headings.push_back(fmt::format(
        "{:.0f}°{}", compass(*fit.wind_heading[f]),
        fit.wind_heading.size() > 1 ? fmt::format(" in log {}", f + 1) : std::string()));
  }
  if (headings.empty()) return "";
  return fmt::format(
      "The wind blows over ground: wind_m_s along the mean heading ({} from north over east), "
      "crosswind_m_s to the right of it.",
      fmt::join(headings, ", "));
}

std::string entangled_sentence(const DragFit& fit) {
  const std::vector<EntangledPair> pairs = entangled_pairs(fit);
  if (pairs.empty()) return "";
  std::string out =
      fmt::format("Hardly told apart by {}, so that only together they mean something: ",
                  fit.covariance_by_flight.size() > 1 ? "these flights" : "this flight");
  for (const EntangledPair& pair : pairs) {
    out += fmt::format("{}{} and {} (correlation {})", &pair == &pairs.front() ? "" : ", ",
                       title_of(fit.parameters[pair.first]), title_of(fit.parameters[pair.second]),
                       fixed(pair.correlation, 3));
  }
  return out + ".";
}

std::string force_sentence(const std::vector<SteadyDrag>& table) {
  const SteadyDrag* best = best_known(table);
  if (best == nullptr) return "";
  const Estimate& force = best->force;
  const bool well = force.standard_error <= well_determined * force.value;
  return fmt::format("{} determined is the drag force: {} N ± {} at {:g} m/s.",
                     well ? "Well" : "Best, though not well,", significant(force.value, 3),
                     percent_of(force.standard_error, force.value), best->airspeed);
}

std::string residual_sentence(const FitQuality& quality) {
  return fmt::format(
      "Residuals: {} m/s² root mean square, {} m/s² mean absolute; R² {}. They resemble their "
      "neighbours (lag-1 autocorrelation {}), so {} samples are worth {} independent ones.",
      significant(quality.rmse, 3), significant(quality.mae, 3), fixed(quality.r_squared, 4),
      fixed(quality.residual_lag1_autocorrelation, 2), quality.samples,
      fixed(quality.effective_samples, 0));
}

ordered_json autopilot_json(const DragFit& fit, Autopilot autopilot) {
  ordered_json out;
  for (const AutopilotParameter& parameter : autopilot_drag(fit, autopilot).parameters) {
    ordered_json& entry = out[parameter.name];
    if (parameter.value) {
      entry = estimate_json(*parameter.value);
    } else {
      entry = {{"value", nullptr}, {"left_out_because", parameter.left_out_because}};
    }
    entry["unit"] = parameter.unit;
  }
  return out;
}

std::string commented(const std::string& sentence) { return wrapped(sentence, 92, "# "); }

/// How a parameter is set, in the words and the file format of its autopilot.
struct ParameterFileStyle {
  std::string_view title;
  std::string_view line;  ///< name and value
  std::string_view how_to_set;
};

ParameterFileStyle parameter_file_style(Autopilot autopilot) {
  if (autopilot == Autopilot::ardupilot) {
    return {"ArduPilot EKF3", "{},{}\n",
            "Load with Mission Planner (Full Parameter List, Load from file) or MAVProxy (param "
            "load). The wind is estimated from drag once any of these is set; "
            "https://ardupilot.org/copter/docs/airspeed-estimation.html tells how to check it."};
  }
  return {"PX4 EKF2", "1\t1\t{}\t{}\t9\n",
          "Load with QGroundControl (Vehicle Setup, Parameters, Tools, Load from file), or type "
          "`param set NAME VALUE` in the MAVLink console. They count once EKF2_DRAG_CTRL is 1 "
          "(before v1.14: bit 5 of EKF2_AID_MASK)."};
}

/// How far one drag area an axis, as the autopilots have it, carries.
std::string check_sentence(const AutopilotDragCheck& check) {
  return fmt::format(
      "They hold near level attitude: the autopilot has no area that shows as the drone tilts. In "
      "steady flight at {:g} m/s, tilted by {}°, it expects {} m/s² along the forward axis, and "
      "the "
      "fit has {} m/s².",
      check.airspeed, fixed(check.tilt / unit::degree, 1), significant(check.by_autopilot, 3),
      significant(check.by_fit, 3));
}

}  // namespace

std::vector<SteadyDrag> steady_drag_table(const DragFit& fit) {
  // The largest step of 1, 2 or 5 times a power of ten that gives at least eight rows, so at
  // most 20.
  constexpr double fewest_rows = 8;
  double step =
      std::pow(10.0, std::floor(std::log10(std::max(fit.max_airspeed, 1e-3) / fewest_rows)));
  for (double factor : {5.0, 2.0}) {
    if (fit.max_airspeed / (factor * step) >= fewest_rows) {
      step *= factor;
      break;
    }
  }
  std::vector<SteadyDrag> rows;
  for (int i = 1; i * step <= fit.max_airspeed; ++i) {
    const auto row = steady_drag(fit, i * step);
    if (row) rows.push_back(*row);
  }
  return rows;
}

std::vector<Warning> drag_warnings(const DragFit& fit) {
  std::vector<Warning> out;
  for (const FittedParameter& p : fit.parameters) {
    if (p.at_bound == Bound::none) continue;
    out.push_back(
        {WarningKind::drag_at_bound,
         fmt::format("{} wants to leave its {} bound {}: the flight lacks what would determine it. "
                     "The errors of the others take it as known.",
                     title_of(p), bound_name(p.at_bound), parameter_number(p, p.estimate.value))});
  }
  const std::vector<SteadyDrag> table = steady_drag_table(fit);
  const bool may_be_none =
      std::ranges::any_of(table, [](const SteadyDrag& row) { return !(row.force.lower > 0); });
  if (may_be_none) {
    out.push_back(
        {WarningKind::drag_may_be_none,
         "At some speeds the flight does not even tell that there is drag (intervals that reach "
         "below zero): fly longer, faster and in both directions."});
  }
  if (!fit.converged) {
    out.push_back({WarningKind::drag_not_converged,
                   "The fit did not converge; take its numbers as a guess."});
  }
  return out;
}

ordered_json drag_json(const DragIdentification& result, std::span<const Warning> notes) {
  const DragFit& fit = result.fit;
  const FitQuality& quality = fit.quality;
  ordered_json out;
  out["front_area_m2"] = parameter_json(fit.front_area());
  out["top_area_m2"] = parameter_json(fit.top_area());
  out["linear_m_s"] = parameter_json(fit.linear_speed());
  out["wind_m_s"] =
      json_list(fit.wind(), [](const FittedParameter& wind) { return parameter_json(wind); });
  const FittedParameter* const side = fit.find("side_area_m2");
  const bool over_ground = std::ranges::any_of(
      fit.wind_heading, [](const std::optional<double>& heading) { return heading.has_value(); });
  if (side) out["side_area_m2"] = parameter_json(*side);
  if (side || over_ground) out["crosswind_m_s"] = own_json(fit, "crosswind_m_s", 1);
  if (side) out["roll_trim_deg"] = own_json(fit, "roll_trim_rad", unit::degree);
  out["rmse_m_s2"] = quality.rmse;
  out["mae_m_s2"] = quality.mae;
  out["r_squared"] = quality.r_squared;
  out["residual_lag1_autocorrelation"] = quality.residual_lag1_autocorrelation;
  out["samples"] = quality.samples;
  out["effective_samples"] = quality.effective_samples;
  add_warnings(out, drag_warnings(fit));
  add_notes(out, notes);
  out["converged"] = fit.converged;
  out["correlation"] = correlation_json(fit);
  out["entangled"] = json_list(entangled_pairs(fit), [&](const EntangledPair& pair) {
    return ordered_json{
        {"parameters", {fit.parameters[pair.first].name, fit.parameters[pair.second].name}},
        {"correlation", pair.correlation}};
  });
  out["mass_g"] = fit.conditions.mass / unit::gram;
  out["air_density_kg_m3"] = fit.conditions.air_density;
  out["gravity_m_s2"] = fit.conditions.gravity;
  out["pitch_offset_deg"] = result.options.pitch_offset / unit::degree;
  out["kinematics"] = result.options.kinematics == Kinematics::published ? "published" : "exact";
  out["range"] = automatic(result) ? "automatic" : "given";
  out["flights"] = json_list(result.flights, [](const Observations& flight) {
    return ordered_json{
        {"from_s", flight.time.front()}, {"to_s", flight.time.back()}, {"samples", flight.size()}};
  });
  for (std::size_t f = 0; f < fit.wind_heading.size(); ++f) {
    if (fit.wind_heading[f]) out["flights"][f]["wind_heading_deg"] = compass(*fit.wind_heading[f]);
  }
  out["table"] = json_list(steady_drag_table(fit), [](const SteadyDrag& row) {
    return ordered_json{{"airspeed_m_s", row.airspeed},
                        {"drag_force_N", estimate_json(row.force)},
                        {"pitch_deg", estimate_json(row.tilt, unit::degree)}};
  });
  out["autopilot"] = {{"ardupilot", autopilot_json(fit, Autopilot::ardupilot)},
                      {"px4", autopilot_json(fit, Autopilot::px4)}};
  const AirframeDrag drag = fit.drag();
  out["drone"]["drag"] = {{"front_area_m2", drag.front_area},
                          {"top_area_m2", drag.top_area},
                          {"linear_m_s", drag.linear_speed}};
  return out;
}

TitledTable drag_parameter_table(const DragFit& fit) {
  TextTable table({word_column(""), "value", "std. error", "95 % interval",
                   "std. error if independent", word_column("")});
  for (const FittedParameter& p : fit.parameters) {
    const Estimate& e = p.estimate;
    const bool held = p.at_bound != Bound::none;
    table.add({title_of(p), parameter_number(p, e.value), percent_of(e.standard_error, e.value),
               held ? "–" : parameter_number(p, e.lower) + " … " + parameter_number(p, e.upper),
               percent_of(e.standard_error_independent, e.value),
               held ? fmt::format("held at its {} bound", bound_name(p.at_bound)) : ""});
  }
  return {"Drag parameters", std::move(table)};
}

TitledTable steady_flight_table(const DragFit& fit) {
  TextTable table({"airspeed m/s", "drag N", "95 % interval", "tilt deg", "95 % interval"});
  const auto interval = [](const Estimate& e, double unit, int decimals) {
    return fixed(e.lower / unit, decimals) + " … " + fixed(e.upper / unit, decimals);
  };
  for (const SteadyDrag& row : steady_drag_table(fit)) {
    table.add({fmt::format("{:g}", row.airspeed), fixed(row.force.value, 3),
               interval(row.force, 1, 3), fixed(row.tilt.value / unit::degree, 2),
               interval(row.tilt, unit::degree, 2)});
  }
  return {"Steady flight without wind and tether", std::move(table)};
}

DragSentences drag_sentences(const DragIdentification& result) {
  const DragFit& fit = result.fit;
  DragSentences out;
  out.made_of = {range_sentence(result),
                 fmt::format("Taken as known: {} g, {} kg/m³, pitch offset {}°.",
                             significant(fit.conditions.mass / unit::gram, 4),
                             significant(fit.conditions.air_density, 4),
                             fixed(result.options.pitch_offset / unit::degree, 3))};
  if (result.options.kinematics == Kinematics::published) {
    out.made_of.emplace_back("Fitted as published: one axis, expected acceleration over cos φ.");
  }
  out.quality = {wind_sentence(fit), entangled_sentence(fit),
                 force_sentence(steady_drag_table(fit))};
  std::erase(out.quality, "");
  for (Warning& warning : drag_warnings(fit)) out.quality.push_back(std::move(warning.sentence));
  out.quality.push_back(residual_sentence(fit.quality));
  return out;
}

std::string drag_text(const DragIdentification& result, const TextStyle& style) {
  const DragSentences told = drag_sentences(result);
  const TitledTable steady = steady_flight_table(result.fit);
  std::string out = style.bold("Drag from flight") + "\n";
  for (const std::string& sentence : told.made_of) out += wrapped(sentence);
  out += "\n" + drag_parameter_table(result.fit).table.text(style) + "\n";
  for (const std::string& sentence : told.quality) out += wrapped(sentence);
  return out + "\n" + steady.title + ":\n" + steady.table.text(style);
}

std::string drag_csv(const DragIdentification& result) {
  std::string out =
      "airspeed_m_s,drag_force_N,drag_force_standard_error_N,drag_force_lower_N,drag_force_upper_N,"
      "pitch_deg,pitch_standard_error_deg,pitch_lower_deg,pitch_upper_deg\n";
  for (const SteadyDrag& row : steady_drag_table(result.fit)) {
    out += csv_number(row.airspeed);
    for (const auto& [e, unit] : {std::pair{row.force, 1.0}, std::pair{row.tilt, unit::degree}}) {
      for (const double value : {e.value, e.standard_error, e.lower, e.upper}) {
        out += "," + csv_number(value / unit);
      }
    }
    out += "\n";
  }
  return out;
}

std::string autopilot_parameter_file(const DragIdentification& result, Autopilot autopilot) {
  const ParameterFileStyle style = parameter_file_style(autopilot);
  const AutopilotDrag drag = autopilot_drag(result.fit, autopilot);
  const DragFitConditions& known = result.fit.conditions;
  std::string out = commented(
      fmt::format("Drag of the drone for the wind estimate of {}, fitted by tethercalc to "
                  "{} samples at {} g and {} kg/m³.",
                  style.title, result.fit.quality.samples, significant(known.mass / unit::gram, 4),
                  significant(known.air_density, 4)));
  out += commented(std::string(style.how_to_set));
  out += commented("Set them together: what one leaves the other takes.");
  for (const Warning& warning : drag_warnings(result.fit)) out += commented(warning.sentence);
  if (drag.check) out += commented(check_sentence(*drag.check));
  for (const AutopilotParameter& parameter : drag.parameters) {
    if (!parameter.value) {
      out += commented(parameter.name + " is left out: " + with_stop(parameter.left_out_because));
      continue;
    }
    const Estimate& e = *parameter.value;
    out += commented(fmt::format("{} in {}, 95 % interval {} … {}", parameter.name, parameter.unit,
                                 significant(e.lower, 4), significant(e.upper, 4)));
    out += fmt::format(fmt::runtime(style.line), parameter.name, significant(e.value, 4));
  }
  return out;
}

}  // namespace tethercalc
