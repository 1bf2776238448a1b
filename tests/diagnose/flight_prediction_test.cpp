#include "diagnose/flight_prediction.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "support/random.hpp"
#include "tethercalc/model/units.hpp"

using namespace tethercalc;

namespace {

FlightRecord swinging_flight() {
  Observations o;
  for (int i = 0; i < 400; ++i) {
    const double t = 0.1 * i;
    o.time.push_back(t);
    o.tilt.push_back(0.4 * std::sin(0.7 * t));
    o.roll.push_back(0.05 * std::cos(t));
    o.yaw.push_back(0.02 * t);
    o.forward_speed.push_back(8 * std::sin(0.5 * t + 0.3));
    o.right_speed.push_back(0);
    o.down_speed.push_back(0.3 * std::sin(0.3 * t));
    o.forward_acceleration.push_back(0);
    o.down_acceleration.push_back(0.09 * std::cos(0.3 * t));
    o.expected_acceleration.push_back(0);
  }
  return flight_record(o, 1.6, 1.25, standard_gravity);
}

constexpr FlightBase base{.front_area = 0.015, .top_area = 0.012, .vertical_acceleration_gain = 1};

std::vector<double> predicted(const FlightRecord& record, const Effect* effect,
                              const std::vector<double>& values) {
  FlightPrediction prediction(record);
  const EffectValues one{effect, values};
  predict_acceleration(prediction, base, {&one, effect == nullptr ? 0U : 1U});
  return prediction.acceleration;
}

/// The prediction written out for one sample, from the formulas of the paper.
double by_hand(const FlightRecord& r, std::size_t i, double wind, double linear) {
  const double theta = r.tilt[i];
  const double u = r.forward_speed[i] - wind;
  const double area = 0.015 * std::cos(theta) + 0.012 * std::abs(std::sin(theta));
  const double force = 0.5 * 1.25 * area * (u * std::abs(u) + linear * u);
  return (standard_gravity - r.down_acceleration[i]) * std::tan(theta) - force / 1.6;
}

}  // namespace

TEST_CASE("every effect of the list of the design stands in the catalogue once") {
  std::set<std::string> ids;
  for (const Effect& effect : effect_catalogue()) CHECK(ids.insert(effect.id).second);
  for (const char* id :
       {"linear_drag", "wind", "turning_wind", "wind_drift", "propwash", "pitch_trim",
        "fore_aft_asymmetry", "vertical_coupling", "attitude_delay"}) {
    CHECK(find_effect(id) != nullptr);
  }
  CHECK(find_effect("gravity_waves") == nullptr);
}

TEST_CASE("every entry of the catalogue is complete") {
  for (const Effect& effect : effect_catalogue()) {
    INFO(effect.id);
    CHECK_FALSE(effect.title.empty());
    CHECK(effect.mechanism.ends_with("."));
    CHECK_FALSE(effect.change.empty());
    CHECK_FALSE(effect.to_separate.empty());
    CHECK_FALSE(effect.parameters.empty());
    for (const EffectParameter& p : effect.parameters) {
      // What begins with a leap begins next to neutral.
      CHECK(p.lower <= p.neutral + 1e-3 * p.scale);
      CHECK(p.neutral <= p.upper);
      CHECK((p.lower < p.upper || p.look_through == LookThrough::moments));
      CHECK(p.scale > 0);
      CHECK_FALSE(p.unit.empty());
    }
    if (!effect.replaces.empty()) CHECK(find_effect(effect.replaces) != nullptr);
  }
}

TEST_CASE("an effect at its neutral values changes no prediction, beyond it every effect does") {
  const FlightRecord record = swinging_flight();
  const std::vector<double> plain = predicted(record, nullptr, {});
  for (const Effect& effect : effect_catalogue()) {
    if (effect.log != LogKind::flight) continue;
    INFO(effect.id);
    std::vector<double> values;
    for (const EffectParameter& p : effect.parameters) values.push_back(p.neutral * p.unit_SI);
    CHECK(predicted(record, &effect, values) == plain);
    values[0] += effect.parameters[0].scale * effect.parameters[0].unit_SI;
    CHECK(predicted(record, &effect, values) != plain);
  }
}

