// Flights that hide known effects: what a diagnosis must say of them. Rates are asserted with room
// for chance; the whole confusion matrix is printed by the program confusion_matrix.
#include <fmt/format.h>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "hidden_effects/diagnosed.hpp"
#include "hidden_effects/drawn_flight.hpp"
#include "support/random.hpp"

using namespace tethercalc;
using truth::drawn_flight;
using truth::HiddenFlight;

namespace {

bool names_first(const Diagnosis& d, const std::string& effect) {
  if (d.findings.empty()) return false;
  const Finding& first = d.findings.front();
  const auto& rivals = first.indistinguishable_from;
  return first.effect == effect ||
         (rivals.size() <= 2 && std::find(rivals.begin(), rivals.end(), effect) != rivals.end());
}

/// Neither drag nor wind, which every simulated flight has.
bool is_neighbour(const Finding& f) { return std::ranges::count(truth::usual_base, f.effect) == 0; }

struct Case {
  const char* effect;
  double HiddenFlight::*field;
  std::vector<double> strengths;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {"attitude_delay", &HiddenFlight::attitude_delay, {0.06, 0.12, 0.25}},
      {"pitch_trim", &HiddenFlight::pitch_trim, {-2, 1.5, 3}},
      {"wind_drift", &HiddenFlight::wind_drift, {-2, 2.5, 4}},
      {"fore_aft_asymmetry", &HiddenFlight::fore_aft_asymmetry, {-0.2, 0.25, 0.35}},
      {"propwash", &HiddenFlight::propwash, {0.2, 0.4, 0.8}},
      {"vertical_coupling", &HiddenFlight::vertical_coupling, {-0.08, 0.12, 0.2}}};
  return all;
}

}  // namespace

TEST_CASE("a wind that is measured is no finding, and its drag is followed") {
  int found_without = 0;
  int found_with = 0;
  int covered = 0;
  const int draws = test::draws(4);
  for (int draw = 0; draw < draws; ++draw) {
    HiddenFlight hidden;
    hidden.seed = 7100 + static_cast<std::uint64_t>(draw) + 1000 * test::run_seed();
    hidden.duration = 300;
    hidden.wind = 2;
    hidden.wind_wave = 1.5;
    hidden.anemometer_noise = 0.3;
    FlightLog log = truth::fly(hidden);
    const Diagnosis with = diagnosed(hidden, log, {"linear_drag"});
    log.north_wind.clear();
    log.east_wind.clear();
    const Diagnosis without = diagnosed(hidden, log, {"linear_drag"});
    found_without += !without.findings.empty();
    found_with += !with.findings.empty();
    CHECK(with.base.holdout_rmse < without.base.holdout_rmse);
    for (const ParameterEstimate& p : with.base.parameters) {
      if (p.name == "wind_gain") covered += p.ci95_lower <= 1 && p.ci95_upper >= 0.9;
    }
  }
  CHECK(found_without == draws);
  CHECK(found_with <= 1);
  CHECK(covered >= draws - 1);
}

TEST_CASE("a hidden effect is found first, with the truth within its interval") {
  std::size_t number = 0;
  int flights = 0;
  int first = 0;
  int named = 0;
  int covered = 0;
  for (const Case& c : cases()) {
    std::uint64_t seed = 40;
    for (const double strength : c.strengths) {
      HiddenFlight hidden = drawn_flight(++seed);
      if (number++ % test::stride() != 0) continue;
      hidden.*(c.field) = strength;
      const Diagnosis d = diagnosed(hidden);
      INFO(c.effect << " " << strength << " seed " << seed);
      ++flights;
      CHECK_FALSE(d.findings.empty());
      first += names_first(d, c.effect) ? 1 : 0;
      if (d.findings.empty() || d.findings[0].effect != c.effect) continue;
      ++named;
      const ParameterEstimate& p = d.findings[0].parameters[0];
      covered += p.ci95_lower <= strength && strength <= p.ci95_upper ? 1 : 0;
    }
  }
  // Asked for: 95 % and 90 %. At the 99 % and 96 % that were seen, three of 18 wrong and five not
  // covered are chances of one in 1400 and 2000.
  CHECK(flights == 17 / static_cast<int>(test::stride()) + 1);
  CHECK(first >= flights - 2);
  CHECK(named >= flights - 4);
  CHECK(covered >= named - 4);
}

