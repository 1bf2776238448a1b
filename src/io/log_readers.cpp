#include "tethercalc/io/log_readers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>

#include "io/checked_values.hpp"
#include "io/csv_log_columns.hpp"
#include "io/log_damage.hpp"
#include "io/logged_vehicle.hpp"
#include "io/longest_increasing.hpp"
#include "io/px4_flight.hpp"
#include "tethercalc/io/input_error.hpp"
#include "tethercalc/model/units.hpp"

namespace tethercalc {
namespace {

/// Samples as logged: time in s, angles in degrees, velocities in m/s.
enum LogColumn : std::size_t {
  time_s,
  roll_deg,
  pitch_deg,
  yaw_deg,
  vn,
  ve,
  vd,
  wind_north,
  wind_east,
  airspeed_forward,
  down_position,
  channel_count
};
using Samples = std::vector<std::vector<double>>;

bool is_plausible(const Samples& samples, std::size_t i) {
  const auto within = [&](LogColumn channel, double limit) {
    return std::abs(samples[channel][i]) <= limit;  // false for NaN
  };
  return std::isfinite(samples[time_s][i]) && within(roll_deg, furthest_roll_deg) &&
         within(pitch_deg, steepest_pitch_deg) && within(yaw_deg, furthest_yaw_deg) &&
         within(vn, fastest_m_s) && within(ve, fastest_m_s) && within(vd, fastest_m_s);
}

/// Returns the number of samples removed.
std::size_t keep(Samples& samples, std::span<const std::size_t> kept) {
  const std::size_t before = samples[time_s].size();
  for (auto& channel : samples) {
    if (channel.empty()) continue;  // the log has none
    for (std::size_t i = 0; i < kept.size(); ++i) channel[i] = channel[kept[i]];
    channel.resize(kept.size());
  }
  return before - kept.size();
}

std::size_t remove_implausible(Samples& samples) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < samples[time_s].size(); ++i) {
    if (is_plausible(samples, i)) kept.push_back(i);
  }
  return keep(samples, kept);
}

/// Whether a velocity leaps to sample i and back, faster than anything flies: by 20 g for the time
/// between, and by 10 m/s at least.
bool is_leap(const Samples& samples, std::size_t i) {
  const std::vector<double>& time = samples[time_s];
  const double most = std::max(10.0, 200 * (time[i + 1] - time[i - 1]) / 2);
  return std::ranges::any_of(std::array{vn, ve, vd}, [&](LogColumn channel) {
    const std::vector<double>& v = samples[channel];
    if (v.empty()) return false;
    const double up = v[i] - v[i - 1];
    const double down = v[i] - v[i + 1];
    return up * down > 0 && std::min(std::abs(up), std::abs(down)) > most &&
           std::abs(v[i + 1] - v[i - 1]) < most;
  });
}

/// `samples` in the order of their time. Returns the number removed.
std::size_t remove_leaps(Samples& samples) {
  const std::size_t size = samples[time_s].size();
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < size; ++i) {
    if (i == 0 || i + 1 == size || !is_leap(samples, i)) kept.push_back(i);
  }
  return keep(samples, kept);
}

std::size_t remove_out_of_order(Samples& samples) {
  const std::vector<double>& time = samples[time_s];
  if (std::ranges::adjacent_find(time, std::greater_equal<>()) == time.end()) return 0;
  return keep(samples, longest_increasing(time));
}

std::vector<double> in_radians(std::vector<double> degrees) {
  for (double& angle : degrees) angle *= unit::degree;
  return degrees;
}

/// Removes jumps of more than half a turn by adding whole turns.
std::vector<double> without_wraps(std::vector<double> angle) {
  constexpr double turn = 2 * std::numbers::pi;
  double turns = 0;
  for (std::size_t i = 1; i < angle.size(); ++i) {
    angle[i] += turns * turn;
    const double correction = -std::round((angle[i] - angle[i - 1]) / turn);
    angle[i] += correction * turn;
    turns += correction;
  }
  return angle;
}

