// Diagnoses of the flight of the paper and of the simulated practice flights, where they are at
// hand.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <set>
#include <sstream>

#include "support/random.hpp"
#include "support/reference_data.hpp"
#include "tethercalc/diagnose/flight_diagnosis.hpp"
#include "tethercalc/model/units.hpp"

using namespace tethercalc;

namespace {

FlightLog read_log(const std::filesystem::path& file) {
  FlightLog log;
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream row(line);
    double t = 0, roll = 0, pitch = 0, yaw = 0, north = 0, east = 0, down = 0;
    row >> t >> roll >> pitch >> yaw >> north >> east >> down;
    log.time.push_back(t);
    log.roll.push_back(roll * unit::degree);
    log.pitch.push_back(pitch * unit::degree);
    yaw *= unit::degree;
    if (!log.yaw.empty()) {
      yaw = log.yaw.back() + std::remainder(yaw - log.yaw.back(), 2 * std::numbers::pi);
    }
    log.yaw.push_back(yaw);
    log.north_velocity.push_back(north);
    log.east_velocity.push_back(east);
    log.down_velocity.push_back(down);
  }
  return log;
}

Diagnosis diagnosed(const MeasuredFlight& log, double mass, double air_density,
                    const FlightDiagnosisOptions& options) {
  Design design;
  design.drone.mass = mass;
  design.flight.air_density = air_density;
  return diagnose_flights(design, {&log, 1}, options);
}

MeasuredFlight published_part(const FlightLog& log) { return {log, range_in_percent(log, 25, 90)}; }

FlightDiagnosisOptions published_choice() {
  FlightDiagnosisOptions options;
  options.pitch_offset = 1.4955439766569403 * unit::degree;
  return options;
}

}  // namespace

TEST_CASE("the published flight shows linear drag and wind, and propwash beside them") {
  const auto file = test::reference_file("data/x500-flight.csv");
  if (!file) return;
  const MeasuredFlight log = published_part(read_log(*file));
  FlightDiagnosisOptions options = published_choice();

  std::set<std::string> found;
  for (const Finding& f : diagnosed(log, 1.549, 1.293, options).findings) found.insert(f.effect);
  CHECK(found.contains("linear_drag"));
  CHECK(found.contains("wind"));

  options.base = {"linear_drag", "wind"};
  const Diagnosis d = diagnosed(log, 1.549, 1.293, options);
  REQUIRE_FALSE(d.findings.empty());
  CHECK(d.findings[0].effect == "propwash");
  CHECK(d.findings[0].gain_percent >= 30);
  CHECK(d.effective_samples < 0.2 * static_cast<double>(d.samples));
}

TEST_CASE("the practice flights are answered correctly") {
  const auto answers_file = test::reference_file("data/practice/answers.json");
  if (!answers_file) return;
  std::ifstream in(*answers_file);
  const auto answers = nlohmann::json::parse(in)["answers"];
  std::size_t flights = 0;
  for (const auto& [name, answer] : answers.items()) {
    if (!name.starts_with("flight")) continue;
    if (flights++ % test::stride() != 0) continue;
    INFO(name);
    FlightDiagnosisOptions options;
    options.base = {"linear_drag", "wind"};
    const Diagnosis d =
        diagnosed({read_log(answers_file->parent_path() / name)}, answer["given"]["mass_kg"],
                  answer["given"]["air_density_kg_m3"], options);
    const std::string effect = answer["effect"];
    const bool unknown = effect.starts_with("unknown");
    CHECK(d.unexplained.detected == unknown);
    if (unknown || effect == "none") {
      CHECK(d.findings.empty());
      if (unknown) CHECK(d.unexplained.channels.front() == "roll_deg");
      continue;
    }
    REQUIRE(d.findings.size() == 1);
    CHECK(d.findings[0].effect == effect);
    const double truth = answer["injected"].begin().value();
    const ParameterEstimate& p = d.findings[0].parameters[0];
    // One flight may miss its 95 % interval; it may not miss it by another half of its width.
    CHECK(std::abs(p.value - truth) < p.ci95_upper - p.ci95_lower);
  }
  CHECK(flights == 6);
}

