// Properties of the drag fit that hold for any flight.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

#include "support/random.hpp"
#include "support/simulated_flight.hpp"
#include "tethercalc/identify/drag_fit.hpp"

using namespace tethercalc;

namespace {

constexpr DragFitConditions conditions{1.6, 1.225, standard_gravity};

struct Truth {
  double front_area = 0.015;
  double top_area = 0.012;
  double linear_speed = 20;
  double wind = 1.5;
};

/// Observations that follow the drag law exactly, plus white noise of `deviation` m/s².
Observations exact_observations(const Truth& truth, std::uint64_t seed, double deviation = 0) {
  test::Dice dice(seed);
  Observations o;
  for (int i = 0; i < 600; ++i) {
    const double tilt = dice.between(-0.5, 0.5);
    const double speed = dice.between(-14, 14);
    const double u = speed - truth.wind;
    const double drag =
        0.5 * 1.225 / 1.6 * (u * std::abs(u) + truth.linear_speed * u) *
        (truth.front_area * std::cos(tilt) + truth.top_area * std::sin(std::abs(tilt)));
    o.time.push_back(0.1 * i);
    o.tilt.push_back(tilt);
    o.forward_speed.push_back(speed);
    o.expected_acceleration.push_back(9.8 * std::tan(tilt));
    o.forward_acceleration.push_back(9.8 * std::tan(tilt) - drag + deviation * dice.normal());
  }
  o.roll = o.yaw = o.right_speed = o.down_speed = o.down_acceleration =
      std::vector<double>(o.size(), 0.0);
  return o;
}

struct WindOverGround {
  double north = 2.5;  // m/s
  double east = -1.5;
};

/// Drag on the two level axes, m/s².
struct LevelDrag {
  double forward = 0;
  double right = 0;
};

/// A flight that turns as it flies on both axes, in a steady wind over ground, with the law written
/// out for each of them; `drags` takes the drag of every sample.
Observations turning_observations(const Truth& truth, const WindOverGround& wind,
                                  std::uint64_t seed, double deviation,
                                  std::vector<LevelDrag>* drags = nullptr) {
  constexpr double side_area = 0.021;
  test::Dice dice(seed);
  Observations o;
  for (int i = 0; i < 3000; ++i) {
    const double yaw = 0.002 * i;
    const double tilt = dice.between(-0.5, 0.5);
    const double roll = dice.between(-0.4, 0.4);
    const double speed = dice.between(-14, 14);
    const double aside = dice.between(-6, 6);
    const double u = speed - (wind.north * std::cos(yaw) + wind.east * std::sin(yaw));
    const double across = aside - (wind.east * std::cos(yaw) - wind.north * std::sin(yaw));
    const double factor = 0.5 * 1.225 / 1.6 * (std::hypot(u, across) + truth.linear_speed);
    const double sideward = std::atan(std::tan(roll) / std::cos(tilt));
    const LevelDrag drag{
        factor * u *
            (truth.front_area * std::cos(tilt) + truth.top_area * std::sin(std::abs(tilt))),
        factor * across *
            (side_area * std::cos(sideward) + truth.top_area * std::sin(std::abs(sideward)))};
    const double forward_noise = deviation * dice.normal();
    const double right_noise = deviation * dice.normal();
    o.time.push_back(0.1 * i);
    o.tilt.push_back(tilt);
    o.roll.push_back(roll);
    o.yaw.push_back(yaw);
    o.forward_speed.push_back(speed);
    o.right_speed.push_back(aside);
    o.expected_acceleration.push_back(standard_gravity * std::tan(tilt));
    o.forward_acceleration.push_back(o.expected_acceleration.back() - drag.forward + forward_noise);
    o.right_acceleration.push_back(standard_gravity * std::tan(sideward) - drag.right +
                                   right_noise);
    if (drags != nullptr) drags->push_back(drag);
  }
  o.down_speed = o.down_acceleration = std::vector<double>(o.size(), 0.0);
  return o;
}

/// N, root mean square.
double left_over(const std::vector<DragAtSample>& samples) {
  double sum = 0;
  for (const DragAtSample& s : samples) {
    sum += (s.measured - s.fitted) * (s.measured - s.fitted);
  }
  return std::sqrt(sum / double(samples.size()));
}

DragFit fit_one(const Observations& flight, const DragFitOptions& options = {}) {
  return fit_drag({&flight, 1}, conditions, options);
}

/// Infinite where the iteration ends at a point without drag.
double rmse_of(const Observations& flight, const DragFitOptions& options) {
  try {
    return fit_one(flight, options).quality.rmse;
  } catch (const UnsuitableFlight&) {
    return std::numeric_limits<double>::infinity();
  }
}

DragFit fit_log(const FlightLog& log) {
  const Observations flight = observe(log, moving_part(log), 0);
  return fit_one(flight);
}

void check_same(const DragFit& a, const DragFit& b, double tolerance = 1e-5) {
  REQUIRE(a.parameters.size() == b.parameters.size());
  for (std::size_t i = 0; i < a.parameters.size(); ++i) {
    const Estimate& x = a.parameters[i].estimate;
    const Estimate& y = b.parameters[i].estimate;
    CAPTURE(i);
    // In standard errors: how close iterations end.
    CHECK(std::abs(x.value - y.value) <= tolerance * x.standard_error);
    CHECK(x.standard_error == Approx(y.standard_error).epsilon(1e-3));
  }
}

template <typename Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no exception";
}

