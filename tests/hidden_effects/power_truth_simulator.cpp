#include "hidden_effects/power_truth_simulator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "support/linked_cable.hpp"

namespace power_truth {
namespace {

// Holybro AIR2216 920 KV, 10 inch, 16 V: gram-force and g/W of the data sheet.
constexpr std::array<std::array<double, 2>, 15> motor_table{{{210, 9.12},
                                                             {259, 8.67},
                                                             {309, 8.45},
                                                             {373, 8.15},
                                                             {447, 7.76},
                                                             {536, 7.39},
                                                             {628, 7.01},
                                                             {729, 6.73},
                                                             {814, 6.44},
                                                             {906, 6.18},
                                                             {993, 5.88},
                                                             {1087, 5.65},
                                                             {1191, 5.43},
                                                             {1289, 5.18},
                                                             {1332, 5.13}}};

double motor_watts(double grams) {
  double last_g = 0;
  double last_w = 0;
  for (const auto& [g, g_per_watt] : motor_table) {
    const double w = g / g_per_watt;
    if (grams <= g) return last_w + (w - last_w) * (grams - last_g) / (g - last_g);
    last_g = g;
    last_w = w;
  }
  return last_w + 0.25 * (grams - last_g);
}

constexpr double pi = 3.14159265358979323846;
constexpr double gravity = 9.80665;
constexpr double wall = 0.75e-3;
constexpr double temperature_coefficient = 0.00403;

double outer_radius(const Rig& rig) { return std::sqrt(rig.area / pi) + wall; }
double ohm_per_metre_20C(const Rig& rig) { return 2 * 0.0278e-6 / rig.area; }
double kg_per_metre(const Rig& rig) {
  const double outer_area = pi * outer_radius(rig) * outer_radius(rig);
  return 2 * (2700 * rig.area + 1360 * (outer_area - rig.area));
}

/// W at the bus for a thrust in N, leaning by `angle`, without the random deviation.
double motor_power_at(const Rig& rig, const HiddenEffects& hidden, double thrust, double speed,
                      double angle) {
  const double thrust_g = thrust / 4 / gravity * 1000;
  // Glauert's momentum theory: v_i·√((v cosα)² + (v sinα + v_i)²) = v_h².
  const double through = speed * std::sin(angle);
  double induced = hidden.induced_speed;
  for (int i = 0; i < 200; ++i) {
    const double next = hidden.induced_speed * hidden.induced_speed /
                        std::hypot(speed * std::cos(angle), through + induced);
    induced = 0.5 * (induced + next);
  }
  const double relief =
      1 - hidden.translational_lift * (1 - (induced + through) / hidden.induced_speed);
  // Rankine and Froude: induced power goes with the inverse root of the density.
  return 4 * rig.motor_size * motor_watts(thrust_g / rig.motor_size) * hidden.motor_power_factor *
         relief / std::sqrt(hidden.air_density_factor);
}

using tethercalc::test::CablePull;
using tethercalc::test::LinkedCable;

/// What the cable does to the drone in flight.
class FlownCable {
 public:
  FlownCable(const Rig& rig, const HiddenEffects& hidden)
      : rig_(rig),
        slack_(rig.slack + hidden.slack),
        winch_pull_(rig.winch_pull + hidden.winch_pull),
        weight_(kg_per_metre(rig) * gravity),
        drag_(0.5 * rig.air_density * hidden.air_density_factor * hidden.tether_drag_factor * 0.75 *
              4 * outer_radius(rig)),
        hanging_(weight_, drag_) {}

  CablePull at(double height, double speed) {
    const double length = height * (1 + slack_);
    if (rig_.cable == Rig::Cable::slack) return hanging_.of_length(height, speed, length);
    if (rig_.cable == Rig::Cable::winch) return hanging_.of_tension(height, speed, winch_pull_);
    return {drag_ * length * speed * speed, weight_ * length + winch_pull_, length};
  }

