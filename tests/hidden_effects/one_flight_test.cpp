// Attitude and power of one flight, judged together: a heavier drone, hungrier motors and more drag
// are told apart, which neither log can alone. Rates are asserted with room for chance: they stand
// at least two standard deviations of a binomial count below those in docs/diagnosis-power.md.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "hidden_effects/one_flight.hpp"
#include "support/random.hpp"
#include "support/verdicts.hpp"
#include "tethercalc/diagnose/power_diagnosis.hpp"
#include "tethercalc/report/diagnosis_report.hpp"

using namespace tethercalc;

namespace {

using truth::HiddenDrone;

std::uint64_t flight_seed(int number) {
  return 1'000'003ULL * test::run_seed() + static_cast<std::uint64_t>(number);
}

/// All that the first finding may be.
std::set<std::string> suspects(const Diagnosis& d) {
  std::set<std::string> ids;
  if (d.findings.empty()) return ids;
  ids.insert(d.findings.front().effect);
  for (const std::string& rival : d.findings.front().indistinguishable_from) ids.insert(rival);
  return ids;
}

bool any_of(const std::set<std::string>& ids, const std::set<std::string>& kind) {
  return std::any_of(ids.begin(), ids.end(), [&](const auto& id) { return kind.count(id) > 0; });
}

/// What acts alike in both logs of a flight at one height.
const std::set<std::string> weight{"extra_mass", "winch_tension"};
const std::set<std::string> appetite{"motor_power_scale", "air_density", "bus_current_gain"};
const std::set<std::string> drag{"airframe_drag", "tether_drag"};

struct Rates {
  int flights = 0;
  int named = 0;   ///< one finding, of the kind that was hidden alone
  int wrong = 0;   ///< a finding of which no suspect is of that kind
  int sized = 0;   ///< its interval holds the truth
  int fitted = 0;  ///< the hidden effect itself comes first
  std::string told;
};

/// By both halves as they are run together; the flight half is done once for all that leaves the
/// attitude as it is.
void judge(const DiagnosisQuestion& question, const std::optional<DragByTilt>& tilt,
           const std::string& hidden, double size, const std::set<std::string>& kind,
           Rates& rates) {
  const PowerLog& log = question.power->log;
  const Diagnosis joint = diagnose_power(question.design, log, {}, {}, {}, tilt).diagnosis;
  const std::set<std::string> ids = suspects(joint);
  ++rates.flights;
  rates.named +=
      joint.findings.size() == 1 && std::includes(kind.begin(), kind.end(), ids.begin(), ids.end());
  rates.wrong += !ids.empty() && !any_of(ids, kind);
  if (!joint.findings.empty() && joint.findings.front().effect == hidden) {
    const ParameterEstimate& p = joint.findings.front().parameters.front();
    ++rates.fitted;
    rates.sized += p.ci95_lower <= size && size <= p.ci95_upper;
  }
  rates.told += hidden + " " + std::to_string(size) + ":";
  for (const std::string& id : ids) rates.told += " " + id;
  rates.told += "\n";
}

/// Whether the power alone tells weight from appetite.
bool is_sure(const DiagnosisQuestion& question) {
  const std::set<std::string> ids =
      suspects(diagnose_power(question.design, question.power->log).diagnosis);
  return any_of(ids, weight) != any_of(ids, appetite);
}

std::optional<DragByTilt> tilt_of(const DiagnosisQuestion& question) {
  return diagnose_flights(question.design, question.flight->flights).drag_by_tilt;
}

/// `least` of 12.
int of_twelve(int flights, int least) { return flights * least / 12; }

}  // namespace

TEST_CASE("mass, motors and drag are told apart by tilt and power of one flight") {
  Rates mass, motors, more_drag, nothing;
  int sure_of_mass = 0;
  int sure_of_motors = 0;
  test::Random random(test::run_seed());
  for (int i = 0; i < test::draws(6); ++i) {
    HiddenDrone plain;
    plain.seed = flight_seed(i);
    const DiagnosisQuestion untouched = truth::one_flight_of(plain);
    const std::optional<DragByTilt> leaning = tilt_of(untouched);
    judge(untouched, leaning, "", 0, {}, nothing);

    HiddenDrone hungry = plain;
    hungry.effects.motor_power_factor = random.uniform(1.08, 1.15);
    const DiagnosisQuestion drawing = truth::one_flight_of(hungry);
    sure_of_motors += is_sure(drawing);
    judge(drawing, leaning, "motor_power_scale", hungry.effects.motor_power_factor, appetite,
          motors);

    HiddenDrone heavy = plain;
    heavy.effects.extra_mass = random.uniform(0.3, 0.6);
    const DiagnosisQuestion loaded = truth::one_flight_of(heavy);
    sure_of_mass += is_sure(loaded);
    judge(loaded, tilt_of(loaded), "extra_mass", heavy.effects.extra_mass, weight, mass);

    HiddenDrone bluff = plain;
    bluff.effects.airframe_drag_factor = random.uniform(1.2, 1.4);
    const DiagnosisQuestion dragged = truth::one_flight_of(bluff);
    judge(dragged, tilt_of(dragged), "airframe_drag", bluff.effects.airframe_drag_factor, drag,
          more_drag);
  }
  INFO("TETHERCALC_TEST_SEED=" << test::run_seed());
  for (const Rates* rates : {&mass, &motors, &more_drag}) {
    INFO(rates->told);
    CHECK(rates->named >= of_twelve(rates->flights, 9));
    CHECK(rates->wrong <= 1);
    CHECK(rates->sized >= of_twelve(rates->fitted, 9));
  }
  INFO(nothing.told);
  CHECK(nothing.wrong == 0);
  INFO("sure by the power alone of mass, of motors");
  CHECK(sure_of_mass <= of_twelve(mass.flights, 6));
  CHECK(sure_of_motors <= 1);
}

