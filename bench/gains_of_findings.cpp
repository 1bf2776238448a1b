// Whether a finding ever makes the simulation worse: short logs with none to three hidden effects
// each, known to the catalogue or not, from the limit of detection to large, are diagnosed, and
// every finding's gain on held-out data is taken. Ends with an error where one is not positive, or
// an extended model is worse than its base. Of one log in ten every finding is sought once more
// with all others in the base model, and counted where it then is neither found nor suspected.
//
//   gains_of_findings [LOGS] [SEED] [power|flights]   logs of each kind, 100 by default
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "hidden_effects/diagnosed.hpp"
#include "hidden_effects/power_scenarios.hpp"
#include "hidden_effects/simulated_flight.hpp"

using namespace tethercalc;

namespace {

using Random = std::mt19937_64;

double between(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

std::size_t at_most(Random& random, std::size_t most) {
  return std::uniform_int_distribution<std::size_t>(0, most)(random);
}

struct Count {
  int logs = 0;
  int findings = 0;
  int not_positive = 0;
  int sought_again = 0;
  int not_found_again = 0;
  int worse_models = 0;
};

/// Percent by which the held-out error falls with `effect`, where it is found or suspected, by
/// itself or as one that explains the log as well; 0 where it is not.
double gain_of(const std::string& effect, const Diagnosis& d) {
  for (const Finding& f : d.findings) {
    const auto& alike = f.indistinguishable_from;
    if (f.effect == effect || std::find(alike.begin(), alike.end(), effect) != alike.end()) {
      return f.gain_percent;
    }
  }
  for (const Suspected& s : d.suspected) {
    if (s.effect == effect) return s.gain_percent;
  }
  return 0;
}

/// `beside` diagnoses the log with further effects in the base model. Of power logs the unit of
/// held-out errors, their noise, is then another: gains can be compared, errors cannot.
template <typename Beside>
void judge(const char* kind, std::uint64_t seed, const Diagnosis& d, const Beside& beside,
           Count& count) {
  ++count.logs;
  for (const Finding& f : d.findings) {
    ++count.findings;
    count.not_positive +=
        f.gain_percent > 0 && f.holdout_rmse_after < f.holdout_rmse_before ? 0 : 1;
  }
  count.worse_models += d.extended.holdout_rmse <= d.base.holdout_rmse ? 0 : 1;
  const bool stands_alone = d.findings.size() < 2;  // judged above
  if (stands_alone || count.logs % 10 != 0) return;
  for (const Finding& f : d.findings) {
    std::vector<std::string> others;
    for (const Finding& other : d.findings) {
      if (&other != &f) others.push_back(other.effect);
    }
    ++count.sought_again;
    if (gain_of(f.effect, beside(others)) > 0) continue;
    ++count.not_found_again;
    fmt::print("{} {}: {} is not found beside {}\n", kind, seed, f.effect, fmt::join(others, ", "));
  }
}

// ---- flights ----

truth::HiddenFlight drawn_flight(std::uint64_t seed) {
  Random random(seed);
  truth::HiddenFlight hidden;
  hidden.seed = seed;
  hidden.duration = between(random, 90, 240);
  hidden.mass = between(random, 1.5, 2.3);
  hidden.linear = between(random, 8, 25);
  hidden.wind = between(random, -2, 2);
  hidden.yaw_turns = at_most(random, 2) == 0;
  hidden.gust_std *= std::exp2(between(random, -1, 1));
  const std::vector<std::pair<double truth::HiddenFlight::*, double>> largest{
      {&truth::HiddenFlight::attitude_delay, 0.25},
      {&truth::HiddenFlight::pitch_trim, 3},
      {&truth::HiddenFlight::wind_north, 4},
      {&truth::HiddenFlight::wind_drift, 4},
      {&truth::HiddenFlight::fore_aft_asymmetry, 0.3},
      {&truth::HiddenFlight::propwash, 0.8},
      {&truth::HiddenFlight::vertical_coupling, 0.2},
      {&truth::HiddenFlight::tether_pull, 1.5},
      {&truth::HiddenFlight::wind_shear, 0.2},
      {&truth::HiddenFlight::wind_step, 4},
      {&truth::HiddenFlight::wind_wave, 3},
      {&truth::HiddenFlight::mass_drop, 40},
      {&truth::HiddenFlight::slung_load, 30},
      {&truth::HiddenFlight::velocity_lag, 0.3},
      {&truth::HiddenFlight::roll_drag, 80},
      {&truth::HiddenFlight::step_force, 1},
      {&truth::HiddenFlight::height_drag, 0.06}};
  for (std::size_t left = at_most(random, 3); left > 0; --left) {
    const auto& [field, most] = largest[at_most(random, largest.size() - 1)];
    hidden.*field = most * std::exp2(between(random, -4, 0));
  }
  return hidden;
}

void diagnose_one_flight(std::uint64_t seed, Count& count) {
  const truth::HiddenFlight hidden = drawn_flight(seed);
  const FlightLog log = truth::fly(hidden);
  const auto beside = [&](std::vector<std::string> further) {
    further.insert(further.end(), truth::usual_base.begin(), truth::usual_base.end());
    return truth::diagnosed(hidden, log, further);
  };
  judge("flight", seed, truth::diagnosed(hidden, log), beside, count);
}

// ---- power logs ----

power_truth::Scenario drawn_power_log(std::uint64_t seed) {
  Random random(seed);
  power_truth::Scenario scenario;
  scenario.seed = seed;
  scenario.duration = between(random, 200, 900);
  scenario.deviation *= std::exp2(between(random, -1, 1));
  scenario.instrument_noise = std::exp2(between(random, -1, 1));
  for (std::size_t left = at_most(random, 3); left > 0; --left) {
    const auto& known = power_truth::hidden_effects();
    power_truth::HiddenEffects& h = scenario.hidden;
    switch (const std::size_t pick = at_most(random, known.size() + 3); pick - known.size()) {
      case 0:
        h.step_in_motor_power = between(random, 0.005, 0.1);
        break;
      case 1:
        h.motor_power_per_height = between(random, 0.005, 0.1);
        break;
      case 2:
        h.step_in_resistance = between(random, 0.01, 0.2);
        break;
      case 3:
        h.motor_power_swing = between(random, 0.005, 0.1);
        break;
      default:
        known[pick].hide(h, between(random, -0.3, 1));
    }
  }
  return scenario;
}

void diagnose_one_power_log(std::uint64_t seed, Count& count) {
  const PowerLog log = power_truth::as_power_log(simulate(drawn_power_log(seed)));
  const auto flown = [](double volts) { return std::isfinite(volts); };
  if (!std::all_of(log.drone_voltage.begin(), log.drone_voltage.end(), flown)) {
    return;  // such a cable cannot feed such a drone
  }
  const auto diagnosed = [&log](const std::vector<std::string>& further) {
    return diagnose_power(power_truth::spec(), log, further).diagnosis;
  };
  judge("power log", seed, diagnosed({}), diagnosed, count);
}

bool print(const char* kind, const Count& c) {
  fmt::print(
      "{:<12}{:>6} logs {:>7} findings {:>4} without gain {:>4} models worse than their base {:>4} "
      "of {} not found again beside the others\n",
      kind, c.logs, c.findings, c.not_positive, c.worse_models, c.not_found_again, c.sought_again);
  return c.not_positive + c.worse_models == 0;
}

template <typename Draw>
Count counted(int logs, std::uint64_t seed, const Draw& draw) {
  Count count;
  for (int i = 0; i < logs; ++i) draw(seed + static_cast<std::uint64_t>(i), count);
  return count;
}

}  // namespace

int main(int argc, char** argv) {
  const int logs = argc > 1 ? std::atoi(argv[1]) : 100;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  const std::string kind = argc > 3 ? argv[3] : "";
  if (logs < 1 || (!kind.empty() && kind != "power" && kind != "flights")) {
    fmt::print(stderr, "usage: gains_of_findings [LOGS] [SEED] [power|flights], LOGS at least 1\n");
    return 2;
  }
  bool good = true;
  if (kind != "flights") good &= print("power logs", counted(logs, seed, diagnose_one_power_log));
  if (kind != "power") good &= print("flights", counted(logs, seed, diagnose_one_flight));
  return good ? 0 : 1;
}