/// The wind that makes up the difference to the speed over ground; none to the right.
void take_wind_from_airspeed(FlightLog& log, const std::vector<double>& airspeed) {
  for (std::size_t i = 0; i < airspeed.size(); ++i) {
    const double ahead_north = std::cos(log.yaw[i]);
    const double ahead_east = std::sin(log.yaw[i]);
    const double wind =
        ahead_north * log.north_velocity[i] + ahead_east * log.east_velocity[i] - airspeed[i];
    log.north_wind.push_back(ahead_north * wind);
    log.east_wind.push_back(ahead_east * wind);
  }
}

FlightLog to_flight_log(Samples samples) {
  samples.resize(channel_count);
  FlightLog log;
  log.time = std::move(samples[time_s]);
  log.roll = in_radians(std::move(samples[roll_deg]));
  log.pitch = in_radians(std::move(samples[pitch_deg]));
  log.yaw = without_wraps(in_radians(std::move(samples[yaw_deg])));
  log.north_velocity = std::move(samples[vn]);
  log.east_velocity = std::move(samples[ve]);
  log.down_velocity = std::move(samples[vd]);
  log.north_wind = std::move(samples[wind_north]);
  log.east_wind = std::move(samples[wind_east]);
  take_wind_from_airspeed(log, samples[airspeed_forward]);
  return log;
}

/// Where a DataFlash log has the wanted samples.
struct EstimatorMessage {
  std::string message;
  std::optional<int> core;
  std::string description;
};

[[noreturn]] void fail(const std::string& name, std::string message) {
  throw InputError({{name, std::move(message)}});
}

[[noreturn]] void fail_without_core(const AutopilotLog& log, std::string_view message, int core) {
  const std::vector<int> cores = log.instances(message);
  fail(
      log.name(),
      fmt::format("there is no EKF core {} in the log's {} messages; it has core {}", core, message,
                  cores.empty() ? std::string("0") : fmt::format("{}", fmt::join(cores, ", "))));
}

void check_core(int core) {
  if (core >= 0 && core <= 255) return;
  fail("core", fmt::format("{} is no EKF core, expected 0 to 255", core));
}

/// The newest estimator that wrote into the log.
EstimatorMessage find_estimator(const AutopilotLog& log, int core) {
  const LogContents& contents = log.contents();
  for (const std::string message : {"XKF1", "NKF1", "EKF1"}) {
    if (contents.count(message) == 0) continue;
    // Logs from before there were several cores have no field that tells them apart.
    if (contents.find(message)->instance_field) {
      return {message, core, fmt::format("{} of EKF core {}", message, core)};
    }
    if (core == 0) return {message, std::nullopt, message};
    if (core == 1 && message == "NKF1" && contents.count("NKF6") > 0) {
      return {"NKF6", std::nullopt, "NKF6"};
    }
    fail_without_core(log, message, core);
  }
  fail(log.name(),
       fmt::format("the log holds {} messages, but no attitude and velocity: expected XKF1, NKF1 "
                   "or EKF1 messages (set bit 'attitude' of LOG_BITMASK to log them)",
                   contents.messages));
}

/// What flew, where it is no multirotor.
std::string other_vehicle(const AutopilotLog& log) {
  const LoggedVehicle vehicle = logged_vehicle(log);
  if (!vehicle.is_other) return {};
  return vehicle.firmware.empty() ? vehicle.kind
                                  : fmt::format("{}, {}", vehicle.firmware, vehicle.kind);
}

/// The last of the samples' columns as that channel.
void move_last_to(LogColumn channel, Samples& samples) {
  std::vector<double> values = std::move(samples.back());
  samples.pop_back();
  samples.resize(channel_count);
  samples[channel] = std::move(values);
}

Samples read_samples(const AutopilotLog& log, const EstimatorMessage& from) {
  const LogMessageType& type = *log.contents().find(from.message);
  if (!time_of(type)) fail(log.name(), fmt::format("{} messages have no time", type.name));
  std::vector<std::string> fields = {"Roll", "Pitch", "Yaw", "VN", "VE", "VD"};
  for (const std::string& field : fields) {
    if (type.find_number(field) != nullptr) continue;
    std::vector<std::string> own;
    for (const LogField& known : type.fields) own.push_back(known.name);
    fail(log.name(), fmt::format("{} messages have no number {}; their fields are {}", type.name,
                                 field, fmt::join(own, ",")));
  }
  const bool has_position = type.find_number("PD") != nullptr;
  if (has_position) fields.emplace_back("PD");
  LogSeries series = log.series(from.message, fields, from.core);
  Samples samples;
  samples.push_back(std::move(series.time));
  for (auto& column : series.columns) samples.push_back(std::move(column));
  if (has_position) move_last_to(down_position, samples);
  return samples;
}