TEST_CASE("the tilt also tells mass from motors where the whole chain is measured") {
  int named = 0;
  std::string told;
  const int flights = test::draws(4);
  for (int i = 0; i < flights; ++i) {
    HiddenDrone hidden;
    hidden.whole_chain = true;
    hidden.seed = flight_seed(500 + i);
    const bool heavy = i % 2 == 0;
    if (heavy) {
      hidden.effects.extra_mass = 0.4;
    } else {
      hidden.effects.motor_power_factor = 1.12;
    }
    const DiagnosisStudy study = study_diagnosis(truth::one_flight_of(hidden));
    const std::set<std::string> ids = suspects(*study.power);
    const std::set<std::string>& kind = heavy ? weight : appetite;
    named += std::includes(kind.begin(), kind.end(), ids.begin(), ids.end()) && !ids.empty();
    for (const std::string& id : ids) told += " " + id;
    told += ";";
  }
  INFO("TETHERCALC_TEST_SEED=" << test::run_seed() << told);
  CHECK(named >= flights - 1);
}

TEST_CASE("the flight half alone never tells mass from drag, and says so") {
  HiddenDrone hidden;
  hidden.seed = flight_seed(600);
  hidden.effects.extra_mass = 0.5;
  DiagnosisQuestion question = truth::one_flight_of(hidden);
  question.power.reset();
  const DiagnosisStudy study = study_diagnosis(question);
  CHECK(test::lists(study.flight->not_identifiable, "extra_mass"));
  CHECK(study.extended.drone.mass == question.design.drone.mass);
}

TEST_CASE("what it takes to speed up and to brake is not taken for hungrier motors") {
  int told = 0;
  const int flights = test::draws(4);
  for (int i = 0; i < flights; ++i) {
    HiddenDrone hidden;
    hidden.acceleration = 4;
    hidden.seed = flight_seed(950 + i);
    const DiagnosisStudy study = study_diagnosis(truth::one_flight_of(hidden));
    told += !study.power->findings.empty();
  }
  INFO("TETHERCALC_TEST_SEED=" << test::run_seed());
  CHECK(told == 0);
}

TEST_CASE("of one flight both logs make one drone, with its mass and its drag") {
  HiddenDrone hidden;
  hidden.seed = flight_seed(700);
  hidden.effects.extra_mass = 0.5;
  const DiagnosisQuestion question = truth::one_flight_of(hidden);
  INFO("TETHERCALC_TEST_SEED=" << test::run_seed());
  const DiagnosisStudy study = study_diagnosis(question);

  const Drone& drone = study.extended.drone;
  CHECK(drone.mass == Approx(question.design.drone.mass + 0.5).epsilon(0.02));
  // The drag that flew, by hand: the airframe's and the cable's, in the mean over what was flown.
  // At one height the share of each cannot be told.
  const double of_cable = power_truth::cable_at({}, hidden.height).drag_area;
  const auto mean_drag = [&](const AirframeDrag& law) {
    double sum = 0;
    for (const double airspeed : study.flight->drag_by_tilt->airspeed) {
      const double v = std::abs(airspeed);
      const double by_area = 0.5 * 1.293 * (v + law.linear_speed) * v;
      const double cable = 0.5 * 1.293 * of_cable * v * v;
      const double lean = (by_area * law.front_area + cable) / (2.5 * 9.80665);  // tan θ, of 2.5 kg
      sum += by_area * (law.front_area + law.top_area * lean) + cable;
    }
    return sum;
  };
  CHECK(mean_drag(drone.drag) == Approx(mean_drag({0.01451, 0.01361, 19.27, 0})).epsilon(0.09));

  const std::string text = joint_diagnosis_text(*study.flight, *study.power, TextStyle{});
  CHECK_THAT(text, Catch::Contains("THE POWER, WITH THE TILT OF THE SAME FLIGHT"));
  CHECK_THAT(text, Catch::Contains("drag over mass that the tilt shows"));
  CHECK_THAT(text, Catch::Contains("weigh the drone"));
}

TEST_CASE("a drone that flew at another mass than the spec's is judged by that in both logs") {
  HiddenDrone hidden;
  hidden.seed = flight_seed(800);
  hidden.effects.extra_mass = 0.4;
  DiagnosisQuestion question = truth::one_flight_of(hidden);
  question.flight->mass = question.design.drone.mass + 0.4;
  INFO("TETHERCALC_TEST_SEED=" << test::run_seed());
  const DiagnosisStudy study = study_diagnosis(question);
  CHECK_FALSE(test::lists(study.power->findings, "extra_mass"));
  CHECK(study.extended.drone.mass == Approx(question.design.drone.mass).epsilon(1e-12));
}

TEST_CASE("logs of two flights are judged one by one") {
  HiddenDrone hidden;
  hidden.seed = flight_seed(900);
  DiagnosisQuestion question = truth::one_flight_of(hidden);
  question.one_flight = false;
  const DiagnosisStudy study = study_diagnosis(question);
  CHECK(study.flight->drag_by_tilt.has_value());
  CHECK_FALSE(study.power->drag_by_tilt.has_value());
  CHECK(study.power->compared.size() == 1);
}
