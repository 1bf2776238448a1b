// Which manoeuvres there are to choose from, and how a further flight is chosen.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "diagnose/manoeuvres.hpp"
#include "support/simulated_flight.hpp"
#include "tethercalc/diagnose/next_flight.hpp"

using namespace tethercalc;

namespace {

FlightLimits usual_limits() {
  return {.speed = 12, .acceleration = 2.5, .height = 15, .ceiling = 30, .reach = 80};
}

/// One heading, with an offset of the pitch that a pull of a cable could be as well.
struct Doubtful {
  Design design;
  MeasuredFlight flight;
  FlightDiagnosisOptions options;
  Diagnosis diagnosis;
  FlightLimits limits;

  Doubtful() {
    test::SimulatedFlight truth;
    truth.seed = 5;
    truth.duration = 110;
    truth.pitch_offset = 0.045;
    design.drone.mass = truth.mass;
    design.flight.air_density = truth.air_density;
    flight.log = test::simulate(truth);
    options.base = {"linear_drag", "turning_wind"};
    diagnosis = diagnose_flights(design, {&flight, 1}, options);
    limits = flown_limits(design, {&flight, 1});
  }
  [[nodiscard]] NextFlight plan() const {
    return plan_next_flight(design, {&flight, 1}, options, diagnosis, limits);
  }
};

}  // namespace

TEST_CASE("manoeuvres keep to the limits, and begin and end above home") {
  const FlightLimits limits = usual_limits();
  const std::vector<Manoeuvre> candidates = candidate_manoeuvres(limits, 0.7);
  CHECK(candidates.size() > 10);
  for (const Manoeuvre& m : candidates) {
    CAPTURE(m.words);
    REQUIRE_FALSE(m.waypoints.empty());
    CHECK(m.duration > 5);
    CHECK(m.duration < 120);
    for (const Waypoint& w : m.waypoints) {
      CHECK(std::hypot(w.north, w.east) <= limits.reach + 1e-9);
      CHECK(w.height >= limits.height - 1e-9);
      CHECK(w.height <= limits.ceiling + 1e-9);
      CHECK(w.speed > 0);
      CHECK(w.speed <= limits.speed + 1e-9);
    }
    const Waypoint& end = m.waypoints.back();
    CHECK(std::hypot(end.north, end.east) < 1e-9);
    CHECK(end.height == Approx(limits.height));
  }
}

TEST_CASE("a manoeuvre's nominal flight goes where its waypoints are, no faster than they say") {
  const FlightLimits limits = usual_limits();
  const FlownBy drone{{0.017, 0.016, 15, 0}, 1.8, 1.225, 9.80665};
  for (const Manoeuvre& m : candidate_manoeuvres(limits, 0.7)) {
    CAPTURE(m.words);
    const NominalFlight flown = nominal_flight({&m, 1}, limits, 0.7, drone);
    const FlightLog& log = flown.log;
    double north = 0;
    double east = 0;
    double farthest = 0;
    double fastest = 0;
    double most_tilt = 0;
    for (std::size_t i = 0; i < log.time.size(); ++i) {
      north += 0.1 * log.north_velocity[i];
      east += 0.1 * log.east_velocity[i];
      farthest = std::max(farthest, std::hypot(north, east));
      fastest = std::max(fastest, std::hypot(log.north_velocity[i], log.east_velocity[i]));
      most_tilt = std::max(most_tilt, std::abs(log.pitch[i]));
    }
    double furthest_waypoint = 0;
    for (const Waypoint& w : m.waypoints) {
      furthest_waypoint = std::max(furthest_waypoint, std::hypot(w.north, w.east));
    }
    CHECK(std::hypot(north, east) < 0.5);
    CHECK(farthest == Approx(furthest_waypoint).margin(0.5));
    CHECK(fastest <= limits.speed + 1e-9);
    CHECK(most_tilt < 0.7);
    CHECK(log.time.back() == Approx(m.duration).margin(1));
  }
}