TEST_CASE("the acceleration follows the published force balance") {
  const FlightRecord record = swinging_flight();
  const std::vector<double> plain = predicted(record, nullptr, {});
  const std::vector<double> windy = predicted(record, find_effect("wind"), {-1.2, 0});
  const std::vector<double> linear = predicted(record, find_effect("linear_drag"), {19.0});
  for (std::size_t i = 0; i < record.size(); i += 13) {
    CHECK(plain[i] == Approx(by_hand(record, i, 0, 0)).epsilon(1e-12));
    CHECK(windy[i] == Approx(by_hand(record, i, -1.2, 0)).epsilon(1e-12));
    CHECK(linear[i] == Approx(by_hand(record, i, 0, 19)).epsilon(1e-12));
  }
}

TEST_CASE("a speed simulated forward follows the nose as it turns into what flies to the side") {
  Observations o;
  constexpr double rate = 0.3;
  constexpr double speed = 2;
  for (int i = 0; i < 50; ++i) {
    const double angle = rate * 0.1 * i;
    o.time.push_back(0.1 * i);
    o.yaw.push_back(angle);
    // It goes on straight, without any drag.
    o.forward_speed.push_back(-speed * std::cos(angle + 1));
    o.right_speed.push_back(speed * std::sin(angle + 1));
    for (auto* series : {&o.tilt, &o.roll, &o.down_speed, &o.forward_acceleration,
                         &o.down_acceleration, &o.expected_acceleration}) {
      series->push_back(0);
    }
  }
  const FlightRecord record = flight_record(o, 1.6, 1.25, standard_gravity);
  const std::vector<double> simulated = simulate_speed(record, {}, {}, 4, 1);
  // Trapezoids of 0.1 s and a rate that is unknown at the first sample, 0.03 rad long.
  for (std::size_t i = 0; i < record.size(); ++i) {
    CHECK(simulated[i] == Approx(o.forward_speed[i]).margin(0.04));
  }
}

TEST_CASE("what happens ahead happens to the side alike") {
  FlightRecord ahead = swinging_flight();
  ahead.both_axes = true;
  ahead.sideward_thrust.assign(ahead.size(), 0.0);
  ahead.cos_sideward.assign(ahead.size(), 1.0);
  FlightRecord aside = ahead;
  std::swap(aside.forward_speed, aside.right_speed);
  std::swap(aside.tan_tilt, aside.sideward_thrust);
  std::swap(aside.cos_tilt, aside.cos_sideward);
  aside.tilt.assign(aside.size(), 0.0);
  for (double& x : aside.right_of_heading) x = -x;  // as in a mirror
  FlightBase alike = base;
  alike.side_area = alike.front_area;
  const auto both = [&](const char* id, const std::vector<double>& values_ahead,
                        const std::vector<double>& values_aside) {
    INFO(id);
    const Effect* effect = find_effect(id);
    REQUIRE(effect != nullptr);
    const EffectValues in_front{effect, values_ahead};
    const EffectValues at_side{effect, values_aside};
    FlightPrediction one(ahead);
    FlightPrediction other(aside);
    predict_acceleration(one, alike, {&in_front, 1});
    predict_acceleration(other, alike, {&at_side, 1});
    for (std::size_t i = 0; i < ahead.size(); i += 7) {
      CHECK(other.side_acceleration[i] == Approx(one.acceleration[i]).margin(1e-4));
      CHECK(other.acceleration[i] == Approx(one.side_acceleration[i]).margin(1e-4));
    }
  };
  // A delay is taken of the tilt here and of its tangent there: 1e-4 m/s² apart at most.
  both("attitude_delay", {0.08}, {0.08});
  both("linear_drag", {19}, {19});
  both("wind", {-1.2, 0}, {0, -1.2});
  both("wind_shear", {0.1, 0}, {0, 0.1});
  both("propwash", {0.4}, {0.4});
  both("vertical_coupling", {0.1}, {0.1});
  both("velocity_lag", {0.2}, {0.2});
  both("velocity_scale", {1.2}, {1.2});
  both("mass_drop", {0.3, 20}, {0.3, 20});
  both("slung_load", {0.2, 3, 0.05}, {0.2, 3, 0.05});
}