void note_removed(FlightLogReading& reading) {
  if (reading.samples_implausible > 0) {
    reading.notes.push_back(
        {WarningKind::log_values_implausible,
         samples_left_out(reading.samples_implausible) + ": values that no flight can have"});
  }
  if (reading.samples_out_of_order > 0) {
    reading.notes.push_back(
        {WarningKind::log_times_unordered,
         samples_left_out(reading.samples_out_of_order) + ": their time does not increase"});
  }
}

/// `samples` as a flight, without those that cannot be.
void take_samples(FlightLogReading& reading, Samples samples, const AutopilotLog& log) {
  reading.samples_implausible = remove_implausible(samples);
  reading.samples_out_of_order = remove_out_of_order(samples);
  reading.samples_implausible += remove_leaps(samples);
  note_damage(log.contents(), reading.notes);
  note_removed(reading);
  samples.resize(channel_count);
  reading.height = std::move(samples[down_position]);
  for (double& height : reading.height) height = -height;
  reading.log = to_flight_log(std::move(samples));
  reading.log.other_vehicle = other_vehicle(log);
}

FlightLogReading read_dataflash(const AutopilotLog& log, int core) {
  const EstimatorMessage from = find_estimator(log, core);
  Samples samples = read_samples(log, from);
  if (samples[time_s].empty() && from.core) fail_without_core(log, from.message, core);
  FlightLogReading reading;
  reading.source = from.description;
  take_samples(reading, std::move(samples), log);
  return reading;
}

std::vector<double> in_degrees(std::vector<double> angles) {
  for (double& angle : angles) angle /= unit::degree;
  return angles;
}

FlightLogReading read_ulog(const AutopilotLog& log, int core) {
  Px4Motion motion = px4_motion(log, core);
  FlightLogReading reading;
  reading.source = std::move(motion.source);
  reading.notes = std::move(motion.notes);
  Samples samples{std::move(motion.time),
                  in_degrees(std::move(motion.roll)),
                  in_degrees(std::move(motion.pitch)),
                  in_degrees(std::move(motion.yaw)),
                  std::move(motion.north),
                  std::move(motion.east),
                  std::move(motion.down),
                  std::move(motion.down_position)};
  move_last_to(down_position, samples);
  take_samples(reading, std::move(samples), log);
  return reading;
}

/// Roll, pitch and yaw of a quaternion that turns the drone's forward, right and down to north,
/// east and down.
void take_angles_from_quaternion(LogTable& table, const std::string& name) {
  if (!table.has("quaternion_w")) return;
  const std::size_t size = table["time_s"].size();
  for (const char* angle : {"roll_deg", "pitch_deg", "yaw_deg"}) table[angle].resize(size);
  Problems problems(20, name);
  for (std::size_t i = 0; i < size; ++i) {
    const double w = table["quaternion_w"][i];
    const double x = table["quaternion_x"][i];
    const double y = table["quaternion_y"][i];
    const double z = table["quaternion_z"][i];
    const double square = w * w + x * x + y * y + z * z;
    constexpr double rounding = 0.02;  // of two decimals
    if (std::abs(square - 1) > 2 * rounding) {
      problems.add(fmt::format("{}:{}", name, i + 2),
                   fmt::format("the quaternion's length is {:.3g}, expected 1", std::sqrt(square)));
    }
    const double up = std::clamp(2 * (w * y - z * x) / square, -1.0, 1.0);
    table["roll_deg"][i] = std::atan2(w * x + y * z, square / 2 - x * x - y * y) / unit::degree;
    table["pitch_deg"][i] = std::asin(up) / unit::degree;
    table["yaw_deg"][i] = std::atan2(w * z + x * y, square / 2 - y * y - z * z) / unit::degree;
  }
  problems.throw_if_any();
}

