// Power logs with known hidden effects, and what the diagnosis makes of them. Rates are asserted
// with room for chance: the bounds stand two standard deviations of a binomial count below what is
// claimed.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <span>

#include "diagnose/power_residuals.hpp"
#include "hidden_effects/power_scenarios.hpp"
#include "support/random.hpp"
#include "support/reference_data.hpp"
#include "support/verdicts.hpp"
#include "tethercalc/diagnose/catalogue.hpp"
#include "tethercalc/files/read_files.hpp"
#include "tethercalc/io/log_readers.hpp"
#include "tethercalc/model/operating_point.hpp"

using namespace tethercalc;
using namespace power_truth;
using test::lists;
using test::names;

namespace {

std::uint64_t seed(std::uint64_t number) { return 1'000'003ULL * test::run_seed() + number; }

Diagnosis diagnosis_of(const PowerLog& log) { return diagnose_power(spec(), log).diagnosis; }
Diagnosis diagnosis_of(const Scenario& scenario) {
  return diagnosis_of(as_power_log(simulate(scenario)));
}

bool any_names(const Diagnosis& diagnosis, const std::string& effect) {
  return std::any_of(diagnosis.findings.begin(), diagnosis.findings.end(),
                     [&](const Finding& f) { return names(f, effect); });
}

std::string summary(const Diagnosis& diagnosis) {
  std::string text;
  for (const Finding& f : diagnosis.findings) {
    text += f.effect + " (" + std::to_string(f.gain_percent) + " %)";
    for (const auto& other : f.indistinguishable_from) text += " or " + other;
    text += "; ";
  }
  if (diagnosis.unexplained.detected) text += "unnamed: " + diagnosis.unexplained.shape;
  return text;
}

/// Of `hidden_effects`, those before what instruments, air and cable add.
constexpr std::size_t mechanisms = 12;

int false_alarms(int logs, std::uint64_t first) {
  int count = 0;
  for (int i = 0; i < logs; ++i) {
    Scenario scenario;
    scenario.seed = seed(first + static_cast<std::uint64_t>(i));
    count += !diagnosis_of(scenario).findings.empty();
  }
  return count;
}

/// Counts over strengths from the limit of detection to large.
struct Detection {
  int worth = 0;    ///< logs in which the effect makes 5 % of the held-out error or more
  int named = 0;    ///< of these, the first finding names it
  int fitted = 0;   ///< logs in which it is the first finding
  int covered = 0;  ///< of these, the interval holds the truth
  std::string failures;
};

void detect(const HiddenEffect& effect, int logs, Detection& count) {
  for (int i = 0; i < logs; ++i) {
    Scenario scenario;
    scenario.seed = seed(10'000 + static_cast<std::uint64_t>(i) +
                         1000 * std::hash<std::string>{}(effect.id) % 100'000);
    effect.hide(scenario.hidden, i / (logs - 1.0));
    const Diagnosis d = diagnosis_of(scenario);
    const bool right = !d.findings.empty() && names(d.findings.front(), effect.id);
    // What the best explanation removes. Where nothing was found, more than 5 % went unnoticed if
    // the error stands 5 % above that of pure noise.
    const double noise = 1.01;
    const double possible = 100 * (1 - noise / d.base.holdout_rmse);
    if (possible >= 5) {
      ++count.worth;
      count.named += right;
      if (!right) count.failures += effect.id + ": " + summary(d) + "\n";
    }
    if (!d.findings.empty() && d.findings.front().effect == effect.id) {
      const ParameterEstimate& p = d.findings.front().parameters.front();
      const double truth = effect.truth(scenario.hidden);
      ++count.fitted;
      count.covered += p.ci95_lower <= truth && truth <= p.ci95_upper;
    }
  }
}

constexpr int detection_logs = 6;  // of an effect, over its strengths
/// Of twenty logs three may then go unseen or uncovered: at the 2 % and 4 % that were seen, four
/// are a chance of one in 2000 and 180.
constexpr int may_miss = 1;

void check_detection(std::size_t first, std::size_t last) {
  Detection count;
  const int draws = std::max(2, test::draws(detection_logs));  // the least and the greatest size
  int logs = 0;
  for (std::size_t e = first; e < last; e += test::stride()) {
    detect(hidden_effects()[e], draws, count);
    logs += draws;
  }
  INFO(count.failures);
  CHECK(3 * count.worth >= logs - 1);
  CHECK(count.named >= 0.9 * count.worth - may_miss);
  CHECK(count.covered >= 0.83 * count.fitted - may_miss);
}

/// Pairs of which one can always be described as a change of the other.
bool degenerate(const std::string& a, const std::string& b) {
  const auto is = [&](const char* x, const char* y) {
    return (a == x && b == y) || (a == y && b == x);
  };
  // With a drum the resistance is the same at every height: any factor or addition is a longer
  // cable.
  return is("spooled_length", "conductor_resistivity") ||
         is("spooled_length", "contact_resistance") ||
         // The converter's fixed loss and the auxiliaries add up.
         is("converter_efficiency_curve", "auxiliary_power");
}

constexpr int quiet_logs = test::draws(40);
/// 5 %; of few logs one may be.
constexpr int most_alarms = std::max(1, quiet_logs / 20);

PowerLog practice_log(const char* name) {
  const auto path = test::reference_file(std::string("data/practice/") + name);
  return path ? read_power_log(*path).log : PowerLog{};
}

}  // namespace

TEST_CASE("a power log without hidden effects yields findings in at most 5 %, first half") {
  CHECK(false_alarms(quiet_logs, 0) <= most_alarms);
}

TEST_CASE("a power log without hidden effects yields findings in at most 5 %, second half") {
  if (test::leave_rates_out()) return;
  CHECK(false_alarms(quiet_logs, 100) <= most_alarms);
}

TEST_CASE("a voltmeter that is off by thousandths is named, and no volt is predicted worse") {
  const auto spec_file = test::reference_file("data/practice2/power-51.spec.json");
  const auto log_file = test::reference_file("data/practice2/power-51.csv");
  if (!spec_file || !log_file) return;  // a log of another simulator, with a height that drifts
  const Design design = read_design(*spec_file).design;
  const PowerLog logged = read_power_log(*log_file).log;
  std::size_t number = 0;
  for (const double gain : {0.994, 1.0035, 1.004, 1.005, 1.006, 1.007, 1.008, 1.01}) {
    if (number++ % test::stride() != 0) continue;
    PowerLog log = logged;
    for (double& volts : log.supply_voltage) volts *= gain;
    const Diagnosis d = diagnose_power(design, log).diagnosis;
    INFO(gain << ": " << summary(d));
    REQUIRE(d.findings.size() == 1);
    CHECK(d.findings.front().effect == "supply_voltage_gain");
    CHECK(d.findings.front().parameters.front().value == Approx(gain).margin(1e-3));
    CHECK(d.further.front().extended_rmse < d.further.front().base_rmse);
  }
}

TEST_CASE("readings that are taken too large do not seem to explain more") {
  // Both voltages 5 V lower and the converter without a loss that grows: nothing of the log is
  // nearer to that, only its noise becomes smaller.
  const auto left_by = [](PowerResiduals& residuals, const PowerModel& model) {
    std::vector<double> squares;
    for (std::size_t k = 0; k < residuals.stages().size(); ++k) {
      if (residuals.stages()[k].stage == Stage::motors) continue;
      std::vector<double> left(residuals.samples());
      residuals.standardised(k, model, left);
      double fast = 0;  // of what changes from sample to sample: noise
      for (std::size_t i = 1; i < left.size(); ++i) {
        fast += (left[i] - left[i - 1]) * (left[i] - left[i - 1]);
      }
      squares.push_back(fast / static_cast<double>(left.size() - 1));
    }
    return squares;
  };
  const PowerModel base{spec()};
  PowerModel low = base;
  low.instruments.supply_voltage_gain = 1.07;
  low.instruments.drone_voltage_offset = base.design.supply.voltage * (1 - 1 / 1.07);
  PowerModel high = base;
  high.instruments.supply_voltage_gain = 1 / 1.07;
  high.instruments.drone_voltage_offset = base.design.supply.voltage * (1 - 1.07);
  for (int draw = 0; draw < test::draws(8); ++draw) {
    Scenario scenario;
    scenario.seed = seed(2600 + static_cast<std::uint64_t>(draw));
    PowerResiduals residuals(base, screen_power_log(base, as_power_log(simulate(scenario))));
    const std::vector<double> as_read = left_by(residuals, base);
    REQUIRE(as_read.size() == 2);
    // Without it the squares would change by 13 %. Seen, over a dozen seeds: up to 4 % on the line
    // and 10 % at the converter.
    for (const PowerModel& model : {low, high}) {
      const std::vector<double> other = left_by(residuals, model);
      CHECK(other[0] == Approx(as_read[0]).epsilon(0.06));
      CHECK(other[1] == Approx(as_read[1]).epsilon(0.12));
    }
  }
}

TEST_CASE("what is left at the converter is told in watts") {
  Scenario scenario;
  scenario.seed = seed(2640);
  const PowerLog log = as_power_log(simulate(scenario));
  const Design design = spec();
  double squares = 0;
  for (std::size_t i = 0; i < log.time.size(); ++i) {
    const double input = log.drone_voltage[i] * log.supply_current[i];
    const double output = log.bus_voltage[i] * log.bus_current[i];
    const double left = input - design.drone.auxiliary_power -
                        output / design.supply.converter.efficiency.front().efficiency;
    squares += left * left;
  }
  const Diagnosis d = diagnosis_of(log);
  const auto watts = std::ranges::find(d.further, "W", &HoldoutComparison::unit);
  REQUIRE(watts != d.further.end());
  const double rms = std::sqrt(squares / static_cast<double>(log.time.size()));
  CHECK(watts->base_rmse == Approx(rms).epsilon(0.02));  // outliers and what is held out apart
}

TEST_CASE("small errors together are not told as large ones that cancel") {
  int large = 0;
  int covered = 0;
  int found = 0;
  const int draws = test::draws(8);
  for (int draw = 0; draw < draws; ++draw) {
    Scenario scenario;
    scenario.seed = seed(2650 + static_cast<std::uint64_t>(draw));
    scenario.hidden.drone_voltage_offset = draw % 2 == 0 ? 0.15 : -0.2;
    scenario.hidden.auxiliary_power = 3;
    const Diagnosis d = diagnosis_of(scenario);
    INFO(summary(d));
    for (const Finding& f : d.findings) {
      const ParameterEstimate& p = f.parameters.front();
      large += f.effect == "supply_voltage_gain" && std::abs(p.value - 1) > 0.02 ? 1 : 0;
      if (f.effect != "drone_voltage_offset") continue;
      ++found;
      const double truth = scenario.hidden.drone_voltage_offset;
      covered += p.ci95_lower <= truth && truth <= p.ci95_upper ? 1 : 0;
    }
  }
  CHECK(large == 0);
  CHECK(found >= draws - 1);
  CHECK(covered >= found - 2);
}

TEST_CASE("three causes are told, and nothing that mimics two of them") {
  // Six metres of cable have a contact's resistance, and weigh as much as the drone is heavier.
  int right = 0;
  const int draws = test::draws(6);
  for (int draw = 0; draw < draws; ++draw) {
    Scenario scenario;
    scenario.seed = seed(2720 + static_cast<std::uint64_t>(draw));
    scenario.duration = 900;
    scenario.hidden.contact_resistance = 0.3;
    scenario.hidden.extra_mass = 0.15;
    scenario.hidden.bus_current_gain = draw % 2 == 0 ? 0.9 : 1.05;
    const Diagnosis d = diagnosis_of(scenario);
    INFO(summary(d));
    const auto told = [&d](const std::string& effect) {
      return std::ranges::any_of(d.findings, [&](const Finding& f) {
        return f.effect == effect || std::ranges::count(f.indistinguishable_from, effect) > 0;
      });
    };
    right += d.findings.size() == 3 && told("contact_resistance") && told("extra_mass") &&
             told("bus_current_gain");
  }
  // Nine of ten logs with several effects at once are told right.
  CHECK(right >= draws - 2);
}

TEST_CASE("effects of the line are named and their size is covered") { check_detection(0, 5); }

TEST_CASE("effects of converter and motors are named and their size is covered") {
  check_detection(5, 9);
}

TEST_CASE("effects of the airframe are named and their size is covered") {
  check_detection(9, mechanisms);
}

TEST_CASE("errors of electrical instruments are named and their size is covered") {
  check_detection(mechanisms, mechanisms + 4);
}

TEST_CASE("a wrong height, airspeed or length of the cable is named and its size is covered") {
  check_detection(mechanisms + 4, mechanisms + 7);
}

TEST_CASE("ageing motors, thin air, a drop and a winch are named and their size is covered") {
  check_detection(mechanisms + 7, mechanisms + 11);
}

TEST_CASE("a cable as cold as its air, and the work of climbing, are named and sized") {
  check_detection(mechanisms + 11, hidden_effects().size());
}

TEST_CASE("every effect gets one verdict, and none that is ruled out is there") {
  int wrong = 0;
  int asked = 0;
  std::string failures;
  for (std::size_t e = 0; e < hidden_effects().size(); e += test::stride()) {
    const HiddenEffect& effect = hidden_effects()[e];
    Scenario scenario;
    scenario.seed = seed(500'000 + e);
    effect.hide(scenario.hidden, 0);  // about the limit of detection: found or not
    const Diagnosis d = diagnosis_of(scenario);
    INFO(effect.id << ": " << summary(d));
    auto verdicts = test::verdict_counts(d);
    for (const Effect& told : effect_catalogue(LogKind::power)) {
      INFO(told.id);
      CHECK(verdicts[told.id] == 1);
    }
    const EffectParameter& p = find_effect(effect.id)->parameters.front();
    const double neutral = p.in_design != nullptr ? p.in_design(spec()) : p.neutral;
    for (const RuledOut& r : d.ruled_out) {
      CHECK(r.bound > 0);
      if (r.parameter != p.name) continue;
      ++asked;
      const bool there = std::abs(effect.truth(scenario.hidden) - neutral) > 1.02 * r.bound;
      wrong += there;
      if (there) failures += effect.id + ": " + summary(d) + "\n";
    }
  }
  // Where another effect explains it, the hidden one is ruled out beside that.
  INFO(asked << " asked\n" << failures);
  CHECK(wrong <= 4);
}

TEST_CASE("causes that others mimic together are not ruled out beside those") {
  if (test::leave_rates_out()) return;
  // Four metres more of cable in thinner air draw what these three do, with two names.
  constexpr double resistance = 0.2;
  constexpr double mass = 0.2;
  constexpr double motors = 0.05;
  int wrong = 0;
  std::string failures;
  for (std::uint64_t draw = 0; draw < 6; ++draw) {
    Scenario scenario;
    scenario.seed = seed(2730 + draw);
    scenario.duration = draw % 2 == 0 ? 0 : 700;
    scenario.hidden.contact_resistance = resistance;
    scenario.hidden.extra_mass = mass;
    scenario.hidden.motor_power_factor = 1 + motors;
    const Diagnosis d = diagnosis_of(scenario);
    for (const RuledOut& r : d.ruled_out) {
      const bool there = (r.effect == "contact_resistance" && resistance > 1.02 * r.bound) ||
                         (r.effect == "extra_mass" && mass > 1.02 * r.bound) ||
                         (r.effect == "motor_power_scale" && motors > 1.02 * r.bound);
      wrong += there;
      if (there) failures += r.effect + ": " + summary(d) + "\n";
    }
  }
  // Bounds of 95 % on up to 18 sizes: more in one run of a hundred.
  INFO(failures);
  CHECK(wrong <= 3);
}

TEST_CASE("two power effects at once are both found") {
  if (test::leave_rates_out()) return;
  constexpr std::size_t sieve = 4;  // every seed tries others of the pairs
  // Those of the drone and its line; each instrument is paired with them through its rivals.
  const auto effects = std::span(hidden_effects()).first(mechanisms);
  int pairs = 0;
  int found = 0;
  std::string failures;
  std::size_t number = 0;
  for (std::size_t a = 0; a < effects.size(); ++a) {
    for (std::size_t b = a + 1; b < effects.size(); ++b) {
      if (degenerate(effects[a].id, effects[b].id)) continue;
      if (number++ % sieve != test::run_seed() % sieve) continue;
      Scenario scenario;
      scenario.seed = seed(200'000 + number);
      effects[a].hide(scenario.hidden, 0.6);
      effects[b].hide(scenario.hidden, 0.6);
      const Diagnosis d = diagnosis_of(scenario);
      const bool both = any_names(d, effects[a].id) && any_names(d, effects[b].id);
      ++pairs;
      found += both;
      if (!both) failures += effects[a].id + " and " + effects[b].id + ": " + summary(d) + "\n";
    }
  }
  INFO(failures);
  // Seen: 89 % of 315 pairs, most misses a translational lift beside another. Of 15 pairs six are
  // missed by a chance of one in 300.
  CHECK(found >= 0.65 * pairs);
}

TEST_CASE("what no power effect describes is seen, with its channel, and not given a name") {
  constexpr int sizes = 5;
  std::uint64_t number = 0;
  int right = 0;
  int total = 0;
  std::string failures;
  test::Random random(test::run_seed());
  for (const UnknownEffect& unknown : unknown_effects()) {
    for (int i = 0; i < sizes; ++i) {
      Scenario scenario;
      scenario.seed = seed(300'000 + number);
      scenario.hidden.step_at = random.uniform(0.25, 0.75);
      if (number++ % test::stride() != 0) continue;
      unknown.hide(scenario.hidden, i / (sizes - 1.0));
      const Diagnosis d = diagnosis_of(scenario);
      const bool ok = d.unexplained.detected && d.unexplained.channels.front() == unknown.channel &&
                      d.findings.empty();
      ++total;
      right += ok;
      if (!ok) failures += unknown.words + ": " + summary(d) + "\n";
    }
  }
  INFO(failures);
  CHECK(right >= 0.8 * total - 1);
}

TEST_CASE("at one height contacts, drum and resistivity are declared indistinguishable") {
  // A rival is left out where the log speaks against it with less than 5 % of the likelihood, so
  // about one log in ten names but two of the three: of 12, five do by a chance of one in 200.
  int declared = 0;
  std::string failures;
  const int logs = test::draws(12);
  for (int i = 0; i < logs; ++i) {
    Scenario scenario;
    scenario.profile = Profile::one_height;
    scenario.hidden.contact_resistance = 0.3;
    scenario.seed = seed(400'000 + static_cast<std::uint64_t>(i));
    const Diagnosis d = diagnosis_of(scenario);
    INFO(summary(d));
    REQUIRE(d.findings.size() == 1);
    const Finding& first = d.findings.front();
    CHECK(first.indistinguishable_from.size() <= 2);
    CHECK_THAT(first.to_separate, Catch::Contains("height"));
    const bool all = names(first, "contact_resistance") && names(first, "conductor_resistivity");
    declared += all;
    if (!all) failures += summary(d) + "\n";
  }
  INFO(failures);
  CHECK(declared >= 0.7 * logs - 1);
}

TEST_CASE("without the drone's voltage what needs it is not testable, the motors still are") {
  Scenario scenario;
  scenario.hidden.contact_resistance = 0.3;
  scenario.hidden.extra_mass = 0.15;
  scenario.seed = seed(400'010);
  PowerLog log = as_power_log(simulate(scenario));
  log.drone_voltage.clear();
  const Diagnosis d = diagnosis_of(log);
  INFO(summary(d));
  for (const Effect& effect : effect_catalogue()) {
    if (effect.log != LogKind::power) continue;
    const bool needs = std::find(effect.needs.begin(), effect.needs.end(), "drone_voltage_V") !=
                       effect.needs.end();
    CHECK(lists(d.not_testable, effect.id) == needs);
  }
  REQUIRE(d.findings.size() == 1);
  CHECK(names(d.findings.front(), "extra_mass"));
}

TEST_CASE("without the bus channels the tether is still judged") {
  Scenario scenario;
  scenario.hidden.contact_resistance = 0.3;
  scenario.hidden.extra_mass = 0.15;
  scenario.seed = seed(400'020);
  PowerLog log = as_power_log(simulate(scenario));
  log.bus_current.clear();
  const Diagnosis d = diagnosis_of(log);
  INFO(summary(d));
  REQUIRE(d.findings.size() == 1);
  CHECK(names(d.findings.front(), "contact_resistance"));
  for (const char* id : {"extra_mass", "auxiliary_power", "motor_power_scale"}) {
    CHECK(lists(d.not_testable, id));
  }
}

TEST_CASE("without the bus channels a drone that draws more is noticed, one as designed is not") {
  const auto is_noticed = [](double extra_mass, double contact_resistance, unsigned number) {
    Scenario scenario;
    scenario.hidden.extra_mass = extra_mass;
    scenario.hidden.contact_resistance = contact_resistance;
    scenario.seed = seed(400'100 + number);
    PowerLog log = as_power_log(simulate(scenario));
    log.bus_current.clear();
    const Diagnosis d = diagnosis_of(log);
    INFO(summary(d));
    return std::ranges::count(d.notes, WarningKind::log_power_untold, &Warning::kind) > 0;
  };
  for (unsigned i = 0; i < static_cast<unsigned>(test::draws(6)); ++i) {
    CHECK(is_noticed(0.15, 0, 3 * i));
    CHECK_FALSE(is_noticed(0, 0, 3 * i + 1));
    CHECK_FALSE(is_noticed(0, 0.3, 3 * i + 2));
  }
}

TEST_CASE("bus, height and airspeed alone are judged by the motors") {
  Scenario scenario;
  scenario.hidden.contact_resistance = 0.3;
  scenario.hidden.motor_power_factor = 1.12;
  scenario.seed = seed(400'030);
  PowerLog log = as_power_log(simulate(scenario));
  log.supply_voltage.clear();
  log.supply_current.clear();
  log.drone_voltage.clear();
  PowerLog power_only = log;
  power_only.bus_power = bus_power_of(log);
  power_only.bus_voltage.clear();
  power_only.bus_current.clear();
  for (const PowerLog& measured : {log, power_only}) {
    const Diagnosis d = diagnosis_of(measured);
    INFO(summary(d));
    REQUIRE(d.findings.size() == 1);
    CHECK(names(d.findings.front(), "motor_power_scale"));
    CHECK(d.quantity == "motor power");
    REQUIRE(lists(d.not_testable, "contact_resistance"));
    for (const NotTestable& missing : d.not_testable) {
      if (missing.effect != "contact_resistance") continue;
      CHECK(missing.needs == "supply_voltage_V, supply_current_A, drone_voltage_V");
    }
  }
}

TEST_CASE("a supply pair alone is refused with the channels that make a stage") {
  PowerLog log = as_power_log(simulate({}));
  log.drone_voltage.clear();
  log.bus_voltage.clear();
  log.bus_current.clear();
  CHECK_THROWS_WITH(diagnosis_of(log),
                    Catch::Contains("the motors need height_m, airspeed_m_s, bus_voltage_V, "
                                    "bus_current_A;") &&
                        Catch::Contains("the tether height_m, supply_voltage_V, "
                                        "supply_current_A, drone_voltage_V;") &&
                        Catch::Contains("bus_power_W will do"));
}

TEST_CASE("a power log that is too short is not judged") {
  Scenario scenario;
  scenario.duration = 90;
  scenario.hidden.extra_mass = 0.3;
  const Diagnosis d = diagnosis_of(scenario);
  CHECK(d.findings.empty());
  CHECK_FALSE(d.unexplained.detected);
  CHECK(lists(d.not_testable, "extra_mass"));
  REQUIRE_FALSE(d.notes.empty());
}

TEST_CASE(
    "two flights with hours between them in one power log are judged as one of their length") {
  const auto with_pause = [](const Scenario& scenario) {
    Log log = simulate(scenario);
    for (std::size_t i = log.time.size() / 2; i < log.time.size(); ++i) log.time[i] += 7200;
    return as_power_log(log);
  };
  Scenario scenario;
  scenario.seed = seed(400'045);
  const Diagnosis nothing = diagnosis_of(with_pause(scenario));
  INFO(summary(nothing));
  CHECK(nothing.findings.empty());

  scenario.hidden.extra_mass = 0.2;
  const Diagnosis heavy = diagnosis_of(with_pause(scenario));
  INFO(summary(heavy));
  REQUIRE_FALSE(heavy.findings.empty());
  CHECK(names(heavy.findings.front(), "extra_mass"));

  scenario.duration = 90;
  CHECK(lists(diagnosis_of(with_pause(scenario)).not_testable, "extra_mass"));
}

TEST_CASE("clocks that disagree are set right and not taken for physics") {
  const double bus = GENERATE(0.0, 3.0, -2.0);
  const double flight = GENERATE(0.0, 4.0);
  if (bus == 0 && flight == 0) return;
  if (test::leave_rates_out() && (bus != 3 || flight == 0)) return;
  Scenario scenario;
  scenario.bus_clock_offset = bus;
  scenario.flight_clock_offset = flight;
  scenario.seed = seed(400'030);
  const Diagnosis nothing = diagnosis_of(scenario);
  INFO(summary(nothing));
  CHECK(nothing.findings.empty());
  CHECK_FALSE(nothing.notes.empty());

  scenario.hidden.extra_mass = 0.2;
  const Diagnosis heavy = diagnosis_of(scenario);
  INFO(summary(heavy));
  REQUIRE_FALSE(heavy.findings.empty());
  CHECK(names(heavy.findings.front(), "extra_mass"));
}

TEST_CASE("clocks that agree are left alone, however noisy the channels") {
  for (int i = 0; i < test::draws(12); ++i) {
    Scenario scenario;
    scenario.seed = seed(400'035) + static_cast<unsigned>(i);
    const Diagnosis diagnosis = diagnosis_of(scenario);
    INFO(scenario.seed << ": " << summary(diagnosis));
    CHECK(std::ranges::none_of(
        diagnosis.notes, [](const Warning& note) { return note.kind == WarningKind::log_lag; }));
  }
}

TEST_CASE("a stuck instrument is noticed and not taken for physics") {
  const std::string channel = GENERATE(as<std::string>(), "drone_voltage_V", "bus_current_A",
                                       "supply_current_A", "height_m", "airspeed_m_s");
  Scenario scenario;
  scenario.stuck_channel = channel;
  scenario.seed = seed(400'040);
  // An airspeed of nothing is what the instrument may show for long in still air.
  const auto stuck_at_nothing = [&] {
    const Log log = simulate(scenario);
    return log.airspeed[log.airspeed.size() / 2] == 0;
  };
  while (channel == "airspeed_m_s" && stuck_at_nothing()) ++scenario.seed;
  const Diagnosis nothing = diagnosis_of(scenario);
  INFO(channel << ": " << summary(nothing));
  CHECK(nothing.findings.empty());
  CHECK_FALSE(nothing.unexplained.detected);
  CHECK(std::any_of(nothing.notes.begin(), nothing.notes.end(), [&](const Warning& note) {
    return note.sentence.find(channel) != std::string::npos &&
           note.sentence.find("stuck") != std::string::npos;
  }));
}

TEST_CASE("outliers in 1 % of the samples change neither silence nor names") {
  Scenario scenario;
  scenario.outlier_share = 0.01;
  scenario.seed = seed(400'050);
  const Diagnosis nothing = diagnosis_of(scenario);
  INFO(summary(nothing));
  CHECK(nothing.findings.empty());

  scenario.hidden.contact_resistance = 0.2;
  const Diagnosis contact = diagnosis_of(scenario);
  INFO(summary(contact));
  REQUIRE_FALSE(contact.findings.empty());
  CHECK(names(contact.findings.front(), "contact_resistance"));
}

TEST_CASE("a drone that tilted beyond the design's limit is diagnosed all the same") {
  Scenario scenario;
  scenario.hidden.tether_drag_factor = 2.6;  // some 45° at 10 m/s and 30 m
  scenario.seed = seed(400'055);
  const Diagnosis d = diagnosis_of(scenario);
  INFO(summary(d));
  REQUIRE(d.findings.size() == 1);
  CHECK(d.findings.front().effect == "tether_drag");
  CHECK(d.findings.front().parameters.front().value == Approx(2.6).margin(0.15));
}

TEST_CASE("a base effect is refitted and not reported") {
  Scenario scenario;
  scenario.hidden.extra_mass = 0.2;
  scenario.seed = seed(400'060);
  const std::vector<std::string> base{"extra_mass"};
  const Diagnosis d = diagnose_power(spec(), as_power_log(simulate(scenario)), base).diagnosis;
  INFO(summary(d));
  CHECK(d.findings.empty());
  REQUIRE(d.base.parameters.size() == 1);
  CHECK(d.base.parameters.front().value == Approx(0.2).margin(0.02));
}

TEST_CASE("the extended design holds what outlives the flight") {
  Scenario scenario;
  scenario.seed = seed(400'070);
  scenario.hidden.extra_mass = 0.2;
  scenario.hidden.contact_resistance = 0.3;
  const Design extended = diagnose_power(spec(), as_power_log(simulate(scenario))).extended;
  CHECK(extended.drone.mass == Approx(1.91).margin(0.03));
  CHECK(extended.tether.contact_resistance == Approx(0.3).margin(0.02));
  if (test::leave_rates_out()) return;

  Scenario warm;
  warm.seed = seed(400'071);
  warm.hidden.heating = 15;
  warm.hidden.converter_fixed_loss = 15;
  const Design hot = diagnose_power(spec(), as_power_log(simulate(warm))).extended;
  CHECK(hot.tether.heating.rise_per_loss == Approx(15).margin(3));
  // 4.6 A: 1.1 W/m, 15 K each in still air, less than half in the wind of the design airspeed.
  const double warm_C =
      evaluate(hot, *hot.tether.cross_section, Condition::forward).conductor_temperature;
  CHECK(warm_C > 23);
  CHECK(warm_C < 45);
  CHECK(efficiency_at(hot.supply.converter, 300) ==
        Approx(300 / (300 + 15 + 1.55e-4 * 9e4)).epsilon(0.003));
}

/// A log in which 0.2 kg are dropped after so much of its duration.
struct Drop {
  PowerLog log;
  double moment;  ///< s

  Drop(std::uint64_t with_seed, double share) {
    Scenario scenario;
    scenario.seed = with_seed;
    scenario.hidden.payload_drop = 0.2;
    scenario.hidden.step_at = share;
    log = as_power_log(simulate(scenario));
    moment = log.time.front() + share * (log.time.back() - log.time.front());
  }
};

/// The moment that is told of a log in which nothing else is found.
ParameterEstimate moment_found_in(const Drop& drop) {
  const Diagnosis d = diagnosis_of(drop.log);
  INFO(summary(d));
  REQUIRE(d.findings.size() == 1);
  CHECK(d.findings.front().effect == "payload_drop");
  const ParameterEstimate& moment = d.findings.front().parameters.at(1);
  CHECK(std::abs(moment.value - drop.moment) < 20);
  return moment;
}

TEST_CASE("the moment at which a payload is dropped is told") {
  int told = 0;
  const int logs = test::draws(10);
  for (int i = 0; i < logs; ++i) {
    const Drop drop(seed(410'000 + static_cast<std::uint64_t>(i)), 0.3 + 0.05 * i);
    const ParameterEstimate moment = moment_found_in(drop);
    told += moment.ci95_lower <= drop.moment && drop.moment <= moment.ci95_upper ? 1 : 0;
  }
  // Of ten intervals at 95 % three miss in 1 % of runs.
  if (!test::leave_rates_out()) CHECK(10 * told >= 8 * logs);
}

TEST_CASE("neither noise that takes a leap for memory nor spikes about it hide a drop") {
  for (const auto& [with_seed, share] : {std::pair{105'410'319ULL, 0.5}, {109'410'336ULL, 0.75}}) {
    moment_found_in(Drop(with_seed, share));
  }
  // A leap so large that its sides lie beyond five standard deviations of what no shape follows.
  const Drop beyond(109'410'334ULL, 0.65);
  CHECK(std::abs(moment_found_in(beyond).value - beyond.moment) < 5);
}

TEST_CASE("the error budget of a power log sums to the whole") {
  Scenario scenario;
  scenario.seed = seed(400'080);
  scenario.hidden.contact_resistance = 0.2;
  scenario.hidden.step_in_motor_power = 0.08;
  const Diagnosis d = diagnosis_of(scenario);
  INFO(summary(d));
  REQUIRE(d.budget.findings.size() == d.findings.size());
  const double named = std::accumulate(d.budget.findings.begin(), d.budget.findings.end(), 0.0);
  CHECK(named + d.budget.unexplained + d.budget.noise == Approx(100).margin(1e-6));
  CHECK(any_names(d, "contact_resistance"));
  CHECK(d.budget.unexplained > 0);
}

TEST_CASE("a spec without a cable, and a base effect of flights, are refused with the reason") {
  const PowerLog log = as_power_log(simulate({}));
  Design design = spec();
  design.tether.cross_section.reset();
  CHECK_THROWS_WITH(diagnose_power(design, log), Catch::Contains("cross_section"));
  const std::vector<std::string> base{"propwash"};
  CHECK_THROWS_WITH(diagnose_power(spec(), log, base), Catch::Contains("propwash"));
}

TEST_CASE("the practice power logs are answered correctly") {
  struct Answer {
    const char* file;
    std::string effect;
    double value;
  };
  const std::vector<Answer> answers{{"power-22.csv", "conductor_heating", 15.506},
                                    {"power-23.csv", "converter_efficiency_curve", 14.773},
                                    {"power-24.csv", "spooled_length", 24.935},
                                    {"power-25.csv", "extra_mass", 0.18769}};
  const PowerLog plain = practice_log("power-21.csv");
  if (plain.time.empty()) return;
  // The same weight as drone, as converter, and as pull of the winch.
  Design converter = spec();
  converter.drone.mass -= 0.2;
  converter.supply.converter.rated_output_power = 500;
  converter.supply.converter.specific_mass = 0.4e-3;
  Design winch = spec();
  winch.drone.mass -= 2 / winch.flight.gravity;
  winch.tether.winch_pull = 2;
  for (const Design& same : {spec(), converter, winch}) {
    const Diagnosis nothing = diagnose_power(same, plain).diagnosis;
    CHECK(nothing.findings.empty());
    CHECK_FALSE(nothing.unexplained.detected);
  }

  for (const Answer& answer : answers) {
    const Diagnosis d = diagnosis_of(practice_log(answer.file));
    INFO(answer.file << ": " << summary(d));
    REQUIRE(d.findings.size() == 1);
    CHECK(d.findings.front().effect == answer.effect);
    // A winch pulls like a weight in every log.
    const std::vector<std::string> alike = answer.effect == "extra_mass"
                                               ? std::vector<std::string>{"winch_tension"}
                                               : std::vector<std::string>{};
    CHECK(d.findings.front().indistinguishable_from == alike);
    CHECK(d.findings.front().parameters.front().ci95_lower <= answer.value);
    CHECK(d.findings.front().parameters.front().ci95_upper >= answer.value);
    CHECK_FALSE(d.unexplained.detected);
  }

  const Diagnosis step = diagnosis_of(practice_log("power-26.csv"));
  CHECK(step.findings.empty());
  CHECK(step.unexplained.detected);
  CHECK(step.unexplained.channels == std::vector<std::string>{"time_s"});
}