TEST_CASE("a load on a rope swings as a pendulum whose pivot gives way") {
  // Level, then leaning by a constant angle, without drag: from the closed form of two bodies, one
  // thrust that carries both, and a spring of m_l·g/l between them.
  constexpr double share = 0.25;
  constexpr double rope = 2;
  constexpr double damping = 0.1;
  Observations o;
  for (int i = 0; i < 200; ++i) {
    o.time.push_back(0.05 * i);
    o.tilt.push_back(i < 40 ? 0 : 0.2);
    for (auto* series : {&o.forward_speed, &o.roll, &o.yaw, &o.right_speed, &o.down_speed,
                         &o.forward_acceleration, &o.down_acceleration, &o.expected_acceleration}) {
      series->push_back(0);
    }
  }
  const FlightRecord record = flight_record(o, 1.6, 1.25, standard_gravity);
  const std::vector<double> swinging =
      predicted(record, find_effect("slung_load"), {share, rope, damping});
  const double own = standard_gravity / rope;
  const double fading = damping * std::sqrt(own);
  const double turning = std::sqrt(own * (1 + share) - fading * fading);
  const double thrust = standard_gravity * std::tan(0.2);  // of both masses together
  // The lean changes evenly from one sample to the next: as if at once half a step before.
  const double begin = o.time[39] + 0.025;
  for (std::size_t i = 41; i < record.size(); ++i) {
    const double t = o.time[i] - begin;
    const double ringing =
        std::exp(-fading * t) * (std::cos(turning * t) + fading / turning * std::sin(turning * t));
    // At once the drone alone takes off with all of the thrust, in the end both do.
    CHECK(swinging[i] == Approx(thrust * (1 + share * ringing)).margin(2e-3 * thrust));
  }
  for (std::size_t i = 0; i < 40; ++i) CHECK(swinging[i] == 0);
}

TEST_CASE("propwash acts only while speed and tilt oppose each other") {
  const FlightRecord record = swinging_flight();
  const std::vector<double> plain = predicted(record, nullptr, {});
  const std::vector<double> washed = predicted(record, find_effect("propwash"), {0.5});
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double u = record.forward_speed[i];
    const double theta = record.tilt[i];
    const double less_drag = u * theta < 0 ? 0.5 * u * std::abs(theta) / 1.6 : 0;
    CHECK(washed[i] - plain[i] == Approx(less_drag).margin(1e-12));
  }
}

TEST_CASE("an attitude delay shifts a smooth tilt back to where it was") {
  const FlightRecord record = swinging_flight();
  FlightPrediction prediction(record);
  const std::vector<double> delay{0.13};
  const EffectValues effect{find_effect("attitude_delay"), delay};
  predict_acceleration(prediction, base, {&effect, 1});
  for (std::size_t i = 3; i + 5 < record.size(); ++i) {
    // Lagrange's cubic at 0.1 s steps errs by h⁴·f⁗/24·(9/16) ≤ 2.3e-7 here.
    const double wanted = 0.4 * std::sin(0.7 * (record.time[i] + 0.13));
    CHECK(prediction.thrust.tilt[i] == Approx(wanted).margin(3e-7));
  }
}