namespace {

/// The value of a command-line option in the answer of a flight, "" where it is not given.
std::string option(const nlohmann::json& answer, const std::string& name) {
  const std::vector<std::string> args = answer["args"];
  for (std::size_t i = 0; i < args.size(); ++i) {
    if (args[i] == name) return args.at(i + 1);
    if (args[i].starts_with(name + "=")) return args[i].substr(name.size() + 1);
  }
  return "";
}

bool says(const Finding& finding, const std::vector<std::string>& effects) {
  return std::any_of(effects.begin(), effects.end(), [&finding](const std::string& effect) {
    const auto& alike = finding.indistinguishable_from;
    return finding.effect == effect || std::find(alike.begin(), alike.end(), effect) != alike.end();
  });
}

/// A flight that somebody else simulated, with its answer.
struct AnsweredFlight {
  std::string name;
  FlightLog log;
  nlohmann::json answer;
  std::string hidden;
  std::vector<std::string> true_of_it;

  [[nodiscard]] Diagnosis diagnosed() const {
    FlightDiagnosisOptions options;
    options.pitch_offset = std::stod(option(answer, "--pitch-offset-deg")) * unit::degree;
    if (!option(answer, "--base").empty()) options.base = {"linear_drag", "wind"};
    return ::diagnosed({log, std::nullopt}, std::stod(option(answer, "--mass-g")) / 1000,
                       std::stod(option(answer, "--air-density")), options);
  }
};

/// Nothing where it is not at hand.
std::optional<AnsweredFlight> answered_flight(int number) {
  const std::string name = "data/practice2/flight-" + std::to_string(number);
  const auto file = test::reference_file(name + ".csv");
  if (!file) return std::nullopt;
  std::ifstream in(*test::reference_file(name + ".answer.json"));
  AnsweredFlight flight{name, read_log(*file), nlohmann::json::parse(in), "", {}};
  flight.hidden = flight.answer["effect"];
  flight.true_of_it = flight.answer["present"];
  // Of another cause, with the same effect in this flight.
  for (const std::string near : flight.answer["near"]) flight.true_of_it.push_back(near);
  // The answers are older than the step, which tells of a wandering wind as much as the drift does.
  if (std::ranges::count(flight.true_of_it, "wind_drift") > 0)
    flight.true_of_it.push_back("wind_step");
  flight.true_of_it.push_back(flight.hidden);
  return flight;
}

FlightLog every(std::size_t n, const FlightLog& log) {
  FlightLog rest;
  for (auto series :
       {&FlightLog::time, &FlightLog::roll, &FlightLog::pitch, &FlightLog::yaw,
        &FlightLog::north_velocity, &FlightLog::east_velocity, &FlightLog::down_velocity}) {
    for (std::size_t i = 0; i < (log.*series).size(); i += n) {
      (rest.*series).push_back((log.*series)[i]);
    }
  }
  return rest;
}

}  // namespace

TEST_CASE("the flights of a second simulator are answered correctly") {
  for (int number = 31; number <= 44; number += static_cast<int>(test::stride())) {
    const auto flight = answered_flight(number);
    if (!flight) return;
    const Diagnosis d = flight->diagnosed();
    INFO(flight->name << ", hidden: " << flight->hidden);
    for (const Finding& f : d.findings) {
      INFO(f.effect);
      CHECK(says(f, flight->true_of_it));
    }
    const bool found = std::any_of(d.findings.begin(), d.findings.end(),
                                   [&](const Finding& f) { return says(f, {flight->hidden}); });
    CHECK(found == (flight->hidden != "none"));
  }
}

TEST_CASE("logged twice a second, the flights of a second simulator get no wrong name") {
  int hidden = 0;
  int found = 0;
  for (int number = 31; number < 31 + test::draws(12); ++number) {  // of 10 Hz
    auto flight = answered_flight(number);
    if (!flight) return;
    flight->log = every(5, flight->log);
    const Diagnosis d = flight->diagnosed();
    INFO(flight->name << ", hidden: " << flight->hidden);
    for (const Finding& f : d.findings) {
      INFO(f.effect);
      CHECK(says(f, flight->true_of_it));
      found += says(f, {flight->hidden});
    }
    hidden += flight->hidden != "none";
  }
  CHECK(found >= hidden - 2);
}