TEST_CASE("limits are what was flown, and a drone on its cable stays on it") {
  const Doubtful doubtful;
  CHECK(doubtful.limits.speed > 3);
  CHECK(doubtful.limits.speed < 25);
  CHECK(doubtful.limits.height >= 10);
  CHECK(doubtful.limits.ceiling == Approx(doubtful.limits.height + 15).margin(10));
  Design held = doubtful.design;
  held.tether.length = 2000;
  const FlightLimits within = flown_limits(held, {&doubtful.flight, 1});
  CHECK(std::hypot(within.reach, within.ceiling) <= 0.95 * 2000 + 1e-6);
  held.flight.airspeed = 40;
  CHECK(flown_limits(held, {&doubtful.flight, 1}).speed == 40);
}

TEST_CASE("where nothing is open no flight is planned") {
  const Doubtful doubtful;
  const NextFlight none = plan_next_flight(doubtful.design, {&doubtful.flight, 1}, doubtful.options,
                                           Diagnosis{}, doubtful.limits);
  CHECK(none.manoeuvres.empty());
  CHECK(none.decides.empty());
  CHECK(none.undecided.empty());
}

namespace {

Suspected suspected(const std::string& effect) {
  Suspected out;
  out.effect = effect;
  out.gain_percent = 12;
  out.gain_se_percent = 3;
  return out;
}

}  // namespace

TEST_CASE("what belongs to moments of the logged flight is left open, and said so") {
  const Doubtful doubtful;
  Diagnosis diagnosis = doubtful.diagnosis;
  diagnosis.findings.clear();
  diagnosis.suspected = {suspected("wind_step")};
  const NextFlight next = plan_next_flight(doubtful.design, {&doubtful.flight, 1}, doubtful.options,
                                           diagnosis, doubtful.limits);
  CHECK(next.manoeuvres.empty());
  REQUIRE(next.undecided.size() == 1);
  CHECK(next.undecided[0].effect == "wind_step");
  CHECK(next.undecided[0].because.find("no other flight repeats") != std::string::npos);
}

TEST_CASE("less time settles no more, and less than the shortest plan not all") {
  Doubtful doubtful;
  // As the log would have it, whatever this draw came to.
  doubtful.diagnosis.findings.clear();
  doubtful.diagnosis.suspected = {suspected("pitch_trim"), suspected("fore_aft_asymmetry")};
  const NextFlight next = doubtful.plan();
  REQUIRE_FALSE(next.decides.empty());
  REQUIRE_FALSE(next.manoeuvres.empty());
  double sum = 0;
  for (const Manoeuvre& m : next.manoeuvres) sum += m.duration;
  CHECK(sum == Approx(next.duration));
  CHECK(next.decides.size() + next.undecided.size() == 2);

  // The very manoeuvres without any one of them: shorter, and too short where the plan is.
  std::size_t fewer = next.decides.size();
  for (const double part : {0.999, 0.6, 0.3}) {
    doubtful.limits.duration = part * next.duration;
    const NextFlight less = doubtful.plan();
    CHECK(less.duration <= doubtful.limits.duration + 1e-9);
    CHECK(less.decides.size() <= fewer);
    if (next.shortest) CHECK(less.decides.size() < next.decides.size());
    fewer = less.decides.size();
  }
  CHECK(fewer == 0);
}

TEST_CASE("a wind in the base model is to be told in detail where the flight turns") {
  Doubtful doubtful;
  doubtful.options.base = {"linear_drag", "wind"};
  doubtful.diagnosis.findings.clear();
  doubtful.diagnosis.suspected = {suspected("pitch_trim")};
  const NextFlight next = doubtful.plan();
  const bool turns =
      std::any_of(next.manoeuvres.begin(), next.manoeuvres.end(), [&](const Manoeuvre& m) {
        return m.waypoints.front().heading != next.manoeuvres.front().waypoints.front().heading;
      });
  if (!turns) return;
  REQUIRE(next.finer_base.size() == 1);
  CHECK(next.finer_base[0].coarse == "wind");
  CHECK(next.finer_base[0].fine == "turning_wind");
}
