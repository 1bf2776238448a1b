// Flies simulated drones with every effect of a flight hidden in turn and prints what the diagnosis
// says: a confusion matrix in Markdown, with the coverage of the intervals and the false alarms.
// Usage: confusion_matrix_flight [flights a row, 20] [condition, real] [one row]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "hidden_effects/simulated_flight.hpp"
#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/diagnose/flight_diagnosis.hpp"

using namespace tethercalc;
using truth::HiddenFlight;

namespace {

struct Row {
  std::string hidden;
  double HiddenFlight::*field = nullptr;
  double weakest = 0;
  double strongest = 0;
  bool either_sign = false;
  std::string channel;  ///< of an effect that no catalogue has
};

std::vector<Row> rows() {
  return {{"nothing", nullptr, 0, 0, false, ""},
          {"attitude_delay", &HiddenFlight::attitude_delay, 0.03, 0.25, false, ""},
          {"pitch_trim", &HiddenFlight::pitch_trim, 0.7, 3, true, ""},
          {"turning_wind", &HiddenFlight::wind_north, 1, 4, true, ""},
          {"wind_drift", &HiddenFlight::wind_drift, 1, 4, true, ""},
          {"fore_aft_asymmetry", &HiddenFlight::fore_aft_asymmetry, 0.08, 0.3, true, ""},
          {"propwash", &HiddenFlight::propwash, 0.12, 0.8, false, ""},
          {"vertical_coupling", &HiddenFlight::vertical_coupling, 0.04, 0.2, true, ""},
          {"tether_pull", &HiddenFlight::tether_pull, 0.3, 1.5, true, ""},
          {"growing_pull", &HiddenFlight::growing_pull, 0.004, 0.04, false, ""},
          {"wind_shear", &HiddenFlight::wind_shear, 0.05, 0.2, true, ""},
          {"wind_step", &HiddenFlight::wind_step, 1.5, 4, true, ""},
          {"wind_wave", &HiddenFlight::wind_wave, 1, 3, true, ""},
          {"mass_drop", &HiddenFlight::mass_drop, 12, 40, false, ""},
          {"slung_load", &HiddenFlight::slung_load, 2, 30, false, ""},
          {"yaw_misalign", &HiddenFlight::yaw_misalign, 5, 20, true, ""},
          {"velocity_lag", &HiddenFlight::velocity_lag, 0.05, 0.3, false, ""},
          {"velocity_scale", &HiddenFlight::velocity_scale, 1.05, 1.3, false, ""},
          {"drag with roll", &HiddenFlight::roll_drag, 20, 80, false, "roll_deg"},
          {"step of a force", &HiddenFlight::step_force, 0.3, 1, true, "time_s"},
          {"drag with height", &HiddenFlight::height_drag, 0.02, 0.06, true, "height_m"}};
}

/// What makes a flight other than the default.
struct FlightCondition {
  const char* name;
  void (*set)(HiddenFlight&);
};

void flown_to_the_side(HiddenFlight& h) {
  h.steepest_roll = 20;
  h.crosswind = 1;
  h.roll_trim = 1;
}

std::vector<FlightCondition> conditions() {
  using truth::Pattern;
  return {{"real", [](HiddenFlight&) {}},
          {"quiet",
           [](HiddenFlight& h) {
             h.gust_std = 0.05;
             h.gust_time = 2;
             h.speed_noise = 0.008;
             h.angle_noise = 0.23;
           }},
          {"2Hz", [](HiddenFlight& h) { h.steps_per_sample = 50; }},
          {"5Hz", [](HiddenFlight& h) { h.steps_per_sample = 20; }},
          {"25Hz", [](HiddenFlight& h) { h.steps_per_sample = 4, h.duration = 300; }},
          {"50Hz", [](HiddenFlight& h) { h.steps_per_sample = 2, h.duration = 200; }},
          {"half_noise",
           [](HiddenFlight& h) { h.gust_std /= 2, h.speed_noise /= 2, h.angle_noise /= 2; }},
          {"double_noise",
           [](HiddenFlight& h) { h.gust_std *= 2, h.speed_noise *= 2, h.angle_noise *= 2; }},
          {"lag_0.7", [](HiddenFlight& h) { h.gust_time = 0.28; }},
          {"lag_0.95", [](HiddenFlight& h) { h.gust_time = 2; }},
          {"120s", [](HiddenFlight& h) { h.duration = 120; }},
          {"200s", [](HiddenFlight& h) { h.duration = 200; }},
          {"900s", [](HiddenFlight& h) { h.duration = 900; }},
          {"hover_first", [](HiddenFlight& h) { h.pattern = Pattern::hover_first; }},
          {"long_forward", [](HiddenFlight& h) { h.pattern = Pattern::long_forward; }},
          {"circles", [](HiddenFlight& h) { h.pattern = Pattern::circles; }},
          {"slipping_circles",
           [](HiddenFlight& h) { h.pattern = Pattern::circles, h.lateral_std = 1.5; }},
          {"turns", [](HiddenFlight& h) { h.yaw_turns = true; }},
          {"gusts_with_speed", [](HiddenFlight& h) { h.gust_std = 0.1, h.gust_with_speed = 0.15; }},
          {"pitch_drift", [](HiddenFlight& h) { h.pitch_drift = 0.3; }},
          {"speed_0.01", [](HiddenFlight& h) { h.speed_digit = 0.01; }},
          {"speed_0.1", [](HiddenFlight& h) { h.speed_digit = 0.1; }},
          {"gentle", [](HiddenFlight& h) { h.steepest_pitch = 15; }},
          {"climbs", [](HiddenFlight& h) { h.climb = 20; }},
          {"rolling", [](HiddenFlight& h) { h.roll_std = 5; }},
          {"both_axes", flown_to_the_side},
          {"both_axes_turning", [](HiddenFlight& h) { flown_to_the_side(h), h.yaw_turns = true; }}};
}

HiddenFlight drawn_flight(const Row& row, std::uint64_t seed, const FlightCondition& condition) {
  std::mt19937_64 random(seed);
  const auto uniform = [&random](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  HiddenFlight hidden;
  hidden.seed = seed;
  truth::draw_drone(hidden, random);
  condition.set(hidden);
  if (row.field == nullptr) return hidden;
  const double sign = row.either_sign && uniform(0, 1) < 0.5 ? -1 : 1;
  hidden.*(row.field) = sign * uniform(row.weakest, row.strongest);
  if (row.hidden == "wind_shear") hidden.climb = std::max(hidden.climb, 20.0);
  if (row.channel == "roll_deg") hidden.roll_std = std::max(hidden.roll_std, 3.5);
  if (row.hidden == "turning_wind") {
    hidden.yaw_turns = hidden.pattern != truth::Pattern::circles;
    hidden.wind = 0;
    hidden.crosswind = 0;
    hidden.wind_east = uniform(-2, 2);
  }
  return hidden;
}

struct Tally {
  std::map<std::string, int> first;
  int in_set = 0;  ///< first, or in a set of at most three with the first
  int strong = 0;  ///< flights in which the effect removes 5 % or more
  int strong_in_set = 0;
  int more = 0;  ///< flights with a second name
  int named = 0;
  int covered = 0;
  int structure = 0;
  int right_channel = 0;
};

Diagnosis diagnosed(const HiddenFlight& hidden, const FlightLog& log,
                    const std::vector<std::string>& base) {
  Design design;
  design.drone.mass = hidden.mass;
  design.flight.air_density = hidden.air_density;
  FlightDiagnosisOptions options;
  options.base = base;
  return diagnose_flight(design, log, options);
}

/// Percent of the held-out error that the hidden effect removes, found or not.
double removed(const Row& row, const HiddenFlight& hidden, const FlightLog& log,
               const Diagnosis& d) {
  const Diagnosis told = diagnosed(hidden, log, {"linear_drag", "wind", row.hidden});
  return 100 * (1 - told.base.holdout_rmse / d.base.holdout_rmse);
}

/// What blows or pulls along the first heading is told along the mean one and across it.
double along_mean_heading(const FlightLog& log, double along_first_heading) {
  double north = 0;
  double east = 0;
  for (const double yaw : log.yaw) {
    north += std::cos(yaw);
    east += std::sin(yaw);
  }
  return along_first_heading * std::cos(std::atan2(east, north) - log.yaw.front());
}

void count(Tally& tally, const Row& row, const HiddenFlight& hidden, const FlightLog& log) {
  const Diagnosis d = diagnosed(hidden, log, {"linear_drag", "wind"});
  const bool named_effect = row.field != nullptr && row.channel.empty();
  const bool strong = named_effect && removed(row, hidden, log, d) >= 5;
  tally.strong += strong ? 1 : 0;
  tally.structure += d.unexplained.detected ? 1 : 0;
  tally.right_channel +=
      d.unexplained.detected && d.unexplained.channels.front() == row.channel ? 1 : 0;
  if (d.findings.empty()) {
    ++tally.first["none"];
    return;
  }
  const Finding& f = d.findings.front();
  ++tally.first[f.effect];
  const auto& rivals = f.indistinguishable_from;
  const bool in_set =
      f.effect == row.hidden || std::find(rivals.begin(), rivals.end(), row.hidden) != rivals.end();
  tally.in_set += in_set ? 1 : 0;
  tally.strong_in_set += in_set && strong ? 1 : 0;
  tally.more += d.findings.size() > 1 ? 1 : 0;
  if (f.effect != row.hidden) return;
  ++tally.named;
  // Of what has a second part to the right of the mean heading.
  const bool has_heading = std::ranges::any_of(
      find_effect(row.hidden)->parameters,
      [](const EffectParameter& q) { return q.shown == Shown::turning_or_to_the_side; });
  const double hidden_size = hidden.*(row.field);
  const double truth = has_heading ? along_mean_heading(log, hidden_size) : hidden_size;
  const ParameterEstimate& p = f.parameters.front();
  tally.covered += p.ci95_lower <= truth && truth <= p.ci95_upper ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  const int flights = argc > 1 ? std::atoi(argv[1]) : 20;
  const std::vector<FlightCondition> known = conditions();
  const std::string wanted = argc > 2 ? argv[2] : known.front().name;
  const auto condition = std::find_if(
      known.begin(), known.end(), [&wanted](const FlightCondition& c) { return wanted == c.name; });
  if (flights < 1 || condition == known.end()) {
    fmt::print(stderr, "usage: confusion_matrix_flight [FLIGHTS] [CONDITION] [ROW], one of");
    for (const FlightCondition& c : known) fmt::print(stderr, " {}", c.name);
    fmt::print(stderr, "\n");
    return 2;
  }
  std::vector<std::string> columns{"none"};
  for (const Effect& effect : effect_catalogue()) {
    if (effect.log == LogKind::flight && !effect.in_first_look) columns.push_back(effect.id);
  }
  fmt::print(
      "| hidden \\ first finding | {} | first or in set | of those removing 5 % | truth in "
      "95 % interval | more names | unnamed structure | its channel |\n",
      fmt::join(columns, " | "));
  std::string rule = "|";
  for (std::size_t k = 0; k < columns.size() + 7; ++k) rule += "---|";
  fmt::print("{}\n", rule);
  std::uint64_t seed = 100000;
  for (const Row& row : rows()) {
    if (argc > 3 && row.hidden != argv[3]) {
      seed += static_cast<std::uint64_t>(flights);
      continue;
    }
    Tally tally;
    for (int k = 0; k < flights; ++k) {
      const HiddenFlight hidden = drawn_flight(row, ++seed, *condition);
      count(tally, row, hidden, truth::fly(hidden));
    }
    std::string line = "| " + row.hidden;
    for (const std::string& column : columns) line += fmt::format(" | {}", tally.first[column]);
    fmt::print("{} | {} | {}/{} | {}/{} | {} | {} | {} |\n", line, tally.in_set,
               tally.strong_in_set, tally.strong, tally.covered, tally.named, tally.more,
               tally.structure,
               row.channel.empty() ? std::string("") : fmt::format("{}", tally.right_channel));
    std::fflush(stdout);
  }
}