/// The velocity over ground of one along the drone's own axes.
void take_velocity_from_body(LogTable& table) {
  if (!table.has("body_forward_m_s")) return;
  const std::size_t size = table["time_s"].size();
  for (const char* velocity : {"vn_m_s", "ve_m_s", "vd_m_s"}) table[velocity].resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    const double roll = table["roll_deg"].empty() ? 0 : table["roll_deg"][i] * unit::degree;
    const double pitch = table["pitch_deg"][i] * unit::degree;
    const double yaw = table["yaw_deg"][i] * unit::degree;
    const double right = table["body_right_m_s"][i];
    const double down = table["body_down_m_s"][i];
    // The roll undone, then the pitch, then the yaw.
    const double level_right = right * std::cos(roll) - down * std::sin(roll);
    const double below = right * std::sin(roll) + down * std::cos(roll);
    const double forward = table["body_forward_m_s"][i];
    const double ahead = forward * std::cos(pitch) + below * std::sin(pitch);
    table["vn_m_s"][i] = ahead * std::cos(yaw) - level_right * std::sin(yaw);
    table["ve_m_s"][i] = ahead * std::sin(yaw) + level_right * std::cos(yaw);
    table["vd_m_s"][i] = below * std::cos(pitch) - forward * std::sin(pitch);
  }
}

/// The wind that makes up the difference between the velocity over ground and the airspeed.
void take_wind_from_direction(LogTable& table) {
  if (!table.has("air_from_deg")) return;
  const std::size_t size = table["time_s"].size();
  for (const char* wind : {"wind_north_m_s", "wind_east_m_s"}) table[wind].resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    const double from = table["air_from_deg"][i] * unit::degree;
    const double airspeed = table["airspeed_m_s"][i];
    table["wind_north_m_s"][i] = table["vn_m_s"][i] - airspeed * std::cos(from);
    table["wind_east_m_s"][i] = table["ve_m_s"][i] - airspeed * std::sin(from);
  }
}

FlightLogReading read_csv(std::string_view text, const std::string& name,
                          const FlightLogOptions& options) {
  constexpr std::array<std::string_view, 2> of_level_flight{"roll_deg", "vd_m_s"};
  LogTable table(text, name, &LogCsvColumn::flight, options.columns,
                 options.level_where_missing ? std::span<const std::string_view>(of_level_flight)
                                             : std::span<const std::string_view>());
  check_wind_columns(table, name);
  take_angles_from_quaternion(table, name);
  take_velocity_from_body(table);
  take_wind_from_direction(table);
  FlightLogReading reading;
  reading.source = "CSV";
  table.note_passed_over(reading.notes);
  for (const auto& [column, taken_for] :
       {std::pair{"roll_deg", "level flight"}, std::pair{"vd_m_s", "flight at one height"}}) {
    if (table.has(column)) continue;
    table[column].assign(table["time_s"].size(), 0.0);
    reading.notes.push_back({WarningKind::log_column_missing,
                             fmt::format("{} is missing: taken for {}", column, taken_for)});
  }
  Samples samples(channel_count);
  for (const auto& [channel, column] : {std::pair{time_s, "time_s"},
                                        {roll_deg, "roll_deg"},
                                        {pitch_deg, "pitch_deg"},
                                        {yaw_deg, "yaw_deg"},
                                        {vn, "vn_m_s"},
                                        {ve, "ve_m_s"},
                                        {vd, "vd_m_s"},
                                        {wind_north, "wind_north_m_s"},
                                        {wind_east, "wind_east_m_s"},
                                        {airspeed_forward, "airspeed_forward_m_s"}}) {
    samples[channel] = std::move(table[column]);
  }
  reading.samples_implausible = remove_leaps(samples);
  note_removed(reading);
  reading.log = to_flight_log(std::move(samples));
  return reading;
}

}  // namespace

FlightLogReading parse_flight_log(const AutopilotLog& log, const FlightLogOptions& options) {
  check_core(options.core);
  check_no_columns(options.columns, log.name());
  return log.format() == LogFormat::ulog ? read_ulog(log, options.core)
                                         : read_dataflash(log, options.core);
}

FlightLogReading parse_flight_log(std::span<const std::byte> content, const std::string& name,
                                  const FlightLogOptions& options) {
  check_core(options.core);
  if (!looks_like_table(content)) return parse_flight_log(AutopilotLog(content, name), options);
  check_no_core(options.core, name);
  return read_csv({reinterpret_cast<const char*>(content.data()), content.size()}, name, options);
}

}  // namespace tethercalc
