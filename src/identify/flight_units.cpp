#include "identify/flight_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "identify/statistics.hpp"
#include "tethercalc/model/units.hpp"

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

namespace {

/// A quantity along the heading and to the right of it, one element a sample.
struct LevelSeries {
  std::vector<double> forward;
  std::vector<double> right;
};

/// m/s², by forces.
LevelSeries seen_accelerations(const Observations& flight) {
  LevelSeries seen{flight.forward_acceleration, flight.right_acceleration};
  if (flight.kinematics == Kinematics::exact) return seen;
  const std::vector<double> turning = yaw_rate(flight);
  for (std::size_t i = 0; i < flight.size(); ++i) {
    seen.forward[i] -= turning[i] * flight.right_speed[i];
  }
  return seen;
}

/// m/s², g·tan θ and g·tan φ/cos θ.
LevelSeries leaning_accelerations(const Observations& flight, double gravity) {
  LevelSeries leaning;
  for (std::size_t i = 0; i < flight.size(); ++i) {
    leaning.forward.push_back(gravity * std::tan(flight.tilt[i]));
    leaning.right.push_back(gravity * std::tan(flight.roll[i]) / std::cos(flight.tilt[i]));
  }
  return leaning;
}

/// How changes of two quantities over a second go together, of as many axes as are added.
struct SecondsCompared {
  double both = 0;
  double leaning = 0;
  double measured = 0;

  void add(const std::vector<double>& expected, const std::vector<double>& seen, std::size_t lag) {
    for (std::size_t i = lag; i < seen.size(); ++i) {
      const double by_leaning = expected[i] - expected[i - lag];
      const double by_force = seen[i] - seen[i - lag];
      both += by_leaning * by_force;
      leaning += by_leaning * by_leaning;
      measured += by_force * by_force;
    }
  }

  [[nodiscard]] std::optional<Leaning> result() const {
    if (!(leaning > 0 && measured > 0)) return std::nullopt;
    return Leaning{both / std::sqrt(leaning * measured), both / leaning,
                   std::sqrt(leaning / measured)};
  }
};

}  // namespace

std::optional<Leaning> leaning_over_a_second(const Observations& flight, double gravity,
                                             Axis axis) {
  if (flight.size() < 3) return std::nullopt;
  const std::size_t lag = samples_a_second(flight);
  if (flight.size() < 10 * lag) return std::nullopt;
  const auto of = axis == Axis::forward ? &LevelSeries::forward : &LevelSeries::right;
  const LevelSeries seen = seen_accelerations(flight);
  if ((seen.*of).size() != flight.size()) return std::nullopt;
  SecondsCompared compared;
  compared.add(leaning_accelerations(flight, gravity).*of, seen.*of, lag);
  return compared.result();
}