TEST_CASE("a prediction made anew with other values is what one from the start is") {
  FlightRecord record = swinging_flight();
  for (std::size_t i = 0; i < record.size(); ++i) {
    record.headwind[i] = 2 + std::sin(0.2 * record.time[i]);
    record.crosswind[i] = 1;
  }
  const std::span<const Effect> catalogue = effect_catalogue(LogKind::flight);
  test::each_random(5, [&](test::Random& random) {
    record.both_axes = random.chance(0.5);
    FlightPrediction anew(record);
    std::vector<double> sizes(catalogue.size(), 0.0);
    FlightBase drawn = base;
    for (int change = 0; change < 100; ++change) {
      // One number changes at a time, as where derivatives are taken, or goes back to what it was.
      const auto which =
          static_cast<std::size_t>(random.integer(0, static_cast<int>(catalogue.size()) + 3));
      const double size = random.chance(0.5) ? 0 : random.uniform(0.1, 1);
      if (which < catalogue.size()) sizes[which] = size;
      if (which == catalogue.size()) drawn.front_area = base.front_area * (1 + size);
      if (which == catalogue.size() + 1) drawn.roll_trim = 0.1 * size;
      if (which == catalogue.size() + 2) drawn.wind_gain = size;
      if (which == catalogue.size() + 3) drawn.vertical_acceleration_gain = 1 - size;
      std::vector<std::vector<double>> values(catalogue.size());
      std::vector<EffectValues> effects;
      for (std::size_t k = 0; k < catalogue.size(); ++k) {
        if (sizes[k] == 0) continue;
        for (const EffectParameter& p : catalogue[k].parameters) {
          values[k].push_back(std::min(p.neutral + sizes[k] * p.scale, p.upper));
        }
        effects.push_back({&catalogue[k], values[k]});
      }
      predict_acceleration(anew, drawn, effects);
      FlightPrediction fresh(record);
      predict_acceleration(fresh, drawn, effects);
      REQUIRE(anew.acceleration == fresh.acceleration);
      REQUIRE(anew.side_acceleration == fresh.side_acceleration);
      REQUIRE(anew.airspeed == fresh.airspeed);
    }
  });
}

TEST_CASE("a flight that obeys the model is simulated back onto its own speed") {
  // Constant tilt: speed rises to where drag balances; integrate finely, log at 10 Hz.
  Observations o;
  const double tilt = 0.3;
  double v = 0;
  for (int k = 0; k < 60000; ++k) {
    if (k % 1000 == 0) {
      o.time.push_back(k * 1e-4);
      o.tilt.push_back(tilt);
      for (auto* zero : {&o.roll, &o.yaw, &o.right_speed, &o.down_speed, &o.forward_acceleration,
                         &o.down_acceleration, &o.expected_acceleration}) {
        zero->push_back(0);
      }
      o.forward_speed.push_back(v);
    }
    const double area = 0.015 * std::cos(tilt) + 0.012 * std::sin(tilt);
    v += 1e-4 * (standard_gravity * std::tan(tilt) - 0.5 * 1.25 * area * v * v / 1.6);
  }
  const FlightRecord record = flight_record(o, 1.6, 1.25, standard_gravity);
  const std::vector<double> simulated = simulate_speed(record, base, {}, 100, 1);
  for (std::size_t i = 0; i < record.size(); ++i) {
    // Trapezoids at 0.1 s and Euler at 1e-4 s both err by less than a few mm/s in 6 s.
    CHECK(simulated[i] == Approx(record.forward_speed[i]).margin(5e-3));
  }
  const std::vector<double> restarted = simulate_speed(record, base, {}, 2, 1);
  CHECK(restarted[20] == record.forward_speed[20]);
}

TEST_CASE("height and place go on from where a stretch led that is left out") {
  Observations o;
  // North at 4 m/s and climbing at 1 m/s, with 30 s left out in which it climbs by 50 m and comes
  // back by 20 m to the south.
  for (int i = 0; i < 100; ++i) {
    o.time.push_back(0.1 * i + (i < 50 ? 0 : 30));
    o.forward_speed.push_back(4);
    o.down_speed.push_back(-1);
    for (auto* series : {&o.tilt, &o.roll, &o.yaw, &o.right_speed, &o.forward_acceleration,
                         &o.down_acceleration, &o.expected_acceleration}) {
      series->push_back(0);
    }
  }
  const Detour detour{o.time[49], o.time[50], -20, 0, 50};
  const FlightRecord record = flight_record(o, 1.6, 1.25, standard_gravity, {&detour, 1});
  CHECK(record.height[49] == Approx(4.9));
  CHECK(record.height[50] == Approx(54.9));
  CHECK(record.height[99] == Approx(59.8));
  CHECK(record.place_along[50] - record.place_along[49] == Approx(-20));
  CHECK(record.place_along[99] - record.place_along[50] == Approx(4 * 4.9));
}