TEST_CASE("what happens at once, comes and goes, pulls aside or is misread is found first") {
  const std::vector<Case> wider{{"tether_pull", &HiddenFlight::tether_pull, {-0.6, 1.2}},
                                {"growing_pull", &HiddenFlight::growing_pull, {0.01, 0.03}},
                                {"wind_shear", &HiddenFlight::wind_shear, {-0.1, 0.15}},
                                {"wind_step", &HiddenFlight::wind_step, {-2.5, 3.5}},
                                {"wind_wave", &HiddenFlight::wind_wave, {1.5, -2.5}},
                                {"mass_drop", &HiddenFlight::mass_drop, {25, 40}},
                                {"slung_load", &HiddenFlight::slung_load, {4, 25}},
                                {"yaw_misalign", &HiddenFlight::yaw_misalign, {-12, 18}},
                                {"velocity_lag", &HiddenFlight::velocity_lag, {0.1, 0.25}},
                                {"velocity_scale", &HiddenFlight::velocity_scale, {1.2, 0.8}}};
  std::uint64_t number = 0;
  int flights = 0;
  int first = 0;
  int named = 0;
  int covered = 0;
  std::string failures;
  for (const Case& c : wider) {
    for (const double strength : c.strengths) {
      HiddenFlight hidden = drawn_flight(1500 + number);
      if (number++ % test::stride() != 0) continue;
      hidden.duration = 540;
      if (c.field == &HiddenFlight::wind_shear) hidden.climb = 25;
      hidden.*(c.field) = strength;
      const Diagnosis d = diagnosed(hidden);
      ++flights;
      const bool right = names_first(d, c.effect);
      first += right ? 1 : 0;
      if (!right) failures += c.effect + (" " + std::to_string(strength)) + "\n";
      if (d.findings.empty() || d.findings[0].effect != c.effect) continue;
      ++named;
      const ParameterEstimate& p = d.findings[0].parameters[0];
      const bool holds = p.ci95_lower <= strength && strength <= p.ci95_upper;
      covered += holds ? 1 : 0;
      if (!holds) {
        failures +=
            fmt::format("{} {}: {} to {}\n", c.effect, strength, p.ci95_lower, p.ci95_upper);
      }
    }
  }
  // Asked for: 95 % of each. Seen: 99 % right, and 96 % of 900 covered. Of 20 flights five that are
  // not covered leave a chance of one in 300 at 95 %.
  INFO(failures);
  CHECK(flights == 19 / static_cast<int>(test::stride()) + 1);
  CHECK(first >= flights - 2);
  CHECK(covered >= named - 4);
}

TEST_CASE("a heading that is off is no velocity scale, also where one heading alone is flown") {
  int told = 0;
  int covered = 0;
  constexpr int flights = test::draws(4);
  for (int draw = 0; draw < flights; ++draw) {
    HiddenFlight hidden = drawn_flight(1900 + static_cast<std::uint64_t>(draw));
    hidden.duration = 300;
    hidden.yaw_misalign = (draw % 2 == 0 ? 1 : -1) * (20 + 8 * draw);
    const Diagnosis d = diagnosed(hidden);
    REQUIRE_FALSE(d.findings.empty());
    const Finding& first = d.findings[0];
    told += first.effect == "yaw_misalign" && first.indistinguishable_from.empty() ? 1 : 0;
    const ParameterEstimate& off = first.parameters[0];
    covered += off.ci95_lower <= hidden.yaw_misalign && hidden.yaw_misalign <= off.ci95_upper;
  }
  // Seen: 24 of 24 told, 22 covered. At 95 % three of 4 are missed by a chance of one in 2000.
  CHECK(told >= flights - 1);
  CHECK(covered >= flights - (flights > 3 ? 2 : 1));
}