 private:
  const Rig& rig_;
  double slack_;
  double winch_pull_;
  double weight_;  ///< N/m
  double drag_;    ///< kg/m²
  LinkedCable hanging_;
};

/// W at the bus for steady flight, without the random deviation.
double motor_power(const Rig& rig, const HiddenEffects& hidden, const CablePull& cable,
                   double speed, double dropped) {
  const double density = rig.air_density * hidden.air_density_factor;
  const double weight = (rig.mass + hidden.extra_mass - dropped) * gravity + cable.down;
  double angle = 0;
  for (int i = 0; i < 60; ++i) {  // contraction: drag changes little with the angle
    const double area = rig.drag_scale * hidden.airframe_drag_factor *
                        (0.01451 * std::cos(angle) + 0.01361 * std::sin(angle));
    const double drag = 0.5 * density * area * (speed * speed + 19.27 * speed);
    angle = std::atan((drag + cable.along) / weight);
  }
  return motor_power_at(rig, hidden, weight / std::cos(angle), speed, angle);
}

double rounded(double value, double step) { return std::round(value / step) * step; }

/// Readings of a channel stamped `offset` late, linear between samples.
std::vector<double> stamped_late(const std::vector<double>& x, double offset, double interval) {
  if (offset == 0) return x;
  std::vector<double> out(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double at = std::clamp(static_cast<double>(i) - offset / interval, 0.0,
                                 static_cast<double>(x.size() - 1));
    const auto k = std::min(static_cast<std::size_t>(at), x.size() - 2);
    const double f = at - static_cast<double>(k);
    out[i] = x[k] + f * (x[k + 1] - x[k]);
  }
  return out;
}

}  // namespace

Cable cable_at(const Rig& rig, double height) {
  return {kg_per_metre(rig) * height, 0.75 * 4 * height * outer_radius(rig)};
}

Log simulate(const Scenario& scenario) {
  const HiddenEffects& hidden = scenario.hidden;
  const Rig& rig = scenario.rig;
  std::mt19937_64 engine(scenario.seed * 0x9E3779B97F4A7C15ULL + 17);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const auto pick = [&](int n) { return static_cast<int>(uniform(engine) * n); };

  const double dt = scenario.sample_interval;
  const double duration = scenario.duration > 0 ? scenario.duration : 1480 + 140 * uniform(engine);
  const bool tracked = !scenario.track.airspeed.empty();
  const auto n = tracked ? scenario.track.airspeed.size() : static_cast<std::size_t>(duration / dt);
  const double ambient = (scenario.ambient_temperature != 0 ? scenario.ambient_temperature
                                                            : 17 + 5 * uniform(engine)) -
                         hidden.colder_air;

  // The six plateaus in random order, each held equally long; a new airspeed every 40 s or so.
  std::array<double, 6> plateau{};
  for (std::size_t k = 0; k < 6; ++k) plateau[k] = static_cast<double>(k + 1) / 6 * rig.length;
  std::shuffle(plateau.begin(), plateau.end(), engine);
  if (scenario.profile == Profile::one_height) plateau.fill(rig.length / 2);
  constexpr std::array<double, 4> speeds{0, 3, 6, 9};

  Log log;
  std::vector<double> height(n), speed(n), supply_current(n), drone_voltage(n), bus_power(n);
  double h = scenario.profile == Profile::one_height ? rig.length / 2 : 1;
  double v = 0;
  double steady_speed = 0;
  double gust = 0;
  double target_speed = 0;
  double next_change = 0;
  double deviation = scenario.deviation * normal(engine);
  double rise = 0;
  FlownCable flown(rig, hidden);
  const double memory = std::pow(0.79, dt);
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) * dt;
    const double share = t / duration;
    const double goal = plateau[std::min<std::size_t>(5, static_cast<std::size_t>(6 * share))];
    const double higher = std::clamp(goal - h, -0.8 * dt, 0.8 * dt);
    h += higher;
    if (t >= next_change) {
      target_speed = speeds[static_cast<std::size_t>(pick(4))];
      next_change = t + 25 + 30 * uniform(engine);
    }
    steady_speed += (target_speed - steady_speed) * (1 - std::exp(-dt / 4));
    const double gust_memory = std::pow(0.85, dt);
    gust = gust_memory * gust + 0.3 * std::sqrt(1 - gust_memory * gust_memory) * normal(engine);
    v = std::max(0.0, steady_speed + gust * std::min(1.0, steady_speed / 3));
    deviation =
        memory * deviation + scenario.deviation * std::sqrt(1 - memory * memory) * normal(engine);

    const double dropped = share >= hidden.step_at ? hidden.payload_drop : 0;
    if (tracked) {
      h = scenario.track.height[i];
      v = scenario.track.airspeed[i];
    }
    const CablePull pull = flown.at(h, v);
    double power =
        (tracked ? motor_power_at(rig, hidden, scenario.track.thrust[i], v, scenario.track.tilt[i])
                 : motor_power(rig, hidden, pull, v, dropped)) *
        (1 + deviation);
    if (share >= hidden.step_at) power *= 1 + hidden.step_in_motor_power;
    power *= 1 + hidden.motor_power_per_height * (h / rig.length) * (h / rig.length);
    power *= 1 + hidden.motor_power_growth * share;
    power *= 1 + hidden.motor_power_swing * std::sin(2 * pi * t / 600);
    power += hidden.climb_work * ((rig.mass + hidden.extra_mass - dropped) * gravity + pull.down) *
             higher / dt;