namespace {

/// What a drone does, and what its attitude makes expect of it.
struct Motion {
  LevelSeries seen;
  LevelSeries leaning;
};

/// A way in which the columns of a log may mean something else than they should.
struct AxesMistake {
  const char* words;
  bool velocities_exchanged = false;  ///< north is east and east is north
  bool velocities_of_body = false;    ///< along the heading and to its right
  double yaw_factor = 1;
  double yaw_offset = 0;  ///< rad
  double pitch_sign = 1;
  double roll_sign = 1;
  bool angles_exchanged = false;  ///< pitch is roll and roll is pitch
};

constexpr double quarter_turn = std::numbers::pi / 2;
constexpr std::array axes_mistakes{
    AxesMistake{.words = "the north and east velocities were exchanged",
                .velocities_exchanged = true},
    AxesMistake{.words = "the yaw were counted the other way round", .yaw_factor = -1},
    AxesMistake{.words = "the yaw were counted from east, counterclockwise",
                .yaw_factor = -1,
                .yaw_offset = quarter_turn},
    AxesMistake{.words = "the yaw were a quarter turn more", .yaw_offset = quarter_turn},
    AxesMistake{.words = "the yaw were a quarter turn less", .yaw_offset = -quarter_turn},
    AxesMistake{.words = "the yaw were half a turn off", .yaw_offset = 2 * quarter_turn},
    AxesMistake{.words = "the yaw were in radians", .yaw_factor = 1 / unit::degree},
    AxesMistake{.words = "the velocities were along the drone's own axes",
                .velocities_of_body = true},
    AxesMistake{.words = "the pitch were positive nose-down", .pitch_sign = -1},
    AxesMistake{.words = "the roll were positive left side down, or the axes were east and north",
                .roll_sign = -1},
    AxesMistake{.words = "pitch and roll were exchanged", .angles_exchanged = true},
};

/// The motion if the columns are mistaken so.
Motion read_otherwise(const Motion& read, const Observations& flight, const AxesMistake& mistake) {
  Motion out = read;
  const std::vector<double> rate = yaw_rate(flight);
  for (std::size_t i = 0; i < flight.size(); ++i) {
    const double cosine = std::cos(flight.yaw[i]);
    const double sine = std::sin(flight.yaw[i]);
    double& forward = out.seen.forward[i];
    double& right = out.seen.right[i];
    double north = forward * cosine - right * sine;
    double east = forward * sine + right * cosine;
    if (mistake.velocities_of_body) {
      forward = north - rate[i] * (flight.forward_speed[i] * sine + flight.right_speed[i] * cosine);
      right = east + rate[i] * (flight.forward_speed[i] * cosine - flight.right_speed[i] * sine);
    } else {
      if (mistake.velocities_exchanged) std::swap(north, east);
      const double meant = mistake.yaw_factor * flight.yaw[i] + mistake.yaw_offset;
      forward = north * std::cos(meant) + east * std::sin(meant);
      right = east * std::cos(meant) - north * std::sin(meant);
    }
    double& nose = out.leaning.forward[i];
    double& wing = out.leaning.right[i];
    nose *= mistake.pitch_sign;
    wing *= mistake.roll_sign;
    if (mistake.angles_exchanged) {
      // Nose-up is positive as a pitch, and leans backwards.
      std::swap(nose, wing);
      nose = -nose;
      wing = -wing;
    }
  }
  return out;
}

double correlation_of(const SecondsCompared& compared) {
  const std::optional<Leaning> result = compared.result();
  return result ? result->correlation : 0;
}

void check_axes(const Observations& flight, double gravity) {
  if (flight.right_acceleration.size() != flight.size()) return;
  const std::size_t lag = samples_a_second(flight);
  const bool rolls = spread(flight.roll) > 0;
  const auto along = [&](const Motion& motion) {
    SecondsCompared compared;
    compared.add(motion.leaning.forward, motion.seen.forward, lag);
    return compared;
  };
  const auto in_plane = [&](const Motion& motion) {
    SecondsCompared compared = along(motion);
    if (rolls) compared.add(motion.leaning.right, motion.seen.right, lag);
    return correlation_of(compared);
  };
  const Motion read{seen_accelerations(flight), leaning_accelerations(flight, gravity)};
  SecondsCompared aside;
  aside.add(read.leaning.right, read.seen.right, lag);
  const double as_read = in_plane(read);
  constexpr double mirrored = -0.5;
  if (as_read > leans_to_speed_up && !(rolls && correlation_of(aside) < mirrored)) return;
  // Gusts that a drone leans against leave less of it; what is read rightly goes together far
  // better, all the same.
  constexpr double clear = 0.7;
  constexpr double far_better = 0.4;
  constexpr double alike = 0.02;
  std::vector<std::pair<double, const char*>> found;
  for (const AxesMistake& mistake : axes_mistakes) {
    found.emplace_back(in_plane(read_otherwise(read, flight, mistake)), mistake.words);
  }
  const double best = std::ranges::max(found).first;
  const bool told = best >= clear || (best > leans_to_speed_up && best > as_read + far_better);
  if (!told || best <= as_read) return;
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
void check_leans_into_its_speed(const Observations& flight) {
  constexpr double fast = 8;          // m/s
  constexpr double long_enough = 20;  // s
  constexpr double nose_up = 0.35;    // m/s², 2°: beyond what the attitude's own errors do
  constexpr int sides = 4;
  const std::vector<double> drag = forward_drag_over_mass(flight);
  std::array<double, sides> sum{};
  std::array<std::size_t, sides> count{};
  for (std::size_t i = 0; i < flight.size(); ++i) {
    if (flight.forward_speed[i] < fast) continue;
    const double turn = flight.yaw[i] / (2 * std::numbers::pi);
    const auto side = static_cast<std::size_t>((turn - std::floor(turn)) * sides) % sides;
    sum[side] += drag[i];
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

double heading_from_leaning(const Observations& flight, double gravity) {
  const LevelSeries seen = seen_accelerations(flight);
  if (seen.right.size() != flight.size()) return 0;
  const std::size_t lag = samples_a_second(flight);
  const LevelSeries leaning = leaning_accelerations(flight, gravity);
  SecondsCompared along;
  along.add(leaning.forward, seen.forward, lag);
  along.add(leaning.right, seen.right, lag);
  SecondsCompared to_the_right;
  to_the_right.add(leaning.forward, seen.right, lag);
  SecondsCompared to_the_left;
  to_the_left.add(leaning.right, seen.forward, lag);
  const double aside = to_the_right.both - to_the_left.both;
  const double all = std::sqrt(along.leaning * along.measured);
  if (!(std::hypot(along.both, aside) > leans_to_speed_up * all)) return 0;
  return std::atan2(-aside, along.both);
}

double mean_heading(const Observations& flight) {
  double north = 0;
  double east = 0;
  for (const double yaw : flight.yaw) {
    north += std::cos(yaw);
    east += std::sin(yaw);
  }
  return std::atan2(east, north);
}

bool turns(const Observations& flight, double apart) { return spread(flight.yaw) > apart; }

bool shows_both_axes(const Observations& flight, double gravity) {
  // m/s: as of the forward speed, below which a fit takes drag and wind for each other.
  constexpr double flown_to_the_side = 3;
  const std::optional<Leaning> aside = leaning_over_a_second(flight, gravity, Axis::right);
  return aside && aside->correlation > leans_to_speed_up &&
         (turns(flight) || spread(flight.right_speed) > flown_to_the_side);
}

namespace {

/// Whether the acceleration falls where the thrust that leans grows, by about as much as it should
/// rise: the regression of its changes over a second on those of g·tan θ and −a_D·tan θ.
bool falls_with_thrust(const Observations& flight, double gravity) {
  const std::size_t lag = samples_a_second(flight);
  const std::vector<double> seen = seen_accelerations(flight).forward;
  const std::vector<double> leaning = leaning_accelerations(flight, gravity).forward;
  std::vector<double> lifted = leaning;
  for (std::size_t i = 0; i < lifted.size(); ++i)
    lifted[i] *= -flight.down_acceleration[i] / gravity;
  SecondsCompared lean_and_seen;
  lean_and_seen.add(leaning, seen, lag);
  SecondsCompared lean_and_lift;
  lean_and_lift.add(leaning, lifted, lag);
  SecondsCompared lift_and_seen;
  lift_and_seen.add(lifted, seen, lag);
  const double along_lean = lean_and_lift.both / lean_and_lift.leaning;
  const double lift = lean_and_lift.measured - along_lean * lean_and_lift.both;
  const double left =
      lift_and_seen.measured - lean_and_seen.both * lean_and_seen.both / lean_and_seen.leaning;
  const double both = lift_and_seen.both - along_lean * lean_and_seen.both;
  if (!(lift > 0 && left > 0)) return false;
  const double of_lift = both / lift;
  const double of_lean = lean_and_seen.both / lean_and_seen.leaning - along_lean * of_lift;
  // Real flights have correlations up to 0.6, simulated ones of others from -0.2 on.
  constexpr double clearly = -0.3;
  constexpr double least = -2.5;  // -1 by physics; what is far more follows something else
  const double gain = of_lift / of_lean;
  return both < clearly * std::sqrt(lift * left) && gain > least && gain < 0;
}

}  // namespace

std::optional<double> heading_error(const Observations& flight, double gravity) {
  constexpr double clearly = 10 * unit::degree;  // the cosine of less is within 2 % of 1
  const double off = heading_from_leaning(flight, gravity);
  return std::abs(off) > clearly ? std::optional(off) : std::nullopt;
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
  constexpr double at_rest = 0.5;  // m/s: beside it an estimate's own drift is large
  if (size < level && spread(flight.forward_speed) < at_rest &&
      spread(flight.right_speed) < at_rest) {
    throw UnsuitableFlight("the drone hardly moves or leans; is it in the air here?");
  }
  if (size < level) {
    throw UnsuitableFlight(
        "the pitch is far too level for the logged accelerations; are the angles in radians?");
  }
  check_axes(flight, gravity);
  check_leans_into_its_speed(flight);
  constexpr double clear = 0.5;  // real flights have correlations of 0.8 to 0.95
  if (correlation < -clear) {
    throw UnsuitableFlight(
        "the drone speeds up when its pitch rises: pitch must be positive nose-up");
  }
  if (correlation > clear && falls_with_thrust(flight, gravity)) {
    throw UnsuitableFlight(
        "the drone speeds up less where its thrust is larger: the down velocity must be positive "
        "downwards");
  }
  if (correlation > clear && (slope > 1.4 || slope < 0.1)) {
    const char* hint = slope < 0.1  ? "is the time in milliseconds?"
                       : slope < 10 ? "are the velocities in km/h, ft/s or knots?"
                                    : "are the angles in radians?";
    throw UnsuitableFlight(fmt::format(
        "the forward acceleration is {:.2g} times what the pitch makes expect; {}", slope, hint));
  }
}

}  // namespace tethercalc