TEST_CASE("the moment of a step in the wind is told") {
  int told = 0;
  constexpr int flights = test::draws(12);
  for (std::uint64_t seed = 1; seed <= flights; ++seed) {
    HiddenFlight hidden = drawn_flight(1600 + seed);
    hidden.wind_step = 3;
    const Diagnosis d = diagnosed(hidden);
    REQUIRE_FALSE(d.findings.empty());
    if (d.findings[0].effect != "wind_step") continue;
    const ParameterEstimate& moment = d.findings[0].parameters.back();
    const double truth = 10 + 0.6 * hidden.duration;
    told += moment.ci95_lower <= truth && truth <= moment.ci95_upper ? 1 : 0;
  }
  // Seen: 37 of 40. Five of 12 miss by a chance of one in 600, all of 3 of one in 2000.
  CHECK(told >= flights - (flights > 3 ? 4 : 2));
}

TEST_CASE(
    "a pitch offset in a turning flight is none of the tether, whatever wind is in the base") {
  const int flights = test::draws(8);
  int right = 0;
  for (int draw = 0; draw < flights; ++draw) {
    HiddenFlight hidden = drawn_flight(1700 + static_cast<std::uint64_t>(draw));
    hidden.yaw_turns = true;
    hidden.wind = 0;
    hidden.wind_north = 1;
    hidden.wind_east = -0.6;
    hidden.pitch_trim = 1.5;
    const Diagnosis d = diagnosed(hidden);
    std::set<std::string> names;
    for (const Finding& f : d.findings) names.insert(f.effect);
    right += names == std::set<std::string>{"pitch_trim", "turning_wind"} ? 1 : 0;
  }
  // Seen: 8 of 8.
  CHECK(right >= flights - (flights > 3 ? 2 : 1));
}

TEST_CASE("a velocity lags over ground, and a wind drifts there, whichever way the drone points") {
  const int flights = test::draws(4);
  int right = 0;
  for (int draw = 0; draw < flights; ++draw) {
    HiddenFlight hidden = drawn_flight(1750 + static_cast<std::uint64_t>(draw));
    hidden.yaw_turns = true;
    hidden.wind = 0;
    HiddenFlight drifting = hidden;
    hidden.velocity_lag = 0.12;
    right += names_first(diagnosed(hidden), "velocity_lag") ? 1 : 0;
    drifting.wind_drift = 3;
    right += names_first(diagnosed(drifting), "wind_drift") ? 1 : 0;
  }
  CHECK(right >= 2 * flights - 1);
}

TEST_CASE("a pull over ground keeps its size and its side while the drone turns") {
  const int flights = test::draws(4);
  int right = 0;
  for (int draw = 0; draw < flights; ++draw) {
    HiddenFlight hidden = drawn_flight(1651 + static_cast<std::uint64_t>(draw));
    hidden.yaw_turns = true;
    hidden.wind = 0;  // none turns with a drone
    hidden.tether_pull = 1.2;
    const FlightLog log = truth::fly(hidden);
    const Diagnosis d = diagnosed(hidden);
    REQUIRE_FALSE(d.findings.empty());
    if (d.findings[0].effect != "tether_pull") continue;
    const auto& pull = d.findings[0].parameters;
    double north = 0;
    double east = 0;
    for (const double yaw : log.yaw) {
      north += std::cos(yaw);
      east += std::sin(yaw);
    }
    // The pull is along the first heading.
    const double turned = log.yaw.front() - std::atan2(east, north);
    const double ahead = hidden.tether_pull * std::cos(turned);
    const double aside = hidden.tether_pull * std::sin(turned);
    right += std::hypot(pull[0].value - ahead, pull[1].value - aside) < 0.15 ? 1 : 0;
    REQUIRE_FALSE(d.notes.empty());
    CHECK(d.notes.back().sentence.find("mean heading") != std::string::npos);
  }
  CHECK(right >= flights - 1);
}

