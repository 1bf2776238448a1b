#include "identify/flight_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "identify/statistics.hpp"

namespace tethercalc {
namespace {

/// Of nine tenths of the values.
double spread(const std::vector<double>& values) {
  return values.empty() ? 0 : quantile(values, 0.95) - quantile(values, 0.05);
}

std::size_t samples_a_second(const Observations& flight) {
  return static_cast<std::size_t>(std::max(1.0, std::round(1 / median_step(flight.time))));
}

}  // namespace

std::vector<double> yaw_rate(const Observations& flight) {
  std::vector<double> rate(flight.size(), 0.0);
  for (std::size_t i = 1; i + 1 < flight.size(); ++i) {
    rate[i] = (flight.yaw[i + 1] - flight.yaw[i - 1]) / (flight.time[i + 1] - flight.time[i - 1]);
  }
  return rate;
}

std::optional<Leaning> leaning_over_a_second(const Observations& flight, double gravity,
                                             Axis axis) {
  if (flight.size() < 3) return std::nullopt;
  const std::size_t lag = samples_a_second(flight);
  if (flight.size() < 10 * lag) return std::nullopt;
  const std::vector<double> turning = yaw_rate(flight);
  const bool forward = axis == Axis::forward;
  if (!forward && flight.right_acceleration.size() != flight.size()) return std::nullopt;
  const auto by_force = [&](std::size_t i) {
    return forward ? flight.forward_acceleration[i] - turning[i] * flight.right_speed[i]
                   : flight.right_acceleration[i] + turning[i] * flight.forward_speed[i];
  };
  const auto by_leaning = [&](std::size_t i) {
    return gravity * (forward ? std::tan(flight.tilt[i])
                              : std::tan(flight.roll[i]) / std::cos(flight.tilt[i]));
  };
  double both = 0, leaning = 0, measured = 0;
  for (std::size_t i = lag; i < flight.size(); ++i) {
    const double expected = by_leaning(i) - by_leaning(i - lag);
    const double seen = by_force(i) - by_force(i - lag);
    both += expected * seen;
    leaning += expected * expected;
    measured += seen * seen;
  }
  if (!(leaning > 0 && measured > 0)) return std::nullopt;
  return Leaning{both / std::sqrt(leaning * measured), both / leaning,
                 std::sqrt(leaning / measured)};
}

namespace {

/// A way in which the columns of a log may mean something else than they should.
struct AxesMistake {
  const char* words;
  bool velocities_exchanged = false;  ///< north is east and east is north
  double yaw_sign = 1;
  double yaw_offset = 0;  ///< rad
  double pitch_sign = 1;
};

constexpr double quarter_turn = std::numbers::pi / 2;
constexpr std::array axes_mistakes{
    AxesMistake{.words = "the north and east velocities were exchanged",
                .velocities_exchanged = true},
    AxesMistake{.words = "the yaw were counted the other way round", .yaw_sign = -1},
    AxesMistake{.words = "the yaw were counted from east, counterclockwise",
                .yaw_sign = -1,
                .yaw_offset = quarter_turn},
    AxesMistake{.words = "the yaw were a quarter turn more", .yaw_offset = quarter_turn},
    AxesMistake{.words = "the yaw were a quarter turn less", .yaw_offset = -quarter_turn},
    AxesMistake{.words = "the yaw were half a turn off", .yaw_offset = 2 * quarter_turn},
    AxesMistake{.words = "the pitch were positive nose-up", .pitch_sign = -1},
};

/// What the pitch and, where it moves, the roll make expect over the heading's axes, and what is
/// seen there, were the log's columns mistaken so.
double leaning_correlation(const Observations& flight, const AxesMistake& mistake) {
  const std::vector<double> turning = yaw_rate(flight);
  const std::size_t lag = samples_a_second(flight);
  const bool rolls = spread(flight.roll) > 0;
  struct Level {
    double ahead = 0;
    double aside = 0;
  };
  const auto seen = [&](std::size_t i) -> Level {
    const double forward = flight.forward_acceleration[i] - turning[i] * flight.right_speed[i];
    const double right = flight.right_acceleration[i] + turning[i] * flight.forward_speed[i];
    const double cosine = std::cos(flight.yaw[i]);
    const double sine = std::sin(flight.yaw[i]);
    double north = forward * cosine - right * sine;
    double east = forward * sine + right * cosine;
    if (mistake.velocities_exchanged) std::swap(north, east);
    const double meant = mistake.yaw_sign * flight.yaw[i] + mistake.yaw_offset;
    return {north * std::cos(meant) + east * std::sin(meant),
            east * std::cos(meant) - north * std::sin(meant)};
  };
  const auto expected = [&](std::size_t i) -> Level {
    return {mistake.pitch_sign * std::tan(flight.tilt[i]),
            rolls ? std::tan(flight.roll[i]) / std::cos(flight.tilt[i]) : 0};
  };
  double both = 0, leaning = 0, measured = 0;
  for (std::size_t i = lag; i < flight.size(); ++i) {
    const Level e1 = expected(i), e0 = expected(i - lag);
    const Level s1 = seen(i), s0 = seen(i - lag);
    const double ahead = s1.ahead - s0.ahead;
    const double aside = rolls ? s1.aside - s0.aside : 0;
    const double by_pitch = e1.ahead - e0.ahead;
    const double by_roll = e1.aside - e0.aside;
    both += by_pitch * ahead + by_roll * aside;
    leaning += by_pitch * by_pitch + by_roll * by_roll;
    measured += ahead * ahead + aside * aside;
  }
  return leaning > 0 && measured > 0 ? both / std::sqrt(leaning * measured) : 0;
}

void check_axes(const Observations& flight) {
  if (flight.right_acceleration.size() != flight.size()) return;
  constexpr double clear = 0.7;
  constexpr double alike = 0.02;
  if (leaning_correlation(flight, {.words = ""}) > leans_to_speed_up) return;
  std::vector<std::pair<double, const char*>> found;
  for (const AxesMistake& mistake : axes_mistakes) {
    found.emplace_back(leaning_correlation(flight, mistake), mistake.words);
  }
  const double best = std::ranges::max(found).first;
  if (best < clear) return;
  std::vector<const char*> words;
  for (const auto& [correlation, said] : found) {
    if (correlation > best - alike) words.push_back(said);
  }
  throw UnsuitableFlight(
      fmt::format("the drone does not speed up where it leans to; it would if {} (correlation "
                  "{:.2f}, flights have 0.8 to 0.95)",
                  fmt::join(words, ", or "), best));
}

/// Drag has to be leaned against, whichever way the wind blows, while wings carry a nose held up.
void check_leans_into_its_speed(const Observations& flight, double gravity) {
  constexpr double fast = 8;          // m/s
  constexpr double long_enough = 20;  // s
  constexpr double nose_up = 0.35;    // m/s², 2°: beyond what the attitude's own errors do
  constexpr int sides = 4;
  std::array<double, sides> sum{};
  std::array<std::size_t, sides> count{};
  for (std::size_t i = 0; i < flight.size(); ++i) {
    if (flight.forward_speed[i] < fast) continue;
    const double turn = flight.yaw[i] / (2 * std::numbers::pi);
    const auto side = static_cast<std::size_t>((turn - std::floor(turn)) * sides) % sides;
    sum[side] += gravity * std::tan(flight.tilt[i]) - flight.forward_acceleration[i];
    ++count[side];
  }
  // With the wind in the back less than nothing may be left of the drag; on both sides of it never.
  const double needed = long_enough / median_step(flight.time) / sides;
  for (std::size_t side = 0; side < sides / 2; ++side) {
    const std::size_t back = side + sides / 2;
    if (static_cast<double>(std::min(count[side], count[back])) < needed) continue;
    const double there = sum[side] / static_cast<double>(count[side]);
    const double and_back = sum[back] / static_cast<double>(count[back]);
    if ((there + and_back) / 2 > -nose_up) continue;
    throw UnsuitableFlight(
        fmt::format("it keeps flying faster than {} m/s with its nose up, there and back, as no "
                    "multirotor can: did wings carry it?",
                    fast));
  }
}

}  // namespace

double mean_heading(const Observations& flight) {
  double north = 0;
  double east = 0;
  for (const double yaw : flight.yaw) {
    north += std::cos(yaw);
    east += std::sin(yaw);
  }
  return std::atan2(east, north);
}

bool turns(const Observations& flight) {
  constexpr double apart = 0.35;  // rad: a third of a force across the one is along the other
  return spread(flight.yaw) > apart;
}

bool shows_both_axes(const Observations& flight, double gravity) {
  // m/s: as of the forward speed, below which a fit takes drag and wind for each other.
  constexpr double flown_to_the_side = 3;
  const std::optional<Leaning> aside = leaning_over_a_second(flight, gravity, Axis::right);
  return aside && aside->correlation > leans_to_speed_up &&
         (turns(flight) || spread(flight.right_speed) > flown_to_the_side);
}

void check_flight_units(const Observations& flight, double gravity) {
  const auto stuck = [&flight](double tilt) { return tilt == flight.tilt.front(); };
  if (std::all_of(flight.tilt.begin(), flight.tilt.end(), stuck)) {
    throw UnsuitableFlight(
        "the pitch never moves, as if its sensor were stuck: nothing can be predicted from it");
  }
  const std::optional<Leaning> found = leaning_over_a_second(flight, gravity);
  if (!found) return;  // too short to judge, which is told elsewhere
  const auto [correlation, slope, size] = *found;
  constexpr double level = 0.1;
  if (size < level) {
    throw UnsuitableFlight(
        "the pitch is far too level for the logged accelerations; are the angles in radians?");
  }
  check_axes(flight);
  check_leans_into_its_speed(flight, gravity);
  constexpr double clear = 0.5;  // real flights have correlations of 0.8 to 0.95
  if (correlation < -clear) {
    throw UnsuitableFlight(
        "the drone speeds up when its pitch rises: pitch must be positive nose-up");
  }
  if (correlation > clear && (slope > 1.6 || slope < 0.1)) {
    const char* hint = slope < 0.1  ? "is the time in milliseconds?"
                       : slope < 10 ? "are the velocities in km/h, or knots?"
                                    : "are the angles in radians?";
    throw UnsuitableFlight(fmt::format(
        "the forward acceleration is {:.2g} times what the pitch makes expect; {}", slope, hint));
  }
}

}  // namespace tethercalc
