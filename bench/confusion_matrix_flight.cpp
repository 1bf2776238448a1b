// Flies simulated drones with every effect of a flight hidden in turn and prints what the diagnosis
// says: a confusion matrix in Markdown, with the coverage of the intervals and the false alarms.
// Usage: confusion_matrix_flight [flights a row, 20] [real|quiet]
#include <fmt/format.h>

#include <algorithm>
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
          {"drag with roll", &HiddenFlight::roll_drag, 20, 80, false, "roll_deg"},
          {"step of the drag", &HiddenFlight::step_drag, 0.15, 0.5, true, "time_s"},
          {"step of a force", &HiddenFlight::step_force, 0.3, 1, true, "time_s"},
          {"drag with height", &HiddenFlight::height_drag, 0.02, 0.06, true, "height_m"}};
}

HiddenFlight drawn_flight(const Row& row, std::uint64_t seed, bool quiet) {
  std::mt19937_64 random(seed);
  const auto uniform = [&random](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  HiddenFlight hidden;
  hidden.seed = seed;
  hidden.mass = uniform(1.5, 2.3);
  hidden.front_area = uniform(0.010, 0.022);
  hidden.top_area = uniform(0.012, 0.022);
  hidden.linear = uniform(12, 20);
  hidden.wind = uniform(-1.8, 1.8);
  if (quiet) {
    hidden.gust_std = 0.05;
    hidden.gust_time = 2;
    hidden.speed_noise = 0.008;
    hidden.angle_noise = 0.23;
  }
  if (row.field == nullptr) return hidden;
  const double sign = row.either_sign && uniform(0, 1) < 0.5 ? -1 : 1;
  hidden.*(row.field) = sign * uniform(row.weakest, row.strongest);
  if (row.channel == "roll_deg") hidden.roll_std = 3.5;
  if (row.hidden == "turning_wind") {
    hidden.yaw_turns = true;
    hidden.wind = 0;
    hidden.wind_east = uniform(-2, 2);
  }
  return hidden;
}

struct Tally {
  std::map<std::string, int> first;
  int in_set = 0;  ///< first, or in a set of at most three with the first
  int strong = 0;  ///< flights in which the effect removes 5 % or more
  int strong_in_set = 0;
  int named = 0;
  int covered = 0;
  int structure = 0;
  int right_channel = 0;
};

void count(Tally& tally, const Row& row, const HiddenFlight& hidden, const Diagnosis& d) {
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
  tally.strong += f.gain_percent >= 5 ? 1 : 0;
  tally.strong_in_set += in_set && f.gain_percent >= 5 ? 1 : 0;
  if (f.effect != row.hidden) return;
  ++tally.named;
  const double truth = hidden.*(row.field);
  const ParameterEstimate& p = f.parameters.front();
  tally.covered += p.ci95_lower <= truth && truth <= p.ci95_upper ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  const int flights = argc > 1 ? std::atoi(argv[1]) : 20;
  const bool quiet = argc > 2 && std::string(argv[2]) == "quiet";
  std::vector<std::string> columns{"none"};
  for (const Effect& effect : effect_catalogue()) {
    if (effect.log == LogKind::flight && effect.id != "linear_drag" && effect.id != "wind") {
      columns.push_back(effect.id);
    }
  }
  fmt::print(
      "| hidden \\ first finding | {} | first or in set | of those removing 5 % | truth in "
      "95 % interval | unnamed structure | its channel |\n",
      fmt::join(columns, " | "));
  std::string rule = "|";
  for (std::size_t k = 0; k < columns.size() + 6; ++k) rule += "---|";
  fmt::print("{}\n", rule);
  std::uint64_t seed = 100000;
  for (const Row& row : rows()) {
    Tally tally;
    for (int k = 0; k < flights; ++k) {
      const HiddenFlight hidden = drawn_flight(row, ++seed, quiet);
      Design design;
      design.drone.mass = hidden.mass;
      design.flight.air_density = hidden.air_density;
      FlightDiagnosisOptions options;
      options.base = {"linear_drag", "wind"};
      count(tally, row, hidden, diagnose_flight(design, truth::fly(hidden), options));
    }
    std::string line = "| " + row.hidden;
    for (const std::string& column : columns) line += fmt::format(" | {}", tally.first[column]);
    fmt::print("{} | {} | {}/{} | {}/{} | {} | {} |\n", line, tally.in_set, tally.strong_in_set,
               tally.strong, tally.covered, tally.named, tally.structure,
               row.channel.empty() ? std::string("") : fmt::format("{}", tally.right_channel));
    std::fflush(stdout);
  }
}