TEST_CASE("a pull that grows with the distance is told from one that stays, and both are sized") {
  if (test::leave_rates_out()) return;
  const auto finding = [](const Diagnosis& d, const std::string& effect) {
    const auto found = std::ranges::find(d.findings, effect, &Finding::effect);
    return found == d.findings.end() ? nullptr : &*found;
  };
  const auto holds = [](const Finding& f, double truth) {
    return f.parameters[0].ci95_lower <= truth && truth <= f.parameters[0].ci95_upper;
  };
  int grows = 0;
  int sized = 0;
  int middle_missed = 0;
  int stays = 0;
  int mistaken = 0;
  const int draws = 6;
  for (int draw = 0; draw < draws; ++draw) {
    test::Random random(1680 + static_cast<unsigned>(draw) +
                        1000 * static_cast<unsigned>(test::run_seed()));
    HiddenFlight hidden = drawn_flight(1680 + static_cast<std::uint64_t>(draw));
    hidden.duration = 540;
    hidden.yaw_turns = draw % 2 == 0;
    hidden.tether_pull = random.uniform(0.6, 1.5);
    const Diagnosis constant = diagnosed(hidden);
    stays += names_first(constant, "tether_pull") ? 1 : 0;
    mistaken += finding(constant, "growing_pull") != nullptr ? 1 : 0;

    hidden.tether_pull = 0;
    hidden.growing_pull = random.magnitude(0.003, 0.03);
    hidden.station = random.uniform(60, 150);
    const FlightLog log = truth::fly(hidden);
    const Diagnosis d = diagnosed(hidden, log);
    const Finding* growing = finding(d, "growing_pull");
    if (growing == nullptr) continue;
    ++grows;
    sized += holds(*growing, hidden.growing_pull) ? 1 : 0;
    // What it pulls at the mean place, along the only heading.
    const Finding* middle = finding(d, "tether_pull");
    if (hidden.yaw_turns || middle == nullptr) continue;
    double place = 0;
    double sum = 0;
    for (std::size_t i = 1; i < log.time.size(); ++i) {
      place += (log.time[i] - log.time[i - 1]) * (log.north_velocity[i] * std::cos(log.yaw[0]) +
                                                  log.east_velocity[i] * std::sin(log.yaw[0]));
      sum += place;
    }
    const double mean = sum / static_cast<double>(log.time.size());
    middle_missed += holds(*middle, hidden.growing_pull * (hidden.station - mean)) ? 0 : 1;
  }
  CHECK(grows >= draws - 1);
  CHECK(sized >= grows - 2);
  CHECK(middle_missed <= 1);
  CHECK(stays >= draws - 1);
  CHECK(mistaken <= 1);
}

TEST_CASE("a log that samples ten times as fast says the same") {
  int right = 0;
  constexpr int flights = test::draws(3);
  for (std::uint64_t seed = 1; seed <= flights; ++seed) {
    HiddenFlight hidden = drawn_flight(1700 + seed);
    hidden.steps_per_sample = 1;
    const Diagnosis nothing = diagnosed(hidden);
    CHECK(nothing.findings.empty());
    CHECK_FALSE(nothing.unexplained.detected);
    CHECK(nothing.samples < static_cast<std::size_t>(11 * hidden.duration));
    hidden.propwash = 0.4;
    right += names_first(diagnosed(hidden), "propwash") ? 1 : 0;
  }
  CHECK(right >= flights - 1);
}

TEST_CASE("nothing hidden, nothing found") {
  if (test::leave_rates_out()) return;
  int alarms = 0;
  int structure = 0;
  constexpr int flights = 60;
  for (int i = 0; i < flights; ++i) {
    const Diagnosis d = diagnosed(drawn_flight(2000 + static_cast<std::uint64_t>(i)));
    alarms += d.findings.empty() ? 0 : 1;
    structure += d.unexplained.detected ? 1 : 0;
  }
  CHECK(alarms <= flights / 20);
  CHECK(structure <= flights / 20);
}

