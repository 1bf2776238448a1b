#include "tethercalc/report/cable_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "model/constants.hpp"
#include "report/result_values.hpp"
#include "tethercalc/io/spec_fields.hpp"
#include "tethercalc/report/design_report.hpp"

namespace tethercalc {
namespace {

constexpr int station_count = 11;

std::string_view outcome_name(CableOutcome outcome) {
  return cable_outcome_names()[static_cast<std::size_t>(outcome)];
}

ordered_json vector_json(const Vector3& v) { return {v.x, v.y, v.z}; }

std::vector<CablePoint> stations_of(const CableShape& shape) {
  std::vector<CablePoint> out;
  const std::size_t pieces = shape.points.size() - 1;
  for (std::size_t k = 0; k < station_count; ++k) {
    out.push_back(shape.points[k * pieces / (station_count - 1)]);
  }
  return out;
}

ordered_json station_json(const CablePoint& p) {
  return {p.s, p.position.x, p.position.y, p.position.z, p.tension};
}

/// Of the pull on the drone, from straight down.
double angle_at_drone(const HangingCable& loads) {
  return std::atan2(std::hypot(loads.on_drone.x, loads.on_drone.y), -loads.on_drone.z) /
         unit::degree;
}

ordered_json hover_json(const LoadedHover& hover) {
  return {{"down_N", hover.down},
          {"against_N", hover.against},
          {"across_N", hover.across},
          {"pitch_deg", hover.pitch / unit::degree},
          {"necessary_thrust_g", number_or_null(hover.thrust / unit::gram_force)},
          {"drone_power_W", number_or_null(hover.drone_power)},
          {"total_power_W", number_or_null(hover.total_power)}};
}

ordered_json loads_json(const HangingCable& loads, const CableShape& shape) {
  return {{"F_on_drone_N", vector_json(loads.on_drone)},
          {"F_on_anchor_N", vector_json(loads.on_station)},
          {"T_drone_N", loads.tension_at_drone},
          {"T_anchor_N", loads.tension_at_station},
          {"T_min_N", shape.slackest.tension},
          {"T_max_N", shape.tautest.tension},
          {"z_low_m", std::min(shape.lowest.position.z, 0.0)}};
}

std::string_view profile_name(WindProfile profile) {
  return field_words(FieldKind::wind_profile)[static_cast<std::size_t>(profile)];
}

/// Of a wind that grows with height, how; empty of another.
std::string profile_words(const MovingAir& air) {
  if (air.profile == WindProfile::uniform) return "";
  const std::string known_at = significant(air.reference_height, 3);
  return air.profile == WindProfile::power_law
             ? fmt::format(" at {} m over ground, by the power {} of the height", known_at,
                           significant(air.exponent, 3))
             : fmt::format(" at {} m over ground, logarithmic over a roughness of {} m", known_at,
                           significant(air.roughness_length, 3));
}

void add_hover(TextTable& table, const char* name, const LoadedHover& hover) {
  table.add({name, fixed(hover.down, 2), fixed(hover.against, 2), fixed(hover.across, 2),
             fixed(hover.pitch / unit::degree, 1), fixed(hover.thrust / unit::gram_force, 0),
             fixed(hover.drone_power, 1), fixed(hover.total_power, 1)});
}

std::string difference_sentence(const ShapeStudy& study) {
  const double right = study.solved.total_power;
  const double straight = study.straight.total_power;
  if (!std::isfinite(right) && !std::isfinite(straight)) {
    return "Both take more power than motors or line have.";
  }
  if (!std::isfinite(right) || !std::isfinite(straight)) {
    return "One of the two takes more power than motors or line have.";
  }
  const double percent = 100 * (straight / right - 1);
  if (std::abs(percent) < 0.05) return "The straight tether takes the same power, within 0.1 %.";
  return fmt::format("The straight tether {} the power by {} %.",
                     percent < 0 ? "understates" : "overstates", fixed(std::abs(percent), 1));
}

std::string ground_sentence(const ShapeStudy& study) {
  return fmt::format(
      "touches the ground: without one it would hang {} m below the station. These loads are "
      "those without a ground.",
      fixed(-study.shape.lowest.position.z, 2));
}

}  // namespace

std::span<const std::string_view> cable_outcome_names() {
  static constexpr std::array<std::string_view, 5> names{
      "hangs", "too_short", "winch_tension_too_low", "not_found", "touches_ground"};
  return names;
}

std::string_view cable_outcome_name(const ShapeStudy& study) {
  return study.outcome == CableOutcome::hangs && !study.hangs_free ? cable_outcome_names().back()
                                                                   : outcome_name(study.outcome);
}

std::string no_shape_sentence(const ShapeStudy& study, const ShapeRequest& request) {
  const double distance = std::hypot(study.drone.x, study.drone.z);
  switch (study.outcome) {
    case CableOutcome::too_short:
      if (study.loads.length > study.cable_there_is) {
        return fmt::format("The cable is too short: {} m are needed, and there are {} m.",
                           significant(study.loads.length, 4),
                           significant(study.cable_there_is, 4));
      }
      return fmt::format("The cable is too short: {} m do not reach a drone {} m away.",
                         significant(*request.paid_out.length, 4), significant(distance, 4));
    case CableOutcome::tension_too_low:
      return fmt::format(
          "{} N at the winch cannot hold the cable up to the drone: whatever is paid "
          "out, it pulls harder.",
          significant(*request.paid_out.winch_tension, 3));
    default:
      return "No equilibrium of this cable was found, so that nothing is said about its shape.";
  }
}

std::string cable_shape_text(const DesignFile& file, double area, const ShapeRequest& request,
                             const ShapeStudy& study, const TextStyle& style) {
  std::string out = style.bold(file.name) + "\n\n";
  out +=
      fmt::format("{} mm² of {}: {} g/m, {} mm across the wind\n",
                  significant(area / unit::square_millimetre, 4), conductor_words(file.conductor),
                  significant(study.cable.weight / file.design.flight.gravity / unit::gram, 3),
                  significant(study.cable.diameter / unit::millimetre, 3));
  out += fmt::format("Drone {} m up and {} m aside, wind {} m/s{}\n",
                     significant(request.height, 3), significant(request.offset, 3),
                     significant(request.wind, 3), profile_words(study.air));
  if (study.outcome != CableOutcome::hangs) {
    return out + "\n" + style.bad(wrapped(no_shape_sentence(study, request)));
  }
  const double distance = std::hypot(request.height, request.offset);
  const double beyond = 100 * (study.loads.length / distance - 1);
  constexpr double rounding = 1e-8;  // %
  out += fmt::format("{} m paid out, {} % {} than the distance\n\n",
                     significant(study.loads.length, 4),
                     significant(std::abs(beyond) > rounding ? std::abs(beyond) : 0, 3),
                     beyond < -rounding ? "less" : "more");
  out += wrapped(fmt::format(
      "Tension: {} N at the station, {} N at the drone, least {} N. {}",
      fixed(study.loads.tension_at_station, 2), fixed(study.loads.tension_at_drone, 2),
      fixed(study.shape.slackest.tension, 2),
      "It " +
          strength_words(study.breaking_load, study.shape.tautest.tension, "its greatest tension") +
          "."));
  out += wrapped(fmt::format("At the drone the cable leaves {}° from straight down.",
                             fixed(angle_at_drone(study.loads), 1)));
  if (!study.hangs_free) {
    out += style.bad(wrapped("It " + ground_sentence(study)));
  }
  TextTable hovers({word_column("tether"), "down\nN", "against\nN", "across\nN", "tilt\n°",
                    "thrust\ng a motor", "drone\nW", "supply\nW"});
  add_hover(hovers, "as it hangs", study.solved);
  add_hover(hovers, "straight", study.straight);
  out += TitledTable{"The drone holding its place", hovers}.text(style);
  out += wrapped(difference_sentence(study));
  const double allowed = file.design.requirements.max_pitch;
  if (std::max(study.solved.pitch, study.straight.pitch) > allowed) {
    out += style.bad(wrapped(
        fmt::format("No flight is allowed a tilt of more than {}° (requirements.max_pitch_deg).",
                    significant(allowed / unit::degree, 3))));
  }
  for (const Warning& warning : spec_warnings(file)) out += wrapped("Note: " + warning.sentence);
  TextTable stations({"along\nm", "x\nm", "y\nm", "height\nm", "tension\nN"});
  for (const CablePoint& p : stations_of(study.shape)) {
    stations.add({fixed(p.s, 2), fixed(p.position.x, 2), fixed(p.position.y, 2),
                  fixed(p.position.z, 2), fixed(p.tension, 2)});
  }
  out += TitledTable{"Its shape; x points to where the drone stands aside", stations}.text(style);
  return out;
}

TitledTable flown_cable_table(const std::vector<FlownShape>& shapes) {
  TextTable table({word_column("flight"), "wind\nm/s", "paid out\nm", "down\nN", "against\nN",
                   "at the drone\nN", "at the station\nN", "least\nN", "leaves\n°"});
  for (const auto& [condition, request, study] : shapes) {
    if (study.outcome != CableOutcome::hangs) continue;
    table.add({condition_words(condition), fixed(request.wind, 1), fixed(study.loads.length, 2),
               fixed(study.solved.down, 2), fixed(study.solved.against, 2),
               fixed(study.loads.tension_at_drone, 2), fixed(study.loads.tension_at_station, 2),
               fixed(study.shape.slackest.tension, 2), fixed(angle_at_drone(study.loads), 1)});
  }
  return {"Pull on the drone, tensions, and the angle from straight down at the drone", table};
}

std::vector<std::string> flown_cable_sentences(const std::vector<FlownShape>& shapes) {
  std::vector<std::string> out;
  for (const auto& [condition, request, study] : shapes) {
    const std::string in = "In " + condition_words(condition);
    if (study.outcome != CableOutcome::hangs) {
      out.push_back(in + ": " + no_shape_sentence(study, request));
    } else if (!study.hangs_free) {
      out.push_back(in + " " + ground_sentence(study));
    }
  }
  return out;
}

ordered_json cable_shape_json(const DesignFile& file, double area, const ShapeStudy& study) {
  ordered_json out{{"name", file.name},
                   {"outcome", cable_outcome_name(study)},
                   {"cross_section_mm2", area / unit::square_millimetre},
                   {"cable",
                    {{"w_N_per_m", study.cable.weight},
                     {"diameter_m", study.cable.diameter},
                     {"Cd", study.cable.drag_coefficient},
                     {"EA_N", number_or_null(study.cable.axial_stiffness)}}},
                   {"drone_m", vector_json(study.drone)},
                   {"wind_m_s", vector_json(study.air.wind)},
                   {"air",
                    {{"density_kg_m3", study.air.density},
                     {"wind_profile", profile_name(study.air.profile)},
                     {"wind_reference_height_m", study.air.reference_height}}}};
  add_estimates(out, file.design);
  add_warnings(out, spec_warnings(file));
  if (study.outcome != CableOutcome::hangs) return out;
  out["length_m"] = study.loads.length;
  out["hangs_free"] = study.hangs_free;
  out.update(loads_json(study.loads, study.shape));
  out["s_low_m"] = study.shape.lowest.s;
  out["angle_at_drone_deg"] = angle_at_drone(study.loads);
  out["breaking_load_N"] =
      study.breaking_load > 0 ? ordered_json(study.breaking_load) : ordered_json(nullptr);
  out["solved"] = hover_json(study.solved);
  out["straight"] = hover_json(study.straight);
  out["stations"] = json_list(stations_of(study.shape), station_json);
  return out;
}

std::string cable_shape_csv(const ShapeStudy& study) {
  std::string out = "s_m,x_m,y_m,z_m,tension_N\n";
  for (const CablePoint& p : study.shape.points) out += csv_line(station_json(p));
  return out;
}

namespace {

ordered_json plane_case_json(const SolvedCase& solved) {
  const CableCase& c = solved.asked;
  const Catenary& shape = solved.catenary;
  const double h = shape.horizontal;
  const double start = shape.vertical_at_start;
  const double end = shape.vertical_at_end;
  const double at_anchor = std::hypot(h, start);
  const double at_drone = std::hypot(h, end);
  const auto at = [&](double s) {
    return catenary_point(shape, s, c.cable.weight, c.cable.axial_stiffness);
  };
  const bool inside = start < 0 && end > 0;
  const double lowest = -start / c.cable.weight;
  ordered_json stations = ordered_json::array();
  for (int k = 0; k < station_count; ++k) {
    const double s = c.length * k / (station_count - 1);
    const CatenaryPoint p = at(s);
    stations.push_back({s, p.x, p.z, p.tension});
  }
  return {{"outcome", outcome_name(solved.outcome)},
          {"H_N", h},
          {"V_anchor_N", start},
          {"V_drone_N", end},
          {"T_anchor_N", at_anchor},
          {"T_drone_N", at_drone},
          {"T_top_N", std::max(at_anchor, at_drone)},
          {"z_low_m", inside ? at(lowest).z : std::min(c.drone.z, 0.0)},
          {"s_low_m", inside ? ordered_json(lowest) : ordered_json(nullptr)},
          {"F_on_drone_N", {-h, -end}},
          {"F_on_anchor_N", {h, start}},
          {"stations", stations}};
}

ordered_json space_case_json(const SolvedCase& solved) {
  ordered_json out{{"outcome", outcome_name(solved.outcome)}};
  out.update(loads_json(solved.loads, solved.shape));
  const Vector3& a = solved.loads.on_drone;
  const Vector3& b = solved.loads.on_station;
  const double weight = solved.asked.cable.weight * solved.asked.length;
  out["total_drag_N"] = {a.x + b.x, a.y + b.y, a.z + b.z + weight};
  out["stations"] = json_list(stations_of(solved.shape), station_json);
  return out;
}

ordered_json case_json(const SolvedCase& solved) {
  if (solved.outcome != CableOutcome::hangs) return {{"outcome", outcome_name(solved.outcome)}};
  return solved.asked.in_plane ? plane_case_json(solved) : space_case_json(solved);
}

}  // namespace

ordered_json cable_cases_json(std::span<const SolvedCase> cases) {
  return {{"cases", json_list(cases, [](const SolvedCase& solved) {
             return ordered_json{{"id", solved.asked.id}, {"result", case_json(solved)}};
           })}};
}

}  // namespace tethercalc
