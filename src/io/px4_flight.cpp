#include "io/px4_flight.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "io/log_damage.hpp"
#include "io/longest_increasing.hpp"
#include "tethercalc/io/input_error.hpp"

namespace tethercalc {
namespace {

constexpr double longest_step = 0.3;  // s between attitudes; PX4 logs 10 to 250 a second

using Quaternion = std::array<double, 4>;  // w, x, y, z

/// Where the two come from.
struct Topics {
  std::string velocity;
  std::string attitude;
  int instance = 0;
};

[[noreturn]] void fail_without_motion(const AutopilotLog& log) {
  throw InputError(log.name(),
                   fmt::format("the log holds {} messages, but no velocity and attitude: expected "
                               "vehicle_local_position and vehicle_attitude (set bit 0 of "
                               "SDLOG_PROFILE to log them)",
                               log.contents().messages));
}

Topics topics_of(const AutopilotLog& log, int core) {
  const LogContents& contents = log.contents();
  const Topics chosen{"vehicle_local_position", "vehicle_attitude", 0};
  if (core == 0 && contents.count(chosen.velocity) > 0 && contents.count(chosen.attitude) > 0) {
    return chosen;
  }
  Topics own{"estimator_local_position", "estimator_attitude", core};
  const std::vector<int> instances = log.instances(own.velocity);
  const std::vector<int> attitudes = log.instances(own.attitude);
  const auto has = [core](const std::vector<int>& all) {
    return std::ranges::find(all, core) != all.end();
  };
  if (has(instances) && has(attitudes)) return own;
  if (core == 0 || (instances.empty() && contents.count(chosen.velocity) == 0)) {
    fail_without_motion(log);
  }
  throw InputError(
      log.name(),
      fmt::format("there is no EKF core {} in the log's estimator_local_position and "
                  "estimator_attitude messages; it has {}",
                  core,
                  instances.empty() ? std::string("only the one that flew, core 0")
                                    : fmt::format("core {}", fmt::join(instances, ", "))));
}

/// Rising in time, whatever damage did to single times.
LogSeries in_order(LogSeries series) {
  if (std::ranges::adjacent_find(series.time, std::greater_equal<>()) == series.time.end()) {
    return series;
  }
  const std::vector<std::size_t> kept = longest_increasing(series.time);
  const auto keep = [&kept](std::vector<double>& column) {
    for (std::size_t i = 0; i < kept.size(); ++i) column[i] = column[kept[i]];
    column.resize(kept.size());
  };
  for (auto& column : series.columns) keep(column);
  keep(series.time);
  return series;
}

double norm(const Quaternion& q) {
  return std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
}

/// Attitudes as quaternions, also where the log has angles.
struct Attitudes {
  std::vector<double> time;
  std::vector<Quaternion> rotation;
};

Attitudes attitudes_of(const AutopilotLog& log, const Topics& topics) {
  const std::vector<std::string> quaternion = {"q[0]", "q[1]", "q[2]", "q[3]"};
  LogSeries series = in_order(log.series(topics.attitude, quaternion, topics.instance));
  Attitudes attitudes;
  if (!series.time.empty()) {
    for (std::size_t i = 0; i < series.time.size(); ++i) {
      const Quaternion q = {series.columns[0][i], series.columns[1][i], series.columns[2][i],
                            series.columns[3][i]};
      constexpr double furthest_from_one = 0.1;  // damaged, or not set yet
      if (!(std::abs(norm(q) - 1) < furthest_from_one)) continue;
      attitudes.time.push_back(series.time[i]);
      attitudes.rotation.push_back(q);
    }
    return attitudes;
  }
  const std::vector<std::string> angles = {"roll", "pitch", "yaw"};
  series = in_order(log.series(topics.attitude, angles, topics.instance));
  for (std::size_t i = 0; i < series.time.size(); ++i) {
    const double r = series.columns[0][i] / 2;
    const double p = series.columns[1][i] / 2;
    const double y = series.columns[2][i] / 2;
    const Quaternion q = {
        std::cos(r) * std::cos(p) * std::cos(y) + std::sin(r) * std::sin(p) * std::sin(y),
        std::sin(r) * std::cos(p) * std::cos(y) - std::cos(r) * std::sin(p) * std::sin(y),
        std::cos(r) * std::sin(p) * std::cos(y) + std::sin(r) * std::cos(p) * std::sin(y),
        std::cos(r) * std::cos(p) * std::sin(y) - std::sin(r) * std::sin(p) * std::cos(y)};
    if (!std::isfinite(norm(q))) continue;
    attitudes.time.push_back(series.time[i]);
    attitudes.rotation.push_back(q);
  }
  return attitudes;
}

/// Between two attitudes a short time apart: along the chord, which over a few degrees is the arc.
Quaternion between(const Quaternion& a, const Quaternion& b, double share) {
  double dot = 0;
  for (std::size_t k = 0; k < 4; ++k) dot += a[k] * b[k];
  const double sign = dot < 0 ? -1 : 1;  // both signs are the same rotation
  Quaternion q;
  for (std::size_t k = 0; k < 4; ++k) q[k] = (1 - share) * a[k] + share * sign * b[k];
  const double size = norm(q);
  for (double& part : q) part /= size;
  return q;
}

void add_angles(Px4Motion& motion, const Quaternion& q) {
  const auto [w, x, y, z] = q;
  motion.roll.push_back(std::atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)));
  motion.pitch.push_back(std::asin(std::clamp(2 * (w * y - z * x), -1.0, 1.0)));
  motion.yaw.push_back(std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)));
}