TEST_CASE("no finding adds nothing and no extended model is worse, whatever the flight") {
  test::Random random(test::run_seed());
  int named = 0;
  for (int i = 0; i < std::max(6, test::draws(30)); ++i) {
    HiddenFlight hidden = drawn_flight(3000 + static_cast<std::uint64_t>(i));
    hidden.duration = random.uniform(75, 240);
    hidden.gust_std = random.uniform(0.1, 0.6);
    hidden.gust_time = random.uniform(0.5, 8);
    hidden.lateral_std = random.uniform(0.3, 4);
    hidden.pattern = i % 2 == 0 ? truth::Pattern::circles : truth::Pattern::long_forward;
    hidden.wind_north = random.uniform(-3, 3);
    hidden.propwash = random.uniform(0, 0.5);
    const Diagnosis d = diagnosed(hidden, std::vector<std::string>{});
    INFO("flight " << i);
    CHECK(d.extended.holdout_rmse <= d.base.holdout_rmse);
    for (const Finding& f : d.findings) {
      INFO(f.effect);
      CHECK(f.gain_percent > 0);
      ++named;
    }
  }
  CHECK(named > 0);
}

TEST_CASE("two effects at once are both found") {
  if (test::leave_rates_out()) return;
  int pairs = 0;
  int both = 0;
  std::uint64_t seed = 700;
  for (std::size_t a = 0; a < cases().size(); ++a) {
    for (std::size_t b = a + 1; b < cases().size(); ++b) {
      ++seed;
      HiddenFlight hidden = drawn_flight(seed);
      hidden.duration = 540;
      hidden.*(cases()[a].field) = cases()[a].strengths[1];
      hidden.*(cases()[b].field) = cases()[b].strengths[1];
      std::set<std::string> found;
      for (const Finding& f : diagnosed(hidden).findings) found.insert(f.effect);
      ++pairs;
      both += found.contains(cases()[a].effect) && found.contains(cases()[b].effect) ? 1 : 0;
    }
  }
  CHECK(pairs >= 3);
  CHECK(both >= 0.85 * pairs - 2);  // 85 % is asked for; two pairs are room for chance
}

TEST_CASE("a wind over ground is told from a headwind once the drone turns") {
  int right = 0;
  constexpr int flights = test::draws(4);
  for (std::uint64_t seed = 1; seed <= flights; ++seed) {
    HiddenFlight hidden = drawn_flight(900 + seed);
    hidden.wind = 0;
    hidden.wind_north = 2.5;
    hidden.wind_east = -1.5;
    hidden.yaw_turns = true;
    right += names_first(diagnosed(hidden), "turning_wind") ? 1 : 0;
  }
  CHECK(right >= flights - 1);
}

TEST_CASE("a turning wind is found in a short flight, and circles invent nothing") {
  int right = 0;
  int quiet = 0;
  constexpr int flights = test::draws(4);
  for (std::uint64_t seed = 1; seed <= flights; ++seed) {
    HiddenFlight hidden = drawn_flight(950 + seed);
    hidden.pattern = truth::Pattern::circles;
    hidden.duration = 200;
    hidden.lateral_std = 1.5;
    const Diagnosis nothing = diagnosed(hidden);
    quiet += nothing.findings.empty() && !nothing.unexplained.detected ? 1 : 0;
    hidden.wind = 0;
    hidden.wind_north = 2.5;
    hidden.wind_east = -1.5;
    right += names_first(diagnosed(hidden), "turning_wind") ? 1 : 0;
  }
  CHECK(right >= flights - 1);
  CHECK(quiet >= flights - 1);
}