    const double converter_input =
        hidden.converter_fixed_loss > 0
            ? power + hidden.converter_fixed_loss + hidden.converter_square_loss * power * power
            : power / rig.efficiency;
    const double input = converter_input + rig.auxiliaries + hidden.auxiliary_power;

    const double cable =
        hidden.spooled_length >= 0 ? rig.length + hidden.spooled_length : pull.length;
    const double temperature =
        hidden.heating > 0 ? ambient + rise : 20 + hidden.air_share * (ambient - 20);
    const double ohm_per_metre = ohm_per_metre_20C(rig) * hidden.resistivity_factor *
                                 (1 + temperature_coefficient * (temperature - 20));
    double resistance = ohm_per_metre * cable + hidden.contact_resistance;
    if (share >= hidden.step_at) resistance += hidden.step_in_resistance;
    const double current =
        (rig.voltage - std::sqrt(rig.voltage * rig.voltage - 4 * resistance * input)) /
        (2 * resistance);
    const double settled = hidden.heating * current * current * ohm_per_metre_20C(rig) /
                           (1 + hidden.heating_wind_cooling * std::sqrt(v));
    rise += (settled - rise) * (1 - std::exp(-dt / hidden.heating_time_constant));

    height[i] = h;
    speed[i] = v;
    supply_current[i] = current;
    drone_voltage[i] = rig.voltage - current * resistance;
    bus_power[i] = power;
  }

  height = stamped_late(height, scenario.flight_clock_offset, dt);
  speed = stamped_late(speed, scenario.flight_clock_offset, dt);
  bus_power = stamped_late(bus_power, scenario.bus_clock_offset, dt);
  for (std::size_t i = 0; i < n; ++i) {
    const auto noise = [&](double standard_deviation) {
      return scenario.instrument_noise * standard_deviation * normal(engine);
    };
    const double bus_voltage = 16 - 0.004 * bus_power[i] / 16;
    log.time.push_back(static_cast<double>(i + 1) * dt);
    log.height.push_back(rounded(height[i] + hidden.height_bias + noise(0.05), 0.01));
    log.airspeed.push_back(
        rounded(std::max(0.0, hidden.airspeed_gain * speed[i] + noise(0.15)), 0.01));
    log.ambient_temperature.push_back(rounded(ambient + noise(0.1), 0.1));
    log.supply_voltage.push_back(
        rounded(hidden.supply_voltage_gain * rig.voltage + noise(0.035), 0.01));
    log.supply_current.push_back(rounded(hidden.supply_current_gain * supply_current[i] +
                                             hidden.supply_current_offset + noise(0.015),
                                         0.001));
    log.drone_voltage.push_back(
        rounded(drone_voltage[i] + hidden.drone_voltage_offset + noise(0.025), 0.01));
    log.bus_voltage.push_back(rounded(bus_voltage + noise(0.01), 0.001));
    log.bus_current.push_back(
        rounded(hidden.bus_current_gain * bus_power[i] / bus_voltage + noise(0.06), 0.01));
  }

  const std::array<std::pair<const char*, std::vector<double>*>, 8> channels{{
      {"height_m", &log.height},
      {"airspeed_m_s", &log.airspeed},
      {"ambient_temperature_C", &log.ambient_temperature},
      {"supply_voltage_V", &log.supply_voltage},
      {"supply_current_A", &log.supply_current},
      {"drone_voltage_V", &log.drone_voltage},
      {"bus_voltage_V", &log.bus_voltage},
      {"bus_current_A", &log.bus_current},
  }};
  for (const auto& [name, values] : channels) {
    std::vector<double>& x = *values;
    const auto [low, high] = std::minmax_element(x.begin(), x.end());
    const double spread = *high - *low;
    for (double& value : x) {
      if (uniform(engine) < scenario.outlier_share) {
        value = std::max(
            0.0, value + (uniform(engine) < 0.5 ? -1 : 1) * (0.5 + 2 * uniform(engine)) * spread);
      }
    }
    if (scenario.stuck_channel == name) {
      std::fill(x.begin() + static_cast<std::ptrdiff_t>(n / 3),
                x.begin() + static_cast<std::ptrdiff_t>(2 * n / 3), x[n / 3]);
    }
  }
  return log;
}

}  // namespace power_truth