void note_wind(const LogContents& contents, Px4Motion& motion) {
  for (const char* const topic : {"wind", "wind_estimate"}) {
    if (contents.count(topic) == 0) continue;
    motion.notes.push_back(
        {WarningKind::log_wind_unused,
         fmt::format("the wind in {} is the estimator's guess, no measurement: not used", topic)});
  }
  if (contents.count("airspeed") > 0) {
    motion.notes.push_back(
        {WarningKind::log_wind_unused,
         "the airspeed in airspeed is not used: a pitot tube on a multirotor reads forward flight "
         "only (where it is to be trusted, give the flight as CSV with airspeed_forward_m_s)"});
  }
}

}  // namespace

Px4Motion px4_motion(const AutopilotLog& log, int core) {
  const Topics topics = topics_of(log, core);
  std::vector<std::string> fields = {"vx", "vy", "vz"};
  const LogMessageType* const type = log.contents().find(topics.velocity);
  for (const char* const flag : {"v_xy_valid", "v_z_valid"}) {
    if (type->find_number(flag) != nullptr) fields.emplace_back(flag);
  }
  const auto flags_end = static_cast<std::ptrdiff_t>(fields.size());
  const bool has_position = type->find_number("z") != nullptr;
  if (has_position) fields.emplace_back("z");
  const LogSeries velocity = log.series(topics.velocity, fields, topics.instance);
  const Attitudes attitudes = attitudes_of(log, topics);
  if (velocity.time.empty() || attitudes.time.empty()) fail_without_motion(log);

  Px4Motion motion;
  motion.source = topics.velocity + " and " + topics.attitude;
  if (core > 0) motion.source += fmt::format(" of EKF core {}", core);
  std::size_t invalid = 0;
  std::size_t alone = 0;
  for (std::size_t i = 0; i < velocity.time.size(); ++i) {
    const bool is_valid =
        std::all_of(velocity.columns.begin() + 3, velocity.columns.begin() + flags_end,
                    [i](const std::vector<double>& flag) { return flag[i] != 0; });
    if (!is_valid) {
      ++invalid;
      continue;
    }
    const double t = velocity.time[i];
    const auto after = static_cast<std::size_t>(std::ranges::lower_bound(attitudes.time, t) -
                                                attitudes.time.begin());
    const bool is_exact = after < attitudes.time.size() && attitudes.time[after] == t;
    const bool is_between = after > 0 && after < attitudes.time.size() &&
                            attitudes.time[after] - attitudes.time[after - 1] <= longest_step;
    if (!is_exact && !is_between) {
      ++alone;
      continue;
    }
    if (is_exact) {
      add_angles(motion, attitudes.rotation[after]);
    } else {
      const double before = attitudes.time[after - 1];
      const double share = (t - before) / (attitudes.time[after] - before);
      add_angles(motion, between(attitudes.rotation[after - 1], attitudes.rotation[after], share));
    }
    motion.time.push_back(t);
    motion.north.push_back(velocity.columns[0][i]);
    motion.east.push_back(velocity.columns[1][i]);
    motion.down.push_back(velocity.columns[2][i]);
    if (has_position) motion.down_position.push_back(velocity.columns.back()[i]);
  }
  if (invalid > 0) {
    motion.notes.push_back(
        {WarningKind::log_velocity_invalid,
         samples_left_out(invalid) + ": the estimator itself calls their velocity invalid"});
  }
  if (alone > 0) {
    motion.notes.push_back({WarningKind::log_attitude_missing,
                            fmt::format("{}: no attitude within {} s before and after",
                                        samples_left_out(alone), longest_step)});
  }
  note_wind(log.contents(), motion);
  return motion;
}

}  // namespace tethercalc