TEST_CASE("linear drag and wind are found where the base has neither") {
  for (std::uint64_t seed = 1; seed <= test::draws(3); ++seed) {
    HiddenFlight hidden = drawn_flight(1100 + seed);
    hidden.wind = 1.6;
    std::set<std::string> found;
    for (const Finding& f : diagnosed(hidden, std::vector<std::string>{}).findings) {
      found.insert(f.effect);
      found.insert(f.indistinguishable_from.begin(), f.indistinguishable_from.end());
    }
    CHECK(found.contains("linear_drag"));
    CHECK(found.contains("wind"));
  }
}

TEST_CASE("what no catalogue knows gets no name where drag and wind have to be found as well") {
  if (test::leave_rates_out()) return;
  int detected = 0;
  int wrong = 0;
  const int flights = 8;
  for (int i = 0; i < flights; ++i) {
    HiddenFlight hidden = drawn_flight(1350 + static_cast<std::uint64_t>(i));
    hidden.step_force = i % 2 == 0 ? -0.6 : 0.8;
    hidden.duration = 540;
    const Diagnosis d = diagnosed(hidden, std::vector<std::string>{});
    detected += d.unexplained.detected ? 1 : 0;
    wrong += std::any_of(d.findings.begin(), d.findings.end(), is_neighbour) ? 1 : 0;
  }
  // Where names are not sought beside drag and wind, five of twelve such flights have a wrong one.
  CHECK(detected >= flights - 2);
  CHECK(wrong <= 1);
}

TEST_CASE("a trim or an askew drag is named where drag and wind have to be found as well") {
  int right = 0;
  int wrong = 0;
  const int flights = test::draws(12);
  for (int i = 0; i < flights; ++i) {
    HiddenFlight hidden = drawn_flight(1380 + static_cast<std::uint64_t>(i));
    const bool trim = i % 2 == 0;
    const std::string effect = trim ? "pitch_trim" : "fore_aft_asymmetry";
    const double sign = i % 4 < 2 ? 1 : -1;
    (trim ? hidden.pitch_trim : hidden.fore_aft_asymmetry) = sign * (trim ? 2.0 : 0.18);
    hidden.duration = 540;
    const Diagnosis d = diagnosed(hidden, std::vector<std::string>{});
    const auto tells = [&effect](const Finding& f) {
      return f.effect == effect || std::ranges::count(f.indistinguishable_from, effect) > 0;
    };
    right += std::any_of(d.findings.begin(), d.findings.end(), tells) ? 1 : 0;
    wrong += std::any_of(d.findings.begin(), d.findings.end(),
                         [&](const Finding& f) { return is_neighbour(f) && !tells(f); })
                 ? 1
                 : 0;
  }
  // Asked for are 95 % and no more than 1 %.
  CHECK(right >= flights - 2);
  CHECK(wrong <= 1);
}

TEST_CASE("what no catalogue knows is detected on its channel and not named") {
  if (test::leave_rates_out()) return;
  const std::vector<std::pair<const char*, std::pair<double HiddenFlight::*, double>>> unknown{
      {"roll_deg", {&HiddenFlight::roll_drag, 60}},
      {"time_s", {&HiddenFlight::step_force, -0.5}},
      {"time_s", {&HiddenFlight::step_force, 0.7}},
      {"height_m", {&HiddenFlight::height_drag, 0.04}}};
  int flights = 0;
  int detected = 0;
  int names = 0;
  for (const auto& [channel, effect] : unknown) {
    for (int draw = 0; draw < 5; ++draw) {
      HiddenFlight hidden = drawn_flight(1301 + 11 * static_cast<std::uint64_t>(flights));
      hidden.*(effect.first) = effect.second;
      hidden.roll_std = 3;
      const Diagnosis d = diagnosed(hidden);
      ++flights;
      names += d.findings.empty() ? 0 : 1;
      detected += d.unexplained.detected && d.unexplained.channels.front() == channel ? 1 : 0;
    }
  }
  // Asked for: 90 %.
  CHECK(detected >= flights - std::max(1, flights / 5));
  CHECK(names <= std::max(1, flights / 10));
}