bool says(const std::string& message, const char* part) {
  return message.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("data without noise gives the truth back") {
  const std::uint64_t seed = test::run_seed();
  CAPTURE(seed);
  test::Dice dice(seed);
  for (int i = 0; i < 50; ++i) {
    const Truth truth{dice.between(0.002, 0.1), dice.between(0.002, 0.1), dice.between(0.5, 80),
                      dice.between(-10, 10)};
    const DragFit fit = fit_one(exact_observations(truth, seed + static_cast<std::uint64_t>(i)));
    CHECK(fit.converged);
    CHECK(fit.front_area().estimate.value == Approx(truth.front_area).epsilon(1e-7));
    CHECK(fit.top_area().estimate.value == Approx(truth.top_area).epsilon(1e-7));
    CHECK(fit.linear_speed().estimate.value == Approx(truth.linear_speed).epsilon(1e-7));
    CHECK(fit.wind()[0].estimate.value == Approx(truth.wind).epsilon(1e-7));
    CHECK(fit.quality.r_squared == Approx(1));
  }
}

TEST_CASE("of both axes the side area, the wind from there and the roll's trim come out") {
  test::Dice dice(test::run_seed());
  constexpr double side_area = 0.021;
  constexpr double crosswind = -0.7;
  constexpr double trim = 0.02;
  const Truth truth;
  Observations o;
  for (int i = 0; i < 600; ++i) {
    const double tilt = dice.between(-0.5, 0.5);
    const double roll = dice.between(-0.4, 0.4);
    const double ahead = dice.between(-14, 14) - truth.wind;
    const double aside = dice.between(-9, 9) - crosswind;
    const double speed = std::hypot(ahead, aside);
    // Along the airspeed, with areas by how far it leans in each direction.
    const double lean = std::atan(std::tan(roll) / std::cos(tilt));
    const double common = 0.5 * 1.225 / 1.6 * (speed + truth.linear_speed);
    const double drag =
        common * ahead *
        (truth.front_area * std::cos(tilt) + truth.top_area * std::abs(std::sin(tilt)));
    const double drag_aside =
        common * aside * (side_area * std::cos(lean) + truth.top_area * std::abs(std::sin(lean)));
    o.time.push_back(0.1 * i);
    o.tilt.push_back(tilt);
    o.roll.push_back(std::atan((std::tan(lean) + trim) * std::cos(tilt)));
    o.forward_speed.push_back(ahead + truth.wind);
    o.right_speed.push_back(aside + crosswind);
    o.expected_acceleration.push_back(standard_gravity * std::tan(tilt));
    o.forward_acceleration.push_back(standard_gravity * std::tan(tilt) - drag);
    o.right_acceleration.push_back(standard_gravity * std::tan(lean) - drag_aside);
  }
  o.yaw = o.down_speed = o.down_acceleration = std::vector<double>(o.size(), 0.0);
  // The fit takes the areas at the logged lean, 0.02 rad off: up to a hundredth of the drag.
  const DragFit fit = fit_one(o);
  CHECK(fit.converged);
  CHECK(fit.front_area().estimate.value == Approx(truth.front_area).epsilon(0.01));
  CHECK(fit.top_area().estimate.value == Approx(truth.top_area).epsilon(0.01));
  CHECK(fit.linear_speed().estimate.value == Approx(truth.linear_speed).epsilon(0.01));
  CHECK(fit.wind()[0].estimate.value == Approx(truth.wind).epsilon(0.01));
  REQUIRE(fit.find("side_area_m2") != nullptr);
  CHECK(fit.find("side_area_m2")->estimate.value == Approx(side_area).epsilon(0.01));
  CHECK(fit.find("crosswind_m_s")->estimate.value == Approx(crosswind).margin(0.02));
  CHECK(fit.find("roll_trim_rad")->estimate.value == Approx(trim).margin(0.001));

  o.kinematics = Kinematics::published;
  CHECK(fit_one(o).find("side_area_m2") == nullptr);
}

TEST_CASE("no random start finds a better minimum than the built-in one") {
  const std::uint64_t seed = test::run_seed();
  CAPTURE(seed);
  test::Dice dice(seed);
  int determined = 0;
  for (int i = 0; i < 10; ++i) {
    // Winds up to a storm, and noise up to that of the drag itself.
    const Truth truth{dice.between(0.002, 0.05), dice.between(0.002, 0.05), dice.between(0.5, 60),
                      dice.between(-12, 12)};
    const Observations flight =
        exact_observations(truth, seed + static_cast<std::uint64_t>(i), dice.between(0.1, 2));
    std::optional<DragFit> fit;
    try {
      fit = fit_one(flight);
    } catch (const UnsuitableFlight&) {
      continue;  // so much noise on so little drag that it determines nothing
    }
    ++determined;
    for (int k = 0; k < 20; ++k) {
      DragFitOptions options;
      options.start = DragParameters{dice.between(0.001, 0.1),
                                     dice.between(0.001, 0.1),
                                     dice.between(0.5, 100),
                                     {dice.between(-20, 20)}};
      // In the flattest of these valleys iterations end within a twentieth of a standard error:
      // 0.05²/N in the sum of squares.
      CHECK(fit->quality.rmse <= rmse_of(flight, options) * (1 + 2e-6));
    }
  }
  CHECK(determined >= 7);
}

TEST_CASE("several flights share the drag and keep their own winds") {
  test::SimulatedFlight first;
  first.wind = -2.5;
  first.seed = test::run_seed();
  CAPTURE(first.seed);
  test::SimulatedFlight second = first;
  second.wind = 1.5;
  second.seed += 1;
  second.heading = 3;
  const FlightLog logs[] = {test::simulate(first), test::simulate(second)};
  const std::vector<Observations> both{observe(logs[0], moving_part(logs[0]), 0),
                                       observe(logs[1], moving_part(logs[1]), 0)};
  const DragFit joint = fit_drag(both, conditions);
  REQUIRE(joint.wind().size() == 2);
  // Six honest standard errors: beyond chance, and small against the 4 m/s between the winds.
  CHECK(std::abs(joint.wind()[0].estimate.value + 2.5) <
        6 * joint.wind()[0].estimate.standard_error);
  CHECK(std::abs(joint.wind()[1].estimate.value - 1.5) <
        6 * joint.wind()[1].estimate.standard_error);
  CHECK(joint.wind()[0].estimate.standard_error < 0.3);
  CHECK(joint.wind()[1].name == "wind_m_s[1]");
  CHECK(joint.quality.samples == both[0].size() + both[1].size());

  // Two flights know the shared drag better than either.
  const double alone =
      std::min(fit_one(both[0]).linear_speed().estimate.standard_error_independent,
               fit_one(both[1]).linear_speed().estimate.standard_error_independent);
  CHECK(joint.linear_speed().estimate.standard_error_independent < alone);
  CHECK(joint.linear_speed().estimate.degrees_of_freedom > joint.degrees_of_freedom_by_flight[0]);

  // Their order does not matter.
  const std::vector<Observations> swapped{both[1], both[0]};
  const DragFit other = fit_drag(swapped, conditions);
  CHECK(other.wind()[0].estimate.value == Approx(joint.wind()[1].estimate.value).epsilon(1e-5));
  CHECK(other.front_area().estimate.value ==
        Approx(joint.front_area().estimate.value).epsilon(1e-5));
}

TEST_CASE("the same flight given twice has the same parameters") {
  const FlightLog log = test::simulate({});
  const std::vector<Observations> twice(2, observe(log, moving_part(log), 0));
  const DragFit one = fit_one(twice[0]);
  const DragFit two = fit_drag(twice, conditions);
  CHECK(two.front_area().estimate.value == Approx(one.front_area().estimate.value).epsilon(1e-6));
  CHECK(two.wind()[1].estimate.value == Approx(one.wind()[0].estimate.value).epsilon(1e-6));
  CHECK(two.front_area().estimate.standard_error ==
        Approx(one.front_area().estimate.standard_error / std::sqrt(2)).epsilon(0.02));
}

TEST_CASE("neither the log's clock nor the heading of the flight changes the fit") {
  const FlightLog log = test::simulate({});
  const DragFit fit = fit_log(log);
  FlightLog later = log;
  for (double& t : later.time) t += 86400;
  check_same(fit_log(later), fit);

  FlightLog turned = log;
  const double turn = 2.2;
  for (std::size_t i = 0; i < log.time.size(); ++i) {
    turned.yaw[i] += turn;
    turned.north_velocity[i] =
        std::cos(turn) * log.north_velocity[i] - std::sin(turn) * log.east_velocity[i];
    turned.east_velocity[i] =
        std::sin(turn) * log.north_velocity[i] + std::cos(turn) * log.east_velocity[i];
  }
  check_same(fit_log(turned), fit);
}

TEST_CASE("flown the other way round the wind changes sign and the drag stays") {
  const FlightLog log = test::simulate({});
  FlightLog mirrored = log;
  for (std::size_t i = 0; i < log.time.size(); ++i) {
    mirrored.pitch[i] *= -1;
    mirrored.yaw[i] += std::numbers::pi;
  }
  const DragFit a = fit_log(log);
  const DragFit b = fit_log(mirrored);
  CHECK(b.front_area().estimate.value == Approx(a.front_area().estimate.value).epsilon(1e-6));
  CHECK(b.linear_speed().estimate.value == Approx(a.linear_speed().estimate.value).epsilon(1e-6));
  CHECK(b.wind()[0].estimate.value == Approx(-a.wind()[0].estimate.value).epsilon(1e-6));
}

TEST_CASE("mass and air density only rescale the areas") {
  const Observations flight = exact_observations({}, 7, 0.3);
  const DragFit fit = fit_one(flight);
  const DragFit heavy = fit_drag({&flight, 1}, {3.2, 1.225, standard_gravity});
  const DragFit thin = fit_drag({&flight, 1}, {1.6, 1.225 / 2, standard_gravity});
  for (const DragFit& other : {heavy, thin}) {
    CHECK(other.front_area().estimate.value == Approx(2 * fit.front_area().estimate.value));
    CHECK(other.top_area().estimate.standard_error ==
          Approx(2 * fit.top_area().estimate.standard_error));
    CHECK(other.linear_speed().estimate.value == Approx(fit.linear_speed().estimate.value));
    CHECK(other.wind()[0].estimate.value == Approx(fit.wind()[0].estimate.value));
  }
}

TEST_CASE("white residuals have the same honest and independent errors") {
  double ratio = 0;
  constexpr int count = 40;
  const std::uint64_t seed = test::run_seed();
  CAPTURE(seed);
  for (int i = 0; i < count; ++i) {
    DragFit fit = fit_one(exact_observations({}, seed + static_cast<std::uint64_t>(i), 0.3));
    // Tilt is random from sample to sample here, so differentiating it means nothing.
    std::fill(fit.differentiation_correction.begin(), fit.differentiation_correction.end(), 0.0);
    const std::array<double, 4> linear{0, 0, 1, 0};
    const Estimate j = propagate(fit, 0, linear);
    ratio += j.standard_error / j.standard_error_independent / count;
  }
  CHECK(ratio == Approx(1).margin(0.1));
}

TEST_CASE("an area that wants to be negative is held at zero, and said") {
  Truth truth;
  truth.top_area = -0.004;
  const DragFit fit = fit_one(exact_observations(truth, 3, 0.1));
  CHECK(fit.top_area().at_bound == Bound::lower);
  CHECK(fit.top_area().estimate.value == 0);
  CHECK(std::isnan(fit.top_area().estimate.standard_error));
  CHECK(fit.front_area().at_bound == Bound::none);
  CHECK(std::isfinite(fit.front_area().estimate.standard_error));
  CHECK(fit.correlation(1, 2) == 0);
  CHECK(std::isfinite(steady_drag(fit, 8)->force.standard_error));
}

TEST_CASE("purely linear drag sends j to its bound, and the drag force is still right") {
  // A·j = 0.3 m³/s with A → 0, seen through noise.
  Truth truth{3e-7, 3e-7, 1e6, -1};
  const DragFit fit = fit_one(exact_observations(truth, 5, 0.02));
  CHECK(fit.linear_speed().at_bound == Bound::upper);
  CHECK(fit.linear_speed().estimate.value == Approx(DragBounds{}.max_linear_speed));
  const double force = 0.5 * 1.225 * 0.3 * 6;  // cosθ + sinθ is 1.2 at the tilt of about 0.07
  CHECK(steady_drag(fit, 6)->force.value == Approx(force).epsilon(0.1));
}

TEST_CASE("what is left of the drag at the samples is the fit's own residual, times the mass") {
  const Observations first = exact_observations({}, 21, 0.3);
  Truth blown;
  blown.wind = -2;
  const std::vector<Observations> flights{first, exact_observations(blown, 22, 0.2)};
  const DragFit fit = fit_drag(flights, conditions);
  const std::vector<DragAtSample> samples = drag_at_samples(fit, flights);
  REQUIRE(samples.size() == fit.quality.samples);
  CHECK(left_over(samples) == Approx(conditions.mass * fit.quality.rmse).epsilon(1e-9));
  const std::vector<double> over_mass = forward_drag_over_mass(first);
  for (std::size_t i = 0; i < first.size(); ++i) {
    CHECK(samples[i].airspeed ==
          Approx(first.forward_speed[i] - fit.wind()[0].estimate.value).margin(1e-12));
    CHECK(samples[i].tilt == first.tilt[i]);
    CHECK(samples[i].measured == Approx(conditions.mass * over_mass[i]).margin(1e-12));
  }
  CHECK(says(message_of([&] { (void)drag_at_samples(fit, {&first, 1}); }), "not those"));
}

TEST_CASE("without a roll a flight that turns tells drag and the wind over ground apart") {
  const Truth truth;
  Observations flight = turning_observations(truth, {}, test::run_seed(), 0);
  flight.roll.assign(flight.size(), 0.0);
  const DragFit fit = fit_one(flight);
  const WindOverGround wind;
  REQUIRE(fit.wind_heading[0].has_value());
  const double heading = *fit.wind_heading[0];
  CHECK(fit.find("side_area_m2") == nullptr);
  CHECK(fit.front_area().estimate.value == Approx(truth.front_area).epsilon(1e-4));
  CHECK(fit.top_area().estimate.value == Approx(truth.top_area).epsilon(1e-4));
  CHECK(fit.linear_speed().estimate.value == Approx(truth.linear_speed).epsilon(1e-4));
  CHECK(fit.wind()[0].estimate.value ==
        Approx(wind.north * std::cos(heading) + wind.east * std::sin(heading)).margin(1e-4));
  CHECK(fit.find("crosswind_m_s")->estimate.value ==
        Approx(wind.east * std::cos(heading) - wind.north * std::sin(heading)).margin(1e-4));

  // Of several flights each that turns has its own.
  Observations straight = flight;
  straight.yaw.assign(flight.size(), 0.3);
  straight.kinematics = Kinematics::published;
  const std::vector<Observations> both{flight, straight};
  const DragFit joint = fit_drag(both, conditions);
  CHECK(joint.find("crosswind_m_s", 0) != nullptr);
  CHECK(joint.find("crosswind_m_s", 1) == nullptr);
}

TEST_CASE("where a flight turns, the drag at its samples is that of the wind over ground") {
  const std::uint64_t seed = test::run_seed();
  CAPTURE(seed);
  const Truth truth;
  const WindOverGround wind;
  std::vector<LevelDrag> drags;
  const Observations flight = turning_observations(truth, wind, seed, 0, &drags);
  const DragFit fit = fit_one(flight);
  REQUIRE(fit.wind_heading[0].has_value());
  const std::vector<DragAtSample> samples = drag_at_samples(fit, {&flight, 1});
  REQUIRE(samples.size() == flight.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double along = wind.north * std::cos(flight.yaw[i]) + wind.east * std::sin(flight.yaw[i]);
    CHECK(samples[i].airspeed == Approx(flight.forward_speed[i] - along).margin(1e-5));
    CHECK(samples[i].fitted == Approx(conditions.mass * drags[i].forward).margin(1e-5));
    CHECK(samples[i].measured == Approx(conditions.mass * drags[i].forward).margin(1e-9));
  }

  // With noise alike on both axes each has the residuals of both; 3000 samples of it leave 1.3 %.
  const Observations shaken = turning_observations(truth, wind, seed, 0.2);
  const DragFit noisy = fit_one(shaken);
  CHECK(left_over(drag_at_samples(noisy, {&shaken, 1})) ==
        Approx(conditions.mass * noisy.quality.rmse).epsilon(0.05));
  CHECK(noisy.quality.rmse == Approx(0.2).epsilon(0.05));
}

TEST_CASE("steady drag balances thrust, and its band is that of the parameters") {
  const DragFit fit = fit_one(exact_observations({}, 11, 0.4));
  const AirframeDrag drag = fit.drag();
  for (double v : {0.5, 5.0, 12.0}) {
    const auto steady = steady_drag(fit, v);
    REQUIRE(steady);
    const double tilt = steady->tilt.value;
    const double force = 0.5 * 1.225 * v * (v + drag.linear_speed) *
                         (drag.front_area * std::cos(tilt) + drag.top_area * std::sin(tilt));
    CHECK(steady->force.value == Approx(force).epsilon(1e-12));
    CHECK(steady->force.value == Approx(1.6 * standard_gravity * std::tan(tilt)).epsilon(1e-12));
    CHECK(steady->force.lower < force);
    CHECK(steady->force.upper > force);
  }
  CHECK(steady_drag(fit, 0)->force.value == 0);
  CHECK_FALSE(steady_drag(fit, 200));
}

TEST_CASE("the entangled pair is named while the drag force is well determined") {
  const FlightLog log = test::simulate({});
  const DragFit fit = fit_log(log);
  const auto pairs = entangled_pairs(fit);
  REQUIRE(pairs.size() == 1);
  CHECK(pairs[0].first == 0);
  CHECK(pairs[0].second == 2);
  CHECK(pairs[0].correlation < -0.9);
  const Estimate& j = fit.linear_speed().estimate;
  const Estimate force = steady_drag(fit, 8)->force;
  CHECK(force.standard_error / force.value < 0.3 * j.standard_error / j.value);
}

TEST_CASE("data that cannot determine drag is refused with a reason") {
  const Observations good = exact_observations({}, 1, 0.1);
  Observations bad = good;
  for (double& v : bad.forward_speed) v = 8 + 0.1 * v;
  CHECK(says(message_of([&] { fit_one(bad); }), "must vary by at least 3 m/s"));

  bad = good;
  for (auto* series : {&bad.time, &bad.tilt, &bad.forward_speed, &bad.forward_acceleration,
                       &bad.expected_acceleration}) {
    series->resize(49);
  }
  CHECK(says(message_of([&] { fit_one(bad); }), "49 samples"));

  bad = good;
  for (double& tilt : bad.tilt) tilt = 0;  // nothing then depends on the top area
  CHECK(says(message_of([&] { fit_one(bad); }), "top_area_m2"));

  bad = good;  // as if pitch were positive nose-down: the drone seems pushed along its way
  for (std::size_t i = 0; i < bad.size(); ++i) {
    bad.forward_acceleration[i] = 2 * bad.expected_acceleration[i] - bad.forward_acceleration[i];
  }
  CHECK(says(message_of([&] { fit_one(bad); }), "shows no drag"));

  CHECK(says(message_of([&] { (void)fit_drag({}, conditions); }), "at least one flight"));
}

TEST_CASE("conditions and bounds outside their range are refused by name") {
  const Observations flight = exact_observations({}, 1, 0.1);
  CHECK(says(message_of([&] {
               (void)fit_drag({&flight, 1}, {0, 1.2, 9.8});
             }),
             "the mass in kg is 0"));
  CHECK(says(message_of([&] { (void)fit_drag({&flight, 1}, {1, -1, 9.8}); }), "the air density"));
  CHECK(says(message_of([&] { (void)fit_drag({&flight, 1}, {1, 1, std::nan("")}); }), "gravity"));
  DragFitOptions options;
  options.bounds.max_wind = std::numeric_limits<double>::infinity();
  CHECK(says(message_of([&] { fit_one(flight, options); }), "the largest wind"));
  options = {};
  options.start = DragParameters{0.01, 0.01, 10, {}};
  CHECK(says(message_of([&] { fit_one(flight, options); }), "winds to start from"));
}

TEST_CASE("density of dry air at tabulated states") {
  CHECK(dry_air_density(101325, 288.15) == Approx(1.2250).epsilon(2e-5));  // ISO 2533, sea level
  CHECK(dry_air_density(101325, 273.15) == Approx(1.2922).epsilon(1e-4));
  CHECK(dry_air_density(54048, 255.68) == Approx(0.73643).epsilon(1e-4));  // ISO 2533, 5000 m
  CHECK_THROWS_AS(dry_air_density(0, 288.15), std::invalid_argument);
  CHECK_THROWS_AS(dry_air_density(101325, -3), std::invalid_argument);
}
